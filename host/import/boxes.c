// Reader of .boxes files: `boxes N`, then N lines of minx miny minz maxx maxy maxz. A box is one item of 6 polygons.
// SPDX-License-Identifier: MIT
#include "reader.h"

#include "line_scan.h"
#include "number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { HUES = 16, FACES = 6 };
static const double COORDINATE_MOST = 1e9; // metres, the scene's own limit: here the line is still known

typedef struct box_reader {
    line_scan text;
    scene_builder *builder;
    uint32_t materials[HUES], object;
    uint64_t flat; // boxes without any area
} box_reader;

static result read_head(box_reader *b, uint32_t *out_count)
{
    static const char word[] = "boxes";
    line_scan_skip_empty(&b->text);
    if ((size_t)(b->text.end - b->text.at) < sizeof word - 1 || memcmp(b->text.at, word, sizeof word - 1) != 0)
        return line_scan_fault(&b->text, "the first line must be `boxes N`; is this a .boxes file?");
    b->text.at += sizeof word - 1;
    const char *behind_word = b->text.at;
    line_scan_skip_blanks(&b->text);
    double count = 0;
    const char *behind = b->text.at > behind_word ? number_read(b->text.at, b->text.end, &count) : NULL;
    if (!behind || count != floor(count) || count < 1 || count > UINT32_MAX)
        return line_scan_fault(&b->text, "`boxes` takes a whole number from 1 on; write how many lines follow");
    b->text.at = behind;
    *out_count = (uint32_t)count;
    return line_scan_at_end(&b->text) ? RESULT_OK : line_scan_fault(&b->text, "more than `boxes N` on the first line; begin a new line");
}

static result read_box(box_reader *b, double box[6])
{
    for (int k = 0; k < 6; ++k) {
        if (!line_scan_number(&b->text, &box[k])) return line_scan_fault(&b->text, "not six decimal numbers; write minx miny minz maxx maxy maxz");
        if (!(fabs(box[k]) <= COORDINATE_MOST)) return line_scan_fault(&b->text, "a coordinate beyond 1e9 m; move the boxes nearer to the origin");
    }
    if (!line_scan_at_end(&b->text)) return line_scan_fault(&b->text, "more than six numbers; write one box a line");
    for (int k = 0; k < 3; ++k)
        if (box[k] > box[3 + k]) return line_scan_fault(&b->text, "a min above its max; write the three least coordinates first");
    return RESULT_OK;
}

// A repeatable scatter of the materials, so that neighbours in the file differ.
static uint32_t hue_of(uint32_t number)
{
    uint32_t h = number * 0x9e3779b9u;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    return (h ^ h >> 13) % HUES;
}

// Corner i is at max in x, y, z by its bits 0, 1, 2. Faces counterclockwise from outside; each has no extent along one axis.
static result add_box(box_reader *b, const double box[6], uint32_t number)
{
    static const uint32_t faces[FACES][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    static const uint32_t polygon_triangles[FACES] = {2, 2, 2, 2, 2, 2};
    const int wide[3] = {box[3] > box[0], box[4] > box[1], box[5] > box[2]};
    if (wide[0] + wide[1] + wide[2] < 2) {
        b->flat++;
        return RESULT_OK;
    }
    builder_vertex vertices[8] = {0};
    for (uint32_t v = 0; v < 8; ++v)
        for (uint32_t k = 0; k < 3; ++k) vertices[v].position[k] = box[v >> k & 1 ? 3 + k : k];
    const uint32_t material = b->materials[hue_of(number)];
    uint32_t first, indices[FACES * 6], used = 0;
    const result done = scene_builder_vertices(b->builder, vertices, 8, material, &first);
    if (done != RESULT_OK) return done;
    for (int f = 0; f < FACES; ++f) {
        const int axis = f / 2;
        if (!wide[(axis + 1) % 3] || !wide[(axis + 2) % 3]) continue;
        for (uint32_t t = 0; t < 2; ++t)
            for (uint32_t c = 0; c < 3; ++c) indices[used++] = first + faces[f][c == 0 ? 0 : t + c];
    }
    const builder_item item = {.indices = indices,
                               .polygon_triangles = polygon_triangles,
                               .index_count = used,
                               .polygon_count = used / 6,
                               .material = material,
                               .object = b->object,
                               .flags = CULL_ITEM_BOX};
    return scene_builder_item(b->builder, &item);
}

static result make_materials(box_reader *b)
{
    for (uint32_t i = 0; i < HUES; ++i) {
        char name[16];
        const int length = snprintf(name, sizeof name, "box%u", i);
        const result done = scene_builder_material(b->builder, name, (size_t)length, 0, &b->materials[i]);
        if (done != RESULT_OK) return done;
    }
    return scene_builder_object(b->builder, "boxes", 5, &b->object);
}

static result read_boxes(box_reader *b)
{
    uint32_t count = 0;
    result done = read_head(b, &count);
    if (done != RESULT_OK) return done;
    if (make_materials(b) != RESULT_OK) return report_no_memory(b->text.report, b->text.path);
    for (uint32_t i = 0; i < count; ++i) {
        double box[6];
        line_scan_skip_empty(&b->text);
        if (b->text.at >= b->text.end)
            return report_error(b->text.report, b->text.path, b->text.line, "the file ends after %u of %u boxes; correct the count or add the rest", i, count);
        done = read_box(b, box);
        if (done != RESULT_OK) return done;
        done = add_box(b, box, i);
        if (done == RESULT_NO_MEMORY) return report_no_memory(b->text.report, b->text.path);
        if (done != RESULT_OK) return line_scan_fault(&b->text, "over 2^32 of anything; split the file");
    }
    line_scan_skip_empty(&b->text);
    return b->text.at >= b->text.end ? RESULT_OK : line_scan_fault(&b->text, "more lines than `boxes N` says; correct the count");
}

result boxes_into(const reader_job *j)
{
    box_reader b = {.text = {.path = j->path, .at = j->text, .end = j->text + j->size, .line = 1, .report = j->report, .comment = '\n'},
                    .builder = j->builder};
    const result done = read_boxes(&b);
    if (done == RESULT_OK && b.flat) report_note(j->report, "%s: %llu boxes have no area and are left out", j->path, (unsigned long long)b.flat);
    return done;
}
