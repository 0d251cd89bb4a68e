// SPDX-License-Identifier: Apache-2.0
// The mesh of roots by the recipe's kind, and coarser levels of it.
#include "roots_output.h"
#include <tsuya/base/log.h>

ty_status roots_shape_make(const ty_roots_recipe* recipe, const roots_network* network, const roots_host* host,
                           ty_workers* workers, roots_shape* out, ty_error* error)
{
    *out = (roots_shape){0};
    if (recipe->mesh == TY_ROOTS_TUBES)
        return roots_tubes_make(recipe, network, host, 0, workers, &out->mesh, &out->axes, error);
    return roots_surface(recipe, network, host, workers, &out->skin, &out->mesh, error);
}

void roots_shape_term(roots_shape* shape)
{
    ty_mesh_destroy(shape->mesh);
    roots_skin_destroy(shape->skin);
    ty_free(shape->axes);
    *shape = (roots_shape){0};
}

// To a radius at least, and as round as it gets thicker: what lies on the host rises with it.
static void thicken(roots_point* p, float least)
{
    if (p->r >= least)
        return;
    float flat = ty_lerp(1.0f, p->flat, p->r / least), held = ty_min(p->sink * 20.0f, 1.0f);
    p->p = ty_mad(p->p, p->n, held * ((flat - p->sink) * least - (p->flat - p->sink) * p->r));
    p->flat = flat;
    p->r = least;
}

// Cells twice as large for each level. Roots that are too thin for them stay, as thick as cells can show: a silhouette
// without them would be off by their length, so it is off by part of a cell.
static ty_status surface_level(const roots_result* result, int level, ty_workers* workers, ty_mesh** out,
                               ty_error* error)
{
    ty_roots_recipe recipe = *result->recipe;
    roots_network network = {.top = result->network->top};
    roots_skin* skin;
    recipe.detail *= (float)(1 << level);
    for (int l = 0; l < result->network->line_count; l++)
        roots_network_add_line(&network, &result->network->lines[l]);
    for (int i = 0; i < result->network->point_count; i++)
    {
        roots_point p = result->network->points[i];
        thicken(&p, 1.1f * recipe.detail);
        roots_network_add_point(&network, &p);
    }
    ty_status status = roots_surface(&recipe, &network, result->host, workers, &skin, out, error);
    roots_skin_destroy(skin);
    roots_network_term(&network);
    return status;
}

ty_status roots_levels_make(const roots_result* result, const ty_mesh_sink* sink, ty_workers* workers, ty_error* error)
{
    ty_status status = TY_OK;
    for (int level = 1; level < result->recipe->levels && status == TY_OK; level++)
    {
        ty_mesh* mesh;
        double start = ty_time_now();
        status =
            result->recipe->mesh == TY_ROOTS_TUBES
                ? roots_tubes_make(result->recipe, result->network, result->host, level, workers, &mesh, NULL, error)
                : surface_level(result, level, workers, &mesh, error);
        if (status != TY_OK)
            break;
        ty_log(TY_LOG_INFO, "roots: level %d of %u triangles in %.2f s", level, mesh->triangle_count,
               ty_time_now() - start);
        status = sink->put(sink->context, level, mesh, error);
        ty_mesh_destroy(mesh);
    }
    return status;
}
