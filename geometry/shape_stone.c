// SPDX-License-Identifier: Apache-2.0
// A weathered stone: a ball cut by planes that run into one another, with relief at four scales.
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
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_curvature(mesh, 1);
}
