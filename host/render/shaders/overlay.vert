// Lines, triangles and letters over the picture, already relative to the eye or in the picture's own -1 .. 1.
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 point_colour;
layout(location = 0) uniform mat4 clip_from_point;
out vec4 v_colour;

void main()
{
    gl_Position = clip_from_point * vec4(position, 1.0);
    v_colour = point_colour;
}
