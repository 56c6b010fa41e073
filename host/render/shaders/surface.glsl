// What every fragment of the scene asks first: is there any surface here?
flat in uint v_triangle;
#if defined(CUT_OUT) || defined(SIDES)
flat in uint v_word;
#endif
#ifdef CUT_OUT
in vec2 v_texcoord;
#endif

// An alpha-tested surface is a grate: bars a quarter of a 1/4 texture wide, for no texture exists.
bool surface_missing()
{
#ifdef CUT_OUT
    vec2 bar = fract(4.0 * v_texcoord);
    if ((v_word & WORD_CUT_OUT) != 0u && bar.x > 0.25 && bar.y > 0.25) return true;
#endif
#ifdef SIDES
    if (!gl_FrontFacing && (v_word & WORD_TWO_SIDED) == 0u) return true;
#endif
    return false;
}
