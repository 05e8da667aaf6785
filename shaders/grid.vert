// The floor under the scene: a square, no attributes.
out vec2 place; // scene units, in the plane

const float kReach = 12.0;

void main() {
    place = (vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0) * kReach;
    gl_Position = frame.clip_from_scene * vec4(place.x, frame.floor_plane.x, place.y, 1.0);
}
