// Counts the fragments of a box that pass the depth drawn so far, of the faces that the eye sees: boxes.c. (GL_CULL_FACE would not do: llvmpipe
// may decide it before rounding.)
layout(early_fragment_tests) in;
layout(std430, binding = 0) buffer count_block { uint counts[]; };
flat in uint v_slot;

void main()
{
    atomicAdd(counts[v_slot], 1u);
}
