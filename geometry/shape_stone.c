// SPDX-License-Identifier: Apache-2.0
// Weathered stones: a ball cut by planes that run into one another, and a hewn block, with relief at four scales.
#include "shape_build.h"
#include <tsuya/base/noise.h>
#include <tsuya/base/rng.h>

enum
{
    PLANES = 14,
};

typedef struct cut
{
    ty_vec3 n;
    float height; // of the plane over the middle
} cut;

// Directions by the golden angle, moved by chance: faces of unlike sizes, none missing.
static void cuts_make(cut cuts[PLANES], uint32_t seed)
{
    ty_rng rng = ty_rng_make((ty_seed){seed}, 0x73746f6e, 0);
    for (int i = 0; i < PLANES; i++)
    {
        float y = 1.0f - 2.0f * ((float)i + 0.5f) / PLANES, sine, cosine;
        ty_sincos(2.39996323f * (float)i, &sine, &cosine);
        float r = ty_safe_sqrt(1.0f - y * y);
        ty_vec3 n = {r * cosine, y, r * sine};
        n.x += ty_rng_range(&rng, -0.35f, 0.35f);
        n.y += ty_rng_range(&rng, -0.35f, 0.35f);
        n.z += ty_rng_range(&rng, -0.35f, 0.35f);
        cuts[i] = (cut){ty_normalize(n), ty_rng_range(&rng, 0.72f, 0.98f)};
    }
}

// How far the surface is in direction d: the ball and the planes as a soft minimum (a power mean), then the relief.
static float radius_at(const cut cuts[PLANES], ty_vec3 d, float relief, uint32_t seed)
{
    float sum = 1.0f;
    for (int i = 0; i < PLANES; i++)
    {
        float along = ty_dot(d, cuts[i].n) / cuts[i].height;
        sum += along > 0.0f ? ty_pow(along, 14.0f) : 0.0f;
    }
    float faceted = ty_pow(sum, -1.0f / 14.0f), bumps = 0.0f, size = 1.0f;
    for (uint32_t octave = 0; octave < 4; octave++, size *= 2.3f)
        bumps += ty_value_noise(ty_mul(d, 1.7f * size), seed + octave) / size;
    float share = ty_min(relief / 0.15f, 1.0f); // without relief it is the ball
    return ty_lerp(1.0f, faceted, share) * (1.0f + 0.6f * relief * bumps);
}

static void finish(ty_mesh* mesh)
{
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_curvature(mesh, 1);
}

void ty_shape_bend_stone(const ty_shape_def* def, ty_mesh* mesh)
{
    cut cuts[PLANES];
    uint32_t seed = (uint32_t)def->variant;
    cuts_make(cuts, seed);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        ty_vec3 d = mesh->positions[v];
        mesh->positions[v] = ty_mul3(ty_mul(d, radius_at(cuts, d, def->relief, seed)), def->size);
    }
    finish(mesh);
}

// --- a hewn block ---

// The ball of the norm |x|^p + |y|^p + |z|^p, which is a cube with round edges, the rounder the less p is.
static float cube_radius(ty_vec3 d, float p)
{
    float most = ty_max(fabsf(d.x), ty_max(fabsf(d.y), fabsf(d.z)));
    ty_vec3 q = ty_mul(d, 1.0f / most);
    return 1.0f / (most * ty_pow(ty_pow(fabsf(q.x), p) + ty_pow(fabsf(q.y), p) + ty_pow(fabsf(q.z), p), 1.0f / p));
}

void ty_shape_bend_block(const ty_shape_def* def, ty_mesh* mesh)
{
    uint32_t seed = (uint32_t)def->variant + 77u;
    float least = ty_min(def->size.x, ty_min(def->size.y, def->size.z));
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        ty_vec3 d = mesh->positions[v];
        // Some edges are worn more than others.
        float worn = ty_clamp(0.4f + 1.2f * ty_value_noise(ty_mul(d, 2.3f), seed + 9u), 0.0f, 1.0f);
        float p = ty_lerp(40.0f, 7.0f, worn * ty_min(def->relief / 0.1f, 1.0f)), bumps = 0.0f, size = 1.0f;
        ty_vec3 at = ty_mul3(ty_mul(d, cube_radius(d, p)), def->size);
        for (uint32_t octave = 0; octave < 4; octave++, size *= 2.3f)
            bumps += ty_value_noise(ty_mul(at, 1.1f * size / least), seed + octave) / size;
        mesh->positions[v] = ty_mad(at, d, 0.35f * def->relief * least * bumps);
    }
    finish(mesh);
}
