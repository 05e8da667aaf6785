in vec2 place;
uniform vec3 lower; // sRGB
uniform vec3 upper;
out vec4 picture;

void main() {
    // A little noise hides the bands that eight bits show in dark gradients.
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    picture = vec4(mix(lower, upper, smoothstep(0.0, 1.0, place.y)) + noise / 255.0, 1.0);
}
