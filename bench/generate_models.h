// Smooth models of the demo scene, each one closed surface that stands on the place it is given.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_GENERATE_MODELS_H
#define PORTCULLIS_BENCH_GENERATE_MODELS_H

#include "generate_obj.h"
#include "generate_random.h"

void model_ball(obj_writer *w, spot middle, double radius, uint32_t around);
void model_ring(obj_writer *w, spot middle, double radius, double tube);  // a standing torus
void model_knot(obj_writer *w, spot middle, double radius);               // a trefoil
void model_column(obj_writer *w, spot foot, double height);               // fluted
void model_figure(obj_writer *w, spot foot, double height, double turn);  // a robed figure
void model_vase(obj_writer *w, spot foot, double height, uint32_t kind);  // kinds 0 .. 3, further ones repeat
void model_pot(obj_writer *w, spot foot, double height, uint32_t kind);   // a vase of fewer triangles
void model_lamp(obj_writer *w, spot foot, double height);
void model_tree(obj_writer *w, spot foot, double height, random_stream *r); // sets its own materials
void model_conifer(obj_writer *w, spot foot, double height, random_stream *r);   // 112 triangles, for woods; as all here sets its materials
void model_broadleaf(obj_writer *w, spot foot, double height, random_stream *r); // 192

#endif
