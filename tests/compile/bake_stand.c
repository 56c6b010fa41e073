// Worlds for tests of baked indices: see bake_stand.h.
// SPDX-License-Identifier: MIT
#include "bake_stand.h"

#include <stdlib.h>
#include <string.h>

result stand_open(stand *t, const scene *s, const char *chain, uint32_t more_movers)
{
    const char *const folders[] = {BAKE_PLUGINS, CORE_PLUGINS, getenv("PORTCULLIS_PLUGINS")};
    memset(t, 0, sizeof *t);
    t->report = hear(&t->heard);
    t->texts = arena_make(allocator_heap());
    host_services_fill(&t->services, allocator_heap(), &t->report);
    chain_spec spec;
    assert_int_equal(chain_parse(chain, &t->texts, &t->report, &spec), RESULT_OK);
    const loader_options options = {.folders = folders, .folder_count = folders[2] ? 3 : 2};
    assert_int_equal(loader_open(&options, allocator_heap(), &t->report, &t->plugins), RESULT_OK);
    return world_open(&(world_request){.scene = s, .plugins = t->plugins, .services = &t->services, .chain = &spec, .more_movers = more_movers}, &t->report, &t->world);
}

void stand_close(stand *t)
{
    world_close(t->world);
    loader_close(t->plugins);
    arena_free(&t->texts);
}
