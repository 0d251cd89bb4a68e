// SPDX-License-Identifier: Apache-2.0
// Host, growth and mesh from a recipe, with all that is wanted of them.
#include "roots_output.h"
#include <string.h>
#include <tsuya/base/log.h>

// From the network on. The mesh is out's.
static ty_status products_make(roots_result* result, ty_workers* workers, ty_made* out, ty_error* error)
{
    roots_shape shape;
    double start = ty_time_now();
    ty_status status = roots_shape_make(result->recipe, result->network, result->host, workers, &shape, error);
    if (status != TY_OK)
        return status;
    result->surface_seconds = ty_time_now() - start;
    result->skin = shape.skin;
    result->axes = shape.axes;
    result->mesh = shape.mesh;
    ty_log(TY_LOG_INFO, "roots: %d roots of %d points grown in %.2f s, %u triangles in %.2f s",
           result->network->line_count, result->network->point_count, result->grow_seconds, shape.mesh->triangle_count,
           result->surface_seconds);
    if (out->wants_report)
        out->report = roots_report(result, workers);
    if (out->wants_curves)
        out->curves = roots_curves_text(result->network);
    if (out->wants_host)
        out->host = ty_mesh_copy(result->host->mesh);
    if (out->levels.put && !out->growth.put)
        status = roots_levels_make(result, &out->levels, workers, error);
    if (out->growth.put)
        status = roots_growth_frames(result, &out->growth, workers, error);
    else if (status == TY_OK)
    {
        out->mesh = shape.mesh;
        shape.mesh = NULL;
    }
    roots_shape_term(&shape);
    return status;
}

ty_status ty_roots_make_all(const void* def, ty_workers* workers, ty_made* out, ty_error* error)
{
    const ty_roots_recipe* recipe = def;
    roots_host host;
    roots_network network = {0};
    roots_result result = {.recipe = recipe, .host = &host, .network = &network};
    ty_status status = roots_recipe_check(recipe, error);
    if (status == TY_OK && out->growth.put && recipe->levels > 1)
        status = ty_error_set(error, TY_BAD_INPUT, "levels: %d; frames of growth have one", recipe->levels);
    if (status == TY_OK && recipe->curves)
        status = roots_curves_read(recipe->curves, &network, error);
    double begun = ty_time_now();
    if (status == TY_OK)
        status = roots_host_init(recipe, out->cache, workers, &host, error);
    if (status != TY_OK)
    {
        roots_network_term(&network);
        return status;
    }
    double ready = ty_time_now();
    result.host_seconds = ready - begun;
    if (!recipe->curves)
        status = roots_grow(recipe, &host, workers, &network, error);
    result.grow_seconds = ty_time_now() - ready;
    if (status == TY_OK)
        status = products_make(&result, workers, out, error);
    roots_network_term(&network);
    roots_host_term(&host);
    return status;
}

ty_status ty_roots_make(const void* def, ty_workers* workers, ty_mesh** out, ty_error* error)
{
    ty_made made = {0};
    ty_status status = ty_roots_make_all(def, workers, &made, error);
    *out = made.mesh;
    return status;
}
