// SPDX-License-Identifier: Apache-2.0
// Affine maps, quaternions and mapped bounds.
#include <tsuya/base/math.h>

ty_affine ty_affine_multiply(const ty_affine* a, const ty_affine* b)
{
    return (ty_affine){ty_map_vector(a, b->x), ty_map_vector(a, b->y), ty_map_vector(a, b->z), ty_map_point(a, b->t)};
}

typedef struct dvec3
{
    double x, y, z;
} dvec3;

static dvec3 cross_double(ty_vec3 a, ty_vec3 b)
{
    return (dvec3){(double)a.y * b.z - (double)a.z * b.y, (double)a.z * b.x - (double)a.x * b.z,
                   (double)a.x * b.y - (double)a.y * b.x};
}

static double dot_double(dvec3 a, ty_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double length_double(ty_vec3 a)
{
    return sqrt((double)a.x * a.x + (double)a.y * a.y + (double)a.z * a.z);
}

static ty_vec3 scaled(double x, double y, double z, double s)
{
    return (ty_vec3){(float)(x * s), (float)(y * s), (float)(z * s)};
}

bool ty_affine_invert(const ty_affine* m, ty_affine* inverse)
{
    // The rows of the inverse are the cross products of the columns over the determinant.
    dvec3 yz = cross_double(m->y, m->z), zx = cross_double(m->z, m->x), xy = cross_double(m->x, m->y);
    double determinant = dot_double(yz, m->x);
    double volume = length_double(m->x) * length_double(m->y) * length_double(m->z);
    // Relative to the box of the columns, below what float columns can hold the volume is noise. NaN fails, too.
    if (!(fabs(determinant) > 1e-7 * volume) || !ty_is_finite3(m->t))
        return false;
    double s = 1.0 / determinant;
    ty_affine result = {scaled(yz.x, zx.x, xy.x, s), scaled(yz.y, zx.y, xy.y, s), scaled(yz.z, zx.z, xy.z, s), m->t};
    result.t = scaled(dot_double(yz, m->t), dot_double(zx, m->t), dot_double(xy, m->t), -s);
    if (!ty_is_finite3(result.x) || !ty_is_finite3(result.y) || !ty_is_finite3(result.z) || !ty_is_finite3(result.t))
        return false;
    *inverse = result;
    return true;
}

ty_affine ty_affine_from_trs(ty_vec3 translation, ty_quat rotation, ty_vec3 scale)
{
    return (ty_affine){ty_quat_rotate(rotation, (ty_vec3){scale.x, 0, 0}),
                       ty_quat_rotate(rotation, (ty_vec3){0, scale.y, 0}),
                       ty_quat_rotate(rotation, (ty_vec3){0, 0, scale.z}), translation};
}

ty_affine ty_affine_look_at(ty_vec3 position, ty_vec3 target, ty_vec3 up)
{
    ty_vec3 z = ty_normalize(ty_sub(position, target));
    if (ty_length_sqr(z) == 0.0f)
        z = (ty_vec3){0, 0, 1};
    ty_vec3 x = ty_cross(ty_normalize(up), z);
    // Looking along up: any horizon does.
    x = ty_length_sqr(x) > 1e-12f ? ty_normalize(x) : ty_frame_from_normal(z).t;
    return (ty_affine){x, ty_cross(z, x), z, position};
}

ty_quat ty_quat_axis_angle(ty_vec3 unit_axis, float angle)
{
    float s, c;
    ty_sincos(0.5f * angle, &s, &c);
    return (ty_quat){unit_axis.x * s, unit_axis.y * s, unit_axis.z * s, c};
}

ty_quat ty_quat_euler(ty_vec3 xyz)
{
    ty_quat x = ty_quat_axis_angle((ty_vec3){1, 0, 0}, xyz.x);
    ty_quat y = ty_quat_axis_angle((ty_vec3){0, 1, 0}, xyz.y);
    ty_quat z = ty_quat_axis_angle((ty_vec3){0, 0, 1}, xyz.z);
    return ty_quat_multiply(z, ty_quat_multiply(y, x));
}

ty_vec3 ty_quat_rotate(ty_quat q, ty_vec3 v)
{
    // v + 2 w (u x v) + 2 u x (u x v)
    ty_vec3 u = {q.x, q.y, q.z}, c = ty_mul(ty_cross(u, v), 2.0f);
    return ty_add(ty_mad(v, c, q.w), ty_cross(u, c));
}

ty_quat ty_quat_from_columns(ty_vec3 x, ty_vec3 y, ty_vec3 z)
{
    // Shepperd 1978: divide by the largest component.
    float trace = x.x + y.y + z.z;
    ty_quat q;
    if (trace > 0.0f)
        q = (ty_quat){y.z - z.y, z.x - x.z, x.y - y.x, 1.0f + trace};
    else if (x.x >= y.y && x.x >= z.z)
        q = (ty_quat){1.0f + x.x - y.y - z.z, x.y + y.x, z.x + x.z, y.z - z.y};
    else if (y.y >= z.z)
        q = (ty_quat){x.y + y.x, 1.0f - x.x + y.y - z.z, y.z + z.y, z.x - x.z};
    else
        q = (ty_quat){z.x + x.z, y.z + z.y, 1.0f - x.x - y.y + z.z, x.y - y.x};
    return ty_quat_normalize(q);
}

ty_quat ty_quat_uniform(float u1, float u2, float u3)
{
    float a = ty_safe_sqrt(1.0f - u1), b = ty_safe_sqrt(u1), s2, c2, s3, c3;
    ty_sincos(2.0f * TY_PI * u2, &s2, &c2);
    ty_sincos(2.0f * TY_PI * u3, &s3, &c3);
    return (ty_quat){a * s2, a * c2, b * s3, b * c3};
}

ty_bounds ty_bounds_map(const ty_affine* m, ty_bounds b)
{
    if (b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z)
        return ty_bounds_empty();
    // Arvo 1990: each column adds its smaller product to the low corner and its larger to the high one.
    ty_bounds out = {m->t, m->t};
    const ty_vec3 columns[3] = {m->x, m->y, m->z};
    const float low[3] = {b.low.x, b.low.y, b.low.z}, high[3] = {b.high.x, b.high.y, b.high.z};
    for (int i = 0; i < 3; i++)
    {
        ty_vec3 p = ty_mul(columns[i], low[i]), q = ty_mul(columns[i], high[i]);
        out.low = ty_add(out.low, ty_min3(p, q));
        out.high = ty_add(out.high, ty_max3(p, q));
    }
    return out;
}
