// SPDX-License-Identifier: Apache-2.0
// Vectors, colours, quaternions, affine maps, bounds, and elementary functions that give the same bits on every CPU.
#pragma once
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define TY_PI 3.14159265358979f
#define TY_INV_PI 0.318309886183791f
#define TY_FLOAT_MAX 3.402823466e38f
#define TY_ONE_MINUS_EPSILON 0x1.fffffep-1f

typedef struct ty_vec2
{
    float x, y;
} ty_vec2;

typedef struct ty_vec3
{
    float x, y, z;
} ty_vec3;

typedef struct ty_rgb
{
    float r, g, b;
} ty_rgb;

typedef struct ty_quat
{
    float x, y, z, w;
} ty_quat;

// Columns x, y, z of the linear part and the translation: p' = x*p.x + y*p.y + z*p.z + t.
typedef struct ty_affine
{
    ty_vec3 x, y, z, t;
} ty_affine;

typedef struct ty_bounds
{
    ty_vec3 low, high;
} ty_bounds;

// An orthonormal frame; n is the normal.
typedef struct ty_frame
{
    ty_vec3 t, b, n;
} ty_frame;

// --- elementary functions: no FMA, no library variant picked by CPU; errors below 3 ulp in the ranges named ---
float ty_sin(float x); // |x| <= 1e4
float ty_cos(float x); // |x| <= 1e4
void ty_sincos(float x, float* sine, float* cosine);
float ty_exp(float x);          // saturates to 0 and FLT_MAX
float ty_ln(float x);           // natural logarithm, x > 0; 0 gives -TY_FLOAT_MAX
float ty_pow(float x, float y); // x >= 0; relative error below 1e-5
float ty_acos(float x);         // clamps to [-1, 1]
float ty_atan2(float y, float x);
float ty_erf(float x);

// --- scalars ---
static inline float ty_min(float a, float b)
{
    return a < b ? a : b;
}
static inline float ty_max(float a, float b)
{
    return a > b ? a : b;
}
static inline float ty_clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}
static inline float ty_lerp(float a, float b, float s)
{
    return a + (b - a) * s;
}
// Cubic from 0 to 1 that is flat at both ends; t in 0..1.
static inline float ty_smoothstep(float t)
{
    return t * t * (3.0f - 2.0f * t);
}
static inline float ty_sqr(float x)
{
    return x * x;
}
static inline float ty_safe_sqrt(float x)
{
    return x > 0.0f ? sqrtf(x) : 0.0f;
}
static inline float ty_radians(float degrees)
{
    return degrees * (TY_PI / 180.0f);
}

// --- vectors ---
static inline ty_vec3 ty_vec3_make(float x, float y, float z)
{
    return (ty_vec3){x, y, z};
}
static inline ty_vec3 ty_add(ty_vec3 a, ty_vec3 b)
{
    return (ty_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline ty_vec3 ty_sub(ty_vec3 a, ty_vec3 b)
{
    return (ty_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline ty_vec3 ty_mul(ty_vec3 a, float s)
{
    return (ty_vec3){a.x * s, a.y * s, a.z * s};
}
static inline ty_vec3 ty_mul3(ty_vec3 a, ty_vec3 b)
{
    return (ty_vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}
static inline ty_vec3 ty_neg(ty_vec3 a)
{
    return (ty_vec3){-a.x, -a.y, -a.z};
}
// a + b * s
static inline ty_vec3 ty_mad(ty_vec3 a, ty_vec3 b, float s)
{
    return (ty_vec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline float ty_dot(ty_vec3 a, ty_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
// The symmetric matrix {xx, yy, zz, xy, xz, yz} times v.
static inline ty_vec3 ty_symmetric_times(const float s[6], ty_vec3 v)
{
    return (ty_vec3){s[0] * v.x + s[3] * v.y + s[4] * v.z, s[3] * v.x + s[1] * v.y + s[5] * v.z,
                     s[4] * v.x + s[5] * v.y + s[2] * v.z};
}
static inline ty_vec3 ty_cross(ty_vec3 a, ty_vec3 b)
{
    return (ty_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float ty_length_sqr(ty_vec3 a)
{
    return ty_dot(a, a);
}
static inline float ty_length(ty_vec3 a)
{
    return sqrtf(ty_dot(a, a));
}
// Zero stays zero.
static inline ty_vec3 ty_normalize(ty_vec3 a)
{
    float l = ty_length(a);
    return l > 0.0f ? ty_mul(a, 1.0f / l) : a;
}
static inline ty_vec3 ty_lerp3(ty_vec3 a, ty_vec3 b, float s)
{
    return ty_mad(a, ty_sub(b, a), s);
}
static inline ty_vec3 ty_min3(ty_vec3 a, ty_vec3 b)
{
    return (ty_vec3){ty_min(a.x, b.x), ty_min(a.y, b.y), ty_min(a.z, b.z)};
}
static inline ty_vec3 ty_max3(ty_vec3 a, ty_vec3 b)
{
    return (ty_vec3){ty_max(a.x, b.x), ty_max(a.y, b.y), ty_max(a.z, b.z)};
}
static inline bool ty_is_finite3(ty_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}
// w mirrored about n: both point away from the surface.
static inline ty_vec3 ty_reflect(ty_vec3 w, ty_vec3 n)
{
    return ty_sub(ty_mul(n, 2.0f * ty_dot(w, n)), w);
}

// --- colours ---
static inline ty_rgb ty_rgb_make(float r, float g, float b)
{
    return (ty_rgb){r, g, b};
}
static inline ty_rgb ty_rgb_grey(float v)
{
    return (ty_rgb){v, v, v};
}
static inline ty_rgb ty_rgb_add(ty_rgb a, ty_rgb b)
{
    return (ty_rgb){a.r + b.r, a.g + b.g, a.b + b.b};
}
static inline ty_rgb ty_rgb_mul(ty_rgb a, ty_rgb b)
{
    return (ty_rgb){a.r * b.r, a.g * b.g, a.b * b.b};
}
static inline ty_rgb ty_rgb_scale(ty_rgb a, float s)
{
    return (ty_rgb){a.r * s, a.g * s, a.b * s};
}
static inline ty_rgb ty_rgb_lerp(ty_rgb a, ty_rgb b, float s)
{
    return (ty_rgb){ty_lerp(a.r, b.r, s), ty_lerp(a.g, b.g, s), ty_lerp(a.b, b.b, s)};
}
// ACEScg (AP1) luminance.
static inline float ty_luminance(ty_rgb c)
{
    return 0.2722287168f * c.r + 0.6740817658f * c.g + 0.0536895174f * c.b;
}
static inline float ty_rgb_max(ty_rgb c)
{
    return ty_max(c.r, ty_max(c.g, c.b));
}
static inline bool ty_rgb_is_black(ty_rgb c)
{
    return fabsf(c.r) + fabsf(c.g) + fabsf(c.b) == 0.0f; // one comparison
}
static inline bool ty_rgb_is_finite(ty_rgb c)
{
    return isfinite(c.r) && isfinite(c.g) && isfinite(c.b);
}

// --- frames ---
// Any tangent and bitangent for a unit n (Duff et al. 2017, "Building an orthonormal basis, revisited").
static inline ty_frame ty_frame_from_normal(ty_vec3 n)
{
    float s = copysignf(1.0f, n.z), a = -1.0f / (s + n.z), b = n.x * n.y * a;
    return (ty_frame){{1.0f + s * n.x * n.x * a, s * b, -s * n.x}, {b, s + n.y * n.y * a, -n.y}, n};
}
static inline ty_vec3 ty_to_local(ty_frame f, ty_vec3 v)
{
    return (ty_vec3){ty_dot(v, f.t), ty_dot(v, f.b), ty_dot(v, f.n)};
}
static inline ty_vec3 ty_to_world(ty_frame f, ty_vec3 v)
{
    return ty_add(ty_add(ty_mul(f.t, v.x), ty_mul(f.b, v.y)), ty_mul(f.n, v.z));
}

// --- affine maps ---
static inline ty_affine ty_affine_identity(void)
{
    return (ty_affine){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
}
static inline ty_vec3 ty_map_vector(const ty_affine* m, ty_vec3 v)
{
    return ty_add(ty_add(ty_mul(m->x, v.x), ty_mul(m->y, v.y)), ty_mul(m->z, v.z));
}
static inline ty_vec3 ty_map_point(const ty_affine* m, ty_vec3 p)
{
    return ty_add(ty_map_vector(m, p), m->t);
}
// Transpose of the linear part times v: given the inverse map, this carries normals.
static inline ty_vec3 ty_map_transpose(const ty_affine* m, ty_vec3 v)
{
    return (ty_vec3){ty_dot(m->x, v), ty_dot(m->y, v), ty_dot(m->z, v)};
}
static inline float ty_affine_determinant(const ty_affine* m)
{
    return ty_dot(m->x, ty_cross(m->y, m->z));
}
ty_affine ty_affine_multiply(const ty_affine* a, const ty_affine* b); // a after b
bool ty_affine_invert(const ty_affine* m, ty_affine* inverse);        // false and *inverse untouched when singular
ty_affine ty_affine_from_trs(ty_vec3 translation, ty_quat rotation, ty_vec3 scale);
ty_affine ty_affine_look_at(ty_vec3 position, ty_vec3 target, ty_vec3 up); // camera to world, looks along -z

// --- quaternions (x y z w, unit) ---
static inline ty_quat ty_quat_identity(void)
{
    return (ty_quat){0, 0, 0, 1};
}
// a after b
static inline ty_quat ty_quat_multiply(ty_quat a, ty_quat b)
{
    return (ty_quat){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                     a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
static inline ty_quat ty_quat_normalize(ty_quat q)
{
    float length = sqrtf(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    if (!(length > 0.0f))
        return ty_quat_identity();
    float s = 1.0f / length;
    return (ty_quat){q.x * s, q.y * s, q.z * s, q.w * s};
}
ty_quat ty_quat_axis_angle(ty_vec3 unit_axis, float angle);
ty_quat ty_quat_euler(ty_vec3 xyz); // rotation about x, then y, then z (radians)
ty_vec3 ty_quat_rotate(ty_quat q, ty_vec3 v);
ty_quat ty_quat_from_columns(ty_vec3 x, ty_vec3 y, ty_vec3 z); // of a rotation matrix
ty_quat ty_quat_uniform(float u1, float u2, float u3);         // uniform over rotations (Shoemake 1992)

// --- bounds ---
static inline ty_bounds ty_bounds_empty(void)
{
    return (ty_bounds){{TY_FLOAT_MAX, TY_FLOAT_MAX, TY_FLOAT_MAX}, {-TY_FLOAT_MAX, -TY_FLOAT_MAX, -TY_FLOAT_MAX}};
}
static inline ty_bounds ty_bounds_add(ty_bounds b, ty_vec3 p)
{
    return (ty_bounds){ty_min3(b.low, p), ty_max3(b.high, p)};
}
static inline ty_bounds ty_bounds_union(ty_bounds a, ty_bounds b)
{
    return (ty_bounds){ty_min3(a.low, b.low), ty_max3(a.high, b.high)};
}
ty_bounds ty_bounds_map(const ty_affine* m, ty_bounds b); // box of the mapped box
