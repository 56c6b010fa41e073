// What a mesh file says: see mesh_soup.h.
// SPDX-License-Identifier: MIT
#include "mesh_soup.h"

#include <string.h>

mesh_soup soup_make(const allocator *memory)
{
    return (mesh_soup){
        .positions = buffer_make(memory, 3 * sizeof(double)),
        .texcoords = buffer_make(memory, 2 * sizeof(float)),
        .corners = buffer_make(memory, sizeof(soup_corner)),
        .polygons = buffer_make(memory, sizeof(soup_polygon)),
        .objects = buffer_make(memory, sizeof(soup_object)),
        .materials = buffer_make(memory, sizeof(soup_name)),
    };
}

void soup_free(mesh_soup *s)
{
    buffer_free(&s->positions);
    buffer_free(&s->texcoords);
    buffer_free(&s->corners);
    buffer_free(&s->polygons);
    buffer_free(&s->objects);
    buffer_free(&s->materials);
}

void soup_use(soup_largest *l, uint64_t index, size_t line)
{
    if (l->is_used && index <= l->index) return;
    *l = (soup_largest){index, line, 1};
}

result soup_polygon_end(mesh_soup *s, size_t first_corner, uint32_t material)
{
    if (s->corners.count > UINT32_MAX || s->polygons.count >= UINT32_MAX) return RESULT_BAD_INPUT;
    soup_polygon *p = buffer_push(&s->polygons, 1);
    if (!p) return RESULT_NO_MEMORY;
    *p = (soup_polygon){(uint32_t)first_corner, (uint32_t)(s->corners.count - first_corner), material};
    return RESULT_OK;
}

soup_name soup_file_stem(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return (soup_name){name, dot && dot > name ? (size_t)(dot - name) : strlen(name)};
}
