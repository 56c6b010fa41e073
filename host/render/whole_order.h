// Which flat items of a zone can be drawn whole, one behind the other, and which are knots that only their pieces untie.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_WHOLE_ORDER_H
#define PORTCULLIS_RENDER_WHOLE_ORDER_H

#include "../core/scene.h"

enum { WHOLE_ROWS_MOST = 1024 }; // more items: all are one knot, as the table grows with their square

typedef struct whole_order {
    double (*planes)[4]; // by row: normal . p + offset, unit normal, from the scene's origin; normal 0: the item is not flat
    uint8_t *sides;      // rows * rows: SIDE_* of the plane of the first that points of the second lie on
    uint8_t *eye_sides;  // by row, for one eye
    uint32_t *numbers, *lows, *stack, *calls, *next; // by row, see whole_order_run
    uint32_t rows;
} whole_order;

typedef struct whole_request { const scene *scene; const uint32_t *items; uint32_t count; } whole_request; // items: global ids
// Rows are places in the request's items. RESULT_NO_MEMORY leaves nothing.
result whole_order_open(const whole_request *q, const allocator *memory, whole_order *out);
void whole_order_close(whole_order *w, const allocator *memory); // zeroed is fine

typedef struct whole_picture { const double *eye; const uint32_t *rows; uint32_t count; } whole_picture; // eye: from the scene's origin
// Writes the rows, each given once, to `out`, farthest first, group by group: ends[g] is the end of group g. An item of a group
// of its own is drawn whole, others by pieces, ordered within the group. out and ends have room for `count`. Returns the groups.
// Constant time a pair.
uint32_t whole_order_run(whole_order *w, const whole_picture *q, uint32_t *out, uint32_t *ends);

#endif
