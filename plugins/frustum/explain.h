// Why an item is kept or dropped, for a person.
// SPDX-License-Identifier: MIT
#ifndef FRUSTUM_EXPLAIN_H
#define FRUSTUM_EXPLAIN_H

#include "index.h"

// [step] As cull_explain.item.
size_t explain_item(const frustum_index *index, const cull_visit *visit, uint32_t item, char *text, size_t size);

#endif
