// SPDX-License-Identifier: Apache-2.0
// Random numbers as a function of (seed, keys, counter): the same whatever the thread or order.
#pragma once
#include <stdint.h>

typedef struct ty_seed
{
    uint64_t value;
} ty_seed;

// A good 32-bit permutation (Ettinger's lowbias32).
static inline uint32_t ty_mix32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

// A good 64-bit permutation (splitmix64's finaliser).
static inline uint64_t ty_mix64(uint64_t x)
{
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    x ^= x >> 31;
    return x;
}

// Counter-based stream: element i is a pure function of (key, i).
typedef struct ty_rng
{
    uint64_t key;
    uint64_t counter;
} ty_rng;

// Streams of different (a, b) are independent.
static inline ty_rng ty_rng_make(ty_seed seed, uint64_t a, uint64_t b)
{
    uint64_t key = ty_mix64(seed.value + 0x9e3779b97f4a7c15ull);
    key = ty_mix64(key ^ (a + 0xd1b54a32d192ed03ull));
    key = ty_mix64(key ^ (b + 0x8cb92ba72f3d8dd7ull));
    return (ty_rng){key, 0};
}

static inline uint64_t ty_rng_u64(ty_rng* rng)
{
    return ty_mix64(rng->key + 0x9e3779b97f4a7c15ull * ++rng->counter);
}

static inline uint32_t ty_rng_u32(ty_rng* rng)
{
    return (uint32_t)(ty_rng_u64(rng) >> 32);
}

// Uniform in [0, 1): 24 bits, so that 1 is never reached.
static inline float ty_u32_to_float(uint32_t x)
{
    return (float)(x >> 8) * 0x1p-24f;
}

static inline float ty_rng_float(ty_rng* rng)
{
    return ty_u32_to_float(ty_rng_u32(rng));
}

// Uniform in [low, high).
static inline float ty_rng_range(ty_rng* rng, float low, float high)
{
    return low + (high - low) * ty_rng_float(rng);
}
