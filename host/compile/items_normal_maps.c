// Which materials have a normal map: worldspawn's key "_normal_maps" lists their names, blanks between; one that ends in '*'
// stands for all names that begin so. Names of maps do not tell where a texture's pictures are, so the map has to say it.
// SPDX-License-Identifier: MIT
#include "items.h"

#include "../import/map_text.h"

#include <string.h>

static int covers(const char *pattern, size_t length, const char *name)
{
    if (length && pattern[length - 1] == '*') return strncmp(pattern, name, length - 1) == 0;
    return strlen(name) == length && memcmp(pattern, name, length) == 0;
}

static int lists(const char *list, const char *name)
{
    static const char blanks[] = " \t\r\n";
    for (const char *at = list + strspn(list, blanks); *at; at += strspn(at, blanks)) {
        const size_t length = strcspn(at, blanks);
        if (covers(at, length, name)) return 1;
        at += length;
    }
    return 0;
}

static const char *list_of(const compile_input *in)
{
    const char *found = NULL;
    for (uint32_t e = 0; e < in->entity_count; ++e) {
        const compile_entity *entity = &in->entities[e];
        if (!map_word_is((map_word){entity->class_name, strlen(entity->class_name)}, "worldspawn")) continue;
        found = item_key(entity, "_normal_maps");
    }
    return found;
}

void items_normal_maps(item_job *j)
{
    const char *list = list_of(j->in);
    for (uint32_t m = 0; list && m < scene_builder_material_count(j->builder); ++m)
        if (lists(list, scene_builder_material_at(j->builder, m)->name)) scene_builder_material_mark(j->builder, m);
}
