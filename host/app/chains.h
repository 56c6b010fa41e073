// Which chain each zone of a scene has: from --culler, --zone and the scene file.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_CHAINS_H
#define PORTCULLIS_HOST_APP_CHAINS_H

#include "../../bench/bench.h"
#include "app.h"

enum { ZONE_OPTIONS_MOST = 256 };
typedef struct zone_options { // NAME=CHAIN, as typed; a NAME may be a pattern with * ? [..]
    const char *texts[ZONE_OPTIONS_MOST];
    uint32_t count;
} zone_options;

// What holds for all strategies of a command. Chains of the same text are one spec.
typedef struct chain_book {
    app *app;
    const char **of_options; // by zone: the chain that --zone gives it, or NULL
    const char *suffix;      // ",NAME=CHAIN" of each option: follows a strategy's name
    buffer specs;            // const chain_spec *
} chain_book;

// Can be told before the scene is read: what --culler and --zone name exists. `scene` as a culler is none to look for.
result chains_check(app *a, const char *const *cullers, uint32_t culler_count, const zone_options *zones);
// The app holds the scene. An exact name goes before patterns, of patterns the last. Refuses a NAME that no zone has, and
// an exact one given twice.
result chain_book_open(app *a, const zone_options *zones, chain_book *out);
void chain_book_close(chain_book *b); // zeroed is fine; texts and specs stay with the app
// culler: a chain, or "scene" (NULL too): what the scene names for each zone, frustum where it names none; or NAME=CHAIN;CHAIN, any number
// of names: zones called so have theirs, all others the last. A zone that --zone names has what that says.
result chain_book_strategy(chain_book *b, const char *culler, bench_strategy_request *out);
// swap/N over the sets of those strategies.
result chain_book_swap(chain_book *b, const bench_strategy_request *strategies, uint32_t count, uint32_t views, bench_strategy_request *out);

#endif
