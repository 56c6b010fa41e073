// What drawing takes: small pictures of a mesh and of parallelograms, timed; see costs.h.
// SPDX-License-Identifier: MIT
// Invariant: nothing of the scene, its layouts and their pictures changes; the same programs draw here as in its frames.
#define _POSIX_C_SOURCE 200809L
#include "costs.h"

#include "gl.h"

#include <time.h>

enum {
    SIDE_PX = 512, // of the pictures that are timed
    GRID = 100,    // cells a side of the fine mesh
    FINE_INDICES = GRID * GRID * 6,
    VERTICES = (GRID + 1) * (GRID + 1),
    SMALLS = 8,     // small slots, in turns: in a frame each picture has textures of its own
    PICTURES = 256, // small ones timed together
    CAPTURES = 64,
    TIMES = 5, // the least of so many, after one that compiles: other work only adds to CPU time
};
static const double DISTANCE_M = 10;

typedef struct bench_bed {
    renderer *g;
    target *t;
    viewpoint view;
    vertex_buffers buffers;
    GLuint elements, vertices;
    picture_slot whole, deep, smalls[SMALLS]; // slots of no layout
} bench_bed;

static double cpu_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

// ---- The mesh: a square at a distance that fills the picture, fine or of two triangles ----

// By vertex: its place on the square, its word, the triangle it belongs to.
typedef struct bench_mesh {
    float positions[VERTICES][3], others[VERTICES][6], texcoords[VERTICES][2];
    uint32_t words[VERTICES], triangles[VERTICES], normals[VERTICES], movers[VERTICES];
    uint32_t indices[FINE_INDICES + 6];
} bench_mesh;

static void make_vertices(bench_mesh *m)
{
    for (int i = 0; i < VERTICES; ++i) {
        const float x = (float)(i % (GRID + 1)) / GRID * 2 - 1, y = (float)(i / (GRID + 1)) / GRID * 2 - 1;
        m->positions[i][0] = x * (float)DISTANCE_M;
        m->positions[i][1] = y * (float)DISTANCE_M;
        m->positions[i][2] = (float)-DISTANCE_M;
        for (int k = 0; k < 6; ++k) m->others[i][k] = m->positions[i][k % 3];
        m->normals[i] = 127u << 16; // +z
    }
}

static void make_indices(bench_mesh *m)
{
    uint32_t *at = m->indices;
    for (uint32_t y = 0; y < GRID; ++y)
        for (uint32_t x = 0; x < GRID; ++x) {
            const uint32_t a = y * (GRID + 1) + x, b = a + 1, c = a + GRID + 1, d = c + 1;
            const uint32_t quad[6] = {a, b, c, c, b, d};
            for (int k = 0; k < 6; ++k) *at++ = quad[k];
        }
    const uint32_t a = 0, b = GRID, c = GRID * (GRID + 1), d = VERTICES - 1;
    const uint32_t whole[6] = {a, b, c, c, b, d};
    for (int k = 0; k < 6; ++k) *at++ = whole[k];
}

static GLuint buffer_of(const void *bytes, size_t size)
{
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, (GLsizeiptr)size, bytes, 0);
    return name;
}

static result make_mesh(bench_bed *b)
{
    const vertex_buffers *scene = &b->g->scene.buffers;
    bench_mesh *m = memory_alloc_zeroed(b->g->memory, 1, sizeof *m);
    if (!m) return RESULT_NO_MEMORY;
    make_vertices(m);
    make_indices(m);
    b->buffers.positions = buffer_of(m->positions, sizeof m->positions);
    b->buffers.words = buffer_of(m->words, sizeof m->words);
    b->buffers.triangles = buffer_of(m->triangles, sizeof m->triangles);
    b->buffers.others = buffer_of(m->others, sizeof m->others);
    if (scene->texcoords) b->buffers.texcoords = buffer_of(m->texcoords, sizeof m->texcoords);
    if (scene->normals) b->buffers.normals = buffer_of(m->normals, sizeof m->normals);
    if (scene->movers) b->buffers.movers = buffer_of(m->movers, sizeof m->movers);
    b->elements = buffer_of(m->indices, sizeof m->indices);
    b->vertices = vertex_array_of(&b->buffers, b->elements);
    memory_free(b->g->memory, m, 1, sizeof *m);
    return RESULT_OK;
}

// ---- What is timed ----

static void begin(bench_bed *b)
{
    const GLfloat far = 0, none[4] = {0};
    state_framebuffer(b->g, b->t->framebuffer, SIDE_PX, SIDE_PX);
    frame_state_pass(b->g, BLEND_NONE, DEPTH_ON);
    glClearBufferfv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
}

static void draw_mesh(bench_bed *b, uint32_t first, uint32_t count)
{
    if (!frame_pass(b->g, &(draw_pass){.view = &b->view}, 0)) return;
    state_vertices(b->g, b->vertices);
    frame_state_pass(b->g, BLEND_NONE, DEPTH_ON);
    glDrawElements(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT, (const void *)((uintptr_t)first * sizeof(uint32_t)));
}

static void run_nothing(bench_bed *b) { begin(b); }

static void run_fine(bench_bed *b)
{
    begin(b);
    draw_mesh(b, 0, FINE_INDICES);
}

static void run_coarse(bench_bed *b)
{
    begin(b);
    draw_mesh(b, FINE_INDICES, 6);
}

static void run_picture(bench_bed *b)
{
    begin(b);
    picture_draw(b->g, &b->whole, &b->view);
}

static void run_deep_picture(bench_bed *b)
{
    begin(b);
    picture_draw(b->g, &b->deep, &b->view);
}

static void run_small_pictures(bench_bed *b)
{
    begin(b);
    for (int i = 0; i < PICTURES; ++i) picture_draw(b->g, &b->smalls[i % SMALLS], &b->view);
}

static void capture(bench_bed *b, picture_slot *s)
{
    capture_begin(b->g, s);
    draw_mesh(b, FINE_INDICES, 6);
    outline_want(b->g, s);
}

static void run_small_captures(bench_bed *b)
{
    for (int i = 0; i < CAPTURES; ++i) {
        capture(b, &b->smalls[i % SMALLS]);
        if (i % SMALLS == SMALLS - 1) outlines_trace(b->g);
    }
}

static void run_capture(bench_bed *b)
{
    capture(b, &b->whole);
    outlines_trace(b->g);
}

static void run_deep_capture(bench_bed *b)
{
    capture(b, &b->deep);
    outlines_trace(b->g);
}

static double timed_ns(bench_bed *b, void (*run)(bench_bed *))
{
    double least = 0;
    run(b); // the driver compiles
    glFinish();
    for (int i = 0; i < TIMES; ++i) {
        const double start = cpu_ns();
        run(b);
        glFinish();
        const double took = cpu_ns() - start;
        least = i == 0 || took < least ? took : least;
    }
    return least;
}

static double over(double ns, double without, double count)
{
    return ns > without ? (ns - without) / count : 0;
}

static void measure(bench_bed *b, cull_costs *out)
{
    const double pixels = (double)SIDE_PX * SIDE_PX, nothing = timed_ns(b, run_nothing);
    const double coarse = timed_ns(b, run_coarse), captured = timed_ns(b, run_capture); // and with it what is shown then
    run_deep_capture(b);
    out->capture_ns = over(timed_ns(b, run_small_captures), 0, CAPTURES);
    out->polygon_ns = over(timed_ns(b, run_fine), coarse, FINE_INDICES / 3 - 2);
    out->pixel_ns = over(coarse, nothing, pixels);
    out->picture_ns = over(timed_ns(b, run_small_pictures), nothing, PICTURES);
    out->picture_pixel_ns = over(timed_ns(b, run_picture), nothing, pixels);
    out->picture_depth_pixel_ns = over(timed_ns(b, run_deep_picture), nothing, pixels);
    out->capture_pixel_ns = over(captured, coarse - nothing, pixels);
}

// ---- The bed ----

static int make_slot(bench_bed *b, picture_slot *s, uint32_t side_px, uint32_t keep_depth)
{
    const double far = side_px == SIDE_PX ? DISTANCE_M : DISTANCE_M / SIDE_PX * side_px;
    const double eye[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) s->eye[k] = eye[k];
    s->corner[0] = s->corner[1] = -far;
    s->corner[2] = -DISTANCE_M;
    s->right[0] = s->up[1] = 2 * far;
    picture_as_taken(s);
    s->near_fraction = b->view.near_m / DISTANCE_M;
    s->filled = 1;
    return slot_textures(b->g, s, &(cull_capture){.width_px = side_px, .height_px = side_px, .keep_depth = keep_depth});
}

static result open_bed(bench_bed *b, report *r)
{
    static const camera eye = {.forward = {0, 0, -1}, .up = {0, 1, 0}, .fovy_deg = 90, .aspect = 1, .near_m = 1.0 / 16, .far_m = 1e30};
    const frame_request q = {.camera = &eye, .width_px = SIDE_PX, .height_px = SIDE_PX};
    const result begun = renderer_begin(b->g, &q, r);
    if (begun != RESULT_OK) return begun;
    b->t = b->g->frame.target;
    b->view = b->g->frame.view;
    for (int k = 0; k < 3; ++k) b->view.eye[k] = 0; // the mesh stands about the scene's origin
    viewpoint_finish(&b->view);
    if (make_mesh(b) != RESULT_OK) return report_no_memory(r, NULL);
    int made = make_slot(b, &b->whole, SIDE_PX, 0) && make_slot(b, &b->deep, SIDE_PX, 1);
    for (int i = 0; made && i < SMALLS; ++i) made = make_slot(b, &b->smalls[i], 4, 0);
    return made ? gl_check(b->g, r, "measuring what drawing takes") : RESULT_NO_GL;
}

static void close_bed(bench_bed *b)
{
    const vertex_buffers *v = &b->buffers;
    const GLuint buffers[] = {v->positions, v->words, v->triangles, v->texcoords, v->normals, v->others, v->movers, b->elements};
    slot_empty(b->g, &b->whole);
    slot_empty(b->g, &b->deep);
    for (int i = 0; i < SMALLS; ++i) slot_empty(b->g, &b->smalls[i]);
    glDeleteVertexArrays(1, &b->vertices);
    glDeleteBuffers((GLsizei)(sizeof buffers / sizeof *buffers), buffers);
    state_forget(b->g); // their names may come again
    if (b->g->frame.open) renderer_end(b->g);
}

result renderer_costs(renderer *g, report *r, cull_costs *out)
{
    if (g->costs_of == g->scene.scene && g->scene.scene) {
        *out = g->costs;
        return RESULT_OK;
    }
    bench_bed b = {.g = g};
    result done = open_bed(&b, r);
    if (done == RESULT_OK) {
        cull_costs measured = {.picture_bytes = g->pictures.options.bytes_most, .is_measured = 1};
        measured.pixel_bytes = g->pictures.options.format == PICTURE_8_BITS ? 4 : 2;
        measured.depth_pixel_bytes = measured.pixel_bytes + 4;
        measure(&b, &measured);
        g->costs = measured;
        g->costs_of = g->scene.scene;
        *out = measured;
    }
    close_bed(&b);
    return done;
}
