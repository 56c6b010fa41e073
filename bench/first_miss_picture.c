// The picture of a first miss: see first_miss_picture.h.
// SPDX-License-Identifier: MIT
#include "first_miss_picture.h"

#include <math.h>
#include <string.h>

enum { CROP_PX = 17, RING_PX = 14, FRAME_PX = 2, MAGNIFIED_MOST = 16 }; // CROP_PX: odd, so that the spot is its middle
typedef struct colour { uint8_t red, green, blue; } colour;
static const colour MAGENTA = {255, 0, 255}, GREEN = {40, 220, 80}, WHITE = {255, 255, 255}, BLACK = {0, 0, 0};

static void put(const miss_picture *p, uint8_t *rgba, int64_t x, int64_t y, colour c)
{
    if (x < 0 || y < 0 || x >= p->width_px || y >= p->height_px) return;
    uint8_t *to = rgba + ((size_t)y * p->width_px + (size_t)x) * 4;
    to[0] = c.red;
    to[1] = c.green;
    to[2] = c.blue;
    to[3] = 255;
}

static void draw_base(const miss_picture *p, uint8_t *rgba)
{
    const size_t pixels = (size_t)p->width_px * p->height_px;
    for (size_t i = 0; i < pixels; ++i) {
        const uint8_t *from = p->drawn + 4 * i;
        uint8_t *to = rgba + 4 * i;
        for (int k = 0; k < 3; ++k) to[k] = (uint8_t)(from[k] / 2 + 40); // as in the bench's pictures of what is missed
        to[3] = 255;
        if (p->missed[i]) to[0] = to[2] = 255, to[1] = 0;
    }
}

// White within black, so that it shows on any ground.
static void draw_ring(const miss_picture *p, uint8_t *rgba)
{
    const int reach = RING_PX + 3;
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const double off = fabs(sqrt((double)(dx * dx + dy * dy)) - RING_PX);
            if (off <= 2.5) put(p, rgba, (int64_t)p->x_px + dx, (int64_t)p->y_px + dy, off <= 1.25 ? WHITE : BLACK);
        }
}

typedef struct inset { uint32_t x, y, scale; const uint8_t *from; colour frame; } inset; // x, y: top left inside of the frame

static void draw_inset(const miss_picture *p, const inset *in, uint8_t *rgba)
{
    const int64_t side = (int64_t)CROP_PX * in->scale;
    for (int64_t y = -FRAME_PX; y < side + FRAME_PX; ++y)
        for (int64_t x = -FRAME_PX; x < side + FRAME_PX; ++x) {
            colour c = in->frame;
            if (x >= 0 && y >= 0 && x < side && y < side) {
                const int64_t from_x = (int64_t)p->x_px + x / in->scale - CROP_PX / 2, from_y = (int64_t)p->y_px + y / in->scale - CROP_PX / 2;
                const int is_inside = from_x >= 0 && from_y >= 0 && from_x < p->width_px && from_y < p->height_px;
                const uint8_t *at = is_inside ? in->from + ((size_t)from_y * p->width_px + (size_t)from_x) * 4 : NULL;
                c = at ? (colour){at[0], at[1], at[2]} : BLACK;
            }
            put(p, rgba, in->x + x, in->y + y, c);
        }
}

static void draw_insets(const miss_picture *p, uint8_t *rgba)
{
    const uint32_t wide = p->width_px / 4, high = p->height_px / 3, room = wide < high ? wide : high;
    uint32_t scale = room / CROP_PX;
    if (scale < 2) return; // too small a picture: nothing would be magnified
    if (scale > MAGNIFIED_MOST) scale = MAGNIFIED_MOST;
    const uint32_t side = CROP_PX * scale, gap = 3 * FRAME_PX;
    const uint32_t y = p->y_px * 2 < p->height_px ? p->height_px - side - gap : gap;
    const uint32_t x = p->x_px * 2 < p->width_px ? p->width_px - 2 * (side + gap) : gap;
    draw_inset(p, &(inset){x, y, scale, p->drawn, MAGENTA}, rgba);
    draw_inset(p, &(inset){x + side + gap, y, scale, p->whole, GREEN}, rgba);
}

void miss_picture_draw(const miss_picture *p, uint8_t *rgba)
{
    draw_base(p, rgba);
    draw_ring(p, rgba);
    draw_insets(p, rgba);
}
