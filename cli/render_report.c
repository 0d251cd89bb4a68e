// SPDX-License-Identifier: Apache-2.0
// Statistics of a render as text and JSON.
#include "render_report.h"
#include <stdio.h>
#include <tsuya/base/log.h>

static json_t* count(uint64_t value)
{
    return json_integer((json_int_t)value);
}

static json_t* rebuilds_json(const ty_scene_rebuilds* rebuilds)
{
    return json_pack("{s:i, s:i, s:i, s:i, s:i, s:i, s:i}", "frames", rebuilds->frames, "meshes", rebuilds->meshes,
                     "cameras", rebuilds->cameras, "materials", rebuilds->materials, "lights", rebuilds->lights,
                     "objects", rebuilds->objects, "worlds", rebuilds->worlds);
}

json_t* ty_render_stats_json(const ty_scene* scene, const ty_render_stats* stats, const char* output)
{
    uint64_t rays = stats->camera_rays + stats->path_rays + stats->shadow_rays + stats->interior_rays;
    json_t* root = json_object();
    json_object_set_new(root, "scene", ty_json_from_text(scene->path));
    json_object_set_new(root, "hash", json_string(scene->hash));
    json_object_set_new(root, "output", output ? ty_json_from_text(output) : json_null());
    json_object_set_new(root, "frame", json_real(scene->frame));
    json_object_set_new(root, "rebuilds", rebuilds_json(&scene->rebuilds));
    json_object_set_new(root, "width", json_integer(scene->film.size[0]));
    json_object_set_new(root, "height", json_integer(scene->film.size[1]));
    json_object_set_new(root, "samples", json_integer(stats->samples_done));
    json_object_set_new(root, "triangles", count(scene->triangle_count));
    json_object_set_new(root, "instances", count(scene->instance_count));
    json_object_set_new(root, "load_seconds", json_real(scene->load_seconds));
    json_object_set_new(root, "asset_seconds", json_real(scene->asset_seconds));
    json_object_set_new(root, "build_seconds", json_real(scene->build_seconds));
    json_object_set_new(root, "render_seconds", json_real(stats->seconds));
    json_object_set_new(root, "camera_rays", count(stats->camera_rays));
    json_object_set_new(root, "path_rays", count(stats->path_rays));
    json_object_set_new(root, "shadow_rays", count(stats->shadow_rays));
    json_object_set_new(root, "interior_rays", count(stats->interior_rays));
    json_object_set_new(root, "path_vertices", count(stats->path_vertices));
    json_object_set_new(root, "walks_lost", count(stats->walks_lost));
    json_object_set_new(root, "walks_cut", count(stats->walks_cut));
    json_object_set_new(root, "samples_per_second", json_real((double)stats->camera_rays / stats->seconds));
    json_object_set_new(root, "rays_per_second", json_real((double)rays / stats->seconds));
    json_object_set_new(root, "nonfinite_samples", count(stats->nonfinite_samples));
    json_object_set_new(root, "saturated_samples", count(stats->saturated_samples));
    json_object_set_new(root, "assets_made", json_integer(scene->assets_made));
    json_object_set_new(root, "assets_cached", json_integer(scene->assets_cached));
    json_object_set_new(root, "scene_memory_bytes", count(ty_world_memory(scene->world)));
    if (scene->texture_cache)
    {
        ty_mip_cache_stats textures;
        ty_mip_cache_get_stats(scene->texture_cache, &textures);
        json_object_set_new(root, "textures_converted", json_integer(textures.files_converted));
        json_object_set_new(root, "textures_found", json_integer(textures.files_found));
        json_object_set_new(root, "texture_seconds", json_real(textures.convert_seconds));
        json_object_set_new(root, "texture_memory_bytes", count(textures.bytes_now));
        json_object_set_new(root, "texture_bytes_read", count(textures.bytes_read));
        json_object_set_new(root, "texture_tiles_read", count(textures.tiles_read));
    }
    json_object_set_new(root, "peak_memory_bytes", count(ty_memory_peak()));
    return root;
}

ty_status ty_render_report(const ty_scene* scene, const ty_arguments* arguments, const ty_render_stats* stats,
                           const char* output, const char* preview)
{
    uint64_t rays = stats->camera_rays + stats->path_rays + stats->shadow_rays + stats->interior_rays;
    ty_log(TY_LOG_INFO, "%d samples in %.1f s (%.3f Msamples/s, %.2f Mray/s), load %.1f s, peak %.0f MB",
           stats->samples_done, stats->seconds, (double)stats->camera_rays / stats->seconds * 1e-6,
           (double)rays / stats->seconds * 1e-6, scene->load_seconds, (double)ty_memory_peak() * 1e-6);
    const char* path = ty_argument_text(arguments, "stats", NULL);
    if (path)
    {
        ty_status status = ty_json_write(path, ty_render_stats_json(scene, stats, output));
        if (status != TY_OK)
        {
            return status;
        }
    }
    if (ty_argument_has(arguments, "json"))
    {
        return ty_json_print(ty_render_stats_json(scene, stats, output));
    }
    return ty_render_report_files(arguments, output, preview);
}

ty_status ty_render_report_files(const ty_arguments* arguments, const char* output, const char* preview)
{
    if (output && !ty_argument_has(arguments, "json"))
    {
        printf("%s\n", output);
        if (preview[0])
        {
            printf("%s\n", preview);
        }
    }
    return ty_output_finish();
}
