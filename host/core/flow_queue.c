// The work list of a flow: nodes whose portals are still to be tried, the nearest first (Dijkstra, 1959, by keys that only rise
// along a way).
// SPDX-License-Identifier: MIT
// Invariant: a node is queued at most once at a time, so the heap holds them all.
#include "flow_internal.h"

static int is_before(flow_turn a, flow_turn b)
{
    return a.key < b.key || (a.key == b.key && a.turn < b.turn);
}

static void put(flow *f, uint32_t place, flow_turn turn)
{
    f->queue[place] = turn;
    f->queue_places[turn.node] = place;
}

static void sift_up(flow *f, uint32_t place, flow_turn turn)
{
    for (; place > 0 && is_before(turn, f->queue[(place - 1) / 2]); place = (place - 1) / 2) put(f, place, f->queue[(place - 1) / 2]);
    put(f, place, turn);
}

static void sift_down(flow *f, flow_turn turn)
{
    uint32_t place = 0;
    for (uint32_t child = 1; child < f->queue_count; child = 2 * place + 1) {
        if (child + 1 < f->queue_count && is_before(f->queue[child + 1], f->queue[child])) child++;
        if (!is_before(f->queue[child], turn)) break;
        put(f, place, f->queue[child]);
        place = child;
    }
    put(f, place, turn);
}

void flow_queue(flow *f, flow_node *n)
{
    if (n->flags & NODE_QUEUED) return;
    n->flags |= NODE_QUEUED;
    sift_up(f, f->queue_count++, (flow_turn){n->key, f->queue_turns++, (uint32_t)(n - f->nodes)});
}

void flow_nearer(flow *f, flow_node *n, double key)
{
    if (!(key < n->key)) return;
    n->key = key;
    const uint32_t place = f->queue_places[n - f->nodes];
    if (n->flags & NODE_QUEUED) sift_up(f, place, (flow_turn){key, f->queue[place].turn, f->queue[place].node});
    else if (n->source == 0) flow_queue(f, n); // it left already: the zones behind are nearer too
}

flow_node *flow_queue_pop(flow *f)
{
    flow_node *n = &f->nodes[f->queue[0].node];
    n->flags &= ~(uint32_t)NODE_QUEUED;
    if (--f->queue_count > 0) sift_down(f, f->queue[f->queue_count]);
    return n;
}
