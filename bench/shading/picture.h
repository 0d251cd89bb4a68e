// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes, rendered by the program in this process, and what tells them apart.
#pragma once
#include <tsuya/renderer/render.h>

typedef struct picture_def
{
    const char* path; // a scene file or folder
    const char* text; // or the scene itself, with files beside path
    const char* const* sets;
    int set_count;
    int size[2]; // 0 = the scene's
    int samples;
    uint64_t seed;
    ty_workers* workers;
} picture_def;

// All channels, and the CPU seconds of rendering alone, of all threads together: other work on the machine counts
// little. Leaves the program with a message where the scene does not load.
ty_exr* picture_render(const picture_def* def, double* seconds);

const float* picture_channel(const ty_exr* exr, const char* name);
