// Numbers in scene files: decimal text to the nearest double, whatever the locale, within bounds.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_NUMBER_H
#define PORTCULLIS_HOST_NUMBER_H

// Reads one decimal number that starts at `text` and ends before `end`. Returns the first byte behind it, or NULL where
// no finite decimal number stands: nan, inf and what overflows a double are refused, of 0x10 only the 0 is read.
// Correctly rounded. [any thread]
const char *number_read(const char *text, const char *end, double *out);

#endif
