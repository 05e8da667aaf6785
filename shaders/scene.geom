// Adds the distance to the three edges in pixels, for the wireframe.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

in Surface {
    SURFACE
} corner[];

out Surface {
    SURFACE
} surface;

out Edges {
    noperspective vec3 distance_px;
    flat float strength;
} edges;

void main() {
    vec3 altitude_px = vec3(1e6);
    float strength = 0.0;
    if (gl_in[0].gl_Position.w > 0.0 && gl_in[1].gl_Position.w > 0.0 &&
        gl_in[2].gl_Position.w > 0.0) {
        vec2 p0 = gl_in[0].gl_Position.xy / gl_in[0].gl_Position.w * frame.viewport.xy * 0.5;
        vec2 p1 = gl_in[1].gl_Position.xy / gl_in[1].gl_Position.w * frame.viewport.xy * 0.5;
        vec2 p2 = gl_in[2].gl_Position.xy / gl_in[2].gl_Position.w * frame.viewport.xy * 0.5;
        vec2 a = p1 - p0;
        vec2 b = p2 - p0;
        float doubled_area = abs(a.x * b.y - a.y * b.x);
        vec3 lengths = max(vec3(distance(p1, p2), length(b), length(a)), vec3(1e-6));
        altitude_px = doubled_area / lengths;
        // Triangles of about a pixel would drown the picture in lines: they fade.
        float narrowest = min(altitude_px.x, min(altitude_px.y, altitude_px.z));
        strength = mix(0.12, 0.85, smoothstep(1.0, 14.0, narrowest));
    }
    for (int i = 0; i < 3; ++i) {
        gl_Position = gl_in[i].gl_Position;
#ifdef HAS_POSITION
        surface.position = corner[i].position;
#endif
#ifdef HAS_NORMAL
        surface.normal = corner[i].normal;
#endif
#ifdef HAS_UV0
        surface.uv0 = corner[i].uv0;
#endif
#ifdef HAS_UV1
        surface.uv1 = corner[i].uv1;
#endif
#ifdef HAS_COLOR
        surface.color = corner[i].color;
#endif
#ifdef MIXED_MIRROR
        surface.handedness = corner[i].handedness;
#endif
#ifdef BY_INSTANCE
        surface.id_color = corner[i].id_color;
#endif
#ifdef HAS_VALUE
        surface.value = corner[i].value;
#endif
#ifdef HAS_TANGENT
        surface.tangent = corner[i].tangent;
#endif
        edges.distance_px = vec3(0.0);
        edges.distance_px[i] = altitude_px[i];
        edges.strength = strength;
        EmitVertex();
    }
    EndPrimitive();
}
