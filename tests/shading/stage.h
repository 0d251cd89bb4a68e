// SPDX-License-Identifier: Apache-2.0
// A world of one prototype with its depth field, and light carried through it with the lobes' own functions.
#pragma once
#include "spherical.h"
#include <tsuya/geometry/shape.h>
#include <tsuya/shading/cdrf.h>

typedef struct stage
{
    ty_mesh* mesh;
    ty_world* world;
    ty_depth_field* field;
    const ty_depth_field* fields[1];
    ty_shading_context context;
} stage;

// Objects of the stage's mesh under the given maps, closed for light that scatters within or not; without a depth
// field. Returns the prototype.
static inline uint32_t stage_place(stage* s, const ty_affine* maps, int count, bool closed)
{
    ty_error error = {0};
    ty_world_def def = ty_world_def_default();
    uint32_t prototype, object;
    assert_int_equal(ty_world_create(&def, &s->world, &error), TY_OK);
    assert_int_equal(ty_world_add_prototype(s->world, s->mesh, &prototype, &error), TY_OK);
    for (int i = 0; i < count; i++)
        assert_int_equal(ty_world_add_object(s->world, prototype, ty_motion_at_rest(&maps[i]),
                                             (ty_object_flags){closed, TY_MASK_OPAQUE}, &object, &error),
                         TY_OK);
    assert_int_equal(ty_world_commit(s->world, &error), TY_OK);
    s->field = NULL;
    s->context = (ty_shading_context){.world = s->world};
    return prototype;
}

// Objects of one shape under the given maps.
static inline void stage_init(stage* s, const ty_shape_def* shape, const ty_affine* maps, int count)
{
    ty_error error = {0};
    assert_int_equal(ty_shape_create(shape, &s->mesh, &error), TY_OK);
    uint32_t prototype = stage_place(s, maps, count, true);
    assert_int_equal(ty_depth_field_create(s->world, prototype, &s->field, &error), TY_OK);
    s->fields[0] = s->field;
    s->context.depth_fields = s->fields;
}

static inline void stage_init_one(stage* s, const ty_shape_def* shape)
{
    ty_affine identity = ty_affine_identity();
    stage_init(s, shape, &identity, 1);
}

static inline void stage_term(stage* s)
{
    ty_depth_field_destroy(s->field);
    ty_world_destroy(s->world);
    ty_mesh_destroy(s->mesh);
}

static inline ty_shape_def shape_of(ty_shape_kind kind, float x, float y, float z)
{
    ty_shape_def d = ty_shape_def_default();
    d.kind = (int)kind;
    d.radius = x;
    d.tube = y;
    d.size = ty_vec3_make(x, y, z);
    d.divisions = 192;
    return d;
}

// The surface seen from `from` looking along `direction`.
static inline ty_surface_point seen(const stage* s, ty_vec3 from, ty_vec3 direction)
{
    ty_ray ray = ty_ray_make(from, direction, TY_FLOAT_MAX);
    ty_hit hit;
    ty_surface_point p;
    assert_true(ty_world_intersect(s->world, &ray, &hit));
    ty_world_surface(s->world, &hit, &p);
    return p;
}

static inline void random4(ty_rng* rng, float u[4])
{
    for (int i = 0; i < 4; i++)
        u[i] = ty_rng_float(rng);
}

// Radiance from p along wo in an environment of radiance 1, by plain path tracing.
static inline double furnace(const stage* s, const ty_material* material, const ty_surface_point* p, ty_vec3 wo, int n)
{
    ty_rng rng = ty_rng_make((ty_seed){21}, 0, 0);
    double sum = 0.0;
    for (int i = 0; i < n; i++)
    {
        ty_surface_point point = *p;
        ty_vec3 out = wo;
        double beta = 1.0;
        for (int bounce = 0; bounce < 1000; bounce++)
        {
            ty_bsdf b;
            ty_rgb weight;
            ty_bsdf_sample sample;
            float u[4];
            random4(&rng, u);
            ty_material_prepare(material, &s->context, &point, out, &b);
            if (!ty_bsdf_resolve(&b, &s->context, u, &rng, &weight))
                break;
            beta *= (double)weight.g;
            random4(&rng, u);
            if (!ty_bsdf_sample_wi(&b, u[0], (ty_vec2){u[1], u[2]}, &sample))
                break;
            beta *= (double)sample.weight.g;
            ty_ray ray;
            ty_hit hit;
            ty_bsdf_spawn(&b, sample.wi, u[3], &ray);
            if (!ty_world_intersect(s->world, &ray, &hit))
            {
                sum += beta;
                break;
            }
            ty_world_surface(s->world, &hit, &point);
            out = ty_neg(sample.wi);
        }
    }
    return sum / n;
}

// Radiance from p along wo under one directional light, where a facing white Lambert surface shows 1; direct light
// only.
static inline double lit(const stage* s, const ty_material* material, const ty_surface_point* p, ty_vec3 wo,
                         ty_vec3 light, int n)
{
    ty_rng rng = ty_rng_make((ty_seed){22}, 0, 0);
    double sum = 0.0;
    for (int i = 0; i < n; i++)
    {
        ty_bsdf b;
        ty_rgb weight;
        ty_ray ray;
        float u[4], pdf;
        random4(&rng, u);
        ty_material_prepare(material, &s->context, p, wo, &b);
        if (!ty_bsdf_resolve(&b, &s->context, u, &rng, &weight))
            continue;
        ty_bsdf_spawn(&b, light, ty_rng_float(&rng), &ray);
        if (!ty_world_occluded(s->world, &ray))
            sum += (double)(weight.g * ty_bsdf_eval(&b, light, &pdf).g) * M_PI;
    }
    return sum / n;
}

static inline ty_cdrf_def white_cdrf(ty_cdrf_evaluate evaluate, ty_cdrf_kernel kernel, float mean_free_path)
{
    ty_cdrf_def d = ty_cdrf_def_default();
    d.color = ty_input_scalar(1);
    d.specular_weight = ty_input_scalar(0);
    d.evaluate = (int)evaluate;
    d.kernel = (int)kernel;
    d.mean_free_path = ty_input_scalar(mean_free_path);
    return d;
}
