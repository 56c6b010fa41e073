// Portals and leak lines as map editors read them: .prt (PRT1, one leaf a zone) and .pts (one point a line), in map units
// and map axes.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_COMPILE_EDITOR_FILES_H
#define PORTCULLIS_HOST_COMPILE_EDITOR_FILES_H

#include "compile.h"

// "PRT1", the zones, the portals, then a portal a line: its corners' count, the zone that sees them clockwise, the one
// behind, "(x y z ) " each. A leak: one zone, no portal.
result editor_prt_write(const compile_input *in, const compiled_zones *z, const char *path, const allocator *memory, report *r);
// From the entity to the void, a point at least every 16 units. Without a leak nothing is written, and a .pts file of that
// name is removed; another kind of file there is an error.
// Before long work: RESULT_OK where nothing, a .pts file or a device stands.
result editor_pts_check(const char *path, report *r);
result editor_pts_write(const compiled_zones *z, const char *path, const allocator *memory, report *r);

#endif
