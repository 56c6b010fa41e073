// Scenes made from a seed: checks what was asked for, lets one kind write it, see generate.h.
// SPDX-License-Identifier: MIT
#include "generate.h"

#include "generate_kinds.h"

#include <stdio.h>
#include <string.h>

enum { PATH_BYTES = 4096 };

typedef struct scene_kind {
    const char *name, *ending, *unit;
    uint64_t usual, most; // most 0: has no size
} scene_kind;

static const scene_kind *kind_named(const char *name)
{
    static const scene_kind kinds[] = {
        {"city", ".boxes", "boxes", 10000, 10000000},
        {"swarm", ".boxes", "boxes", 10000, 10000000},
        {"rooms", ".obj", "rooms", 16, 100000}, // about 6 kB a room: 10^7 of them would be more than importers read
        {"demo", ".obj", "", 0, 0},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
        if (strcmp(kinds[i].name, name) == 0) return &kinds[i];
    return NULL;
}

static int ends_in(const char *text, const char *ending)
{
    const size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

static result size_check(const scene_kind *k, uint64_t *size, report *r)
{
    const int said = *size != GENERATE_SIZE_OF_KIND;
    if (!k->most) return said ? report_error(r, NULL, 0, "generate %s has one size; leave --size out", k->name) : RESULT_OK;
    if (!said) *size = k->usual;
    if (*size < 1 || *size > k->most)
        return report_error(r, NULL, 0, "generate %s makes 1 to %llu %s, not %llu; give another --size", k->name,
                            (unsigned long long)k->most, k->unit, (unsigned long long)*size);
    return RESULT_OK;
}

static result demo_write(uint64_t seed, const char *path, const allocator *memory, report *r)
{
    char views[PATH_BYTES];
    const int base = (int)(strlen(path) - strlen(".obj"));
    const int length = snprintf(views, sizeof views, "%.*s.views", base, path);
    if (length < 0 || (size_t)length >= sizeof views) return report_error(r, path, 0, "the name is too long; give a shorter one");
    text_file scene = text_open(memory), walk = text_open(memory);
    generate_demo(seed, memory, &scene);
    generate_demo_path(&walk);
    if (walk.failed) scene.failed = 1; // neither or both
    const result done = text_close(&scene, path, r);
    if (done != RESULT_OK) {
        text_free(&walk);
        return done;
    }
    const result done_too = text_close(&walk, views, r);
    if (done_too != RESULT_OK) remove(path);
    return done_too;
}

result generate_scene(const char *kind, uint64_t size, uint64_t seed, const char *path, const allocator *memory, report *r)
{
    const scene_kind *k = kind_named(kind);
    if (!k) return report_error(r, NULL, 0, "no kind of scene is called '%s'; there are " GENERATE_KINDS, kind);
    const result fit = size_check(k, &size, r);
    if (fit != RESULT_OK) return fit;
    if (!ends_in(path, k->ending))
        return report_error(r, path, 0, "generate %s writes a %s file; let the name end so", k->name, k->ending);
    if (!k->most) return demo_write(seed, path, memory, r);
    text_file out = text_open(memory);
    if (strcmp(k->name, "city") == 0) generate_city(size, seed, memory, &out);
    else if (strcmp(k->name, "swarm") == 0) generate_swarm(size, seed, &out);
    else generate_rooms(size, seed, memory, &out);
    return text_close(&out, path, r);
}
