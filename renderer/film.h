// SPDX-License-Identifier: Apache-2.0
// The film's insides: sums per pixel in fixed point, which come out the same however samples are grouped.
#pragma once
#include <tsuya/renderer/render.h>

__extension__ typedef unsigned __int128 ty_u128;

#define TY_FILM_SCALE 0x1p30           // counts per unit
#define TY_FILM_LIMIT 0x7fffffffffffll // of one sample: 131072 units; 65536 such samples still fit
#define TY_FILM_Z_NONE 1e10f           // Z of a pixel that sees nothing
#define TY_FILM_NO_SAMPLE 0xffffffffu

// One camera sample.
typedef struct ty_film_sample
{
    ty_rgb radiance;
    ty_rgb albedo;
    ty_vec3 normal;
    ty_vec3 position;
    float depth;                   // m, along the camera's axis
    uint32_t instance;             // from 1 over the whole scene
    bool hit;                      // a surface: albedo to instance are set
    bool covered;                  // a surface or a visible area light
    ty_rgb group[TY_LIGHT_GROUPS]; // parts of the radiance by light group; those that the film has
} ty_film_sample;

static inline void ty_film_sample_begin(ty_film_sample* sample, uint32_t group_count)
{
    sample->radiance = (ty_rgb){0};
    sample->hit = sample->covered = false;
    for (uint32_t g = 0; g < group_count; ++g)
        sample->group[g] = (ty_rgb){0};
}

// Light of a group, -1 = nobody asks.
static inline void ty_film_sample_add(ty_film_sample* sample, int group, ty_rgb light)
{
    sample->radiance = ty_rgb_add(sample->radiance, light);
    if (group >= 0)
        sample->group[group] = ty_rgb_add(sample->group[group], light);
}

// The sums are kept as unsigned numbers modulo 2^64 (2^128): adding never overflows, whatever a damaged part holds.
typedef struct ty_pixel_sums
{
    ty_u128 luminance_sqr; // in 2^-60
    uint64_t radiance[3];  // in 2^-30, two's complement
    uint64_t luminance;
    uint64_t normal[3];
    uint64_t albedo[3];
    uint64_t group[TY_LIGHT_GROUPS][3]; // as radiance
    uint32_t group_count;
    uint32_t samples, covered;
    // The hit of the lowest sample index that has one.
    uint32_t first_sample; // TY_FILM_NO_SAMPLE = none
    uint32_t first_instance;
    ty_vec3 first_position;
    float first_depth;
} ty_pixel_sums;

typedef enum ty_sample_fate
{
    TY_SAMPLE_GOOD,
    TY_SAMPLE_SATURATED, // clamped to the fixed point's range
    TY_SAMPLE_DROPPED,   // not finite: it counts as black
} ty_sample_fate;

typedef struct ty_plane_beauty
{
    uint64_t radiance[3];
    uint32_t samples, covered;
} ty_plane_beauty;

typedef struct ty_plane_moments
{
    ty_u128 luminance_sqr;
    uint64_t luminance;
} ty_plane_moments;

typedef struct ty_plane_vector
{
    uint64_t sum[3];
} ty_plane_vector;

typedef struct ty_plane_first
{
    uint32_t sample, instance;
    ty_vec3 position;
    float depth;
} ty_plane_first;

struct ty_film
{
    ty_film_setup setup;
    int width, height; // of the crop
    ty_plane_beauty* beauty;
    ty_plane_moments* moments; // with TY_AOV_VARIANCE, else NULL
    ty_plane_vector* normal;   // with TY_AOV_N
    ty_plane_vector* albedo;   // with TY_AOV_ALBEDO
    ty_plane_first* first;     // with TY_AOV_Z, P or INSTANCE
    ty_plane_vector* groups;   // [pixel][group_count], with TY_AOV_LIGHT
    char group_names[TY_LIGHT_GROUPS][TY_LIGHT_GROUP_NAME + 1];
    uint32_t group_count; // 0 without TY_AOV_LIGHT
};

ty_pixel_sums ty_pixel_sums_make(uint32_t group_count);
// sample_index: global, for the first hit.
ty_sample_fate ty_pixel_sums_add(ty_pixel_sums* sums, const ty_film_sample* sample, uint32_t sample_index);

// Adds sums of samples that are not in the film yet to picture pixel (x, y) of the crop. Different pixels may be
// committed from different threads.
void ty_film_commit(ty_film* film, int x, int y, const ty_pixel_sums* sums);
ty_pixel_sums ty_film_pixel(const ty_film* film, int x, int y);

static inline size_t ty_film_index(const ty_film* film, int x, int y)
{
    return (size_t)(y - film->setup.crop[1]) * (size_t)film->width + (size_t)(x - film->setup.crop[0]);
}

// Mean of a sum in fixed point.
static inline float ty_fixed_mean(uint64_t sum, uint32_t samples)
{
    return samples ? (float)((double)(int64_t)sum / (TY_FILM_SCALE * (double)samples)) : 0.0f;
}

// Variance of the pixel's mean luminance: unbiased sample variance over the count; 0 below two samples.
float ty_film_variance(const ty_pixel_sums* sums);

// --- EXR: the picture alone, and the exact sums ---

// Channels of the picture; half and the choice of channels follow the setup.
void ty_film_add_channels(const ty_film* film, bool partial, ty_exr* exr);
void ty_film_add_part_channels(const ty_film* film, ty_exr* exr);
// A film with the sums of a part written before. TY_BAD_FILE when something is missing or does not fit.
TY_CHECKED ty_status ty_film_from_part(const ty_exr* exr, const char* name, ty_film** out, ty_error* error);
void ty_film_add_range(int sample_begin, int sample_end, ty_exr* exr); // "tsuya/samples"

#define TY_GROUP_CHANNEL "light."
#define TY_GROUP_CHANNEL_SIZE 56 // bytes that a channel's name takes at most
#define TY_PART_CHANNEL "part."
#define TY_KEY_SAMPLES "tsuya/samples"
#define TY_KEY_PARTIAL "tsuya/partial"
#define TY_KEY_PART "tsuya/part"
#define TY_KEY_PLANNED "tsuya/samplesPlanned" // of the scene: tells a part from a picture
// "light.NAME.R" and so on.
void ty_film_group_channel(const char* group, int component, char name[TY_GROUP_CHANNEL_SIZE]);
