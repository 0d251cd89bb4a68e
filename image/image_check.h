// SPDX-License-Identifier: Apache-2.0
// A look at an image file's bytes before any library sees them: its format, and what its header claims.
#pragma once
#include <stdint.h>
#include <tsuya/base/status.h>

#define TY_IMAGE_MAX_SIDE 32768

// OpenImageIO's name of the format, by content and not by extension; NULL if it is none that we read.
const char* ty_image_format(const char* path, const void* bytes, size_t size);

// Checks EXR headers and PNG files as a whole (length and CRC of each chunk); other formats pass.
// A failure is TY_BAD_FILE with the reason.
TY_CHECKED ty_status ty_image_check(const char* path, const char* format, const void* bytes, size_t size,
                                    ty_error* error);

// Refuses sides above the limit, and pixel data that the format cannot have packed into that many bytes.
TY_CHECKED ty_status ty_image_check_claim(const char* path, int64_t width, int64_t height, int64_t bytes_per_pixel,
                                          size_t size, ty_error* error);
