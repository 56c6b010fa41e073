// The outline of a picture, a vertex for each strip of its columns: the rows from its lowest covered texel to above its highest, as
// fractions of its height. Of a strip with nothing in it the lowest is 1, the highest 0. Nothing is drawn.
layout(binding = 0) uniform sampler2D picture_colour;
layout(location = 0) uniform ivec2 strips; // place of the first one; texels that each is wide
layout(std430, binding = 5) writeonly buffer outline_block { vec2 outlines[]; }; // lowest, highest

const int BESIDE = 2; // texels beside a strip that count as its own: what is drawn reaches over from there

void main()
{
    ivec2 size = textureSize(picture_colour, 0);
    int first = gl_VertexID * strips.y - BESIDE, end = min(first + strips.y + 2 * BESIDE, size.x + BESIDE);
    vec2 texel = 1.0 / vec2(size);
    int low = size.y, high = 0;
    for (int y = 0; y < size.y; y += 2) {
        float most = 0.0;
        for (int x = first; x < end; x += 2) // where four texels meet: their mean
            most = max(most, textureLod(picture_colour, vec2(x + 1, y + 1) * texel, 0.0).a);
        low = most > 0.0 && low == size.y ? y : low;
        high = most > 0.0 ? y + 2 : high;
    }
    outlines[strips.x + gl_VertexID] = vec2(low, high) * texel.y;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
