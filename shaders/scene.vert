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
#if defined(BY_INSTANCE) || defined(POSED) || defined(MORPHED)
layout(location = 8) in uint instance_id;
#endif

#ifdef HAS_VALUE
layout(location = 9) in float value;
#endif
#ifdef HAS_JOINTS
layout(location = 10) in uvec4 joints;
layout(location = 11) in vec4 joint_weights;
#endif
#ifdef HAS_MORE_JOINTS
layout(location = 12) in uvec4 more_joints;
layout(location = 13) in vec4 more_joint_weights;
#endif
#ifdef HAS_TANGENT
layout(location = 14) in vec4 tangent;
#endif

#if defined(POSED) || defined(MORPHED)
uniform samplerBuffer pose;
uniform int pose_row; // texel of an instance: pose_row + its id
#endif
#ifdef MORPHED
uniform samplerBuffer morph_deltas; // position and normal of each vertex of each target
uniform ivec2 morph_shape;          // targets, vertices
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

struct Rows { // scene from local
    vec4 x;
    vec4 y;
    vec4 z;
};

#ifdef POSED
Rows poseRows(int texel) {
    return Rows(texelFetch(pose, texel), texelFetch(pose, texel + 1), texelFetch(pose, texel + 2));
}

void addJoints(inout Rows sum, inout float total, vec2 place, uvec4 which, vec4 weights) {
    for (int i = 0; i < 4; ++i) {
        if (!(weights[i] > 0.0))
            continue;
        Rows rows = poseRows(int(place.x) + 3 * int(min(float(which[i]), place.y)));
        sum.x += rows.x * weights[i];
        sum.y += rows.y * weights[i];
        sum.z += rows.z * weights[i];
        total += weights[i];
    }
}
#endif

Rows instanceRows() {
#ifdef POSED
    vec2 place = texelFetch(pose, pose_row + int(instance_id)).xy; // first texel, last joint
#ifdef HAS_JOINTS
    Rows sum = Rows(vec4(0.0), vec4(0.0), vec4(0.0));
    float total = 0.0;
    addJoints(sum, total, place, joints, joint_weights);
#ifdef HAS_MORE_JOINTS
    addJoints(sum, total, place, more_joints, more_joint_weights);
#endif
    if (total > 0.0)
        return Rows(sum.x / total, sum.y / total, sum.z / total);
    return Rows(row_x, row_y, row_z);
#else
    return poseRows(int(place.x));
#endif
#else
    return Rows(row_x, row_y, row_z);
#endif
}

#ifdef MORPHED
void morph(inout vec3 moved, inout vec3 turned) {
    int weights = int(texelFetch(pose, pose_row + int(instance_id)).z);
    for (int target = 0; target < morph_shape.x; ++target) {
        float weight = texelFetch(pose, weights + target / 4)[target % 4];
        if (weight == 0.0)
            continue;
        int texel = 2 * (target * morph_shape.y + gl_VertexID);
        moved += weight * texelFetch(morph_deltas, texel).xyz;
        turned += weight * texelFetch(morph_deltas, texel + 1).xyz;
    }
}
#endif

void main() {
    Rows rows = instanceRows();
    vec3 moved = position;
    vec3 turned = vec3(0.0);
#ifdef HAS_NORMAL
    turned = normal;
#endif
#ifdef MORPHED
    morph(moved, turned);
#endif
    vec4 local = vec4(moved, 1.0);
    vec3 scene = vec3(dot(rows.x, local), dot(rows.y, local), dot(rows.z, local));
#ifdef HAS_POSITION
    surface.position = scene;
#endif
#if defined(HAS_NORMAL) || defined(MIXED_MIRROR)
    // Rows of the cofactor matrix: determinant times inverse transpose, so it is right under
    // shear and non-uniform scale, never divides, and turns normals of mirrored instances.
    vec3 cofactor_x = cross(rows.y.xyz, rows.z.xyz);
#ifdef HAS_NORMAL
    vec3 cofactor_y = cross(rows.z.xyz, rows.x.xyz);
    vec3 cofactor_z = cross(rows.x.xyz, rows.y.xyz);
    float mirror = dot(cofactor_x, rows.x.xyz) < 0.0 ? -1.0 : 1.0;
    vec3 n = vec3(dot(cofactor_x, turned), dot(cofactor_y, turned), dot(cofactor_z, turned));
    float largest = max(max(abs(n.x), abs(n.y)), max(abs(n.z), 1e-35));
    surface.normal = n * (mirror / largest);
#endif
#ifdef MIXED_MIRROR
    surface.handedness = dot(cofactor_x, rows.x.xyz) < 0.0 ? -1.0 : 1.0;
#endif
#endif
#ifdef HAS_TANGENT
    vec3 t = vec3(dot(rows.x.xyz, tangent.xyz),
                  dot(rows.y.xyz, tangent.xyz),
                  dot(rows.z.xyz, tangent.xyz));
    float longest = max(max(abs(t.x), abs(t.y)), max(abs(t.z), 1e-35));
    surface.tangent = vec4(t / longest, tangent.w * mirror);
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
