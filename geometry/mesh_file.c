// SPDX-License-Identifier: Apache-2.0
// Which reader a mesh file goes to.
#include "mesh_import.h"
#include "ply.h"
#include <strings.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/gltf.h>
#include <tsuya/geometry/mesh_file.h>

static const float CREASE = 0.7f;              // radians, 40 degrees
static const size_t LARGEST = (size_t)8 << 30; // bytes

static ty_status read_ply(const char* path, float crease, ty_mesh** out, ty_error* error)
{
    ty_bytes bytes;
    ty_status status = ty_file_read(path, LARGEST, &bytes, error);
    if (status == TY_OK)
    {
        status = ply_read(path, bytes.data, bytes.size, crease, out, error);
        ty_bytes_term(&bytes);
    }
    return status;
}

static ty_status read_gltf(const char* path, ty_mesh** out, ty_error* error)
{
    ty_gltf_scene* scene;
    ty_status status = ty_gltf_scene_open(path, NULL, NULL, &scene, error);
    if (status != TY_OK)
    {
        return status;
    }
    for (int i = 0; i < scene->warning_count; i++)
    {
        ty_log(TY_LOG_WARNING, "%s: %s", path, scene->warnings[i]);
    }
    status = ty_gltf_scene_read_meshes(scene, error);
    if (status == TY_OK)
    {
        status = ty_gltf_scene_merge(scene, out, error);
    }
    ty_gltf_scene_destroy(scene);
    return status;
}

ty_status ty_mesh_read(const char* path, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    const char* extension = ty_path_extension(path);
    if (strcasecmp(extension, "ply") == 0)
    {
        return read_ply(path, CREASE, out, error);
    }
    if (mesh_import_knows(extension))
    {
        if (!ty_file_exists(path))
        {
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "no such file");
        }
        return mesh_import(path, out, error);
    }
    if (strcasecmp(extension, "glb") == 0 || strcasecmp(extension, "gltf") == 0)
    {
        return read_gltf(path, out, error);
    }
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                           "unknown mesh type '.%s' (ply, obj, stl, fbx, dae, off, glb, gltf)", extension);
}

ty_status ty_mesh_read_frame(const char* path, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    if (strcasecmp(ty_path_extension(path), "ply") != 0)
    {
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "sequences of meshes are read from .ply files");
    }
    return read_ply(path, TY_PI, out, error);
}
