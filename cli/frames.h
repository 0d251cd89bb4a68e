// SPDX-License-Identifier: Apache-2.0
// Lists of frames, "1-24:2,40", and the names of their files.
#pragma once
#include "cli.h"
#include <tsuya/base/file.h>

typedef struct ty_frame_list
{
    int* frames; // rising, each once; owned
    int count;
} ty_frame_list;

// Numbers, ranges and steps; `all` is start to end. A list that makes no sense, or of more than a million frames, is
// TY_USAGE that says why.
TY_CHECKED ty_status ty_frame_list_parse(const char* text, int start, int end, ty_frame_list* out, ty_error* error);
// What --frames says of a scene, `all` being its timeline; mistakes are logged.
TY_CHECKED ty_status ty_frame_list_read(const ty_arguments* arguments, const ty_scene_options* options,
                                        ty_frame_list* out);
void ty_frame_list_term(ty_frame_list* list);

// `%04d` and `%d` in the name of the file become `####` and `#`.
void ty_frame_pattern(const char* text, char out[TY_PATH_MAX]);
