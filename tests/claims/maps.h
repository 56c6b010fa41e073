// The real maps that claims are shown on, compiled with automatic rooms.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_CLAIMS_MAPS_H
#define PORTCULLIS_TESTS_CLAIMS_MAPS_H

#include "stage.h"

enum { MAPS = 8 };
extern const char *const map_names[MAPS]; // in the folder of PORTCULLIS_SCENES
// Skips the test, with a line, when the folder is not there.
void maps_need(void);
void map_load(stage *s, const char *name);
void map_load_file(stage *s, const char *path); // any file of brushes

#endif
