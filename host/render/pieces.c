// Pieces of a layout: the scene's vertices and the pieces' in one set of buffers, and tables from items to pieces to indices.
// SPDX-License-Identifier: MIT
// Invariant: all that a frame needs is taken here; an item whose pieces do not cover it once has none, and goes by distance.
#include "pieces.h"

#include "../core/report.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// ---- Closing ----

static void close_zone(pieces_zone *z, const allocator *memory)
{
    memory_free(memory, z->item_first, (size_t)z->place_count + 1, sizeof *z->item_first);
    memory_free(memory, z->entries, z->place_count, sizeof *z->entries);
    memory_free(memory, z->rows, z->place_count, sizeof *z->rows);
    memory_free(memory, z->row_places, z->place_count, sizeof *z->row_places);
    whole_order_close(&z->whole, memory);
    memory_free(memory, z->numbers, z->number_room, sizeof *z->numbers);
    memory_free(memory, z->wanted, z->number_room, sizeof *z->wanted);
    memory_free(memory, z->spans, z->number_room, sizeof *z->spans);
    *z = (pieces_zone){0};
}

void pieces_close(render_layout *l)
{
    layout_pieces *p = l->pieces;
    const allocator *memory = l->g->memory;
    if (!p) return;
    const vertex_buffers *v = &p->buffers;
    const GLuint buffers[] = {v->positions, v->words, v->triangles, v->texcoords, v->normals, v->paints, v->others, v->movers, p->elements};
    glDeleteVertexArrays(1, &p->vertices);
    glDeleteBuffers((GLsizei)(sizeof buffers / sizeof *buffers), buffers);
    l->g->state.vertices = 0; // its name may come again
    for (uint32_t z = 0; p->zones && z < l->zone_count; ++z) close_zone(&p->zones[z], memory);
    memory_free(memory, p->zones, l->zone_count, sizeof *p->zones);
    zone_order_close(&p->order, memory);
    buffer_free(&p->indices);
    memory_free(memory, p->numbers, p->number_room, sizeof *p->numbers);
    memory_free(memory, p->places, p->item_room, 3 * sizeof *p->places);
    memory_free(memory, p->knots, p->item_room, sizeof *p->knots);
    memory_free(memory, p->scratch, p->scratch_room, 1);
    memory_free(memory, p->staged, p->staged_room, sizeof *p->staged);
    memory_free(memory, p->draws, p->draw_room, sizeof *p->draws);
    memory_free(memory, p, 1, sizeof *p);
    l->pieces = NULL;
}

void pieces_forget_zone(render_layout *l, uint32_t zone)
{
    if (l->pieces) l->pieces->zones[zone].lent = NULL;
}

// ---- A zone's ----

typedef struct making {
    render_layout *l;
    layout_pieces *p;
    pieces_mesh mesh;
    uint32_t refused; // items
} making;

static int is_see_through(const render_layout *l, uint32_t zone, uint32_t place)
{
    return l->g->scene.is_see_through[layout_item(l, l->zones[zone].first_place + place)];
}

// Pieces of see-through items, item by item.
static void sort_by_item(const making *k, uint32_t zone, const cull_pieces *lent)
{
    pieces_zone *z = &k->p->zones[zone];
    for (uint32_t i = 0; i < lent->piece_count; ++i)
        if (is_see_through(k->l, zone, lent->pieces[i].item)) z->item_first[lent->pieces[i].item + 1]++;
    for (uint32_t i = 0; i < z->place_count; ++i) {
        z->item_first[i + 1] += z->item_first[i];
        z->entries[i] = z->item_first[i]; // where its next one goes
    }
    for (uint32_t i = 0; i < lent->piece_count; ++i)
        if (is_see_through(k->l, zone, lent->pieces[i].item)) z->numbers[z->entries[lent->pieces[i].item]++] = i;
    z->number_count = z->item_first[z->place_count];
}

// Triangles of all pieces; items that they do not cover lose them.
static result cut_items(making *k, uint32_t zone, const cull_pieces *lent)
{
    pieces_zone *z = &k->p->zones[zone];
    pieces_mesh_request q = {.scene = k->l->g->scene.scene, .lent = lent};
    uint32_t kept = 0, first = 0;
    piece_span *spans = memory_alloc(k->l->g->memory, z->number_count, sizeof *spans); // of one item
    layout_zone_offset(k->l->g, zone, q.offset);
    result done = spans ? RESULT_OK : RESULT_NO_MEMORY;
    for (uint32_t place = 0; place < z->place_count && done == RESULT_OK; ++place) {
        const uint32_t end = z->item_first[place + 1];
        q.numbers = z->numbers + first;
        q.count = end - first;
        q.item = layout_item(k->l, k->l->zones[zone].first_place + place);
        z->item_first[place] = kept;
        first = end;
        if (!q.count) continue;
        done = pieces_mesh_item(&k->mesh, &q, spans);
        if (done == RESULT_BAD_INPUT) {
            k->refused++;
            done = RESULT_OK;
            continue;
        }
        for (uint32_t i = 0; i < q.count && done == RESULT_OK; ++i) {
            z->spans[q.numbers[i]] = spans[i];
            z->numbers[kept++] = q.numbers[i]; // never beyond what is read
        }
    }
    memory_free(k->l->g->memory, spans, z->number_count, sizeof *spans);
    z->item_first[z->place_count] = z->number_count = kept;
    return done;
}

static int lends_see_through(const render_layout *l, uint32_t zone, const cull_pieces *lent)
{
    for (uint32_t i = 0; lent && i < lent->piece_count; ++i) {
        assert(lent->pieces[i].item < l->zones[zone].count);
        if (is_see_through(l, zone, lent->pieces[i].item)) return 1;
    }
    return 0;
}

// Who hides whom, of items with pieces.
static result order_items(making *k, uint32_t zone)
{
    const allocator *memory = k->l->g->memory;
    pieces_zone *z = &k->p->zones[zone];
    uint32_t *items = memory_alloc(memory, z->place_count, sizeof *items);
    if (!items) return RESULT_NO_MEMORY;
    for (uint32_t place = 0; place < z->place_count; ++place) {
        if (z->item_first[place] == z->item_first[place + 1]) continue;
        z->rows[place] = z->item_count;
        z->row_places[z->item_count] = place;
        items[z->item_count++] = layout_item(k->l, k->l->zones[zone].first_place + place);
    }
    const whole_request q = {k->l->g->scene.scene, items, z->item_count};
    const result done = whole_order_open(&q, memory, &z->whole);
    memory_free(memory, items, z->place_count, sizeof *items);
    return done;
}

static result make_zone(making *k, uint32_t zone, const cull_pieces *lent)
{
    const allocator *memory = k->l->g->memory;
    pieces_zone *z = &k->p->zones[zone];
    if (!lends_see_through(k->l, zone, lent)) return RESULT_OK;
    z->place_count = k->l->zones[zone].count;
    z->number_room = lent->piece_count;
    z->item_first = memory_alloc_zeroed(memory, (size_t)z->place_count + 1, sizeof *z->item_first);
    z->entries = memory_alloc_zeroed(memory, z->place_count, sizeof *z->entries);
    z->rows = memory_alloc(memory, z->place_count, sizeof *z->rows);
    z->row_places = memory_alloc(memory, z->place_count, sizeof *z->row_places);
    z->numbers = memory_alloc(memory, z->number_room, sizeof *z->numbers);
    z->wanted = memory_alloc_zeroed(memory, z->number_room, sizeof *z->wanted);
    z->spans = memory_alloc_zeroed(memory, z->number_room, sizeof *z->spans);
    if (!z->item_first || !z->entries || !z->rows || !z->row_places || !z->numbers || !z->wanted || !z->spans) return RESULT_NO_MEMORY;
    sort_by_item(k, zone, lent);
    const result cut = cut_items(k, zone, lent);
    if (cut != RESULT_OK || !z->number_count) return cut;
    z->lent = lent;
    return order_items(k, zone);
}

// ---- Vertices ----

// The scene's, with room behind for the pieces'.
static GLuint longer(GLuint from, size_t stride, size_t count, size_t more)
{
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, (GLsizeiptr)((count + more) * stride + 4), NULL, GL_DYNAMIC_STORAGE_BIT);
    glCopyNamedBufferSubData(from, name, 0, 0, (GLsizeiptr)(count * stride));
    return name;
}

typedef struct source { const scene *s; const uint32_t *indices, *words; } source; // indices: turned, see gl.h

static uint32_t normal_of(const source *from, const piece_vertex *v)
{
    const uint32_t *at = from->s->indices + (size_t)3 * v->triangle;
    uint32_t packed = 0;
    for (int k = 0; k < 3; ++k)
        if (v->weights[k] == 1) return from->s->normals[at[k]];
    for (uint32_t shift = 0; shift < 24; shift += 8) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += v->weights[k] * (int8_t)(uint8_t)(from->s->normals[at[k]] >> shift);
        packed |= (uint32_t)(uint8_t)(int8_t)lrint(fmin(fmax(sum, -127), 127)) << shift;
    }
    return packed;
}

static void texcoord_of(const source *from, const piece_vertex *v, float out[2])
{
    const uint32_t *at = from->s->indices + (size_t)3 * v->triangle;
    for (int i = 0; i < 2; ++i) {
        double sum = 0;
        for (int k = 0; k < 3; ++k)
            if (v->weights[k] != 0) sum += v->weights[k] * (double)from->s->texcoords[2 * (size_t)at[k] + (size_t)i];
        out[i] = (float)sum;
    }
}

// Only the last vertex of a triangle says whether it has two sides.
static uint32_t word_of(const source *from, const piece_vertex *v)
{
    const uint32_t word = from->words[from->indices[(size_t)3 * v->triangle + 2]];
    return v->is_centre ? word : word & ~(uint32_t)WORD_TWO_SIDED;
}

// One attribute of all pieces' vertices, as the buffer has it.
typedef enum attribute_kind { POSITIONS, WORDS, TRIANGLES, TEXCOORDS, NORMALS, PAINTS, ZEROS } attribute_kind;
static void write_attribute(const source *from, attribute_kind kind, const pieces_mesh *mesh, uint32_t *out)
{
    const piece_vertex *v = mesh->vertices.items;
    for (size_t i = 0; i < mesh->vertices.count; ++i) {
        if (kind == POSITIONS) memcpy(out + 3 * i, &v[i].position, sizeof v[i].position);
        if (kind == WORDS) out[i] = word_of(from, &v[i]);
        if (kind == TRIANGLES) out[i] = v[i].triangle;
        if (kind == PAINTS) out[i] = from->s->materials[word_of(from, &v[i]) & 0xffffu].colour;
        if (kind == NORMALS) out[i] = normal_of(from, &v[i]);
        if (kind == TEXCOORDS) {
            float at[2];
            texcoord_of(from, &v[i], at);
            memcpy(out + 2 * i, at, sizeof at);
        }
    }
}

static void append(const making *k, const source *from, attribute_kind kind, GLuint scene_buffer, size_t stride, uint32_t *room, GLuint *out)
{
    const size_t count = k->l->g->scene.vertex_count, more = k->mesh.vertices.count;
    if (!scene_buffer) return;
    *out = longer(scene_buffer, stride, count, more);
    if (kind == ZEROS) memset(room, 0, more * stride);
    else write_attribute(from, kind, &k->mesh, room);
    glNamedBufferSubData(*out, (GLintptr)(count * stride), (GLsizeiptr)(more * stride), room);
}

static result make_vertices(making *k)
{
    renderer *g = k->l->g;
    const scene_gpu *s = &g->scene;
    vertex_buffers *b = &k->p->buffers;
    const size_t more = k->mesh.vertices.count;
    if (more > UINT32_MAX - s->vertex_count) return RESULT_NO_MEMORY;
    uint32_t *room = memory_alloc(g->memory, more, 6 * sizeof *room); // of the widest attribute
    uint32_t *words = memory_alloc(g->memory, s->vertex_count, sizeof *words);
    if (room && words) {
        glGetNamedBufferSubData(s->buffers.words, 0, (GLsizeiptr)(s->vertex_count * sizeof *words), words);
        const source from = {s->scene, s->indices, words};
        append(k, &from, POSITIONS, s->buffers.positions, 12, room, &b->positions);
        append(k, &from, WORDS, s->buffers.words, 4, room, &b->words);
        append(k, &from, TRIANGLES, s->buffers.triangles, 4, room, &b->triangles);
        append(k, &from, TEXCOORDS, s->buffers.texcoords, 8, room, &b->texcoords);
        append(k, &from, NORMALS, s->buffers.normals, 4, room, &b->normals);
        append(k, &from, PAINTS, s->buffers.paints, 4, room, &b->paints);
        append(k, &from, ZEROS, s->buffers.others, 24, room, &b->others);
        append(k, &from, ZEROS, s->buffers.movers, 4, room, &b->movers);
    }
    memory_free(g->memory, words, s->vertex_count, sizeof *words);
    memory_free(g->memory, room, more, 6 * sizeof *room);
    if (!room || !words) return RESULT_NO_MEMORY;
    uint32_t *indices = k->mesh.indices.items;
    for (size_t i = 0; i < k->mesh.indices.count; ++i) indices[i] += s->vertex_count;
    return RESULT_OK;
}

// ---- Room for frames ----

// Indices that the see-through things of all zones take at most, whole or in pieces.
static size_t staged_most(const making *k, size_t *out_things)
{
    const render_layout *l = k->l;
    const scene *s = l->g->scene.scene;
    size_t sum = k->mesh.indices.count;
    *out_things = 0;
    for (uint32_t place = 0; place < l->total; ++place) {
        const uint32_t item = layout_item(l, place);
        if (!l->g->scene.is_see_through[item]) continue;
        sum += s->items[item].index_count;
        ++*out_things;
    }
    return sum;
}

static result make_room(making *k)
{
    layout_pieces *p = k->p;
    const allocator *memory = k->l->g->memory;
    size_t pieces = 0, things;
    for (uint32_t z = 0; z < k->l->zone_count; ++z) {
        const pieces_zone *zone = &p->zones[z];
        if (!zone->lent) continue;
        pieces += zone->number_count;
        p->number_room = zone->number_count > p->number_room ? zone->number_count : p->number_room;
        p->item_room = zone->item_count > p->item_room ? zone->item_count : p->item_room;
        p->scratch_room = zone->lent->scratch_size > p->scratch_room ? zone->lent->scratch_size : p->scratch_room;
    }
    p->staged_room = staged_most(k, &things);
    p->draw_room = pieces + things;
    if (p->staged_room > INT32_MAX) return RESULT_NO_MEMORY; // one draw takes no more
    p->numbers = memory_alloc(memory, p->number_room, sizeof *p->numbers);
    p->places = memory_alloc(memory, p->item_room, 3 * sizeof *p->places);
    p->knots = memory_alloc(memory, p->item_room, sizeof *p->knots);
    p->scratch = memory_alloc(memory, p->scratch_room, 1);
    p->staged = memory_alloc(memory, p->staged_room, sizeof *p->staged);
    p->draws = memory_alloc(memory, p->draw_room, sizeof *p->draws);
    if (!p->numbers || !p->places || !p->knots || !p->scratch || !p->staged || !p->draws) return RESULT_NO_MEMORY;
    const uint32_t zones = k->l->g->scene.scene->zone_count;
    if (zone_order_open(k->l->zone_count > zones ? k->l->zone_count : zones, memory, &p->order) != RESULT_OK) return RESULT_NO_MEMORY;
    glCreateBuffers(1, &p->elements);
    glNamedBufferStorage(p->elements, (GLsizeiptr)(p->staged_room * sizeof(uint32_t) + 4), NULL, GL_DYNAMIC_STORAGE_BIT);
    return RESULT_OK;
}

// ---- All ----

static result make_all(making *k, const cull_pieces *const *pieces)
{
    result done = RESULT_OK;
    k->p->zones = memory_alloc_zeroed(k->l->g->memory, k->l->zone_count, sizeof *k->p->zones);
    if (!k->p->zones) return RESULT_NO_MEMORY;
    for (uint32_t z = 0; z < k->l->zone_count && done == RESULT_OK; ++z) done = make_zone(k, z, pieces[z]);
    if (done == RESULT_OK && k->mesh.indices.count) done = make_vertices(k);
    if (done == RESULT_OK && k->mesh.indices.count) done = make_room(k);
    if (done != RESULT_OK || !k->mesh.indices.count) return done;
    k->p->vertices = vertex_array_of(&k->p->buffers, k->p->elements);
    k->p->indices = k->mesh.indices;
    k->mesh.indices = buffer_make(k->l->g->memory, sizeof(uint32_t));
    return RESULT_OK;
}

static int any_lends(const render_layout *l, const cull_pieces *const *pieces)
{
    for (uint32_t z = 0; z < l->zone_count; ++z)
        if (lends_see_through(l, z, pieces[z])) return 1;
    return 0;
}

result render_layout_pieces(render_layout *l, const cull_pieces *const *pieces, report *r)
{
    renderer *g = l->g;
    const char *path = g->scene.scene->path;
    assert(!g->frame.open);
    pieces_close(l);
    if (!l->see_through || !any_lends(l, pieces)) return RESULT_OK;
    making k = {.l = l, .p = memory_alloc_zeroed(g->memory, 1, sizeof *k.p), .mesh = pieces_mesh_make(g->memory)};
    l->pieces = k.p;
    result done = k.p ? make_all(&k, pieces) : RESULT_NO_MEMORY;
    const int is_empty = done == RESULT_OK && !k.p->vertices;
    pieces_mesh_free(&k.mesh);
    if (done == RESULT_NO_MEMORY) report_no_memory(r, path);
    else done = gl_check(g, r, "cutting see-through items");
    if (done != RESULT_OK || is_empty) pieces_close(l);
    if (k.refused) report_warning(r, path, 0, "pieces of %u see-through items do not cover them once; they are put in order by distance", k.refused);
    return done;
}
