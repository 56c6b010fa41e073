// The list of built-in cullers.
// SPDX-License-Identifier: MIT
#include "builtin.h"

const cull_plugin *const *builtin_plugins(uint32_t *count)
{
    static const cull_plugin *const plugins[] = {&builtin_none, &builtin_brute, &builtin_flood};
    *count = (uint32_t)(sizeof plugins / sizeof plugins[0]);
    return plugins;
}
