// SPDX-License-Identifier: Apache-2.0
// A scene around a glTF file: what one sees who only names the file.
#include "loader.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define FRAMING_VFOV 35.0f // degrees
#define HEIGHT 540         // px

bool ty_gltf_is_file(const char* path)
{
    const char* extension = ty_path_extension(path);
    return strcasecmp(extension, "glb") == 0 || strcasecmp(extension, "gltf") == 0;
}

// Bounds of everything: as the accessors say, else of the meshes themselves.
static ty_status find_bounds(ty_gltf_scene* gltf, ty_bounds* out, ty_error* error)
{
    *out = gltf->bounds;
    if (out->low.x <= out->high.x)
        return TY_OK;
    ty_mesh* mesh = NULL;
    ty_status status = ty_gltf_scene_read_meshes(gltf, error);
    if (status == TY_OK)
        status = ty_gltf_scene_merge(gltf, &mesh, error);
    if (status == TY_OK)
        *out = mesh->bounds;
    ty_mesh_destroy(mesh);
    return status;
}

// All of it, from the front, the right and above.
static void add_framing(ty_text* text, ty_bounds bounds)
{
    ty_vec3 middle = ty_mul(ty_add(bounds.low, bounds.high), 0.5f);
    float radius = ty_max(0.5f * ty_length(ty_sub(bounds.high, bounds.low)), 1e-6f);
    float distance = 1.02f * radius / ty_sin(0.5f * ty_radians(FRAMING_VFOV));
    ty_vec3 eye = ty_mad(middle, ty_normalize(ty_vec3_make(0.55f, 0.4f, 1.0f)), distance);
    ty_text_format(text,
                   "camera: { position: [%.9g, %.9g, %.9g], look_at: [%.9g, %.9g, %.9g], vfov: %g, near_clip: %.3g }\n",
                   (double)eye.x, (double)eye.y, (double)eye.z, (double)middle.x, (double)middle.y, (double)middle.z,
                   (double)FRAMING_VFOV, (double)ty_min(0.001f, 0.001f * distance));
}

static void add_film(ty_text* text, const ty_gltf_scene* gltf)
{
    float aspect = gltf->camera_count > 0 && gltf->cameras[0].aspect > 0.0f ? gltf->cameras[0].aspect : 16.0f / 9.0f;
    int width = (int)ty_clamp((float)HEIGHT * aspect + 0.5f, 1.0f, 8.0f * HEIGHT);
    ty_text_format(text, "film: { size: [%d, %d] }\n", width, HEIGHT);
}

static ty_status compose(const char* path, ty_gltf_scene* gltf, ty_text* text, ty_error* error)
{
    const char* slash = strrchr(path, '/');
    ty_bounds bounds = ty_bounds_empty();
    bool has_camera = gltf->camera_count > 0;
    ty_status status = has_camera ? TY_OK : find_bounds(gltf, &bounds, error);
    if (status != TY_OK)
        return status;
    ty_text_add(text, "tsuya: 1\nassets: { model: { gltf: ");
    ty_text_quote(text, slash ? slash + 1 : path);
    ty_text_format(text, " } }\nobjects: [ { gltf: model, file_lights: %s%s } ]\n",
                   gltf->light_count > 0 ? "true" : "false", has_camera ? ", file_camera: 0" : "");
    add_film(text, gltf);
    if (!has_camera)
        add_framing(text, bounds);
    if (gltf->light_count == 0)
        ty_text_add(text, "lights: [ { type: sky, zenith: 1.1, horizon: 0.8, ground: 0.35, falloff: 0.6, "
                          "sun_irradiance: 1.2, sun_elevation: 50, sun_azimuth: 130, sun_angle: 12 } ]\n");
    return TY_OK;
}

ty_status ty_gltf_scene_text(const char* path, ty_text* out, ty_error_list* errors)
{
    ty_error error = {0};
    ty_gltf_scene* gltf;
    ty_status status = ty_gltf_scene_open(path, NULL, NULL, &gltf, &error);
    if (status == TY_OK)
    {
        status = compose(path, gltf, out, &error);
        ty_gltf_scene_destroy(gltf);
    }
    if (status != TY_OK)
        ty_error_list_add(errors, &error);
    return status;
}
