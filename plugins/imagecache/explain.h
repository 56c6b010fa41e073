// Why the image cache keeps or drops an item, for a person.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_IMAGECACHE_EXPLAIN_H
#define PORTCULLIS_IMAGECACHE_EXPLAIN_H

#include "cells.h"

typedef enum explain_by { EXPLAIN_BY_CELLS, EXPLAIN_BY_BOXES } explain_by; // what decided

// [step] As cull_explain.item.
size_t explain_item(const cells *c, explain_by by, const cull_visit *visit, uint32_t place, char *text, size_t size);

#endif
