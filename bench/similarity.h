// PSNR, and SSIM: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility to structural
// similarity", IEEE Transactions on Image Processing 13(4), 2004. Same bits from every compiler.
// SPDX-License-Identifier: MIT
#ifndef PORTCULLIS_BENCH_SIMILARITY_H
#define PORTCULLIS_BENCH_SIMILARITY_H

#include "flip.h"

// No error at all has no PSNR: it and all that is better stands as this many dB, so that a number always stands there.
#define PSNR_MOST_DB 100.0

// Mean of the squared differences of the bytes R, G and B over pixels and channels; alpha is not looked at.
double similarity_squared_error(const flip_pair *pair, size_t pixels);
double similarity_psnr_db(double mean_squared_error);

// Luminance 0.299 R + 0.587 G + 0.114 B of the bytes, windows of 11 x 11 with a Gaussian of 1.5 pixels, K1 0.01, K2 0.03,
// L 255; windows lie wholly in the picture, as in the authors' program. Returns their mean, 1 for equal pictures.
enum { SSIM_WINDOW_PX = 11 };
typedef struct similarity similarity; // scratch for one size of pictures
typedef struct similarity_size { uint32_t width_px, height_px; } similarity_size; // SSIM_WINDOW_PX at least
similarity *similarity_open(const similarity_size *q, const allocator *memory); // NULL: no memory, or no window fits
void similarity_close(similarity *s); // NULL is fine
double similarity_ssim(similarity *s, const flip_pair *pair);

#endif
