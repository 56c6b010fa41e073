// same_region A.png B.png X Y WIDTH HEIGHT: exit 0 when both pictures hold the same colours there, 1 when not, 2 on trouble.
// SPDX-License-Identifier: MIT
#include <png.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct picture {
    png_image image;
    unsigned char *rgba;
} picture;

static int picture_read(const char *path, picture *out)
{
    *out = (picture){.image = {.version = PNG_IMAGE_VERSION}};
    if (!png_image_begin_read_from_file(&out->image, path)) return 0;
    out->image.format = PNG_FORMAT_RGBA;
    out->rgba = malloc(PNG_IMAGE_SIZE(out->image));
    return out->rgba && png_image_finish_read(&out->image, NULL, out->rgba, 0, NULL);
}

int main(int argc, char **argv)
{
    picture a = {0}, b = {0};
    unsigned long at[4], different = 0;
    if (argc != 7 || !picture_read(argv[1], &a) || !picture_read(argv[2], &b)) return 2;
    for (int i = 0; i < 4; ++i) at[i] = strtoul(argv[3 + i], NULL, 10);
    if (a.image.width != b.image.width || a.image.height != b.image.height || at[0] + at[2] > a.image.width || at[1] + at[3] > a.image.height)
        return 2;
    for (unsigned long y = at[1]; y < at[1] + at[3]; ++y)
        for (unsigned long x = at[0]; x < at[0] + at[2]; ++x)
            different += memcmp(a.rgba + 4 * (y * a.image.width + x), b.rgba + 4 * (y * a.image.width + x), 4) != 0;
    printf("%lu of %lu pixels differ\n", different, at[2] * at[3]);
    free(a.rgba);
    free(b.rgba);
    return different != 0;
}
