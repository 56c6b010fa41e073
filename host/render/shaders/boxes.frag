// Counts the fragments of a box that pass the depth drawn so far.
layout(early_fragment_tests) in;
layout(std430, binding = 0) buffer count_block { uint counts[]; };
flat in uint v_slot;

void main()
{
    atomicAdd(counts[v_slot], 1u);
}
