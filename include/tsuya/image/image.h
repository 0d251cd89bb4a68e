// SPDX-License-Identifier: Apache-2.0
// Any image file through OpenImageIO, as interleaved floats.
#pragma once
#include <tsuya/base/file.h>

typedef struct ty_image
{
    int width, height, channels;
    float* pixels;        // [height][width][channels], top row first; owned
    bool is_float;        // whether the file held floating point (else integers scaled to 0..1)
    char color_space[64]; // what the file says of itself, or ""
} ty_image;

void ty_image_term(ty_image* image);

// Reads EXR of every kind (tiled, multi-part: the first part; DWA), HDR, PNG, JPEG, TIFF, BMP, TGA, PNM, WebP, DPX,
// told apart by content. A header whose size is out of proportion to the file, or above 32768 a side, is refused before
// memory is taken. Alpha as stored.
TY_CHECKED ty_status ty_image_read(const char* path, ty_image* out, ty_error* error);

// Only the channel of that name ("v", "matte.moss"); NULL: only the picture, which is R, G, B and A, or Y and A, where
// there are such, else the first four channels. TY_BAD_INPUT where there is no such channel; the message names all.
TY_CHECKED ty_status ty_image_read_channel(const char* path, const char* channel, ty_image* out, ty_error* error);

// What the header says, after the same checks; no pixels are decoded.
TY_CHECKED ty_status ty_image_read_size(const char* path, int* width, int* height, ty_error* error);

// Writes PNG (8 or 16 bit), JPEG or TIFF by extension, atomically; values clamp to 0..1. channels 1, 3 or 4. bits 8 or
// 16; 8 bit is dithered by nothing: equal input, equal bytes. JPEG has 8 bits and no alpha.
TY_CHECKED ty_status ty_image_write(const char* path, const ty_image* image, int bits, ty_error* error);
// The same into memory, owned by the caller; path gives the format and stands in messages.
TY_CHECKED ty_status ty_image_encode(const char* path, const ty_image* image, int bits, ty_bytes* out, ty_error* error);

// A smaller picture of at least 1 x 1 and at most the size of `image`: each pixel is the mean of the area that it
// stands for. The caller frees out; TY_NO_MEMORY leaves it empty.
TY_CHECKED ty_status ty_image_shrink(const ty_image* image, int width, int height, ty_image* out, ty_error* error);
