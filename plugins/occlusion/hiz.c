// method=hiz: see hiz.h. Here: its memory, what of the zone is looked at, the bands, and what is handed back.
// SPDX-License-Identifier: MIT
#include "hiz.h"

#include <stdio.h>
#include <string.h>

enum {
    CELLS_ITEMS = 4096, // up to so many boxes, ...
    CELLS_ROWS = 720,   // ... and in a picture of so many rows, two of these share a depth
    ALIGN = 64,
    SKEW = 2048 + 64, // else a tile's two words lie 4096 bytes times a number apart, and a store to one delays loads of the other
};

// ---- Life ----

static cull_result option_refused(const cull_host *host, const char *key, const char *value, const char *legal)
{
    char line[200];
    snprintf(line, sizeof line, "occlusion: %s=%.32s: must be %s", key, value, legal);
    host->log(host, CULL_LOG_ERROR, line);
    return CULL_ERR_OPTION;
}

cull_result hiz_options_read(const cull_host *host, const char *const *values, hiz_options *out)
{
    const char *const prune = values[0], *const threads = values[1], *const isa = values[2], *const pixels = values[3];
    const int prunes = strcmp(prune, "on") == 0;
    if (!prunes && strcmp(prune, "off") != 0) return option_refused(host, "prune", prune, "on or off");
    if (!threads[0] || threads[1] || !strchr("1248", threads[0])) return option_refused(host, "threads", threads, "1, 2, 4 or 8");
    out->pixels = strcmp(pixels, "auto") == 0 ? 0 : (uint32_t)(pixels[0] - '0');
    if (out->pixels && (!pixels[0] || pixels[1] || !strchr("124", pixels[0]))) return option_refused(host, "pixels", pixels, "auto, 1, 2 or 4");
    out->kernel = hiz_kernel_of(isa);
    if (!out->kernel) return option_refused(host, "isa", isa, "auto, avx512, avx2 or plain, and one that this CPU has");
    out->threads = (uint32_t)(threads[0] - '0');
    out->prunes = prunes != 0;
    return CULL_OK;
}

// Where few boxes hide a few more, each is large on a large picture: what a coarser one loses at its edges is little, and drawing it is most of
// the work. Polygons of a mesh would part at every edge between them.
static hiz_size cell_of(const hiz *h, const cull_view *view)
{
    const int is_coarse = !h->index.shapes.face_count && h->index.tree.item_count <= CELLS_ITEMS && view->height_px >= CELLS_ROWS;
    const uint32_t pixels = h->options.pixels ? h->options.pixels : is_coarse ? 2 : 1;
    return (hiz_size){pixels == 4 ? 2 : 1, pixels > 1 ? 2 : 1};
}

cull_result hiz_make(const cull_host *host, const cull_zone *zone, const hiz_options *options, hiz *out)
{
    hiz h = {.host = host, .options = *options};
    if (zone->item_count >= 1u << 28) {
        host->log(host, CULL_LOG_ERROR, "occlusion: method=hiz numbers at most 2^28 items; split the zone");
        return CULL_ERR_ZONE;
    }
    cull_result result = hiz_tree_make(host, zone, &h.index.tree);
    if (result != CULL_OK) return result;
    result = hiz_shapes_make(host, zone, h.index.tree.items, &h.index.shapes);
    if (result != CULL_OK) hiz_tree_free(host, &h.index.tree);
    else *out = h;
    return result;
}

void hiz_free(hiz *h)
{
    hiz_shapes_free(h->host, &h->index.shapes);
    hiz_tree_free(h->host, &h->index.tree);
}

size_t hiz_bytes(const hiz *h)
{
    return hiz_tree_bytes(&h->index.tree) + hiz_shapes_bytes(&h->index.shapes);
}

// ---- Scratch ----

typedef struct hiz_room { // what a step works in; shared, then of each band
    float *far, *coarse;
    uint32_t *owners;
    uint64_t *stale, *active[HIZ_LEVELS_MOST];
    struct {
        float *depths;
        hiz_planes *records;
        queue_entry *entries;
        queue_key *heap;
        int32_t *heads;
        uint32_t *seen;
    } bands[HIZ_THREADS_MOST];
    size_t size;
} hiz_room;

static void *part(char *base, size_t *at, size_t bytes)
{
    void *here = base + *at;
    *at += (bytes + ALIGN - 1) / ALIGN * ALIGN;
    return here;
}

static uint32_t pictures_of(const hiz *h)
{
    return HIZ_PICTURES_MOST / h->options.threads;
}

static uint32_t records_of(const hiz *h)
{
    return HIZ_RECORDS_MOST / h->options.threads;
}

// base NULL: only the size is asked for.
static void room_part(const hiz *h, char *base, hiz_room *out)
{
    const hiz_tree *t = &h->index.tree;
    const size_t tiles = (size_t)HIZ_COLUMNS_MOST * HIZ_ROWS_MOST + HIZ_PADDING_TILES * HIZ_THREADS_MOST;
    size_t at = 0, entries = 0;
    out->far = part(base, &at, tiles * sizeof *out->far);
    (void)part(base, &at, SKEW);
    out->owners = part(base, &at, tiles * sizeof *out->owners);
    out->coarse = part(base, &at, (HIZ_BLOCK_COLUMNS_MOST * HIZ_BLOCK_ROWS_MOST) * sizeof *out->coarse);
    out->stale = part(base, &at, HIZ_BLOCK_ROWS_MOST * sizeof *out->stale);
    for (uint32_t level = 0; level < t->level_count; level++) {
        out->active[level] = part(base, &at, (t->counts[level] / 64 + 1) * sizeof(uint64_t));
        entries += t->counts[level];
    }
    for (uint32_t b = 0; b < h->options.threads; b++) {
        out->bands[b].heads = part(base, &at, QUEUE_LISTS * sizeof *out->bands[b].heads);
        out->bands[b].entries = part(base, &at, entries * sizeof *out->bands[b].entries);
        out->bands[b].heap = part(base, &at, entries * sizeof *out->bands[b].heap);
        out->bands[b].seen = part(base, &at, t->item_count * sizeof *out->bands[b].seen);
        out->bands[b].records = part(base, &at, records_of(h) * sizeof *out->bands[b].records);
        out->bands[b].depths = part(base, &at, (size_t)pictures_of(h) * HIZ_TILE_PIXELS * sizeof *out->bands[b].depths);
    }
    out->size = at;
}

size_t hiz_scratch_bytes(const hiz *h)
{
    static char nothing;
    hiz_room room;
    room_part(h, &nothing, &room);
    return room.size;
}

// ---- What is looked at ----

static void bits_set(uint64_t *bits, uint32_t at)
{
    bits[at / 64] |= UINT64_C(1) << (at % 64);
}

static void runs_mark(const hiz_tree *t, const cull_run *runs, uint32_t count, uint64_t *bits)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t item = runs[i].first; item - runs[i].first < runs[i].count && item < t->item_count; item++) bits_set(bits, t->slots[item]);
}

// Candidates, or all but what pictures stand for and what is drawn clipped; then each node that has such a one below. 0: all there is.
static int active_mark(const hiz_tree *t, const cull_visit *visit, hiz_room *room)
{
    if (!visit->candidates && !visit->picture_count && !visit->clipped_count) return 0;
    for (uint32_t level = 0; level < t->level_count; level++) memset(room->active[level], 0, (t->counts[level] / 64 + 1) * sizeof(uint64_t));
    uint64_t *bits = room->active[0];
    if (visit->candidates) runs_mark(t, visit->candidates, visit->candidate_count, bits);
    else {
        for (uint32_t i = 0; i < visit->picture_count; i++) runs_mark(t, visit->pictures[i].runs, visit->pictures[i].run_count, bits);
        for (uint32_t i = 0; i < visit->clipped_count; i++) runs_mark(t, visit->clipped[i].runs, visit->clipped[i].run_count, bits);
        for (uint32_t i = 0; i <= t->item_count / 64; i++) bits[i] = ~bits[i];
    }
    for (uint32_t level = 1; level < t->level_count; level++)
        for (uint32_t i = 0; i < t->counts[level]; i++)
            if (room->active[level - 1][i / 4] >> (i % 4 * 16) & 0xffff) bits_set(room->active[level], i);
    return 1;
}

// ---- Bands ----

typedef struct hiz_frame {
    const hiz *h;
    hiz_view views[HIZ_THREADS_MOST];
    hiz_buffer buffers[HIZ_THREADS_MOST];
    hiz_walk walks[HIZ_THREADS_MOST];
    uint32_t band_count;
} hiz_frame;

void hiz_buffer_clear(hiz_buffer *b)
{
    const size_t first = (size_t)b->first_row * (size_t)b->pitch; // vectors read over the last row's end
    const size_t tiles = (size_t)(b->end_row - b->first_row) * (size_t)b->pitch + HIZ_PADDING_TILES;
    memset(b->far + first, 0, tiles * sizeof *b->far);
    memset(b->owners + first, 0, tiles * sizeof *b->owners);
    const int32_t block_row = b->first_row / HIZ_BLOCK_TILES, block_end = (b->end_row + HIZ_BLOCK_TILES - 1) / HIZ_BLOCK_TILES;
    for (int32_t row = block_row; row < block_end; row++) {
        memset(b->coarse + (size_t)row * HIZ_BLOCK_COLUMNS_MOST, 0, HIZ_BLOCK_COLUMNS_MOST * sizeof *b->coarse);
        b->stale[row] = 0;
    }
    b->picture_count = b->record_count = b->limits_hit = 0;
}

static void band_run(void *context, uint32_t i)
{
    hiz_frame *f = context;
    hiz_buffer_clear(&f->buffers[i]);
    f->h->options.kernel->walk(&f->walks[i]);
}

static int32_t divided_up(int32_t a, int32_t b)
{
    return (a + b - 1) / b;
}

// Bands start at rows of blocks, so that none shares one.
static void band_make(hiz_frame *f, const hiz_room *room, const cull_visit *visit, const hiz_view *view, uint32_t i)
{
    const int32_t rows = divided_up(view->height_px, HIZ_TILE_PX), block_rows = divided_up(rows, HIZ_BLOCK_TILES);
    const int32_t bands = (int32_t)f->band_count, band = (int32_t)i;
    const int32_t first = block_rows * band / bands * HIZ_BLOCK_TILES, end = block_rows * (band + 1) / bands * HIZ_BLOCK_TILES;
    hiz_buffer *b = &f->buffers[i];
    hiz_walk *w = &f->walks[i];
    f->views[i] = *view;
    f->views[i].y_first = first * HIZ_TILE_PX;
    f->views[i].y_end = end * HIZ_TILE_PX < view->height_px ? end * HIZ_TILE_PX : view->height_px;
    const int32_t columns = divided_up(view->width_px, HIZ_TILE_PX);
    const size_t apart = (size_t)i * HIZ_PADDING_TILES; // vectors that read over a band's end read nothing of the next
    *b = (hiz_buffer){.far = room->far + apart, .owners = room->owners + apart, .coarse = room->coarse, .stale = room->stale, .depths = room->bands[i].depths,
                      .records = room->bands[i].records, .pitch = columns, .first_row = first, .end_row = end < rows ? end : rows,
                      .width_px = columns * HIZ_TILE_PX, .picture_most = pictures_of(f->h), .record_most = records_of(f->h), .prunes = f->h->options.prunes};
    *w = (hiz_walk){.index = &f->h->index, .view = &f->views[i], .volumes = visit->volumes, .buffer = b, .seen = room->bands[i].seen,
                    .volume_count = visit->volume_count};
    w->queue.entries = room->bands[i].entries;
    w->queue.heap = room->bands[i].heap;
    w->queue.heads = room->bands[i].heads;
}

// ---- What is handed back ----

static void run_put(cull_batch *batch, uint32_t first_run, uint32_t number)
{
    cull_run *last = batch->run_count > first_run ? &batch->runs[batch->run_count - 1] : NULL;
    if (last && last->first + last->count == number) last->count++;
    else batch->runs[batch->run_count++] = (cull_run){number, 1};
}

// A band's list is in its order; an item of several bands is said once. active[0] is free by now.
static void seen_put(hiz_frame *f, const uint32_t *numbers, uint64_t *said, cull_batch *batch)
{
    const hiz_tree *t = &f->h->index.tree;
    const uint32_t first_run = batch->run_count;
    if (f->band_count > 1) memset(said, 0, (t->item_count / 64 + 1) * sizeof *said);
    for (uint32_t i = 0; i < f->band_count; i++) {
        const hiz_walk *w = &f->walks[i];
        batch->nodes_visited += w->nodes_visited;
        batch->limits_hit += w->buffer->limits_hit;
        for (uint32_t k = 0; k < w->seen_count; k++) {
            const uint32_t slot = w->seen[k], item = t->items[slot];
            if (f->band_count > 1) {
                if (said[slot / 64] >> (slot % 64) & 1) continue;
                bits_set(said, slot);
            }
            run_put(batch, first_run, numbers ? numbers[item] : item);
        }
    }
}

// Which of up to 16 boxes may leave a pixel behind what the bands hold.
static uint32_t boxes_seen(hiz_frame *f, const cull_box *boxes[HIZ_WIDTH], uint32_t count)
{
    float block[HIZ_BLOCK_FLOATS] = {0};
    uint32_t seen = 0;
    for (uint32_t i = 0; i < count; i++) {
        const cull_box *box = boxes[i];
        const float values[6] = {box->min.x, box->min.y, box->min.z, box->max.x, box->max.y, box->max.z};
        for (int k = 0; k < 6; k++) block[k * HIZ_WIDTH + (int)i] = values[k];
    }
    for (uint32_t i = 0; i < f->band_count; i++) seen |= f->h->options.kernel->boxes_seen(&f->views[i], &f->buffers[i], block, (1u << count) - 1);
    return f->band_count ? seen : UINT32_MAX;
}

static void movers_put(hiz_frame *f, const cull_visit *visit, cull_batch *batch)
{
    const cull_box *boxes[HIZ_WIDTH];
    for (uint32_t first = 0, count; first < visit->mover_count; first += count) {
        for (count = 0; count < HIZ_WIDTH && first + count < visit->mover_count; count++) boxes[count] = &visit->movers[first + count].box;
        const uint32_t seen = boxes_seen(f, boxes, count);
        for (uint32_t i = 0; i < count; i++)
            if (seen >> i & 1) batch->runs[batch->run_count++] = (cull_run){visit->movers[first + i].id, 1};
    }
}

// Of a select that stands before: neither shown nor taken where hidden.
static void pictures_keep(hiz_frame *f, const cull_visit *visit, cull_batch *batch, drop_counters *n)
{
    const cull_box *boxes[HIZ_WIDTH];
    for (uint32_t first = 0, count; first < visit->picture_count; first += count) {
        for (count = 0; count < HIZ_WIDTH && first + count < visit->picture_count; count++) boxes[count] = &visit->pictures[first + count].box;
        const uint32_t seen = boxes_seen(f, boxes, count);
        n->tested += count;
        for (uint32_t i = 0; i < count; i++)
            if (!(seen >> i & 1)) drop_picture(visit, batch, first + i, n);
    }
    for (uint32_t i = 0; i < visit->clipped_count; i++) {
        boxes[0] = &visit->clipped[i].box;
        if (!(boxes_seen(f, boxes, 1) & 1)) batch->keep_clipped[i] = 0;
    }
}

static void frame_run(const hiz *h, const cull_visit *visit, hiz_room *room, hiz_frame *f)
{
    hiz_view view;
    room_part(h, visit->scratch, room);
    hiz_view_make(visit->view, (hiz_size){HIZ_WIDTH_MOST, HIZ_HEIGHT_MOST}, cell_of(h, visit->view), &view);
    f->h = h;
    f->band_count = h->options.threads;
    const int is_part = active_mark(&h->index.tree, visit, room);
    for (uint32_t i = 0; i < f->band_count; i++) {
        band_make(f, room, visit, &view, i);
        for (uint32_t level = 0; is_part && level < h->index.tree.level_count; level++) f->walks[i].active[level] = room->active[level];
    }
    if (f->band_count > 1) h->host->parallel_for(h->host, band_run, f, f->band_count);
    else band_run(f, 0);
}

cull_progress hiz_step(const hiz *h, const uint32_t *numbers, const cull_visit *visit, cull_batch *batch, hiz_counters *counters)
{
    hiz_room room;
    hiz_frame f;
    frame_run(h, visit, &room, &f);
    for (uint32_t i = 0; i < f.band_count; i++) {
        counters->rectangles += f.walks[i].test_count;
        counters->items += f.walks[i].cover_count;
        counters->polygons += f.walks[i].polygon_count;
    }
    batch->limits_hit += visit->view->width_px > HIZ_WIDTH_MOST || visit->view->height_px > HIZ_HEIGHT_MOST;
    seen_put(&f, numbers, room.active[0], batch);
    movers_put(&f, visit, batch);
    pictures_keep(&f, visit, batch, &counters->drops);
    return CULL_DONE;
}

hiz_sight hiz_look(const hiz *h, const cull_visit *visit, uint32_t item)
{
    const hiz_tree *t = &h->index.tree;
    hiz_room room;
    hiz_frame f;
    frame_run(h, visit, &room, &f);
    for (uint32_t i = 0; i < f.band_count; i++)
        for (uint32_t k = 0; k < f.walks[i].seen_count; k++)
            if (f.walks[i].seen[k] == t->slots[item]) return f.views[i].is_usable ? HIZ_SEEN : HIZ_UNTESTED;
    for (uint32_t i = 0; i < f.band_count; i++) hiz_buffer_clear(&f.buffers[i]);
    const float *b = t->blocks[0] + (size_t)(t->slots[item] / HIZ_WIDTH) * HIZ_BLOCK_FLOATS + t->slots[item] % HIZ_WIDTH;
    const cull_box box = {{b[0], b[16], b[32]}, {b[48], b[64], b[80]}};
    const cull_box *one[HIZ_WIDTH] = {&box};
    return boxes_seen(&f, one, 1) & 1 ? HIZ_HIDDEN : HIZ_NO_PIXEL;
}
