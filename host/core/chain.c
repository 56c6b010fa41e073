// Chains: creates, builds and checks the cullers of one zone, and lays the zone out in the select's order.
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 200809L
#include "chain.h"

#include "hierarchy_check.h"

#include <string.h>
#include <time.h>

static const size_t SCRATCH_BYTES_MOST = (size_t)1 << 32; // a culler that wants more is wrong about something
enum { LIST_MOST = 1 << 28 };                             // and so with every capacity it tells

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// ---- The zone as plugins see it ----

static const float *floats_in_order(chain *c, const float *from)
{
    const uint32_t count = c->zone.item_count;
    float *to = arena_push(&c->memory, (size_t)count + CULL_PADDING, sizeof *to);
    if (!to) return NULL;
    for (uint32_t i = 0; i < count; ++i) to[i] = from[c->order[i]];
    memset(to + count, 0, CULL_PADDING * sizeof *to);
    return to;
}

// Items, boxes and walls in the select's order, for the stages behind it.
static result zone_in_order(chain *c)
{
    c->ordered_zone = c->zone;
    if (!c->order || c->stage_count == 1) return RESULT_OK;
    const uint32_t count = c->zone.item_count;
    const cull_boxes *b = &c->zone.boxes;
    const cull_boxes to = {floats_in_order(c, b->min_x), floats_in_order(c, b->min_y), floats_in_order(c, b->min_z),
                           floats_in_order(c, b->max_x), floats_in_order(c, b->max_y), floats_in_order(c, b->max_z)};
    cull_item *items = arena_push(&c->memory, count, sizeof *items);
    cull_wall *walls = c->zone.walls ? arena_push(&c->memory, count, sizeof *walls) : NULL;
    if (!to.min_x || !to.min_y || !to.min_z || !to.max_x || !to.max_y || !to.max_z || !items || (c->zone.walls && !walls)) return RESULT_NO_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        items[i] = c->zone.items[c->order[i]];
        if (walls) walls[i] = c->zone.walls[c->order[i]];
    }
    c->ordered_zone.items = items;
    c->ordered_zone.boxes = to;
    c->ordered_zone.walls = walls;
    return RESULT_OK;
}

static result order_is_permutation(chain *c, const char *id, report *r)
{
    const uint32_t count = c->zone.item_count;
    uint8_t *seen = memory_alloc_zeroed(c->memory.memory, count, 1);
    if (!seen) return report_no_memory(r, NULL);
    uint32_t good = 0;
    for (uint32_t i = 0; i < count; ++i)
        if (c->order[i] < count && !seen[c->order[i]]) good += seen[c->order[i]] = 1;
    memory_free(c->memory.memory, seen, count, 1);
    return good == count ? RESULT_OK : report_error(r, NULL, 0, "culler '%s' returned an order that is no permutation of the zone's items; mend the plugin", id);
}

// ---- One stage ----

static result option_values(const cull_descriptor *d, const chain_stage_spec *spec, report *r, const char **values)
{
    for (uint32_t i = 0; i < d->option_count; ++i) values[i] = d->options[i].fallback;
    for (uint32_t k = 0; k < spec->option_count; ++k) {
        uint32_t i = 0;
        while (i < d->option_count && strcmp(d->options[i].key, spec->options[k].key) != 0) ++i;
        if (i == d->option_count) {
            char keys[256] = "";
            for (uint32_t o = 0; o < d->option_count && strlen(keys) + strlen(d->options[o].key) + 3 < sizeof keys; ++o) {
                if (o) strcat(keys, ", ");
                strcat(keys, d->options[o].key);
            }
            return report_error(r, NULL, 0, "culler '%s' has no option '%s'; it has: %s", d->id, spec->options[k].key, *keys ? keys : "none");
        }
        values[i] = spec->options[k].value;
    }
    return RESULT_OK;
}

static result tell_failure(cull_result code, const chain_stage *stage, const char *what, report *r)
{
    const char *id = stage->plugin->descriptor->id;
    if (code == CULL_ERR_MEMORY) return report_no_memory(r, NULL);
    if (code == CULL_ERR_OPTION) return report_error(r, NULL, 0, "culler '%s' refused an option; `portcullis plugins` lists them", id);
    if (code == CULL_ERR_BLOB) return report_error(r, NULL, 0, "culler '%s' refused a baked index; compile the scene again", id);
    return report_error(r, NULL, 0, "culler '%s' could not %s this zone (result %d); try another chain", id, what, (int)code);
}

static result built_is_sound(const chain_stage *stage, const cull_hierarchy *lent, report *r)
{
    const cull_built *b = &stage->built;
    const cull_promises may = stage->plugin->descriptor->may_promise;
    const char *fault = NULL;
    if (b->max_steps < 1 || b->max_steps > CULL_MAX_STEPS) fault = "max_steps is not 1 .. 1,000,000";
    else if (b->max_runs > LIST_MOST || b->max_tests > LIST_MOST || b->max_captures > LIST_MOST || b->max_pictures > LIST_MOST || b->max_clipped > LIST_MOST ||
             b->slot_count > LIST_MOST)
        fault = "a capacity is over 2^28";
    else if (b->scratch_size > SCRATCH_BYTES_MOST) fault = "it wants over 4 GiB of scratch";
    else if (b->promises & ~may) fault = "it promises more than its descriptor's may_promise";
    else if (b->walks_hierarchy && stage->role == ROLE_FILTER && !lent) fault = "it walks a hierarchy, and the select has none";
    else if (b->max_captures && !b->slot_count) fault = "it captures without slots";
    return fault ? report_error(r, NULL, 0, "culler '%s' told nonsense after build: %s; mend the plugin", stage->plugin->descriptor->id, fault) : RESULT_OK;
}

static result stage_role_of(const cull_plugin *p, uint32_t place, uint32_t *crossers, report *r, stage_role *out)
{
    const char *id = p->descriptor->id;
    if (place == 0 && !p->select) return report_error(r, NULL, 0, "culler '%s' cannot stand first: it selects nothing; put one such as frustum before it", id);
    *out = place == 0 ? ROLE_SELECT : p->filter ? ROLE_FILTER : ROLE_CROSS;
    if (place > 0 && !p->filter && !p->cross) return report_error(r, NULL, 0, "culler '%s' can only stand first in a chain: it neither filters nor crosses", id);
    if (*out == ROLE_CROSS && ++*crossers > 1) return report_error(r, NULL, 0, "culler '%s' is the second crosser of its chain; one at most", id);
    return RESULT_OK;
}

// Asked for and checked once, before anyone walks it.
static result take_hierarchy(chain *c, report *r)
{
    const chain_stage *select = &c->stages[0];
    const cull_hierarchy *h = select->plugin->get_extension(select->culler, CULL_EXT_HIERARCHY);
    const char *fault;
    if (!h) return RESULT_OK;
    if (hierarchy_check(h, &c->ordered_zone, c->memory.memory, &fault) != RESULT_OK) return report_no_memory(r, NULL);
    if (fault) return report_error(r, NULL, 0, "culler '%s' lends a hierarchy that is nonsense: %s; mend the plugin", select->plugin->descriptor->id, fault);
    c->hierarchy = h;
    return RESULT_OK;
}

// What only the first stage has: order and hierarchy, for those behind it.
static result take_layout(chain *c, report *r)
{
    c->order = c->stages[0].built.order;
    result done = c->order ? order_is_permutation(c, c->stages[0].plugin->descriptor->id, r) : RESULT_OK;
    if (done == RESULT_OK && zone_in_order(c) != RESULT_OK) done = report_no_memory(r, NULL);
    return done == RESULT_OK && c->stage_count > 1 ? take_hierarchy(c, r) : done;
}

// A slot is a number of one stage, and a viewer has one set of them.
static result slots_are_free(const chain *c, uint32_t place, report *r)
{
    if (!c->stages[place].built.slot_count) return RESULT_OK;
    for (uint32_t i = 0; i < place; ++i)
        if (c->stages[i].built.slot_count)
            return report_error(r, NULL, 0, "cullers '%s' and '%s' both take pictures; one of a chain at most", c->stages[i].plugin->descriptor->id, c->stages[place].plugin->descriptor->id);
    return RESULT_OK;
}

static void loading_begins(const chain_request *q)
{
    if (q->loading) pthread_mutex_lock(q->loading);
}

static void loading_ends(const chain_request *q)
{
    if (q->loading) pthread_mutex_unlock(q->loading);
}

// ---- Baked indices ----

// The extension asks with the host that the culler was made with, which is the first member of its stage.
static const void *stage_extension(const cull_host *host, const cull_zone *zone, const char *id)
{
    const chain_stage *stage = (const chain_stage *)(const void *)host;
    const cull_host *services = &stage->services->host;
    if (!zone || zone != stage->zone || strcmp(id, CULL_EXT_BLOB) != 0) return services->get_extension(services, zone, id);
    return stage->blob.bytes ? &stage->blob : NULL;
}

bake_key chain_bake_key(const chain *c, uint32_t place)
{
    const chain_stage *stage = &c->stages[place];
    const cull_zone *zone = place == 0 ? &c->zone : &c->ordered_zone;
    return (bake_key){stage->plugin->descriptor, stage->options_hash, bake_zone_hash(zone, place == 0 ? NULL : c->hierarchy), c->data->index};
}

static void tell_blob(const chain *c, uint32_t place, const char *why, report *r)
{
    report_warning(r, c->data->scene->path, 0, "culler '%s' cannot use its baked index of zone %u: %s; it is built anew, compile the scene again to keep it",
                   c->stages[place].plugin->descriptor->id, c->data->index, why);
}

static void stage_find_blob(chain *c, uint32_t place, const char *const *values, report *r)
{
    chain_stage *stage = &c->stages[place];
    const scene *s = c->data->scene;
    stage->zone = place == 0 ? &c->zone : &c->ordered_zone;
    stage->options_hash = bake_options_hash(stage->plugin->descriptor, values);
    if (!s->bake_count) return; // nothing is hashed for nothing
    const bake_key key = chain_bake_key(c, place);
    const scene_bake *found = bake_find(s, &key);
    if (found) {
        stage->blob = (cull_blob){found->bytes, found->size};
        return;
    }
    const char *why = bake_fault(s, &key);
    if (why) tell_blob(c, place, why, r);
}

// ---- Building ----

static cull_result stage_create(chain_stage *stage, const char *const *values, const chain_request *q)
{
    cull_culler *made = NULL; // not the stage's own: what a failed create leaves there is nothing to destroy
    loading_begins(q);
    stage->services = q->services;
    stage->host = q->services->host;
    stage->host.get_extension = stage_extension;
    const cull_result code = stage->plugin->create(&stage->host, values, &made);
    loading_ends(q);
    if (code == CULL_OK) stage->culler = made;
    return code;
}

// A culler that refused its blob is made once more and lent none.
static cull_result stage_build_anew(chain *c, uint32_t place, const char *const *values, const chain_request *q)
{
    chain_stage *stage = &c->stages[place];
    loading_begins(q);
    stage->plugin->destroy(stage->culler);
    loading_ends(q);
    stage->culler = NULL;
    stage->blob = (cull_blob){NULL, 0};
    stage->built = (cull_built){0};
    const cull_result created = stage_create(stage, values, q);
    if (!stage->culler) return created != CULL_OK ? created : CULL_ERR_ZONE;
    return stage->plugin->build(stage->culler, stage->zone, c->hierarchy, &stage->built);
}

static result stage_build(chain *c, uint32_t place, const chain_request *q, report *r)
{
    chain_stage *stage = &c->stages[place];
    const char *values[256];
    result done = option_values(stage->plugin->descriptor, &q->spec->stages[place], r, values);
    if (done != RESULT_OK) return done;
    const cull_result created = stage_create(stage, values, q);
    if (!stage->culler) return tell_failure(created != CULL_OK ? created : CULL_ERR_ZONE, stage, "create an index for", r);
    stage_find_blob(c, place, values, r);
    cull_result code = stage->plugin->build(stage->culler, stage->zone, c->hierarchy, &stage->built); // the first is lent none: it is not taken yet
    if (code == CULL_ERR_BLOB && stage->blob.bytes) {
        tell_blob(c, place, "the culler refused it", r);
        code = stage_build_anew(c, place, values, q);
    }
    if (code != CULL_OK) return tell_failure(code, stage, "build", r);
    done = built_is_sound(stage, c->hierarchy, r);
    if (done == RESULT_OK) done = slots_are_free(c, place, r);
    return done == RESULT_OK && place == 0 ? take_layout(c, r) : done;
}

static void chain_sum_up(chain *c)
{
    c->promises = ~0u;
    for (uint32_t i = 0; i < c->stage_count; ++i) {
        const cull_built *b = &c->stages[i].built;
        c->promises &= b->promises & CULL_CONSERVATIVE ? b->promises | CULL_SAMPLED : b->promises; // the stronger holds the weaker
        c->index_bytes += b->index_bytes;
        c->uses_renderer |= b->max_tests || b->max_captures || b->max_pictures || b->max_clipped;
    }
}

static result find_plugins(chain *c, const chain_request *q, report *r)
{
    uint32_t crossers = 0;
    result done = RESULT_OK;
    loading_begins(q);
    for (uint32_t i = 0; i < c->stage_count && done == RESULT_OK; ++i) {
        done = loader_find(q->plugins, q->spec->stages[i].id, r, &c->stages[i].plugin);
        if (done == RESULT_OK) done = stage_role_of(c->stages[i].plugin, i, &crossers, r, &c->stages[i].role);
    }
    loading_ends(q);
    return done;
}

static result chain_fill(chain *c, const chain_request *q, report *r)
{
    const result found = find_plugins(c, q, r);
    if (found != RESULT_OK) return found;
    const double start = cpu_ms();
    for (uint32_t i = 0; i < c->stage_count; ++i) {
        const result done = stage_build(c, i, q, r);
        if (done != RESULT_OK) return done;
    }
    c->build_ms = cpu_ms() - start;
    chain_sum_up(c);
    return RESULT_OK;
}

static size_t chain_bytes(uint32_t stage_count)
{
    return sizeof(chain) + stage_count * sizeof(chain_stage);
}

result chain_build(const chain_request *q, report *r, chain **out)
{
    const allocator *memory = q->services->memory;
    chain *c = memory_alloc_zeroed(memory, 1, chain_bytes(q->spec->stage_count));
    if (!c) return report_no_memory(r, NULL);
    c->stage_count = q->spec->stage_count;
    c->memory = arena_make(memory);
    c->data = q->zone;
    c->zone = q->zone->zone;
    const result done = chain_fill(c, q, r);
    if (done != RESULT_OK) {
        chain_close(c);
        return done;
    }
    *out = c;
    return RESULT_OK;
}

void chain_close(chain *c)
{
    if (!c) return;
    for (uint32_t i = c->stage_count; i-- > 0;)
        if (c->stages[i].culler) c->stages[i].plugin->destroy(c->stages[i].culler);
    const allocator *memory = c->memory.memory;
    arena_free(&c->memory);
    memory_free(memory, c, 1, chain_bytes(c->stage_count));
}
