// Libraries that the loader has to refuse, one for each value of REFUSED, and one WITHOUT_SYMBOL; NAME is the id.
// SPDX-License-Identifier: MIT
#include <portcullis/culler.h>

enum {
    ABI_NEXT = 1, ABI_MOST, NO_TABLE, NO_PLUGIN, NULL_PLUGIN, MANY_PLUGINS, NO_DESCRIPTOR, NO_CREATE, NO_DESTROY, NO_BUILD, NO_OPEN, NO_CLOSE,
    NO_EXTENSION, NO_VERB, ID_NULL, ID_EMPTY, ID_CAPITAL, ID_LONG, ID_TAKEN, ID_TWICE, NO_VERSION, NO_SUMMARY, OPTION_TWICE, OPTION_NO_KEY,
    OPTION_NO_FALLBACK, OPTION_NO_HELP, OPTIONS_MISSING, OPTIONS_MANY
};

#ifdef WITHOUT_SYMBOL
CULL_EXPORT extern const int not_the_entry;
const int not_the_entry = 1;
#else

static cull_result create(const cull_host *host, const char *const *values, cull_culler **out)
{
    (void)host;
    (void)values;
    (void)out;
    return CULL_ERR_ZONE;
}
static void destroy(cull_culler *c)
{
    (void)c;
}
static cull_result build(cull_culler *c, const cull_zone *zone, const cull_hierarchy *lent, cull_built *out)
{
    (void)c;
    (void)zone;
    (void)lent;
    (void)out;
    return CULL_ERR_ZONE;
}
static cull_result open_query(const cull_culler *c, cull_query **out)
{
    (void)c;
    (void)out;
    return CULL_ERR_ZONE;
}
static void close_query(cull_query *q)
{
    (void)q;
}
static cull_progress select_items(cull_query *q, const cull_visit *visit, cull_batch *batch)
{
    (void)q;
    (void)visit;
    (void)batch;
    return CULL_DONE;
}
static const void *get_extension(const cull_culler *c, const char *id)
{
    (void)c;
    (void)id;
    return NULL;
}

#define UNLESS(fault, value) (REFUSED == (fault) ? NULL : (value))
static const cull_option options[2] = {
    {UNLESS(OPTION_NO_KEY, "key"), UNLESS(OPTION_NO_FALLBACK, "0"), NULL, UNLESS(OPTION_NO_HELP, "help")},
    {REFUSED == OPTION_TWICE ? "key" : "other", "0", NULL, "help"},
};
static const cull_descriptor descriptor = {
    .id = REFUSED == ID_NULL      ? NULL
          : REFUSED == ID_EMPTY   ? ""
          : REFUSED == ID_CAPITAL ? "Refused"
          : REFUSED == ID_LONG    ? "a123456789b123456789c123456789d123456789e123456789f123456789g123"
          : REFUSED == ID_TAKEN   ? "brute"
                                  : NAME,
    .version = UNLESS(NO_VERSION, "1"),
    .summary = UNLESS(NO_SUMMARY, "refused"),
    .options = UNLESS(OPTIONS_MISSING, options),
    .option_count = REFUSED == OPTIONS_MANY ? 1000000 : 2,
};
static const cull_plugin plugin = {
    .descriptor = UNLESS(NO_DESCRIPTOR, &descriptor),
    .create = UNLESS(NO_CREATE, create),
    .destroy = UNLESS(NO_DESTROY, destroy),
    .build = UNLESS(NO_BUILD, build),
    .open = UNLESS(NO_OPEN, open_query),
    .close = UNLESS(NO_CLOSE, close_query),
    .select = UNLESS(NO_VERB, select_items),
    .get_extension = UNLESS(NO_EXTENSION, get_extension),
};
static const cull_plugin *const plugins[] = {UNLESS(NULL_PLUGIN, &plugin), &plugin};
CULL_ENTRY = {
    .abi = REFUSED == ABI_NEXT ? CULL_ABI + 1 : REFUSED == ABI_MOST ? 0xffffffff : CULL_ABI,
    .plugin_count = REFUSED == NO_PLUGIN ? 0 : REFUSED == MANY_PLUGINS ? 65 : REFUSED == ID_TWICE ? 2 : 1,
    .plugins = UNLESS(NO_TABLE, plugins),
};
#endif
