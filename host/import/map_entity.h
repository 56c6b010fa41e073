// What an entity of a map is: still, moving or nothing to see; where its door opens to.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_MAP_ENTITY_H
#define PORTCULLIS_HOST_MAP_ENTITY_H

#include "../core/scene.h"
#include "map_text.h"

typedef enum entity_role {
    ENTITY_NOTHING, // triggers: no surface, no body
    ENTITY_STILL,
    ENTITY_MOVER,
} entity_role;

typedef enum entity_body { // what its brushes are to free-space tests
    BODY_NONE,
    BODY_STRUCTURE,
    BODY_ENTITY,
    BODY_HOLLOW, // takes away from the structure before it
} entity_body;

map_word entity_class(const map_entity *e); // empty when it says none
entity_role entity_role_of(map_word class_name);
entity_body entity_body_of(map_word class_name);
place_kind entity_place_of(map_word class_name);

// func_door: from shut to open in the map's units, by `angle` or `angles` and `lip`, over the bounds of its brushes;
// zero for every other class. RESULT_BAD_INPUT, with a line, where a key that it needs is no number.
result entity_open_offset(const map_entity *e, const double min[3], const double max[3], const map_reader *m, double out[3]);

#endif
