// SPDX-License-Identifier: Apache-2.0
// Affine maps as translation, rotation and scale.
#include "placement.h"
#include <string.h>

typedef struct columns
{
    double c[3][3]; // c[column][row]
} columns;

static columns columns_of(const ty_affine* m)
{
    return (columns){{{m->x.x, m->x.y, m->x.z}, {m->y.x, m->y.y, m->y.z}, {m->z.x, m->z.y, m->z.z}}};
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double determinant(const columns* m)
{
    const double *x = m->c[0], *y = m->c[1], *z = m->c[2];
    return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
}

bool ty_placement_is_regular(const ty_affine* m)
{
    if (!ty_is_finite3(m->x) || !ty_is_finite3(m->y) || !ty_is_finite3(m->z) || !ty_is_finite3(m->t))
        return false;
    columns c = columns_of(m);
    double longest = sqrt(fmax(dot(c.c[0], c.c[0]), fmax(dot(c.c[1], c.c[1]), dot(c.c[2], c.c[2]))));
    return fabs(determinant(&c)) > 1e-30 * longest * longest * longest;
}

ty_affine ty_placement_compose(const ty_placement* p)
{
    double x = p->rotation.x, y = p->rotation.y, z = p->rotation.z, w = p->rotation.w;
    // Dividing by the squared length makes the matrix a rotation though the quaternion is unit to float rounding only.
    double s = 2.0 / (x * x + y * y + z * z + w * w);
    double sx = p->scale.x, sy = p->scale.y, sz = p->scale.z;
    return (ty_affine){{(float)(sx * (1.0 - s * (y * y + z * z))), (float)(sx * s * (x * y + z * w)),
                        (float)(sx * s * (x * z - y * w))},
                       {(float)(sy * s * (x * y - z * w)), (float)(sy * (1.0 - s * (x * x + z * z))),
                        (float)(sy * s * (y * z + x * w))},
                       {(float)(sz * s * (x * z + y * w)), (float)(sz * s * (y * z - x * w)),
                        (float)(sz * (1.0 - s * (x * x + y * y)))},
                       p->translation};
}

// Quaternion of a rotation matrix by its largest component (Shepperd 1978), w >= 0.
static ty_quat quaternion_of(const columns* r)
{
    double m00 = r->c[0][0], m11 = r->c[1][1], m22 = r->c[2][2];
    double m10 = r->c[0][1], m20 = r->c[0][2], m01 = r->c[1][0], m21 = r->c[1][2], m02 = r->c[2][0], m12 = r->c[2][1];
    double q[4]; // x y z w
    double four[4] = {1 + m00 - m11 - m22, 1 - m00 + m11 - m22, 1 - m00 - m11 + m22, 1 + m00 + m11 + m22};
    int k = 3;
    for (int i = 0; i < 3; i++)
        k = four[i] > four[k] ? i : k;
    switch (k)
    {
    case 0:
        memcpy(q, (double[4]){four[0], m10 + m01, m02 + m20, m21 - m12}, sizeof q);
        break;
    case 1:
        memcpy(q, (double[4]){m10 + m01, four[1], m21 + m12, m02 - m20}, sizeof q);
        break;
    case 2:
        memcpy(q, (double[4]){m02 + m20, m21 + m12, four[2], m10 - m01}, sizeof q);
        break;
    default:
        memcpy(q, (double[4]){m21 - m12, m02 - m20, m10 - m01, four[3]}, sizeof q);
        break;
    }
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    length = q[3] < 0.0 ? -length : length;
    return (ty_quat){(float)(q[0] / length), (float)(q[1] / length), (float)(q[2] / length), (float)(q[3] / length)};
}

// A length within rounding of one is one: rigid maps keep exact scales.
static float rounded_scale(double length)
{
    return fabs(length - 1.0) < 1e-6 ? 1.0f : (float)length;
}

// One splitting: lengths of the columns, and the rotation of the columns made orthonormal in order.
static void split_once(const ty_affine* m, ty_placement* out)
{
    columns c = columns_of(m);
    double length[3];
    for (int i = 0; i < 3; i++)
        length[i] = sqrt(dot(c.c[i], c.c[i]));
    float mirror = determinant(&c) < 0.0 ? -1.0f : 1.0f;
    out->translation = m->t;
    out->scale = (ty_vec3){mirror * rounded_scale(length[0]), rounded_scale(length[1]), rounded_scale(length[2])};
    length[0] *= mirror;
    for (int k = 0; k < 3; k++)
    {
        c.c[0][k] /= length[0];
        c.c[1][k] /= length[1];
    }
    double along = dot(c.c[0], c.c[1]);
    for (int k = 0; k < 3; k++)
        c.c[1][k] -= along * c.c[0][k];
    double rest = sqrt(dot(c.c[1], c.c[1]));
    for (int k = 0; k < 3; k++)
        c.c[1][k] /= rest;
    for (int k = 0; k < 3; k++)
    {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        c.c[2][k] = c.c[0][a] * c.c[1][b] - c.c[0][b] * c.c[1][a];
    }
    out->rotation = quaternion_of(&c);
}

static bool is_sheared(const ty_affine* m)
{
    columns c = columns_of(m);
    for (int i = 0; i < 3; i++)
    {
        const double *a = c.c[i], *b = c.c[(i + 1) % 3];
        if (fabs(dot(a, b)) > 1e-6 * sqrt(dot(a, a) * dot(b, b)))
            return true;
    }
    return false;
}

static void step(ty_placement* p)
{
    ty_affine m = ty_placement_compose(p);
    split_once(&m, p);
}

// Splitting what was put together may move the last bits again and again. The sequence ends in a cycle, mostly of
// length one; its least member (as bytes) is the same wherever one begins. Brent's cycle finding; false when it is
// long.
static bool settle(ty_placement* p)
{
    const int most = 1 << 14;
    ty_placement anchor = *p;
    int length = 0;
    for (int i = 1, next_anchor = 1; i <= most; i++)
    {
        step(p);
        length++;
        if (memcmp(p, &anchor, sizeof anchor) == 0)
            break;
        if (i == most)
            return false;
        if (length == next_anchor)
        {
            anchor = *p;
            next_anchor *= 2;
            length = 0;
        }
    }
    ty_placement least = *p;
    for (int i = 1; i < length; i++)
    {
        step(p);
        if (memcmp(p, &least, sizeof least) < 0)
            least = *p;
    }
    *p = least;
    return true;
}

bool ty_placement_split(const ty_affine* m, ty_placement* out)
{
    memset(out, 0, sizeof *out); // compared as bytes
    split_once(m, out);
    return !is_sheared(m) && settle(out);
}
