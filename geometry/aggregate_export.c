// SPDX-License-Identifier: Apache-2.0
// Which writer an ending stands for.
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/mesh_file.h>

const char* const ty_aggregate_endings[] = {"glb", "usda", "ply", "obj", NULL};

ty_status ty_mesh_export(const char* path, const ty_mesh* mesh, ty_error* error)
{
    const char* ending = ty_path_extension(path);
    if (strcmp(ending, "obj") == 0)
        return ty_obj_write(path, mesh, error);
    if (strcmp(ending, "ply") == 0)
        return ty_ply_write(path, mesh, error);
    if (strcmp(ending, "glb") == 0)
        return ty_glb_write_mesh(path, mesh, error);
    return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "a realised mesh goes to .glb, .ply or .obj");
}

static ty_status write_realised(const char* path, const ty_aggregate* a, ty_error* error)
{
    ty_mesh* mesh;
    ty_status status = ty_aggregate_realise(a, &mesh, error);
    if (status != TY_OK)
        return status;
    status = ty_mesh_export(path, mesh, error);
    ty_mesh_destroy(mesh);
    return status;
}

ty_status ty_aggregate_export(const char* path, const ty_aggregate* a, bool realised, ty_error* error)
{
    const char* ending = ty_path_extension(path);
    bool known = false;
    for (int i = 0; ty_aggregate_endings[i]; i++)
        known = known || strcmp(ending, ty_aggregate_endings[i]) == 0;
    if (!known)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "an aggregate goes to .glb, .usda, .ply or .obj");
    if (strcmp(ending, "usda") == 0 && !realised)
        return ty_aggregate_write_usd(path, a, error);
    if (strcmp(ending, "usda") == 0)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "a realised mesh goes to .glb, .ply or .obj");
    if (realised || strcmp(ending, "obj") == 0)
        return write_realised(path, a, error);
    return strcmp(ending, "ply") == 0 ? ty_aggregate_write_points(path, a, error) : ty_aggregate_write(path, a, error);
}
