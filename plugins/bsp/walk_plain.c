// The walk in the baseline's vectors, or plain C.
// SPDX-License-Identifier: MIT
#define WALK_KERNEL walk_plain
#include "walk_body.h"
