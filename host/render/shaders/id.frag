// The id picture: who owns the pixel. Depth errs away from the eye: the raster rounds corners to 1/256 pixel, which tilts
// surfaces seen edge on until they poke through what hides them. 1/128 pixel of slope holds that. No triangle is farther
// than its farthest corner, though, or nearer than its nearest, wherever the tilt takes its plane: it must not fall behind
// what it hides.
layout(location = 0) out uint owner; // global triangle + 1
flat in float v_far_depth, v_near_depth;

void main()
{
    float depth = gl_FragCoord.z;
    float slope = fwidth(depth); // before any discard: its neighbours must still be there
    if (surface_missing()) discard;
    owner = v_triangle + 1u;
    gl_FragDepth = clamp(depth - slope / 128.0, v_far_depth, v_near_depth);
}
