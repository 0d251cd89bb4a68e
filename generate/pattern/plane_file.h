// SPDX-License-Identifier: Apache-2.0
// Masks and images for patterns: a file, or a sequence of files, as planes of floats.
#pragma once
#include <tsuya/image/color.h>

// [channels][height][width], top row first.
typedef struct ty_planes
{
    int width, height, channels;
    float* values; // owned, freed with ty_planes_term
} ty_planes;

void ty_planes_term(ty_planes* planes); // zeroed ones are allowed

typedef enum ty_plane_channel
{
    TY_PLANE_LUMINANCE, // of Rec. 709's primaries; of one or two channels the first
    TY_PLANE_R,
    TY_PLANE_G,
    TY_PLANE_B,
    TY_PLANE_A, // the last of two or four; 1 where there is none
} ty_plane_channel;

extern const char* const ty_plane_channel_names[]; // for tables, up to NULL

// An image or a sequence that was found: all of it belongs to the caller of open but the texts, which are borrowed.
typedef struct ty_plane_file
{
    const char* path; // a file, or a pattern with ####; NULL = none
    const char* key;  // what messages begin with, e.g. "region.mask"
    int width, height;
} ty_plane_file;

// Looks whether the file is there, or every frame from first to last of a sequence, and reads their sizes. Without a
// frame, or with frames of two sizes: TY_BAD_INPUT that tells which.
TY_CHECKED ty_status ty_plane_file_open(const char* path, const char* key, int first, int last, ty_plane_file* out,
                                        ty_error* error);
// Of a sequence that frame is read. One of another size than the first: TY_BAD_INPUT with both sizes.
// One channel as it stands in the file: [height][width], the caller frees it with ty_free.
TY_CHECKED ty_status ty_plane_file_read_channel(const ty_plane_file* file, int frame, ty_plane_channel channel,
                                                float** out, ty_error* error);
// Three planes in ACEScg, taken from the space that the file says or is guessed to be in.
TY_CHECKED ty_status ty_plane_file_read_color(const ty_plane_file* file, int frame, const ty_color* color,
                                              ty_planes* out, ty_error* error);
