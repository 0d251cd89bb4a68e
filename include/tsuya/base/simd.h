// SPDX-License-Identifier: Apache-2.0
// Sixteen floats side by side: AVX-512, two halves of AVX2, or plain loops, by what the including file is compiled for.
// Every operation is the IEEE one, so that all three give the same bits. AVX2 counts with FMA only: files that compute
// with this are compiled with it (tsuya_use_fma). TY_SIMD_PORTABLE forces the loops.
#pragma once
#include <math.h>
#include <stdint.h>

#define TY_LANES 16

#if defined(__AVX512F__) && defined(__AVX512DQ__) && !defined(TY_SIMD_PORTABLE)
#include <immintrin.h>

typedef __m512 ty_f16;

static inline ty_f16 ty_f16_load(const float* aligned)
{
    return _mm512_load_ps(aligned);
}
static inline void ty_f16_store(float* aligned, ty_f16 a)
{
    _mm512_store_ps(aligned, a);
}
static inline ty_f16 ty_f16_set(float a)
{
    return _mm512_set1_ps(a);
}
static inline ty_f16 ty_f16_add(ty_f16 a, ty_f16 b)
{
    return _mm512_add_ps(a, b);
}
static inline ty_f16 ty_f16_sub(ty_f16 a, ty_f16 b)
{
    return _mm512_sub_ps(a, b);
}
static inline ty_f16 ty_f16_mul(ty_f16 a, ty_f16 b)
{
    return _mm512_mul_ps(a, b);
}
static inline ty_f16 ty_f16_div(ty_f16 a, ty_f16 b)
{
    return _mm512_div_ps(a, b);
}
// a * b + c, a * b - c, c - a * b, rounded once.
static inline ty_f16 ty_f16_fma(ty_f16 a, ty_f16 b, ty_f16 c)
{
    return _mm512_fmadd_ps(a, b, c);
}
static inline ty_f16 ty_f16_fms(ty_f16 a, ty_f16 b, ty_f16 c)
{
    return _mm512_fmsub_ps(a, b, c);
}
static inline ty_f16 ty_f16_fnma(ty_f16 a, ty_f16 b, ty_f16 c)
{
    return _mm512_fnmadd_ps(a, b, c);
}
static inline ty_f16 ty_f16_sqrt(ty_f16 a)
{
    return _mm512_sqrt_ps(a);
}
static inline ty_f16 ty_f16_abs(ty_f16 a)
{
    return _mm512_abs_ps(a);
}
// a < b ? a : b
static inline ty_f16 ty_f16_min(ty_f16 a, ty_f16 b)
{
    return _mm512_min_ps(a, b);
}
// a > b ? a : b
static inline ty_f16 ty_f16_max(ty_f16 a, ty_f16 b)
{
    return _mm512_max_ps(a, b);
}
// One bit a lane, the lowest for lane 0; false where either is NaN.
static inline uint32_t ty_f16_le(ty_f16 a, ty_f16 b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
}
static inline uint32_t ty_f16_lt(ty_f16 a, ty_f16 b)
{
    return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ);
}
// Where the integers are the value.
static inline uint32_t ty_u32_equal16(const uint32_t* aligned, uint32_t value)
{
    return _mm512_cmpeq_epi32_mask(_mm512_load_si512(aligned), _mm512_set1_epi32((int)value));
}

#elif defined(__AVX2__) && defined(__FMA__) && !defined(TY_SIMD_PORTABLE)
#include <immintrin.h>

typedef struct ty_f16
{
    __m256 low, high;
} ty_f16;

static inline ty_f16 ty_f16_load(const float* aligned)
{
    return (ty_f16){_mm256_load_ps(aligned), _mm256_load_ps(aligned + 8)};
}
static inline void ty_f16_store(float* aligned, ty_f16 a)
{
    _mm256_store_ps(aligned, a.low);
    _mm256_store_ps(aligned + 8, a.high);
}
static inline ty_f16 ty_f16_set(float a)
{
    return (ty_f16){_mm256_set1_ps(a), _mm256_set1_ps(a)};
}
static inline ty_f16 ty_f16_add(ty_f16 a, ty_f16 b)
{
    return (ty_f16){_mm256_add_ps(a.low, b.low), _mm256_add_ps(a.high, b.high)};
}
static inline ty_f16 ty_f16_sub(ty_f16 a, ty_f16 b)
{
    return (ty_f16){_mm256_sub_ps(a.low, b.low), _mm256_sub_ps(a.high, b.high)};
}
static inline ty_f16 ty_f16_mul(ty_f16 a, ty_f16 b)
{
    return (ty_f16){_mm256_mul_ps(a.low, b.low), _mm256_mul_ps(a.high, b.high)};
}
static inline ty_f16 ty_f16_div(ty_f16 a, ty_f16 b)
{
    return (ty_f16){_mm256_div_ps(a.low, b.low), _mm256_div_ps(a.high, b.high)};
}
static inline ty_f16 ty_f16_fma(ty_f16 a, ty_f16 b, ty_f16 c)
{
    return (ty_f16){_mm256_fmadd_ps(a.low, b.low, c.low), _mm256_fmadd_ps(a.high, b.high, c.high)};
}
static inline ty_f16 ty_f16_fms(ty_f16 a, ty_f16 b, ty_f16 c)
{
    return (ty_f16){_mm256_fmsub_ps(a.low, b.low, c.low), _mm256_fmsub_ps(a.high, b.high, c.high)};
}
static inline ty_f16 ty_f16_fnma(ty_f16 a, ty_f16 b, ty_f16 c)
{
    return (ty_f16){_mm256_fnmadd_ps(a.low, b.low, c.low), _mm256_fnmadd_ps(a.high, b.high, c.high)};
}
static inline ty_f16 ty_f16_sqrt(ty_f16 a)
{
    return (ty_f16){_mm256_sqrt_ps(a.low), _mm256_sqrt_ps(a.high)};
}
static inline ty_f16 ty_f16_abs(ty_f16 a)
{
    const __m256 sign = _mm256_set1_ps(-0.0f);
    return (ty_f16){_mm256_andnot_ps(sign, a.low), _mm256_andnot_ps(sign, a.high)};
}
static inline ty_f16 ty_f16_min(ty_f16 a, ty_f16 b)
{
    return (ty_f16){_mm256_min_ps(a.low, b.low), _mm256_min_ps(a.high, b.high)};
}
static inline ty_f16 ty_f16_max(ty_f16 a, ty_f16 b)
{
    return (ty_f16){_mm256_max_ps(a.low, b.low), _mm256_max_ps(a.high, b.high)};
}
static inline uint32_t ty_f16_le(ty_f16 a, ty_f16 b)
{
    uint32_t low = (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a.low, b.low, _CMP_LE_OQ));
    return low | (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a.high, b.high, _CMP_LE_OQ)) << 8;
}
static inline uint32_t ty_f16_lt(ty_f16 a, ty_f16 b)
{
    uint32_t low = (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a.low, b.low, _CMP_LT_OQ));
    return low | (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a.high, b.high, _CMP_LT_OQ)) << 8;
}
static inline uint32_t ty_u32_equal16(const uint32_t* aligned, uint32_t value)
{
    const __m256i *at = (const __m256i*)(const void*)aligned, all = _mm256_set1_epi32((int)value);
    __m256 low = _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_load_si256(at), all));
    __m256 high = _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_load_si256(at + 1), all));
    return (uint32_t)_mm256_movemask_ps(low) | (uint32_t)_mm256_movemask_ps(high) << 8;
}

#else

typedef struct ty_f16
{
    float lane[TY_LANES];
} ty_f16;

#define TY_F16_EACH(expression)                                                                                        \
    ty_f16 r;                                                                                                          \
    for (int i = 0; i < TY_LANES; i++)                                                                                 \
        r.lane[i] = (expression);                                                                                      \
    return r

static inline ty_f16 ty_f16_load(const float* aligned)
{
    TY_F16_EACH(aligned[i]);
}
static inline void ty_f16_store(float* aligned, ty_f16 a)
{
    for (int i = 0; i < TY_LANES; i++)
        aligned[i] = a.lane[i];
}
static inline ty_f16 ty_f16_set(float a)
{
    TY_F16_EACH(a);
}
static inline ty_f16 ty_f16_add(ty_f16 a, ty_f16 b)
{
    TY_F16_EACH(a.lane[i] + b.lane[i]);
}
static inline ty_f16 ty_f16_sub(ty_f16 a, ty_f16 b)
{
    TY_F16_EACH(a.lane[i] - b.lane[i]);
}
static inline ty_f16 ty_f16_mul(ty_f16 a, ty_f16 b)
{
    TY_F16_EACH(a.lane[i] * b.lane[i]);
}
static inline ty_f16 ty_f16_div(ty_f16 a, ty_f16 b)
{
    TY_F16_EACH(a.lane[i] / b.lane[i]);
}
static inline ty_f16 ty_f16_fma(ty_f16 a, ty_f16 b, ty_f16 c)
{
    TY_F16_EACH(fmaf(a.lane[i], b.lane[i], c.lane[i]));
}
static inline ty_f16 ty_f16_fms(ty_f16 a, ty_f16 b, ty_f16 c)
{
    TY_F16_EACH(fmaf(a.lane[i], b.lane[i], -c.lane[i]));
}
static inline ty_f16 ty_f16_fnma(ty_f16 a, ty_f16 b, ty_f16 c)
{
    TY_F16_EACH(fmaf(-a.lane[i], b.lane[i], c.lane[i]));
}
static inline ty_f16 ty_f16_sqrt(ty_f16 a)
{
    TY_F16_EACH(sqrtf(a.lane[i]));
}
static inline ty_f16 ty_f16_abs(ty_f16 a)
{
    TY_F16_EACH(fabsf(a.lane[i]));
}
static inline ty_f16 ty_f16_min(ty_f16 a, ty_f16 b)
{
    TY_F16_EACH(a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i]);
}
static inline ty_f16 ty_f16_max(ty_f16 a, ty_f16 b)
{
    TY_F16_EACH(a.lane[i] > b.lane[i] ? a.lane[i] : b.lane[i]);
}
static inline uint32_t ty_f16_le(ty_f16 a, ty_f16 b)
{
    uint32_t mask = 0;
    for (int i = 0; i < TY_LANES; i++)
        mask |= (uint32_t)(a.lane[i] <= b.lane[i]) << i;
    return mask;
}
static inline uint32_t ty_f16_lt(ty_f16 a, ty_f16 b)
{
    uint32_t mask = 0;
    for (int i = 0; i < TY_LANES; i++)
        mask |= (uint32_t)(a.lane[i] < b.lane[i]) << i;
    return mask;
}
static inline uint32_t ty_u32_equal16(const uint32_t* aligned, uint32_t value)
{
    uint32_t mask = 0;
    for (int i = 0; i < TY_LANES; i++)
        mask |= (uint32_t)(aligned[i] == value) << i;
    return mask;
}
#endif

// a * x + (b * y + c * z), each step fused.
static inline ty_f16 ty_f16_dot3(ty_f16 a, ty_f16 x, ty_f16 b, ty_f16 y, ty_f16 c, ty_f16 z)
{
    return ty_f16_fma(a, x, ty_f16_fma(b, y, ty_f16_mul(c, z)));
}
