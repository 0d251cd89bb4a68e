// SPDX-License-Identifier: Apache-2.0
// Cells side by side: sixteen with AVX-512, eight with AVX2, else one, by what the including file is compiled for.
// Every operation is the IEEE one and none is fused, so that all give the same bits. GS_PORTABLE forces the one.
#pragma once
#include <stdbool.h>
#include <stdint.h>

#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512VL__) && !defined(GS_PORTABLE)
#include <immintrin.h>

enum
{
    GS_LANES = 16,
    GS_SLIDES = true // shifting registers beats loads across cache lines
};
typedef __m512 gs_lanes;
typedef __mmask16 gs_flags; // a cell's barrier
typedef __m512i gs_index;   // a cell's mark, in four bits
typedef __m512 gs_table;    // sixteen values

static inline gs_lanes gs_load(const float* at)
{
    return _mm512_loadu_ps(at);
}
static inline void gs_store(float* at, gs_lanes a)
{
    _mm512_storeu_ps(at, a);
}
static inline gs_lanes gs_set(float a)
{
    return _mm512_set1_ps(a);
}
static inline gs_lanes gs_add(gs_lanes a, gs_lanes b)
{
    return _mm512_add_ps(a, b);
}
static inline gs_lanes gs_sub(gs_lanes a, gs_lanes b)
{
    return _mm512_sub_ps(a, b);
}
static inline gs_lanes gs_mul(gs_lanes a, gs_lanes b)
{
    return _mm512_mul_ps(a, b);
}
// The lanes a cell to the left of a's, and to the right: `before` and `after` lie beside it.
static inline gs_lanes gs_before(gs_lanes before, gs_lanes a)
{
    return _mm512_castsi512_ps(_mm512_alignr_epi32(_mm512_castps_si512(a), _mm512_castps_si512(before), 15));
}
static inline gs_lanes gs_after(gs_lanes a, gs_lanes after)
{
    return _mm512_castsi512_ps(_mm512_alignr_epi32(_mm512_castps_si512(after), _mm512_castps_si512(a), 1));
}
static inline gs_index gs_index_load(const uint8_t* marks)
{
    return _mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i*)(const void*)marks));
}
static inline gs_table gs_table_load(const float* table)
{
    return _mm512_loadu_ps(table);
}
static inline gs_lanes gs_look_up(gs_table table, gs_index index)
{
    return _mm512_permutexvar_ps(index, table);
}
static inline gs_flags gs_closed(const uint8_t* marks)
{
    return _mm_movepi8_mask(_mm_loadu_si128((const __m128i*)(const void*)marks));
}
static inline gs_flags gs_or(gs_flags a, gs_flags b)
{
    return (gs_flags)(a | b);
}
static inline gs_flags gs_and(gs_flags a, gs_flags b)
{
    return (gs_flags)(a & b);
}
// flag ? a : b
static inline gs_lanes gs_select(gs_flags flag, gs_lanes a, gs_lanes b)
{
    return _mm512_mask_mov_ps(b, flag, a);
}

#elif defined(__AVX2__) && !defined(GS_PORTABLE)
#include <immintrin.h>

enum
{
    GS_LANES = 8,
    GS_SLIDES = false // two shuffles a shift
};
typedef __m256 gs_lanes;
typedef __m256 gs_flags; // the sign bit
typedef __m256i gs_index;
typedef struct gs_table
{
    __m256 low, high;
} gs_table;

static inline gs_lanes gs_load(const float* at)
{
    return _mm256_loadu_ps(at);
}
static inline void gs_store(float* at, gs_lanes a)
{
    _mm256_storeu_ps(at, a);
}
static inline gs_lanes gs_set(float a)
{
    return _mm256_set1_ps(a);
}
static inline gs_lanes gs_add(gs_lanes a, gs_lanes b)
{
    return _mm256_add_ps(a, b);
}
static inline gs_lanes gs_sub(gs_lanes a, gs_lanes b)
{
    return _mm256_sub_ps(a, b);
}
static inline gs_lanes gs_mul(gs_lanes a, gs_lanes b)
{
    return _mm256_mul_ps(a, b);
}
// The lanes a cell to the left of a's, and to the right: `before` and `after` lie beside it.
static inline gs_lanes gs_before(gs_lanes before, gs_lanes a)
{
    __m256 middle = _mm256_permute2f128_ps(before, a, 0x21);
    return _mm256_castsi256_ps(_mm256_alignr_epi8(_mm256_castps_si256(a), _mm256_castps_si256(middle), 12));
}
static inline gs_lanes gs_after(gs_lanes a, gs_lanes after)
{
    __m256 middle = _mm256_permute2f128_ps(a, after, 0x21);
    return _mm256_castsi256_ps(_mm256_alignr_epi8(_mm256_castps_si256(middle), _mm256_castps_si256(a), 4));
}
static inline gs_index gs_index_load(const uint8_t* marks)
{
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i*)(const void*)marks));
}
static inline gs_table gs_table_load(const float* table)
{
    return (gs_table){_mm256_loadu_ps(table), _mm256_loadu_ps(table + 8)};
}
static inline gs_lanes gs_look_up(gs_table table, gs_index index)
{
    __m256 low = _mm256_permutevar8x32_ps(table.low, index), high = _mm256_permutevar8x32_ps(table.high, index);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(index, 28))); // bit 3 to the sign
}
static inline gs_flags gs_closed(const uint8_t* marks)
{
    return _mm256_castsi256_ps(_mm256_cvtepi8_epi32(_mm_loadl_epi64((const __m128i*)(const void*)marks)));
}
static inline gs_flags gs_or(gs_flags a, gs_flags b)
{
    return _mm256_or_ps(a, b);
}
static inline gs_flags gs_and(gs_flags a, gs_flags b)
{
    return _mm256_and_ps(a, b);
}
static inline gs_lanes gs_select(gs_flags flag, gs_lanes a, gs_lanes b)
{
    return _mm256_blendv_ps(b, a, flag);
}

#else

enum
{
    GS_LANES = 1,
    GS_SLIDES = false
};
typedef float gs_lanes;
typedef bool gs_flags;
typedef unsigned gs_index;
typedef const float* gs_table;

static inline gs_lanes gs_load(const float* at)
{
    return *at;
}
static inline void gs_store(float* at, gs_lanes a)
{
    *at = a;
}
static inline gs_lanes gs_set(float a)
{
    return a;
}
static inline gs_lanes gs_add(gs_lanes a, gs_lanes b)
{
    return a + b;
}
static inline gs_lanes gs_sub(gs_lanes a, gs_lanes b)
{
    return a - b;
}
static inline gs_lanes gs_mul(gs_lanes a, gs_lanes b)
{
    return a * b;
}
// The lanes a cell to the left of a's, and to the right: `before` and `after` lie beside it.
static inline gs_lanes gs_before(gs_lanes before, gs_lanes a)
{
    (void)a;
    return before;
}
static inline gs_lanes gs_after(gs_lanes a, gs_lanes after)
{
    (void)a;
    return after;
}
static inline gs_index gs_index_load(const uint8_t* marks)
{
    return *marks & 15u;
}
static inline gs_table gs_table_load(const float* table)
{
    return table;
}
static inline gs_lanes gs_look_up(gs_table table, gs_index index)
{
    return table[index];
}
static inline gs_flags gs_closed(const uint8_t* marks)
{
    return *marks >= 128;
}
static inline gs_flags gs_or(gs_flags a, gs_flags b)
{
    return a || b;
}
static inline gs_flags gs_and(gs_flags a, gs_flags b)
{
    return a && b;
}
static inline gs_lanes gs_select(gs_flags flag, gs_lanes a, gs_lanes b)
{
    return flag ? a : b;
}
#endif
