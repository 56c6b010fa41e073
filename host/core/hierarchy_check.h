// Hierarchy check: what a select lends as cull.hierarchy/1 is lent on only when every number of it is sound.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_HIERARCHY_CHECK_H
#define PORTCULLIS_HOST_HIERARCHY_CHECK_H

#include "memory.h"
#include "report.h"

#include <portcullis/culler.h>

// [build] *out_fault: NULL when it is sound, else what is wrong with it, a constant text. `zone` in the select's order.
// O(nodes + items) time and memory. RESULT_NO_MEMORY without a line, else RESULT_OK.
result hierarchy_check(const cull_hierarchy *h, const cull_zone *zone, const allocator *memory, const char **out_fault);

#endif
