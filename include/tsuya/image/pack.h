// SPDX-License-Identifier: Apache-2.0
// Pixels as compressed bytes that a script of a page unpacks with what every browser has.
#pragma once
#include <tsuya/image/image.h>

// A zlib stream of the pixels as halves (values beyond saturate, NaN become 0): for each channel the upper bytes of all
// pixels, row by row, then the lower ones; each byte but the first as its difference to the one before, modulo 256. The
// caller frees out. Equal input, equal bytes.
TY_CHECKED ty_status ty_pack_halves(const ty_image* image, ty_bytes* out, ty_error* error);
