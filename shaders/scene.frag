in Surface {
    SURFACE
} surface;
#ifdef WIREFRAME
in Edges {
    noperspective vec3 distance_px;
    flat float strength;
} edges;
#endif

uniform sampler2D base_color_map;
uniform sampler2D metallic_roughness_map;
uniform sampler2D normal_map;
uniform sampler2D occlusion_map;
uniform sampler2D emissive_map;
uniform vec4 submesh_color; // linear
uniform float cull_back;    // 1: back faces of mixed mirrored instances are dropped here

out vec4 picture;

const vec3 kSky = vec3(0.46, 0.52, 0.62);
const vec3 kGround = vec3(0.22, 0.19, 0.17);
const vec3 kKey = vec3(2.30, 2.17, 1.98);
const float kPi = 3.14159265;

vec3 toSrgb(vec3 linear) {
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055;
    return mix(low, high, step(vec3(0.0031308), linear));
}

// Leaves colours below 0.5 as they are and rolls highlights off towards white.
vec3 toneMap(vec3 color) {
    const float kStart = 0.5;
    float peak = max(color.r, max(color.g, color.b));
    if (peak <= kStart)
        return color;
    float rest = 1.0 - kStart;
    float mapped = 1.0 - rest * rest / (peak + rest - kStart);
    vec3 scaled = color * (mapped / peak);
    return mix(scaled, vec3(mapped), clamp(1.0 - 1.0 / (0.12 * (peak - mapped) + 1.0), 0.0, 1.0));
}

#if defined(HAS_UV0) || defined(HAS_UV1)
vec2 textureUv(int index) {
#if defined(HAS_UV0) && defined(HAS_UV1)
    vec2 uv = material.uv_u[index].w > 0.5 ? surface.uv1 : surface.uv0;
#elif defined(HAS_UV0)
    vec2 uv = surface.uv0;
#else
    vec2 uv = surface.uv1;
#endif
    vec3 h = vec3(uv, 1.0);
    return vec2(dot(material.uv_u[index].xyz, h), dot(material.uv_v[index].xyz, h));
}
#endif

vec4 baseColor() {
    vec4 color = material.base_color;
#ifdef BASE_MAP
    color *= texture(base_color_map, textureUv(0));
#endif
#ifdef HAS_COLOR
    color *= surface.color;
#endif
    return color;
}

// From the surface to the eye.
vec3 viewDirection() {
    if (frame.back.w > 0.5)
        return frame.back.xyz;
    vec2 tangent = (gl_FragCoord.xy - frame.drawn.xy) * frame.drawn.z;
    return normalize(frame.back.xyz - frame.right.xyz * tangent.x - frame.up.xyz * tangent.y);
}

vec3 faceNormal() {
#ifdef HAS_POSITION
    vec3 n = cross(dFdx(surface.position), dFdy(surface.position));
    float squared = dot(n, n);
    return squared > 0.0 ? n * inversesqrt(squared) : frame.back.xyz;
#else
    return frame.back.xyz;
#endif
}

bool frontFacing() {
#ifdef MIXED_MIRROR
    return gl_FrontFacing == (surface.handedness > 0.0);
#else
    return gl_FrontFacing;
#endif
}

vec3 shadingNormal() {
#if defined(HAS_NORMAL) && !defined(FACETS)
    float squared = dot(surface.normal, surface.normal);
    if (!(squared > 1e-8))
        return faceNormal();
    vec3 n = surface.normal * inversesqrt(squared);
    return frontFacing() ? n : -n;
#else
    return faceNormal();
#endif
}

#ifdef NORMAL_MAP
// Tangent frame: the file's tangents (the convention of MikkTSpace), else from screen derivatives,
// which is right for mirrored charts too.
vec3 mappedNormal(vec3 n) {
    vec2 uv = textureUv(2);
    vec3 texel = texture(normal_map, uv).xyz * 2.0 - 1.0;
    // Seen from behind, the mapped normal is the reverse of the one in front, not its mirror image.
    float side = frontFacing() ? 1.0 : -1.0;
    texel.xy *= material.factors.z * side;
#ifdef HAS_TANGENT
    if (dot(surface.tangent.xyz, surface.tangent.xyz) > 1e-8) {
        vec3 along = normalize(surface.tangent.xyz);
        vec3 over = cross(n, along) * (surface.tangent.w * side); // n is turned to the eye
        return normalize(along * texel.x + over * texel.y + n * texel.z);
    }
#endif
    vec3 dp_x = dFdx(surface.position);
    vec3 dp_y = dFdy(surface.position);
    vec2 duv_x = dFdx(uv);
    vec2 duv_y = dFdy(uv);
    vec3 across_y = cross(dp_y, n);
    vec3 across_x = cross(n, dp_x);
    vec3 tangent = across_y * duv_x.x + across_x * duv_y.x;
    vec3 bitangent = across_y * duv_x.y + across_x * duv_y.y;
    float largest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    if (!(largest > 0.0))
        return n;
    float scale = inversesqrt(largest);
    // glTF counts v downwards in the picture, y of the normal map upwards.
    return normalize(tangent * (scale * texel.x) - bitangent * (scale * texel.y) + n * texel.z);
}
#endif

vec3 hemisphere(vec3 direction) { return mix(kGround, kSky, direction.y * 0.5 + 0.5); }

#ifdef SHADE_LIT
vec3 litColor(vec3 base, vec3 n) {
    float metallic = material.factors.x;
    float roughness = material.factors.y;
#ifdef METALLIC_ROUGHNESS_MAP
    vec4 texel = texture(metallic_roughness_map, textureUv(1));
    metallic *= texel.b;
    roughness *= texel.g;
#endif
    roughness = clamp(roughness * frame.display.x, 0.08, 1.0);
    float occlusion = 1.0;
#ifdef OCCLUSION_MAP
    occlusion =
        1.0 + material.factors.w * (texture(occlusion_map, textureUv(3)).r - 1.0);
#endif
#ifdef NORMAL_MAP
    n = mappedNormal(n);
#endif
    vec3 v = viewDirection();
    vec3 l = frame.key_light.xyz;
    float n_v = max(dot(n, v), 1e-3);
    float n_l = dot(n, l);
    vec3 diffuse = base * (1.0 - metallic);
    vec3 f0 = mix(vec3(0.04), base, metallic);

    // The key wraps a little around the edge, like a large soft light.
    const float kWrap = 0.18;
    float lit = max(n_l + kWrap, 0.0) / (1.0 + kWrap);
    vec3 color = diffuse * (hemisphere(n) * occlusion + kKey * (lit / kPi * 1.25));
    color += diffuse * 0.12 * max(dot(n, v), 0.0) * occlusion; // light at the camera

    vec3 h = normalize(l + v);
    float n_h = max(dot(n, h), 0.0);
    float a2 = roughness * roughness;
    a2 *= a2;
    float denominator = n_h * n_h * (a2 - 1.0) + 1.0;
    float k = roughness * roughness * 0.5;
    float visible = max(n_l, 0.0) / max((max(n_l, 0.0) * (1.0 - k) + k) * (n_v * (1.0 - k) + k), 1e-3);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(v, h), 0.0), 5.0);
    color += kKey * fresnel * min(a2 / (kPi * denominator * denominator) * visible * 0.25, 6.0);

    // Surroundings: a soft sky and ground, sharper the smoother the surface (Karis' fit).
    vec3 r = reflect(-v, n);
    float horizon = smoothstep(-roughness - 0.05, roughness + 0.05, r.y);
    vec3 around = mix(kGround * 0.8, kSky * 1.25, horizon);
    vec4 fit = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(fit.x * fit.x, exp2(-9.28 * n_v)) * fit.x + fit.y;
    vec2 ab = vec2(-1.04, 1.04) * a004 + fit.zw;
    color += around * (f0 * ab.x + ab.y) * occlusion;

    vec3 emissive = material.emissive.rgb;
#ifdef EMISSIVE_MAP
    emissive *= texture(emissive_map, textureUv(4)).rgb;
#endif
    return color + emissive;
}
#endif

// One soft material for shape: lit from the camera's upper left, darker towards the rim.
vec3 clayColor(vec3 base, vec3 n) {
    vec3 v = viewDirection();
    float lit = max(dot(n, frame.key_light.xyz) + 0.25, 0.0) / 1.25;
    float facing = max(dot(n, v), 0.0);
    vec3 color = base * (hemisphere(n) * 0.55 + kKey * (lit * 0.36));
    color *= 0.72 + 0.28 * facing;
    vec3 h = normalize(frame.key_light.xyz + v);
    return color + vec3(0.06) * pow(max(dot(n, h), 0.0), 24.0);
}

vec3 checkerColor(vec3 n) {
#ifdef HAS_UV0
    vec2 cell = surface.uv0 * 8.0;
    vec2 width = max(fwidth(cell), vec2(1e-6));
    // Box-filtered checker board: fades to grey instead of shimmering.
    vec2 i = 2.0 * (abs(fract((cell - 0.5 * width) * 0.5) - 0.5) -
                    abs(fract((cell + 0.5 * width) * 0.5) - 0.5)) / width;
    float odd = 0.5 - 0.5 * i.x * i.y;
    vec2 tile = fract(surface.uv0);
    vec3 tint = mix(vec3(0.10, 0.33, 0.42), vec3(0.75, 0.38, 0.14), tile.x);
    tint = mix(tint, vec3(0.20, 0.50, 0.22), tile.y * 0.5);
    return clayColor(mix(tint, vec3(0.78), clamp(odd, 0.0, 1.0)), n);
#else
    return clayColor(vec3(0.25, 0.22, 0.24), n);
#endif
}

#ifdef SHADE_MATCAP
// A studio around the camera: a soft key from the upper left, a cool rim, a warm floor.
vec3 matcapColor(vec3 n) {
    vec3 eye = vec3(dot(n, frame.right.xyz), dot(n, frame.up.xyz), dot(n, viewDirection()));
    float key = max(dot(eye, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float rim = pow(clamp(1.0 - eye.z, 0.0, 1.0), 3.0);
    vec3 color = mix(vec3(0.085, 0.062, 0.055), vec3(0.16, 0.17, 0.19), eye.y * 0.5 + 0.5);
    color += vec3(0.50, 0.47, 0.43) * key * key;
    color += vec3(0.55) * pow(key, 40.0 / frame.display.x);
    return color + vec3(0.16, 0.24, 0.34) * rim * smoothstep(-0.4, 0.7, eye.y + 0.5 * eye.x);
}
#endif

#ifdef SHADE_VALUE
#if defined(SHADE_UV) && defined(BASE_MAP)
// Texels of the base colour along a length of the surface.
float texelDensity() {
    vec2 texel = textureUv(0) * vec2(textureSize(base_color_map, 0));
    vec2 right = dFdx(texel);
    vec2 up = dFdy(texel);
    float area = length(cross(dFdx(surface.position), dFdy(surface.position)));
    return sqrt(abs(right.x * up.y - right.y * up.x) / max(area, 1e-30));
}
#define VALUE texelDensity()
#elif defined(HAS_VALUE)
#define VALUE surface.value
#endif

// Lit just enough that the shape can be seen and colours can be read off the legend.
vec3 valueColor(vec3 n) {
#ifdef VALUE
    float of_full = VALUE * frame.display.y;
    float place = frame.display.w > 0.0 ? log2(max(of_full, 1e-30)) * frame.display.w + 1.0
                                        : of_full;
    place = clamp(place, 0.0, 1.0) * 8.0;
    int lower = int(min(place, 7.0));
    vec3 color = mix(frame.value_colors[lower].rgb, frame.value_colors[lower + 1].rgb,
                     place - float(lower));
#else
    vec3 color = vec3(0.32);
#endif
    return color * (0.80 + 0.20 * max(dot(n, viewDirection()), 0.0));
}
#endif

void main() {
#ifdef MIXED_MIRROR
    if (cull_back > 0.5 && !frontFacing())
        discard;
#endif
    vec4 base = baseColor();
    float alpha = 1.0;
#ifdef ALPHA_MASK
    if (frame.viewport.w > 0.5) {
        // Edge of about one pixel around the cut-off, turned into coverage by MSAA.
        float width = max(fwidth(base.a), 1e-4);
        alpha = clamp((base.a - material.emissive.w) / width + 0.5, 0.0, 1.0);
        if (alpha <= 0.0)
            discard;
    } else if (base.a < material.emissive.w) {
        discard;
    }
#endif
#ifdef ALPHA_BLEND
    alpha = clamp(base.a, 0.0, 1.0);
#endif

#ifdef HIGHLIGHT
    picture = frame.highlight_color;
    return;
#endif

    vec3 color;
#if defined(SHADE_LIT) && (defined(UNLIT) || defined(NO_SURFACE))
    color = base.rgb;
#elif defined(NO_SURFACE)
    color = vec3(0.6);
#elif defined(SHADE_LIT)
    color = litColor(base.rgb, shadingNormal());
#elif defined(SHADE_MATCAP)
    color = matcapColor(shadingNormal());
#elif defined(SHADE_CLAY)
    color = clayColor(vec3(0.58, 0.56, 0.54), shadingNormal());
#elif defined(SHADE_BASE_COLOR)
    color = clayColor(base.rgb, shadingNormal());
#elif defined(SHADE_UV)
    color = checkerColor(shadingNormal());
#elif defined(BY_INSTANCE)
    color = clayColor(surface.id_color * surface.id_color, shadingNormal());
#elif defined(SHADE_SUBMESH)
    color = clayColor(submesh_color.rgb, shadingNormal());
#else
    color = vec3(0.0);
#endif

#if defined(SHADE_VALUE) && !defined(NO_SURFACE)
    vec3 srgb = valueColor(shadingNormal());
#elif defined(SHADE_NORMALS) && !defined(NO_SURFACE)
    vec3 srgb = shadingNormal() * 0.5 + 0.5;
#elif defined(UNLIT) && defined(SHADE_LIT)
    vec3 srgb = toSrgb(clamp(color, 0.0, 1.0));
#else
    vec3 srgb = toSrgb(toneMap(color * frame.viewport.z));
#endif
#ifdef WIREFRAME
    vec3 d = edges.distance_px;
    float nearest = min(d.x, min(d.y, d.z));
    srgb = mix(srgb, frame.wire_color.rgb, edges.strength * (1.0 - smoothstep(0.2, 1.1, nearest)));
#endif
    picture = vec4(srgb, alpha);
}
