// SPDX-License-Identifier: Apache-2.0
// Integrates what single scattering by GGX facets loses, once per material.
#include "loss_table.h"
#include "fresnel.h"
#include "microfacet.h"
#include <tsuya/base/memory.h>

enum
{
    MU_NODES = 32, // at mu = (i / 31)^2: dense at grazing, where E is steep
    ROUGH_NODES = 12,
    SIDE_NODES = 7, // of the index on each side of 1, besides the material's own
    ETA_NODES = 2 * SIDE_NODES + 4,
    // Points of the quadrature: the fewer slices, the more.
    FINE = 2584,
    MEDIUM = 610,
    COARSE = 377,
    COARSEST = 144
};

struct ty_loss_table
{
    float roughness_low, roughness_high;
    int rough_count, eta_count;
    float eta[ETA_NODES]; // rising
    int points[ETA_NODES];
    float* slices;   // [eta][roughness][MU_NODES]
    float* averages; // [eta][roughness]
};

typedef struct facets
{
    ty_vec2 alpha;
    float eta;   // 0 = they reflect everything
    float shine; // like this index
    int points;
} facets;

// What one facet sends on, relative to what it receives.
static float facet_albedo(const facets* f, ty_vec3 wo, ty_vec3 h)
{
    ty_vec3 wi = ty_reflect(wo, h);
    float r = f->eta > 0.0f ? ty_fresnel_weighted(ty_dot(wo, h), f->eta, f->shine) : 1.0f;
    float sum = wi.z > 0.0f ? r * ty_ggx_g2(wo, wi, f->alpha) / ty_ggx_g1(wo, f->alpha) : 0.0f;
    if (r < 1.0f && ty_refract(wo, h, f->eta, &wi) && wi.z < 0.0f)
        sum += (1.0f - r) * ty_ggx_g1(wi, f->alpha);
    return sum;
}

// Over a Fibonacci lattice of facets: a grid would step over the heavy tail, where all is lost at once. Half a turn is
// enough: the lobe is symmetric.
static float integrate_loss(const facets* f, float mu)
{
    const float golden = 0.6180339887f;
    ty_vec3 wo = ty_vec3_make(ty_safe_sqrt(1.0f - mu * mu), 0.0f, mu);
    float sum = 0.0f;
    for (int i = 0; i < f->points; i++)
    {
        float turn = (float)i * golden;
        ty_vec2 u = {0.5f * (turn - floorf(turn)), ((float)i + 0.5f) / (float)f->points};
        sum += 1.0f - facet_albedo(f, wo, ty_ggx_sample(wo, f->alpha, u));
    }
    return ty_clamp(sum / (float)f->points, 0.0f, 1.0f);
}

// 2 * integral of L mu dmu = 4 * integral of L(s) s^3 ds with mu = s^2, exactly for the piecewise-linear L(s): what is
// lost is then given back in full. Of a piece from a to b with values p and q: by parts over the cubic weight.
static float average(const float* slice)
{
    double sum = 0.0, h = 1.0 / (MU_NODES - 1);
    for (int i = 0; i + 1 < MU_NODES; i++)
    {
        double a = i * h, b = a + h, a4 = a * a * a * a, b4 = b * b * b * b;
        double slope = ((double)slice[i + 1] - (double)slice[i]) / h;
        sum += ((double)slice[i] - slope * a) * (b4 - a4) + slope * 0.8 * (b4 * b - a4 * a);
    }
    return (float)sum;
}

static float roughness_node(const ty_loss_table* t, int i)
{
    return t->rough_count > 1 ? ty_lerp(t->roughness_low, t->roughness_high, (float)i / (ROUGH_NODES - 1))
                              : t->roughness_low;
}

static void fill(ty_loss_table* t, float weight, float coat)
{
    int count = t->rough_count * t->eta_count;
    t->slices = TY_ALLOC(float, count* MU_NODES);
    t->averages = TY_ALLOC(float, count);
    for (int s = 0; s < count; s++)
    {
        int e = s / t->rough_count;
        facets f = {.alpha = ty_ggx_round(ty_ggx_alpha(roughness_node(t, s % t->rough_count))),
                    .eta = t->eta[e],
                    .shine = ty_shine(t->eta[e], weight, coat),
                    .points = t->points[e]};
        if (f.alpha.x == 0.0f) // mirrors lose nothing
            continue;
        for (int i = 0; i < MU_NODES; i++)
            // Exactly grazing is a limit: take it from just above.
            t->slices[s * MU_NODES + i] = integrate_loss(&f, ty_max(ty_sqr((float)i / (MU_NODES - 1)), 1e-5f));
        t->averages[s] = average(t->slices + s * MU_NODES);
    }
}

static ty_loss_table* create(float roughness_low, float roughness_high)
{
    ty_loss_table* t = TY_ALLOC(ty_loss_table, 1);
    t->roughness_low = roughness_low;
    t->roughness_high = roughness_high;
    t->rough_count = roughness_low == roughness_high ? 1 : ROUGH_NODES;
    return t;
}

ty_loss_table* ty_loss_table_create_conductor(float roughness_low, float roughness_high)
{
    ty_loss_table* t = create(roughness_low, roughness_high);
    t->eta_count = 1;
    t->points[0] = t->rough_count == 1 ? FINE : MEDIUM;
    fill(t, 1.0f, 1.0f);
    return t;
}

// Kept in order; a node that is there already only becomes finer.
static void add_eta(ty_loss_table* t, float eta, int points)
{
    int i = t->eta_count;
    while (i > 0 && t->eta[i - 1] >= eta)
        i--;
    if (i < t->eta_count && t->eta[i] == eta)
    {
        t->points[i] = points;
        return;
    }
    for (int k = t->eta_count++; k > i; k--)
    {
        t->eta[k] = t->eta[k - 1];
        t->points[k] = t->points[k - 1];
    }
    t->eta[i] = eta;
    t->points[i] = points;
}

ty_loss_table* ty_loss_table_create_dielectric(float roughness_low, float roughness_high, float ior_low, float ior_high,
                                               float weight, float coat)
{
    static const float side[SIDE_NODES] = {1.0005f, 1.03f, 1.1f, 1.25f, 1.6f, 2.2f, 3.0f};
    ty_loss_table* t = create(roughness_low, roughness_high);
    bool constant = t->rough_count == 1;
    for (int i = 0; i < SIDE_NODES; i++)
    {
        add_eta(t, side[i], constant ? COARSE : COARSEST);
        add_eta(t, 1.0f / side[i], constant ? COARSE : COARSEST);
    }
    const float own[4] = {ior_low, 1.0f / ior_low, ior_high, 1.0f / ior_high};
    for (int i = 0; i < 4; i++)
        add_eta(t, own[i], constant ? FINE : COARSE);
    fill(t, weight, coat);
    return t;
}

void ty_loss_table_destroy(ty_loss_table* table)
{
    if (!table)
        return;
    ty_free(table->slices);
    ty_free(table->averages);
    ty_free(table);
}

static void locate_roughness(const ty_loss_table* t, float roughness, int* index, float* share)
{
    *index = 0;
    *share = 0.0f;
    if (t->rough_count == 1)
        return;
    float s = (roughness - t->roughness_low) / (t->roughness_high - t->roughness_low);
    s = ty_clamp(s, 0.0f, 1.0f) * (ROUGH_NODES - 1);
    *index = (int)s < ROUGH_NODES - 1 ? (int)s : ROUGH_NODES - 2;
    *share = s - (float)*index;
}

static void locate_eta(const ty_loss_table* t, float eta, int* index, float* share)
{
    *index = 0;
    *share = 0.0f;
    if (t->eta_count == 1)
        return;
    int i = 0;
    while (i + 2 < t->eta_count && t->eta[i + 1] <= eta)
        i++;
    *index = i;
    *share = ty_clamp((eta - t->eta[i]) / (t->eta[i + 1] - t->eta[i]), 0.0f, 1.0f);
}

ty_loss_row ty_loss_table_row(const ty_loss_table* t, float roughness, float eta)
{
    if (!t)
        return (ty_loss_row){0};
    int r, e;
    ty_loss_row row = {.next_roughness = t->rough_count > 1 ? MU_NODES : 0,
                       .next_eta = t->eta_count > 1 ? t->rough_count * MU_NODES : 0};
    locate_roughness(t, roughness, &r, &row.share_roughness);
    locate_eta(t, eta, &e, &row.share_eta);
    int first = e * t->rough_count + r, up = t->rough_count > 1 ? 1 : 0, over = t->eta_count > 1 ? t->rough_count : 0;
    const float* a = t->averages + first;
    row.slice = t->slices + first * MU_NODES;
    row.average = ty_lerp(ty_lerp(a[0], a[up], row.share_roughness),
                          ty_lerp(a[over], a[over + up], row.share_roughness), row.share_eta);
    // From the ends, where the form is exact: 1 / (mu^2 + s) falls by (1 + s) / s.
    float grazing = ty_loss_row_at(&row, 0.0f), straight = ty_loss_row_at(&row, 1.0f);
    row.spread = ty_clamp(straight / ty_max(grazing - straight, 1e-6f), 1e-4f, 4.0f);
    return row;
}

float ty_loss_row_sample(const ty_loss_row* row, float u)
{
    float s = row->spread;
    return ty_min(ty_safe_sqrt(s * ty_exp(u * ty_ln((1.0f + s) / s)) - s), 1.0f);
}

float ty_loss_row_pdf(const ty_loss_row* row, float mu)
{
    float s = row->spread;
    return mu * TY_INV_PI / ((mu * mu + s) * ty_ln((1.0f + s) / s));
}

static float between(const float* slice, int i, float share)
{
    return ty_lerp(slice[i], slice[i + 1], share);
}

float ty_loss_row_at(const ty_loss_row* row, float mu)
{
    if (!row->slice)
        return 0.0f;
    float s = sqrtf(ty_clamp(mu, 0.0f, 1.0f)) * (MU_NODES - 1);
    int i = (int)s < MU_NODES - 1 ? (int)s : MU_NODES - 2;
    s -= (float)i;
    const float* a = row->slice;
    float value = between(a, i, s);
    if (row->share_roughness > 0.0f)
        value = ty_lerp(value, between(a + row->next_roughness, i, s), row->share_roughness);
    if (row->share_eta <= 0.0f)
        return value;
    a += row->next_eta;
    float beyond = between(a, i, s);
    if (row->share_roughness > 0.0f)
        beyond = ty_lerp(beyond, between(a + row->next_roughness, i, s), row->share_roughness);
    return ty_lerp(value, beyond, row->share_eta);
}
