// The input as it grows: see input.h.
// SPDX-License-Identifier: MIT
#include "input.h"

#include <math.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

enum { GRID_AT_FIRST = 256, GRID_MOST = 65536, UNITS_PER_METRE = 32, SLOTS_AT_FIRST = 256 };
static const double WELD_UNITS = 1.0 / 32; // 1 mm: three times the gaps that rounding leaves in published maps (below 0.01)

// ---- Open and close ----

result input_draft_open(const char *path, const input_options *o, const allocator *memory, report *r, input_draft *d)
{
    const double grid = o && o->grid != 0 ? o->grid : GRID_AT_FIRST, weld = o && o->weld != 0 ? o->weld : WELD_UNITS;
    *d = (input_draft){.path = path,
                       .report = r,
                       .shape = brush_shape_make(memory),
                       .before = brush_shape_make(memory),
                       .brushes = buffer_make(memory, sizeof(compile_brush)),
                       .faces = buffer_make(memory, sizeof(compile_face)),
                       .entities = buffer_make(memory, sizeof(compile_entity)),
                       .materials = buffer_make(memory, sizeof(compile_material)),
                       .changes = buffer_make(memory, sizeof(weld_change)),
                       .close = buffer_make(memory, sizeof(uint32_t)),
                       .slots = buffer_make(memory, sizeof(uint32_t)),
                       .planes = buffer_make(memory, sizeof(plane_ref))};
    if (!(grid >= 1 && grid <= GRID_MOST) || grid != floor(grid))
        return report_error(r, path, 0, "a grid of %g steps a unit; give a whole number from 1 to %d", grid, GRID_MOST);
    if (!(weld > 0 && weld <= 1)) return report_error(r, path, 0, "a weld of %g units; give one above 0, up to 1", weld);
    d->grid = (uint32_t)grid;
    d->weld = weld * grid;
    d->in = memory_alloc_zeroed(memory, 1, sizeof *d->in);
    if (!d->in) return report_no_memory(r, path);
    d->in->memory = arena_make(memory);
    d->in->planes = plane_table_make(memory);
    d->in->steps_per_metre = grid * UNITS_PER_METRE;
    d->in->path = arena_text(&d->in->memory, path, strlen(path));
    if (!d->in->planes || !d->in->path || !brush_shape_cube(d->in->planes, d->cube)) return report_no_memory(r, path);
    return RESULT_OK;
}

void input_draft_close(input_draft *d)
{
    buffer *const all[] = {&d->brushes, &d->faces, &d->entities, &d->materials, &d->changes, &d->close, &d->slots, &d->planes};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i) buffer_free(all[i]);
    brush_shape_free(&d->shape);
    brush_shape_free(&d->before);
    compile_input_free(d->in);
    d->in = NULL;
}

void compile_input_free(compile_input *in)
{
    if (!in) return;
    const allocator *memory = in->memory.memory;
    plane_table_free(in->planes);
    scene_builder_close(in->beside);
    arena_free(&in->memory);
    memory_free(memory, in, 1, sizeof *in);
}

// ---- Materials ----

static size_t material_slot(const input_draft *d, const char *name, size_t length)
{
    const uint32_t *slots = d->slots.items;
    const compile_material *materials = d->materials.items;
    const size_t mask = d->slots.count - 1;
    size_t at = XXH3_64bits(name, length) & mask;
    for (; slots[at]; at = (at + 1) & mask) {
        const char *other = materials[slots[at] - 1].name;
        if (strlen(other) == length && memcmp(other, name, length) == 0) break;
    }
    return at;
}

static int grow_slots(input_draft *d)
{
    if (d->slots.count > 2 * (d->materials.count + 1)) return 1;
    const size_t size = d->slots.count ? d->slots.count * 2 : SLOTS_AT_FIRST;
    d->slots.count = 0;
    uint32_t *slots = buffer_push(&d->slots, size);
    if (!slots) return 0;
    memset(slots, 0, size * sizeof *slots);
    const compile_material *materials = d->materials.items;
    for (uint32_t i = 0; i < d->materials.count; ++i) slots[material_slot(d, materials[i].name, strlen(materials[i].name))] = i + 1;
    return 1;
}

uint32_t input_draft_material(input_draft *d, const char *name, size_t length, uint32_t flags)
{
    if (!grow_slots(d)) return UINT32_MAX;
    const size_t at = material_slot(d, name, length);
    uint32_t *slots = d->slots.items;
    if (slots[at]) return slots[at] - 1;
    const compile_material made = {arena_text(&d->in->memory, name, length), flags};
    if (!made.name || !buffer_append(&d->materials, &made, 1)) return UINT32_MAX;
    slots[at] = (uint32_t)d->materials.count;
    return slots[at] - 1;
}

// ---- Brushes ----

// Each plane once, its first face kept.
static result take_planes(input_draft *d, const compile_face *faces, uint32_t count, const char *where, buffer *kept)
{
    d->planes.count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const plane_ref *planes = d->planes.items;
        size_t same = 0;
        while (same < d->planes.count && planes[same] != faces[i].plane) same++;
        if (same < d->planes.count) {
            report_warning(d->report, d->path, faces[i].line, "%s: a face on the same plane as an earlier one; dropped", where);
            continue;
        }
        if (!buffer_append(&d->planes, &faces[i].plane, 1) || !buffer_append(kept, &i, 1)) return report_no_memory(d->report, d->path);
    }
    return RESULT_OK;
}

// What most faces of the brush show, of those that are opaque; of several the first by name, so that no order of the faces decides.
static uint32_t usual_material(const input_draft *d, const compile_face *faces, uint32_t count)
{
    const compile_material *materials = d->materials.items;
    uint32_t best = COMPILE_NOTHING, most = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t material = faces[i].material;
        if (material == COMPILE_NOTHING || materials[material].flags & (MATERIAL_TRANSLUCENT | MATERIAL_CUT_OUT)) continue;
        uint32_t uses = 0;
        for (uint32_t k = 0; k < count; ++k) uses += faces[k].material == material;
        if (uses < most || (uses == most && strcmp(materials[material].name, materials[best].name) >= 0)) continue;
        best = material;
        most = uses;
    }
    return best;
}

// A side without a material (skip ...) of structure bounds air like any other. Left out, one looks through it into the rock and on
// into rooms that no zone's portals lead to.
static void close_holes(const input_draft *d, compile_face *faces, uint32_t count)
{
    uint32_t holes = 0;
    for (uint32_t i = 0; i < count; ++i) holes += faces[i].material == COMPILE_NOTHING;
    const uint32_t usual = holes ? usual_material(d, faces, count) : COMPILE_NOTHING;
    for (uint32_t i = 0; i < count && holes; ++i)
        if (faces[i].material == COMPILE_NOTHING) faces[i].material = usual;
}

static result add_cut_brush(input_draft *d, const compile_brush *brush, const compile_face *faces, const uint32_t *kept)
{
    compile_brush made = *brush;
    made.first_face = (uint32_t)d->faces.count;
    made.face_count = (uint32_t)d->shape.faces.count;
    brush_shape_bounds(&d->shape, d->in->planes, made.min, made.max);
    compile_face *to = buffer_push(&d->faces, made.face_count);
    const uint32_t number = (uint32_t)d->brushes.count;
    if (!to || !buffer_append(&d->brushes, &made, 1)) return report_no_memory(d->report, d->path);
    if (shape_close_pairs(&d->shape, d->in->planes, d->weld) && !buffer_append(&d->close, &number, 1)) return report_no_memory(d->report, d->path);
    const shape_face *from = d->shape.faces.items;
    for (uint32_t i = 0; i < made.face_count; ++i) to[i] = faces[kept[from[i].face]];
    if (made.role == BRUSH_STRUCTURE) close_holes(d, to, made.face_count);
    return RESULT_OK;
}

result input_draft_brush(input_draft *d, const compile_brush *brush, const compile_face *faces, uint32_t count, const char *where, uint32_t line,
                         brush_verdict *out)
{
    *out = BRUSH_DROPPED;
    buffer kept = buffer_make(d->faces.memory, sizeof(uint32_t));
    result done = take_planes(d, faces, count, where, &kept);
    if (done == RESULT_OK) {
        switch (brush_shape_cut(&d->shape, d->in->planes, d->cube, d->planes.items, (uint32_t)d->planes.count)) {
        case SHAPE_SOUND:
            done = add_cut_brush(d, brush, faces, kept.items);
            *out = BRUSH_TAKEN;
            break;
        case SHAPE_OPEN: done = report_error(d->report, d->path, line, "%s: its faces leave it open; add the side that is missing", where); break;
        case SHAPE_EMPTY:
            report_warning(d->report, d->path, line, "%s: its faces leave nothing; dropped", where);
            d->in->brushes_dropped++;
            break;
        case SHAPE_NO_MEMORY: done = report_no_memory(d->report, d->path); break;
        }
    }
    buffer_free(&kept);
    return done;
}

// ---- Finish ----

static void *to_arena(input_draft *d, const buffer *from)
{
    void *to = arena_push(&d->in->memory, from->count ? from->count : 1, from->item_size);
    if (to && from->count) memcpy(to, from->items, from->count * from->item_size);
    return to;
}

result input_draft_finish(input_draft *d, compile_input **out)
{
    result done = input_snap_corners(d);
    if (done == RESULT_OK) done = input_weld_planes(d);
    if (done == RESULT_OK) done = input_join_corners(d);
    if (done != RESULT_OK) return done;
    compile_input *in = d->in;
    in->brushes = to_arena(d, &d->brushes);
    in->faces = to_arena(d, &d->faces);
    in->entities = to_arena(d, &d->entities);
    in->materials = to_arena(d, &d->materials);
    in->changes = to_arena(d, &d->changes);
    if (!in->brushes || !in->faces || !in->entities || !in->materials || !in->changes) return report_no_memory(d->report, d->path);
    in->brush_count = (uint32_t)d->brushes.count;
    in->face_count = (uint32_t)d->faces.count;
    in->entity_count = (uint32_t)d->entities.count;
    in->material_count = (uint32_t)d->materials.count;
    in->weld_moves = (uint32_t)d->changes.count;
    *out = in;
    d->in = NULL;
    return RESULT_OK;
}
