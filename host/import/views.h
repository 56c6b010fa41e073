// Camera paths: .views files, those of the scene, and the repeatable automatic views auto:N, auto:walk:N and auto:edges:N.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_VIEWS_H
#define PORTCULLIS_HOST_VIEWS_H

#include "../core/scene.h"
#include "../core/view.h"

typedef struct camera_path {
    camera *cameras;
    uint32_t count;
    char name[128]; // "city.views" -> "city", "auto:100", "auto:walk:300": for bench names
} camera_path;

// `what` is a file name, "path:NAME" (one of the scene's), "path:" (its first), or, of the scene, repeatable:
// "auto:N"        spread over it
// "auto:walk:N"   a smooth walk, 0.3 m a view          "auto:turn:N" the same of one who spins, 15 degrees a view
// "auto:street:N" on the ground under the open sky, 2.4 m a view; "auto:roofs:N" over the roofs, 2.4 m a view
// "auto:drive:N"  on the ground under the open sky in a car, 1 m a view, with turns as wide as a car's
// "auto:edges:N"  eyes on portals and in planes of walls, or beside by ulps
// aspect: of the picture, for automatic views only.
result camera_path_load(const char *what, const scene *s, double aspect, const allocator *memory, report *r, camera_path *out);
result camera_path_parse(const char *path, const char *text, size_t size, const allocator *memory, report *r, camera_path *out);
// The path as text in .views format; free with memory_free(memory, text, size + 1, 1).
result camera_path_text(const camera_path *p, const allocator *memory, char **out_text, size_t *out_size);
void camera_path_free(camera_path *p, const allocator *memory);

#endif
