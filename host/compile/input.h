// What readers of the compiler's input share: an input that grows, its brushes cut as they come, welded and closed at the end.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_COMPILE_INPUT_H
#define PORTCULLIS_HOST_COMPILE_INPUT_H

#include "brush_shape.h"
#include "compile.h"

typedef struct input_draft {
    compile_input *in;
    const char *path;
    report *report;
    uint32_t grid;           // steps a unit
    double weld;             // steps
    plane_ref cube[6];       // see brush_shape_cube
    brush_shape shape, before; // of the last brush added or changed; before the change
    buffer brushes, faces, entities, materials, changes; // compile_brush, compile_face, compile_entity, compile_material, weld_change
    buffer close;            // uint32_t: brushes with corners closer than the weld
    buffer slots;            // uint32_t: of materials by name
    buffer planes;           // plane_ref: scratch
} input_draft;

// Both report what is wrong. After a failure, too, input_draft_close is to be called.
result input_draft_open(const char *path, const input_options *o, const allocator *memory, report *r, input_draft *d);
void input_draft_close(input_draft *d); // frees all but what input_draft_finish handed out

// The number of a material; UINT32_MAX: out of memory.
uint32_t input_draft_material(input_draft *d, const char *name, size_t length, uint32_t flags);

typedef enum brush_verdict { BRUSH_TAKEN, BRUSH_DROPPED } brush_verdict;
// Cuts the brush, keeps those of its faces that have an area, and adds it. brush: what, role, entity; the rest is filled.
// where: "entity 3 brush 7". Empty brushes and repeated planes are dropped with a warning, open ones refused.
result input_draft_brush(input_draft *d, const compile_brush *brush, const compile_face *faces, uint32_t count, const char *where, uint32_t line,
                         brush_verdict *out);

// ---- Weld: each lists what it did; see the files ----

result input_snap_corners(input_draft *d); // input_snap.c: corners of one brush
result input_weld_planes(input_draft *d);  // input_weld.c: planes of different brushes
result input_join_corners(input_draft *d); // input_join.c: corners of one brush to faces of others, where rounding parted them

// Corners of a shape that are different points but closer than `reach` steps, counted by pairs. input_replace.c
uint32_t shape_close_pairs(const brush_shape *s, const plane_table *t, double reach);

typedef struct plane_replacement {
    uint32_t brush;
    const plane_ref *planes; // one a face of the brush
    weld_kind kind;          // WELD_POINT: fewer close pairs are wanted; else not more
} plane_replacement;
typedef enum replace_verdict { REPLACE_DONE, REPLACE_REFUSED } replace_verdict;
result input_cut_brush(input_draft *d, uint32_t brush); // into d->shape
// d->shape is the brush as it is, before and after. Done, and listed, if the brush keeps all its faces, no corner goes
// farther than the weld, and the close pairs are as wanted.
result input_replace_planes(input_draft *d, const plane_replacement *r, replace_verdict *out);
result input_try_planes(input_draft *d, const plane_replacement *r, replace_verdict *out); // the same verdict, but nothing is done

// Welds and hands out.
result input_draft_finish(input_draft *d, compile_input **out);

#endif
