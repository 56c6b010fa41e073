// The frame in which a map was drawn before it was turned as a whole and its points rounded: there they are whole units again.
// SPDX-License-Identifier: MIT
// Invariant: a frame is a rational rotation, so planes through whole points of it are planes of whole numbers; a written
// point that it does not explain to within the tolerance keeps what was written.
#ifndef PORTCULLIS_HOST_TURNED_FRAME_H
#define PORTCULLIS_HOST_TURNED_FRAME_H

#include "../core/memory.h"
#include "../core/report.h"

#include <portcullis/exact.h>

enum { FRAME_SHIFT_PARTS = 4096 };

typedef struct turned_frame {
    int64_t turn[3][3], scale;  // a place (y + shift) of the frame is turn (y + shift) / scale; turn' turn = scale^2
    int64_t shift[3];           // of the frame's points, in 1/4096 of its unit
    uint32_t grid, parts;       // steps a unit; the frame's points are whole parts of a unit: 1, 2, 4 or 8
    uint32_t points_explained;  // of those given
} turned_frame;

typedef enum frame_verdict { FRAME_FOUND, FRAME_NONE } frame_verdict;

// points: three a face, grid steps. Found when nearly all of them are a turned grid's, and that is no grid as written. The
// same for any order of faces.
result turned_frame_find(const int32_t (*points)[3], size_t count, uint32_t grid, const allocator *memory, turned_frame *out, frame_verdict *verdict);
// The plane through three points as they were before they were rounded. 0: the frame does not explain them. move: steps, the
// farthest that one of the three goes.
int turned_frame_plane(const turned_frame *f, const int32_t a[3], const int32_t b[3], const int32_t c[3], cull_wide_plane *out, double *move);

#endif
