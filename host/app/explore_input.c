// The viewer's keys and mouse. Scripts press the same keys (--keys), so that a test can do what a person does.
// SPDX-License-Identifier: MIT
#include "explore.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double TURN_DEG_S = 90, MOUSE_DEG_PX = 0.2, PITCH_MOST_DEG = 85, FASTER = 5;
static const double ASPECT_PART = 1e-3; // a path says 1.777778 for 16:9: that is kept
static const double ASPECT_MOST = 1024;    // of a camera, either way; a thinner window shows a distorted picture
static const double PI = 3.14159265358979323846;

typedef struct heading {
    double yaw, pitch;
} heading; // radians

static heading heading_of(const camera *c)
{
    const double *f = c->forward;
    return (heading){atan2(f[0], -f[2]), atan2(f[1], sqrt(f[0] * f[0] + f[2] * f[2]))};
}

static void look(camera *c, double yaw_deg, double pitch_deg)
{
    heading h = heading_of(c);
    const double most = PITCH_MOST_DEG * PI / 180;
    h.yaw += yaw_deg * PI / 180;
    h.pitch = fmin(fmax(h.pitch + pitch_deg * PI / 180, -most), most);
    c->forward[0] = sin(h.yaw) * cos(h.pitch);
    c->forward[1] = sin(h.pitch);
    c->forward[2] = -cos(h.yaw) * cos(h.pitch);
    c->up[0] = c->up[2] = 0;
    c->up[1] = 1;
}

static void go(camera *c, double ahead, double right, double up)
{
    const heading h = heading_of(c);
    c->eye[0] += c->forward[0] * ahead + cos(h.yaw) * right;
    c->eye[1] += c->forward[1] * ahead + up;
    c->eye[2] += c->forward[2] * ahead + sin(h.yaw) * right;
}

void explore_move(explore *e, char key, double dt_s)
{
    const double step = e->speed_m_s * dt_s, turn = TURN_DEG_S * dt_s;
    switch (key) {
    case 'w': go(&e->fly, step, 0, 0); break;
    case 's': go(&e->fly, -step, 0, 0); break;
    case 'a': go(&e->fly, 0, -step, 0); break;
    case 'd': go(&e->fly, 0, step, 0); break;
    case 'e': go(&e->fly, 0, 0, step); break;
    case 'q': go(&e->fly, 0, 0, -step); break;
    case 'j': look(&e->fly, -turn, 0); break;
    case 'l': look(&e->fly, turn, 0); break;
    case 'i': look(&e->fly, 0, turn); break;
    case 'k': look(&e->fly, 0, -turn); break;
    default: break;
    }
}

static void toggle_freeze(explore *e)
{
    e->freeze = e->freeze == FREEZE_NOT ? FREEZE_CULLING : FREEZE_NOT;
    e->frozen = e->fly;
    snprintf(e->message, sizeof e->message, e->freeze == FREEZE_NOT ? "culling goes on" : "culling frozen: fly out and look at it");
}

void explore_press(explore *e, char key)
{
    switch (key) {
    case 'c': explore_cycle_chain(e); break;
    case 'o': explore_use_door(e); break;
    case 'f': toggle_freeze(e); break;
    case 'p': e->wants_picture = 1; break;
    case 'v': e->mode = (render_mode)((e->mode + 1) % (RENDER_OVERDRAW + 1)); break;
    case 'x': e->scissor = e->scissor == SCISSOR_NONE ? SCISSOR_ZONES : SCISSOR_NONE; break;
    case 'b': e->shows_portals = !e->shows_portals; break;
    case 't': e->time_stands = !e->time_stands; break;
    case 'h': e->shows_help = !e->shows_help; break;
    case '+': e->speed_m_s = fmin(e->speed_m_s * 2, 10000); break;
    case '-': e->speed_m_s = fmax(e->speed_m_s / 2, 0.01); break;
    case KEY_ESCAPE: e->is_over = 1; break;
    default: break;
    }
}

// ---- The window ----

void explore_poll(explore *e, double dt_s)
{
    static const struct {
        char key, letter;
    } held[] = {{'w', 'w'}, {'s', 's'},      {'a', 'a'},       {'d', 'd'},    {'e', 'e'},
                {'q', 'q'}, {KEY_LEFT, 'j'}, {KEY_RIGHT, 'l'}, {KEY_UP, 'i'}, {KEY_DOWN, 'k'}};
    window_input in;
    renderer_window_input(e->g, &in);
    if (in.width_px > 0 && in.height_px > 0) {
        const double aspect = fmin(fmax((double)in.width_px / in.height_px, 1 / ASPECT_MOST), ASPECT_MOST);
        e->width_px = in.width_px;
        e->height_px = in.height_px;
        if (fabs(aspect - e->fly.aspect) > ASPECT_PART * aspect) e->fly.aspect = aspect;
    }
    for (size_t i = 0; i < sizeof held / sizeof *held; ++i)
        if (in.held[(int)held[i].key]) explore_move(e, held[i].letter, dt_s * (in.held[KEY_SHIFT] && i < 6 ? FASTER : 1));
    for (uint32_t i = 0; i < in.pressed_count; ++i) explore_press(e, in.pressed[i]);
    if (in.drag_px[0] != 0 || in.drag_px[1] != 0) look(&e->fly, in.drag_px[0] * MOUSE_DEG_PX, in.drag_px[1] * MOUSE_DEG_PX);
}
