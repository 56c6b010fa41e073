// Marks translucent triangles of which a fragment passes the finished opaque depth.
layout(early_fragment_tests) in;
layout(std430, binding = 0) buffer seen_block { uint seen[]; }; // a bit per triangle

void main()
{
    if (surface_missing()) return;
    uint bit = 1u << (v_triangle & 31u);
    if ((seen[v_triangle >> 5] & bit) == 0u) atomicOr(seen[v_triangle >> 5], bit); // read first: atomics are slow
}
