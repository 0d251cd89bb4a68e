// SPDX-License-Identifier: Apache-2.0
// `evaluate: probe`: the kernel on the osculating sphere, brought back to the surface by a ray from outside.
#include "curvature_at.h"
#include "lobes.h"
#include "material_private.h"
#include <tsuya/shading/cdrf.h>

// Cosine between n and n' under the Henyey-Greenstein function, the Poisson kernel of the sphere.
static float sample_poisson(float t, float u)
{
    float g = ty_exp(-t);
    if (g < 1e-3f)
        return 2.0f * u - 1.0f;
    float s = (1.0f - g * g) / (1.0f - g + 2.0f * g * u);
    return ty_clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
}

// Concentration whose mean cosine coth k - 1/k is m: Cohen's approximation (1991), then Newton.
static float concentration(float m)
{
    float k = m * (3.0f - m * m) / ty_max(1.0f - m * m, 1e-6f);
    for (int i = 0; i < 3 && k > 1e-2f && k < 1e2f; i++)
    {
        float e = ty_exp(-2.0f * k), coth = (1.0f + e) / (1.0f - e), slope = 1.0f - coth * coth + 1.0f / (k * k);
        k -= (coth - 1.0f / k - m) / slope;
    }
    return k;
}

// Spherical Gaussian (von Mises-Fisher) that leaves the same share below the horizon as the wrapped Gaussian: their
// first harmonics agree.
static float sample_gaussian(float sigma, float u)
{
    float m = 1.0f - 2.0f * ty_cdrf_share_below(TY_CDRF_GAUSSIAN, sigma);
    if (m <= 1e-3f)
        return 2.0f * u - 1.0f;
    float k = concentration(m);
    return ty_clamp(1.0f + ty_ln(1.0f - u + u * ty_exp(-2.0f * k)) / k, -1.0f, 1.0f);
}

// Where the probe starts, and the outward direction it comes from.
static ty_vec3 probe_start(const ty_bsdf* b, const float u[3], ty_vec3* outward)
{
    ty_vec3 n = b->point.ns;
    ty_frame frame = ty_frame_from_normal(n);
    float k = b->curvature, sine, cosine;
    ty_sincos(2.0f * TY_PI * u[1], &sine, &cosine);
    if (k * b->mean_free_path < 0.02f)
    {
        // Nearly flat or hollow: the planar limit of the kernel, a radius with density s0 r / (r^2 + s0^2)^(3/2).
        float rest = 1.0f - u[0],
              radius = b->mean_free_path * (4.0f / 3.0f) * ty_safe_sqrt(1.0f / (rest * rest) - 1.0f);
        *outward = n;
        return ty_add(b->point.position, ty_add(ty_mul(frame.t, radius * cosine), ty_mul(frame.b, radius * sine)));
    }
    float spread = ty_cdrf_spread(b, k);
    float c =
        b->material->cdrf.kernel == TY_CDRF_POISSON ? sample_poisson(spread, u[0]) : sample_gaussian(spread, u[0]);
    float s = ty_safe_sqrt(1.0f - c * c);
    *outward = ty_normalize(ty_to_world(frame, ty_vec3_make(s * cosine, s * sine, c)));
    return ty_mad(b->point.position, ty_sub(*outward, n), 1.0f / k);
}

bool ty_cdrf_probe_exit(const ty_shading_context* context, const ty_bsdf* b, const float u[3], ty_surface_point* exit)
{
    const ty_surface_point* x = &b->point;
    const ty_mesh* mesh = ty_world_mesh(context->world, x->object, x->instance);
    ty_affine to_world = ty_world_to_world(context->world, x->object, x->instance, x->time);
    ty_bounds box = ty_bounds_map(&to_world, mesh->bounds);
    ty_vec3 outward, y = probe_start(b, u, &outward);
    // From beyond the far side of the box, through it.
    float size = ty_length(ty_sub(box.high, box.low)), start = size + ty_length(ty_sub(y, x->position));
    ty_hit hit;
    if (ty_world_intersect_instance(context->world, x->object, x->instance, x->time, ty_mad(y, outward, start),
                                    ty_neg(outward), 2.0f * start, &hit))
    {
        hit.object = x->object;
        hit.instance = x->instance;
        ty_world_surface(context->world, &hit, exit);
        return true;
    }
    // Past the object: light is gathered at x as if the surface stood there with the other normal.
    *exit = *x;
    exit->ns = outward;
    return b->curvature * b->mean_free_path >= 0.02f;
}
