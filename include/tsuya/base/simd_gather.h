// SPDX-License-Identifier: Apache-2.0
// Sixteen 32-bit integers beside ty_f16, and reading sixteen pairs of neighbouring 16-bit numbers by index. The same
// bits in all three widths of base/simd.h.
#pragma once
#include <string.h>
#include <tsuya/base/simd.h>

#if defined(__AVX512F__) && defined(__AVX512DQ__) && !defined(TY_SIMD_PORTABLE)

typedef __m512i ty_i16;

static inline ty_i16 ty_i16_set(int32_t a)
{
    return _mm512_set1_epi32(a);
}
static inline ty_i16 ty_i16_add(ty_i16 a, ty_i16 b)
{
    return _mm512_add_epi32(a, b);
}
// The low 32 bits.
static inline ty_i16 ty_i16_mul(ty_i16 a, ty_i16 b)
{
    return _mm512_mullo_epi32(a, b);
}
static inline ty_f16 ty_f16_floor(ty_f16 a)
{
    return _mm512_roundscale_ps(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
// Of whole numbers within the range of int32_t.
static inline ty_i16 ty_f16_to_int(ty_f16 a)
{
    return _mm512_cvttps_epi32(a);
}
// numbers[index] and numbers[index + 1] of each lane. index is at least 0; both numbers exist.
static inline void ty_u16_gather_pairs(const uint16_t* numbers, ty_i16 index, ty_f16* first, ty_f16* second)
{
    const __m512i pair = _mm512_i32gather_epi32(index, numbers, 2);
    *first = _mm512_cvtepi32_ps(_mm512_and_si512(pair, _mm512_set1_epi32(0xffff)));
    *second = _mm512_cvtepi32_ps(_mm512_srli_epi32(pair, 16));
}

#elif defined(__AVX2__) && defined(__FMA__) && !defined(TY_SIMD_PORTABLE)

typedef struct ty_i16
{
    __m256i low, high;
} ty_i16;

static inline ty_i16 ty_i16_set(int32_t a)
{
    return (ty_i16){_mm256_set1_epi32(a), _mm256_set1_epi32(a)};
}
static inline ty_i16 ty_i16_add(ty_i16 a, ty_i16 b)
{
    return (ty_i16){_mm256_add_epi32(a.low, b.low), _mm256_add_epi32(a.high, b.high)};
}
static inline ty_i16 ty_i16_mul(ty_i16 a, ty_i16 b)
{
    return (ty_i16){_mm256_mullo_epi32(a.low, b.low), _mm256_mullo_epi32(a.high, b.high)};
}
static inline ty_f16 ty_f16_floor(ty_f16 a)
{
    return (ty_f16){_mm256_floor_ps(a.low), _mm256_floor_ps(a.high)};
}
static inline ty_i16 ty_f16_to_int(ty_f16 a)
{
    return (ty_i16){_mm256_cvttps_epi32(a.low), _mm256_cvttps_epi32(a.high)};
}
static inline void ty_u16_gather_pairs(const uint16_t* numbers, ty_i16 index, ty_f16* first, ty_f16* second)
{
    const __m256i mask = _mm256_set1_epi32(0xffff);
    const __m256i low = _mm256_i32gather_epi32((const int*)(const void*)numbers, index.low, 2);
    const __m256i high = _mm256_i32gather_epi32((const int*)(const void*)numbers, index.high, 2);
    *first =
        (ty_f16){_mm256_cvtepi32_ps(_mm256_and_si256(low, mask)), _mm256_cvtepi32_ps(_mm256_and_si256(high, mask))};
    *second = (ty_f16){_mm256_cvtepi32_ps(_mm256_srli_epi32(low, 16)), _mm256_cvtepi32_ps(_mm256_srli_epi32(high, 16))};
}

#else

typedef struct ty_i16
{
    int32_t lane[TY_LANES];
} ty_i16;

#define TY_I16_EACH(expression)                                                                                        \
    ty_i16 r;                                                                                                          \
    for (int i = 0; i < TY_LANES; i++)                                                                                 \
        r.lane[i] = (expression);                                                                                      \
    return r

static inline ty_i16 ty_i16_set(int32_t a)
{
    TY_I16_EACH(a);
}
static inline ty_i16 ty_i16_add(ty_i16 a, ty_i16 b)
{
    TY_I16_EACH((int32_t)((uint32_t)a.lane[i] + (uint32_t)b.lane[i]));
}
static inline ty_i16 ty_i16_mul(ty_i16 a, ty_i16 b)
{
    TY_I16_EACH((int32_t)((uint32_t)a.lane[i] * (uint32_t)b.lane[i]));
}
static inline ty_f16 ty_f16_floor(ty_f16 a)
{
    TY_F16_EACH(floorf(a.lane[i]));
}
static inline ty_i16 ty_f16_to_int(ty_f16 a)
{
    TY_I16_EACH((int32_t)a.lane[i]);
}
static inline void ty_u16_gather_pairs(const uint16_t* numbers, ty_i16 index, ty_f16* first, ty_f16* second)
{
    for (int i = 0; i < TY_LANES; i++)
    {
        first->lane[i] = numbers[index.lane[i]];
        second->lane[i] = numbers[(int64_t)index.lane[i] + 1];
    }
}
#endif
