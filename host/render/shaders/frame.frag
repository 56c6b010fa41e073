// One picture for people: shaded, items, zones, depth or overdraw.
layout(location = 0) out vec4 colour;
layout(location = 8) uniform float alpha;       // of this pass
layout(location = 9) uniform vec2 depth_range;  // distances of white and black, metres
#ifdef SHADED
in vec4 v_front;    // as it is seen from in front, lit at the vertices; w: how far its normal points away from the eye, times the distance
flat in uint v_back; // from behind; alpha 0: it has no normal, and this is its paint
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
vec3 shaded()
{
#ifdef FLAT
    if (v_back < 0x01000000u) {
        vec3 face = cross(dFdx(v_eye), dFdy(v_eye));
        face *= dot(face, v_eye) > 0.0 ? -1.0 : 1.0;
        return lit(unpackUnorm4x8(v_back).rgb, face / max(length(face), 1e-30)); // a face of no area has no direction; anything but NaN will do
    }
#endif
    // Seen edge-on a face may turn over when its corners are rounded to the raster's grid: what is all but edge-on is not turned round.
    return !gl_FrontFacing && v_front.w > 0.2 / gl_FragCoord.w ? unpackUnorm4x8(v_back).rgb : v_front.rgb;
}
#endif

void main()
{
    if (surface_missing()) discard;
#if defined(SHADED)
    vec3 c = shaded();
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
