// A small right culler, a loop over boxes, with one fault for each macro BROKEN_... : what `portcullis check` must name. NAME is its id.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include <portcullis/plane.h>

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    NONE, DROPS_ONE_IN_1000, DROPS_SUB_PIXEL, DROPS_ON_PLANE, SHRINKS_A_PLANE, SKIPS_LAST_VOLUME, WRITES_PAST_END, READS_PAST_PLANES,
    READS_PAST_BOXES, KEEPS_GLOBALS, COUNTS_IN_GLOBAL, ALLOCATES, ALLOCATES_FROM_HOST, READS_FILE, SLEEPS, MUTATES_ZONE, LEAKS, LEAKS_HEAP,
    FREES_WRONG_SIZE, CRASHES, NEVER_ENDS, EXITS, STEPS_FOR_EVER, PREVIOUS_VIEW, IGNORES_CHANGE, UNINITIALISED, CLAIMS_ORDERED,
    PROMISES_TOO_MUCH, TAKES_ANY_WORD, TAKES_OUT_OF_RANGE, REFUSES_SILENTLY, WRONG_ABI, NO_SUMMARY, IGNORES_NO_MEMORY, LEAKS_WITHOUT_MEMORY,
    WRONG_CODE_WITHOUT_MEMORY, TRUSTS_BLOB, SAVES_TOO_MUCH, FORGETS_IN_BLOB, DUPLICATES, OUTSIDE_ZONE, EMPTY_RUN, REPLACES_LIST,
    ORDER_NO_PERMUTATION, TREE_WITHOUT_ITEM, RACES, NAN_CRASH, SORTS, DROPS_MOVERS, CROSSES_NOTHING, EXPLAINS_PAST_END, RAY_MISSES,
    NEEDS_A_CULLER
};
#define IS(fault) (BROKEN == (fault))

struct cull_culler {
    const cull_host *host;
    const cull_zone *zone;
    uint32_t item_count;
    cull_box *boxes;
    uint32_t *order;
    cull_node *nodes;
    cull_hierarchy tree;
    uint32_t band;
    cull_volume *shared; // of RACES
};

typedef struct memory { // of a query: the last view's volumes
    cull_plane planes[64][CULL_MAX_PLANES];
    cull_volume volumes[64];
    uint32_t count, has_any;
    float eye[3];
} memory;
struct cull_query {
    const cull_culler *culler;
    memory last;
    uint8_t *spare; // never written: see UNINITIALISED
    cull_run away[8192];
};

static const volatile uintptr_t nowhere = 8; // not known when this is compiled
static cull_culler *newest; // of KEEPS_GLOBALS
static uint32_t steps_so_far; // of COUNTS_IN_GLOBAL

// ---- Life ----

static void *take(const cull_host *host, size_t size)
{
    return host->alloc(host, size, 64);
}

static int is_range(const char *text, uint32_t *out)
{
    char *end;
    const unsigned long value = strtoul(text, &end, 10);
    if (IS(TAKES_OUT_OF_RANGE)) return *out = (uint32_t)value, end != text || *text < '0';
    if (*text < '0' || *text > '9' || *end || end - text > 3 || value > 100) return 0;
    *out = (uint32_t)value;
    return 1;
}

static cull_result create(const cull_host *host, const char *const *values, cull_culler **out)
{
    uint32_t band = 0;
    const int is_word = IS(TAKES_ANY_WORD) || strcmp(values[0], "plain") == 0 || strcmp(values[0], "fancy") == 0;
    if (!is_word || !is_range(values[1], &band)) {
        if (!IS(REFUSES_SILENTLY)) host->log(host, CULL_LOG_ERROR, "mode takes plain or fancy, band 0 to 100");
        return CULL_ERR_OPTION;
    }
    cull_culler *c = take(host, sizeof *c);
    if (!c) return CULL_ERR_MEMORY;
    memset(c, 0, sizeof *c);
    c->host = host;
    c->band = band;
    newest = c;
    *out = c;
    return CULL_OK;
}

static void destroy(cull_culler *c)
{
    const cull_host *host = c->host;
    const size_t count = c->item_count + 1u;
    if (c->boxes && !IS(LEAKS)) host->free(host, c->boxes, count * sizeof *c->boxes + IS(FREES_WRONG_SIZE));
    if (c->order) host->free(host, c->order, count * sizeof *c->order);
    if (c->nodes) host->free(host, c->nodes, 2 * sizeof *c->nodes);
    if (c->shared) host->free(host, c->shared, 64 * sizeof *c->shared);
    host->free(host, c, sizeof *c);
}

typedef struct blob_head { uint32_t magic, count; uint64_t hash; } blob_head;

static uint64_t hash_of(const cull_box *boxes, uint32_t count)
{
    uint64_t hash = 0xcbf29ce484222325u;
    const unsigned char *bytes = (const unsigned char *)boxes;
    for (size_t i = 0; i < count * sizeof *boxes; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static cull_result boxes_load(cull_culler *c, const cull_blob *blob)
{
    blob_head head;
    if (blob->size < sizeof head && !IS(TRUSTS_BLOB)) return CULL_ERR_BLOB;
    memcpy(&head, blob->bytes, sizeof head);
    if (IS(TRUSTS_BLOB)) {
        c->item_count = head.count; // whatever it says
    } else if (head.magic != 0x6b6f7262 || head.count != c->item_count || blob->size != sizeof head + head.count * sizeof *c->boxes) {
        return CULL_ERR_BLOB;
    }
    if (c->item_count) memcpy(c->boxes, (const char *)blob->bytes + sizeof head, c->item_count * sizeof *c->boxes);
    if (IS(FORGETS_IN_BLOB) && c->item_count) c->boxes[0] = (cull_box){{1e9f, 1e9f, 1e9f}, {1e9f, 1e9f, 1e9f}};
    return IS(TRUSTS_BLOB) || IS(FORGETS_IN_BLOB) || head.hash == hash_of(c->boxes, c->item_count) ? CULL_OK : CULL_ERR_BLOB;
}

static cull_result boxes_make(cull_culler *c)
{
    const cull_blob *blob = c->host->get_extension(c->host, c->zone, CULL_EXT_BLOB);
    if (blob) return boxes_load(c, blob);
    for (uint32_t i = 0; i < c->item_count; i++) c->boxes[i] = cull_box_at(&c->zone->boxes, i);
    return CULL_OK;
}

static void tree_make(cull_culler *c)
{
    c->nodes[0] = (cull_node){.box = c->zone->box, .item_count = c->item_count, .subtree = {0, c->item_count}};
    if (IS(TREE_WITHOUT_ITEM) && c->item_count) c->nodes[0].item_count--, c->nodes[0].subtree.count--;
    c->tree = (cull_hierarchy){.nodes = c->nodes, .node_count = 1, .depth = 1};
}

static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    const size_t count = zone->item_count + 1u;
    (void)lent;
    if (IS(EXITS)) exit(0);
    c->zone = zone;
    c->item_count = zone->item_count;
    c->boxes = take(c->host, count * sizeof *c->boxes);
    if (!c->boxes && !IS(IGNORES_NO_MEMORY)) return IS(WRONG_CODE_WITHOUT_MEMORY) ? CULL_ERR_ZONE : CULL_ERR_MEMORY;
    c->order = take(c->host, count * sizeof *c->order);
    if (!c->order) {
        if (IS(LEAKS_WITHOUT_MEMORY)) c->boxes = NULL;
        return CULL_ERR_MEMORY;
    }
    c->nodes = take(c->host, 2 * sizeof *c->nodes);
    c->shared = take(c->host, 64 * sizeof *c->shared);
    if (!c->nodes || !c->shared) return CULL_ERR_MEMORY;
    const cull_result made = boxes_make(c);
    if (made != CULL_OK) return made;
    if (IS(READS_PAST_BOXES) && zone->boxes.min_x[(zone->item_count + 15) / 16 * 16 + CULL_PADDING] == 12345) return CULL_ERR_ZONE;
    for (uint32_t i = 0; i < zone->item_count; i++) c->order[i] = i;
    if (IS(ORDER_NO_PERMUTATION) && zone->item_count > 1) c->order[1] = 0;
    tree_make(c);
    out->order = c->order;
    out->promises = CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS | (IS(CLAIMS_ORDERED) || IS(PROMISES_TOO_MUCH) || IS(SORTS) ? CULL_ORDERED : 0u);
    out->max_runs = zone->item_count;
    out->takes_movers = IS(DROPS_MOVERS);
    out->max_steps = IS(STEPS_FOR_EVER) ? 3 : 1;
    return CULL_OK;
}

static cull_result open_query(const cull_culler *c, cull_query **out)
{
    cull_query *q = take(c->host, sizeof *q);
    if (!q) return CULL_ERR_MEMORY;
    memset(q, 0, sizeof *q);
    q->culler = c;
    q->spare = take(c->host, 64);
    if (!q->spare) {
        c->host->free(c->host, q, sizeof *q);
        return CULL_ERR_MEMORY;
    }
    if (IS(LEAKS_HEAP) && !malloc(100000)) return CULL_ERR_MEMORY;
    *out = q;
    return CULL_OK;
}

static void close_query(cull_query *q)
{
    const cull_host *host = q->culler->host;
    host->free(host, q->spare, 64);
    host->free(host, q, sizeof *q);
}

// ---- A step ----

static int drops(const cull_culler *c, const cull_visit *v, uint32_t item)
{
    const cull_box b = c->boxes[item];
    const float *eye = v->view->eye, *low = &b.min.x, *high = &b.max.x;
    float square = 0, size = 0;
    for (int i = 0; i < 3; i++) {
        const float away = low[i] - eye[i] > 0 ? low[i] - eye[i] : eye[i] - high[i] > 0 ? eye[i] - high[i] : 0;
        square += away * away;
        size = high[i] - low[i] > size ? high[i] - low[i] : size;
        if (IS(DROPS_ON_PLANE) && (eye[i] == low[i] || eye[i] == high[i]) && eye[i] != 0) return 1;
    }
    if (IS(DROPS_SUB_PIXEL)) return size * v->view->pixels_per_tangent < 0.9f * sqrtf(square);
    return IS(DROPS_ONE_IN_1000) && (item * 2654435761u >> 8) % 1000 == 7;
}

static int touches(const cull_volume *volumes, uint32_t count, cull_box box)
{
    for (uint32_t i = 0; i < count; i++) {
        cull_volume v = volumes[i];
        cull_plane planes[CULL_MAX_PLANES];
        if (IS(SHRINKS_A_PLANE) && v.plane_count) {
            memcpy(planes, v.planes, v.plane_count * sizeof *planes);
            planes[0].offset -= 0.7f;
            v.planes = planes;
        }
        if (cull_volume_touches(&v, box)) return 1;
    }
    return 0;
}

static void remember(memory *m, const cull_visit *v)
{
    m->count = v->volume_count < 64 ? v->volume_count : 64;
    m->has_any = 1;
    memcpy(m->eye, v->view->eye, sizeof m->eye);
    for (uint32_t i = 0; i < m->count; i++) {
        if (v->volumes[i].plane_count) memcpy(m->planes[i], v->volumes[i].planes, v->volumes[i].plane_count * sizeof(cull_plane));
        m->volumes[i] = (cull_volume){m->planes[i], v->volumes[i].plane_count, 0};
    }
}

static void misbehave(cull_query *q, const cull_visit *v, cull_batch *b)
{
    const cull_culler *c = q->culler;
    if (IS(COUNTS_IN_GLOBAL)) steps_so_far++;
    if (IS(ALLOCATES)) {
        void *volatile spare = malloc(100);
        free(spare);
    }
    if (IS(ALLOCATES_FROM_HOST)) c->host->free(c->host, take(c->host, 100), 100);
    if (IS(READS_FILE)) {
        char text[16];
        const int file = open("/dev/zero", O_RDONLY);
        if (file >= 0 && read(file, text, sizeof text) < 0) b->limits_hit++;
        if (file >= 0) close(file);
    }
    if (IS(SLEEPS)) nanosleep(&(struct timespec){0, 1000000}, NULL);
    if (IS(MUTATES_ZONE) && c->item_count) ((cull_item *)(uintptr_t)c->zone->items)[0].reserved++;
    if (IS(CRASHES) && (uint32_t)(v->view->eye[0] * 1000) % 5 == 3) *(volatile int *)nowhere = 1;
    if (IS(NEVER_ENDS) && v->volume_count > 1)
        for (volatile int i = 1; i; i = 1) continue;
    if (IS(NAN_CRASH) && !(v->view->eye[0] < 1e30f)) *(volatile int *)nowhere = 1;
    if (IS(READS_PAST_PLANES) && v->volume_count && v->volumes[v->volume_count - 1].planes) {
        const volatile float *end = &v->volumes[0].planes[v->volumes[0].plane_count].offset;
        if (*end == 12345.0f) b->limits_hit++;
    }
}

static cull_progress select_items(cull_query *q, const cull_visit *v, cull_batch *b)
{
    const cull_culler *c = IS(KEEPS_GLOBALS) ? newest : q->culler;
    const cull_volume *volumes = v->volumes;
    uint32_t count = v->volume_count;
    misbehave(q, v, b);
    if (IS(STEPS_FOR_EVER) && v->step) return CULL_MORE;
    if (IS(SKIPS_LAST_VOLUME) && count > 1) count--;
    if (IS(RACES)) { // through memory that all queries share
        count = count < 64 ? count : 64;
        memcpy(c->shared, volumes, count * sizeof *volumes);
        volumes = c->shared;
    }
    if (IS(IGNORES_CHANGE) && !(q->last.has_any && memcmp(q->last.eye, v->view->eye, sizeof q->last.eye) == 0)) remember(&q->last, v);
    if ((IS(PREVIOUS_VIEW) && q->last.has_any) || IS(IGNORES_CHANGE)) volumes = q->last.volumes, count = q->last.count;
    if (IS(REPLACES_LIST)) b->runs = q->away;
    for (uint32_t i = 0; i < c->item_count; i++) {
        if (!touches(volumes, count, c->boxes[i]) || drops(c, v, i)) continue;
        if (b->run_count && b->runs[b->run_count - 1].first + b->runs[b->run_count - 1].count == i) b->runs[b->run_count - 1].count++;
        else b->runs[b->run_count++] = (cull_run){i, 1};
    }
    if (IS(PREVIOUS_VIEW)) remember(&q->last, v);
    if (IS(UNINITIALISED) && q->spare[0] == 0x3c) b->run_count = 1, b->runs[0] = (cull_run){0, c->item_count};
    if (IS(DUPLICATES) && b->run_count && b->run_count < c->item_count) b->runs[b->run_count] = b->runs[0], b->run_count++;
    if (IS(OUTSIDE_ZONE) && b->run_count) b->runs[b->run_count - 1].count = c->item_count + 1;
    if (IS(EMPTY_RUN) && b->run_count < c->item_count) b->runs[b->run_count++] = (cull_run){0, 0};
    if (IS(WRITES_PAST_END)) b->runs[c->item_count] = (cull_run){0, 0};
    return IS(STEPS_FOR_EVER) ? CULL_MORE : CULL_DONE;
}

// ---- Other verbs ----

static float distance_of(const cull_box *b, const float *eye)
{
    const float *low = &b->min.x, *high = &b->max.x;
    float square = 0;
    for (int i = 0; i < 3; i++) {
        const float away = low[i] - eye[i] > 0 ? low[i] - eye[i] : eye[i] - high[i] > 0 ? eye[i] - high[i] : 0;
        square += away * away;
    }
    return square;
}

// Runs of one item each, sorted as Shell did: nothing is allocated.
static void sort_runs(const cull_culler *c, const float *eye, cull_run *runs, uint32_t count)
{
    for (uint32_t gap = count / 2; gap > 0; gap /= 2)
        for (uint32_t i = gap; i < count; i++) {
            const cull_run run = runs[i];
            const float at = distance_of(&c->boxes[run.first], eye);
            uint32_t k = i;
            for (; k >= gap && distance_of(&c->boxes[runs[k - gap].first], eye) > at; k -= gap) runs[k] = runs[k - gap];
            runs[k] = run;
        }
}

static cull_progress select_sorted(cull_query *q, const cull_visit *v, cull_batch *b)
{
    for (uint32_t i = 0; i < q->culler->item_count; i++)
        if (touches(v->volumes, v->volume_count, q->culler->boxes[i])) b->runs[b->run_count++] = (cull_run){i, 1};
    sort_runs(q->culler, v->view->eye, b->runs, b->run_count);
    return CULL_DONE;
}

static cull_crossing cross(cull_query *q, const cull_view *view, const cull_volume *in, uint32_t portal, cull_plane *planes, uint32_t *plane_count)
{
    (void)q, (void)view, (void)in, (void)portal, (void)planes, (void)plane_count;
    return CULL_CROSS_NONE;
}

// ---- What it lends ----

static size_t explain_item(cull_query *q, const cull_visit *v, uint32_t item, char *text, size_t size)
{
    static const char why[] = "kept, or not";
    (void)q, (void)v, (void)item;
    memset(text, 0, size + 1);
    memcpy(text, why, size < sizeof why ? size - 1 : sizeof why);
    return sizeof why - 1;
}
static const cull_explain explain = {explain_item};

static uint32_t no_segment(const cull_culler *c, cull_vec3 from, cull_vec3 to, cull_run *runs, uint32_t max_runs)
{
    (void)c, (void)from, (void)to, (void)runs, (void)max_runs;
    return 0;
}
static uint32_t no_box(const cull_culler *c, const cull_box *box, cull_run *runs, uint32_t max_runs)
{
    (void)c, (void)box, (void)runs, (void)max_runs;
    return 0;
}
static const cull_ray ray = {no_segment, no_box};

static uint64_t save(const cull_culler *c, void *blob, uint64_t size)
{
    const uint64_t needed = sizeof(blob_head) + c->item_count * sizeof *c->boxes;
    if (size < needed) return needed;
    const blob_head head = {0x6b6f7262, c->item_count, hash_of(c->boxes, c->item_count)};
    memcpy(blob, &head, sizeof head);
    memcpy((char *)blob + sizeof head, c->boxes, c->item_count * sizeof *c->boxes);
    if (IS(SAVES_TOO_MUCH)) memset((char *)blob + needed, 0, 64);
    return needed;
}
static const cull_bake bake = {save};

static const void *get_extension(const cull_culler *c, const char *id)
{
    if (!c && !IS(NEEDS_A_CULLER)) return NULL;
    if (IS(NEEDS_A_CULLER) && c->item_count == 0) return NULL;
    if (strcmp(id, CULL_EXT_BAKE) == 0) return &bake;
    if (IS(EXPLAINS_PAST_END) && strcmp(id, CULL_EXT_EXPLAIN) == 0) return &explain;
    if (IS(RAY_MISSES) && strcmp(id, CULL_EXT_RAY) == 0) return &ray;
    return strcmp(id, CULL_EXT_HIERARCHY) == 0 ? &c->tree : NULL;
}

static const cull_option options[] = {{"mode", "plain", "plain fancy", "how it goes about it: plain or fancy"}, {"band", "5", "0 5 100", "0 to 100"}};
static const cull_descriptor descriptor = {NAME, "1", IS(NO_SUMMARY) ? NULL : "for tests of portcullis check", options, 2,
                                           CULL_CONSERVATIVE | CULL_SAMPLED | CULL_STATELESS | (IS(CLAIMS_ORDERED) || IS(SORTS) ? CULL_ORDERED : 0u)};
static const cull_plugin plugin = {.descriptor = &descriptor, .create = create, .destroy = destroy, .build = build, .open = open_query, .close = close_query,
                                   .select = IS(CROSSES_NOTHING) ? NULL : IS(SORTS) ? select_sorted : select_items,
                                   .cross = IS(CROSSES_NOTHING) ? cross : NULL, .get_extension = get_extension};
static const cull_plugin *const plugins[] = {&plugin};
CULL_ENTRY = {IS(WRONG_ABI) ? CULL_ABI + 7 : CULL_ABI, 1, plugins};
