// The id picture: who owns the pixel.
layout(location = 0) out uint owner; // global triangle + 1

void main()
{
    if (surface_missing()) discard;
    owner = v_triangle + 1u;
}
