// Back-face rejection on the truth's side: which items a picture holds when walls seen from behind only are left out.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_WALLS_H
#define PORTCULLIS_BENCH_WALLS_H

#include "../host/core/chain.h"
#include "../host/core/view.h"

// The same on both sides of any comparison: a chain whose select has the option `backface` at 1 is judged by front walls
// only. MIXED: some zones have such a chain; a wall is left out where all zones that list it have one.
typedef enum walls { WALLS_BOTH_SIDES, WALLS_FRONT_ONLY, WALLS_MIXED } walls;

walls walls_of_chain(const cull_descriptor *select, const chain_spec *spec);
// shown: the bit of every item and mover but of one-sided walls none of whose triangles faces the eye. edge_on: of those, the
// ones whose back is thinner on the picture than what the rasterizer rounds by. No pixel is theirs, and nobody sees anything
// through them: what meets along such a wall overlaps in front of it by less than the rounding, and would part. Both: (item_count +
// mover_count + 31) / 32 words.
typedef struct walls_view {
    const camera *camera;
    uint32_t width_px, height_px;
} walls_view;
void walls_in_front(const scene *s, const walls_view *v, uint32_t *shown, uint32_t *edge_on);

#endif
