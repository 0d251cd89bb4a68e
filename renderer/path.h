// SPDX-License-Identifier: Apache-2.0
// What one path carries from vertex to vertex, and the light that is gathered at a vertex.
#pragma once
#include "cone.h"

#define TY_PATH_MAX_PASSED 256 // surfaces that a ray goes straight through

typedef struct ty_path
{
    ty_ray ray;
    ty_rgb beta; // throughput
    ty_light_view view;
    ty_cone cone;
    int bounce;           // surfaces scattered at before the present one; those passed straight through do not count
    int passed;           // straight through, all together
    bool soft;            // scattered by something that is no mirror already
    bool indirect;        // and once more: what the ray meets is indirect light
    bool diffused;        // scattered by something matte or translucent already
    bool at_boundary;     // the present surface bounds a medium:
    bool entering;        // the ray arrived from outside of it
    ty_medium body;       // behind it
    ty_rng rng;           // of scatterings in media
    int scatterings;      // in media
    float entered;        // largest channel of beta at the first of them since the last surface
    float lead;           // m, of the way in the medium before the ray's origin, which keeps off the surface; or less
                          // than 0: what the origin lies before the ray's true start
    ty_vec3 inward;       // normal of that surface, into the medium
    ty_rgb absorption[2]; // 1/m, of the media on wo's side of the present surface and beyond it
    ty_media media;       // the ray is in; last, because paths in air leave it untouched
} ty_path;

// Where a surface gathers light, for choosing a light there.
ty_light_point ty_path_light_point(const ty_integrator* in, const ty_bsdf* bsdf);

// A ray leaves the surface towards a sampled direction: what of the view follows from that.
void ty_path_turn(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, ty_light_view* view);

// One light sample at a surface that gathers light there, times beta to out. u: two for the light's surface, one to
// choose it, one for the ray's start.
void ty_path_direct_light(const ty_integrator* in, const ty_path* p, const ty_bsdf* bsdf, const ty_light_point* at,
                          const float u[4], const ty_rgb* beta, ty_film_sample* out, ty_counters* counters);

// What the sampled direction of a coat meets of the lights, the scene between, times beta to out. u: for the ray's
// start.
void ty_path_light_along(const ty_integrator* in, const ty_path* p, const ty_bsdf* bsdf, const ty_light_point* at,
                         const ty_bsdf_sample* sample, float u, ty_film_sample* out, ty_counters* counters);

// Adds light found at the path's end; what is indirect can be limited, for less noise and a darker picture.
void ty_path_add(const ty_integrator* in, bool indirect, int group, ty_rgb light, ty_film_sample* out);
// The same of all that a ray met together, in a sample of its own.
void ty_path_add_limited(const ty_integrator* in, const ty_film_sample* met, ty_film_sample* out);

// --- path_media.c ---

// The next surface of a body within which nothing else exists.
bool ty_path_meet_own(const ty_world* world, const ty_medium* body, const ty_ray* ray, ty_hit* hit);

#define TY_PATH_MAX_SCATTERINGS 65536 // of a path, in media

typedef enum ty_path_flight
{
    TY_PATH_PASSED,    // the distance, without being scattered; beta is weighed on arrival
    TY_PATH_SCATTERED, // the ray is the next one
    TY_PATH_ENDED,
} ty_path_flight;

// A free flight along the path's ray through matter that ends at a distance.
ty_path_flight ty_path_scatter(const ty_scattering* matter, float distance, ty_path* p, ty_counters* counters);

void ty_path_find_media(const ty_scene* scene, ty_vec3 p, ty_media* out); // closed clear bodies around a point
void ty_path_pass(const ty_surface_point* point, float t, ty_ray* ray);   // t: of the hit at point
// A ray of the path has left a surface into the medium that the path is in: it begins on its own line, and what of the
// way lies before that counts.
void ty_path_keep_way(const ty_surface_point* point, ty_path* p);
// The ray goes straight through the surface of a clear body: on its way out it has left the medium, too.
void ty_path_leave(const ty_scene* scene, const ty_material* material, const ty_surface_point* point, ty_vec3 direction,
                   ty_media* media);
// What arrives along a shadow ray past all that stands in its way, and through the medium in which it begins.
ty_rgb ty_path_transmittance(const ty_integrator* in, ty_ray* ray, ty_rgb absorption, float distance,
                             ty_counters* counters);
