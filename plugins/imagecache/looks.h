// Which nodes are hidden by the geometry in front of them: their boxes are tested in the frame's first step, and what is hidden is neither taken nor
// shown in its second, as a picture or as geometry that was hidden before. Who was seen of late is believed to be so still (Bittner et al., coherent hierarchical culling, 2004).
// SPDX-License-Identifier: MIT
//
// Invariant: a node counts as hidden by an answer of this very frame only. Beliefs say what to ask, and what a picture is foretold to cost.
#ifndef PORTCULLIS_IMAGECACHE_LOOKS_H
#define PORTCULLIS_IMAGECACHE_LOOKS_H

#include "lists.h"

// A query's memory of them.
typedef struct looks {
    const lists *lists;
    uint32_t *hidden; // by node: the frame that it was hidden in last
    uint32_t frame;   // of this frame, from 2 on: 0 never was one
    double hits;      // share of tests of what was not hidden before that found it hidden, of late
    uint32_t asked, found; // this frame
    size_t bytes;
} looks;

int looks_open(const cull_host *host, const lists *l, looks *out); // 0: no memory
void looks_close(const cull_host *host, looks *l);
void looks_begin(looks *l); // a frame

typedef enum looks_need { LOOKS_CHEAP, LOOKS_DEAR } looks_need; // dear: if it is seen, its picture has to be taken anew

// Asks about a node where that pays.
void looks_ask(looks *l, uint32_t node, looks_need need, cull_batch *batch);
// A node whose geometry waits for the answer is asked in any case; whether it should wait:
int looks_should_wait(const looks *l, uint32_t node);
void looks_ask_box(looks *l, uint32_t node, cull_batch *batch);
// Takes the answers of this frame.
void looks_learn(looks *l, const cull_visit *visit);

static inline int looks_is_hidden(const looks *l, uint32_t node)
{
    return l->hidden[node] == l->frame;
}

// It was, in the frame before, or something above it was.
int looks_was_hidden(const looks *l, uint32_t node);

#endif
