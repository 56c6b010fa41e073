// The planes of a compilation, each once, and the exact decisions about them by reference. See exact.h for bounds and tiers.
// SPDX-License-Identifier: MIT
// Invariant: every plane is canonical (no common divisor, first component that is not zero positive); a reference is
// 2 * plane + flipped, so the same plane seen from the same side always has the same reference.
#ifndef PORTCULLIS_HOST_PLANE_TABLE_H
#define PORTCULLIS_HOST_PLANE_TABLE_H

#include "../core/memory.h"

#include <portcullis/exact.h>

typedef uint32_t plane_ref;
typedef struct plane_table {
    buffer planes; // cull_wide_plane
    buffer rows;   // cull_row, of the same planes
    buffer slots;  // uint32_t: plane + 1, 0 empty; a power of two
} plane_table;

#define PLANE_NONE UINT32_MAX

// [one thread for adding; any number of readers in between] NULL: out of memory.
plane_table *plane_table_make(const allocator *memory);
void plane_table_free(plane_table *t); // NULL is fine
// The same plane, reduced: one that is there already keeps its reference. PLANE_NONE: out of memory.
plane_ref plane_table_add(plane_table *t, const cull_wide_plane *plane);

static inline uint32_t plane_table_count(const plane_table *t)
{
    return (uint32_t)t->planes.count;
}

static inline plane_ref plane_ref_flipped(plane_ref r)
{
    return r ^ 1u;
}

static inline int plane_ref_sign(plane_ref r) // -1 when flipped
{
    return r & 1u ? -1 : 1;
}

// Canonical, not flipped; the pointers last until a plane is added.
static inline const cull_wide_plane *plane_table_canonical(const plane_table *t, plane_ref r)
{
    return (const cull_wide_plane *)t->planes.items + (r >> 1);
}

static inline const cull_row *plane_table_row(const plane_table *t, plane_ref r)
{
    return (const cull_row *)t->rows.items + (r >> 1);
}

// As seen by the reference.
static inline cull_wide_plane plane_table_get(const plane_table *t, plane_ref r)
{
    const cull_wide_plane p = *plane_table_canonical(t, r);
    return r & 1u ? cull_wide_plane_flipped(p) : p;
}

// ---- Decisions, orientation of the references respected ----

// Sign of det(n_a, n_b, n_c); 0: no single point in common.
int plane_table_normals_sign(const plane_table *t, plane_ref a, plane_ref b, plane_ref c);
// Side of `of` on which a, b and c meet; they must. Needs no orientation of a, b, c.
int plane_table_side(const plane_table *t, const plane_ref meet[3], plane_ref of);
// On the line of a and b, in the direction n_a x n_b: sign of (point of c - point of d). Both must meet the line.
int plane_table_order_along(const plane_table *t, plane_ref a, plane_ref b, plane_ref c, plane_ref d);
// The point in doubles, each coordinate within 2^-50 of its size; 0 when the planes have no single point in common.
int plane_table_position(const plane_table *t, const plane_ref meet[3], double out[3]);
// The same as plane_table_side for a point whose position came from plane_table_position: that decides nearly always.
int plane_table_side_at(const plane_table *t, const plane_ref meet[3], const double position[3], plane_ref of);
int plane_table_side_of_point(const plane_table *t, const int32_t p[3], plane_ref of);

#endif
