// Bakes the indices of a world's chains: asks each built culler for cull.bake/1, and keeps what it saves under its key.
// SPDX-License-Identifier: MIT
#include "bake_zones.h"

#include "../core/world_parts.h"

#include <string.h>

static const uint64_t BLOB_BYTES_MOST = UINT64_C(1) << 36; // of one zone: a culler that wants more is wrong about something

typedef struct baking {
    const world *world;
    report *report;
    baked_zones *to;
    buffer bakes; // scene_bake
} baking;

static result tell(baking *b, const cull_descriptor *d, const char *what)
{
    return report_error(b->report, NULL, 0, "culler '%s' cannot be baked: %s; mend the plugin", d->id, what);
}

static result bake_stage(baking *b, uint32_t zone, const chain *c, uint32_t place)
{
    const chain_stage *stage = &c->stages[place];
    const cull_descriptor *d = stage->plugin->descriptor;
    const cull_bake *bake = stage->plugin->get_extension(stage->culler, CULL_EXT_BAKE);
    if (!bake || !bake->save) {
        b->to->cullers_without++;
        return RESULT_OK;
    }
    const uint64_t size = bake->save(stage->culler, NULL, 0);
    if (size == 0 || size > BLOB_BYTES_MOST) return tell(b, d, "it says that its index takes 0 bytes, or over 64 GiB");
    if (size > SIZE_MAX / 2) return report_no_memory(b->report, NULL);
    void *blob = arena_push(&b->to->memory, (size_t)size, 1);
    scene_bake *made = blob ? buffer_push(&b->bakes, 1) : NULL;
    if (!made) return report_no_memory(b->report, NULL);
    memset(blob, 0, (size_t)size); // what it leaves out is the same each time
    if (bake->save(stage->culler, blob, size) != size) return tell(b, d, "its index changes its size from one call to the next");
    const bake_key key = chain_bake_key(c, place);
    *made = (scene_bake){.id = d->id, .version = d->version, .options_hash = key.options_hash, .zone_hash = key.zone_hash, .bytes = blob, .size = size, .zone = zone};
    b->to->bytes += size;
    return RESULT_OK;
}

static result bake_all(baking *b)
{
    for (uint32_t z = 0; z < b->world->scene->zone_count; ++z) {
        const chain *c = world_chain(b->world, z);
        for (uint32_t i = 0; c && i < c->stage_count; ++i) {
            const result done = bake_stage(b, z, c, i);
            if (done != RESULT_OK) return done;
        }
    }
    return RESULT_OK;
}

static result keep_list(baking *b)
{
    b->to->count = (uint32_t)b->bakes.count;
    b->to->bakes = arena_push(&b->to->memory, b->bakes.count, sizeof(scene_bake));
    if (!b->to->bakes) return report_no_memory(b->report, NULL);
    if (b->bakes.count) memcpy(b->to->bakes, b->bakes.items, b->bakes.count * sizeof(scene_bake));
    return RESULT_OK;
}

result baked_zones_make(const world *w, const allocator *memory, report *r, baked_zones *out)
{
    baked_zones made = {.memory = arena_make(memory)};
    baking b = {.world = w, .report = r, .to = &made, .bakes = buffer_make(memory, sizeof(scene_bake))};
    result done = bake_all(&b);
    if (done == RESULT_OK) done = keep_list(&b);
    buffer_free(&b.bakes);
    if (done == RESULT_OK) *out = made;
    else baked_zones_free(&made);
    return done;
}

void baked_zones_free(baked_zones *b)
{
    if (b->memory.memory) arena_free(&b->memory);
    *b = (baked_zones){0};
}
