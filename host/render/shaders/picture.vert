// A captured picture, shown as the parallelogram that it was taken through.
layout(location = 0) uniform mat4 clip_from_eye;
layout(location = 1) uniform vec3 corner; // relative to the eye
layout(location = 2) uniform vec3 right;
layout(location = 3) uniform vec3 up;
out vec2 v_place;

void main()
{
    v_place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = clip_from_eye * vec4(corner + v_place.x * right + v_place.y * up, 1.0);
}
