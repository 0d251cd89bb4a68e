// SPDX-License-Identifier: Apache-2.0
// Aggregates as binary PLY points, in Houdini's names.
#include "aggregate_write.h"
#include "glb.h"
#include "ply.h"
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/sink.h>
#include <tsuya/geometry/aggregate_export.h>

// Beyond some parts in a million scale_x .. scale_z are written too.
static bool is_stretched(ty_vec3 s)
{
    float spread = ty_max(fabsf(s.x - s.y), fabsf(s.x - s.z));
    return spread > 4e-6f * fabsf(s.x);
}

static void put_note(ty_sink* text, const char* key, const char* note)
{
    char* line = TY_ALLOC(char, ply_note_bound(note) + 1);
    char* end = ply_note_write(key, note, line);
    ty_sink_put(text, line, (size_t)(end - line));
    ty_free(line);
}

static void put_header(ty_sink* text, const ty_aggregate* a, bool stretched)
{
    ty_sink_format(text, "ply\nformat binary_little_endian 1.0\n");
    put_note(text, "hash", a->hash);
    put_note(text, "recipe", a->recipe);
    ty_sink_format(text,
                   "element vertex %u\nproperty float x\nproperty float y\nproperty float z\nproperty float orient_x\n"
                   "property float orient_y\nproperty float orient_z\nproperty float orient_w\nproperty float pscale\n",
                   a->instance_count);
    if (stretched)
        ty_sink_format(text, "property float scale_x\nproperty float scale_y\nproperty float scale_z\n");
    ty_sink_format(text, "property uint id\n");
    if (a->prototype_count > 1)
        ty_sink_format(text, "property uint prototype\n");
    if (a->velocities)
        ty_sink_format(text, "property float vx\nproperty float vy\nproperty float vz\n");
    if (a->spins)
        ty_sink_format(text, "property float wx\nproperty float wy\nproperty float wz\n");
    for (int k = 0; k < a->attribute_count; k++)
        ty_sink_format(text, "property float %s\n", ty_aggregate_attribute_by_name(a, k)->name);
    ty_sink_format(text, "end_header\n");
}

static void put_vector(ty_sink* text, ty_vec3 v)
{
    ty_sink_f32(text, v.x);
    ty_sink_f32(text, v.y);
    ty_sink_f32(text, v.z);
}

static void put_point(ty_sink* text, const ty_aggregate* a, const float* const* attributes, uint32_t i,
                      const ty_placement* p, bool stretched)
{
    const float place[7] = {p->translation.x, p->translation.y, p->translation.z, p->rotation.x,
                            p->rotation.y,    p->rotation.z,    p->rotation.w};
    for (int k = 0; k < 7; k++)
        ty_sink_f32(text, place[k]);
    ty_sink_f32(text, stretched ? 1.0f : p->scale.x);
    if (stretched)
        put_vector(text, p->scale);
    ty_sink_u32(text, a->ids[i]);
    if (a->prototype_count > 1)
        ty_sink_u32(text, a->prototype_index[i]);
    if (a->velocities)
        put_vector(text, a->velocities[i]);
    if (a->spins)
        put_vector(text, a->spins[i]);
    for (int k = 0; k < a->attribute_count; k++)
        ty_sink_f32(text, attributes[k][i]);
}

// The names of the columns that every such file has, or may have.
static ty_status check_names(const ty_aggregate* a, const char* path, ty_error* error)
{
    static const char* const own[] = {"x",        "y",      "z",       "orient_x", "orient_y", "orient_z",
                                      "orient_w", "pscale", "scale_x", "scale_y",  "scale_z",  "prototype",
                                      "vx",       "vy",     "vz",      "wx",       "wy",       "wz"};
    for (int k = 0; k < a->attribute_count; k++)
        for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
            if (strcmp(a->attributes[k].name, own[i]) == 0)
                return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "\"%s\" cannot name an attribute of points",
                                       own[i]);
    return TY_OK;
}

ty_status ty_aggregate_write_points(const char* path, const ty_aggregate* a, ty_error* error)
{
    ty_status status = ty_aggregate_check_content(a, path, error);
    if (status == TY_OK)
        status = check_names(a, path, error);
    ty_placement* placements = NULL;
    if (status == TY_OK)
        status = ty_aggregate_split(a, path, "points", &placements, error);
    if (status != TY_OK)
        return status;
    bool stretched = false;
    for (uint32_t i = 0; i < a->instance_count && !stretched; i++)
        stretched = is_stretched(placements[i].scale);
    const float* attributes[TY_GLTF_ATTRIBUTES_MAX];
    for (int k = 0; k < a->attribute_count; k++)
        attributes[k] = ty_aggregate_attribute_by_name(a, k)->values;
    ty_sink text = {0};
    put_header(&text, a, stretched);
    for (uint32_t i = 0; i < a->instance_count; i++)
        put_point(&text, a, attributes, i, &placements[i], stretched);
    status = ty_file_write(path, text.bytes, text.size, error);
    ty_sink_term(&text);
    ty_free(placements);
    return status;
}
