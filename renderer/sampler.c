// SPDX-License-Identifier: Apache-2.0
// Sobol' with hash-based Owen scrambling and an index shuffled per group (Burley 2020, "Practical hash-based Owen
// scrambling"), all on reversed bits: Owen's nested permutation is then a hash whose bits depend on lower bits alone.
#include "sampler.h"
#include <string.h>

// Direction numbers of Joe and Kuo 2008 ("new-joe-kuo-6"), dimensions 2 to 4.
static const struct
{
    int degree;
    uint32_t coefficients;
    uint32_t m[3];
} polynomials[3] = {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}};

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

// Columns of the generator matrix, first digit in the most significant bit.
static void direction_numbers(int dimension, uint32_t v[16])
{
    for (int i = 0; i < 16; ++i)
    {
        if (dimension == 0)
        {
            v[i] = 1u << (31 - i);
            continue;
        }
        int degree = polynomials[dimension - 1].degree;
        if (i < degree)
        {
            v[i] = polynomials[dimension - 1].m[i] << (31 - i);
            continue;
        }
        v[i] = v[i - degree] ^ v[i - degree] >> degree;
        for (int k = 1; k < degree; ++k)
            if (polynomials[dimension - 1].coefficients >> (degree - 1 - k) & 1u)
                v[i] ^= v[i - k];
    }
}

void ty_sobol_init(ty_sobol* sobol)
{
    for (int d = 0; d < 4; ++d)
    {
        uint32_t v[16];
        direction_numbers(d, v);
        for (int half = 0; half < 2; ++half)
            for (uint32_t byte = 0; byte < 256; ++byte)
            {
                uint32_t point = 0;
                for (int bit = 0; bit < 8; ++bit) // the byte is reversed: its top bit is the lowest of the index
                    if (byte >> (7 - bit) & 1u)
                        point ^= v[8 * half + bit];
                sobol->points[half][byte][d] = reverse_bits(point);
            }
    }
}

ty_sampler ty_sampler_make(const ty_sobol* sobol, ty_seed seed, int x, int y, uint32_t sample)
{
    uint64_t pixel = (uint64_t)(uint32_t)y << 32 | (uint32_t)x;
    uint64_t key = ty_mix64(ty_mix64(seed.value + 0x9e3779b97f4a7c15ull) ^ (pixel + 0xd1b54a32d192ed03ull));
    return (ty_sampler){sobol, key, reverse_bits(sample), seed, pixel, sample};
}

void ty_sampler_set_sample(ty_sampler* sampler, uint32_t sample)
{
    sampler->index_reversed = reverse_bits(sample);
    sampler->sample = sample;
}

// Laine and Karras 2011 in the constants of Vegdahl 2021 ("Building a better LK hash"): a nested uniform scramble of
// the reversed bits.
static inline uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Vectors of gcc and clang: the operators of C, lane by lane.
typedef uint32_t u32x4 __attribute__((vector_size(16)));
typedef uint32_t u32x8 __attribute__((vector_size(32)));
typedef int32_t s32x8 __attribute__((vector_size(32)));
typedef float f32x8 __attribute__((vector_size(32)));
typedef uint8_t u8x32 __attribute__((vector_size(32)));
typedef int32_t s32x4 __attribute__((vector_size(16)));
typedef float f32x4 __attribute__((vector_size(16)));
typedef uint8_t u8x16 __attribute__((vector_size(16)));

// The point of a group, before its scrambling, and the seed of that.
static inline u32x4 group_point(const ty_sampler* s, uint32_t group, uint32_t* seed)
{
    uint64_t key = ty_mix64(s->key + 0x9e3779b97f4a7c15ull * (group + 1u));
    uint32_t index = scramble_reversed(s->index_reversed, (uint32_t)key);
    u32x4 low, high;
    memcpy(&low, s->sobol->points[0][index >> 24], sizeof low);
    memcpy(&high, s->sobol->points[1][index >> 16 & 255u], sizeof high);
    *seed = (uint32_t)(key >> 32);
    return low ^ high;
}

#define DIMENSION_STEP 0x9e3779b9u // between the seeds of a group's dimensions

// Vectors of any width: mix32 of the seeds, the scrambling, reversed bits within bytes.
#define SCRAMBLE(x, seed)                                                                                              \
    do                                                                                                                 \
    {                                                                                                                  \
        seed ^= seed >> 16;                                                                                            \
        seed *= 0x7feb352du;                                                                                           \
        seed ^= seed >> 15;                                                                                            \
        seed *= 0x846ca68bu;                                                                                           \
        seed ^= seed >> 16;                                                                                            \
        x ^= x * 0x3d20adeau;                                                                                          \
        x += seed;                                                                                                     \
        x *= seed >> 16 | 1u;                                                                                          \
        x ^= x * 0x05526c56u;                                                                                          \
        x ^= x * 0x53a22864u;                                                                                          \
        x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;                                                           \
        x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;                                                           \
        x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;                                                           \
    } while (0)

void ty_sampler_4d(const ty_sampler* sampler, uint32_t group, float u[4])
{
    uint32_t s;
    u32x4 x = group_point(sampler, group, &s), seed = (u32x4){s, s, s, s} + (u32x4){0, 1, 2, 3} * DIMENSION_STEP;
    SCRAMBLE(x, seed);
    x = (u32x4)__builtin_shufflevector((u8x16)x, (u8x16)x, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
    f32x4 unit = __builtin_convertvector((s32x4)(x >> 8), f32x4) * 0x1p-24f;
    memcpy(u, &unit, sizeof unit);
}

// The same, twice as wide.
void ty_sampler_8d(const ty_sampler* sampler, uint32_t group, float u[8])
{
    uint32_t a, b;
    u32x4 low = group_point(sampler, group, &a), high = group_point(sampler, group + 1u, &b);
    u32x8 x = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    u32x8 seed = (u32x8){a, a, a, a, b, b, b, b} + (u32x8){0, 1, 2, 3, 0, 1, 2, 3} * DIMENSION_STEP;
    SCRAMBLE(x, seed);
    x = (u32x8)__builtin_shufflevector((u8x32)x, (u8x32)x, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12, 19, 18,
                                       17, 16, 23, 22, 21, 20, 27, 26, 25, 24, 31, 30, 29, 28);
    f32x8 unit = __builtin_convertvector((s32x8)(x >> 8), f32x8) * 0x1p-24f;
    memcpy(u, &unit, sizeof unit);
}
