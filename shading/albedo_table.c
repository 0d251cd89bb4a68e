// SPDX-License-Identifier: Apache-2.0
// Integrates what layers reflect and what they keep from one another, once per material.
#include "albedo_table.h"
#include "fresnel.h"
#include "fuzz.h"
#include "microfacet.h"
#include <tsuya/base/memory.h>

#define MU_NODES 32 // at mu = (i / 31)^2: dense at grazing, where E is steep
#define ROUGH_NODES 16
#define ETA_NODES 9
#define RING_COUNT 32  // quadrature over visible normals
#define SPOKE_COUNT 16 // half a turn is enough: the lobe is symmetric

#define JOINT_NODES 8 // where roughnesses of two layers vary

typedef struct axis
{
    float low, high;
    int count;
} axis;

struct ty_albedo_table
{
    axis roughness, eta; // eta: or the roughness of the other layer
    float* slices;       // [eta][roughness][MU_NODES]
    float* averages;     // [eta][roughness]
};

static axis make_axis(const float range[2], int count)
{
    return (axis){range[0], range[1], range[0] == range[1] ? 1 : count};
}

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

static ty_albedo_table* create(axis roughness, axis eta)
{
    ty_albedo_table* t = TY_ALLOC(ty_albedo_table, 1);
    t->roughness = roughness;
    t->eta = eta;
    t->slices = TY_ALLOC(float, roughness.count* eta.count* MU_NODES);
    t->averages = TY_ALLOC(float, roughness.count* eta.count);
    return t;
}

// Exactly grazing is a limit: it is taken from just above.
static float node_mu(int i)
{
    return ty_max(ty_sqr((float)i / (MU_NODES - 1)), 1e-5f);
}

ty_albedo_table* ty_albedo_table_create(const float roughness[2], const float eta[2])
{
    ty_albedo_table* t = create(make_axis(roughness, ROUGH_NODES), make_axis(eta, ETA_NODES));
    for (int s = 0; s < t->roughness.count * t->eta.count; s++)
    {
        float alpha = ty_ggx_alpha(axis_node(t->roughness, s % t->roughness.count));
        float index = axis_node(t->eta, s / t->roughness.count);
        for (int i = 0; i < MU_NODES; i++)
            t->slices[s * MU_NODES + i] = integrate(node_mu(i), alpha, index);
        t->averages[s] = average(t->slices + s * MU_NODES);
    }
    return t;
}

ty_albedo_table* ty_albedo_table_create_fuzz(const float roughness[2])
{
    const float one[2] = {1.0f, 1.0f};
    ty_albedo_table* t = create(make_axis(roughness, ROUGH_NODES), make_axis(one, 1));
    for (int s = 0; s < t->roughness.count; s++)
    {
        for (int i = 0; i < MU_NODES; i++)
            t->slices[s * MU_NODES + i] = ty_fuzz_albedo(axis_node(t->roughness, s), node_mu(i));
        t->averages[s] = average(t->slices + s * MU_NODES);
    }
    return t;
}

// What else there is to a reflection beneath a layer.
typedef struct beneath
{
    float alpha, eta;          // eta 0 = of metal
    const ty_albedo_row* coat; // between both, or NULL
    float coat_weight;
} beneath;

// Of a reflection that leaves towards wi, how much reaches the layer.
static float arrives(const beneath* lower, ty_vec3 wo, ty_vec3 wi, ty_vec3 h)
{
    ty_vec2 a = ty_ggx_round(lower->alpha);
    float part = ty_ggx_g2(wo, wi, a) / ty_ggx_g1(wo, a);
    if (lower->eta > 0.0f)
        part *= ty_fresnel(ty_dot(wo, h), lower->eta);
    if (lower->coat)
        part *= 1.0f -
                lower->coat_weight * ty_max(ty_albedo_row_at(lower->coat, wo.z), ty_albedo_row_at(lower->coat, wi.z));
    return part;
}

// Mean of the larger of the upper layer's albedos towards wo and wi, over the directions wi of what comes from beneath.
static float integrate_larger(const ty_albedo_row* upper, float mu, const beneath* lower)
{
    float seen = ty_albedo_row_at(upper, mu), sum = 0.0f, all = 0.0f;
    if (lower->alpha == 0.0f)
        return seen;
    ty_vec3 wo = ty_vec3_make(ty_safe_sqrt(1.0f - mu * mu), 0.0f, mu);
    for (int j = 0; j < RING_COUNT; j++)
        for (int i = 0; i < SPOKE_COUNT; i++)
        {
            ty_vec2 u = {0.5f * ((float)i + 0.5f) / SPOKE_COUNT, ((float)j + 0.5f) / RING_COUNT};
            ty_vec3 h = ty_ggx_sample(wo, ty_ggx_round(lower->alpha), u), wi = ty_reflect(wo, h);
            if (!(wi.z > 0.0f))
                continue;
            float part = arrives(lower, wo, wi, h);
            sum += part * ty_max(seen, ty_albedo_row_at(upper, wi.z));
            all += part;
        }
    return all > 0.0f ? sum / all : seen;
}

ty_albedo_table* ty_albedo_table_create_joint(const ty_lower_layer* lower, const ty_albedo_table* upper,
                                              const float upper_roughness[2], float upper_eta)
{
    if (!upper)
        return NULL;
    ty_albedo_table* t = create(make_axis(lower->roughness, JOINT_NODES), make_axis(upper_roughness, JOINT_NODES));
    ty_albedo_row coat = ty_albedo_table_row(lower->coat, lower->coat_roughness, lower->coat_eta);
    beneath b = {.eta = lower->eta, .coat = lower->coat ? &coat : NULL, .coat_weight = lower->coat_weight};
    for (int s = 0; s < t->roughness.count * t->eta.count; s++)
    {
        b.alpha = ty_ggx_alpha(axis_node(t->roughness, s % t->roughness.count));
        ty_albedo_row row = ty_albedo_table_row(upper, axis_node(t->eta, s / t->roughness.count), upper_eta);
        for (int i = 0; i < MU_NODES; i++)
            t->slices[s * MU_NODES + i] = integrate_larger(&row, node_mu(i), &b);
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
