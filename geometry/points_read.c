// SPDX-License-Identifier: Apache-2.0
// PLY points as an aggregate.
#include "points_read.h"
#include "placement.h"
#include "ply.h"
#include <string.h>

typedef struct columns
{
    const ply_points* points;
    bool used[PLY_MAX_PROPERTIES];
} columns;

// NULL when there is none; else it will not become an attribute.
static const float* use_column(columns* c, const char* name)
{
    for (int i = 0; i < c->points->column_count; i++)
        if (strcmp(c->points->names[i], name) == 0)
        {
            c->used[i] = true;
            return c->points->columns[i];
        }
    return NULL;
}

// count columns named by one of the patterns; false when no pattern has them all.
static bool use_vector(columns* c, const char* const (*patterns)[4], int pattern_count, int count, const float** out)
{
    for (int p = 0; p < pattern_count; p++)
    {
        int found = 0;
        while (found < count && ply_points_column(c->points, patterns[p][found]))
            found++;
        if (found < count)
            continue;
        for (int k = 0; k < count; k++)
            out[k] = use_column(c, patterns[p][k]);
        return true;
    }
    return false;
}

static const char* const orients[][4] = {
    {"orient[0]", "orient[1]", "orient[2]", "orient[3]"},
    {"orient0", "orient1", "orient2", "orient3"},
    {"orient_0", "orient_1", "orient_2", "orient_3"},
    {"orient_x", "orient_y", "orient_z", "orient_w"},
    {"rot_0", "rot_1", "rot_2", "rot_3"},
    {"rot_x", "rot_y", "rot_z", "rot_w"},
};
static const char* const scales[][4] = {{"scale_x", "scale_y", "scale_z"}, {"scale[0]", "scale[1]", "scale[2]"}};

static const char* const velocities[][4] = {{"vx", "vy", "vz"}, {"v[0]", "v[1]", "v[2]"}, {"v_x", "v_y", "v_z"}};
static const char* const spins[][4] = {{"wx", "wy", "wz"}, {"w[0]", "w[1]", "w[2]"}, {"w_x", "w_y", "w_z"}};

static void move_points(columns* c, ty_aggregate* out)
{
    const float *v[3], *w[3];
    if (use_vector(c, velocities, sizeof velocities / sizeof velocities[0], 3, v))
        (void)ty_aggregate_add_velocities(out);
    if (use_vector(c, spins, sizeof spins / sizeof spins[0], 3, w))
        (void)ty_aggregate_add_spins(out);
    for (uint32_t i = 0; i < out->instance_count && out->velocities; i++)
        out->velocities[i] = ty_vec3_make(v[0][i], v[1][i], v[2][i]);
    for (uint32_t i = 0; i < out->instance_count && out->spins; i++)
        out->spins[i] = ty_vec3_make(w[0][i], w[1][i], w[2][i]);
}

static void place_points(columns* c, const float* const xyz[3], ty_aggregate* out)
{
    const float *orient[4], *scale[3], *id = use_column(c, "id");
    const float* size = use_column(c, "pscale");
    bool turned = use_vector(c, orients, sizeof orients / sizeof orients[0], 4, orient);
    bool stretched = use_vector(c, scales, sizeof scales / sizeof scales[0], 3, scale);
    if (!size && !stretched)
        size = use_column(c, "scale");
    for (uint32_t i = 0; i < out->instance_count; i++)
    {
        ty_placement p = {{xyz[0][i], xyz[1][i], xyz[2][i]}, {0, 0, 0, 1}, {1, 1, 1}};
        if (turned)
            p.rotation = (ty_quat){orient[0][i], orient[1][i], orient[2][i], orient[3][i]};
        if (stretched)
            p.scale = (ty_vec3){scale[0][i], scale[1][i], scale[2][i]};
        if (size)
            p.scale = ty_mul(p.scale, size[i]);
        out->transforms[i] = ty_placement_compose(&p);
        // Beyond 2^24 a float does not hold every number: then the place stays the id.
        if (id && id[i] >= 0.0f && id[i] <= 16777216.0f)
            out->ids[i] = (uint32_t)id[i];
    }
}

static void add_attributes(const columns* c, ty_aggregate* out)
{
    for (int k = 0; k < c->points->column_count; k++)
    {
        if (c->used[k])
            continue;
        char name[sizeof out->attributes[0].name];
        size_t n = 0;
        // As the names of our own files: lower case, and _ for what is neither letter nor digit.
        for (const char* at = c->points->names[k]; *at && n < sizeof name - 1; at++)
        {
            char lower = (char)(*at >= 'A' && *at <= 'Z' ? *at - 'A' + 'a' : *at);
            name[n++] = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9') ? lower : '_';
        }
        name[n] = '\0';
        memcpy(ty_aggregate_add_attribute(out, name), c->points->columns[k], out->instance_count * sizeof(float));
    }
}

static ty_status build(const char* name, const ply_points* points, const ty_mesh* prototype, ty_aggregate** out,
                       ty_error* error)
{
    columns c = {.points = points};
    const float* xyz[3] = {use_column(&c, "x"), use_column(&c, "y"), use_column(&c, "z")};
    if (!xyz[0] || !xyz[1] || !xyz[2])
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "the points have no x, y and z");
    if (points->count == 0 || points->count >= UINT32_MAX)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "%llu points; an aggregate needs at least one",
                               (unsigned long long)points->count);
    ty_aggregate* a = ty_aggregate_create((uint32_t)points->count, 1);
    if (a)
        a->prototypes[0] = ty_mesh_copy(prototype);
    if (!a || !a->prototypes[0])
    {
        ty_aggregate_destroy(a);
        return ty_error_set_at(error, TY_NO_MEMORY, name, 0, 0, "no memory for %llu instances",
                               (unsigned long long)points->count);
    }
    place_points(&c, xyz, a);
    move_points(&c, a);
    add_attributes(&c, a);
    *out = a;
    return TY_OK;
}

ty_status ty_points_read_memory(const char* name, const void* bytes, size_t size, const ty_mesh* prototype,
                                ty_aggregate** out, ty_error* error)
{
    *out = NULL;
    if (!prototype)
        return ty_error_set_at(error, TY_BAD_INPUT, name, 0, 0, "points need a prototype mesh");
    ply_points points;
    ty_status status = ply_read_points(name, bytes, size, &points, error);
    if (status != TY_OK)
        return status;
    status = build(name, &points, prototype, out, error);
    ply_points_term(&points);
    return status;
}
