// What a person sees of a strategy beside full geometry, view by view: PSNR, SSIM, FLIP, cracks. A pass of its own, in the
// path's order, so that times are those of passes which nobody looks at, and every view's full geometry is drawn once.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_PICTURES_H
#define PORTCULLIS_BENCH_PICTURES_H

#include "progress.h"
#include "records.h"
#include "strategy.h"

// Of what a bench has open. rows: of the same strategies; only what their pictures take is read. Views before the records' are shown for the strategies' history.
typedef struct pictures_request {
    const bench_request *bench;
    strategy *strategies;
    const bench_row *rows;
    records *records;
    motion *motion; // of the truth
    renderer *g;
} pictures_request;

// Strategies that show pictures of their own, unless the bench was asked for all or none.
int pictures_wanted(const bench_request *q, const strategy *s);
// [main] After the passes that are timed: every view of every strategy wanted, into its record; with images, the worst view's three
// pictures, where any differs.
result pictures_run(const pictures_request *q, progress *bar, report *r);

#endif
