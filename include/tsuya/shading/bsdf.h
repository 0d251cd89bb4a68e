// SPDX-License-Identifier: Apache-2.0
// The prepared lobes at one point. Plain data, lives on the stack of a path.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/rng.h>
#include <tsuya/geometry/trace.h>

struct ty_material;
struct ty_shading_context;

// Closed set; each member in a file of its own, dispatched by a switch in bsdf.c.
typedef enum ty_bsdf_kind
{
    TY_BSDF_SURFACE,    // layered: coat over (metal | dielectric specular over diffuse | transmission)
    TY_BSDF_CDRF,       // depth or probe, not yet resolved: call ty_bsdf_resolve
    TY_BSDF_CDRF_LOCAL, // kernel over the whole sphere at the point, plus coat
    TY_BSDF_CDRF_EXIT,  // resolved: Lambert with (1 - F) at the exit point
    TY_BSDF_CDRF_COAT,  // resolved: the specular coat at the entry point
} ty_bsdf_kind;

typedef struct ty_bsdf
{
    ty_bsdf_kind kind;
    const struct ty_material* material;
    ty_surface_point point; // where light is gathered; moves to the exit point on resolve
    ty_frame frame;         // shading frame there, n on wo's side
    ty_vec3 wo;
    ty_rgb emission;        // leaving along wo
    bool entering;          // wo is outside the surface
    bool convex;            // the instance is convex: rays that leave it cannot meet it again
    // parameters at the point, meaning by kind
    ty_rgb color;           // diffuse albedo or C
    ty_rgb specular_tint;   // metal reflectance or specular colour
    ty_rgb transmission;    // tint
    float metalness, specular_weight, alpha, eta, transmission_weight;
    float coat_weight, coat_alpha, coat_eta;
    float spread;           // sigma or t of the kernel
    float curvature;        // 1/m, in world units
    float mean_free_path;   // m
    float lobe_probability[4];
} ty_bsdf;

typedef struct ty_bsdf_sample
{
    ty_vec3 wi;    // unit, away from the surface
    ty_rgb weight; // f |cos| / pdf
    float pdf;     // per solid angle; of the whole bsdf, so that MIS can use it; 0 when delta
    bool delta;
    bool transmitted;
} ty_bsdf_sample;

// For cdrf `depth` and `probe`: decides between coat and interior, traces the interior, and turns bsdf into the lobe at
// the point where light leaves. *weight multiplies the path. Others: nothing happens, weight 1. False = absorbed.
// u: 4 numbers in [0,1); extra: further numbers for the rare longer walk.
bool ty_bsdf_resolve(ty_bsdf* bsdf, const struct ty_shading_context* context, const float u[4], ty_rng* extra,
                     ty_rgb* weight);

bool ty_bsdf_is_delta(const ty_bsdf* bsdf);                            // light sampling is pointless
ty_rgb ty_bsdf_eval(const ty_bsdf* bsdf, ty_vec3 wi, float* pdf);      // f |cos|, and the pdf sample would have
bool ty_bsdf_sample_wi(const ty_bsdf* bsdf, float u_lobe, ty_vec2 u, ty_bsdf_sample* out); // false = absorbed
ty_rgb ty_bsdf_albedo(const ty_bsdf* bsdf);                            // for the albedo AOV, about 0..1

// Sets origin, direction, t_min, t_max = TY_FLOAT_MAX, flags and skips for a ray that leaves towards wi.
// u: one number for the randomised own-shadow distance of `local` on non-convex instances.
void ty_bsdf_spawn(const ty_bsdf* bsdf, ty_vec3 wi, float u, ty_ray* ray);
