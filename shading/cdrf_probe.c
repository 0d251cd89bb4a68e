// SPDX-License-Identifier: Apache-2.0
// `evaluate: probe`: the kernel on the osculating sphere, brought back to the surface by a ray from outside.
#include "curvature_at.h"
#include "lobes.h"
#include "material_private.h"
#include <tsuya/shading/cdrf.h>

// Cosine between n and n' under the Henyey-Greenstein function, the Poisson kernel of the sphere. drop = 1 - g.
static float sample_poisson(float drop, float u)
{
    float g = 1.0f - drop;
    if (g < 1e-3f)
        return 2.0f * u - 1.0f;
    float s = drop * (1.0f + g) / (drop + 2.0f * g * u);
    return ty_clamp((1.0f + g * g - s * s) / (2.0f * g), -1.0f, 1.0f);
}

// Its density over directions, times 4 pi, by 1 - cosine.
static float poisson_density(float drop, float versine)
{
    float g = 1.0f - drop, d = drop * drop + 2.0f * g * versine;
    return drop * (1.0f + g) / (d * sqrtf(d));
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
static float gaussian_concentration(float sigma)
{
    float m = 1.0f - 2.0f * ty_cdrf_share_below(TY_CDRF_GAUSSIAN, sigma);
    return m > 1e-3f ? concentration(m) : 0.0f;
}

static float sample_gaussian(float k, float u)
{
    if (k <= 0.0f)
        return 2.0f * u - 1.0f;
    return ty_clamp(1.0f + ty_ln(1.0f - u + u * ty_exp(-2.0f * k)) / k, -1.0f, 1.0f);
}

static float gaussian_density(float k, float versine)
{
    return k > 0.0f ? 2.0f * k * ty_exp(-k * versine) / (1.0f - ty_exp(-2.0f * k)) : 1.0f;
}

// --- the kernel about one point ---

typedef struct kernel
{
    bool poisson, flat;
    float spread[3]; // by channel: depth on a plane; 1 - e^-t; concentration
} kernel;

// Nearly flat or hollow: the planar limit of the kernel, a radius r with density d r / (r^2 + d^2)^(3/2).
static kernel kernel_at(const ty_bsdf* b, float curvature)
{
    const float* l = b->mean_free_path;
    kernel k = {.poisson = b->material->cdrf.kernel == TY_CDRF_POISSON,
                .flat = curvature * ty_max(l[0], ty_max(l[1], l[2])) < 0.02f};
    int count = b->grey ? 1 : 3;
    for (int i = 0; i < count; i++)
    {
        float spread = ty_cdrf_spread(b, curvature, i);
        k.spread[i] = k.flat ? l[i] * (4.0f / 3.0f) : k.poisson ? spread : gaussian_concentration(spread);
    }
    return k;
}

static float kernel_sample(const kernel* k, int channel, float u)
{
    float s = k->spread[channel], rest = 1.0f - u;
    if (k->flat)
        return s * ty_safe_sqrt(1.0f / (rest * rest) - 1.0f);
    return k->poisson ? sample_poisson(s, u) : sample_gaussian(s, u);
}

static float kernel_density(const kernel* k, int channel, float x)
{
    float s = k->spread[channel], r = x * x + s * s;
    if (k->flat)
        return s / ty_max(r * sqrtf(r), 1e-30f);
    return k->poisson ? poisson_density(s, 1.0f - x) : gaussian_density(s, 1.0f - x);
}

// A radius or a cosine for all channels: of one that is chosen, weighted by the balance heuristic.
static float kernel_choose(const kernel* k, bool grey, float u, ty_rgb* weight)
{
    if (grey)
        return kernel_sample(k, 0, u);
    int chosen = (int)ty_min(u * 3.0f, 2.5f);
    float x = kernel_sample(k, chosen, ty_min(u * 3.0f - (float)chosen, TY_ONE_MINUS_EPSILON));
    float p[3] = {kernel_density(k, 0, x), kernel_density(k, 1, x), kernel_density(k, 2, x)};
    float sum = p[0] + p[1] + p[2];
    if (sum > 0.0f)
        *weight = ty_rgb_mul(*weight, ty_rgb_scale(ty_rgb_make(p[0], p[1], p[2]), 3.0f / sum));
    return x;
}

// --- the way ---

void ty_probe_prepare(const ty_shading_context* context, ty_bsdf* b)
{
    ty_frame f = ty_frame_from_normal(b->point.ns);
    ty_form form = ty_form_world(context->world, &b->point, f.t, f.b);
    b->second_form[0] = form.tt;
    b->second_form[1] = form.tb;
    b->second_form[2] = form.bb;
    b->curvature =
        b->material->cdrf.curvature == TY_CDRF_CURVATURE_MAXIMAL ? ty_form_maximum(form) : ty_form_mean(form);
}

// Where the probe starts, and the outward direction it comes from. False = from a plane, straight.
static bool probe_start(const ty_bsdf* b, const float u[3], ty_vec3* y, ty_vec3* outward, ty_rgb* weight)
{
    ty_vec3 n = b->point.ns;
    ty_frame frame = ty_frame_from_normal(n);
    float curvature = b->curvature, sine, cosine;
    ty_sincos(2.0f * TY_PI * u[1], &sine, &cosine);
    if (b->material->cdrf.curvature == TY_CDRF_CURVATURE_DIRECTIONAL)
        curvature = ty_form_towards((ty_form){b->second_form[0], b->second_form[1], b->second_form[2]}, cosine, sine);
    kernel k = kernel_at(b, curvature);
    float x = kernel_choose(&k, b->grey, u[0], weight);
    if (k.flat)
    {
        *outward = n;
        *y = ty_add(b->point.position, ty_add(ty_mul(frame.t, x * cosine), ty_mul(frame.b, x * sine)));
        return false;
    }
    float s = ty_safe_sqrt(1.0f - x * x);
    *outward = ty_normalize(ty_to_world(frame, ty_vec3_make(s * cosine, s * sine, x)));
    *y = ty_mad(b->point.position, ty_sub(*outward, n), 1.0f / curvature);
    return true;
}

bool ty_cdrf_probe_exit(const ty_shading_context* context, const ty_bsdf* b, const float u[3], ty_rgb* weight,
                        ty_surface_point* exit)
{
    const ty_surface_point* x = &b->point;
    const ty_mesh* mesh = ty_world_mesh(context->world, x->object, x->instance);
    ty_affine to_world = ty_world_to_world(context->world, x->object, x->instance, x->time);
    ty_bounds box = ty_bounds_map(&to_world, mesh->bounds);
    ty_vec3 outward, y;
    bool curved = probe_start(b, u, &y, &outward, weight);
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
    return curved;
}
