// A shard's journal: what it has measured so far, appended view by view, so that one that was stopped goes on from there.
// SPDX-License-Identifier: MIT
// Invariant: an entry is believed only when its hash holds, and only up to the first that does not; so a kill at any byte loses one view at most.
#ifndef PORTCULLIS_BENCH_RESUME_H
#define PORTCULLIS_BENCH_RESUME_H

#include "records.h"
#include "shard.h"

#include <time.h>

typedef struct resume {
    const bench_request *q;
    view_range range;
    int file; // 0: nobody wants a journal, and all below is empty
    char *path;
    char *bytes; // of the journal as it was found
    size_t size, good, at; // good: of which so many are whole entries; at: where the first stands
    uint32_t *done;        // by strategy and pass: views kept, from the range's first on
    time_t synced_s;
} resume;

typedef struct resume_place { uint32_t strategy, pass, view; } resume_place;

// After the renderer: of a journal by another identity or driver it says so. Fills result.records with what is kept.
result resume_open(const bench_request *q, bench_result *b, view_range range, report *r, resume *out);
void resume_close(resume *j, result done); // RESULT_OK: the journal has served. Zeroed is fine
// Views of the pass that are still to be measured.
view_range resume_left(const resume *j, uint32_t strategy, uint32_t pass);
// Appends the views of the truth that strategy k was the first to need, as far as they are kept one behind the other.
result resume_truth(const resume *j, uint32_t strategy, report *r, truth *t);
// The truth's last view.
result resume_keep_truth(resume *j, uint32_t strategy, const truth *t, report *r);
result resume_keep_pass(resume *j, const resume_place *at, const records *records, report *r);

#endif
