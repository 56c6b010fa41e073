// Fuzz target: any bytes as a chain string. What is read is written again, and must be read as the same chain.
// SPDX-License-Identifier: MIT
#include "host/core/chain.h"
#include "tests/fuzz_driver.h"

#include <stdlib.h>
#include <string.h>

enum { TEXT_MOST = 8192 };

const char *const fuzz_seeds[] = {
    "octree[leaf=64]+occlusion", "bsp[split=exact,choose=fast,cells=hull]+portal[clip=exact]+occlusion[method=hiz]", "a", "a+b+c+d+e+f+g+h", "a[b=c=d]", "[", "a[=]",
    NULL,
};
const char *const fuzz_files[] = {NULL};

static void expect(int holds)
{
    if (!holds) abort();
}

static size_t put(char *text, size_t at, const char *word)
{
    const size_t length = strlen(word);
    expect(length > 0 && at + length + 2 < TEXT_MOST);
    memcpy(text + at, word, length);
    return at + length;
}

static void write_chain(const chain_spec *chain, char text[TEXT_MOST])
{
    size_t at = 0;
    for (uint32_t s = 0; s < chain->stage_count; ++s) {
        const chain_stage_spec *stage = &chain->stages[s];
        if (s) text[at++] = '+';
        at = put(text, at, stage->id);
        for (uint32_t o = 0; o < stage->option_count; ++o) {
            text[at++] = o ? ',' : '[';
            at = put(text, at, stage->options[o].key);
            text[at++] = '=';
            at = put(text, at, stage->options[o].value);
        }
        if (stage->option_count) text[at++] = ']';
    }
    text[at] = 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char again[TEXT_MOST];
    static chain_spec chain, second; // large; all of it is set by a parse that succeeds
    report silent = {0};
    char *text = malloc(size + 1); // of its own size: reading past the end is seen
    expect(text != NULL);
    if (size) memcpy(text, data, size);
    text[size] = 0;
    arena texts = arena_make(allocator_heap());
    const result done = chain_parse(text, &texts, &silent, &chain);
    expect(done == RESULT_OK ? silent.errors == 0 : done == RESULT_BAD_INPUT && silent.errors == 1);
    if (done == RESULT_OK) {
        expect(chain.stage_count >= 1 && chain.stage_count <= CHAIN_STAGES_MOST && strcmp(chain.text, text) == 0);
        write_chain(&chain, again);
        expect(strcmp(again, text) == 0); // a chain can be written in one way only
        expect(chain_parse(again, &texts, &silent, &second) == RESULT_OK && second.stage_count == chain.stage_count);
    }
    arena_free(&texts);
    free(text);
    return 0;
}
