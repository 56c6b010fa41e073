// Counts the fragments of a box that pass the depth drawn so far. A closed surface covers each pixel as often from the
// front as from behind, however its corners were rounded, and the eye is outside: front faces say all. (GL_CULL_FACE
// would not do: llvmpipe may decide it before rounding.)
layout(early_fragment_tests) in;
layout(std430, binding = 0) buffer count_block { uint counts[]; };
flat in uint v_slot;

void main()
{
    if (gl_FrontFacing) atomicAdd(counts[v_slot], 1u);
}
