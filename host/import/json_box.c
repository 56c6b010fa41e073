// Boxes of a JSON scene: their keys, and their faces.
// SPDX-License-Identifier: MIT
#include "json_scene.h"
#include "map_texture.h"

#include <string.h>

static const char *const face_names[] = {"-x", "+x", "-y", "+y", "-z", "+z", NULL};

uint32_t material_flags_of_name(const char *name)
{
    return texture_material_flags(texture_kind_of((map_word){name, strlen(name)})) & MATERIAL_TRANSLUCENT; // others need textures, or are tools
}

static result read_omitted(const json_node *box, uint32_t *out)
{
    json_node list;
    size_t count = 0;
    if (!node_find(box, "omit", &list)) return RESULT_OK;
    result done = node_array(&list, 0, BOX_FACES, &count);
    for (size_t i = 0; i < count && done == RESULT_OK; ++i) {
        size_t face = 0;
        const json_node name = node_item(&list, i);
        done = node_choice(&name, face_names, &face);
        *out |= 1u << face;
    }
    return done;
}

static result read_side(const json_node *box, box_side *out)
{
    static const char *const sides[] = {"out", "in", NULL};
    json_node side;
    size_t chosen = 0;
    if (!node_find(box, "side", &side)) return RESULT_OK;
    const result done = node_choice(&side, sides, &chosen);
    *out = chosen ? BOX_IN : BOX_OUT;
    return done;
}

result box_read(const json_node *n, const char *const *known_keys, json_box *out)
{
    json_node min, max;
    *out = (json_box){.material = "default"};
    result done = node_object(n, known_keys);
    if (done == RESULT_OK) done = node_need(n, "min", &min);
    if (done == RESULT_OK) done = node_need(n, "max", &max);
    if (done == RESULT_OK) done = node_numbers(&min, 3, out->min);
    if (done == RESULT_OK) done = node_numbers(&max, 3, out->max);
    if (done == RESULT_OK) done = node_maybe_text(n, "material", &out->material);
    if (done == RESULT_OK) done = read_side(n, &out->side);
    if (done == RESULT_OK) done = read_omitted(n, &out->omitted);
    if (done != RESULT_OK) return done;
    int faces = 0;
    for (int k = 0; k < 3; ++k)
        if (out->min[k] > out->max[k]) return node_fault(n, "min is above max in %c; write the three least coordinates as min", 'x' + k);
    for (int f = 0; f < BOX_FACES; ++f) faces += box_has_face(out, f);
    return faces ? RESULT_OK : node_fault(n, "no face with an area; make it wider in two directions, omit less, or take it out");
}

int box_has_face(const json_box *b, int face)
{
    const int u = (face / 2 + 1) % 3, v = (face / 2 + 2) % 3;
    return !(b->omitted >> face & 1) && b->max[u] > b->min[u] && b->max[v] > b->min[v];
}

void box_face(const json_box *b, int face, double (*out_points)[3])
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}; // in u, v: counterclockwise seen from +axis
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const int looks_up = (face % 2 == 1) == (b->side == BOX_OUT);
    for (int i = 0; i < 4; ++i) {
        double *p = out_points[looks_up ? i : 3 - i];
        p[axis] = face % 2 ? b->max[axis] : b->min[axis];
        p[u] = around[i][0] ? b->max[u] : b->min[u];
        p[v] = around[i][1] ? b->max[v] : b->min[v];
    }
}
