// From what hides in space to what it covers on the picture: edges and depths in the homogeneous coordinates of Olano and Greer, Triangle
// Scan Conversion using 2D Homogeneous Coordinates, 1997: planes through the eye, so that nothing is clipped and nothing divides by w.
// SPDX-License-Identifier: MIT
#ifndef OCCLUSION_HIZ_SETUP_H
#define OCCLUSION_HIZ_SETUP_H

#include "hiz_buffer.h"
#include "hiz_view.h"

enum { HIZ_LOOP_MOST = 11 }; // vertices of a polygon

// A flat convex polygon, counterclockwise from where its normal points.
typedef struct hiz_loop {
    double points[HIZ_LOOP_MOST][3]; // from the eye
    double normal[3];
    uint32_t count;
} hiz_loop;

#endif
