// SPDX-License-Identifier: Apache-2.0
// What thin films add to what rough dielectrics reflect in all: for the light that goes on beneath them.
#include "fresnel.h"
#include "microfacet.h"
#include "thin_film.h"
#include <tsuya/base/memory.h>

enum
{
    MU_NODES = 32, // at mu = (i / 31)^2, as in the tables of the layers without
    ROUGH_NODES = 16,
    FACETS = 64, // cosines at the facets, at (i / 63)^2
    RINGS = 32,
    SPOKES = 16,
    SLICE = 3 * MU_NODES
};

#define THICKNESS_STEP 0.01f // micrometres: a tenth of a fringe
#define THICKNESS_MOST 6.0f  // where all fringes have faded

struct ty_thin_film_table
{
    float roughness[2], thickness[2]; // least and most
    int rough_count, thick_count;
    float* slices;    // [thickness][roughness][MU_NODES][3]
    ty_rgb* averages; // [thickness][roughness]
};

static float node_mu(int i, int count)
{
    return ty_max(ty_sqr((float)i / (float)(count - 1)), 1e-5f);
}

static float node_of(const float range[2], int i, int count)
{
    return count > 1 ? ty_lerp(range[0], range[1], (float)i / (float)(count - 1)) : range[0];
}

// Puts a facet's part between the two nodes next to its cosine.
static void add_facet(float shares[FACETS], float cosine, float part)
{
    float s = sqrtf(ty_clamp(cosine, 0.0f, 1.0f)) * (FACETS - 1);
    int i = (int)s < FACETS - 1 ? (int)s : FACETS - 2;
    shares[i] += part * (1.0f - (s - (float)i));
    shares[i + 1] += part * (s - (float)i);
}

// By how much the facets at each cosine take part in what is reflected from mu.
static void facet_shares(float mu, float alpha, float shares[FACETS])
{
    ty_vec3 wo = ty_vec3_make(ty_safe_sqrt(1.0f - mu * mu), 0.0f, mu);
    ty_vec2 a = ty_ggx_round(alpha);
    for (int i = 0; i < FACETS; i++)
        shares[i] = 0.0f;
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < SPOKES; i++)
        {
            ty_vec2 u = {0.5f * ((float)i + 0.5f) / SPOKES, ((float)j + 0.5f) / RINGS};
            ty_vec3 h = ty_ggx_sample(wo, a, u), wi = ty_reflect(wo, h);
            if (wi.z > 0.0f)
                add_facet(shares, ty_dot(wo, h),
                          ty_ggx_g2(wo, wi, a) / (ty_ggx_g1(wo, a) * (float)RINGS * (float)SPOKES));
        }
}

static ty_rgb gain(const ty_thin_film* film, float cosine, float shine)
{
    return ty_rgb_add(ty_thin_film_over_dielectric(film, cosine, shine), ty_rgb_grey(-ty_fresnel(cosine, shine)));
}

// 2 * integral of E mu dmu = 4 * integral of E(s) s^3 ds with mu = s^2, exactly for what is linear between nodes.
static ty_rgb average(const float* slice)
{
    ty_rgb sum = {0};
    const float h = 1.0f / (MU_NODES - 1), h4 = h * h * h * h;
    for (int i = 0; i + 1 < MU_NODES; i++)
    {
        float x = (float)i, cubed = 1.0f / 4.0f + x * (1.0f + x * (1.5f + x)), // integral of s^3
            rising = 1.0f / 5.0f + x * (3.0f / 4.0f + x * (1.0f + 0.5f * x));  // of (s - i) s^3
        float w0 = 4.0f * h4 * (cubed - rising), w1 = 4.0f * h4 * rising;
        const float *v0 = slice + 3 * i, *v1 = v0 + 3;
        sum = ty_rgb_add(sum, ty_rgb_make(w0 * v0[0] + w1 * v1[0], w0 * v0[1] + w1 * v1[1], w0 * v0[2] + w1 * v1[2]));
    }
    return sum;
}

static void fill_slice(const float (*shares)[FACETS], const ty_rgb facets[FACETS], float* slice)
{
    for (int m = 0; m < MU_NODES; m++)
    {
        ty_rgb sum = {0};
        for (int i = 0; i < FACETS; i++)
            sum = ty_rgb_add(sum, ty_rgb_scale(facets[i], shares[m][i]));
        slice[3 * m] = sum.r;
        slice[3 * m + 1] = sum.g;
        slice[3 * m + 2] = sum.b;
    }
}

static void fill_mirror(const ty_thin_film* film, float shine, float* slice)
{
    for (int m = 0; m < MU_NODES; m++)
    {
        ty_rgb g = gain(film, node_mu(m, MU_NODES), shine);
        slice[3 * m] = g.r;
        slice[3 * m + 1] = g.g;
        slice[3 * m + 2] = g.b;
    }
}

static void fill_roughness(ty_thin_film_table* t, const ty_thin_film* film, int rough, float shine)
{
    float alpha = ty_ggx_alpha(node_of(t->roughness, rough, t->rough_count)), shares[MU_NODES][FACETS];
    for (int m = 0; m < MU_NODES && alpha > 0.0f; m++)
        facet_shares(node_mu(m, MU_NODES), alpha, shares[m]);
    for (int k = 0; k < t->thick_count; k++)
    {
        float* slice = t->slices + (k * t->rough_count + rough) * SLICE;
        ty_thin_film at = *film;
        at.weight = 1.0f;
        at.path = film->path * node_of(t->thickness, k, t->thick_count);
        ty_rgb facets[FACETS];
        for (int i = 0; i < FACETS && alpha > 0.0f; i++)
            facets[i] = gain(&at, node_mu(i, FACETS), shine);
        if (alpha > 0.0f)
            fill_slice((const float(*)[FACETS])shares, facets, slice);
        else
            fill_mirror(&at, shine, slice);
        t->averages[k * t->rough_count + rough] = average(slice);
    }
}

ty_thin_film_table* ty_thin_film_table_create(const ty_thin_film* film, const float roughness[2],
                                              const float thickness[2], float shine)
{
    ty_thin_film_table* t = TY_ALLOC(ty_thin_film_table, 1);
    for (int i = 0; i < 2; i++)
    {
        t->roughness[i] = roughness[i];
        t->thickness[i] = ty_min(thickness[i], THICKNESS_MOST);
    }
    t->rough_count = roughness[0] < roughness[1] ? ROUGH_NODES : 1;
    t->thick_count = 1;
    if (t->thickness[0] < t->thickness[1])
        t->thick_count = 2 + (int)((t->thickness[1] - t->thickness[0]) / THICKNESS_STEP);
    t->slices = TY_ALLOC(float, t->rough_count * t->thick_count * SLICE);
    t->averages = TY_ALLOC(ty_rgb, t->rough_count * t->thick_count);
    for (int r = 0; r < t->rough_count; r++)
        fill_roughness(t, film, r, shine);
    return t;
}

void ty_thin_film_table_destroy(ty_thin_film_table* table)
{
    if (!table)
        return;
    ty_free(table->slices);
    ty_free(table->averages);
    ty_free(table);
}

static int locate(const float range[2], int count, float x, float* share)
{
    *share = 0.0f;
    if (count == 1)
        return 0;
    float s = ty_clamp((x - range[0]) / (range[1] - range[0]), 0.0f, 1.0f) * (float)(count - 1);
    int i = (int)s < count - 1 ? (int)s : count - 2;
    *share = s - (float)i;
    return i;
}

ty_thin_film_row ty_thin_film_table_row(const ty_thin_film_table* table, float roughness, float thickness, float weight)
{
    ty_thin_film_row row = {0};
    if (!table)
        return row;
    float share_r, share_t;
    int r = locate(table->roughness, table->rough_count, roughness, &share_r);
    int t = locate(table->thickness, table->thick_count, thickness, &share_t);
    for (int k = 0; k < 4; k++)
    {
        float w = weight * (k & 1 ? share_r : 1.0f - share_r) * (k & 2 ? share_t : 1.0f - share_t);
        if (w <= 0.0f)
            continue;
        int s = (t + (k >> 1)) * table->rough_count + r + (k & 1);
        row.slice[row.count] = table->slices + s * SLICE;
        row.weight[row.count++] = w;
        row.average = ty_rgb_add(row.average, ty_rgb_scale(table->averages[s], w));
    }
    return row;
}

ty_rgb ty_thin_film_row_at(const ty_thin_film_row* row, float mu)
{
    float s = sqrtf(ty_clamp(mu, 0.0f, 1.0f)) * (MU_NODES - 1);
    int i = (int)s < MU_NODES - 1 ? (int)s : MU_NODES - 2;
    ty_rgb sum = {0};
    for (int k = 0; k < row->count; k++)
    {
        const float *v0 = row->slice[k] + 3 * i, *v1 = v0 + 3;
        float w1 = row->weight[k] * (s - (float)i), w0 = row->weight[k] - w1;
        sum = ty_rgb_add(sum, ty_rgb_make(w0 * v0[0] + w1 * v1[0], w0 * v0[1] + w1 * v1[1], w0 * v0[2] + w1 * v1[2]));
    }
    return sum;
}
