// SPDX-License-Identifier: Apache-2.0
// A look at an EXR header before any library sees it: what it claims, and whether a file of that size can hold it.
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <tsuya/base/status.h>

typedef struct ty_exr_claim
{
    bool tiled, multipart, deep, subsampled;
    bool has_channels, has_data_window, has_compression;
    int data_window[4];
    int compression; // the format's number: 0 none, 1 RLE, 2 ZIPS, 3 ZIP, 4 PIZ, 5 PXR24, 6 B44, 7 B44A, 8 DWAA, 9 DWAB
    int channel_count;
    int64_t bytes_per_pixel; // of all channels at full resolution
} ty_exr_claim;

bool ty_exr_is_magic(const void* bytes, size_t size);

// Walks the (first) header. Every attribute must lie inside the file, their number and the channels' be bounded, the
// window sane, the key attributes there once. A failure is TY_BAD_FILE with the reason.
TY_CHECKED ty_status ty_exr_check_header(const char* name, const void* bytes, size_t size, ty_exr_claim* claim,
                                         ty_error* error);

// Refuses a claim above max_side, or of more than the compression can bring out of that many bytes.
TY_CHECKED ty_status ty_exr_check_size(const char* name, const ty_exr_claim* claim, size_t size, int max_side,
                                       ty_error* error);
