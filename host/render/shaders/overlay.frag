// The overlay's colours, as they are.
layout(location = 0) out vec4 colour;
in vec4 v_colour;

void main()
{
    colour = v_colour;
}
