// What pictures took against what all geometry would have taken, frame by frame, in the host's measured costs: a zone in which they lose is handed back to
// geometry for a while, longer each time (binary exponential back-off: Metcalfe and Boggs, 1976). And how much sooner pictures wear out than foretold.
// SPDX-License-Identifier: MIT
//
// Invariant: only counts and the host's costs go in: the same frames give the same account. What pictures may lose before geometry has its turn is
// DEBT_MOST frames of geometry, and by the doubling of its turns a vanishing share of a long flight.
#ifndef PORTCULLIS_IMAGECACHE_ACCOUNT_H
#define PORTCULLIS_IMAGECACHE_ACCOUNT_H

#include <stdint.h>

// A frame with pictures, in nanoseconds.
typedef struct account_frame {
    double geometry_ns;           // of all in view, had it been geometry
    double near_ns, shown_ns;     // geometry drawn beside pictures; pictures shown, tests and all
    double taken_ns, foretold_ns; // captures; those that pictures shown were foretold to need, a frame
} account_frame;

typedef struct account {
    double balance_ns;           // what pictures saved, less what they lost, of late
    double taken_ns, foretold_ns; // of captures: slow sums
    double wear;                 // captures for each that was foretold; it stays while it is about right
    uint32_t rest, next_rest;    // frames of geometry still to go; and when pictures lose again
    uint32_t in_a_row;           // frames with pictures
} account;

void account_open(account *a);
int account_rests(account *a); // a frame begins: 1, it is geometry's turn
void account_skip(account *a); // it was no frame of pictures, though they had their turn
void account_add(account *a, const account_frame *f);

#endif
