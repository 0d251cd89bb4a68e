// SPDX-License-Identifier: Apache-2.0
// Places on a host where main roots start: given, or painted.
#include "roots_host.h"

// A given place put on the surface, where it is near.
static ty_status point_place(const roots_host* host, const ty_roots_recipe* recipe, int index, roots_start* out,
                             ty_error* error)
{
    ty_vec3 p = ((const ty_vec3*)recipe->start.points.items)[index];
    float far = 0.1f * host_longest(host->mesh), deep = ty_max(recipe->radius, 2.0f * host->field.step);
    float d = roots_host_exact(host, p, far, &out->n);
    if (!(d <= far))
        return ty_error_set(error, TY_BAD_INPUT, "start.points[%d]: [%g, %g, %g] is %.3g m from the host; at most %.3g",
                            index, (double)p.x, (double)p.y, (double)p.z, (double)d, (double)far);
    if (d < -deep)
        return ty_error_set(error, TY_BAD_INPUT,
                            "start.points[%d]: [%g, %g, %g] is inside of the host, %.3g m deep; at most %.3g", index,
                            (double)p.x, (double)p.y, (double)p.z, (double)-d, (double)deep);
    out->p = ty_mad(p, out->n, -d);
    return TY_OK;
}

// Painted vertices, each time the one that is farthest from all starts so far; the first one is the highest. Their
// order does not change with how many are asked for.
static void painted_take(const roots_host* host, const host_channel* channel, int most, roots_start* out, int* count)
{
    const ty_mesh* mesh = host->mesh;
    float* nearest = TY_ALLOC(float, mesh->vertex_count); // squared; -1: not painted
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        nearest[v] = channel->values[(size_t)v * (size_t)channel->stride] > 0.5f ? TY_FLOAT_MAX : -1.0f;
        for (int i = 0; i < *count && nearest[v] >= 0.0f; i++)
            nearest[v] = ty_min(nearest[v], ty_length_sqr(ty_sub(mesh->positions[v], out[i].p)));
    }
    while (*count < most)
    {
        int64_t best = -1;
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            if (nearest[v] > 0.0f && (best < 0 || nearest[v] > nearest[best] ||
                                      (nearest[v] == nearest[best] && mesh->positions[v].y > mesh->positions[best].y)))
                best = v;
        if (best < 0)
            break;
        roots_start* start = &out[(*count)++];
        start->p = mesh->positions[best];
        (void)roots_host_exact(host, start->p, 2.0f * host->field.step, &start->n);
        for (uint32_t v = 0; v < mesh->vertex_count; v++)
            nearest[v] = ty_min(nearest[v], ty_length_sqr(ty_sub(mesh->positions[v], start->p)));
    }
    ty_free(nearest);
}

ty_status roots_host_starts(const roots_host* host, const ty_roots_recipe* recipe, int most, roots_start** out,
                            int* count, ty_error* error)
{
    const ty_roots_start_def* def = &recipe->start;
    bool painted = def->attribute && def->attribute[0];
    int room = def->points.count > most ? def->points.count : most;
    ty_status status = TY_OK;
    host_channel channel = {0};
    *out = NULL;
    *count = 0;
    if (def->points.count == 0 && !painted)
        return TY_OK;
    if (painted)
        status = host_channel_find(host->mesh, "start.attribute", def->attribute, &channel, error);
    roots_start* starts = TY_ALLOC(roots_start, room);
    for (int i = 0; i < def->points.count && status == TY_OK; i++)
        status = point_place(host, recipe, (*count)++, &starts[i], error);
    if (status == TY_OK && painted)
        painted_take(host, &channel, most, starts, count);
    if (status == TY_OK && *count == 0)
        status = ty_error_set(error, TY_BAD_INPUT, "start.attribute: '%.100s' is above 0.5 at no vertex of the host",
                              def->attribute);
    if (status == TY_OK)
        *out = starts;
    else
    {
        *count = 0;
        ty_free(starts);
    }
    return status;
}
