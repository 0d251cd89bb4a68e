// SPDX-License-Identifier: Apache-2.0
// The prepared lobes at one point. Plain data, lives on the stack of a path.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/rng.h>
#include <tsuya/geometry/trace.h>
#include <tsuya/shading/scattering.h>

struct ty_material;
struct ty_shading_context;

// Closed set; each member in a file of its own, dispatched by a switch in bsdf.c.
typedef enum ty_bsdf_kind
{
    TY_BSDF_SURFACE,    // layered: fuzz over coat over (metal | dielectric specular over diffuse | transmission)
    TY_BSDF_SUBSURFACE, // a surface and a share of its base that light enters, not yet resolved
    TY_BSDF_MATTE,      // nothing but Lambert: such a surface, or where light leaves a body without a coat
    TY_BSDF_CDRF,       // depth or probe, not yet resolved: call ty_bsdf_resolve
    TY_BSDF_CDRF_LOCAL, // kernel over the whole sphere at the point, plus coat
    TY_BSDF_CDRF_EXIT,  // resolved, under a coat: Lambert with (1 - F) at the exit point
    TY_BSDF_CDRF_COAT,  // resolved: the specular coat at the entry point
} ty_bsdf_kind;

// How a random walk through a body ended.
typedef enum ty_walk_end
{
    TY_WALK_LEFT,     // at the surface
    TY_WALK_ABSORBED, // by chance, in proportion to what was left of it
    TY_WALK_LOST,     // through a hole of the mesh
    TY_WALK_CUT,      // by the bound on flights: left straight on
} ty_walk_end;

// Directional albedo E(mu) of a reflecting layer at the point's roughness: up to four table slices and their weights.
typedef struct ty_albedo_row
{
    const float* slice[4]; // owned by the material
    float weight[4];
    int count;     // 0 = the layer reflects nothing
    float average; // 2 * integral of E(mu) mu
} ty_albedo_row;

// What single scattering loses, 1 - E(mu), at the point's roughness and index: between four table slices.
typedef struct ty_loss_row
{
    const float* slice; // owned by the material; NULL = nothing is lost
    int next_roughness, next_eta;
    float share_roughness, share_eta;
    float average; // 2 * integral of (1 - E(mu)) mu
    float spread;  // about proportional to 1 / (mu^2 + spread): how it is sampled
} ty_loss_row;

// A film that waves of light interfere in, at the point.
typedef struct ty_thin_film
{
    const struct ty_thin_film_bands* bands; // owned by the material
    float weight;
    float path;  // micrometres: twice thickness times index
    float bend;  // sine within over that outside
    float index; // relative to that of what lies over it
    bool turned; // beneath is less dense than what covers it
} ty_thin_film;

// What it adds to the directional albedo of a reflection, by channels: up to four table slices and their weights.
typedef struct ty_thin_film_row
{
    const float* slice[4]; // owned by the material
    float weight[4];
    int count;      // 0 = there is no film
    ty_rgb average; // 2 * integral of it times mu
} ty_thin_film_row;

typedef struct ty_bsdf
{
    ty_bsdf_kind kind;
    bool entering; // wo is outside the surface
    bool bent;     // the frame's normal is that of a map: directions on the wrong side of ng are mirrored in it
    const struct ty_material* material;
    ty_surface_point point; // where light is gathered; moves to the exit point on resolve
    ty_frame frame;         // shading frame there, n on wo's side (where light leaves a body: outward)
    ty_vec3 wo;
    ty_rgb emission; // leaving along wo
    ty_rgb color;    // base color or C

    // Parameters at the point, meaning by kind. What follows is not set for MATTE.
    bool inside;                   // surface: wo is within a transmitting body
    bool thin;                     // surface: a sheet
    bool alone;                    // surface: of a body within which nothing else exists
    ty_rgb diffuse, diffuse_below; // surface: albedos of the diffuse base, reflected and (of sheets) transmitted
    float diffuse_roughness;
    ty_rgb specular_tint;    // of the dielectric
    ty_rgb metal, metal_dip; // factor of the metal's reflection; what it falls short of Schlick's form
    ty_rgb transmission;     // factor for one crossing
    float metalness, specular_weight, transmission_weight;
    ty_vec2 alpha;              // of the specular lobe along the frame's t and b; 0 = mirror
    float eta;                  // refractive index beyond the surface over that on wo's side
    float shine;                // the same of the index it reflects by
    float outside;              // refractive index around the body
    float coat_weight;          // surface: of the coat; cdrf: of the specular reflection
    float coat_alpha, coat_eta; // alpha 0 = mirror
    ty_vec2 coat_stretch;       // surface: instead, along t and b turned by
    float coat_sine, coat_cosine;
    bool coat_stretched;
    ty_albedo_row specular_row; // E of the dielectric specular
    ty_albedo_row coat_row;     // E of the coat
    // What facets lose that are met once only goes back as lobes in proportion to what is lost along wi.
    ty_loss_row conductor_loss, near_loss, far_loss; // of the metal; of the clear boundary from wo's side and beyond
    ty_rgb conductor_gain;                           // factor of conductor_loss(wi) cos (under layers: of its share)
    float conductor_mean;                            // 2 * integral of that over mu
    float near_share, near_mean, near_gain,
        far_gain;                          // share of near_loss that goes back; the same of its lobe and of far_loss
    float lobe_probability[8];             // surface: ty_surface_lobe; local: coat, cosine, uniform
    bool layered, tinted, excessive;       // there is coat or fuzz; the coat has a colour; diffuse_excess counts
    float diffuse_gain;                    // of diffuse light along wo, what the layers leave to it over its mean
    ty_rgb coat_log;                       // logarithm of the coat's colour
    float diffuse_left[8], diffuse_excess; // see ty_diffuse_excess: at the nodes; of wo, less the mean
    float coat_roughness, fuzz_weight, fuzz_roughness;
    ty_rgb fuzz_color;
    ty_albedo_row fuzz_row; // E of the fuzz
    // The larger of a layer's albedos towards wo and wi, on average over the reflection beneath it.
    ty_albedo_row coat_under_fuzz, base_under_coat, base_under_fuzz;

    ty_thin_film film;         // surface: weight 0 = none
    ty_thin_film_row film_row; // of the dielectric
    ty_rgb film_gain;          // as diffuse_gain, by channels, and in its place

    // subsurface, and surfaces that come of it
    float body;           // share of what is neither metal nor clear; 0 = no body
    float surface_chance; // of going on with the rest of the surface
    ty_rgb body_color;    // with the coat's darkening; grey of a walk, whose matter has the colour

    // cdrf
    float mean_free_path[3]; // m, world, by channel
    float loss[3];           // 1 - single-scattering albedo, by channel
    bool grey;               // the channels are alike in both
    float sigma_slope;       // m; > 0: sigma = sigma_slope * curvature instead of the law of mean free path and loss
    float curvature;         // 1/m, world; for local where the direction of light does not matter
    float second_form[3];    // probe, local: II(t,t), II(t,b), II(b,b) in the frame, 1/m, convex positive

    // walk: mean_free_path 0 = light leaves where it entered
    ty_scattering matter;
    float way;        // m: how far away the viewer is where it is within the body; 0 = somewhere
    uint32_t flights; // of the walk, once its interior is taken
    ty_walk_end walk_end;
} ty_bsdf;

// Radiance is carried divided by the squared refractive index of its medium, so no factor appears at interfaces.
typedef struct ty_bsdf_sample
{
    ty_vec3 wi;    // unit, away from the surface
    ty_rgb weight; // f |cos| / pdf
    float pdf;     // per solid angle; of the whole bsdf, so that MIS can use it; 0 when delta
    bool delta;
    bool transmitted;
    uint32_t kind; // TY_MASK_DIFFUSE, GLOSSY or TRANSMISSION: of the lobe that was sampled
} ty_bsdf_sample;

// f |cos| and density by kinds of lobes: diffuse, glossy, transmission.
typedef struct ty_bsdf_parts
{
    ty_rgb f[3];
    float pdf[3];
} ty_bsdf_parts;

// For cdrf `depth` and `probe`, `walk` and surfaces with subsurface: decides between coat (or all the rest of the
// surface) and interior, traces the interior, and turns bsdf into the lobe at the point where light leaves. *weight
// multiplies the path. Others: nothing happens, weight 1. False = absorbed. u: 4 numbers in [0,1); extra: further
// numbers for the rare longer walk.
bool ty_bsdf_resolve(ty_bsdf* bsdf, const struct ty_shading_context* context, const float u[4], ty_rng* extra,
                     ty_rgb* weight);

// The same two ways apart, for a caller that follows both: the coat where the point is, or the lobe where light leaves
// (u: 3 numbers; its weight takes no part of the choice). Both only where ty_bsdf_is_open.
static inline bool ty_bsdf_is_open(const ty_bsdf* bsdf)
{
    return bsdf->kind == TY_BSDF_CDRF || bsdf->kind == TY_BSDF_SUBSURFACE;
}
float ty_bsdf_coat_chance(const ty_bsdf* bsdf); // a good probability for going on with the coat; 0 = there is none
void ty_bsdf_take_coat(ty_bsdf* bsdf);
bool ty_bsdf_take_interior(ty_bsdf* bsdf, const struct ty_shading_context* context, const float u[3], ty_rng* extra,
                           ty_rgb* weight);

bool ty_bsdf_is_delta(const ty_bsdf* bsdf);                        // light sampling is pointless
ty_rgb ty_bsdf_eval(const ty_bsdf* bsdf, ty_vec3 wi, float* pdf);  // f |cos|, and the pdf sample would have
ty_bsdf_parts ty_bsdf_eval_parts(const ty_bsdf* bsdf, ty_vec3 wi); // they add up to what eval says
bool ty_bsdf_sample_wi(const ty_bsdf* bsdf, float u_lobe, ty_vec2 u, ty_bsdf_sample* out); // false = absorbed
ty_rgb ty_bsdf_albedo(const ty_bsdf* bsdf); // for the albedo AOV, about 0..1

// Sets origin, direction, t_min, t_max = TY_FLOAT_MAX, flags, skips, time and mask = TY_MASK_ALL for a ray that leaves
// towards wi.
// u: one number for the randomised own-shadow distance of `local` on non-convex instances.
void ty_bsdf_spawn(const ty_bsdf* bsdf, ty_vec3 wi, float u, ty_ray* ray);
