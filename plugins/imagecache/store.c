// Memory of pictures: see store.h.
// SPDX-License-Identifier: MIT
#include "store.h"

#include <string.h>

enum { EMPTY_BYTES = 8 }; // a texel, with depth

int store_open(const cull_host *host, uint32_t slot_count, store *out)
{
    memset(out, 0, sizeof *out);
    out->size = 3 * (size_t)slot_count * sizeof *out->bytes;
    out->bytes = host->alloc(host, out->size, _Alignof(uint32_t));
    if (!out->bytes) return 0;
    memset(out->bytes, 0, out->size);
    out->asked = out->bytes + slot_count;
    out->used = out->asked + slot_count;
    out->slot_count = slot_count;
    return 1;
}

void store_close(const cull_host *host, store *s)
{
    if (s->bytes) host->free(host, s->bytes, s->size);
}

void store_begin(store *s, const cull_visit *visit, uint32_t frame, uint64_t most)
{
    s->frame = frame;
    s->most = most;
    s->held = s->evicted = 0;
    for (uint32_t i = 0; i < s->slot_count; i++) {
        if (s->asked[i] && visit->slots[i]) s->bytes[i] = s->asked[i];
        s->asked[i] = 0;
        s->held += s->bytes[i];
    }
}

void store_keep(store *s, uint32_t slot)
{
    s->used[slot] = s->frame;
}

static uint32_t oldest(const store *s)
{
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < s->slot_count; i++) {
        if (s->bytes[i] <= EMPTY_BYTES || s->used[i] == s->frame) continue;
        if (found == UINT32_MAX || s->frame - s->used[i] > s->frame - s->used[found]) found = i;
    }
    return found;
}

// Straight ahead of the view's eye, so that it can be taken; nothing is in it.
static void empty(store *s, const store_request *q, uint32_t slot, cull_batch *batch)
{
    const float *eye = q->visit->view->eye;
    const cull_vec3 at = {eye[0], eye[1], eye[2]};
    batch->captures[batch->capture_count++] = (cull_capture){.box = {at, at}, .corner = {at.x - 0.5f, at.y - 0.5f, at.z - 1}, .right = {1, 0, 0},
                                                             .up = {0, 1, 0}, .slot = slot, .width_px = 1, .height_px = 1};
    s->held -= s->bytes[slot] - EMPTY_BYTES;
    s->bytes[slot] = EMPTY_BYTES;
    s->evicted++;
}

int store_take(store *s, const store_request *q, cull_batch *batch)
{
    const uint32_t more = q->bytes > s->bytes[q->slot] ? q->bytes - s->bytes[q->slot] : 0;
    while (s->held + more > s->most) {
        const uint32_t slot = oldest(s);
        if (slot == UINT32_MAX || batch->capture_count + 1 >= q->captures_most) return 0;
        empty(s, q, slot, batch);
    }
    if (batch->capture_count >= q->captures_most) return 0;
    s->held += more;
    s->bytes[q->slot] += more;
    s->asked[q->slot] = q->bytes;
    return 1;
}
