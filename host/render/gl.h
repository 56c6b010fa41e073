// What the renderer's files share. Everything of GL hangs off `renderer`; no file keeps state of its own.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_RENDER_GL_H
#define PORTCULLIS_RENDER_GL_H

#include "render.h"

#include <epoxy/gl.h>

#include <epoxy/egl.h>

// ---- Programs (program.c) ----

typedef enum program_kind {
    PROGRAM_ID,
    PROGRAM_SEE_THROUGH,
    PROGRAM_SHADED, // from here five in the order of render_mode
    PROGRAM_ITEMS,
    PROGRAM_ZONES,
    PROGRAM_DEPTH,
    PROGRAM_OVERDRAW,
    PROGRAM_BOXES,
    PROGRAM_PICTURE,
    PROGRAM_OUTLINE,
    PROGRAM_HEAT,
    PROGRAM_OVERLAY,
    PROGRAM_KINDS
} program_kind;

enum { // what a program must know of the scene or the pass; compiled in, on first use
    VARIANT_CUT_OUT = 1u << 0,
    VARIANT_TRANSLUCENT = 1u << 1,
    VARIANT_SIDES = 1u << 2, // back faces of one-sided triangles dropped per fragment
    VARIANT_CLIP = 1u << 3,  // by up to four planes
    VARIANT_KEEP_DEPTH = 1u << 4,
    VARIANT_MOVERS = 1u << 5, // vertices of movers go where their pose has them
    VARIANT_LINEAR = 1u << 6, // a picture's colours between its texels
    VARIANT_FLAT = 1u << 7,   // some vertices have no normal: shaded as their face lies
    VARIANTS = 1u << 8
};

enum { // vertex words: material below, then
    WORD_TRANSLUCENT = 1u << 16,
    WORD_CUT_OUT = 1u << 17,
    WORD_SKY = 1u << 18,
    WORD_TWO_SIDED = 1u << 19, // of the triangle that this vertex is the last of
};

enum { // storage buffer bindings
    BIND_COUNTS = 0,
    BIND_MATERIALS = 1,
    BIND_ITEMS = 2,
    BIND_ZONES = 3,
    BIND_POSES = 4,
    BIND_OUTLINES = 5,
};

enum { // uniform locations of scene.vert and frame.frag
    AT_CLIP_FROM_EYE = 0,
    AT_EYE_HIGH = 1,
    AT_EYE_LOW = 2,
    AT_WANTED = 3,
    AT_CLIP_PLANES = 4,
    AT_ALPHA = 8,
    AT_DEPTH_RANGE = 9,
};

// 0 and a counted, reported error when the driver refuses it.
GLuint program_find(renderer *g, program_kind kind, uint32_t variant);
void programs_close(renderer *g);

// ---- State, set only where it changes, and counted (state.c) ----

typedef enum blend { BLEND_NONE, BLEND_MIX, BLEND_ADD } blend;
typedef enum colour_writes { COLOUR_ON, COLOUR_OFF } colour_writes;
typedef enum depth_writes { DEPTH_ON, DEPTH_OFF } depth_writes;
typedef enum back_faces { BACK_DRAWN, BACK_CULLED } back_faces;
typedef enum depth_offset { OFFSET_NONE, OFFSET_FARTHER, OFFSET_NEARER } depth_offset;
// BEHIND: one depth, behind all that has a depth of its own.
typedef enum depth_range { RANGE_OWN, RANGE_BEHIND } depth_range;

typedef struct gl_state {
    GLuint program, vertices, framebuffer;
    uint32_t width_px, height_px;
    GLenum depth_test; // GL_ALWAYS: no test at all
    depth_writes depth;
    colour_writes colour;
    blend blend;
    back_faces back;
    depth_offset offset;
    depth_range range;
    uint32_t known; // 0: nothing of it is set yet
} gl_state;

void state_forget(renderer *g); // the next calls set all
void state_program(renderer *g, GLuint program);
void state_vertices(renderer *g, GLuint vertex_array);
void state_framebuffer(renderer *g, GLuint framebuffer, uint32_t width_px, uint32_t height_px);
typedef struct pass_state {
    GLenum depth_test;
    depth_writes depth;
    colour_writes colour;
    blend blend;
    back_faces back;
    depth_offset offset;
} pass_state;
void state_pass(renderer *g, const pass_state *p);
void state_pass_at(renderer *g, const pass_state *p, depth_range range);
#define PICTURE_DEPTH 0x1p-120 // of a picture that keeps none; see state.c

// ---- Targets (target.c) ----

typedef enum target_kind { TARGET_ID, TARGET_COLOUR, TARGET_LAYERS } target_kind;
typedef struct target {
    GLuint framebuffer, colour, depth;
    uint32_t width_px, height_px;
    target_kind kind;
    uint64_t used; // 0: empty place
} target;
enum { TARGETS = 4 };

// The target of that kind and size; stays valid while at most TARGETS are in use. NULL: reported.
target *target_find(renderer *g, target_kind kind, uint32_t width_px, uint32_t height_px, report *r);
void targets_close(renderer *g);

// ---- Index ranges for one multi-draw (ranges.c) ----

typedef struct ranges {
    GLsizei *counts;
    const void **offsets; // bytes
    uint32_t count, capacity;
    uint32_t end; // index behind the last range
} ranges;

result ranges_open(ranges *a, uint32_t capacity, const allocator *memory);
result ranges_reserve(ranges *a, uint32_t capacity, const allocator *memory); // empty; nothing changed on failure
void ranges_close(ranges *a, const allocator *memory);
// Joined to the last when it follows it. 0: full, nothing changed.
int ranges_add(ranges *a, uint32_t first_index, uint32_t index_count);
void ranges_draw(renderer *g, ranges *a); // one draw call, then empty

// ---- Where movers are (poses.c) ----

typedef struct pose_block pose_block; // as the shaders have it
typedef struct mover_box { double low[3], high[3]; } mover_box; // relative to the scene's origin
typedef struct posed_movers {
    scene_pose *poses;
    mover_box *boxes;
    pose_block *blocks;
    GLuint buffer;
    double eye[3];     // that the blocks are made for
    uint32_t count, is_made; // is_made 0: a pose changed
} posed_movers;

result poses_open(posed_movers *m, const scene *s, const allocator *memory); // at rest
void poses_close(posed_movers *m, const allocator *memory);
void poses_use(renderer *g, const double eye[3]); // relative to the scene's origin: for the draws that follow
void item_box(const renderer *g, uint32_t item, mover_box *out); // of any item, where it is

// ---- The scene on the GPU (upload.c) ----

typedef struct vertex_buffers { GLuint positions, words, triangles, texcoords, normals, paints, others, movers; } vertex_buffers; // 0: not needed

typedef struct scene_levels scene_levels; // levels.c

typedef struct scene_gpu {
    const scene *scene; // NULL: none
    GLuint vertices;    // vertex array, with the index buffer in the scene's order
    vertex_buffers buffers;
    GLuint elements;
    GLuint materials, triangle_items, item_zones, seen;
    uint32_t *indices;         // each triangle turned so that its last vertex is its own
    uint32_t *see_through;     // items with translucent triangles, ascending
    uint8_t *is_see_through;   // per item
    uint32_t see_through_count;
    uint32_t index_count, triangle_count, item_total; // movers too
    uint32_t vertex_count; // of buffers
    uint32_t variant;          // VARIANT_CUT_OUT, VARIANT_TRANSLUCENT, VARIANT_MOVERS, VARIANT_FLAT as the scene needs
    uint32_t has_two_sided;    // an opaque triangle of a two-sided item
    uint32_t *box_items;       // item_total: scratch of the floor
    uint32_t *box_counts;      // item_total: scratch of the floor
    GLuint counts;             // of the floor, item_total words
    ranges ranges;
    posed_movers poses;
    scene_levels *levels; // NULL: nobody asked
} scene_gpu;

void scene_release(renderer *g);
// A vertex array over vertices and the given index buffer.
GLuint vertex_array_of(const vertex_buffers *buffers, GLuint elements);
GLuint scene_vertex_array(const renderer *g, GLuint elements);

// ---- Where it is seen from (viewpoint.c) ----

typedef struct viewpoint {
    double clip_from_eye[16], eye[3]; // column major; relative to the scene's origin
    double near_m, pixels_per_tangent;
    float clip[16], eye_high[3], eye_low[3];
} viewpoint;

typedef struct viewpoint_request {
    const camera *camera;
    uint32_t width_px, height_px;
    double jitter_px[2];
} viewpoint_request;

result viewpoint_make(const renderer *g, const viewpoint_request *q, report *r, viewpoint *out);
void viewpoint_set(const viewpoint *v, GLuint program, uint32_t wanted);
void viewpoint_finish(viewpoint *v); // floats from the doubles

// ---- Boxes against the depth (boxes.c) ----

typedef enum box_fate { BOX_OUTSIDE, BOX_NEAR, BOX_TESTED } box_fate;
typedef struct eye_box { float low[3], high[3]; } eye_box; // relative to the eye, widened

box_fate box_place(const viewpoint *v, const mover_box *box, eye_box *out);

enum { BOX_CHUNK = 2048 };
typedef struct box_pass {
    GLuint vertices, corners, elements;
    float *staged; // BOX_CHUNK boxes of 8 corners
    uint32_t *staged_elements; // of the faces that the eye sees, at most three a box
    uint32_t staged_count, element_count, first_slot;
    const viewpoint *view;
    GLuint counts;
} box_pass;

result boxes_open(renderer *g, report *r);
void boxes_close(renderer *g);
// Between begin and end nothing else is drawn: box number n since begin counts its fragments in word n of `counts`,
// against the depth of the framebuffer that is bound when boxes are added and at the end.
void boxes_begin(renderer *g, const viewpoint *v, GLuint counts);
void boxes_add(renderer *g, const eye_box *box);
void boxes_end(renderer *g);

// ---- Box tests in flight (box_tests.c) ----

enum { TEST_GROUPS = 16 };
#define TEST_NONE UINT32_MAX

typedef struct test_group { // drawn and read back at once, of any zones
    GLuint counts;          // all 0 while nothing is in flight
    GLsync fence;
    uint32_t *entries;      // that each word of counts belongs to
    uint32_t *pixels;       // read back
    uint32_t capacity, count;
} test_group;

typedef struct test_entry {
    uint32_t tag, frame, asked; // asked: the zone's collects before it
    uint32_t pixels;            // or TEST_NONE: in flight
    uint32_t next;              // of the zone, or of the free; TEST_NONE: the last
} test_entry;

typedef struct test_queue {
    test_group groups[TEST_GROUPS]; // a ring in the order of drawing; the one behind the last is being staged
    uint32_t first, count, is_staging;
    test_entry *entries;
    uint32_t capacity, free;
    uint32_t latency;   // in calls of renderer_collect for the zone
    uint32_t by_driver; // 1: ready when the fences say so, whatever the latency
    uint32_t is_lost;   // the driver left a fence unanswered: nothing is waited for any more
} test_queue;

result tests_reserve(renderer *g, uint32_t tests_a_step);
void tests_submit(renderer *g); // what is staged is drawn
void tests_forget_zone(renderer *g, render_layout *l, uint32_t zone);
void tests_close(renderer *g);

// ---- Layouts (layout.c) ----

typedef struct layout_zone {
    uint32_t first_place, count;
    uint32_t first_slot, slot_count;           // in render_layout.slots
    uint32_t oldest_test, newest_test, collects; // in test_queue.entries, or TEST_NONE
} layout_zone;

typedef struct picture_slot picture_slot;
typedef struct layout_pieces layout_pieces; // pieces.h
typedef struct layout_level layout_level; // levels.h
struct render_layout {
    renderer *g;
    render_layout *next; // of the renderer's
    GLuint vertices, elements; // elements 0: the scene's own
    layout_zone *zones;
    uint32_t *items;       // at each place; NULL: as the scene stands
    uint32_t *first_index; // of each place, movers behind; one more at the end
    uint32_t *see_through; // places before this one that are; NULL: none is
    picture_slot *slots;
    render_picture_counts pictures;
    layout_pieces *pieces; // NULL: see-through items go by distance
    layout_level *levels;  // level_count, finest first
    uint32_t zone_count, place_count, total, slot_count; // total: places and movers
    uint32_t level_count;
};

#define LAYOUT_MOVERS UINT32_MAX // in the place of a zone: what stands behind all zones

uint32_t layout_item(const render_layout *l, uint32_t place); // global id, movers too
uint32_t layout_first_place(const render_layout *l, uint32_t zone); // of a zone, or of the movers
void layout_zone_offset(const renderer *g, uint32_t zone, double out[3]); // of the zone's origin from the scene's

// ---- Frames (frame.c, draw.c, translucent.c) ----

typedef struct pixel_box { GLint x, y, width, height; } pixel_box;
typedef struct zone_cut { pixel_box box; uint32_t frame; } zone_cut; // counts in that frame only

typedef struct layout_runs {
    const render_layout *layout;
    uint32_t zone; // or LAYOUT_MOVERS
    const cull_run *runs;
    uint32_t count;
} layout_runs;

typedef struct translucent_item {
    double distance2;
    const render_layout *layout;
    pixel_box cut;
    uint32_t place, item; // item: global id, the same whatever the layout
    uint32_t zone, rank;  // or LAYOUT_MOVERS; rank: what has a lower one is drawn before, whatever the distance
} translucent_item;

typedef struct shown_picture { // with what it was asked to be shown as
    picture_slot *slot;
    double place[3][3];
    pixel_box cut;
} shown_picture;

typedef struct frame_state {
    viewpoint view;
    target *target;    // colours, in the end
    target *layers;    // RENDER_OVERDRAW
    frame_request request;
    const render_layout *pending; // whose ranges wait in scene.ranges; NULL: none do
    pixel_box pending_cut;
    zone_cut *cuts; // by zone
    translucent_item *translucent;
    shown_picture *shown; // that wait for the frame's end
    uint32_t cut_capacity, translucent_count, translucent_capacity, shown_count, shown_capacity;
    uint32_t number; // of this frame
    uint32_t draw_calls, state_changes;
    uint32_t open; // between begin and end
    uint32_t may_repeat; // a translucent item may have been noted twice
} frame_state;

// A pass over runs of a zone, for frames and captures.
typedef struct draw_pass {
    const viewpoint *view;
    const GLfloat (*planes)[4]; // four, relative to the eye; NULL: none
    const layout_level *level;  // NULL: the scene itself
} draw_pass;

// Planes of a zone as the shaders take them. Between begin and end as many cut as there are.
typedef struct clip_pass { GLfloat planes[4][4]; uint32_t count; } clip_pass;
typedef struct clip_request {
    const cull_plane *planes;
    uint32_t count, zone;
    const viewpoint *view;
} clip_request;
void clip_make(const renderer *g, const clip_request *q, clip_pass *out);
void clip_begin(const clip_pass *c);
void clip_end(const clip_pass *c);

result frame_reserve(renderer *g, uint32_t zones, uint32_t places, uint32_t translucent); // nothing changes on failure but what grew
void frame_release(renderer *g);
void frame_bind(renderer *g); // the frame's framebuffer
GLuint frame_pass(renderer *g, const draw_pass *p, uint32_t wanted); // its program and uniforms set; 0: there is none
void frame_state_pass(renderer *g, blend blend, depth_writes depth);
void frame_flush(renderer *g); // draws and tests that wait are carried out
void frame_draw_runs(renderer *g, const draw_pass *p, const layout_runs *r); // at once
pixel_box frame_cut(const renderer *g, uint32_t zone);    // where the zone may draw; the whole picture when nothing cuts it
void cut_begin(renderer *g, const pixel_box *cut);        // until the end the picture ends there
void cut_end(renderer *g, const pixel_box *cut);
void translucent_note(renderer *g, const layout_runs *r);
void translucent_draw(renderer *g);
void translucent_sort(translucent_item *items, uint32_t count); // by rank, then farthest first, then by global id

// ---- Pictures (picture_slots.c, picture_outline.c, capture.c, picture_show.c) ----

struct picture_slot {
    GLuint framebuffer, colour, depth;
    uint32_t width_px, height_px, keep_depth, filled;
    render_mode mode; // of the frame that it was taken in: its colours mean nothing in another
    faces faces;
    uint32_t used;  // number of the frame that last took or showed it
    uint64_t bytes; // of its textures
    double corner[3], right[3], up[3], eye[3]; // that it was taken through and from, relative to the scene's origin
    double shown[3][3];                        // corner, right and up that it is shown as
    uint32_t waits_in;                         // number of the frame whose end it last waited for, to be shown
    double near_fraction; // distance of depth 1, in units of the parallelogram's
    uint32_t outline;              // its place among the outlines, from 1; 0: it has none
    uint32_t strips, strip_texels; // that its outline tells of, and columns of each; 0: not traced, shown whole
    picture_slot *next_untraced;
};

enum { SLOTS_MOST = 65536, OUTLINES_MOST = 4096, OUTLINE_STRIPS = 32 };
typedef struct picture_shared {
    GLuint vertices; // of a draw without attributes
    GLuint spare_depth; // for captures that keep none
    uint32_t spare_width_px, spare_height_px;
    GLuint outlines;                         // buffer: of all slots, OUTLINE_STRIPS each
    uint32_t outline_count, outline_next;    // taken; where the search for a free one begins
    uint8_t outline_is_taken[OUTLINES_MOST]; // beyond so many, pictures are shown whole
    picture_slot *untraced;
    picture_options options;
} picture_shared;

picture_slot *slot_find(const render_layout *l, uint32_t zone, uint32_t slot); // NULL: there is none
int slot_holds(const renderer *g, const picture_slot *s); // a picture that this frame may show
int slot_textures(renderer *g, picture_slot *s, const cull_capture *c); // of an empty one. 0: the driver has none
void capture_begin(renderer *g, const picture_slot *s); // bound and cleared
// Textures and framebuffer of that size, within the memory that the layout's pictures may take. 0: none.
int slot_prepare(renderer *g, render_layout *l, picture_slot *s, const cull_capture *c);
void slot_empty(renderer *g, picture_slot *s); // and its memory given back
void picture_as_taken(picture_slot *s); // is how it is shown from now on
void picture_set3(double out[3], cull_vec3 v, const double offset[3]);
void picture_draw(renderer *g, const picture_slot *s, const viewpoint *v); // into what is bound
result shown_reserve(renderer *g, uint32_t slots); // room for so many pictures in a frame; nothing changes on failure
void shown_release(renderer *g);
void shown_draw(renderer *g); // those that wait

// Outlines (picture_outline.c)
void outline_want(renderer *g, picture_slot *s);  // of what was just taken
void outline_drop(renderer *g, picture_slot *s);
void outlines_trace(renderer *g);                 // of all that are wanted, with the frame's framebuffer bound
// For the draw that follows: how many strips; 0: it is drawn whole.
uint32_t outline_set(const picture_slot *s, GLuint program);
void outlines_close(renderer *g);

void pictures_forget_zone(renderer *g, render_layout *l, uint32_t zone);
void pictures_close_layout(renderer *g, render_layout *l);
void pictures_close(renderer *g);

// ---- Overlay (overlay.c, font.c) ----

typedef struct overlay_point { float position[3]; uint32_t colour; } overlay_point; // relative to the eye, or of the picture
enum { OVERLAY_CHUNK = 6 * 1024, FONT_WIDE = 8, FONT_HIGH = 16 }; // points at a time: whole lines, triangles and rectangles
typedef struct overlay_pass {
    GLuint vertices, points;
    overlay_point *staged; // OVERLAY_CHUNK
    uint32_t count;
} overlay_pass;

result overlay_open(renderer *g, report *r);
void overlay_close(renderer *g);
uint32_t font_row(char letter, uint32_t row); // bit 0: leftmost of FONT_WIDE; letters that it lacks are a box

// ---- The window's keys and mouse (window.c) ----

void window_listen(renderer *g);

// ---- The whole ----

struct renderer {
    const allocator *memory;
    report sink; // a copy of what renderer_open got: for calls that take none
    EGLDisplay display;
    EGLContext context;
    struct GLFWwindow *window;
    window_input input; // since the last renderer_window_input
    double mouse_px[2];
    uint32_t mouse_is_held;
    char name[192];
    uint32_t errors;
    uint32_t has_debug; // errors come through the callback; glGetError only clears them
    uint32_t size_most_px;
    uint64_t clock; // of target use
    GLuint programs[PROGRAM_KINDS][VARIANTS];
    gl_state state;
    target targets[TARGETS];
    scene_gpu scene;
    box_pass boxes;
    test_queue tests;
    frame_state frame;
    render_layout *layouts;
    picture_shared pictures;
    cull_costs costs;      // of the scene `costs_of`; NULL: not measured
    const scene *costs_of;
    overlay_pass overlay;
    target *id_target; // of the last id picture, while its depth is there
};

// Clears GL's error flags; each is counted and reported with what was being done. RESULT_NO_GL when there was one.
result gl_check(renderer *g, report *r, const char *doing);

#endif
