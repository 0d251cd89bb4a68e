// SPDX-License-Identifier: Apache-2.0
// Cones along a path (T. Akenine-Moeller et al. 2021, "Improved shader and texture level of detail using ray cones",
// sec. 3), widened where a lobe scatters by the solid angle that one sample stands for.
#include "cone.h"

#define WIDEST 1.0f // radians

// Samples share a pixel, and a lobe: each stands for its part. Never less than an eighth of the whole, as the pixel
// filter blurs anyway.
static float share(const ty_scene* scene)
{
    return ty_max(0.125f, 1.0f / sqrtf((float)scene->render.samples));
}

// How wide a pixel is where the ray begins, and how fast it grows: its solid angle as a circle's.
static ty_cone pixel_cone(const ty_camera* camera, ty_vec3 direction)
{
    float height = camera->inverse_size[1], cosine = 0.0f;
    switch (camera->projection)
    {
    case TY_PROJECTION_PERSPECTIVE: // falls with the third power of the cosine to the axis
        cosine = ty_max(ty_dot(direction, camera->forward), 0.0f);
        return (ty_cone){.spread = 2.0f * camera->half_height * height * cosine * sqrtf(cosine)};
    case TY_PROJECTION_ORTHOGRAPHIC:
        return (ty_cone){.width = 2.0f * camera->half_height * height};
    case TY_PROJECTION_EQUIRECTANGULAR: // pixels grow narrow towards the poles
        cosine = ty_safe_sqrt(1.0f - ty_sqr(ty_dot(direction, camera->up)));
        return (ty_cone){.spread = TY_PI * sqrtf(2.0f * camera->inverse_size[0] * height * cosine)};
    }
    return (ty_cone){0};
}

ty_cone ty_cone_begin(const ty_integrator* in, const ty_ray* ray)
{
    const ty_scene* scene = in->scene;
    if (scene->surface_texture_count == 0 || !scene->render.texture_filter)
        return (ty_cone){0};
    ty_cone pixel = pixel_cone(&in->camera, ray->direction);
    return (ty_cone){pixel.width * share(scene), pixel.spread * share(scene), true};
}

void ty_cone_arrive(ty_cone* cone, ty_vec3 direction, float distance, ty_surface_point* point)
{
    if (!cone->active)
        return;
    cone->width = fabsf(cone->width + cone->spread * distance);
    ty_surface_set_footprint(point, direction, cone->width);
}

void ty_cone_scatter(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, ty_cone* cone)
{
    if (!cone->active)
        return;
    float extra = sample->delta ? 0.0f : ty_min(share(in->scene) / sqrtf(ty_max(sample->pdf, 1e-6f)), WIDEST);
    if (extra < 0.1f) // else what the surface's curvature adds is lost in it
    {
        // The normal turns by this angle across the width.
        float turn = ty_integrator_curvature(in->scene->world, &bsdf->point) * cone->width;
        turn = bsdf->entering ? turn : -turn;
        if (!sample->transmitted)
            cone->spread += 2.0f * turn;
        else
            cone->spread = (cone->spread + turn) / (bsdf->eta > 0.0f ? bsdf->eta : 1.0f) - turn;
    }
    if (extra > 0.0f)
        cone->spread = sqrtf(cone->spread * cone->spread + extra * extra);
    cone->spread = ty_clamp(cone->spread, -WIDEST, WIDEST);
}

float ty_integrator_curvature(const ty_world* world, const ty_surface_point* point)
{
    const ty_mesh* mesh = ty_world_mesh(world, point->object, point->instance);
    if (!mesh->curvature_1 || !mesh->curvature_2)
        return 0.0f;
    float sum =
        ty_world_interpolate(world, point, mesh->curvature_1) + ty_world_interpolate(world, point, mesh->curvature_2);
    // Stretched instances are taken at the mean of their scale: cube root of the volume ratio.
    ty_affine map = ty_world_to_world(world, point->object, point->instance, point->time);
    float volume = fabsf(ty_affine_determinant(&map));
    return 0.5f * sum / ty_pow(volume, 1.0f / 3.0f);
}
