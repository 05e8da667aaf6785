layout(location = 0) in vec3 position;
#ifdef HAS_NORMAL
layout(location = 1) in vec3 normal;
#endif
#ifdef HAS_UV0
layout(location = 2) in vec2 uv0;
#endif
#ifdef HAS_UV1
layout(location = 3) in vec2 uv1;
#endif
#ifdef HAS_COLOR
layout(location = 4) in vec4 color;
#endif
layout(location = 5) in vec4 row_x; // scene from local, by rows
layout(location = 6) in vec4 row_y;
layout(location = 7) in vec4 row_z;
#ifdef BY_INSTANCE
layout(location = 8) in uint instance_id;
#endif

#ifdef HAS_VALUE
layout(location = 9) in float value;
#endif

out Surface {
    SURFACE
} surface;

#ifdef BY_INSTANCE
vec3 idColor(uint id) {
    uint h = id * 2654435761u;
    h ^= h >> 15;
    h *= 2246822519u;
    h ^= h >> 13;
    float hue = float(h & 1023u) / 1024.0 * 6.0;
    float tint = 0.35 + 0.4 * float((h >> 10) & 255u) / 255.0;
    vec3 pure = clamp(abs(mod(hue + vec3(0.0, 4.0, 2.0), 6.0) - 3.0) - 1.0, 0.0, 1.0);
    return mix(vec3(0.8), pure, tint);
}
#endif

void main() {
    vec4 local = vec4(position, 1.0);
    vec3 scene = vec3(dot(row_x, local), dot(row_y, local), dot(row_z, local));
#ifdef HAS_POSITION
    surface.position = scene;
#endif
#if defined(HAS_NORMAL) || defined(MIXED_MIRROR)
    // Rows of the cofactor matrix: determinant times inverse transpose, so it is right under
    // shear and non-uniform scale, never divides, and turns normals of mirrored instances.
    vec3 cofactor_x = cross(row_y.xyz, row_z.xyz);
#ifdef HAS_NORMAL
    vec3 cofactor_y = cross(row_z.xyz, row_x.xyz);
    vec3 cofactor_z = cross(row_x.xyz, row_y.xyz);
    float mirror = dot(cofactor_x, row_x.xyz) < 0.0 ? -1.0 : 1.0;
    vec3 n = vec3(dot(cofactor_x, normal), dot(cofactor_y, normal), dot(cofactor_z, normal));
    float largest = max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1e-35));
    surface.normal = n * (mirror / largest);
#endif
#ifdef MIXED_MIRROR
    surface.handedness = dot(cofactor_x, row_x.xyz) < 0.0 ? -1.0 : 1.0;
#endif
#endif
#ifdef HAS_UV0
    surface.uv0 = uv0;
#endif
#ifdef HAS_UV1
    surface.uv1 = uv1;
#endif
#ifdef HAS_COLOR
    surface.color = color;
#endif
#ifdef BY_INSTANCE
    surface.id_color = idColor(instance_id);
#endif
#ifdef HAS_VALUE
    surface.value = value;
#endif
    gl_Position = frame.clip_from_scene * vec4(scene, 1.0);
}
