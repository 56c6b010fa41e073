// The exact volume of bodies that add and subtract in order, in rational numbers (GMP), by cutting convex cells: nothing of
// the compiler takes part but the bodies' planes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_VOLUME_ORACLE_H
#define PORTCULLIS_TESTS_VOLUME_ORACLE_H

#include <gmp.h>
#include <stdint.h>

typedef struct oracle_plane { // inside: normal . x + offset <= 0
    mpz_t normal[3], offset;
    double rough[4];
} oracle_plane;

typedef enum oracle_kind { ORACLE_ADD, ORACLE_SUBTRACT } oracle_kind;
typedef struct oracle_body {
    const oracle_plane *planes;
    uint32_t plane_count;
    oracle_kind kind;
    double min[3], max[3]; // hold it, with room to spare
} oracle_body;

// Six times the volume. A point is solid where the last body that holds it adds, so the volume is that of each adding body
// less all later ones. Bodies lie within 2^25 of the origin. Returns the number of cells that were measured.
uint64_t oracle_volume(const oracle_body *bodies, uint32_t count, mpq_t six_volumes);

#endif
