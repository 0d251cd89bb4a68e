// SPDX-License-Identifier: Apache-2.0
// Rough diffuse reflection that keeps its energy. Local frame, both cosines positive.
#pragma once
#include <tsuya/base/math.h>

// f of albedo 1 single scattering and what follows of it: Oren-Nayar in Fujii's form, with what facets pass on among
// themselves given back in deeper colour (Portsmouth, Kutz & Hill 2025, "EON: A practical energy-preserving rough
// diffuse BRDF"). Roughness 0 is Lambert. Reciprocal; of a white surface exactly energy preserving.
ty_rgb ty_diffuse_value(ty_rgb color, float roughness, ty_vec3 wo, ty_vec3 wi);
// The share of the light from mu that leaves.
ty_rgb ty_diffuse_albedo(ty_rgb color, float roughness, float mu);

// Gauss-Legendre in the root of the cosine, in which albedos of layers are even.
enum
{
    TY_MU_NODES = 8
};
typedef struct ty_mu_node
{
    float mu, weight; // of 2 mu dmu
    float rough;      // by how much single scattering from there gains with roughness
} ty_mu_node;
extern const ty_mu_node ty_mu_nodes[TY_MU_NODES];

// Under layers that leave x(mu) of diffuse light, each way, a rough surface would send off a little more or less of it
// than a Lambert one, since it prefers some directions: by how much of 1, seen from mu. x: at the nodes, times weight.
float ty_diffuse_excess(float roughness, const float x[TY_MU_NODES], float mu);
// Its mean over x.
float ty_diffuse_excess_mean(float roughness, const float x[TY_MU_NODES]);
