// What the tests of scene files share: scenes with something of everything, all bits of two scenes compared.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_PCS_FIXTURE_H
#define PORTCULLIS_TESTS_PCS_FIXTURE_H

#include "host/compile/pcs_write.h"
#include "host/import/pcs.h"
#include "tests/import/json_support.h"

scene *everything_scene(void); // small: zones, portals, doors, movers on paths, lights, cameras, materials, a chain; heap
scene *small_map_scene(void);  // brushes, a water, a door, places: heap
void free_heap_scene(scene *s);

// Every array and number, names too; not the path, the bakes, the bytes that they lie in.
void assert_scenes_equal(const scene *a, const scene *b);
// The file of the scene, with those bakes; must work. Free with memory_free(allocator_heap(), bytes, size, 1).
char *encoded(const pcs_request *q, size_t *out_size);
char *encoded_scene(const scene *s, size_t *out_size);
scene *opened(const void *bytes, size_t size); // must open
void sign(char *file, size_t size);            // gives the bytes the hash that they have now
char *section_of(char *file, pcs_id id);       // where its bytes begin
uint64_t section_count(const char *file, pcs_id id);

#endif
