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

size_t explain_sight(const occlusion_walk *w, uint32_t item, hiz_sight sight, char *text, size_t size)
{
    const uint32_t place = w->places ? w->places[item] : item;
    const cull_box *box = &w->tree->boxes[place];
    occlusion_walk volumes = *w;
    volumes.takes_candidates = 0; // hiz holds candidates against them too
    const char *why = "kept: its box may be seen past what was drawn into the pyramid before it";
    if (sight == HIZ_UNTESTED) why = "kept: nothing is tested in such a view: its matrix has no inverse, or the picture is too large";
    else if (sight == HIZ_SEEN && walk_is_near(w, walk_key(w, box))) why = "kept: the eye is in or near its box, which is not tested then";
    else if (sight != HIZ_SEEN && walk_is_masked(w, place)) why = "dropped: a culler before left it out, or a picture stands for it";
    else if (sight != HIZ_SEEN && walk_place_of(&volumes, box) == WALK_OUT) why = "dropped: its box lies outside every volume";
    else if (sight == HIZ_HIDDEN) why = "dropped: what nearer items drew into the pyramid hides its box, or one around it";
    else if (sight == HIZ_NO_PIXEL) why = "dropped: no pixel's centre lies in its box";
    const int length = snprintf(text, size, "%s", why);
    return length < 0 ? 0 : (size_t)length;
}
