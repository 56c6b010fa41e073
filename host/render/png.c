// PNG files: made whole in memory, then written under their name or not at all.
// SPDX-License-Identifier: MIT
#include "render.h"

#include "../core/file.h"

#include <png.h>

static const uint32_t PNG_SIDE_MOST = 1u << 15; // pixels

static result refuse(const char *path, report *r, const char *why)
{
    return report_error(r, path, 0, "the picture can't be written as PNG: %s; try a smaller one", why);
}

result png_write(const char *path, const uint8_t *rgba, uint32_t width_px, uint32_t height_px, report *r)
{
    if (width_px == 0 || height_px == 0 || width_px > PNG_SIDE_MOST || height_px > PNG_SIDE_MOST) return refuse(path, r, "its size");
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width_px, .height = height_px, .format = PNG_FORMAT_RGBA, .flags = PNG_IMAGE_FLAG_FAST};
    const size_t most = PNG_IMAGE_PNG_SIZE_MAX(image);
    const allocator *memory = allocator_heap();
    void *bytes = memory_alloc(memory, most, 1);
    if (!bytes) return report_no_memory(r, path);
    png_alloc_size_t size = most;
    const int written = png_image_write_to_memory(&image, bytes, &size, 0, rgba, 0, NULL);
    const result done = written ? file_write(path, bytes, size, r) : refuse(path, r, image.message);
    memory_free(memory, bytes, most, 1);
    return done;
}
