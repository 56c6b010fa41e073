// Maps through the compiler up to a scene, for tests of its last stage.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_ITEMS_FIXTURE_H
#define PORTCULLIS_TESTS_ITEMS_FIXTURE_H

#include "input_fixture.h"

typedef struct compiled { // of one map
    compile_input *in;
    compiled_zones *zones;
    scene *scene;
    compile_checks checks;
    report_lines lines;
} compiled;

void take_zones(compiled *c, compile_input *in, portal_choice portals); // takes `in`; the struct must not move
void take_items(compiled *c);
void release(compiled *c);
void expect_sound(const compiled *c); // watertight, no item lost

// Two rooms of 8 m x 8 m x 4 m side by side, a door of 2 m x 3 m in the wall between them that opens upwards.
void write_two_rooms(map_writer *w);
void write_rooms_alone(map_writer *w, const char *worldspawn_keys); // without the door and what stands in them
void write_inhabitants(map_writer *w); // a player start in one, a light in the other

#endif
