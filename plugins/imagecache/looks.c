// Hidden nodes: see looks.h.
// SPDX-License-Identifier: MIT
#include "looks.h"

#include <string.h>

enum { SEEN_AGAIN = 8, RARELY = 32 }; // frames between two tests of what is believed to be seen, and where tests find little
#define HITS_KEPT 0.98   // of the share, a test
#define HITS_LEAST 0.05  // below, tests of what is believed to be seen don't pay

int looks_open(const cull_host *host, const lists *l, looks *out)
{
    memset(out, 0, sizeof *out);
    out->bytes = l->node_count * sizeof *out->hidden;
    out->hidden = host->alloc(host, out->bytes, _Alignof(uint32_t));
    if (!out->hidden) return 0;
    memset(out->hidden, 0, out->bytes);
    out->lists = l;
    out->frame = 1;
    out->hits = 1;
    return 1;
}

void looks_close(const cull_host *host, looks *l)
{
    if (l->hidden) host->free(host, l->hidden, l->bytes);
}

void looks_begin(looks *l)
{
    l->asked = l->found = 0;
    if (++l->frame) return;
    memset(l->hidden, 0, l->bytes); // after 2^32 frames old ones would look new
    l->frame = 2;
}

int looks_was_hidden(const looks *l, uint32_t node)
{
    for (;; node = nodes_parent(node)) {
        if (l->hidden[node] == l->frame - 1) return 1;
        if (node == 0) return 0;
    }
}

void looks_ask_box(looks *l, uint32_t node, cull_batch *batch)
{
    batch->tests[batch->test_count++] = (cull_test){l->lists->nodes[node].box, node, 0};
    l->asked++;
}

static int is_due(const looks *l, uint32_t node, uint32_t every)
{
    return looks_was_hidden(l, node) || (node + l->frame) % (l->hits < HITS_LEAST ? RARELY : every) == 0;
}

void looks_ask(looks *l, uint32_t node, looks_need need, cull_batch *batch)
{
    if (is_due(l, node, need == LOOKS_DEAR ? 1 : SEEN_AGAIN)) looks_ask_box(l, node, batch);
}

int looks_should_wait(const looks *l, uint32_t node)
{
    return is_due(l, node, SEEN_AGAIN);
}

void looks_learn(looks *l, const cull_visit *visit)
{
    for (uint32_t i = 0; i < visit->answer_count; i++) {
        const cull_answer a = visit->answers[i];
        if (a.age != 0 || a.tag >= l->lists->node_count) continue;
        const int was = looks_was_hidden(l, a.tag), is = a.pixels == 0;
        if (!was) l->hits = HITS_KEPT * l->hits + (is ? 1 - HITS_KEPT : 0);
        if (!is) continue;
        l->hidden[a.tag] = l->frame;
        l->found++;
    }
}
