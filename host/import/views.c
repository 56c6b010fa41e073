// Camera paths: .views files in and out, and the choice between a file, a path of the scene and automatic views.
// SPDX-License-Identifier: MIT
#include "views.h"

#include "../core/file.h"
#include "line_scan.h"
#include "views_auto.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NUMBERS = 13, NUMBER_BYTES = 32, VIEWS_MOST = 100000 };

// ---- Reading ----

static result read_view(line_scan *v, camera *out)
{
    double n[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) {
        if (line_scan_number(v, &n[i])) continue;
        if (i < NUMBERS - 1 || !line_scan_word(v, "inf"))
            return report_error(v->report, v->path, v->line,
                                "number %d of 13 is missing or no decimal number; write eye(3) dir(3) up(3) fovy_deg aspect near far", i + 1);
        n[i] = INFINITY; // the far plane may be there, and is then written so
    }
    if (!line_scan_at_end(v)) return line_scan_fault(v, "more than 13 numbers; write one view a line");
    *out = (camera){.fovy_deg = n[9], .aspect = n[10], .near_m = n[11], .far_m = n[12]};
    memcpy(out->eye, n, sizeof out->eye);
    memcpy(out->forward, n + 3, sizeof out->forward);
    memcpy(out->up, n + 6, sizeof out->up);
    const char *wrong = camera_fault(out);
    return wrong ? report_error(v->report, v->path, v->line, "%s; correct the view", wrong) : RESULT_OK;
}

static result read_views(line_scan *v, buffer *cameras)
{
    for (; v->at < v->end; line_scan_next(v)) {
        if (line_scan_at_end(v)) continue;
        camera *c = buffer_push(cameras, 1);
        if (!c) return report_no_memory(v->report, v->path);
        const result done = read_view(v, c);
        if (done != RESULT_OK) return done;
        if (cameras->count > VIEWS_MOST) return line_scan_fault(v, "over 100,000 views; split the path");
    }
    return cameras->count ? RESULT_OK : report_error(v->report, v->path, 0, "no view in it; write 13 numbers a line");
}

static void name_path(const char *path, char *name, size_t size)
{
    const char *base = strrchr(path, '/');
    base = base ? base + 1 : path;
    static const char ending[] = ".views";
    size_t length = strlen(base);
    if (length > sizeof ending - 1 && strcmp(base + length - (sizeof ending - 1), ending) == 0) length -= sizeof ending - 1;
    snprintf(name, size, "%.*s", length < size ? (int)length : (int)size - 1, base);
}

static result keep(const buffer *cameras, const char *path, report *r, camera_path *out)
{
    camera *kept = memory_alloc(cameras->memory, cameras->count, sizeof *kept);
    if (!kept) return report_no_memory(r, path);
    memcpy(kept, cameras->items, cameras->count * sizeof *kept);
    *out = (camera_path){.cameras = kept, .count = (uint32_t)cameras->count};
    name_path(path, out->name, sizeof out->name);
    return RESULT_OK;
}

result camera_path_parse(const char *path, const char *text, size_t size, const allocator *memory, report *r, camera_path *out)
{
    line_scan v = {.path = path, .at = text, .end = text + size, .line = 1, .report = r, .comment = '#'};
    buffer cameras = buffer_make(memory, sizeof(camera));
    result done = read_views(&v, &cameras);
    if (done == RESULT_OK) done = keep(&cameras, path, r, out);
    buffer_free(&cameras);
    return done;
}

// ---- Automatic ----

typedef enum auto_kind { AUTO_VIEWS, AUTO_WALK, AUTO_EDGES, AUTO_STREET, AUTO_ROOFS, AUTO_TURN, AUTO_DRIVE, AUTO_NONE } auto_kind;
static const char *const auto_starts[AUTO_NONE] = {"auto:", "auto:walk:", "auto:edges:", "auto:street:", "auto:roofs:", "auto:turn:", "auto:drive:"};

static auto_kind auto_kind_of(const char *what, const char **out_count)
{
    auto_kind kind = AUTO_NONE;
    size_t longest = 0; // each starts like the first
    for (auto_kind k = AUTO_VIEWS; k < AUTO_NONE; ++k) {
        const size_t length = strlen(auto_starts[k]);
        if (strncmp(what, auto_starts[k], length) != 0 || length < longest) continue;
        kind = k;
        longest = length;
    }
    *out_count = what + longest;
    return kind;
}

static uint32_t read_count(const char *text)
{
    uint32_t count = 0;
    if (!*text) return 0;
    for (; *text; ++text) {
        if (*text < '0' || *text > '9' || count > VIEWS_MOST) return 0;
        count = count * 10 + (uint32_t)(*text - '0');
    }
    return count <= VIEWS_MOST ? count : 0;
}

static result make_automatic(auto_kind kind, uint32_t count, const scene *s, double aspect, const allocator *memory, report *r, camera_path *out)
{
    static result (*const makers[AUTO_NONE])(auto_views *, uint32_t, camera *) = {auto_views_make,   auto_walk_make,  auto_edges_make,
                                                                                auto_street_make, auto_roofs_make, auto_turn_make, auto_drive_make};
    auto_views a;
    camera *cameras = memory_alloc(memory, count, sizeof *cameras);
    if (!cameras) return report_no_memory(r, s->path);
    result done = auto_views_open(s, aspect, memory, r, &a);
    if (done == RESULT_OK) {
        done = makers[kind](&a, count, cameras);
        auto_views_close(&a);
    }
    if (done != RESULT_OK) {
        memory_free(memory, cameras, count, sizeof *cameras);
        return done;
    }
    *out = (camera_path){.cameras = cameras, .count = count};
    snprintf(out->name, sizeof out->name, "%s%u", auto_starts[kind], count);
    return RESULT_OK;
}

// ---- Of the scene ----

static result copy_path(const scene *s, const scene_camera_path *from, const allocator *memory, report *r, camera_path *out)
{
    camera *cameras = memory_alloc(memory, from->camera_count, sizeof *cameras);
    if (!cameras) return report_no_memory(r, s->path);
    memcpy(cameras, s->cameras + from->first_camera, from->camera_count * sizeof *cameras);
    *out = (camera_path){.cameras = cameras, .count = from->camera_count};
    snprintf(out->name, sizeof out->name, "%s", from->name);
    return RESULT_OK;
}

static result find_path(const char *what, const char *name, const scene *s, const allocator *memory, report *r, camera_path *out)
{
    char known[256] = "";
    if (s->path_count == 0) return report_error(r, NULL, 0, "--views %s: %s has no camera path; use auto:N, or a .views file", what, s->path);
    if (!*name) return copy_path(s, &s->paths[0], memory, r, out);
    for (uint32_t p = 0; p < s->path_count; ++p) {
        if (strcmp(s->paths[p].name, name) == 0) return copy_path(s, &s->paths[p], memory, r, out);
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", s->paths[p].name);
    }
    return report_error(r, NULL, 0, "--views %s: no such path in %s; it has: %s", what, s->path, known);
}

result camera_path_load(const char *what, const scene *s, double aspect, const allocator *memory, report *r, camera_path *out)
{
    const char *number = NULL;
    const auto_kind kind = auto_kind_of(what, &number);
    if (kind != AUTO_NONE) {
        const uint32_t count = read_count(number);
        if (!count) return report_error(r, NULL, 0, "--views %s: write auto:N, auto:walk:N, auto:drive:N, auto:edges:N, auto:street:N, auto:roofs:N or auto:turn:N, N from 1 to 100000", what);
        return make_automatic(kind, count, s, aspect, memory, r, out);
    }
    static const char of_scene[] = "path:";
    if (strncmp(what, of_scene, sizeof of_scene - 1) == 0) return find_path(what, what + sizeof of_scene - 1, s, memory, r, out);
    char *text;
    size_t size;
    result done = file_read(what, memory, r, &text, &size);
    if (done != RESULT_OK) return done;
    done = camera_path_parse(what, text, size, memory, r, out);
    memory_free(memory, text, size + 1, 1);
    return done;
}

// ---- Writing ----

// 17 digits tell every double from its neighbours, so the text reads back bit for bit.
static size_t write_view(const camera *c, char *to, size_t room)
{
    const double n[NUMBERS] = {c->eye[0], c->eye[1], c->eye[2], c->forward[0], c->forward[1], c->forward[2], c->up[0],
                               c->up[1],  c->up[2],  c->fovy_deg, c->aspect,   c->near_m,     c->far_m};
    size_t used = 0;
    for (int i = 0; i < NUMBERS; ++i) {
        const int length = snprintf(to + used, room - used, "%.17g%c", n[i], i + 1 < NUMBERS ? ' ' : '\n');
        for (int k = 0; k < length; ++k)
            if (to[used + (size_t)k] == ',') to[used + (size_t)k] = '.'; // a locale's decimal comma
        used += (size_t)length;
    }
    return used;
}

result camera_path_text(const camera_path *p, const allocator *memory, char **out_text, size_t *out_size)
{
    const size_t room = (size_t)p->count * NUMBERS * NUMBER_BYTES + 1;
    char *wide = memory_alloc(memory, room, 1);
    if (!wide) return RESULT_NO_MEMORY;
    size_t size = 0;
    for (uint32_t i = 0; i < p->count; ++i) size += write_view(&p->cameras[i], wide + size, room - size);
    char *text = memory_alloc(memory, size + 1, 1);
    if (text) {
        memcpy(text, wide, size);
        text[size] = 0;
        *out_text = text;
        *out_size = size;
    }
    memory_free(memory, wide, room, 1);
    return text ? RESULT_OK : RESULT_NO_MEMORY;
}

void camera_path_free(camera_path *p, const allocator *memory)
{
    memory_free(memory, p->cameras, p->count, sizeof *p->cameras);
    *p = (camera_path){0};
}
