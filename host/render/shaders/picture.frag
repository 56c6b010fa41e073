// A captured picture: colour where it covers, its depth that of the pass or re-projected from what it kept.
layout(location = 0) out vec4 colour;
layout(binding = 0) uniform sampler2D picture_colour; // alpha 1: covered, else all are 0
in vec2 v_place;
// Of a covered texel's share where the picture ends. A mask knows an outline to half a texel, and halfway (0.5) pixels stay open that geometry covers; a fringe of
// half a texel (0.1) leaves fewest, and widens all that is thin: 3.3 dB, measured on needles. A quarter of a texel beyond halfway loses 1.1 of these.
const float COVERED = 0.25;
#ifdef KEEP_DEPTH
layout(binding = 1) uniform sampler2D picture_depth;
layout(location = 8) uniform vec2 taken_eye_zw; // of clip space, where the eye of the capture stood
layout(location = 9) uniform float behind;      // depth of what has none
in vec2 v_taken_zw; // the way from there that depth 1 is
#endif

void main()
{
#ifdef LINEAR
    vec4 texel = textureLod(picture_colour, v_place, 0.0);
#else
    ivec2 size = textureSize(picture_colour, 0);
    vec4 texel = texelFetch(picture_colour, clamp(ivec2(v_place * vec2(size)), ivec2(0), size - 1), 0);
#endif
    if (texel.a < COVERED) discard;
    colour = vec4(texel.rgb / texel.a, 1.0); // what is not covered weighs nothing
#ifdef KEEP_DEPTH
    float depth = textureLod(picture_depth, v_place, 0.0).r; // of the nearest texel
    if (depth == 0.0) { // which is not covered: of those beside it
        vec4 beside = textureGather(picture_depth, v_place);
        depth = max(max(beside.x, beside.y), max(beside.z, beside.w));
    }
    vec2 zw = depth * taken_eye_zw + v_taken_zw; // times the depth: what it shows stands at the eye plus the way over the depth
    gl_FragDepth = depth <= 2.0 * behind ? behind : zw.y > 0.0 ? clamp(zw.x / zw.y, 0.0, 1.0) : 1.0;
#endif
}
