// The id picture: who owns the pixel. Depth errs away from the eye: the raster rounds corners to 1/256 pixel, which tilts
// surfaces seen edge on until they poke through what hides them. 1/128 pixel of slope holds that. No triangle is farther
// than its farthest corner, though: it must not fall behind what it hides.
layout(location = 0) out uint owner; // global triangle + 1
flat in float v_far_depth;

void main()
{
    if (surface_missing()) discard;
    owner = v_triangle + 1u;
    float depth = gl_FragCoord.z;
    gl_FragDepth = min(depth, max(depth - fwidth(depth) / 128.0, v_far_depth));
}
