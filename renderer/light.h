// SPDX-License-Identifier: Apache-2.0
// Lights: chosen and sampled from a point, and met by rays. Those of the list `lights` are no part of the world and
// block nothing; what materials emit is met as the surface that it is.
#pragma once
#include "film.h"
#include "light_tree.h"
#include <tsuya/base/rng.h>
#include <tsuya/scene/scene.h>
#include <tsuya/shading/sampling.h>

#define TY_MASK_SEEN 15u // the rays that may see a light: camera, diffuse, glossy, transmission

// One of the list; a sky is two: its gradient, and its sun as a directional light.
typedef struct ty_light
{
    ty_light_kind kind;
    int source;                    // index in the scene's list
    int group;                     // light group, -1 = nobody asks
    unsigned visible;              // ty_mask
    bool shadows;                  // what stands in the way hides it
    ty_rgb value;                  // radiance, intensity, or irradiance where a directional light has no angle
    ty_vec3 center;                // m
    ty_frame frame;                // rectangle: sides t and b, facing n; disk, spot: facing n, up b; cylinder: along n;
                                   // directional: n towards the light; environment: its axes
    float half_size[2];            // m, rectangle; cylinder: half length first
    float area;                    // m^2
    float far_sqr;                 // m^2, rectangle: from this distance of the centre on it is sampled by area
    float radius;                  // m
    ty_rgb horizon, ground;        // sky, value being the zenith
    float falloff;                 // sky
    float cos_outer;               // spot: of the half cone; directional: of the disc's half angle
    float one_minus_cos;           // directional: of the disc's half angle, 0 = sharp
    float fade;                    // spot: 1 / (cosine of where the fade begins - cos_outer)
    float image_mean;              // luminance of an environment's image over the sphere
    const ty_texture* image;       // of an environment or spot, NULL = none
    ty_distribution* distribution; // environment: borrowed; NULL = left to the rays
} ty_light;

// An instance whose material emits.
typedef struct ty_light_mesh
{
    uint32_t object, instance;
    int tree; // of its prototype's triangles, in the set's mesh_trees
} ty_light_mesh;

// Where light is gathered: what choosing depends on.
typedef struct ty_light_point
{
    ty_vec3 position;
    ty_vec3 normal; // light from behind it is of no use; zero = light from any side is
    float time;     // within the shutter
    int link;       // which lights light it: index of the set's selections
} ty_light_point;

typedef struct ty_light_sample
{
    ty_vec3 wi; // unit, towards the light
    float distance;
    ty_rgb radiance; // arriving along wi; for delta lights what replaces radiance / pdf at pdf = probability
    float pdf;       // per solid angle, the choice included
    bool delta;
    bool shadows;
    bool solid;     // it lies on a surface of the world: a shadow ray goes to
    ty_vec3 target; // this point, just above
    int group;
    unsigned visible; // ty_mask
} ty_light_sample;

// Emitters are numbered: the lights, then the meshes. How one of those that light an object is chosen: by fixed
// probabilities when they are few, else by a tree for those that have a place and fixed probabilities for the rest.
typedef struct ty_light_selection
{
    int* chosen; // emitters of the table
    float* cumulative;
    float* probability; // [emitter_count], 0 = not in the table
    int chosen_count;
    int only;               // the emitter that is always chosen, -1 = there are none or several
    float endless;          // irradiance of those in the table, where there is a tree
    ty_light_tree* tree;    // NULL = the table has all
    int* shapes;            // lights that a ray can meet
    int shape_count;        // of those
    ty_light_tree* shaping; // the same by their places, where they are many, else NULL
    int* skies;             // lights seen where a ray meets nothing
    int sky_count;
    bool shadowless_skies; // some of them are also seen where a ray meets something
} ty_light_selection;

typedef struct ty_light_set
{
    const ty_scene* scene; // borrowed
    ty_light* lights;      // owned
    int light_count;
    ty_light_mesh* meshes;
    int mesh_count;
    uint32_t* first_mesh;       // [object_count], TY_NONE where the material does not emit
    ty_light_tree** mesh_trees; // owned
    int mesh_tree_count;
    ty_light_selection* selections; // by link
    int selection_count;
    bool restricted; // some light is not visible to every kind of scattering
    bool grouped;    // the film has light groups
} ty_light_set;

// Only what stands nearer than this share of the way to a light hides it, whichever sampling found it: a surface in the
// lamp's own plane does not.
#define TY_LIGHT_REACH 0.9999f

// How a ray came to be, for the weight of the light it meets.
typedef struct ty_light_view
{
    ty_light_point from; // the point that light was sampled from
    float pdf;           // of the direction by the surface's own sampling
    bool full;           // no light sampling competed: camera rays and mirror reflections
    bool done;           // all light along the ray has been counted already, but for what surfaces emit
    unsigned seen;       // ty_mask of the ray
    ty_rgb absorption;   // 1/m, of the medium along the ray
    ty_bsdf_parts parts; // of the direction, where the set is restricted and view is not full
} ty_light_view;

void ty_light_set_init(ty_light_set* set, const ty_scene* scene, bool grouped);
void ty_light_set_term(ty_light_set* set);

// False: nothing can arrive from the light that was chosen.
bool ty_light_set_sample(const ty_light_set* set, const ty_light_point* at, float u_choice, ty_vec2 u,
                         ty_light_sample* out);

// Emission that a ray meets up to distance t, weighted against light sampling (power heuristic), times beta to out.
// t = TY_FLOAT_MAX also meets the skies. True when a visible shape is met.
bool ty_light_set_along(const ty_light_set* set, const ty_ray* ray, float t, const ty_light_view* view,
                        const ty_rgb* beta, ty_film_sample* out);
// Whether that could be anything at all, the world apart.
bool ty_light_set_shines(const ty_light_set* set, const ty_ray* ray, const ty_light_view* view);

// Share that is due to a surface's own emission met by a ray of that view at the point.
ty_rgb ty_light_set_weight(const ty_light_set* set, const ty_surface_point* met, const ty_light_view* view, ty_vec3 wi);
int ty_light_set_object_group(const ty_light_set* set, uint32_t object); // -1 = nobody asks

// Sums over the kinds of lobes in a ty_mask.
ty_rgb ty_light_parts_value(const ty_bsdf_parts* parts, unsigned mask, float* pdf);

// Weight of the technique with density a where the other has b (Veach 1997, exponent 2), in a form that cannot
// overflow.
static inline float ty_power_heuristic(float a, float b)
{
    float ratio = b / a;
    return 1.0f / (1.0f + ratio * ratio);
}

// --- light_select.c: which emitter ---

// lit: [emitter_count], emitters of this selection; NULL = all.
void ty_light_selection_init(ty_light_selection* selection, const ty_light_set* set, const bool* lit,
                             float scene_radius);
void ty_light_selection_term(ty_light_selection* selection);
// Emitter with its probability, -1 = none. rest: a number that is uniform again, for choosing further.
int ty_light_select(const ty_light_set* set, const ty_light_point* at, double u, float* probability, double* rest);
float ty_light_select_probability(const ty_light_set* set, const ty_light_point* at, int emitter);

// --- light_place.c: what selection needs to know of an emitter ---

// False: it has no place (it lights everything evenly, so that distance means nothing).
bool ty_light_leaf(const ty_light_set* set, int emitter, ty_light_node* out);
// Watts of luminance that it sends into the scene, roughly; 0 = it is left to the rays.
float ty_light_power(const ty_light_set* set, int emitter, float scene_radius);
float ty_light_irradiance(const ty_light* light); // of one without a place, on a plane that faces it
static inline bool ty_light_is_shape(const ty_light* light)
{
    return light->kind == TY_LIGHT_RECTANGLE || light->kind == TY_LIGHT_DISK || light->kind == TY_LIGHT_SPHERE ||
           light->kind == TY_LIGHT_CYLINDER;
}

// --- one file each; those with a density can be met by a ray ---

// table: of the image, NULL where that is.
void ty_light_environment_init(ty_light* light, const ty_light_def* def, const ty_texture* image,
                               const ty_environment_table* table);
ty_rgb ty_light_environment_radiance(const ty_light* light, ty_vec3 direction);
float ty_light_environment_mean(const ty_light* light); // mean luminance over all directions
bool ty_light_environment_sample(const ty_light* light, ty_vec2 u, ty_light_sample* out);
float ty_light_environment_pdf(const ty_light* light, ty_vec3 wi);

void ty_light_sky_init(ty_light* gradient, ty_light* sun, const ty_light_def* def);
ty_rgb ty_light_sky_radiance(const ty_light* light, ty_vec3 direction);

void ty_light_directional_init(ty_light* light, ty_vec3 towards, ty_rgb irradiance, float angle);
bool ty_light_directional_sample(const ty_light* light, ty_vec2 u, ty_light_sample* out);
bool ty_light_directional_covers(const ty_light* light, ty_vec3 direction);
float ty_light_directional_pdf(const ty_light* light); // within its disc

void ty_light_rectangle_init(ty_light* light, const ty_light_def* def);
bool ty_light_rectangle_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out);
float ty_light_rectangle_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi); // wi meets it
// The lit side alone, between t_min and limit, in one place because every ray asks: mostly it ends before the plane or
// goes away from it.
static inline bool ty_light_rectangle_meet(const ty_light* light, const ty_ray* ray, float limit, float* t)
{
    float cosine = -ty_dot(ray->direction, light->frame.n);
    ty_vec3 d = ty_sub(ray->origin, light->center);
    *t = ty_dot(d, light->frame.n) / cosine;
    if (!((int)(*t > 0.0f) & (int)(*t >= ray->t_min) & (int)(*t * TY_LIGHT_REACH < limit)))
        return false;
    ty_vec3 q = ty_mad(d, ray->direction, *t);
    return cosine > 0.0f && fabsf(ty_dot(q, light->frame.t)) <= light->half_size[0] &&
           fabsf(ty_dot(q, light->frame.b)) <= light->half_size[1];
}

void ty_light_disk_init(ty_light* light, const ty_light_def* def);
bool ty_light_disk_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out);
bool ty_light_disk_meet(const ty_light* light, const ty_ray* ray, float* t); // the lit side alone
float ty_light_disk_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi);       // wi meets it

bool ty_light_sphere_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out);
bool ty_light_sphere_meet(const ty_light* light, const ty_ray* ray, float* t);
float ty_light_sphere_pdf(const ty_light* light, ty_vec3 p);

void ty_light_cylinder_init(ty_light* light, const ty_light_def* def);
bool ty_light_cylinder_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out);
bool ty_light_cylinder_meet(const ty_light* light, const ty_ray* ray, float* t); // from outside
float ty_light_cylinder_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi);       // wi meets it

void ty_light_spot_init(ty_light* light, const ty_light_def* def, const ty_texture* image);
bool ty_light_spot_sample(const ty_light* light, ty_vec3 p, ty_light_sample* out); // and a point light, cos_outer = -2

void ty_light_meshes_init(ty_light_set* set);
void ty_light_meshes_term(ty_light_set* set);
bool ty_light_mesh_leaf(const ty_light_set* set, const ty_light_mesh* mesh, ty_light_node* out);
bool ty_light_mesh_sample(const ty_light_set* set, const ty_light_mesh* mesh, const ty_light_point* at, double choice,
                          ty_vec2 u, ty_light_sample* out);
float ty_light_mesh_pdf(const ty_light_set* set, const ty_light_mesh* mesh, const ty_light_point* at,
                        const ty_surface_point* met, ty_vec3 wi);
