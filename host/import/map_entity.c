// Entities of maps: see map_entity.h. Doors open as in Quake's SetMovedir and func_door.
// SPDX-License-Identifier: MIT
#include "map_entity.h"

#include <math.h>

static const double LIP_UNITS = 8; // Quake's default: what of an open door still stands out of the wall

map_word entity_class(const map_entity *e)
{
    const map_key *key = map_entity_key(e, "classname");
    return key ? key->value : (map_word){"", 0};
}

entity_role entity_role_of(map_word class_name)
{
    static const char *const moving[] = {"func_door", "func_plat", "func_train", "func_button"};
    if (map_word_starts(class_name, "trigger_")) return ENTITY_NOTHING;
    for (size_t i = 0; i < sizeof moving / sizeof *moving; ++i)
        if (map_word_starts(class_name, moving[i])) return ENTITY_MOVER;
    return ENTITY_STILL;
}

entity_body entity_body_of(map_word class_name)
{
    if (map_word_starts(class_name, "trigger_") || map_word_is(class_name, "func_detail_illusionary")) return BODY_NONE;
    if (map_word_is(class_name, "csg_subtract")) return BODY_HOLLOW;
    if (map_word_is(class_name, "worldspawn") || map_word_is(class_name, "func_group") || map_word_is(class_name, "csg_add") ||
        map_word_starts(class_name, "func_detail"))
        return BODY_STRUCTURE;
    return BODY_ENTITY;
}

place_kind entity_place_of(map_word class_name)
{
    if (map_word_starts(class_name, "info_player_")) return PLACE_PLAYER;
    return map_word_starts(class_name, "monster_") ? PLACE_MONSTER : PLACE_OTHER;
}

// Where the key is absent out stays as it was; where its value is empty it is 0, as the game reads it.
static result read_key(const map_entity *e, const char *name, const map_reader *m, double *out, int count)
{
    const map_key *key = map_entity_key(e, name);
    if (!key || map_word_numbers(key->value, out, count)) return RESULT_OK;
    if (map_word_numbers(key->value, NULL, 0)) {
        for (int i = 0; i < count; ++i) out[i] = 0;
        report_warning(m->report, m->path, key->line, "entity %u: \"%s\" is empty; taken as 0", e->number, name);
        return RESULT_OK;
    }
    return report_error(m->report, m->path, key->line, "entity %u: \"%s\" takes %d number%s; repair its value", e->number, name, count,
                        count > 1 ? "s" : "");
}

static void direction_of(double angle_deg, double out[3])
{
    static const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const double turn = fmod(angle_deg, 360), quarter = floor(turn / 90);
    out[0] = out[1] = out[2] = 0;
    if (angle_deg == -1) out[2] = 1;
    else if (angle_deg == -2) out[2] = -1;
    else if (quarter * 90 == turn) {
        out[0] = quarters[((int)quarter + 4) % 4][0];
        out[1] = quarters[((int)quarter + 4) % 4][1];
    } else {
        const double radians = turn * (3.14159265358979323846 / 180);
        out[0] = cos(radians);
        out[1] = sin(radians);
    }
}

result entity_open_offset(const map_entity *e, const double min[3], const double max[3], const map_reader *m, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    if (!map_word_is(entity_class(e), "func_door")) return RESULT_OK;
    double angles[3] = {0}, lip = 0, direction[3];
    result done = read_key(e, "angles", m, angles, 3); // pitch, yaw, roll: only yaw turns a door's way
    if (done == RESULT_OK) done = read_key(e, "angle", m, &angles[1], 1);
    if (done == RESULT_OK) done = read_key(e, "lip", m, &lip, 1);
    if (done != RESULT_OK) return done;
    if (!(fabs(lip) <= MAP_COORDINATE_MOST)) {
        const map_key *key = map_entity_key(e, "lip");
        return report_error(m->report, m->path, key->line, "entity %u: a lip within 2^20 units is needed; repair it", e->number);
    }
    if (lip == 0) lip = LIP_UNITS; // as Quake: 0 is the same as not said
    direction_of(angles[1], direction);
    double way = 0;
    for (int k = 0; k < 3; ++k) way += (max[k] - min[k]) * direction[k];
    for (int k = 0; k < 3; ++k) out[k] = direction[k] * (fabs(way) - lip) + 0.0;
    return RESULT_OK;
}
