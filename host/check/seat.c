// A scene, a culler on it and a query, in one call: see checks.h.
// SPDX-License-Identifier: MIT
#include "checks.h"

#include <stdio.h>
#include <string.h>

static const char *result_text(cull_result result)
{
    return result == CULL_ERR_OPTION ? "CULL_ERR_OPTION" : result == CULL_ERR_MEMORY ? "CULL_ERR_MEMORY"
                                       : result == CULL_ERR_BLOB ? "CULL_ERR_BLOB" : "an unknown result";
}

seat_state seat_open(check_run *r, const seat_request *q, bench_seat *b)
{
    stand_values defaults;
    stand_defaults(r->plugin, &defaults);
    made_scene_make(r, q->kind, &b->scene);
    b->scene.zone.mover_capacity = q->mover_capacity;
    if (stand_role_of(r->plugin) == ROLE_CROSS) made_scene_portals(r, &b->scene);
    const stand_request request = {.plugin = r->plugin, .values = q->values ? q->values : &defaults, .scene = &b->scene, .tasks = q->tasks};
    run_at(r, "build, scene %s", made_scene_name(q->kind));
    const cull_result built = stand_open(&b->stand, &request);
    memset(&b->sitting, 0, sizeof b->sitting);
    memset(&b->answer, 0, sizeof b->answer);
    if (b->stand.fault) return run_fail(r, "%s", b->stand.fault), SEAT_FAULTY;
    if (built == CULL_ERR_ZONE) return SEAT_REFUSED;
    if (built != CULL_OK) return run_fail(r, "create or build returned %s", result_text(built)), SEAT_FAULTY;
    run_at(r, "open, scene %s", made_scene_name(q->kind));
    const cull_result opened = sitting_open(&b->sitting, &b->stand, q->lists);
    if (opened != CULL_OK || !b->sitting.query) return run_fail(r, "open failed, or gave no query"), SEAT_FAULTY;
    answer_open(&b->answer, &b->scene);
    return SEAT_GOOD;
}

void seat_close(bench_seat *b)
{
    answer_close(&b->answer);
    lender_release(&b->stand.lender);
    sitting_close(&b->sitting);
    stand_close(&b->stand);
    lender_close(&b->stand.lender);
    made_scene_free(&b->scene);
}

int variant_make(const cull_plugin *p, uint32_t number, stand_values *out, char *name, size_t size, char *words, size_t words_size)
{
    stand_defaults(p, out);
    snprintf(name, size, "defaults");
    if (number == 0) return 1;
    for (uint32_t i = 0; i < p->descriptor->option_count && i < STAND_OPTIONS_MOST; ++i) {
        const cull_option *o = &p->descriptor->options[i];
        if (!o->sweep) continue;
        snprintf(words, words_size, "%s", o->sweep);
        char *save = NULL;
        for (char *word = words; (word = word + strspn(word, " "), *word); word = save) {
            save = word + strcspn(word, " ");
            if (--number) continue;
            *save = 0;
            out->values[i] = word;
            snprintf(name, size, "%s=%s", o->key, word);
            return 1;
        }
    }
    return 0;
}
