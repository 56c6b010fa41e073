// The renderer: OpenGL 4.5 core, headless by EGL or in a GLFW window. Camera-relative, reversed z, one vertex buffer.
// SPDX-License-Identifier: MIT
// Invariant: a picture of triangles depends on camera, size and the set of triangles, never on the order of a culler.
#ifndef PORTCULLIS_HOST_RENDER_H
#define PORTCULLIS_HOST_RENDER_H

#include "../core/scene.h"
#include "../core/view.h"

typedef struct renderer renderer;

typedef enum renderer_target { RENDERER_HEADLESS, RENDERER_WINDOW } renderer_target;

typedef struct renderer_options {
    renderer_target target;
    uint32_t width_px, height_px; // of the window; headless pictures say theirs with each call
    const char *title;
} renderer_options;

// [main, and all below] One context, current on the calling thread. RESULT_NO_GL with a line when there is none.
result renderer_open(const renderer_options *o, const allocator *memory, report *r, renderer **out);
void renderer_close(renderer *g); // NULL is fine
const char *renderer_name(const renderer *g);  // GL_RENDERER and version, one line
uint32_t renderer_errors(const renderer *g);   // GL errors seen so far (debug callback, checks); each was reported
result renderer_upload(renderer *g, const scene *s, report *r); // one scene at a time, borrowed until the next or close

// Where the scene's movers are in the pictures that follow, until the next call or upload (at rest after an upload). Not
// within a frame: what is translucent is drawn at its end.
void renderer_poses(renderer *g, const scene_pose *poses); // scene.mover_count

// ---- Truth: ascending global id, one program, one vertex buffer ----
// Depths err away from the eye by 1/128 pixel of slope, never behind a triangle's farthest corner: rounding to the raster's
// grid lets no surface seen edge on poke through what hides it. Box tests err towards the eye, so they find every owner.

typedef struct id_picture {
    uint32_t width_px, height_px;
    uint32_t *triangles;        // width * height, bottom row first: global triangle + 1, 0: nothing
    uint32_t *see_through;      // per global triangle a bit: a fragment of this translucent triangle passes the opaque depth
    uint32_t see_through_words; // length of see_through
} id_picture;

result id_picture_open(const scene *s, uint32_t width_px, uint32_t height_px, const allocator *memory, id_picture *out);
void id_picture_free(id_picture *p, const allocator *memory);

typedef enum faces { FACES_ALL, FACES_FRONT } faces; // FRONT drops back faces of items that are not two-sided

typedef struct id_request {
    const camera *camera;
    const uint32_t *item_bits; // global ids (movers too) to draw, NULL: all
    double jitter_px[2];       // sub-pixel shift of the picture, right and up
    faces faces;
} id_request;

// Draws and reads back. size: that of `out`. RESULT_NO_GL when the driver fails (a line was reported).
result renderer_id_picture(renderer *g, const id_request *q, report *r, id_picture *out);
// Right after renderer_id_picture, against its depth: bit i of item_bits is set where the widened box of item i (movers
// too) passes anywhere, or reaches the near plane. item_bits holds (item_count + mover_count + 31) / 32 words.
result renderer_floor(renderer *g, const camera *c, report *r, uint32_t *item_bits);

// ---- A frame drawn from visible sets ----

// How the zones of a world lie in one index buffer: each zone's items in the order of its chain, an item as often as
// zones list it.
typedef struct render_layout render_layout;
typedef struct render_layout_zone { const uint32_t *items; uint32_t count; } render_layout_zone; // global id at each place
result render_layout_open(renderer *g, const render_layout_zone *zones, uint32_t zone_count, report *r, render_layout **out);
// After a swap of the zone's chain, not within a frame: the same items in another order. Writes that zone's part only.
// Pictures and tests of the zone are forgotten. RESULT_NO_MEMORY: nothing changed.
result render_layout_reorder(render_layout *l, uint32_t zone, const uint32_t *items, report *r);
// By zone: what its chain's select lends (host/core/pieces.h), NULL: nothing; not within a frame. Borrowed until the next call,
// until a reorder of the zone, which forgets its pieces, or until the layout closes. See-through items of such zones are drawn in
// exact order: whole where planes tell who is behind whom, else piece by piece; zones in the order of the portals between them;
// items without pieces, and movers, by the distance of their middles. Takes all memory that frames need.
// RESULT_NO_MEMORY, RESULT_NO_GL: a line, and everything goes by distance.
result render_layout_pieces(render_layout *l, const cull_pieces *const *pieces, report *r);
void render_layout_close(render_layout *l); // NULL is fine; before the renderer

// RENDER_IDS is for checks, not for people: owners as an id picture has them, drawn through the layout. Nothing that is
// translucent is in it, and no picture of a culler: what one would show is drawn.
typedef enum render_mode { RENDER_SHADED, RENDER_ITEMS, RENDER_ZONES, RENDER_DEPTH, RENDER_OVERDRAW, RENDER_IDS } render_mode;

typedef enum render_scissor { SCISSOR_NONE, SCISSOR_ZONES } render_scissor; // ZONES: what a zone draws is cut to its rectangle

typedef struct frame_request {
    const camera *camera;
    uint32_t width_px, height_px;
    render_mode mode;
    faces faces;
    render_scissor scissor;
} frame_request;

result renderer_begin(renderer *g, const frame_request *q, report *r); // target, clear
// Runs of places in the zone's order. Opaque now or by the next call that needs it, translucent at renderer_end.
void renderer_draw(renderer *g, const render_layout *l, uint32_t zone, const cull_run *runs, uint32_t run_count);
// Those at or over scene.mover_count have no geometry.
void renderer_draw_movers(renderer *g, const render_layout *l, const uint32_t *movers, uint32_t count);
// Least x, least y, greatest x, greatest y in -1 .. 1, for what the zone draws from now on in this frame; with
// SCISSOR_ZONES only. Cut a pixel wider. Where several zones list an item and one draws it for all, its rectangle must
// hold theirs.
void renderer_zone_rectangle(renderer *g, uint32_t zone, const float rectangle[4]);
void renderer_end(renderer *g);    // translucent items of all runs drawn, then glFinish
uint32_t renderer_draw_calls(const renderer *g);   // since renderer_begin
uint32_t renderer_state_changes(const renderer *g);
void renderer_forget_state(renderer *g); // the next frame sets all of it, whatever was drawn before: then its state changes are its own
result renderer_read(renderer *g, uint8_t *rgba, report *r); // width * height * 4, top row first, after renderer_end
// The same frame's depths: 0 where nothing opaque and no picture of a culler was drawn. width * height, bottom row first.
result renderer_read_depths(renderer *g, float *depths, report *r);
// Right after renderer_id_picture, or renderer_end of RENDER_IDS: each pixel's owner (global triangle + 1, 0: nothing) and
// its depth, bottom row first. The same triangle has the same depth in both, to the bit. Of two at one depth an id picture
// has the lower, a frame the one drawn first. triangles or depths may be NULL; width * height of the picture each.
result renderer_read_ids(renderer *g, uint32_t *triangles, float *depths, report *r);

// ---- What cullers ask for ----

// Inside a frame. Issues box tests against the depth of what was drawn so far, which no picture is part of: these are right to their
// tolerance only. The boxes are the plugin's, relative to the zone's origin, widened here. At the near plane: seen.
void renderer_test(renderer *g, const render_layout *l, uint32_t zone, const cull_test *tests, uint32_t count, uint32_t frame);
typedef enum collect { COLLECT_READY, COLLECT_ALL } collect; // ALL waits
typedef struct collect_request { const render_layout *layout; uint32_t zone, frame; collect how; } collect_request;
// Takes answered tests of that zone out, oldest first, at most `capacity`. *stalled is set to 1 when it had to wait. age is now - asked.
uint32_t renderer_collect(renderer *g, const collect_request *q, cull_answer *answers, uint32_t capacity, uint32_t *stalled);
void renderer_forget_tests(renderer *g);
// From then on answers are ready by count, whatever the driver's clock does: a test is readable in the first call of
// renderer_collect, plus `steps` (bench --query-latency). Never called: when the driver says so, for a viewer.
void renderer_query_latency(renderer *g, uint32_t steps);
// Takes all memory that frames need when all zones together have at most so many tests asked between two calls of
// renderer_collect for each of them: such frames allocate nothing afterwards, but what the driver does. After
// renderer_query_latency, which says how many tests wait at once. RESULT_NO_MEMORY with a line; what was taken stays.
result renderer_reserve(renderer *g, uint32_t tests_a_step, report *r);
// Clipped to what lies inside their planes, opaque now; what is translucent is drawn whole at renderer_end, once.
void renderer_draw_clipped(renderer *g, const render_layout *l, uint32_t zone, const cull_clipped *clipped);

// How pictures are kept and shown. Not within a frame; forgets the pictures there are. Never called: linear, 8 bits, 256 MiB.
// Coverage is a bit a texel. NEAREST takes texels as they are; LINEAR goes between them, where the outline runs halfway from a covered
// texel to one that is not: a dB more inside of what is shown, for a quarter more a pixel (tests/render/measure_pictures.c).
// 8_BITS: 4 bytes a texel. 5_BITS: 2, with steps of 8/255: alone a PSNR of 41 dB. Depth, where kept: 4 more.
typedef enum picture_filter { PICTURE_LINEAR, PICTURE_NEAREST } picture_filter;
typedef enum picture_format { PICTURE_8_BITS, PICTURE_5_BITS } picture_format;
typedef struct picture_options {
    picture_filter filter;
    picture_format format;
    uint64_t bytes_most; // of a layout's pictures. For more those not used for longest go, but none of this frame
} picture_options;
void renderer_picture_options(renderer *g, const picture_options *o);
typedef struct render_picture_counts { // of a layout, since render_layout_slots
    uint64_t bytes, bytes_peak;          // of its pictures; never over picture_options.bytes_most
    uint64_t captures, pixels_captured;  // taken
    uint64_t shown;                      // pictures
    double pixels_shown;                 // area of the pictures shown, in the frame
    uint64_t emptied, refused;           // slots for want of memory; captures that found none
} render_picture_counts;
render_picture_counts render_layout_picture_counts(const render_layout *l);
// To 0 which slots of the zone hold no picture that can be shown now: never taken, emptied, or taken in another render_mode.
void renderer_check_slots(renderer *g, const render_layout *l, uint32_t zone, uint8_t *slots, uint32_t count);

// Room for the pictures of a layout: slot_counts by zone, at most 65,536 together; none until then. A zone captures into
// slots below its count; a capture that finds no slot is not taken, and showing it draws the items. Forgets what was there.
result render_layout_slots(render_layout *l, const uint32_t *slot_counts, report *r);
// Coarser triangles for captures (cull_capture.detail_m), until the layout closes or a zone of it is reordered; not within a frame. Made once a scene, which
// takes some seconds a million triangles where it pays, and kept where they are far fewer: out->levels says which, as cullers are to be told. Never
// called: captures draw every triangle. RESULT_NO_MEMORY: they do, too.
result render_layout_levels(render_layout *l, report *r, cull_costs *out);
void renderer_capture(renderer *g, render_layout *l, uint32_t zone, const cull_capture *capture);
// Drawn at renderer_end, in the order of the calls; a slot that is captured again before that is drawn then, and box tests see it.
// What a picture shows goes on for half a pixel beyond its outline where nothing else stands in the end: an outline that errs by less leaves
// no gap.
void renderer_show(renderer *g, render_layout *l, uint32_t zone, const cull_picture *picture);
void renderer_forget_pictures(renderer *g);

// ---- Over the picture, for people: after renderer_end, before renderer_read or renderer_present ----

typedef struct overlay_vertex { double position[3]; uint32_t colour; } overlay_vertex; // world; 0xAABBGGRR
// Pairs of vertices are lines, threes triangles. Drawn with the frame's camera; TESTED hides what the picture's depth hides.
typedef enum overlay_depth { OVERLAY_TESTED, OVERLAY_ON_TOP } overlay_depth;
void renderer_overlay_lines(renderer *g, const overlay_vertex *vertices, uint32_t count, overlay_depth depth);
void renderer_overlay_triangles(renderer *g, const overlay_vertex *vertices, uint32_t count, overlay_depth depth);
// ASCII text in a built-in fixed font, 8 x 16 pixels a letter times `scale`, top left at (x_px, y_px) from the top left; \n breaks.
typedef struct overlay_text { const char *text; uint32_t x_px, y_px, scale, colour; } overlay_text;
void renderer_overlay_text(renderer *g, const overlay_text *t);

// ---- Pictures to files ----

result png_write(const char *path, const uint8_t *rgba, uint32_t width_px, uint32_t height_px, report *r);

// The window, for the viewer.
int renderer_window_is_open(renderer *g); // polls events
// Keys are lower-case letters, '+', '-', and KEY_* below.
enum { KEY_LEFT = 1, KEY_RIGHT, KEY_UP, KEY_DOWN, KEY_ESCAPE, KEY_SHIFT, WINDOW_KEYS = 128, WINDOW_PRESSES_MOST = 16 };
typedef struct window_input {
    uint32_t width_px, height_px;     // of the window's picture; 0 while it is hidden
    double drag_px[2];                // the mouse since the last call, to the right and up, while its left button is held
    uint8_t held[WINDOW_KEYS];        // by key
    char pressed[WINDOW_PRESSES_MOST]; // since the last call, in order
    uint32_t pressed_count;
} window_input;
void renderer_window_input(renderer *g, window_input *out); // zero when headless
void renderer_present(renderer *g);       // the frame's colours to the window

#endif
