// What pictures took against what geometry would have taken: see account.h.
// SPDX-License-Identifier: MIT
#include "account.h"

#define DEBT_MOST 3.0   // frames of geometry that pictures may lose: the first ones of a view are worth about two
#define GAIN_MOST 3.0   // frames of geometry that they may have saved up against that
#define SUMS_KEPT 0.98  // a frame, of the sums of captures: fifty frames
#define BELIEF 0.5      // frames of geometry's worth of captures, by which what was foretold is believed
#define WEAR_LEAST 0.5
#define WEAR_MOST 32.0
#define WEAR_STAYS 1.3 // times more or less: choices would come and go with it
enum { REST_FIRST = 30, REST_MOST = 960 }; // frames

void account_open(account *a)
{
    *a = (account){.wear = 1, .next_rest = REST_FIRST};
}

int account_rests(account *a)
{
    if (a->rest == 0) return 0;
    a->rest--;
    a->in_a_row = 0;
    return 1;
}

void account_skip(account *a)
{
    a->in_a_row = 0;
}

// The first pictures of a view are taken whatever they will last: they say nothing.
static void learn_wear(account *a, const account_frame *f)
{
    if (a->in_a_row++ == 0) return;
    a->taken_ns = SUMS_KEPT * a->taken_ns + f->taken_ns;
    a->foretold_ns = SUMS_KEPT * a->foretold_ns + f->foretold_ns;
    const double belief = BELIEF * f->geometry_ns;
    if (!(a->foretold_ns + belief > 0)) return;
    double wear = (a->taken_ns + belief) / (a->foretold_ns + belief);
    wear = wear < WEAR_LEAST ? WEAR_LEAST : wear > WEAR_MOST ? WEAR_MOST : wear;
    if (wear > a->wear * WEAR_STAYS || wear * WEAR_STAYS < a->wear) a->wear = wear;
}

void account_add(account *a, const account_frame *f)
{
    learn_wear(a, f);
    a->balance_ns += f->geometry_ns - f->near_ns - f->shown_ns - f->taken_ns;
    if (a->balance_ns > GAIN_MOST * f->geometry_ns) {
        a->balance_ns = GAIN_MOST * f->geometry_ns;
        a->next_rest = REST_FIRST;
    }
    if (a->balance_ns >= -DEBT_MOST * f->geometry_ns) return;
    a->balance_ns = 0;
    a->rest = a->next_rest;
    a->next_rest = 2 * a->next_rest < REST_MOST ? 2 * a->next_rest : REST_MOST;
}
