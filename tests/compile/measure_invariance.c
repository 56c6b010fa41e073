// Not a test: each map given, turned in every way, against itself: what differs, and its CPU time over that of the unturned
// map at the same scale, the least of 5 each.
// usage: measure_invariance [quick] MAP...
// SPDX-License-Identifier: MIT
#include "tests/common/test.h"

#include "map_print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct source { const char *path; char *text; size_t size; int runs; } source;

static source read_source(const char *path, int runs)
{
    source s = {.path = path, .runs = runs};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    s.size = (size_t)ftell(file);
    rewind(file);
    s.text = malloc(s.size + 1);
    assert_non_null(s.text);
    assert_int_equal(fread(s.text, 1, s.size, file), s.size);
    fclose(file);
    return s;
}

static map_print best_of(const source *s, const map_rewrite *by, portal_choice choice)
{
    size_t size;
    char *text = map_rewritten(s->text, s->size, by, &size);
    map_print best = map_print_of(text, size, by, choice);
    for (int i = 1; i < s->runs; ++i) {
        map_print again = map_print_of(text, size, by, choice);
        if (again.cpu_ms < best.cpu_ms) best.cpu_ms = again.cpu_ms;
        map_print_free(&again);
    }
    free(text);
    return best;
}

static void print_counts(const map_counts *c)
{
    printf("  in %u csg %u merged %u traced %u zones %u sealed %u shells %u portals %u leak %u t-junctions %u triangles %u weld %u\n", c->polygons_in,
           c->polygons_csg, c->polygons_merged, c->polygons_traced, c->zones, c->zones_sealed, c->shells, c->portals, c->leak, c->t_junctions_inserted,
           c->triangles, c->weld_moves);
}

static void against(const source *s, const map_print *base, const map_rewrite *by, portal_choice choice)
{
    char words[DIFFERENCES_BYTES];
    map_print p = best_of(s, by, choice);
    const int count = map_print_differences(base, &p, by->points == POINTS_ROUNDED ? PRINT_ZONES : PRINT_ALL, words);
    printf("  %-18s %5.2f%s%s", by->name, p.cpu_ms / base->cpu_ms, count ? "  DIFFERS:" : "", words);
    if (by->points == POINTS_ROUNDED) printf("  weld %u moves, at most %g units", p.counts.weld_moves, p.max_move);
    printf("\n");
    fflush(stdout);
    map_print_free(&p);
}

static void all_ways(const source *s, portal_choice choice)
{
    const map_rewrite still = rewrite_scaled(1);
    map_print base = best_of(s, &still, choice);
    printf("%s %s %.1f ms\n", s->path, choice == PORTALS_DOORS ? "doors" : "none", base.cpu_ms);
    print_counts(&base.counts);
    for (int i = 1; i < 48; i += s->runs > 1 ? 5 : 1) {
        const map_rewrite by = rewrite_turned(i);
        against(s, &base, &by, choice);
    }
    map_rewrite by = still;
    by.name = "moved";
    by.move[0] = 1001, by.move[1] = -703, by.move[2] = 300;
    against(s, &base, &by, choice);
    for (unsigned shuffle = 1; shuffle < 8; ++shuffle) {
        by = still;
        by.name = "shuffled";
        by.shuffle = shuffle;
        against(s, &base, &by, choice);
    }
    map_print_free(&base);
    for (int i = 0; i < SLANTED_TURNS; ++i) {
        by = rewrite_slanted(i);
        const map_rewrite larger = rewrite_scaled(by.scale);
        base = best_of(s, &larger, choice);
        against(s, &base, &by, choice);
        map_print_free(&base);
    }
    by = still;
    by.points = POINTS_ROUNDED;
    base = best_of(s, &by, choice);
    for (int i = 0; i < SLANTED_TURNS; ++i) {
        by = rewrite_slanted(i);
        by.points = POINTS_ROUNDED;
        against(s, &base, &by, choice);
    }
    map_print_free(&base);
}

typedef struct arguments { int count; char **text; } arguments;

static void measure(void **state) // as a test, for its assertions to tell where they fail
{
    const arguments *a = *state;
    const int quick = a->count > 1 && strcmp(a->text[1], "quick") == 0;
    for (int i = 1 + quick; i < a->count; ++i) {
        const source s = read_source(a->text[i], quick ? 1 : 5);
        all_ways(&s, PORTALS_NONE);
        all_ways(&s, PORTALS_DOORS);
        free(s.text);
    }
}

int main(int argc, char **argv)
{
    arguments a = {argc, argv};
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(measure, &a)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
