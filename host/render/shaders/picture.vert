// A captured picture, shown as the parallelogram that it was taken through.
layout(location = 0) uniform mat4 clip_from_eye;
layout(location = 1) uniform vec3 corner; // relative to the eye
layout(location = 2) uniform vec3 right;
layout(location = 3) uniform vec3 up;
out vec2 v_place;
#ifdef KEEP_DEPTH
layout(location = 4) uniform vec3 taken_corner; // relative to the eye of the capture
layout(location = 5) uniform vec3 taken_right;
layout(location = 6) uniform vec3 taken_up;
layout(location = 7) uniform float taken_near;  // depth 1 in units of the parallelogram's distance
out vec2 v_taken_zw;
#endif

void main()
{
    v_place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = clip_from_eye * vec4(corner + v_place.x * right + v_place.y * up, 1.0);
#ifdef KEEP_DEPTH
    v_taken_zw = (clip_from_eye * vec4(taken_near * (taken_corner + v_place.x * taken_right + v_place.y * taken_up), 0.0)).zw;
#endif
}
