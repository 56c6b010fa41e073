// One picture for people: shaded, items, zones, depth or overdraw.
layout(location = 0) out vec4 colour;
layout(location = 8) uniform float alpha;       // of this pass
layout(location = 9) uniform vec2 depth_range;  // distances of white and black, metres
#ifdef SHADED
layout(std430, binding = 1) readonly buffer material_block { uint material_colours[]; };
in vec3 v_normal;
#endif
#ifdef EYE_POSITION
in vec3 v_eye;
#endif
#if defined(ITEMS) || defined(ZONES)
layout(std430, binding = 2) readonly buffer item_block { uint triangle_items[]; };
#endif
#ifdef ZONES
layout(std430, binding = 3) readonly buffer zone_block { uint item_zones[]; }; // the first that lists it, + 1; 0: none
#endif

vec3 hashed_colour(uint n)
{
    n = (n ^ 61u) ^ (n >> 16);
    n *= 9u;
    n ^= n >> 4;
    n *= 0x27d4eb2du;
    n ^= n >> 15;
    return 0.25 + 0.75 * vec3(n & 255u, (n >> 8) & 255u, (n >> 16) & 255u) / 255.0;
}

#ifdef SHADED
vec3 lit(vec3 albedo)
{
    vec3 face = cross(dFdx(v_eye), dFdy(v_eye));
    // Seen edge-on a face may turn over when its corners are rounded to the raster's grid: what is all but edge-on is not turned round.
    bool is_behind = !gl_FrontFacing && dot(v_normal, v_eye) > 0.2 * length(v_eye);
    vec3 n = dot(v_normal, v_normal) > 0.25 ? v_normal * (is_behind ? -1.0 : 1.0) : face * (dot(face, v_eye) > 0.0 ? -1.0 : 1.0);
    n = n / max(length(n), 1e-30); // a face of no area has no direction; anything but NaN will do
    float sun = max(dot(n, vec3(0.47, 0.80, 0.37)), 0.0);
    float fill = max(dot(n, vec3(-0.70, 0.25, -0.67)), 0.0);
    return albedo * (vec3(0.42, 0.44, 0.48) + 0.10 * n.y + sun * vec3(0.56, 0.52, 0.44) + fill * vec3(0.17, 0.20, 0.24));
}
#endif

void main()
{
    if (surface_missing()) discard;
#if defined(SHADED)
    vec3 albedo = unpackUnorm4x8(material_colours[v_word & 0xffffu]).rgb;
    vec3 c = (v_word & WORD_SKY) != 0u ? vec3(0.47, 0.70, 0.96) : lit(albedo);
#elif defined(ITEMS)
    vec3 c = hashed_colour(triangle_items[v_triangle]);
#elif defined(ZONES)
    vec3 face = cross(dFdx(v_eye), dFdy(v_eye));
    vec3 c = hashed_colour(16u + item_zones[triangle_items[v_triangle]]) * (0.75 + 0.25 * face.y / max(length(face), 1e-30));
#elif defined(DEPTH)
    float far = log2(depth_range.y / depth_range.x);
    vec3 c = vec3(1.0 - clamp(log2(max(length(v_eye), 1e-30) / depth_range.x) / far, 0.0, 1.0));
#else
    vec3 c = vec3(1.0); // OVERDRAW: added up, a palette comes later
#endif
    colour = vec4(c, alpha);
}
