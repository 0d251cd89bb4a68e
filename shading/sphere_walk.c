// SPDX-License-Identifier: Apache-2.0
// Random walks in a sphere of radius 1: where light that enters at the pole leaves again.
#include "fresnel.h"
#include <tsuya/base/memory.h>
#include <tsuya/shading/calibrate.h>
#include <tsuya/shading/sampling.h>
#include <tsuya/shading/walk.h>

#define BLOCK 512           // walks, added up in order
#define MOST_EVENTS 1000000 // of a walk: none goes on for ever
#define LEAST_WEIGHT 1e-6f

typedef struct block_sum
{
    double moments[TY_SPHERE_DEGREES], scatterings;
} block_sum;

typedef struct walk_job
{
    const ty_sphere_walk_def* def;
    float free_path; // of the anisotropic medium, in radii
    block_sum* blocks;
} walk_job;

// From inside along d to the sphere.
static float way_out(ty_vec3 p, ty_vec3 d)
{
    float b = ty_dot(p, d);
    return ty_max(-b + ty_safe_sqrt(b * b + ty_max(1.0f - ty_dot(p, p), 0.0f)), 0.0f);
}

static bool is_reflected(float mu, float ior, ty_rng* rng)
{
    if (ior <= 1.0f)
        return false;
    return ty_rng_float(rng) < ty_fresnel(mu, 1.0f / ior); // seen from inside
}

// Weight of the walk when it leaves, and where, as the cosine to the pole.
static float walk(const walk_job* job, ty_rng* rng, float* cosine, int* scatterings)
{
    const ty_sphere_walk_def* def = job->def;
    ty_vec3 p = {0.0f, 0.0f, 1.0f};
    ty_vec3 d = ty_neg(ty_sample_cosine((ty_vec2){ty_rng_float(rng), ty_rng_float(rng)}));
    // Of the similar medium with this phase function: mu_s = mu_s' / (1 - g), the same absorption.
    float g = def->anisotropy, albedo = def->albedo / (def->albedo + (1.0f - def->albedo) * (1.0f - g)), weight = 1.0f;
    *scatterings = 0;
    for (int event = 0; event < MOST_EVENTS; event++)
    {
        float s = -job->free_path * ty_ln(1.0f - ty_rng_float(rng)), out = way_out(p, d);
        if (s < out)
        {
            p = ty_mad(p, d, s);
            weight *= albedo;
            ++*scatterings;
            if (weight < LEAST_WEIGHT)
                break;
            d = ty_phase_sample(g, d, (ty_vec2){ty_rng_float(rng), ty_rng_float(rng)});
            continue;
        }
        p = ty_normalize(ty_mad(p, d, out));
        float mu = ty_dot(p, d);
        if (!is_reflected(mu, def->ior, rng))
        {
            *cosine = p.z;
            return weight;
        }
        d = ty_normalize(ty_mad(d, p, -2.0f * mu));
    }
    *cosine = 0.0f;
    return 0.0f;
}

static void add_moments(double weight, double x, double* moments)
{
    double before = 1.0, now = x;
    moments[0] += weight;
    moments[1] += weight * x;
    for (int l = 2; l < TY_SPHERE_DEGREES; l++)
    {
        double next = ((2 * l - 1) * x * now - (l - 1) * before) / l;
        before = now;
        now = next;
        moments[l] += weight * next;
    }
}

static void run_blocks(void* context, int64_t begin, int64_t end, int worker)
{
    const walk_job* job = context;
    (void)worker;
    for (int64_t b = begin; b < end; b++)
        for (int64_t i = b * BLOCK; i < (b + 1) * BLOCK && i < job->def->walk_count; i++)
        {
            ty_rng rng = ty_rng_make(job->def->seed, 0x7370686572u, (uint64_t)i);
            float cosine;
            int scatterings;
            float weight = walk(job, &rng, &cosine, &scatterings);
            add_moments((double)weight, (double)cosine, job->blocks[b].moments);
            job->blocks[b].scatterings += scatterings;
        }
}

bool ty_sphere_walk_run(const ty_sphere_walk_def* def, ty_workers* workers, ty_sphere_walk* out)
{
    int64_t block_count = (def->walk_count + BLOCK - 1) / BLOCK;
    // 1/mu_t of the medium from that of the similar isotropic one, 1 / optical_radius.
    float g = def->anisotropy, reduced = def->albedo / (1.0f - g) + 1.0f - def->albedo;
    walk_job job = {def, 1.0f / (def->optical_radius * reduced), TY_ALLOC(block_sum, block_count)};
    bool done = ty_parallel_for(workers, block_count, 1, run_blocks, &job);
    *out = (ty_sphere_walk){0};
    for (int64_t b = 0; b < block_count; b++)
    {
        for (int l = 0; l < TY_SPHERE_DEGREES; l++)
            out->moments[l] += job.blocks[b].moments[l] / def->walk_count;
        out->mean_scatterings += job.blocks[b].scatterings / def->walk_count;
    }
    ty_free(job.blocks);
    return done;
}
