// SPDX-License-Identifier: Apache-2.0
// How light behaves at a point: materials, their evaluation and sampling.
#pragma once
#include <tsuya/base/moisture.h>
#include <tsuya/base/params.h>
#include <tsuya/base/rng.h>
#include <tsuya/base/status.h>
#include <tsuya/geometry/trace.h>
#include <tsuya/image/mip_texture.h>
#include <tsuya/shading/cdrf.h>

typedef struct ty_material ty_material;       // opaque, const after creation
typedef struct ty_depth_field ty_depth_field; // opaque: per-vertex depth and curvature of a prototype, for `depth`

// --- definitions: what a scene file says ---

typedef enum ty_subsurface_evaluate
{
    TY_SUBSURFACE_DEPTH, // as `cdrf` does by default
    TY_SUBSURFACE_WALK,  // as `walk`
} ty_subsurface_evaluate;

// Names follow OpenPBR Surface.
typedef struct ty_surface_def
{
    ty_input base_weight;                   // 0..1, factor of base_color
    ty_input base_color;                    // albedo of the diffuse base, or reflectance of the metal
    ty_input base_diffuse_roughness;        // 0..1: 0 is Lambert
    ty_input base_metalness;                // 0..1
    ty_input specular_weight;               // 0..1: of the reflectance at normal incidence
    ty_input specular_color;                // tint of the dielectric; of a metal at 82 degrees
    ty_input specular_roughness;            // 0..1; GGX alpha = roughness^2; below .02 it is a mirror
    ty_input specular_ior;                  // 1..3
    ty_input specular_roughness_anisotropy; // 0..1: longer along the texture's u, smaller across
    ty_input specular_rotation;             // radians, of that direction about the normal
    ty_input transmission_weight;
    ty_input transmission_color;   // tint at normal passage of transmission_depth, or per interface when that is 0
    float transmission_depth;      // m
    ty_input transmission_scatter; // share of the light that is scattered in transmission_depth, or more than all
    float transmission_scatter_anisotropy; // -.99..+.99
    ty_input coat_weight;
    ty_input coat_color; // what is left of light after going through it and back, straight
    ty_input coat_roughness;
    ty_input coat_roughness_anisotropy; // 0..1, as that of the specular reflection
    ty_input coat_rotation;             // radians
    float coat_ior;
    ty_input coat_darkening; // 0..1: how much of what it reflects back onto the base counts
    ty_input fuzz_weight;
    ty_input fuzz_color;
    ty_input fuzz_roughness;      // 0..1: how far the fibres stray
    ty_input thin_film_weight;    // over metal and dielectric, beneath the coat
    ty_input thin_film_thickness; // micrometres
    float thin_film_ior;
    ty_input emission_luminance; // radiance
    ty_input emission_color;
    ty_input opacity;                 // 0..1, geometry_opacity: light passes the rest unbent
    bool thin_walled;                 // a sheet: transmitted light is not refracted, nothing is enclosed
    ty_input subsurface_weight;       // share of the diffuse base that light enters, or of thin sheets shines through
    ty_input subsurface_color;        // its albedo; of sheets reflection and transmission together
    ty_input subsurface_radius;       // m, mean free path in bodies
    ty_input subsurface_radius_scale; // of the channels
    float subsurface_anisotropy;      // mean cosine of scattering; of sheets -1 = all reflected .. 1 = all transmitted
    int subsurface_evaluate;          // ty_subsurface_evaluate
    int priority;                     // of the body where bodies overlap: the highest is there
    ty_input normal;                  // tangent space, +y along v; no texture = none
    float normal_strength;
    ty_input bump; // m, height along the normal; no texture = none
} ty_surface_def;

// What moisture is written as.
typedef enum ty_moisture_source
{
    TY_MOISTURE_WET_BASIS,
    TY_MOISTURE_UPTAKE,
    TY_MOISTURE_SOAK,
} ty_moisture_source;

typedef struct ty_soak_inputs
{
    ty_input minutes;
    ty_input celsius; // 0..60
} ty_soak_inputs;

typedef struct ty_moisture_inputs
{
    ty_input wet_basis;  // 0..1
    ty_input uptake;     // of water per raw mass
    ty_soak_inputs soak; //
    ty_input cooked;     // 0..1; < 0: as ty_moisture_def says
    ty_input gradient;   // added to the wet basis; between 0 and its value
    int source;          // ty_moisture_source: which of the first three counts
} ty_moisture_inputs;

ty_moisture_inputs ty_moisture_inputs_default(void); // cooked rice
const ty_param_table* ty_moisture_params(void);      // "moisture"
const ty_param_table* ty_soak_params(void);          // "moisture.soak"
const ty_param_table* ty_moisture_law_params(void);  // "calibration": what `tsuya calibrate` writes

typedef enum ty_cdrf_kernel
{
    TY_CDRF_POISSON,
    TY_CDRF_GAUSSIAN,
    TY_CDRF_GAUSSIAN_PUBLISHED,
} ty_cdrf_kernel;

typedef enum ty_cdrf_evaluate
{
    TY_CDRF_DEPTH,
    TY_CDRF_PROBE,
    TY_CDRF_LOCAL,
} ty_cdrf_evaluate;

typedef enum ty_cdrf_curvature
{
    TY_CDRF_CURVATURE_AUTOMATIC,   // directional for `local`, mean for the others
    TY_CDRF_CURVATURE_MEAN,        // (k1 + k2) / 2
    TY_CDRF_CURVATURE_DIRECTIONAL, // normal curvature towards the light (local) or the way out (depth, probe)
    TY_CDRF_CURVATURE_MAXIMAL,     // max(k1, k2)
} ty_cdrf_curvature;

typedef struct ty_cdrf_def
{
    ty_input color;                // fraction of the entered light that leaves again, per channel
    ty_moisture_inputs moisture;   //
    float cooked;                  // 0..1, where moisture does not say; < 0: neither does this
    ty_input mean_free_path;       // m, transport mean free path; < 0: from the moisture law
    ty_input mean_free_path_scale; // its factor per channel
    int kernel;                    // ty_cdrf_kernel; `depth` knows poisson alone
    int evaluate;                  // ty_cdrf_evaluate
    int curvature;                 // ty_cdrf_curvature
    ty_input specular_weight;      // 0 = no coat, the furnace of color 1 then gives exactly 1 as well
    ty_input specular_roughness;   // < 0: from the moisture (a wet film is smoother)
    float specular_ior;
    ty_input normal; // of the specular reflection: tangent space, +y along v; no texture = none
    float normal_strength;
    ty_input bump;               // m, likewise
    ty_moisture_law calibration; // what moisture means
} ty_cdrf_def;

typedef enum ty_walk_boundary
{
    TY_WALK_DIFFUSE,    // light enters and leaves by the cosine: what `cdrf` stands for
    TY_WALK_DIELECTRIC, // it is refracted, and reflected on the inner side
} ty_walk_boundary;

// One of preset, scattering, subsurface_color and (without any) color says what is within.
typedef struct ty_walk_def
{
    ty_cdrf_def common;         // but for kernel, evaluate and curvature
    int boundary;               // ty_walk_boundary
    int preset;                 // 0 = none, else index into ty_walk_preset_names
    ty_input scattering;        // 1/mm, reduced: (1 - anisotropy) times that of single scatterings; < 0: not given
    ty_input absorption;        // 1/mm, beside scattering
    float anisotropy;           // -.99..+.99
    ty_input subsurface_color;  // diffuse reflectance of a thick body; < 0: not given
    ty_input subsurface_radius; // m, mean free path
    ty_input subsurface_radius_scale; // of the channels
} ty_walk_def;

// Layers of noise on a root or stem whose uv are turns about it and metres along it.
typedef struct ty_bark_def
{
    ty_input young_color, old_color, crease_color;
    float size;                         // m, of a patch; all else is in proportion
    float depth;                        // m, of the relief
    float wrinkles, lenticels, creases; // 0..1
    ty_input age;                       // 0..1
    ty_input radius;                    // m, of the root
    ty_input join;                      // 0..1: 1 = patterns lie in space instead of along the root
    ty_input lichen;                    // 0..1, cover
    ty_input lichen_color;              //
    ty_input moisture;                  // 0..1: 0 dry, 1 dripping
    ty_input specular_roughness;        // 0..1, dry
    ty_input specular_weight;           // 0..1
} ty_bark_def;

extern const char* const ty_walk_preset_names[]; // NULL-terminated; the first is "none"

ty_surface_def ty_surface_def_default(void);
ty_cdrf_def ty_cdrf_def_default(void);
ty_walk_def ty_walk_def_default(void);
ty_bark_def ty_bark_def_default(void);
const ty_param_table* ty_surface_params(void); // "material.surface"
const ty_param_table* ty_cdrf_params(void);    // "material.cdrf"
const ty_param_table* ty_walk_params(void);    // "material.walk"
const ty_param_table* ty_bark_params(void);    // "material.bark"

// Copies def (strings excepted: indices must be resolved). Impossible combinations are TY_BAD_INPUT naming the field.
TY_CHECKED ty_status ty_material_create_surface(const ty_surface_def* def, ty_material** out, ty_error* error);
TY_CHECKED ty_status ty_material_create_cdrf(const ty_cdrf_def* def, ty_material** out, ty_error* error);
TY_CHECKED ty_status ty_material_create_walk(const ty_walk_def* def, ty_material** out, ty_error* error);
TY_CHECKED ty_status ty_material_create_bark(const ty_bark_def* def, ty_material** out, ty_error* error);
void ty_material_destroy(ty_material* material); // NULL is allowed

bool ty_material_is_subsurface(const ty_material* material); // cdrf, walk: closed surfaces of it are one-sided
bool ty_material_needs_depth(const ty_material* material);   // its prototypes need a depth field
bool ty_material_is_emissive(const ty_material* material);

// Rays against the committed world; half a second for a million vertices. Needs welds and curvature on the mesh.
TY_CHECKED ty_status ty_depth_field_create(const ty_world* world, uint32_t prototype, ty_depth_field** out,
                                           ty_error* error);
void ty_depth_field_destroy(ty_depth_field* field); // NULL is allowed

// --- evaluation ---

// What shading needs to know of the scene. Const, shared by all threads.
typedef struct ty_shading_context
{
    const ty_world* world;
    const ty_mip_texture* const* textures;        // by texture_index, all set to the time
    const ty_depth_field* const* depth_fields;    // by prototype, NULL entries where not needed
    const float* const* const* object_attributes; // [object][attribute_index] -> [instance], NULL where absent
    const ty_mesh_attribute* const* const* vertex_attributes; // [prototype][attribute_index], NULL where absent
} ty_shading_context;

// The value of an input at a point: value * (offset + scale * texel or attribute); value alone where neither is
// present. An attribute is that of the instance, else that of the mesh's vertices: one component is grey, of two the
// third is 0, a fourth is left out; a float takes the first. Beside a texture it is a factor as it is.
// Textures are averaged over the point's footprint.
ty_rgb ty_input_color(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point);
float ty_input_float(const ty_input* input, const ty_shading_context* context, const ty_surface_point* point);

// The state at a point. context and point may be NULL where all is constant.
ty_moisture ty_moisture_at(const ty_moisture_inputs* inputs, const ty_shading_context* context,
                           const ty_surface_point* point);
bool ty_moisture_inputs_are_constant(const ty_moisture_inputs* inputs);

// Radiance that the base emits at a point of the outer side, in every direction; and what coat and fuzz leave of it
// towards wo.
ty_rgb ty_material_emission(const ty_material* material, const ty_shading_context* context,
                            const ty_surface_point* point);
ty_rgb ty_material_emission_towards(const ty_material* material, const ty_shading_context* context,
                                    const ty_surface_point* point, ty_vec3 wo);

typedef enum ty_material_trait
{
    TY_TRAIT_TRANSPARENT = 1, // light may go straight through: opacity, smooth sheets
    TY_TRAIT_MEDIUM = 2,      // encloses a medium that light enters
    TY_TRAIT_SCATTERING = 4,  // which scatters it
} ty_material_trait;
unsigned ty_material_traits(const ty_material* material);

// What goes straight through a surface as if nothing were there, and the share of the rest, which the bsdf describes.
typedef struct ty_transparency
{
    ty_rgb through;
    float opacity;
} ty_transparency;
ty_transparency ty_material_transparency(const ty_material* material, const ty_shading_context* context,
                                         const ty_surface_point* point, ty_vec3 wo);

#include <tsuya/shading/bsdf.h>

// Prepares the lobes at a point seen along wo (unit, away from the surface). If the point is seen from behind, opaque
// materials behave as from the front with the normal turned. point may be out's own.
void ty_material_prepare(const ty_material* material, const ty_shading_context* context, const ty_surface_point* point,
                         ty_vec3 wo, ty_bsdf* out);
// The same where not air but a medium of this refractive index is around the body.
void ty_material_prepare_within(const ty_material* material, const ty_shading_context* context,
                                const ty_surface_point* point, ty_vec3 wo, float outside, ty_bsdf* out);
