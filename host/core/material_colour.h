// A material's colour when its file says none: by words in its name that mean a stuff, varied by the name's hash.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_HOST_MATERIAL_COLOUR_H
#define PORTCULLIS_HOST_MATERIAL_COLOUR_H

#include <stddef.h>
#include <stdint.h>

uint32_t material_colour(const char *name, size_t length); // 0xAABBGGRR, opaque; the same name, the same colour

#endif
