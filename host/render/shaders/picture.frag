// A captured picture: colour where it covers, depth of the parallelogram or re-projected from what it kept.
layout(location = 0) out vec4 colour;
layout(binding = 0) uniform sampler2D picture_colour; // coverage in alpha, colours multiplied by it
in vec2 v_place;
#ifdef KEEP_DEPTH
layout(binding = 1) uniform sampler2D picture_depth;
layout(location = 0) uniform mat4 clip_from_eye;
layout(location = 4) uniform vec3 taken_corner; // relative to the eye of the capture
layout(location = 5) uniform vec3 taken_right;
layout(location = 6) uniform vec3 taken_up;
layout(location = 7) uniform vec3 taken_eye;    // relative to the eye of now
layout(location = 8) uniform float taken_near;  // depth 1 in units of the parallelogram's distance
#endif

void main()
{
    vec4 texel = texture(picture_colour, v_place);
    if (texel.a < 0.5) discard;
    colour = vec4(texel.rgb / texel.a, 1.0);
#ifdef KEEP_DEPTH
    ivec2 size = textureSize(picture_depth, 0);
    float depth = texelFetch(picture_depth, clamp(ivec2(v_place * vec2(size)), ivec2(0), size - 1), 0).r;
    float far = depth > 0.0 ? taken_near / depth : 1.0;
    vec3 point = taken_eye + far * (taken_corner + v_place.x * taken_right + v_place.y * taken_up);
    vec4 clip = clip_from_eye * vec4(point, 1.0);
    gl_FragDepth = clip.w > 0.0 ? clamp(clip.z / clip.w, 0.0, 1.0) : 1.0;
#endif
}
