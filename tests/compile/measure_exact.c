// What exact decisions cost: ns a call by family of planes, beside GMP, and ms for the input of each map given.
// usage: measure_exact [MAP...]
// SPDX-License-Identifier: MIT
#define _POSIX_C_SOURCE 199309L // clock_gettime
#include "exact_oracle.h"
#include "host/compile/compile.h"
#include "host/compile/plane_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SETS = 4096, ROUNDS = 64, GMP_ROUNDS = 2, MAP_RUNS = 5 };

static double cpu_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

typedef struct planes_set { cull_wide_plane p[4]; } planes_set;

static int64_t sum; // of signs, printed, so that no call can be left out

static double ns_a_call(double ms, int rounds)
{
    return ms * 1e6 / ((double)SETS * rounds);
}

static void measure_family(plane_family f, planes_set *sets)
{
    uint64_t seed = 1;
    uint32_t tiers[4] = {0};
    for (int i = 0; i < SETS; ++i) family_planes(f, &seed, sets[i].p);
    double start = cpu_ms();
    for (int r = 0; r < ROUNDS; ++r)
        for (int i = 0; i < SETS; ++i) {
            cull_tier tier;
            const cull_wide_plane *p = sets[i].p;
            sum += cull_four_sign_tier(&p[0], &p[1], &p[2], &p[3], &tier);
            tiers[tier]++;
        }
    const double four = ns_a_call(cpu_ms() - start, ROUNDS);
    start = cpu_ms();
    for (int r = 0; r < ROUNDS; ++r)
        for (int i = 0; i < SETS; ++i) {
            const cull_wide_plane *const p[4] = {&sets[i].p[0], &sets[i].p[1], &sets[i].p[2], &sets[i].p[3]};
            sum += cull_four_256(p);
        }
    const double widest = ns_a_call(cpu_ms() - start, ROUNDS);
    start = cpu_ms();
    for (int r = 0; r < ROUNDS; ++r)
        for (int i = 0; i < SETS; ++i) {
            double position[3];
            const cull_wide_plane *p = sets[i].p;
            sum += cull_meet_position(&p[0], &p[1], &p[2], position) && position[0] > 0;
        }
    const double position = ns_a_call(cpu_ms() - start, ROUNDS);
    start = cpu_ms();
    for (int r = 0; r < GMP_ROUNDS; ++r)
        for (int i = 0; i < SETS; ++i) sum += gmp_four_sign(sets[i].p);
    const double all = (double)SETS * ROUNDS / 100;
    printf("%-12s %7.1f %9.1f %9.1f %9.1f   %5.1f %5.1f %5.1f %5.1f\n", family_name(f), four, widest, position, ns_a_call(cpu_ms() - start, GMP_ROUNDS),
           tiers[0] / all, tiers[1] / all, tiers[2] / all, tiers[3] / all);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static int measure_map(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) return 0;
    fseek(file, 0, SEEK_END);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(size + 1);
    int read = text && fread(text, 1, size, file) == size;
    fclose(file);
    double runs[MAP_RUNS];
    report r = {0};
    for (int i = 0; i < MAP_RUNS && read; ++i) {
        compile_input *in = NULL;
        const double start = cpu_ms();
        read = compile_input_map(path, text, size, NULL, allocator_heap(), &r, &in) == RESULT_OK;
        runs[i] = cpu_ms() - start;
        if (read && i + 1 == MAP_RUNS) {
            qsort(runs, MAP_RUNS, sizeof *runs, by_size);
            printf("%s: %u brushes, %u faces, %u welded: %.1f ms, median of %d\n", path, in->brush_count, in->face_count, in->weld_moves,
                   runs[MAP_RUNS / 2], MAP_RUNS);
        }
        compile_input_free(in);
    }
    free(text);
    return read;
}

int main(int count, char **arguments)
{
    planes_set *sets = malloc(SETS * sizeof *sets);
    if (!sets) return 1;
    printf("ns a call     tiers  256 only  position  GMP       %% by double, 64, 128, 256\n");
    for (int f = 0; f < FAMILY_COUNT; ++f) measure_family((plane_family)f, sets);
    printf("(%lld)\n", (long long)sum);
    free(sets);
    for (int i = 1; i < count; ++i)
        if (!measure_map(arguments[i])) {
            fprintf(stderr, "%s: cannot be read\n", arguments[i]);
            return 1;
        }
    return 0;
}
