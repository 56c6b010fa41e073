// Upload: one vertex buffer set for every picture of a scene.
// SPDX-License-Identifier: MIT
// Invariant: each triangle's last vertex is its own and carries its global number, so the number reaches the fragments
// flat, in any draw and any order of the index buffer. (gl_PrimitiveID needs a base per draw and is 1.5x slower on llvmpipe.)
#include "levels.h"

#include <string.h>

// Positions double where every vertex of a triangle is another's last already; about T - V + T/2 times in a closed mesh.
typedef struct upload {
    const scene *s;
    uint32_t *owners;  // per vertex: triangle + 1 that it is the last of, 0: none
    uint8_t *flags;    // per vertex: WORD_* >> 16
    buffer doubled;    // uint32_t: the vertex that is doubled
    buffer doubled_owners; // uint32_t: triangle
} upload;

static result upload_open(const scene *s, const allocator *memory, upload *u)
{
    *u = (upload){.s = s};
    u->doubled = buffer_make(memory, sizeof(uint32_t));
    u->doubled_owners = buffer_make(memory, sizeof(uint32_t));
    u->owners = memory_alloc_zeroed(memory, s->position_count, sizeof *u->owners);
    u->flags = memory_alloc_zeroed(memory, s->position_count, sizeof *u->flags);
    return u->owners && u->flags ? RESULT_OK : RESULT_NO_MEMORY;
}

static void upload_close(upload *u, const allocator *memory)
{
    memory_free(memory, u->owners, u->s->position_count, sizeof *u->owners);
    memory_free(memory, u->flags, u->s->position_count, sizeof *u->flags);
    buffer_free(&u->doubled);
    buffer_free(&u->doubled_owners);
}

static uint8_t flags_of_material(const scene *s, uint32_t vertex)
{
    const uint32_t flags = s->materials[s->vertex_materials[vertex]].flags;
    return (uint8_t)((flags & MATERIAL_TRANSLUCENT ? WORD_TRANSLUCENT >> 16 : 0) | (flags & MATERIAL_CUT_OUT ? WORD_CUT_OUT >> 16 : 0) |
                     (flags & MATERIAL_SKY ? WORD_SKY >> 16 : 0));
}

// A vertex is what its material says, and what the flags of the items that use it say.
static void flag_vertices(upload *u, uint32_t item_total)
{
    const scene *s = u->s;
    for (uint32_t v = 0; v < s->position_count; ++v) u->flags[v] = flags_of_material(s, v);
    for (uint32_t i = 0; i < item_total; ++i) {
        const scene_item *item = &s->items[i];
        const uint32_t more = (item->flags & CULL_ITEM_SEE_THROUGH ? WORD_TRANSLUCENT >> 16 : 0) | (item->flags & CULL_ITEM_CUT_OUT ? WORD_CUT_OUT >> 16 : 0);
        if (!more || i >= s->item_count) continue; // a mover's flags speak of some of its triangles only
        for (uint32_t k = 0; k < item->index_count; ++k) u->flags[s->indices[item->first_index + k]] |= (uint8_t)more;
    }
}

static int corners_agree(const upload *u)
{
    const uint32_t *i = u->s->indices;
    const uint32_t asked = (WORD_TRANSLUCENT | WORD_CUT_OUT) >> 16;
    for (uint32_t k = 0; k < u->s->index_count; k += 3)
        if (((u->flags[i[k]] ^ u->flags[i[k + 1]]) | (u->flags[i[k]] ^ u->flags[i[k + 2]])) & asked) return 0;
    return 1;
}

// Turns the triangle, keeping its sense, so that a free vertex comes last; else doubles the last.
static int own_last_vertex(upload *u, uint32_t triangle, uint32_t corners[3])
{
    for (int turn = 0; turn < 3; ++turn) {
        if (!u->owners[corners[2]]) {
            u->owners[corners[2]] = triangle + 1;
            return 1;
        }
        const uint32_t last = corners[2];
        corners[2] = corners[1];
        corners[1] = corners[0];
        corners[0] = last;
    }
    if (u->doubled.count >= UINT32_MAX - u->s->position_count) return 0;
    if (!buffer_append(&u->doubled, &corners[2], 1) || !buffer_append(&u->doubled_owners, &triangle, 1)) return 0;
    corners[2] = u->s->position_count + (uint32_t)(u->doubled.count - 1);
    return 1;
}

static result take_double(upload *u, uint32_t at, uint32_t *indices)
{
    const uint32_t v = indices[at], triangle = at / 3;
    if (u->doubled.count >= UINT32_MAX - u->s->position_count) return RESULT_NO_MEMORY;
    if (!buffer_append(&u->doubled, &v, 1) || !buffer_append(&u->doubled_owners, &triangle, 1)) return RESULT_NO_MEMORY;
    if (at % 3 == 2) u->owners[v] = 0; // was this triangle's own
    indices[at] = u->s->position_count + (uint32_t)(u->doubled.count - 1);
    return RESULT_OK;
}

static result turn_triangles(upload *u, uint32_t *indices)
{
    if (u->s->index_count) memcpy(indices, u->s->indices, u->s->index_count * sizeof *indices);
    for (uint32_t t = 0; t < u->s->index_count / 3; ++t)
        if (!own_last_vertex(u, t, indices + (size_t)3 * t)) return RESULT_NO_MEMORY;
    return RESULT_OK;
}

// A mover's vertices are its own, for they move: what it shares with another item is doubled.
static result part_movers(upload *u, uint32_t *indices, const allocator *memory)
{
    static const uint32_t NOBODY = UINT32_MAX;
    const scene *s = u->s;
    if (s->mover_count == 0) return RESULT_OK;
    uint32_t *claims = memory_alloc(memory, s->position_count, sizeof *claims); // mover + 1, 0: what never moves
    if (!claims) return RESULT_NO_MEMORY;
    for (uint32_t v = 0; v < s->position_count; ++v) claims[v] = NOBODY;
    result done = RESULT_OK;
    const uint32_t still = s->items[s->item_count].first_index;
    for (uint32_t k = 0; k < still; ++k)
        if (indices[k] < s->position_count) claims[indices[k]] = 0;
    for (uint32_t m = 0; m < s->mover_count && done == RESULT_OK; ++m) {
        const scene_item *item = &s->items[s->item_count + m];
        for (uint32_t k = item->first_index; k < item->first_index + item->index_count && done == RESULT_OK; ++k) {
            const uint32_t v = indices[k];
            if (v >= s->position_count) continue; // doubled already
            if (claims[v] == NOBODY) claims[v] = m + 1;
            if (claims[v] != m + 1) done = take_double(u, k, indices);
        }
    }
    memory_free(memory, claims, s->position_count, sizeof *claims);
    return done;
}

static GLuint buffer_of(const void *bytes, size_t size) // bytes NULL: of undefined content
{
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, (GLsizeiptr)(size ? size : 4), bytes, GL_DYNAMIC_STORAGE_BIT);
    return name;
}

// One attribute: the scene's array, then the doubled vertices' share of it.
static GLuint attribute_of(const upload *u, const void *bytes, size_t stride, const allocator *memory)
{
    const uint32_t *doubled = u->doubled.items;
    const size_t count = u->s->position_count, more = u->doubled.count;
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, (GLsizeiptr)((count + more) * stride + 4), NULL, GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(name, 0, (GLsizeiptr)(count * stride), bytes);
    char *share = memory_alloc(memory, more, stride);
    if (share) {
        for (size_t i = 0; i < more; ++i) memcpy(share + i * stride, (const char *)bytes + doubled[i] * stride, stride);
        glNamedBufferSubData(name, (GLintptr)(count * stride), (GLsizeiptr)(more * stride), share);
    } else {
        glDeleteBuffers(1, &name);
        name = 0;
    }
    memory_free(memory, share, more, stride);
    return name;
}

static void mark_two_sided(const upload *u, const uint32_t *indices, uint32_t *words)
{
    const scene *s = u->s;
    for (uint32_t i = 0; i < s->item_count + s->mover_count; ++i) {
        if (!(s->items[i].flags & CULL_ITEM_TWO_SIDED)) continue;
        const uint32_t first = s->items[i].first_index, end = first + s->items[i].index_count;
        for (uint32_t k = first; k < end; k += 3) words[indices[k + 2]] |= WORD_TWO_SIDED; // on the vertex that is its own
    }
}

static GLuint words_of(const upload *u, const uint32_t *indices, const allocator *memory)
{
    const uint32_t *doubled = u->doubled.items;
    const size_t count = u->s->position_count, all = count + u->doubled.count;
    uint32_t *words = memory_alloc(memory, all, sizeof *words);
    if (!words) return 0;
    for (size_t v = 0; v < count; ++v) words[v] = u->s->vertex_materials[v] | (uint32_t)u->flags[v] << 16;
    for (size_t v = count; v < all; ++v) words[v] = words[doubled[v - count]];
    mark_two_sided(u, indices, words);
    const GLuint name = buffer_of(words, all * sizeof *words);
    memory_free(memory, words, all, sizeof *words);
    return name;
}

static GLuint paints_of(const upload *u, const allocator *memory)
{
    const scene *s = u->s;
    uint32_t *paints = memory_alloc(memory, s->position_count, sizeof *paints);
    if (!paints) return 0;
    for (size_t v = 0; v < s->position_count; ++v) paints[v] = s->materials[s->vertex_materials[v]].colour;
    const GLuint name = attribute_of(u, paints, sizeof *paints, memory);
    memory_free(memory, paints, s->position_count, sizeof *paints);
    return name;
}

static uint32_t variant_of_normals(const scene *s)
{
    for (size_t v = 0; v < s->position_count; ++v)
        if (!s->normals || !(s->normals[v] & 0xffffffu)) return VARIANT_FLAT;
    return 0;
}

static GLuint triangles_of(upload *u, const allocator *memory)
{
    const uint32_t count = u->s->position_count;
    for (uint32_t v = 0; v < count; ++v) u->owners[v] -= u->owners[v] != 0;
    const GLuint name = attribute_of(u, u->owners, sizeof *u->owners, memory);
    if (name) glNamedBufferSubData(name, (GLintptr)(count * sizeof(uint32_t)), (GLsizeiptr)(u->doubled_owners.count * sizeof(uint32_t)), u->doubled_owners.items);
    return name;
}

static GLuint movers_of(const upload *u, const uint32_t *indices, const allocator *memory)
{
    const scene *s = u->s;
    const size_t count = s->position_count + u->doubled.count;
    uint32_t *movers = memory_alloc_zeroed(memory, count, sizeof *movers); // mover + 1, 0: what never moves
    if (!movers) return 0;
    for (uint32_t m = 0; m < s->mover_count; ++m) {
        const scene_item *item = &s->items[s->item_count + m];
        for (uint32_t k = item->first_index; k < item->first_index + item->index_count; ++k) movers[indices[k]] = m + 1;
    }
    const GLuint name = buffer_of(movers, count * sizeof *movers);
    memory_free(memory, movers, count, sizeof *movers);
    return name;
}

static cull_vec3 position_of(const upload *u, uint32_t vertex)
{
    const uint32_t *doubled = u->doubled.items;
    return u->s->positions[vertex < u->s->position_count ? vertex : doubled[vertex - u->s->position_count]];
}

// For each triangle's own vertex, where the other two are.
static GLuint others_of(const upload *u, const uint32_t *indices, const allocator *memory)
{
    typedef struct pair { cull_vec3 a, b; } pair;
    const size_t count = u->s->position_count + u->doubled.count;
    pair *pairs = memory_alloc_zeroed(memory, count, sizeof *pairs);
    if (!pairs) return 0;
    for (size_t i = 0; i < u->s->index_count; i += 3)
        pairs[indices[i + 2]] = (pair){position_of(u, indices[i]), position_of(u, indices[i + 1])};
    const GLuint name = buffer_of(pairs, count * sizeof *pairs);
    memory_free(memory, pairs, count, sizeof *pairs);
    return name;
}

static result upload_vertices(scene_gpu *p, upload *u, const allocator *memory)
{
    const scene *s = u->s;
    result turned = turn_triangles(u, p->indices);
    if (turned == RESULT_OK) turned = part_movers(u, p->indices, memory);
    if (turned != RESULT_OK) return turned;
    p->vertex_count = s->position_count + (uint32_t)u->doubled.count;
    p->buffers.positions = attribute_of(u, s->positions, sizeof *s->positions, memory);
    p->buffers.words = words_of(u, p->indices, memory);
    p->buffers.triangles = triangles_of(u, memory);
    p->buffers.others = others_of(u, p->indices, memory);
    if (!p->buffers.positions || !p->buffers.words || !p->buffers.triangles || !p->buffers.others) return RESULT_NO_MEMORY;
    if (s->mover_count && !(p->buffers.movers = movers_of(u, p->indices, memory))) return RESULT_NO_MEMORY;
    if (s->texcoords && !(p->buffers.texcoords = attribute_of(u, s->texcoords, 2 * sizeof(float), memory))) return RESULT_NO_MEMORY;
    if (s->normals && !(p->buffers.normals = attribute_of(u, s->normals, sizeof(uint32_t), memory))) return RESULT_NO_MEMORY;
    if (!(p->buffers.paints = paints_of(u, memory))) return RESULT_NO_MEMORY;
    p->variant |= variant_of_normals(s);
    p->elements = buffer_of(p->indices, s->index_count * sizeof(uint32_t));
    return RESULT_OK;
}

static result upload_materials(scene_gpu *p, const scene *s, const allocator *memory)
{
    uint32_t *colours = memory_alloc(memory, s->material_count, sizeof *colours);
    if (!colours) return RESULT_NO_MEMORY;
    for (uint32_t m = 0; m < s->material_count; ++m) colours[m] = s->materials[m].colour;
    p->materials = buffer_of(colours, s->material_count * sizeof *colours);
    memory_free(memory, colours, s->material_count, sizeof *colours);
    return RESULT_OK;
}

static void look_at_item(scene_gpu *p, const upload *u, uint32_t item, uint32_t *triangle_items)
{
    const scene_item *it = &u->s->items[item];
    for (uint32_t t = it->first_index / 3; t < (it->first_index + it->index_count) / 3; ++t) {
        const uint32_t flags = (uint32_t)u->flags[u->s->indices[(size_t)3 * t]] << 16;
        triangle_items[t] = item;
        if (flags & WORD_TRANSLUCENT) p->is_see_through[item] = 1;
        else if (it->flags & CULL_ITEM_TWO_SIDED) p->has_two_sided = 1;
        if (flags & WORD_CUT_OUT && p->buffers.texcoords) p->variant |= VARIANT_CUT_OUT;
    }
    if (!p->is_see_through[item]) return;
    p->see_through[p->see_through_count++] = item;
    p->variant |= VARIANT_TRANSLUCENT;
}

static result upload_triangles(scene_gpu *p, const upload *u, const allocator *memory)
{
    uint32_t *items = memory_alloc_zeroed(memory, p->triangle_count, sizeof *items);
    if (!items) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < p->item_total; ++i) look_at_item(p, u, i, items);
    p->triangle_items = buffer_of(items, p->triangle_count * sizeof *items);
    memory_free(memory, items, p->triangle_count, sizeof *items);
    p->seen = buffer_of(NULL, (p->triangle_count / 32 + 1) * sizeof(uint32_t));
    p->counts = buffer_of(NULL, p->item_total * sizeof(uint32_t));
    return RESULT_OK;
}

// The first zone that lists an item, plus 1; 0: none does.
static result upload_zones(scene_gpu *p, const scene *s, const allocator *memory)
{
    uint32_t *zones = memory_alloc_zeroed(memory, p->item_total, sizeof *zones);
    if (!zones) return RESULT_NO_MEMORY;
    for (uint32_t z = s->zone_count; z-- > 0;)
        for (uint32_t i = 0; i < s->zones[z].item_count; ++i) zones[s->zone_items[s->zones[z].first_item + i]] = z + 1;
    p->item_zones = buffer_of(zones, p->item_total * sizeof *zones);
    memory_free(memory, zones, p->item_total, sizeof *zones);
    return RESULT_OK;
}

static result reserve(renderer *g, scene_gpu *p)
{
    const size_t total = p->item_total;
    p->indices = memory_alloc(g->memory, p->index_count, sizeof *p->indices);
    p->see_through = memory_alloc(g->memory, total, sizeof *p->see_through);
    p->is_see_through = memory_alloc_zeroed(g->memory, total, 1);
    p->box_items = memory_alloc(g->memory, total, sizeof *p->box_items);
    p->box_counts = memory_alloc_zeroed(g->memory, total, sizeof *p->box_counts);
    if (ranges_open(&p->ranges, p->item_total + 8, g->memory) != RESULT_OK) return RESULT_NO_MEMORY; // 8: ranges too long for one
    if (poses_open(&p->poses, p->scene, g->memory) != RESULT_OK) return RESULT_NO_MEMORY;
    if (p->scene->mover_count) p->variant |= VARIANT_MOVERS;
    return p->indices && p->see_through && p->is_see_through && p->box_items && p->box_counts ? RESULT_OK : RESULT_NO_MEMORY;
}

static result fill(renderer *g, scene_gpu *p, report *r)
{
    upload u;
    result done = upload_open(p->scene, g->memory, &u);
    if (done == RESULT_OK) done = reserve(g, p);
    if (done == RESULT_OK) {
        flag_vertices(&u, p->item_total);
        if (!corners_agree(&u)) done = report_error(r, p->scene->path, 0, "a triangle is translucent or alpha-tested at some corners only; give it one material");
    }
    if (done == RESULT_OK) done = upload_vertices(p, &u, g->memory);
    if (done == RESULT_OK) done = upload_materials(p, p->scene, g->memory);
    if (done == RESULT_OK) done = upload_triangles(p, &u, g->memory);
    if (done == RESULT_OK) done = upload_zones(p, p->scene, g->memory);
    upload_close(&u, g->memory);
    if (done == RESULT_NO_MEMORY) report_no_memory(r, p->scene->path);
    return done;
}

static void attribute(GLuint vertices, GLuint place, GLuint buffer, GLsizei stride)
{
    glVertexArrayVertexBuffer(vertices, place, buffer, 0, stride);
    glVertexArrayAttribBinding(vertices, place, place);
    glEnableVertexArrayAttrib(vertices, place);
}

GLuint vertex_array_of(const vertex_buffers *p, GLuint elements)
{
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    attribute(name, 0, p->positions, 12);
    glVertexArrayAttribFormat(name, 0, 3, GL_FLOAT, GL_FALSE, 0);
    attribute(name, 1, p->words, 4);
    glVertexArrayAttribIFormat(name, 1, 1, GL_UNSIGNED_INT, 0);
    attribute(name, 2, p->triangles, 4);
    glVertexArrayAttribIFormat(name, 2, 1, GL_UNSIGNED_INT, 0);
    attribute(name, 5, p->others, 24);
    glVertexArrayAttribFormat(name, 5, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribFormat(name, 6, 3, GL_FLOAT, GL_FALSE, 12);
    glVertexArrayAttribBinding(name, 6, 5);
    glEnableVertexArrayAttrib(name, 6);
    if (p->texcoords) {
        attribute(name, 3, p->texcoords, 8);
        glVertexArrayAttribFormat(name, 3, 2, GL_FLOAT, GL_FALSE, 0);
    }
    if (p->movers) {
        attribute(name, 7, p->movers, 4);
        glVertexArrayAttribIFormat(name, 7, 1, GL_UNSIGNED_INT, 0);
    }
    attribute(name, 8, p->paints, 4);
    glVertexArrayAttribFormat(name, 8, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
    if (p->normals) {
        attribute(name, 4, p->normals, 4);
        glVertexArrayAttribFormat(name, 4, 4, GL_BYTE, GL_TRUE, 0);
    }
    glVertexArrayElementBuffer(name, elements);
    return name;
}

GLuint scene_vertex_array(const renderer *g, GLuint elements)
{
    return vertex_array_of(&g->scene.buffers, elements);
}

static result fits_driver(const scene *s, report *r)
{
    GLint64 block = 0;
    GLint in_vertices = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &in_vertices); // GL 4.5 lets a driver have none
    if (s->mover_count && in_vertices < 1) {
        report_error(r, s->path, 0, "%u movers; this driver gives vertex shaders no storage block to move them by, so use another driver", s->mover_count);
        return RESULT_NO_GL;
    }
    if ((GLint64)(s->index_count / 3) * 4 <= block) return RESULT_OK;
    report_error(r, s->path, 0, "%u triangles; this driver numbers %lld at most, so split the scene", s->index_count / 3, (long long)block / 4);
    return RESULT_NO_GL;
}

result renderer_upload(renderer *g, const scene *s, report *r)
{
    scene_release(g);
    const result fits = fits_driver(s, r);
    if (fits != RESULT_OK) return fits;
    scene_gpu *p = &g->scene;
    p->scene = s;
    p->index_count = s->index_count;
    p->triangle_count = s->index_count / 3;
    p->item_total = s->item_count + s->mover_count;
    result done = fill(g, p, r);
    if (done == RESULT_OK) {
        p->vertices = scene_vertex_array(g, p->elements);
        done = gl_check(g, r, "uploading the scene");
    }
    if (done != RESULT_OK) scene_release(g);
    return done;
}

void scene_release(renderer *g)
{
    scene_gpu *p = &g->scene; // the scene itself may be gone already
    if (!p->scene) return;
    frame_flush(g);
    const vertex_buffers *v = &p->buffers;
    const GLuint buffers[] = {v->positions, v->words, v->triangles, v->texcoords, v->normals, v->paints, v->others, v->movers, p->elements,
                              p->materials, p->triangle_items, p->item_zones, p->seen, p->counts};
    glDeleteVertexArrays(1, &p->vertices);
    glDeleteBuffers((GLsizei)(sizeof buffers / sizeof *buffers), buffers);
    memory_free(g->memory, p->indices, p->index_count, sizeof *p->indices);
    memory_free(g->memory, p->see_through, p->item_total, sizeof *p->see_through);
    memory_free(g->memory, p->is_see_through, p->item_total, 1);
    memory_free(g->memory, p->box_items, p->item_total, sizeof *p->box_items);
    memory_free(g->memory, p->box_counts, p->item_total, sizeof *p->box_counts);
    ranges_close(&p->ranges, g->memory);
    poses_close(&p->poses, g->memory);
    levels_release(g);
    frame_release(g);
    g->id_target = NULL; // its depth is of another scene
    g->costs_of = NULL;
    *p = (scene_gpu){0};
    state_forget(g);
}
