// See brushes.h.
// SPDX-License-Identifier: MIT
#include "brushes.h"

#include "support.h"

#include <stdio.h>
#include <string.h>

void map_add(map_text *m, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(m->text + m->size, sizeof m->text - m->size, format, values);
    va_end(values);
    assert_true(length >= 0 && (size_t)length < sizeof m->text - m->size);
    m->size += (size_t)length;
}

void box_faces(const double min[3], const double max[3], point_set faces[6])
{
    for (int f = 0; f < 6; ++f) {
        const int axis = f / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        double(*p)[3] = faces[f].points;
        for (int i = 0; i < 3; ++i) {
            memcpy(p[i], min, sizeof p[i]);
            if (f % 2) p[i][axis] = max[axis];
        }
        const int first = f % 2 ? u : v, last = f % 2 ? v : u; // (p0 - p1) x (p2 - p1) points out
        p[0][first] = max[first];
        p[2][last] = max[last];
    }
}

void map_add_faces(map_text *m, const point_set *faces, int count, const char *texture)
{
    map_add(m, "{\n");
    for (int f = 0; f < count; ++f) {
        for (int i = 0; i < 3; ++i)
            map_add(m, "( %.17g %.17g %.17g ) ", faces[f].points[i][0], faces[f].points[i][1], faces[f].points[i][2]);
        map_add(m, "%s 0 0 0 1 1\n", texture);
    }
    map_add(m, "}\n");
}

void map_add_box(map_text *m, const double min[3], const double max[3], const char *texture)
{
    point_set faces[6];
    box_faces(min, max, faces);
    map_add_faces(m, faces, 6, texture);
}
