// Why an item is kept or dropped: see explain.h.
// SPDX-License-Identifier: MIT
#include "explain.h"

#include <stdio.h>

size_t explain_item(const occlusion_walk *w, uint32_t item, char *text, size_t size)
{
    const occlusion_tree *t = w->tree;
    const occlusion_history *h = w->h;
    int length;
    if (item >= t->item_count) length = snprintf(text, size, "there is no item %u", (unsigned)item);
    else {
        const uint32_t place = w->places ? w->places[item] : item, unit = t->nodes[t->item_nodes[place]].unit;
        if (h->drawn[place] == h->serial && unit != TREE_NONE && h->pages[unit].is_off)
            length = snprintf(text, size, "kept: tests do not pay among its %u neighbours; they are drawn without for %u frames more",
                              (unsigned)t->nodes[unit].below_count, (unsigned)(h->pages[unit].off_until - h->serial));
        else if (h->drawn[place] == h->serial) length = snprintf(text, size, "kept: its box may be seen");
        else if (walk_is_masked(w, place)) length = snprintf(text, size, "dropped: a culler before left it out, or a picture stands for it");
        else if (walk_place_of(w, &t->boxes[place]) == WALK_OUT) length = snprintf(text, size, "dropped: its box lies outside every volume");
        else if (h->serial && h->rested == h->serial) length = snprintf(text, size, "kept: tests do not pay in this zone; it is drawn without");
        else length = snprintf(text, size, "dropped: no pixel of its box, or of one around it, can be seen behind what is drawn");
    }
    return length < 0 ? 0 : (size_t)length;
}

size_t explain_seen(int is_seen, char *text, size_t size)
{
    const int length = snprintf(text, size, "%s", is_seen ? "kept: its box may be seen past what was drawn into the pyramid before it"
                                                          : "dropped: outside every volume, left out before, or hidden behind what was drawn into the pyramid before it");
    return length < 0 ? 0 : (size_t)length;
}
