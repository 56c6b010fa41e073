// A captured picture: colour where it covers, its depth that of the pass or re-projected from what it kept.
layout(location = 0) out vec4 colour;
layout(binding = 0) uniform sampler2D picture_colour; // alpha 1: covered, else 0. Colours go on for a texel beside it
in vec2 v_place;
#ifdef KEEP_DEPTH
layout(binding = 1) uniform sampler2D picture_depth;
layout(location = 8) uniform vec2 taken_eye_zw; // of clip space, where the eye of the capture stood
layout(location = 9) uniform float behind;      // depth of what has none
in vec2 v_taken_zw; // the way from there that depth 1 is
#endif

vec4 texel_at(vec2 place)
{
    ivec2 size = textureSize(picture_colour, 0);
    return texelFetch(picture_colour, clamp(ivec2(place * vec2(size)), ivec2(0), size - 1), 0);
}

#ifdef FRINGE
// Is anything covered within half a pixel? Less a little, so that texels that lie on pixels make no fringe.
void main()
{
    const vec2 ways[8] = vec2[8](vec2(0.499, 0), vec2(-0.499, 0), vec2(0, 0.499), vec2(0, -0.499), vec2(0.353), vec2(-0.353), vec2(0.353, -0.353), vec2(-0.353, 0.353));
    vec2 right = dFdx(v_place), up = dFdy(v_place);
    for (int i = 0; i < 8; ++i) {
        vec2 place = v_place + ways[i].x * right + ways[i].y * up;
        vec4 texel = texel_at(place);
        if (texel.a < 0.5 || place != clamp(place, vec2(0.0), vec2(1.0))) continue;
        colour = vec4(texel.rgb, 1.0);
        return;
    }
    discard;
}
#else
void main()
{
#ifdef LINEAR
    vec4 texel = textureLod(picture_colour, v_place, 0.0);
#else
    vec4 texel = texel_at(v_place);
#endif
    if (texel.a < 0.49) discard; // halfway between a covered texel and one that is not; a hundredth less, as filters weigh in 8 bits
    colour = vec4(texel.rgb, 1.0);
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
#endif
