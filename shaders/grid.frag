in vec2 place;
out vec4 picture;

// How much of the pixel lines of one spacing cover; what is too dense fades.
float coverage(vec2 coordinate) {
    vec2 width = max(fwidth(coordinate), vec2(1e-6));
    vec2 away = abs(fract(coordinate - 0.5) - 0.5) / width;
    vec2 fade = 1.0 - smoothstep(0.15, 0.5, width);
    vec2 lines = (1.0 - min(away, 1.0)) * fade;
    return max(lines.x, lines.y);
}

void main() {
    vec2 coordinate = place * frame.floor_plane.y + frame.floor_plane.zw;
    float strength = max(coverage(coordinate) * 0.10, coverage(coordinate * 0.1) * 0.24);
    strength *= 1.0 - smoothstep(1.5, 9.0, length(place));
    if (strength < 0.002)
        discard;
    picture = vec4(vec3(frame.display.z), strength);
}
