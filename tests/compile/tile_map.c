// Not a test: writes SIDE times SIDE copies of a map as one.
// usage: tile_map IN.map SIDE OUT.map
// SPDX-License-Identifier: MIT
#include "map_tile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *read_whole(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*size + 1);
    if (text && fread(text, 1, *size, file) != *size) {
        free(text);
        text = NULL;
    }
    fclose(file);
    return text;
}

int main(int count, char **arguments)
{
    static const char *const faults[] = {"", "it is no map", "the copies would lie beyond 65,536 units", "out of memory"};
    const int side = count == 4 ? atoi(arguments[2]) : 0;
    if (side < 1 || side > 64) {
        fprintf(stderr, "usage: tile_map IN.map SIDE OUT.map, SIDE from 1 to 64\n");
        return 2;
    }
    size_t size = 0, tiled_size = 0;
    char *text = read_whole(arguments[1], &size), *tiled = NULL;
    const tile_fault fault = text ? map_tile(text, size, (unsigned)side, &tiled, &tiled_size) : TILE_NO_MAP;
    free(text);
    if (fault != TILE_SOUND) {
        fprintf(stderr, "%s: %s\n", arguments[1], faults[fault]);
        return 1;
    }
    FILE *file = fopen(arguments[3], "wb");
    const int wrote = file && fwrite(tiled, 1, tiled_size, file) == tiled_size;
    free(tiled);
    if (file && fclose(file) == 0 && wrote) return 0;
    fprintf(stderr, "%s: cannot be written\n", arguments[3]);
    return 1;
}
