// Chain strings: STAGE ('+' STAGE)*, STAGE = ID ['[' KEY=VALUE (',' KEY=VALUE)* ']'].
// SPDX-License-Identifier: MIT
#include "chain.h"

#include <string.h>

enum { TEXT_BYTES_MOST = 4096 };

typedef struct cursor {
    const char *text, *at;
    arena *texts;
    report *r;
} cursor;

static result fault(const cursor *c, const char *what)
{
    return report_error(c->r, NULL, 0, "chain '%s', at character %zu: %s; write it like octree[leaf=64]+occlusion", c->text,
                        (size_t)(c->at - c->text) + 1, what);
}

// The text up to any of `ends`; empty is a fault.
static result word(cursor *c, const char *ends, const char *what, const char **out)
{
    const size_t length = strcspn(c->at, ends);
    if (length == 0) return fault(c, what);
    *out = arena_text(c->texts, c->at, length);
    if (!*out) return report_no_memory(c->r, NULL);
    c->at += length;
    return RESULT_OK;
}

static result parse_option(cursor *c, chain_stage_spec *stage)
{
    if (stage->option_count == CHAIN_OPTIONS_MOST) return fault(c, "too many options");
    chain_option *o = &stage->options[stage->option_count];
    result done = word(c, "=,[]+", "an option's name is missing", &o->key);
    if (done != RESULT_OK) return done;
    if (*c->at != '=') return fault(c, "an option needs '=' and a value");
    c->at++;
    done = word(c, ",[]", "an option's value is missing", &o->value);
    if (done != RESULT_OK) return done;
    for (uint32_t i = 0; i < stage->option_count; ++i)
        if (strcmp(stage->options[i].key, o->key) == 0) return fault(c, "an option stands twice");
    stage->option_count++;
    return RESULT_OK;
}

static result parse_stage(cursor *c, chain_stage_spec *stage)
{
    stage->option_count = 0;
    result done = word(c, "+[],=", "a culler's name is missing", &stage->id);
    if (done != RESULT_OK || *c->at != '[') return done;
    do {
        c->at++;
        done = parse_option(c, stage);
        if (done != RESULT_OK) return done;
    } while (*c->at == ',');
    if (*c->at != ']') return fault(c, "']' is missing");
    c->at++;
    return RESULT_OK;
}

result chain_parse(const char *text, arena *texts, report *r, chain_spec *out)
{
    if (strlen(text) > TEXT_BYTES_MOST) return report_error(r, NULL, 0, "a chain of over 4096 characters; shorten it");
    const char *copy = arena_text(texts, text, strlen(text));
    if (!copy) return report_no_memory(r, NULL);
    cursor c = {copy, copy, texts, r};
    *out = (chain_spec){.text = copy};
    for (;;) {
        if (out->stage_count == CHAIN_STAGES_MOST) return fault(&c, "over 8 cullers");
        const result done = parse_stage(&c, &out->stages[out->stage_count++]);
        if (done != RESULT_OK) return done;
        if (*c.at == 0) return RESULT_OK;
        if (*c.at != '+') return fault(&c, "'+' or the end is expected");
        c.at++;
    }
}
