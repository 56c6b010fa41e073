// Item boxes, eight corners each, already relative to the eye and widened.
layout(location = 0) in vec3 corner;
layout(location = 0) uniform mat4 clip_from_eye;
layout(location = 1) uniform uint first_slot;
flat out uint v_slot;

void main()
{
    gl_Position = clip_from_eye * vec4(corner, 1.0);
    v_slot = first_slot + (uint(gl_VertexID) >> 3);
}
