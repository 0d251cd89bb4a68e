// SPDX-License-Identifier: Apache-2.0
// A render as the command line asks for it: one picture, or one a frame, of one scene that is loaded once.
#pragma once
#include "frames.h"
#include <tsuya/renderer/render.h>

typedef struct ty_render_job
{
    const ty_arguments* arguments;
    ty_frame_list list; // count 0 = the scene's own frame
    double first;       // of the list
    bool lists;         // frames were asked for
    bool skips;         // frames that are there already
    bool develops;
    char pattern[TY_PATH_MAX]; // of the output
    char output[TY_PATH_MAX];  // of the frame in work
    char preview[TY_PATH_MAX]; // "" = not developed
    const char* video;         // NULL = none
    ty_develop_def develop;
    ty_film_setup setup;
    ty_film_write write;
    ty_render_options render;
    double next_preview; // seconds of rendering
    json_t* results;     // of frames, with --json or --stats; NULL = none
    const char* repeat;  // the command that renders this again, for messages; NULL = of the scene and its frame
} ty_render_job;

// --- render_options.c: what the command line says; mistakes are logged and TY_USAGE ---

// The short forms of --set, so that they are recorded like any other override.
TY_CHECKED ty_status ty_render_overrides(const ty_arguments* arguments, ty_scene_arguments* scene);
TY_CHECKED ty_status ty_render_progress(const ty_arguments* arguments);
// Window, samples and channels, once the scene is known.
TY_CHECKED ty_status ty_render_plan(ty_render_job* job, const ty_scene* scene);

// --- render_frame.c ---

// Renders, writes what there is (also after a signal) and reports.
TY_CHECKED ty_status ty_render_frame(ty_render_job* job, const ty_scene* scene, ty_workers* workers, ty_error* error);
// Whether the frame in work is there, complete, of this very scene and with the channels asked for; then its PNG is
// developed from it.
TY_CHECKED ty_status ty_render_find(const ty_render_job* job, const ty_scene* scene, bool* found, ty_error* error);

// --- render.c ---

// All of it: overrides of the caller are in scene_arguments already. Takes the list over; empty = what --frames says.
TY_CHECKED ty_status ty_render_run(const ty_arguments* arguments, ty_scene_arguments* scene_arguments,
                                   ty_frame_list list);

// What a picture is made of: for every command that renders.
#define TY_PICTURE_OPTIONS                                                                                             \
    {"quick", 'q', NULL, "half size, 16 samples, where --size, --spp and --set say nothing"},                          \
        {"spp", 0, "N", "samples a pixel"},                                                                            \
        {"samples", 0, "A-B", "only these sample indices: a part for `tsuya merge`"},                                  \
        {"size", 0, "WxH", "picture size"}, {"crop", 0, "x0,y0,x1,y1", "only these pixels (inclusive)"},               \
        {"seed", 0, "N", "seed of all random decisions"},                                                              \
        {"aov", 0, "LIST", "alpha,Z,N,P,albedo,variance,instance,light | all | none"},                                 \
        {"integrator", 0, "X", "path, albedo, normal, curvature, ao"},                                                 \
        {"time-limit", 0, "SECONDS", "stop (each frame) after the pass that exceeds it"},                              \
        {"trace", 0, "PATH", "fast, or reference: plain Embree instances"},                                            \
    {                                                                                                                  \
        "isa", 0, "NAME", "pin the CPU kernels: sse2, sse4.2, avx, avx2, avx512"                                       \
    }

// The options that commands that render frames understand, but for --frames.
#define TY_RENDER_OPTIONS                                                                                              \
    {"output", 'o', "OUT.exr", "the picture (default: the scene's name); of frames with #### or %04d"},                \
        {"develop", 0, NULL, "also a PNG beside it, from early on"},                                                   \
        {"display", 0, "D", "of the PNG: display of the OCIO configuration (default: sRGB)"},                          \
        {"view", 0, "V", "of the PNG: view (default: ACES 1.0 SDR)"},                                                  \
        {"exposure", 'e', "EV", "of the PNG: stops, before the view"},                                                 \
        {"bits", 0, "8|16", "of the PNG: bits a channel (default 8)"},                                                 \
        {"video", 0, "OUT.mp4", "the developed frames as a video, by ffmpeg"},                                         \
        {"skip-existing", 0, NULL, "leave frames that are there: complete, of this very scene and these channels"},    \
        TY_SCENE_OPTIONS, TY_PICTURE_OPTIONS, {"stats", 0, "F.json", "statistics as JSON"},                            \
        {"progress", 0, "M", "auto, bar, lines, none"}, {"json", 0, NULL, "the result as JSON on standard output"},    \
    {                                                                                                                  \
        "dry-run", 0, NULL, "check everything, render nothing"                                                         \
    }
