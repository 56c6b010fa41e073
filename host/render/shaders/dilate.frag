// Colours outside a picture's mask: the mean of the covered texels beside them, so that filtering takes no fringe. Of the four
// texels that it mixes one at least is covered where alpha comes to a half, and the other three stand beside that one.
layout(location = 0) out vec4 colour;
layout(binding = 0) uniform sampler2D picture_colour;
layout(location = 0) uniform ivec2 size; // of the picture: the texture may be larger

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), last = size - 1;
    if (texelFetch(picture_colour, at, 0).a > 0.5) discard;
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec4 texel = texelFetch(picture_colour, clamp(at + ivec2(x, y), ivec2(0), last), 0);
            sum += texel.a > 0.5 ? vec4(texel.rgb, 1.0) : vec4(0.0);
        }
    if (sum.a == 0.0) discard;
    colour = vec4(sum.rgb / sum.a, 0.0);
}
