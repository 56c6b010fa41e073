// Every triangle of the scene, whatever the picture: camera-relative position, reversed z.
// Invariant: the same vertex gives the same bits in every program and every draw.
layout(location = 0) in vec3 position;  // relative to the scene's origin
layout(location = 1) in uint word;      // material in the low 16 bits, flags above
layout(location = 2) in uint triangle;  // global number of the triangle that this vertex is the last of
layout(location = 0) uniform mat4 clip_from_eye;
layout(location = 1) uniform vec3 eye_high; // the eye relative to the scene's origin: float part ...
layout(location = 2) uniform vec3 eye_low;  // ... and what float could not hold
layout(location = 3) uniform uint wanted;   // 0 or WORD_TRANSLUCENT: which triangles this pass draws
layout(location = 4) uniform vec4 clip_planes[4]; // relative to the eye
invariant gl_Position;

flat out uint v_triangle;
#ifdef CUT_OUT
layout(location = 3) in vec2 texcoord;
out vec2 v_texcoord;
#endif
#if defined(CUT_OUT) || defined(SIDES)
flat out uint v_word;
#endif
#ifdef SHADED
layout(location = 4) in vec4 normal; // 0: none
layout(location = 8) in vec4 paint;
out vec4 v_front;
flat out uint v_back;
#endif
#ifdef EYE_POSITION
out vec3 v_eye;
#endif
#ifdef MOVERS
layout(location = 7) in uint mover; // number + 1; 0: never moves
struct pose_block { vec4 high, low, rows[3]; }; // poses.c says what they are
layout(std430, binding = 4) readonly buffer poses_block { pose_block poses[]; };
#endif

vec3 from_eye_of(vec3 p)
{
    precise vec3 from_eye;
#ifdef MOVERS
    if (mover != 0u) {
        vec4 low = poses[mover - 1u].low;
        from_eye = (p - poses[mover - 1u].high.xyz) - low.xyz;
        if (low.w == 0.0) return from_eye;
        vec4 x = poses[mover - 1u].rows[0], y = poses[mover - 1u].rows[1], z = poses[mover - 1u].rows[2];
        precise vec3 turned = vec3(dot(x.xyz, from_eye) + x.w, dot(y.xyz, from_eye) + y.w, dot(z.xyz, from_eye) + z.w);
        return turned;
    }
#endif
    from_eye = (p - eye_high) - eye_low;
    return from_eye;
}

#ifdef FAR_DEPTH
layout(location = 5) in vec3 other_a; // the triangle's other corners, where this vertex is its last
layout(location = 6) in vec3 other_b;
flat out float v_far_depth, v_near_depth; // of its farthest and nearest corner
float depth_of(vec4 clip)
{
    return clip.w > 0.0 ? clip.z / clip.w : 1.0; // behind the eye: the near plane cuts it
}
vec4 clip_of(vec3 p)
{
    return clip_from_eye * vec4(from_eye_of(p), 1.0);
}
#endif
#ifdef CLIP
out float gl_ClipDistance[4];
#endif

#ifdef SHADED
// Light is the same all over a flat face, and all but linear between the vertices of a smooth one: 20 times fewer vertices than fragments pay for it.
void shade(vec3 from_eye)
{
    vec3 n = normal.xyz;
#ifdef MOVERS
    if (mover != 0u && poses[mover - 1u].low.w != 0.0)
        n = vec3(dot(poses[mover - 1u].rows[0].xyz, n), dot(poses[mover - 1u].rows[1].xyz, n), dot(poses[mover - 1u].rows[2].xyz, n));
#endif
    float size = length(n);
    n /= max(size, 1e-30);
    if ((word & WORD_SKY) != 0u) {
        v_front = vec4(0.47, 0.70, 0.96, 0.0);
        v_back = packUnorm4x8(vec4(v_front.rgb, 1.0));
    } else if (size < 0.5) { // no normal; packed ones are near 1
        v_front = vec4(lit(paint.rgb, vec3(0.0, 1.0, 0.0)), 0.0); // where the last corner has one, and this has not
        v_back = packUnorm4x8(vec4(paint.rgb, 0.0));
    } else {
        v_front = vec4(lit(paint.rgb, n), dot(n, from_eye));
        v_back = packUnorm4x8(vec4(lit(paint.rgb, -n), 1.0));
    }
}
#endif

void main()
{
    precise vec3 from_eye = from_eye_of(position);
    gl_Position = clip_from_eye * vec4(from_eye, 1.0);
#ifdef TRANSLUCENT
    if ((word & WORD_TRANSLUCENT) != wanted) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside: the whole triangle goes
#endif
    v_triangle = triangle;
#ifdef FAR_DEPTH
    float depth = depth_of(gl_Position), depth_a = depth_of(clip_of(other_a)), depth_b = depth_of(clip_of(other_b));
    v_far_depth = min(depth, min(depth_a, depth_b));
    v_near_depth = max(depth, max(depth_a, depth_b));
#endif
#ifdef CUT_OUT
    v_texcoord = texcoord;
#endif
#if defined(CUT_OUT) || defined(SIDES)
    v_word = word;
#endif
#ifdef SHADED
    shade(from_eye);
#endif
#ifdef EYE_POSITION
    v_eye = from_eye;
#endif
#ifdef CLIP
    for (int i = 0; i < 4; ++i) gl_ClipDistance[i] = dot(clip_planes[i].xyz, from_eye) + clip_planes[i].w;
#endif
}
