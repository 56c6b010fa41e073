// cmocka with what it wants included before it.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_TESTS_TEST_H
#define PORTCULLIS_TESTS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#endif
