// SPDX-License-Identifier: Apache-2.0
// Lights: chosen and sampled from a point, and met by rays. They are no part of the world and block nothing.
#pragma once
#include <tsuya/scene/scene.h>
#include <tsuya/shading/sampling.h>

typedef struct ty_light
{
    ty_light_kind kind;
    bool camera_visible;
    ty_rgb value;       // radiance, intensity or irradiance
    float probability;  // of being chosen at a point; 0 = found by rays alone
    ty_vec3 center;     // m
    ty_frame frame;     // rectangle: sides t and b, facing n; directional: n towards the light; environment: its axes
    float half_size[2]; // m
    float area;         // m^2
    float radius;       // m
    float image_mean;   // luminance of an environment's image over the sphere
    const ty_texture* image;       // of an environment, NULL = constant
    ty_distribution* distribution; // over (azimuth, angle from above), owned; NULL = not sampled
} ty_light;

typedef struct ty_light_sample
{
    ty_vec3 wi; // unit, towards the light
    float distance;
    ty_rgb radiance; // arriving along wi; for delta lights what replaces radiance / pdf at pdf = probability
    float pdf;       // per solid angle, the choice included
    bool delta;
} ty_light_sample;

typedef struct ty_light_set
{
    ty_light* lights; // owned, as in the scene
    int count;
    int* chosen;       // lights of positive probability
    float* cumulative; // of their probabilities
    int chosen_count;
    bool has_shapes; // rectangles or spheres
} ty_light_set;

// Only what stands nearer than this share of the way to a light hides it, whichever sampling found it: a surface in the
// lamp's own plane does not.
#define TY_LIGHT_REACH 0.9999f

// How a ray came to be, for the weight of the light it meets.
typedef struct ty_light_view
{
    ty_vec3 from; // the point that light was sampled from
    float pdf;    // of the direction by the surface's own sampling
    bool full;    // no light sampling competed: camera rays and mirror reflections
    bool camera;
    bool done; // all light along the ray has been counted already
} ty_light_view;

void ty_light_set_init(ty_light_set* set, const ty_scene* scene);
void ty_light_set_term(ty_light_set* set);

// False: nothing can arrive from the light that was chosen.
bool ty_light_set_sample(const ty_light_set* set, ty_vec3 p, float u_choice, ty_vec2 u, ty_light_sample* out);

// Emission that a ray meets up to distance t, weighted against light sampling (power heuristic). t = TY_FLOAT_MAX also
// meets the environment. *covered becomes true when a visible rectangle or sphere is met.
ty_rgb ty_light_set_along(const ty_light_set* set, const ty_ray* ray, float t, const ty_light_view* view,
                          bool* covered);

// Weight of the technique with density a where the other has b (Veach 1997, exponent 2), in a form that cannot
// overflow.
static inline float ty_power_heuristic(float a, float b)
{
    float ratio = b / a;
    return 1.0f / (1.0f + ratio * ratio);
}

// --- one file each ---

void ty_light_environment_init(ty_light* light, const ty_light_def* def, const ty_texture* image);
ty_rgb ty_light_environment_radiance(const ty_light* light, ty_vec3 direction);
float ty_light_environment_mean(const ty_light* light); // mean luminance over all directions
bool ty_light_environment_sample(const ty_light* light, ty_vec2 u, ty_light_sample* out);
float ty_light_environment_pdf(const ty_light* light, ty_vec3 wi);

void ty_light_rectangle_init(ty_light* light, const ty_light_def* def);
bool ty_light_rectangle_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out);
bool ty_light_rectangle_meet(const ty_light* light, const ty_ray* ray, float* t); // the lit side alone
float ty_light_rectangle_pdf(const ty_light* light, ty_vec3 p, ty_vec3 wi);       // wi meets it

bool ty_light_sphere_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out);
bool ty_light_sphere_meet(const ty_light* light, const ty_ray* ray, float* t);
float ty_light_sphere_pdf(const ty_light* light, ty_vec3 p);
