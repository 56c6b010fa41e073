// Scenes of zones alone: see fixture.h.
// SPDX-License-Identifier: MIT
#include "fixture.h"

#include "tests/common/test.h"

#include <math.h>
#include <string.h>

void fixture_make(zone_fixture *f)
{
    const allocator *heap = allocator_heap();
    *f = (zone_fixture){.zones = buffer_make(heap, sizeof(scene_zone)),
                        .hulls = buffer_make(heap, sizeof(scene_hull)),
                        .planes = buffer_make(heap, sizeof(scene_solid_plane))};
    f->scene.step = FIXTURE_STEP;
}

void fixture_free(zone_fixture *f)
{
    buffer_free(&f->zones);
    buffer_free(&f->hulls);
    buffer_free(&f->planes);
}

static void fixture_renew(zone_fixture *f)
{
    scene *s = &f->scene;
    s->zones = f->zones.items;
    s->hulls = f->hulls.items;
    s->hull_planes = f->planes.items;
    s->zone_count = (uint32_t)f->zones.count;
    s->hull_count = (uint32_t)f->hulls.count;
    s->hull_plane_count = (uint32_t)f->planes.count;
}

uint32_t fixture_zone(zone_fixture *f, uint32_t flags, uint32_t parent)
{
    const scene_zone zone = {.name = "zone", .flags = flags, .parent = parent, .first_hull = (uint32_t)f->hulls.count};
    assert_non_null(buffer_append(&f->zones, &zone, 1));
    fixture_renew(f);
    return f->scene.zone_count - 1;
}

void fixture_origin(zone_fixture *f, uint32_t zone, double x, double y, double z)
{
    scene_zone *own = &f->scene.zones[zone];
    own->origin[0] = x;
    own->origin[1] = y;
    own->origin[2] = z;
}

static void fixture_hull(zone_fixture *f, const scene_solid_plane *planes, uint32_t count, const double min[3], const double max[3])
{
    scene_hull hull = {f->scene.zone_count - 1, (uint32_t)f->planes.count, count, {0}, {0}};
    memcpy(hull.min, min, sizeof hull.min);
    memcpy(hull.max, max, sizeof hull.max);
    assert_non_null(buffer_append(&f->planes, planes, count));
    assert_non_null(buffer_append(&f->hulls, &hull, 1));
    f->scene.zones[f->scene.zone_count - 1].hull_count++;
    fixture_renew(f);
}

void fixture_box(zone_fixture *f, const double min[3], const double max[3])
{
    scene_solid_plane planes[6];
    memset(planes, 0, sizeof planes);
    for (int k = 0; k < 3; k++) {
        planes[2 * k].normal[k] = -1;
        planes[2 * k].distance = -min[k];
        planes[2 * k + 1].normal[k] = 1;
        planes[2 * k + 1].distance = max[k];
    }
    fixture_hull(f, planes, 6, min, max);
}

void fixture_gem(zone_fixture *f, const double centre[3], double radius, double turn)
{
    scene_solid_plane planes[10];
    double min[3], max[3];
    for (uint32_t i = 0; i < 10; i++) {
        const double angle = turn + 0.785398163 * i, tilt = i % 2 ? 0.4 : -0.3;
        double *n = planes[i].normal;
        n[0] = i < 8 ? cos(angle) * cos(tilt) : 0;
        n[1] = i < 8 ? sin(tilt) : i == 8 ? 1 : -1;
        n[2] = i < 8 ? sin(angle) * cos(tilt) : 0;
        planes[i].distance = n[0] * centre[0] + n[1] * centre[1] + n[2] * centre[2] + radius * (i < 8 ? 1 : 0.75);
    }
    for (int k = 0; k < 3; k++) { // wide of the corners
        min[k] = centre[k] - 2 * radius;
        max[k] = centre[k] + 2 * radius;
    }
    fixture_hull(f, planes, 10, min, max);
}

void fixture_rooms(zone_fixture *f, uint32_t side, double size, const double corner[3])
{
    for (uint32_t i = 0; i < side * side; i++) {
        const double x = corner[0] + size * (i % side), z = corner[2] + size * (double)(i / side);
        const double min[3] = {x, corner[1], z}, max[3] = {x + size, corner[1] + 4, z + size};
        const uint32_t zone = fixture_zone(f, 0, SCENE_NONE);
        fixture_box(f, min, max);
        fixture_origin(f, zone, floor(x), floor(corner[1]), floor(z));
    }
}

static double corner_height(const scene_solid_plane *plane, const double low[3], const double high[3], int is_highest)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double a = plane->normal[k] * low[k], b = plane->normal[k] * high[k];
        sum += is_highest ? fmax(a, b) : fmin(a, b);
    }
    return sum - plane->distance;
}

static int zone_has_hull(const scene *s, uint32_t zone, const double min[3], const double max[3], double reach, int whole)
{
    for (uint32_t h = s->zones[zone].first_hull; h < s->zones[zone].first_hull + s->zones[zone].hull_count; h++) {
        const scene_hull *hull = &s->hulls[h];
        int found = 1;
        for (int k = 0; k < 3; k++) {
            if (whole) found &= hull->min[k] < min[k] - reach && hull->max[k] > max[k] + reach;
            else found &= hull->min[k] <= max[k] + reach && hull->max[k] >= min[k] - reach;
        }
        for (uint32_t i = 0; found && i < hull->plane_count; i++) {
            const double height = corner_height(&s->hull_planes[hull->first_plane + i], min, max, whole);
            found = whole ? height < -reach : height <= reach;
        }
        if (found) return 1;
    }
    return 0;
}

uint32_t oracle_zones(const zone_fixture *f, const double min[3], const double max[3], oracle_margins margins, uint32_t *zones)
{
    const scene *s = &f->scene;
    uint32_t count = 0;
    for (uint32_t z = 0; z < s->zone_count; z++) {
        if (s->zones[z].flags & ZONE_STRAY) continue;
        if (!(s->zones[z].flags & ZONE_EVERYWHERE) && !zone_has_hull(s, z, min, max, margins.touch, 0)) continue;
        int is_taken = 0;
        for (uint32_t c = 0; c < s->zone_count && !is_taken; c++) {
            is_taken = s->zones[c].parent == z && zone_has_hull(s, c, min, max, margins.hold, 1);
        }
        if (!is_taken) zones[count++] = z;
    }
    return count;
}

uint32_t oracle_zones_of_box(const zone_fixture *f, const double min[3], const double max[3], uint32_t *zones)
{
    return oracle_zones(f, min, max, (oracle_margins){f->scene.step, 2 * f->scene.step}, zones);
}
