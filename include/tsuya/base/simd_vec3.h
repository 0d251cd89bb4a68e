// SPDX-License-Identifier: Apache-2.0
// A vector of three in one register, for the few places where hundreds of them are worth it: SSE, or plain floats.
// Every operation is the one of math.h to the bit; the fourth lane means nothing. TY_SIMD_PORTABLE forces plain floats.
#pragma once
#include <tsuya/base/math.h>

#if defined(__SSE4_1__) && !defined(TY_SIMD_PORTABLE)
#include <immintrin.h>

typedef __m128 ty_f4;

static inline ty_f4 ty_f4_load(const ty_vec3* v)
{
    __m128 xy = _mm_castsi128_ps(_mm_loadl_epi64((const __m128i*)(const void*)v));
    return _mm_insert_ps(xy, _mm_load_ss(&v->z), 0x20);
}
static inline void ty_f4_store(ty_vec3* v, ty_f4 a)
{
    _mm_storel_epi64((__m128i*)(void*)v, _mm_castps_si128(a));
    _mm_store_ss(&v->z, _mm_movehl_ps(a, a));
}
static inline ty_f4 ty_f4_set(float a)
{
    return _mm_set1_ps(a);
}
static inline ty_f4 ty_f4_xxx(ty_f4 a)
{
    return _mm_shuffle_ps(a, a, _MM_SHUFFLE(0, 0, 0, 0));
}
static inline ty_f4 ty_f4_yyy(ty_f4 a)
{
    return _mm_shuffle_ps(a, a, _MM_SHUFFLE(1, 1, 1, 1));
}
static inline ty_f4 ty_f4_zzz(ty_f4 a)
{
    return _mm_shuffle_ps(a, a, _MM_SHUFFLE(2, 2, 2, 2));
}
static inline ty_f4 ty_f4_yzx(ty_f4 a)
{
    return _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 0, 2, 1));
}
static inline float ty_f4_x(ty_f4 a)
{
    return _mm_cvtss_f32(a);
}
static inline ty_f4 ty_f4_add(ty_f4 a, ty_f4 b)
{
    return _mm_add_ps(a, b);
}
static inline ty_f4 ty_f4_sub(ty_f4 a, ty_f4 b)
{
    return _mm_sub_ps(a, b);
}
static inline ty_f4 ty_f4_mul(ty_f4 a, ty_f4 b)
{
    return _mm_mul_ps(a, b);
}
static inline ty_f4 ty_f4_abs(ty_f4 a)
{
    return _mm_andnot_ps(_mm_set1_ps(-0.0f), a);
}
// a > b ? a : b
static inline ty_f4 ty_f4_max(ty_f4 a, ty_f4 b)
{
    return _mm_max_ps(a, b);
}

#else

typedef ty_vec3 ty_f4;

static inline ty_f4 ty_f4_load(const ty_vec3* v)
{
    return *v;
}
static inline void ty_f4_store(ty_vec3* v, ty_f4 a)
{
    *v = a;
}
static inline ty_f4 ty_f4_set(float a)
{
    return (ty_f4){a, a, a};
}
static inline ty_f4 ty_f4_xxx(ty_f4 a)
{
    return (ty_f4){a.x, a.x, a.x};
}
static inline ty_f4 ty_f4_yyy(ty_f4 a)
{
    return (ty_f4){a.y, a.y, a.y};
}
static inline ty_f4 ty_f4_zzz(ty_f4 a)
{
    return (ty_f4){a.z, a.z, a.z};
}
static inline ty_f4 ty_f4_yzx(ty_f4 a)
{
    return (ty_f4){a.y, a.z, a.x};
}
static inline float ty_f4_x(ty_f4 a)
{
    return a.x;
}
static inline ty_f4 ty_f4_add(ty_f4 a, ty_f4 b)
{
    return ty_add(a, b);
}
static inline ty_f4 ty_f4_sub(ty_f4 a, ty_f4 b)
{
    return ty_sub(a, b);
}
static inline ty_f4 ty_f4_mul(ty_f4 a, ty_f4 b)
{
    return ty_mul3(a, b);
}
static inline ty_f4 ty_f4_abs(ty_f4 a)
{
    return (ty_f4){fabsf(a.x), fabsf(a.y), fabsf(a.z)};
}
static inline ty_f4 ty_f4_max(ty_f4 a, ty_f4 b)
{
    return ty_max3(a, b);
}
#endif

// a + b s
static inline ty_f4 ty_f4_mad(ty_f4 a, ty_f4 b, ty_f4 s)
{
    return ty_f4_add(a, ty_f4_mul(b, s));
}
static inline float ty_f4_dot(ty_f4 a, ty_f4 b)
{
    ty_f4 m = ty_f4_mul(a, b);
    return ty_f4_x(ty_f4_add(ty_f4_add(m, ty_f4_yyy(m)), ty_f4_zzz(m)));
}
static inline ty_f4 ty_f4_cross(ty_f4 a, ty_f4 b)
{
    return ty_f4_yzx(ty_f4_sub(ty_f4_mul(a, ty_f4_yzx(b)), ty_f4_mul(ty_f4_yzx(a), b)));
}
static inline float ty_f4_largest(ty_f4 a)
{
    return ty_f4_x(ty_f4_max(a, ty_f4_max(ty_f4_yyy(a), ty_f4_zzz(a))));
}

// The linear part of an affine map, by columns.
typedef struct ty_f4_columns
{
    ty_f4 x, y, z;
} ty_f4_columns;

static inline ty_f4_columns ty_f4_columns_of(const ty_affine* m)
{
    return (ty_f4_columns){ty_f4_load(&m->x), ty_f4_load(&m->y), ty_f4_load(&m->z)};
}
static inline ty_f4 ty_f4_map_vector(const ty_f4_columns* m, ty_f4 v)
{
    ty_f4 xy = ty_f4_mad(ty_f4_mul(m->x, ty_f4_xxx(v)), m->y, ty_f4_yyy(v));
    return ty_f4_mad(xy, m->z, ty_f4_zzz(v));
}
