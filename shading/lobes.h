// SPDX-License-Identifier: Apache-2.0
// The members of the closed set of bsdf kinds. All directions here are in the local frame, wo.z > 0 unless said.
#pragma once
#include <tsuya/shading/material.h>
#include <tsuya/shading/sampling.h>

bool ty_surface_is_delta(const ty_bsdf* bsdf);
ty_rgb ty_surface_eval(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi, float* pdf);
ty_rgb ty_surface_eval_diffuse(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi, float* pdf); // its share of eval
bool ty_surface_sample(const ty_bsdf* bsdf, ty_vec3 wo, float u_lobe, ty_vec2 u, ty_bsdf_sample* out);
ty_rgb ty_surface_albedo(const ty_bsdf* bsdf);
bool ty_surface_take_interior(ty_bsdf* bsdf, const ty_shading_context* context, const float u[3], ty_rng* extra,
                              ty_rgb* weight);
ty_rgb ty_surface_eval_exit(const ty_bsdf* bsdf, float mu); // what its layers leave of light from its body

// One dielectric reflection of the coat, as CDRF_COAT, and as a part of others. Its weight is coat_weight.
ty_rgb ty_coat_eval(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi, float* pdf);
bool ty_coat_sample(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec2 u, ty_bsdf_sample* out);
float ty_coat_albedo(const ty_bsdf* bsdf, float mu); // coat_weight * E(mu)

// Lambert under the coat, at the point where light leaves; wi alone matters.
ty_rgb ty_exit_eval(const ty_bsdf* bsdf, ty_vec3 wi, float* pdf);
bool ty_exit_sample(const ty_bsdf* bsdf, ty_vec2 u, ty_bsdf_sample* out);

void ty_local_prepare(const ty_shading_context* context, ty_bsdf* bsdf); // lobe probabilities, second form
ty_rgb ty_local_eval(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi, float* pdf);
ty_rgb ty_local_eval_diffuse(const ty_bsdf* bsdf, ty_vec3 wo, ty_vec3 wi, float* pdf); // eval without the coat
bool ty_local_sample(const ty_bsdf* bsdf, ty_vec3 wo, float u_lobe, ty_vec2 u, ty_bsdf_sample* out);
float ty_local_curvature(const ty_bsdf* bsdf, ty_vec3 wi); // 1/m, in the tangential direction of wi, >= 0

ty_rgb ty_cdrf_albedo(const ty_bsdf* bsdf);
// Mean free path times scale by channel, and the loss that gives the colour under a boundary that reflects `internal`
// of diffuse light back. The material must have its table of spreads.
void ty_cdrf_set_medium(ty_bsdf* bsdf, float mean_free_path, ty_rgb scale, ty_rgb color, float internal);
float ty_cdrf_spread(const ty_bsdf* bsdf, float curvature, int channel); // 1 - e^-t or sigma
// By channel. True = so alike (within a twentieth of their mean, which spread[0] then is) that no eye can part them.
bool ty_cdrf_spreads(const ty_bsdf* bsdf, float curvature, float spread[3]);

// Where a walk that enters at the point leaves. u: three numbers. Returns false where the point itself is the answer.
// Channels whose light spreads alike share one way; else one is chosen and *weight is multiplied by what that is worth
// to each.
bool ty_cdrf_depth_exit(const ty_shading_context* context, ty_bsdf* bsdf, const float u[3], ty_rng* extra,
                        ty_rgb* weight, ty_surface_point* exit);
// The same by a random walk. Multiplies weight by what is left of the light, and notes in bsdf how the walk went.
bool ty_walk_exit(const ty_shading_context* context, ty_bsdf* bsdf, const float u[3], ty_rng* extra, ty_rgb* weight,
                  ty_surface_point* exit);
ty_vec3 ty_walk_entry(const ty_surface_point* x, const float u[2]);      // direction into which light enters at x
ty_rgb ty_walk_reflectance(const ty_scattering* matter);                 // of a thick body
void ty_probe_prepare(const ty_shading_context* context, ty_bsdf* bsdf); // curvature
bool ty_cdrf_probe_exit(const ty_shading_context* context, const ty_bsdf* bsdf, const float u[3], ty_rgb* weight,
                        ty_surface_point* exit);
