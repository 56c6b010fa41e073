// Writes a JSON scene: see generate_json.h.
// SPDX-License-Identifier: MIT
#include "generate_json.h"

void json_open(json_writer *j, text_file *out, const char *name)
{
    *j = (json_writer){.out = out};
    text_add(out, "{\n\"portcullis\": 1,\n\"name\": \"");
    text_add(out, name);
    text_add(out, "\"");
}

void json_close(json_writer *j)
{
    text_add(j->out, "\n}\n");
}

void json_list(json_writer *j, const char *key)
{
    text_add(j->out, ",\n\"");
    text_add(j->out, key);
    text_add(j->out, "\": [");
    j->is_first = 1;
}

void json_list_end(json_writer *j)
{
    text_add(j->out, j->is_first ? "]" : "\n]");
}

void json_item(json_writer *j)
{
    text_add(j->out, j->is_first ? "\n" : ",\n");
    j->is_first = 0;
}

// As JSON has it: a file's name may hold any byte but '/' and 0.
static void add_letter(text_file *out, char c)
{
    static const char digits[] = "0123456789abcdef";
    const unsigned char code = (unsigned char)c;
    const char letter[2] = {c, 0}, escaped[7] = {'\\', 'u', '0', '0', digits[code >> 4], digits[code & 15], 0};
    if (code < 0x20) {
        text_add(out, escaped);
        return;
    }
    if (c == '"' || c == '\\') text_add(out, "\\");
    text_add(out, letter);
}

void json_mesh(json_writer *j, const char *file)
{
    json_list(j, "meshes");
    json_item(j);
    text_add(j->out, "{\"file\": \"");
    for (const char *c = file; *c; ++c) add_letter(j->out, *c);
    text_add(j->out, "\"}");
    json_list_end(j);
}

void json_place(text_file *out, place p)
{
    text_add(out, "[");
    text_decimal(out, p.x, PLACE_DECIMALS);
    text_add(out, ", ");
    text_decimal(out, p.y, PLACE_DECIMALS);
    text_add(out, ", ");
    text_decimal(out, p.z, PLACE_DECIMALS);
    text_add(out, "]");
}

void json_numbered(text_file *out, const char *kind, uint32_t number)
{
    text_add(out, "\"");
    text_add(out, kind);
    if (number != PLAN_OUTSIDE) {
        text_add(out, "_");
        text_count(out, number);
    }
    text_add(out, "\"");
}

void json_box(text_file *out, const block *b, const char *material)
{
    text_add(out, "{\"min\": ");
    json_place(out, b->min);
    text_add(out, ", \"max\": ");
    json_place(out, b->max);
    text_add(out, ", \"material\": \"");
    text_add(out, material);
    text_add(out, "\"}");
}

// ---- From a plan ----

static void zone_name(text_file *out, const plan *p, uint32_t room)
{
    if (room == PLAN_OUTSIDE) json_numbered(out, p->quarter.name ? p->quarter.name : "outside", PLAN_OUTSIDE);
    else json_numbered(out, plan_room_at(p, room)->kind, plan_room_at(p, room)->number);
}

static void add_text(text_file *out, const char *key, const char *text)
{
    text_add(out, ", \"");
    text_add(out, key);
    text_add(out, "\": \"");
    text_add(out, text);
    text_add(out, "\"");
}

static void add_box(text_file *out, const block *b)
{
    text_add(out, ", \"box\": [");
    json_place(out, b->min);
    text_add(out, ", ");
    json_place(out, b->max);
    text_add(out, "]");
}

static void open_zones(json_writer *j, const plan *p)
{
    json_item(j);
    text_add(j->out, "{\"name\": \"outside\"");
    add_text(j->out, "chain", p->outside_chain ? p->outside_chain : "frustum");
    text_add(j->out, "}");
    if (!p->quarter.name) return;
    json_item(j);
    text_add(j->out, "{\"name\": ");
    zone_name(j->out, p, PLAN_OUTSIDE);
    add_box(j->out, &p->quarter.zone);
    add_text(j->out, "in", "outside");
    add_text(j->out, "chain", p->quarter.chain);
    text_add(j->out, "}");
}

void json_zones(json_writer *j, const plan *p)
{
    json_list(j, "zones");
    if (p->has_outside) open_zones(j, p);
    for (uint32_t i = 0; i < plan_room_count(p) && !j->out->failed; ++i) {
        const plan_room *r = plan_room_at(p, i);
        json_item(j);
        text_add(j->out, "{\"name\": ");
        zone_name(j->out, p, i);
        add_box(j->out, &r->zone);
        if (p->has_outside) add_text(j->out, "in", p->quarter.name ? p->quarter.name : "outside");
        if (r->chain) add_text(j->out, "chain", r->chain);
        text_add(j->out, "}");
    }
    json_list_end(j);
}

// ---- Portals ----

static void corners_write(text_file *out, const place corners[4])
{
    text_add(out, "], \"points\": [");
    for (int k = 0; k < 4; ++k) {
        if (k) text_add(out, ", ");
        json_place(out, corners[k]);
    }
    text_add(out, "]");
}

// Counterclockwise seen from within.
static void quarter_portals(json_writer *j, const plan_quarter *q)
{
    enum { FACES = 5 };
    const place a = {q->zone.min.x, q->ground, q->zone.min.z}, b = q->zone.max;
    const place faces[FACES][4] = {{{a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z}},
                                   {{b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}},
                                   {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}},
                                   {{a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
                                   {{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}};
    for (uint32_t i = 0; i < FACES; ++i) {
        json_item(j);
        text_add(j->out, "{\"name\": ");
        json_numbered(j->out, "edge", i);
        text_add(j->out, ", \"zones\": [");
        json_numbered(j->out, q->name, PLAN_OUTSIDE);
        text_add(j->out, ", \"outside\"");
        corners_write(j->out, faces[i]);
        text_add(j->out, "}");
    }
}

void json_portals(json_writer *j, const plan *p)
{
    json_list(j, "portals");
    for (uint32_t i = 0; i < plan_hole_count(p) && !j->out->failed; ++i) {
        const plan_hole *h = plan_hole_at(p, i);
        place corners[4];
        plan_hole_corners(h, corners);
        json_item(j);
        text_add(j->out, "{\"name\": ");
        json_numbered(j->out, "portal", i);
        text_add(j->out, ", \"zones\": [");
        zone_name(j->out, p, h->rooms[0]);
        text_add(j->out, ", ");
        zone_name(j->out, p, h->rooms[1]);
        corners_write(j->out, corners);
        if (h->door != PLAN_GAP) {
            text_add(j->out, ", \"door\": ");
            json_numbered(j->out, "door", i);
        }
        text_add(j->out, "}");
    }
    if (p->quarter.name) quarter_portals(j, &p->quarter);
    json_list_end(j);
}

void json_doors(json_writer *j, const plan *p)
{
    json_list(j, "doors");
    for (uint32_t i = 0; i < plan_hole_count(p) && !j->out->failed; ++i) {
        const plan_hole *h = plan_hole_at(p, i);
        if (h->door == PLAN_GAP) continue;
        json_item(j);
        text_add(j->out, "{\"name\": ");
        json_numbered(j->out, "door", i);
        text_add(j->out, h->door == PLAN_DOOR_OPEN ? ", \"open\": true, \"mover\": " : ", \"open\": false, \"mover\": ");
        json_numbered(j->out, "leaf", i);
        text_add(j->out, "}");
    }
    json_list_end(j);
}

void json_leaves(json_writer *j, const plan *p)
{
    for (uint32_t i = 0; i < plan_hole_count(p) && !j->out->failed; ++i) {
        const plan_hole *h = plan_hole_at(p, i);
        if (h->door == PLAN_GAP) continue;
        const block leaf = plan_leaf(h);
        const int along_z = h->side == SIDE_MIN_X || h->side == SIDE_MAX_X;
        json_item(j);
        text_add(j->out, "{\"name\": ");
        json_numbered(j->out, "leaf", i);
        text_add(j->out, ", \"box\": ");
        json_box(j->out, &leaf, h->leaf);
        text_add(j->out, ", \"open\": ");
        json_place(j->out, along_z ? (place){0, 0, h->slide} : (place){h->slide, 0, 0});
        text_add(j->out, "}");
    }
}
