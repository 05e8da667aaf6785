// Shared by all scene stages. Lengths are scene units: world, centred and scaled to radius 1.
layout(std140) uniform Frame {
    mat4 clip_from_scene;
    vec4 drawn;      // xy: middle in drawn pixels; z: tangent of the viewing angle of one
    vec4 right;      // xyz: axes of the camera
    vec4 up;
    vec4 back;       // w: 1 orthographic, 0 perspective
    vec4 key_light;  // xyz: towards the light
    vec4 viewport;   // xy: pixels; z: exposure; w: 1 when alpha becomes coverage
    vec4 wire_color; // sRGB
    vec4 highlight_color; // sRGB, alpha
    vec4 display;         // x: factor of the roughness; y: 1 / full value; z: 1 light grid lines;
                          // w: 1 / octaves of a logarithmic scale of values, 0: linear
    vec4 floor_plane;     // x: height; y: lines a scene unit; zw: the first line
    vec4 value_colors[9]; // sRGB
} frame;

layout(std140) uniform Material {
    vec4 base_color;
    vec4 emissive; // w: alpha cut-off
    vec4 factors;  // metallic, roughness, normal scale, occlusion strength
    vec4 uv_u[5];  // rows of the texture transform; w: TEXCOORD_n
    vec4 uv_v[5];  // base colour, metallic-roughness, normal, occlusion, emissive
} material;

// Members of the block that travels from stage to stage; empty macros are absent members.
#if !defined(HAS_NORMAL) || defined(FACETS) || defined(NORMAL_MAP) || \
    (defined(SHADE_VALUE) && defined(SHADE_UV))
#define HAS_POSITION
#define SURFACE_POSITION vec3 position;
#else
#define SURFACE_POSITION
#endif
#ifdef HAS_NORMAL
#define SURFACE_NORMAL vec3 normal;
#else
#define SURFACE_NORMAL
#endif
#ifdef HAS_UV0
#define SURFACE_UV0 vec2 uv0;
#else
#define SURFACE_UV0
#endif
#ifdef HAS_UV1
#define SURFACE_UV1 vec2 uv1;
#else
#define SURFACE_UV1
#endif
#ifdef HAS_COLOR
#define SURFACE_COLOR vec4 color;
#else
#define SURFACE_COLOR
#endif
#ifdef MIXED_MIRROR
#define SURFACE_MIRROR flat float handedness;
#else
#define SURFACE_MIRROR
#endif
#ifdef BY_INSTANCE
#define SURFACE_ID flat vec3 id_color;
#else
#define SURFACE_ID
#endif
#ifdef HAS_VALUE
#define SURFACE_VALUE float value;
#else
#define SURFACE_VALUE
#endif
#ifdef HAS_TANGENT
#define SURFACE_TANGENT vec4 tangent;
#else
#define SURFACE_TANGENT
#endif
#define SURFACE \
    SURFACE_POSITION SURFACE_NORMAL SURFACE_UV0 SURFACE_UV1 SURFACE_COLOR SURFACE_MIRROR \
    SURFACE_ID SURFACE_VALUE SURFACE_TANGENT
