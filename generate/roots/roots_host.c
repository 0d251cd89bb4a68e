// SPDX-License-Identifier: Apache-2.0
// What roots grow on: a mesh asked for its closest point, its field of distance, and the plane it stands on.
#include "roots_host.h"
#include <tsuya/base/log.h>

static ty_status world_make(roots_host* host, ty_error* error)
{
    ty_world_def def = ty_world_def_default();
    ty_status status = ty_world_create(&def, &host->world, error);
    if (status == TY_OK)
        status = ty_world_add_prototype(host->world, host->mesh, &host->prototype, error);
    return status == TY_OK ? ty_world_commit(host->world, error) : status;
}

// A root as thick as its host has nothing to hold on to.
static ty_status radius_check(const ty_roots_recipe* recipe, const ty_mesh* mesh, ty_error* error)
{
    float most = host_longest(mesh);
    if (recipe->radius <= most)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "radius: %g mm; at most %g mm, the host's longest side",
                        (double)recipe->radius * 1e3, (double)most * 1e3);
}

// Cells have to be larger than what numbers tell apart where the host stands: four of their steps.
static ty_status detail_check(const ty_roots_recipe* recipe, const ty_mesh* mesh, ty_error* error)
{
    float reach = host_reach(mesh), least = 0x1p-21f * reach;
    if (recipe->detail >= least)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT,
                        "detail: %g mm; at least %.3g mm where the host reaches %g m from the origin",
                        (double)recipe->detail * 1e3, (double)least * 1e3, (double)reach);
}

static ty_status obstacles_make(const ty_roots_recipe* recipe, const char* cache, ty_workers* workers, roots_host* out,
                                ty_error* error)
{
    ty_mesh* mesh;
    if (recipe->obstacles.count == 0)
        return TY_OK;
    ty_status status = host_objects_make("obstacles", &recipe->obstacles, &mesh, NULL, error);
    if (status != TY_OK)
        return status;
    status = host_field_make(mesh, recipe->host.resolution, cache, workers, &out->obstacles, NULL, error);
    ty_mesh_destroy(mesh);
    return status;
}

ty_status roots_host_init(const ty_roots_recipe* recipe, const char* cache, ty_workers* workers, roots_host* out,
                          ty_error* error)
{
    const ty_roots_host_def* def = &recipe->host;
    int32_t* nearest = NULL;
    host_parts parts = {0};
    host_sources* painted = NULL;
    double start = ty_time_now();
    *out = (roots_host){.has_floor = def->floor};
    ty_status status = host_mesh_make(def, &out->mesh, &parts, error);
    if (status == TY_OK)
        status = radius_check(recipe, out->mesh, error);
    if (status == TY_OK)
        status = detail_check(recipe, out->mesh, error);
    if (status == TY_OK)
        status = host_sources_open(out->mesh, def, &parts, &painted, error);
    if (status == TY_OK)
        status = world_make(out, error);
    if (status == TY_OK)
        status =
            host_field_make(out->mesh, def->resolution, cache, workers, &out->field, painted ? &nearest : NULL, error);
    if (status == TY_OK && painted)
        status = host_masks_make(out, painted, nearest, workers, error);
    host_sources_close(painted);
    ty_free(nearest);
    host_parts_term(&parts);
    if (status == TY_OK)
        status = obstacles_make(recipe, cache, workers, out, error);
    if (status == TY_OK)
    {
        out->floor = out->mesh->bounds.low.y + def->floor_height;
        ty_log(TY_LOG_INFO, "roots: host of %u triangles in %.2f s", out->mesh->triangle_count, ty_time_now() - start);
    }
    else
        roots_host_term(out);
    return status;
}

void roots_host_term(roots_host* host)
{
    ty_world_destroy(host->world);
    ty_mesh_destroy(host->mesh);
    ty_voxels_term(&host->field);
    ty_voxels_term(&host->obstacles);
    for (int i = 0; i < ROOTS_MASKS; i++)
        ty_free(host->masks[i]);
    *host = (roots_host){0};
}

// --- distances ---

float host_field_value(const ty_voxels* f, ty_vec3 p, ty_vec3* gradient)
{
    ty_vec3 q = ty_mul(ty_sub(p, f->origin), 1.0f / f->step);
    const float at[3] = {q.x, q.y, q.z};
    float part[3], off[3];
    size_t low = 0, stride[3] = {1, (size_t)f->size[0], (size_t)f->size[0] * (size_t)f->size[1]};
    for (int i = 0; i < 3; i++)
    {
        float x = ty_clamp(at[i], 0.0f, (float)(f->size[i] - 1) - 1e-3f);
        int cell = (int)x;
        off[i] = at[i] - x;
        part[i] = x - (float)cell;
        low += stride[i] * (size_t)cell;
    }
    const float *v = f->values + low, *w = v + stride[2];
    size_t y = stride[1];
    float v00 = ty_lerp(v[0], v[1], part[0]), v10 = ty_lerp(v[y], v[y + 1], part[0]);
    float v01 = ty_lerp(w[0], w[1], part[0]), v11 = ty_lerp(w[y], w[y + 1], part[0]);
    float v0 = ty_lerp(v00, v10, part[1]), v1 = ty_lerp(v01, v11, part[1]);
    float dx0 = ty_lerp(v[1] - v[0], v[y + 1] - v[y], part[1]), dx1 = ty_lerp(w[1] - w[0], w[y + 1] - w[y], part[1]);
    ty_vec3 g = {ty_lerp(dx0, dx1, part[2]), ty_lerp(v10 - v00, v11 - v01, part[2]), v1 - v0};
    g = ty_mul(g, 1.0f / f->step);
    ty_vec3 beyond = ty_mul(ty_vec3_make(off[0], off[1], off[2]), f->step);
    float away = ty_length(beyond);
    *gradient = away > f->step ? ty_normalize(ty_add(ty_mul(g, ty_lerp(v0, v1, part[2])), beyond)) : g;
    return ty_lerp(v0, v1, part[2]) + away;
}

float roots_host_value(const roots_host* host, ty_vec3 p, ty_vec3* gradient)
{
    ty_vec3 g;
    float d = host_field_value(&host->field, p, &g), floor = p.y - host->floor;
    if (host->has_floor && floor < d)
    {
        d = floor;
        g = ty_vec3_make(0.0f, 1.0f, 0.0f);
    }
    if (gradient)
        *gradient = g;
    return d;
}

float roots_host_clear(const roots_host* host, ty_vec3 p, ty_vec3* gradient)
{
    ty_vec3 g = {0.0f, 0.0f, 0.0f};
    float d = host->obstacles.values ? host_field_value(&host->obstacles, p, &g) : TY_FLOAT_MAX;
    if (gradient)
        *gradient = g;
    return d;
}

// Which side of the surface p is on, next to it, where the field's own sign may err: that of the field a little way on
// from the surface through p. Of a sheet both sides are outside.
static float side_of(const roots_host* host, const ty_closest* c, ty_vec3 away)
{
    ty_vec3 g, beyond = ty_mad(c->position, away, 1.5f * host->field.step);
    return host_field_value(&host->field, beyond, &g) < 0.0f ? -1.0f : 1.0f;
}

static ty_vec3 facet_normal(const roots_host* host, uint32_t triangle)
{
    const uint32_t* c = host->mesh->triangles[triangle];
    const ty_vec3* at = host->mesh->positions;
    ty_vec3 n = ty_cross(ty_sub(at[c[1]], at[c[0]]), ty_sub(at[c[2]], at[c[0]]));
    return ty_length_sqr(n) > 0.0f ? ty_normalize(n) : ty_vec3_make(0.0f, 1.0f, 0.0f);
}

// Of a place inside: whether its closest point is on a face that lies within another part of the host, where the field
// knows better.
static bool is_buried(const roots_host* host, const ty_closest* c, ty_vec3 away)
{
    ty_vec3 g, beyond = ty_mad(c->position, away, -0.75f * host->field.step);
    return host_field_value(&host->field, beyond, &g) < -0.25f * host->field.step;
}

// The distance of a place inside from the outer face that it would come out by, which is sought from outside, up along
// the field; where that finds a face that the place is not under, from farther over that one.
static float outer_exact(const roots_host* host, ty_vec3 p, float d, ty_vec3* normal)
{
    float step = host->field.step;
    ty_vec3 out = ty_mad(p, *normal, step - d);
    for (int i = 0; i < 3; i++)
    {
        ty_closest c;
        if (!ty_world_closest(host->world, host->prototype, out, 3.0f * step, &c) || c.distance < 1e-3f * step)
            break;
        ty_vec3 n = ty_mul(ty_sub(out, c.position), 1.0f / c.distance);
        float height = ty_dot(ty_sub(p, c.position), n);
        if (height < 0.0f)
        {
            *normal = n;
            return height;
        }
        out = ty_mad(out, n, step);
    }
    return d;
}

// The distance of the mesh where the field says d.
static float mesh_exact(const roots_host* host, ty_vec3 p, float d, ty_vec3* normal)
{
    ty_closest c;
    float step = host->field.step, reach = fabsf(d) + step; // wide searches are slow, and about lids there is no mesh
    if (!ty_world_closest(host->world, host->prototype, p, reach, &c))
        return d;
    if (c.distance <= 1e-3f * step) // the way to the surface says nothing
    {
        ty_vec3 n = ty_length_sqr(*normal) > 0.25f ? *normal : facet_normal(host, c.triangle);
        *normal = ty_mul(n, side_of(host, &c, n));
        return ty_dot(ty_sub(p, c.position), *normal) < 0.0f ? -c.distance : c.distance;
    }
    ty_vec3 away = ty_mul(ty_sub(p, c.position), 1.0f / c.distance);
    if (d < 0.0f && is_buried(host, &c, away))
        return outer_exact(host, p, d, normal);
    float side = fabsf(d) > 0.75f * step ? (d < 0.0f ? -1.0f : 1.0f) : side_of(host, &c, away);
    *normal = ty_mul(away, side);
    return side * c.distance;
}

float roots_host_exact(const roots_host* host, ty_vec3 p, float reach, ty_vec3* normal)
{
    ty_vec3 g;
    float d = host_field_value(&host->field, p, &g), floor = p.y - host->floor;
    *normal = ty_length_sqr(g) > 0.0f ? ty_normalize(g) : ty_vec3_make(0.0f, 1.0f, 0.0f);
    if (fabsf(d) < reach)
        d = mesh_exact(host, p, d, normal);
    if (!host->has_floor || floor >= d)
        return d;
    *normal = ty_vec3_make(0.0f, 1.0f, 0.0f);
    return floor;
}

bool roots_host_keep(const roots_host* host, float depth, ty_vec3* p)
{
    float step = host->field.step;
    ty_vec3 n;
    if (roots_host_value(host, *p, NULL) > 2.0f * step - depth)
        return false;
    for (int i = 0; i < 24; i++) // between two surfaces one move leads under the other, in clefts again and again
    {
        float height = roots_host_exact(host, *p, depth + 2.0f * step, &n);
        if (height >= -1.0001f * depth)
            break;
        *p = ty_mad(*p, n, -depth - height);
    }
    return true;
}

ty_vec3 roots_host_project(const roots_host* host, ty_vec3 p, float height, ty_vec3* normal)
{
    ty_vec3 g;
    for (int i = 0; i < 3; i++)
    {
        float wrong = roots_host_value(host, p, &g) - height, steep = ty_max(ty_length_sqr(g), 0.25f);
        p = ty_mad(p, g, -wrong / steep);
        if (fabsf(wrong) < 1e-3f * host->field.step)
            break;
    }
    *normal = ty_length_sqr(g) > 0.0f ? ty_normalize(g) : ty_vec3_make(0.0f, 1.0f, 0.0f);
    return p;
}
