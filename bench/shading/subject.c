// SPDX-License-Identifier: Apache-2.0
// The shapes as meshes: built in where the library has them, else a sphere drawn onto the implicit surface.
#include "subject.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <tsuya/geometry/shape.h>

static void must(ty_status status, const ty_error* error)
{
    if (status == TY_OK)
        return;
    fprintf(stderr, "bench_shading: %s\n", error->text);
    exit(1);
}

static ty_shape_def shape_def(const implicit_shape* shape, int divisions)
{
    const double* size = shape->size;
    ty_shape_def d = ty_shape_def_default();
    d.divisions = divisions;
    d.size = ty_mul(ty_vec3_make((float)size[0], (float)size[1], (float)size[2]), MILLIMETRE);
    d.radius = (float)size[0] * MILLIMETRE;
    switch (shape->kind)
    {
    case IMPLICIT_TORUS:
        d.kind = TY_SHAPE_TORUS;
        d.tube = (float)size[1] * MILLIMETRE;
        break;
    case IMPLICIT_DISC:
        d.kind = TY_SHAPE_CYLINDER;
        d.height = 2.0f * (float)size[1] * MILLIMETRE;
        d.rounding = (float)size[2] * MILLIMETRE;
        break;
    case IMPLICIT_CUBE:
        d.kind = TY_SHAPE_BOX;
        d.size = ty_vec3_make(d.radius, d.radius, d.radius);
        d.rounding = (float)size[1] * MILLIMETRE;
        break;
    case IMPLICIT_ELLIPSOID:
        d.kind = TY_SHAPE_ELLIPSOID;
        break;
    case IMPLICIT_SUPER:
    case IMPLICIT_DUMBBELL:
        d.kind = TY_SHAPE_SPHERE;
        d.radius = MILLIMETRE;
        break;
    }
    return d;
}

// Both are seen whole from their centre: every vertex moves along its ray onto the surface.
static void draw_onto(ty_mesh* mesh, const implicit_shape* shape)
{
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 f = ty_normalize(mesh->positions[i]);
        vec d = {(double)f.x, (double)f.y, (double)f.z}, p;
        double low = 0.0, high = shape->bound;
        for (int k = 0; k < 60; k++)
        {
            double middle = 0.5 * (low + high);
            p = (vec){d.x * middle, d.y * middle, d.z * middle};
            if (implicit_value(shape, p) < 0.0)
                low = middle;
            else
                high = middle;
        }
        mesh->positions[i] = ty_mul(vec_float(p), MILLIMETRE);
    }
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    ty_mesh_compute_normals(mesh, TY_PI);
    ty_mesh_compute_curvature(mesh, 1);
}

static ty_mesh* make_mesh(const implicit_shape* shape, int divisions)
{
    ty_mesh* mesh = NULL;
    ty_error error = {0};
    ty_shape_def def = shape_def(shape, divisions);
    must(ty_shape_create(&def, &mesh, &error), &error);
    if (shape->kind == IMPLICIT_SUPER || shape->kind == IMPLICIT_DUMBBELL)
        draw_onto(mesh, shape);
    if (shape->kind == IMPLICIT_TORUS || shape->kind == IMPLICIT_DISC) // turned about y there, about z here
    {
        ty_affine turn = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, 0}};
        ty_mesh_transform(mesh, &turn);
    }
    return mesh;
}

void subject_init(subject* s, const implicit_shape* shape, int divisions)
{
    ty_affine identity = ty_affine_identity();
    subject_init_mapped(s, shape, divisions, &identity);
}

void subject_init_mapped(subject* s, const implicit_shape* shape, int divisions, const ty_affine* map)
{
    ty_error error = {0};
    ty_world_def def = ty_world_def_default();
    uint32_t prototype, object;
    s->mesh = make_mesh(shape, divisions);
    must(ty_world_create(&def, &s->world, &error), &error);
    must(ty_world_add_prototype(s->world, s->mesh, &prototype, &error), &error);
    must(ty_world_add_object(s->world, prototype, ty_motion_at_rest(map), (ty_object_flags){true, TY_MASK_OPAQUE},
                             &object, &error),
         &error);
    must(ty_world_commit(s->world, &error), &error);
    must(ty_depth_field_create(s->world, prototype, &s->field, &error), &error);
    s->fields[0] = s->field;
    s->context = (ty_shading_context){.world = s->world, .depth_fields = s->fields};
}

void subject_term(subject* s)
{
    ty_depth_field_destroy(s->field);
    ty_world_destroy(s->world);
    ty_mesh_destroy(s->mesh);
}

ty_surface_point subject_point(const subject* s, vec x, vec n)
{
    ty_ray ray = ty_ray_make(ty_mul(vec_float(vec_mad(x, n, 0.05)), MILLIMETRE), ty_neg(vec_float(n)), TY_FLOAT_MAX);
    ty_hit hit;
    ty_surface_point p;
    if (!ty_world_intersect(s->world, &ray, &hit))
    {
        fprintf(stderr, "bench_shading: a mesh is not where its shape is\n");
        exit(1);
    }
    ty_world_surface(s->world, &hit, &p);
    return p;
}

static ty_material* make_cdrf(const ty_cdrf_def* def)
{
    ty_material* material;
    ty_error error = {0};
    must(ty_material_create_cdrf(def, &material, &error), &error);
    return material;
}

ty_material* subject_cdrf(ty_cdrf_evaluate evaluate, ty_cdrf_kernel kernel, double mean_free_path)
{
    ty_cdrf_def d = ty_cdrf_def_default();
    d.color = ty_input_scalar(1);
    d.specular_weight = ty_input_scalar(0);
    d.evaluate = (int)evaluate;
    d.kernel = (int)kernel;
    d.mean_free_path = ty_input_scalar((float)mean_free_path * MILLIMETRE);
    return make_cdrf(&d);
}

ty_material* subject_depth_colored(const double path[3], const double color[3])
{
    ty_cdrf_def d = ty_cdrf_def_default();
    double longest = fmax(path[0], fmax(path[1], path[2]));
    d.color = ty_input_make(ty_rgb_make((float)color[0], (float)color[1], (float)color[2]));
    d.specular_weight = ty_input_scalar(0);
    d.mean_free_path = ty_input_scalar((float)longest * MILLIMETRE);
    d.mean_free_path_scale =
        ty_input_make(ty_rgb_make((float)(path[0] / longest), (float)(path[1] / longest), (float)(path[2] / longest)));
    return make_cdrf(&d);
}

double subject_color_of(double albedo)
{
    float low = 0.0f, high = 1.0f;
    for (int i = 0; i < 40; i++)
    {
        float middle = 0.5f * (low + high);
        if (1.0 - (double)ty_cdrf_loss(middle, 0) < albedo)
            low = middle;
        else
            high = middle;
    }
    return (double)(0.5f * (low + high));
}

ty_material* subject_walk(double mean_free_path, double albedo)
{
    ty_walk_def d = ty_walk_def_default();
    ty_material* material;
    ty_error error = {0};
    d.common.color = ty_input_scalar(1);
    d.common.specular_weight = ty_input_scalar(0);
    d.common.mean_free_path = ty_input_scalar((float)mean_free_path * MILLIMETRE);
    if (albedo < 1.0)
    {
        d.scattering = ty_input_scalar((float)(albedo / mean_free_path));
        d.absorption = ty_input_scalar((float)((1.0 - albedo) / mean_free_path));
    }
    must(ty_material_create_walk(&d, &material, &error), &error);
    return material;
}

bool subject_leave(const subject* s, const ty_material* material, const ty_surface_point* p, const float u[4],
                   ty_rng* rng, ty_bsdf* b, ty_rgb* weight)
{
    ty_material_prepare(material, &s->context, p, p->ns, b);
    return ty_bsdf_resolve(b, &s->context, u, rng, weight);
}

void subject_light(const subject* s, const ty_bsdf* b, double weight, ty_rng* rng, const vec* directions, int count,
                   double* light)
{
    for (int i = 0; i < count; i++)
    {
        float pdf;
        ty_vec3 wi = vec_float(directions[i]);
        double f = weight * (double)ty_bsdf_eval(b, wi, &pdf).g * (double)TY_PI;
        ty_ray ray;
        if (f <= 0.0)
            continue;
        ty_bsdf_spawn(b, wi, ty_rng_float(rng), &ray);
        if (!ty_world_occluded(s->world, &ray))
            light[i] += f;
    }
}

void roberts_sequence(int k, const double turn[4], float u[4])
{
    static const double step[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
    for (int i = 0; i < 4; i++)
    {
        double x = turn[i] + step[i] * k;
        u[i] = fminf((float)(x - floor(x)), 0x1.fffffep-1f);
    }
}
