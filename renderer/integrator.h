// SPDX-License-Identifier: Apache-2.0
// What turns one camera ray into one film sample. Const and shared by all workers, but for the counters.
#pragma once
#include "camera.h"
#include "film.h"
#include "light.h"
#include "pixel_filter.h"
#include "sampler.h"
#include <tsuya/shading/media.h>

typedef struct ty_integrator
{
    const ty_scene* scene;   // borrowed
    ty_camera camera;        // at the frame's own moment
    ty_camera* camera_steps; // over the open shutter; owned, NULL = it stands still
    int camera_step_count;
    ty_pixel_filter filter;
    ty_light_set lights;
    ty_sobol sobol;
    uint32_t group_count;     // light groups of the film
    bool has_transparent;     // something light goes straight through
    bool has_media;           // clear bodies
    ty_media media;           // those the camera is in
    uint32_t* first_instance; // by object: number of its instance 0, from 1 over the whole scene; owned
} ty_integrator;

// One per worker, on cache lines of its own.
typedef struct ty_counters
{
    _Alignas(64) uint64_t camera_rays;
    uint64_t path_rays, shadow_rays, interior_rays, path_vertices;
    uint64_t walks_lost, walks_cut;
    uint64_t nonfinite_samples, saturated_samples;
    int first_nonfinite[3]; // x, y, sample; valid when nonfinite_samples > 0
} ty_counters;

// Surface seen by the camera, for the film's other channels.
void ty_integrator_record(const ty_integrator* in, const ty_bsdf* bsdf, ty_film_sample* out);

// Mean curvature of the mesh, 1/m in the world; 0 where the mesh has none.
float ty_integrator_curvature(const ty_world* world, const ty_surface_point* point);

// out has begun; the ray is the camera's.
void ty_path_sample(const ty_integrator* in, const ty_sampler* sampler, const ty_ray* ray, ty_counters* counters,
                    ty_film_sample* out);
void ty_debug_sample(const ty_integrator* in, const ty_sampler* sampler, const ty_ray* ray, ty_counters* counters,
                     ty_film_sample* out);
