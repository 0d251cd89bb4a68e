// SPDX-License-Identifier: Apache-2.0
// Owen-scrambled Sobol' points as a pure function of (seed, pixel, sample, dimension group).
#pragma once
#include <tsuya/base/rng.h>

#define TY_SAMPLER_MAX_SAMPLES 65536

// Sobol' points of four dimensions by bytes of the bit-reversed index. Digits are reversed too: the least significant
// bit is the first binary digit, as the scrambling wants it.
typedef struct ty_sobol
{
    uint32_t points[2][256][4];
} ty_sobol;

void ty_sobol_init(ty_sobol* sobol);

// Plain data; one pixel sample.
typedef struct ty_sampler
{
    const ty_sobol* sobol;   // borrowed
    uint64_t key;            // of (seed, pixel)
    uint32_t index_reversed; // of the sample
    ty_seed seed;
    uint64_t pixel;
    uint32_t sample;
} ty_sampler;

// sample is below TY_SAMPLER_MAX_SAMPLES.
ty_sampler ty_sampler_make(const ty_sobol* sobol, ty_seed seed, int x, int y, uint32_t sample);
// On to another sample of the same pixel.
void ty_sampler_set_sample(ty_sampler* sampler, uint32_t sample);

// Dimension groups. What a group is used for never depends on what happened before, so that a decision at one bounce
// shifts no dimension of a later one.
#define TY_GROUP_CAMERA 0u        // filter x, y, lens x, y
#define TY_GROUP_TIME 0x30000000u // moment within the shutter, where anything moves
#define TY_GROUP_COAT 0x40000000u // and the next one: direct light by the coat at the camera's vertex
// Whether a ray goes straight through a surface; four numbers a group.
static inline uint32_t ty_group_pass(int bounce, int passed)
{
    return 0x50000000u + (uint32_t)bounce + ((uint32_t)passed / 4u << 16);
}
static inline uint32_t ty_group_scatter(int bounce)
{
    return 1u + 3u * (uint32_t)bounce; // this and the next one are fetched together
}
static inline uint32_t ty_group_interior(int bounce)
{
    return 3u + 3u * (uint32_t)bounce;
}

// Four numbers in [0,1). (0, 1) is a (0,2)-sequence over the samples of a pixel; each number alone is a (0,1)-sequence.
void ty_sampler_4d(const ty_sampler* sampler, uint32_t group, float u[4]);

// Groups `group` and `group + 1` at once; (0, 1) and (4, 5) are (0,2)-sequences.
void ty_sampler_8d(const ty_sampler* sampler, uint32_t group, float u[8]);

// Independent numbers for loops of unknown length at a bounce.
static inline ty_rng ty_sampler_extra(const ty_sampler* sampler, int bounce)
{
    return ty_rng_make(sampler->seed, sampler->pixel, (uint64_t)sampler->sample << 32 | (uint32_t)bounce);
}
