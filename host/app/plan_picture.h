// The plan of a scene: its floors from above, each zone in a colour of its own, portals as lines.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_APP_PLAN_PICTURE_H
#define PORTCULLIS_HOST_APP_PLAN_PICTURE_H

#include "../core/memory.h"
#include "../core/report.h"
#include "../core/scene.h"

// [any thread] What looks up is a floor; a higher one hides those below and is lighter. Portals without a door are white, those
// with one yellow. BAD_INPUT, reported: there is no floor. No GL.
result plan_picture_write(const scene *s, const char *path, const allocator *memory, report *r);

#endif
