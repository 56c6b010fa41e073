// Scenes made from a seed: checks what was asked for, lets one kind write it, see generate.h.
// SPDX-License-Identifier: MIT
#include "generate.h"

#include "generate_zoned.h"

#include <stdio.h>
#include <string.h>

enum { PATH_BYTES = 4096 };

typedef struct scene_kind {
    const char *name, *unit;
    const char *ending;            // of what has no zones; NULL: all that it makes has zones
    void (*zoned)(zoned_scene *z); // what a name that ends in .json makes; NULL: nothing
    uint64_t usual, least, most;   // most 0: has no size
} scene_kind;

static const scene_kind *kind_named(const char *name)
{
    static const scene_kind kinds[] = {
        {"city", "boxes", ".boxes", NULL, 10000, 1, 10000000},
        {"swarm", "boxes", ".boxes", NULL, 10000, 1, 10000000},
        {"rooms", "rooms", ".obj", zoned_rooms, 16, 1, 100000}, // about 6 kB a room: 10^7 of them would be more than importers read
        {"maze", "rooms", NULL, zoned_maze, 100, 10, 100000},
        {"house", "", NULL, zoned_house, 0, 0, 0},
        {"demo", "", ".obj", NULL, 0, 0, 0},
        {"flagship", "metres to the horizon", NULL, zoned_flagship, 150, 150, 2000},
        {"terrain", "tiles", ".obj", NULL, 1024, 1, 65536},
        {"forest", "triangles", ".obj", NULL, 100000, 1000, 20000000},
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
    if (*size < k->least || *size > k->most)
        return report_error(r, NULL, 0, "generate %s makes %llu to %llu %s, not %llu; give another --size", k->name,
                            (unsigned long long)k->least, (unsigned long long)k->most, k->unit, (unsigned long long)*size);
    return RESULT_OK;
}

// The same name with another ending.
static result name_beside(const char *path, const char *ending, const char *other, char out[PATH_BYTES], report *r)
{
    const int base = (int)(strlen(path) - strlen(ending)), length = snprintf(out, PATH_BYTES, "%.*s%s", base, path, other);
    if (length < 0 || length >= PATH_BYTES) return report_error(r, path, 0, "the name is too long; give a shorter one");
    return RESULT_OK;
}

static result demo_write(uint64_t seed, const char *path, const allocator *memory, report *r)
{
    char views[PATH_BYTES];
    const result named = name_beside(path, ".obj", ".views", views, r);
    if (named != RESULT_OK) return named;
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

// JSON is UTF-8, so what it cannot name is refused: bytes that are no characters.
static int is_utf8(const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        const unsigned head = *c++;
        const int more = head < 0x80 ? 0 : head >= 0xc2 && head < 0xe0 ? 1 : head >= 0xe0 && head < 0xf0 ? 2 : head >= 0xf0 && head < 0xf5 ? 3 : -1;
        if (more < 0) return 0;
        if ((head == 0xe0 && *c < 0xa0) || (head == 0xed && *c > 0x9f) || (head == 0xf0 && *c < 0x90) || (head == 0xf4 && *c > 0x8f)) return 0;
        for (int i = 0; i < more; ++i, ++c)
            if ((*c & 0xc0) != 0x80) return 0;
    }
    return 1;
}

typedef struct wish { const scene_kind *kind; uint64_t size, seed; const char *path; } wish;

static result zoned_make(const wish *q, const allocator *memory, report *r)
{
    char obj[PATH_BYTES];
    const result named = name_beside(q->path, ".json", ".obj", obj, r);
    if (named != RESULT_OK) return named;
    if (!is_utf8(q->path)) return report_error(r, q->path, 0, "a .json names its .obj, and this name is not UTF-8; choose another");
    const zoned_request z = {q->kind->name, q->kind->zoned, q->size, q->seed, q->path, obj};
    return zoned_write(&z, memory, r);
}

result generate_scene(const char *kind, uint64_t size, uint64_t seed, const char *path, const allocator *memory, report *r)
{
    const scene_kind *k = kind_named(kind);
    if (!k) return report_error(r, NULL, 0, "no kind of scene is called '%s'; there are " GENERATE_KINDS, kind);
    const result fit = size_check(k, &size, r);
    if (fit != RESULT_OK) return fit;
    if (k->zoned && ends_in(path, ".json")) return zoned_make(&(wish){k, size, seed, path}, memory, r);
    if (!k->ending || !ends_in(path, k->ending))
        return report_error(r, path, 0, "generate %s writes a %s file%s; let the name end so", k->name, k->ending ? k->ending : ".json",
                            k->ending && k->zoned ? " or, with zones, a .json file" : "");
    if (!k->most) return demo_write(seed, path, memory, r);
    text_file out = text_open(memory);
    if (strcmp(k->name, "city") == 0) generate_city(size, seed, memory, &out);
    else if (strcmp(k->name, "swarm") == 0) generate_swarm(size, seed, &out);
    else if (strcmp(k->name, "terrain") == 0) generate_terrain(size, seed, memory, &out);
    else if (strcmp(k->name, "forest") == 0) generate_forest(size, seed, memory, &out);
    else generate_rooms(size, seed, memory, &out);
    return text_close(&out, path, r);
}
