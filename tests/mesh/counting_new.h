// Operator new, counted and made to fail: for the fault loop through the bridge.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_MESH_COUNTING_NEW_H
#define PORTCULLIS_TESTS_MESH_COUNTING_NEW_H

#ifdef __cplusplus
extern "C" {
#endif

void new_fails_at(long call); // the call-th from now throws, from 1; 0: none
long new_calls(void);         // since then
long new_live(void);          // blocks that stand now

#ifdef __cplusplus
}
#endif
#endif
