// What the tests of pieces share: scenes of flat panes, each a wall, and the chain of a zone with the pieces that it lends.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_PIECES_FIXTURE_H
#define PORTCULLIS_TESTS_PIECES_FIXTURE_H

#include "host/core/pieces.h"

#include "../common/test.h"

enum { PANE_POINTS_MOST = 8, PANES_MOST = 256 };
typedef enum pane_kind { PANE_GLASS, PANE_OPAQUE, PANE_CLUSTER, PANE_MOVER } pane_kind; // the last two: glass that is no wall
typedef struct pane {
    double points[PANE_POINTS_MOST][3]; // counterclockwise from the front
    uint32_t point_count;
    pane_kind kind;
    uint32_t colour;
} pane;

typedef struct pane_list {
    pane panes[PANES_MOST];
    uint32_t count;
} pane_list;

// A parallelogram: middle, half sides.
pane *panes_add(pane_list *l, pane_kind kind, const double middle[3], const double u[3], const double v[3]);
void panes_add_box(pane_list *l, const double low[3], const double high[3]); // glass, faces outward
// The scenes, each of glass; names say what.
void panes_cyclic(pane_list *l);   // three, each over the next
void panes_crossing(pane_list *l); // two
void panes_boxes(pane_list *l);    // glass boxes in glass boxes
void panes_random(pane_list *l, uint32_t count, uint64_t seed);
void panes_sliced(pane_list *l); // a large one that many small ones cross, so that it falls into many pieces
typedef struct pane_scene { const char *name; void (*make)(pane_list *l); } pane_scene;
extern const pane_scene pane_scenes[];
extern const uint32_t pane_scene_count;

double pane_hit(const pane *p, const double from[3], const double along[3]); // in lengths of `along`; INFINITY: it meets none of it

typedef enum pane_materials { AS_THEY_ARE, ALL_OPAQUE } pane_materials;
scene *panes_build(const pane_list *l, pane_materials materials, const allocator *memory);

// A zone's chain as the product builds it, with what its select lends.
typedef struct zone_chain {
    report log;
    host_services services;
    loader *plugins;
    arena texts;
    chain_spec spec;
    zone_data zone;
    chain *chain;
    const cull_pieces *lent;
} zone_chain;
void zone_chain_open(const scene *s, uint32_t zone, const char *spec, zone_chain *out); // out must not move
void zone_chain_close(zone_chain *c);                                                   // zeroed is fine
uint32_t zone_chain_item(const zone_chain *c, uint32_t place);                          // in the zone data

extern const char *const piece_chains[]; // both ways to split, and with each all ways to choose; by turns split=1 and split=node
extern const uint32_t piece_chain_count;

#endif
