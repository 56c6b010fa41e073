// A captured picture, shown as the parallelogram that it was taken through, without what its outline (outline.vert) leaves empty: a strip
// of triangles from seam to seam of its columns' strips. Each seam holds what both strips beside it need, so they share it to the bit.
layout(location = 0) uniform mat4 clip_from_eye;
layout(location = 1) uniform vec3 corner; // relative to the eye
layout(location = 2) uniform vec3 right;
layout(location = 3) uniform vec3 up;
layout(location = 10) uniform ivec2 strips; // place of the first one; how many: 0: the whole parallelogram, four vertices
layout(location = 11) uniform vec2 reach;   // width of a strip; height of a texel: between one that is covered and one that is not a part of the way is covered
layout(std430, binding = 5) readonly buffer outline_block { vec2 outlines[]; };
out vec2 v_place;
#ifdef KEEP_DEPTH
layout(location = 4) uniform vec3 taken_corner; // relative to the eye of the capture
layout(location = 5) uniform vec3 taken_right;
layout(location = 6) uniform vec3 taken_up;
layout(location = 7) uniform float taken_near;  // depth 1 in units of the parallelogram's distance
out vec2 v_taken_zw;
#endif

vec2 strip_at(int number)
{
    return outlines[strips.x + clamp(number, 0, strips.y - 1)];
}

// Left of a strip: lowest, highest.
vec2 seam_at(int number)
{
    vec2 a = strip_at(number - 1), b = strip_at(number), rows = vec2(min(a.x, b.x), max(a.y, b.y));
    return rows.x > rows.y ? vec2(0.0) : clamp(rows + reach.y * vec2(-1.0, 1.0), 0.0, 1.0);
}

vec2 place_of(int vertex)
{
    if (strips.y == 0) return vec2(vertex & 1, vertex >> 1);
    int number = vertex >> 1;
    vec2 rows = seam_at(number);
    return vec2(min(float(number) * reach.x, 1.0), (vertex & 1) == 0 ? rows.x : rows.y);
}

void main()
{
    v_place = place_of(gl_VertexID);
    gl_Position = clip_from_eye * vec4(corner + v_place.x * right + v_place.y * up, 1.0);
#ifdef KEEP_DEPTH
    v_taken_zw = (clip_from_eye * vec4(taken_near * (taken_corner + v_place.x * taken_right + v_place.y * taken_up), 0.0)).zw;
#endif
}
