// SPDX-License-Identifier: Apache-2.0
// How pictures are made: a frozen scene to a film.
#pragma once
#include <tsuya/base/workers.h>
#include <tsuya/image/exr.h>
#include <tsuya/scene/scene.h>

typedef enum ty_aov
{
    TY_AOV_ALPHA = 1,
    TY_AOV_Z = 2,
    TY_AOV_N = 4,
    TY_AOV_P = 8,
    TY_AOV_ALBEDO = 16,
    TY_AOV_VARIANCE = 32,
    TY_AOV_INSTANCE = 64,
    TY_AOV_ALL = 127,  // of every scene
    TY_AOV_LIGHT = 128 // by light groups
} ty_aov;

// Sums per pixel as fixed-point integers: exact, so any split into samples, tiles or parts gives the same bits.
typedef struct ty_film ty_film; // opaque

typedef struct ty_film_setup
{
    int size[2];                  // of the whole picture
    int crop[4];                  // inclusive pixels {x0, y0, x1, y1}; the data window
    int sample_begin, sample_end; // the range this film is for
    unsigned aovs;                // ty_aov; beauty is always there
    bool half;
    const char* const* groups; // names of the light groups with TY_AOV_LIGHT, borrowed during create
    int group_count;           // at most TY_LIGHT_GROUPS
} ty_film_setup;

TY_CHECKED ty_status ty_film_create(const ty_film_setup* setup, ty_film** out, ty_error* error);
void ty_film_destroy(ty_film* film); // NULL is allowed

typedef struct ty_render_stats
{
    uint64_t camera_rays, path_rays, shadow_rays, interior_rays, path_vertices;
    uint64_t walks_lost; // random walks that got out through a hole
    uint64_t walks_cut;  // random walks that met the bound on their flights
    uint64_t nonfinite_samples, saturated_samples;
    int first_nonfinite[3]; // x, y, sample of the first dropped sample in (y, x, sample) order
    int samples_done;       // per pixel, complete passes
    double seconds;
} ty_render_stats;

// Called between passes on the calling thread, with every pixel complete from sample_begin up to sample_end (exclusive,
// global indices). False = stop here.
typedef bool ty_pass_fn(void* context, const ty_film* film, int sample_end, double seconds);

typedef struct ty_render_options
{
    int sample_begin, sample_end; // global sample indices
    ty_pass_fn* on_pass;          // NULL = none
    void* pass_context;
    double time_limit; // seconds, 0 = none: ends after a complete pass
    bool progress;
} ty_render_options;

// Renders into film by passes of rising length. Pure function of the scene, its seed, and the sample range.
// Cancelled: TY_INTERRUPTED or TY_TERMINATED; every pixel holds at least the complete passes (stats->samples_done),
// pixels of tiles that were through hold one pass more, and each averages over its own count.
TY_CHECKED ty_status ty_render(const ty_scene* scene, const ty_render_options* options, ty_workers* workers,
                               ty_film* film, ty_render_stats* stats, ty_error* error);

// The picture: channels and attributes as documented. partial marks an interrupted one and adds a channel of sample
// counts. part keeps the exact sums, so that merge can join it with others (not where a pass was interrupted: a
// warning).
typedef struct ty_film_write
{
    const ty_scene* scene;        // for camera, hash, recipe, seed
    int sample_begin, sample_end; // what the film holds
    bool part, partial;
} ty_film_write;
TY_CHECKED ty_status ty_film_to_exr(const ty_film* film, const ty_film_write* how, ty_exr** out, ty_error* error);

// Whether a picture has the channels that a film of this setup gives, each of its type and no other; the sums of parts
// are not looked at.
bool ty_film_setup_matches(const ty_film_setup* setup, const ty_exr* exr);

// Joins parts written with `part`: same hash, seed, size and window; their sample ranges follow each other. The result
// has the bytes that one run of the joined range writes: a picture if that is all the scene asks for, else a part
// again. A gap or an overlap is TY_BAD_FILE that names it.
TY_CHECKED ty_status ty_film_merge(const char* const* paths, int count, const char* output, ty_error* error);
