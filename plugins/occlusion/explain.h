// Why an item is kept or dropped, for a person.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_EXPLAIN_H
#define OCCLUSION_EXPLAIN_H

#include "hiz.h"
#include "walk.h"

// [step] As cull_explain.item, after the frame's last step.
size_t explain_item(const occlusion_walk *w, uint32_t item, char *text, size_t size);
// Of method=hiz.
size_t explain_sight(const occlusion_walk *w, uint32_t item, hiz_sight sight, char *text, size_t size);

#endif
