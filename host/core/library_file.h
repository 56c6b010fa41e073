// A culler's library before it is opened: what the system's loader would say in its own words, or die of, is found in the
// file's bytes and told in one line. Nothing of the library runs.
// SPDX-License-Identifier: MIT
// Invariant: no byte outside the file is read, and the time is linear in its size, whatever stands in it.
#ifndef PORTCULLIS_HOST_LIBRARY_FILE_H
#define PORTCULLIS_HOST_LIBRARY_FILE_H

#include <stddef.h>
#include <stdint.h>

enum { LIBRARY_FAULT_BYTES = 256 };
typedef struct library_fault_text { char text[LIBRARY_FAULT_BYTES]; } library_fault_text; // for reasons that hold numbers

// NULL: it may be opened. Else what is wrong, a constant or in `text`. Where the system has no ELF files all may be opened.
const char *library_bytes_fault(const uint8_t *bytes, size_t size, library_fault_text *text);
const char *library_path_fault(const char *path, library_fault_text *text);
// The same words for a library that is open already. NULL: it is this host's number.
const char *library_abi_fault(uint32_t abi, library_fault_text *text);

#endif
