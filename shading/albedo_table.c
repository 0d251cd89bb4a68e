// SPDX-License-Identifier: Apache-2.0
// Integrates the directional albedo of GGX dielectric reflection once per material.
#include "albedo_table.h"
#include "fresnel.h"
#include "microfacet.h"
#include <tsuya/base/memory.h>

#define MU_NODES 32 // at mu = (i / 31)^2: dense at grazing, where E is steep
#define ROUGH_NODES 16
#define ETA_NODES 9
#define RING_COUNT 32  // quadrature over visible normals
#define SPOKE_COUNT 16 // half a turn is enough: the lobe is symmetric

typedef struct axis
{
    float low, high;
    int count;
} axis;

struct ty_albedo_table
{
    axis roughness, eta;
    float* slices;   // [eta][roughness][MU_NODES]
    float* averages; // [eta][roughness]
};

static float axis_node(axis a, int i)
{
    return a.count > 1 ? ty_lerp(a.low, a.high, (float)i / (float)(a.count - 1)) : a.low;
}

static float integrate(float mu, float alpha, float eta)
{
    if (alpha == 0.0f)
        return ty_fresnel(mu, eta);
    ty_vec2 a = ty_ggx_round(alpha);
    ty_vec3 wo = ty_vec3_make(ty_safe_sqrt(1.0f - mu * mu), 0.0f, mu);
    float sum = 0.0f;
    for (int j = 0; j < RING_COUNT; j++)
        for (int i = 0; i < SPOKE_COUNT; i++)
        {
            ty_vec2 u = {0.5f * ((float)i + 0.5f) / SPOKE_COUNT, ((float)j + 0.5f) / RING_COUNT};
            ty_vec3 h = ty_ggx_sample(wo, a, u), wi = ty_reflect(wo, h);
            if (wi.z > 0.0f)
                sum += ty_fresnel(ty_dot(wo, h), eta) * ty_ggx_g2(wo, wi, a) / ty_ggx_g1(wo, a);
        }
    return sum / (RING_COUNT * SPOKE_COUNT);
}

// 2 * integral of E mu dmu = 4 * integral of E(s) s^3 ds with mu = s^2, exactly for the piecewise-linear E(s): what the
// layer leaves is then handed on in full.
static float average(const float* slice)
{
    static const double node[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static const double weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0.0, h = 1.0 / (MU_NODES - 1);
    for (int i = 0; i + 1 < MU_NODES; i++)
        for (int k = 0; k < 3; k++)
        {
            double s = (i + node[k]) * h, e = slice[i] + ((double)slice[i + 1] - slice[i]) * node[k];
            sum += 4.0 * e * s * s * s * weight[k] * h;
        }
    return (float)sum;
}

ty_albedo_table* ty_albedo_table_create(float roughness_low, float roughness_high, float eta_low, float eta_high)
{
    ty_albedo_table* t = TY_ALLOC(ty_albedo_table, 1);
    t->roughness = (axis){roughness_low, roughness_high, roughness_low == roughness_high ? 1 : ROUGH_NODES};
    t->eta = (axis){eta_low, eta_high, eta_low == eta_high ? 1 : ETA_NODES};
    int count = t->roughness.count * t->eta.count;
    t->slices = TY_ALLOC(float, count* MU_NODES);
    t->averages = TY_ALLOC(float, count);
    for (int s = 0; s < count; s++)
    {
        float alpha = ty_ggx_alpha(axis_node(t->roughness, s % t->roughness.count));
        float eta = axis_node(t->eta, s / t->roughness.count);
        for (int i = 0; i < MU_NODES; i++)
        {
            // Exactly grazing is a limit: take it from just above.
            float mu = ty_max(ty_sqr((float)i / (MU_NODES - 1)), 1e-5f);
            t->slices[s * MU_NODES + i] = integrate(mu, alpha, eta);
        }
        t->averages[s] = average(t->slices + s * MU_NODES);
    }
    return t;
}

void ty_albedo_table_destroy(ty_albedo_table* table)
{
    if (!table)
        return;
    ty_free(table->slices);
    ty_free(table->averages);
    ty_free(table);
}

// Lower node and the share of the upper one.
static int locate(axis a, float x, float* share)
{
    if (a.count == 1)
    {
        *share = 0.0f;
        return 0;
    }
    float s = ty_clamp((x - a.low) / (a.high - a.low), 0.0f, 1.0f) * (float)(a.count - 1);
    int i = (int)s < a.count - 1 ? (int)s : a.count - 2;
    *share = s - (float)i;
    return i;
}

ty_albedo_row ty_albedo_table_row(const ty_albedo_table* table, float roughness, float eta)
{
    ty_albedo_row row = {0};
    if (!table)
        return row;
    float share_r, share_e;
    int r = locate(table->roughness, roughness, &share_r), e = locate(table->eta, eta, &share_e);
    for (int k = 0; k < 4; k++)
    {
        float w = (k & 1 ? share_r : 1.0f - share_r) * (k & 2 ? share_e : 1.0f - share_e);
        if (w <= 0.0f)
            continue;
        int s = (e + (k >> 1)) * table->roughness.count + r + (k & 1);
        row.slice[row.count] = table->slices + s * MU_NODES;
        row.weight[row.count++] = w;
        row.average += w * table->averages[s];
    }
    return row;
}

float ty_albedo_row_at(const ty_albedo_row* row, float mu)
{
    float s = sqrtf(ty_clamp(mu, 0.0f, 1.0f)) * (MU_NODES - 1), sum = 0.0f;
    int i = (int)s < MU_NODES - 1 ? (int)s : MU_NODES - 2;
    for (int k = 0; k < row->count; k++)
        sum += row->weight[k] * ty_lerp(row->slice[k][i], row->slice[k][i + 1], s - (float)i);
    return sum;
}

static float node_value(const ty_albedo_row* row, int i)
{
    float sum = 0.0f;
    for (int k = 0; k < row->count; k++)
        sum += row->weight[k] * row->slice[k][i];
    return sum;
}

float ty_albedo_row_common(const ty_albedo_row* a, const ty_albedo_row* b)
{
    // Trapezoids in s over 4 E_a E_b s^3: the last node counts half.
    const float h = 1.0f / (MU_NODES - 1);
    float sum = 0.0f;
    for (int i = 1; i < MU_NODES; i++)
    {
        float s = (float)i * h, end = i == MU_NODES - 1 ? 0.5f : 1.0f;
        sum += end * 4.0f * h * s * s * s * node_value(a, i) * node_value(b, i);
    }
    return sum;
}
