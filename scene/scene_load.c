// SPDX-License-Identifier: Apache-2.0
// A scene from its file to the frozen ty_scene: tree, tables, files, world.
#include "loader.h"
#include <string.h>
#include <tsuya/base/log.h>

#define FORMAT "tsuya scene 1" // in the hash: a scene of another format is another scene

static void check_sections(ty_loader* loader)
{
    static const char* const keys[] = {"film",      "camera",   "render",    "assets",  "materials", "objects",
                                       "lights",    "ocio",     "tsuya",     "include", "vars",      "search",
                                       "overrides", "timeline", "turntable", "frame",   NULL};
    (void)ty_params_check_keys(&loader->reader, loader->root, keys, "a scene"); // reported
}

static void read_sections(ty_loader* loader)
{
    check_sections(loader);
    ty_read_view(loader);
    ty_read_assets(loader);
    ty_read_materials(loader);
    ty_read_objects(loader);
    ty_read_lights(loader);
    ty_read_links(loader);
}

// Overrides are in the tree by now. What they were is kept in the text as well, behind those that an earlier recipe
// tells of, so that the picture of a recipe says what the picture it came from said.
static void record_overrides(ty_loader* loader)
{
    const char* given = ty_override_text(loader->arena, loader->options);
    ty_node* recorded = ty_node_get(loader->root, "overrides");
    if (recorded && recorded->kind != TY_NODE_SCALAR)
    {
        char described[80];
        ty_report(loader->errors, recorded->place, TY_BAD_INPUT, "'overrides': expected a text, got %s",
                  ty_node_describe(recorded, described));
        return;
    }
    const char* before = recorded ? recorded->text : "";
    const char* all = ty_arena_format(loader->arena, "%s%s%s", before, before[0] && given[0] ? " " : "", given);
    loader->scene->overrides = all;
    if (!recorded && all[0])
    {
        recorded = ty_node_create(&loader->tree, TY_NODE_SCALAR, loader->root->place);
        if (!recorded)
            return;
        ty_node_add(&loader->tree, loader->root, (ty_key){"overrides", loader->root->place}, recorded);
    }
    if (recorded)
        recorded->text = all;
}

// The text that makes the same scene again, after everything was read: paths are relative to the scene's folder now.
static void write_recipe(ty_loader* loader)
{
    ty_timeline_show_keys(&loader->timeline, true);
    char* body = ty_node_is_empty(loader->root) ? ty_string_copy("") : ty_tree_emit(loader->root);
    ty_timeline_show_keys(&loader->timeline, false);
    ty_free(loader->scene->resources->recipe);
    loader->scene->recipe = loader->scene->resources->recipe = ty_string_format("tsuya: 1\n%s", body);
    ty_free(body);
}

static void hash_scene(ty_loader* loader)
{
    ty_error error;
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add_string(hasher, FORMAT);
    ty_hasher_add_string(hasher, loader->scene->recipe);
    for (int i = 0; i < loader->asset_count; ++i)
        if (loader->assets[i].kind == TY_ASSET_RECIPE)
            ty_hasher_add_string(hasher, loader->assets[i].recipe.generator->build_id);
    if (ty_files_add_to_hash(&loader->files, 0, loader->files.count, hasher, &error) != TY_OK)
        ty_error_list_add(loader->errors, &error);
    ty_hash_hex(ty_hasher_end(hasher), loader->scene->hash);
}

void ty_frame_write_recipe(ty_loader* loader)
{
    write_recipe(loader);
    hash_scene(loader);
}

// Each stage needs the one before without a mistake; a check goes on to the files to find those mistakes as well.
static void load_stages(ty_loader* loader, int first)
{
    if (!ty_loader_resolve(loader))
        return;
    ty_frame_begin(loader);
    ty_gltf_expand(loader);
    read_sections(loader);
    ty_frame_check_keys(loader);
    bool good = loader->errors->count == first;
    if (!loader->scene->color || (!good && !loader->options->check_only))
        return;
    ty_load_textures(loader);
    ty_load_assets(loader);
    ty_load_surface_textures(loader);
    ty_bind_objects(loader);
    ty_resolve_slots(loader);
    ty_build_attributes(loader);
    if (loader->errors->count > first)
        return;
    ty_pose_scene(loader);
    if (!loader->options->check_only)
        ty_set_mesh_motion(loader);
    if (loader->errors->count > first)
        return;
    record_overrides(loader);
    ty_frame_write_recipe(loader);
    if (loader->errors->count == first && !loader->options->check_only)
        ty_build_world(loader);
}

static ty_status finish(ty_loader* loader, const char* path, double start, int first, ty_scene** out)
{
    ty_scene* scene = loader->scene;
    if (loader->root)
        load_stages(loader, first);
    ty_forget_repeated(loader->errors, first);
    scene->path = ty_arena_string(loader->arena, path);
    scene->load_seconds = ty_time_now() - start;
    bool good = loader->root && loader->errors->count == first;
    ty_status status = good ? TY_OK : ty_loader_status(loader->errors, first);
    if (good)
    {
        ty_loader_keep(loader);
        *out = scene;
        return status;
    }
    ty_loader_destroy(loader);
    ty_scene_destroy(scene);
    return status;
}

// The file of a path: a folder stands for the scene.yaml in it.
static const char* scene_file(const char* path, char file[TY_PATH_MAX])
{
    if (ty_folder_exists(path))
        ty_path_join(path, "scene.yaml", file);
    else
        ty_path_join(".", path, file);
    return strncmp(file, "./", 2) == 0 ? file + 2 : file;
}

// A loader with the tree of text, or of the file where text is NULL.
static ty_loader* read_tree(const char* name, const void* text, size_t size, const ty_scene_options* options,
                            ty_error_list* errors)
{
    char folder[TY_PATH_MAX];
    ty_path_folder(name, folder);
    ty_loader* loader = ty_loader_create(folder, options, errors);
    loader->root = text ? ty_document_parse(&loader->tree, &loader->files, name, text, size)
                        : ty_document_load(&loader->tree, &loader->files, name, "", NULL);
    return loader;
}

ty_status ty_scene_load(const char* path, const ty_scene_options* options, ty_scene** out, ty_error_list* errors)
{
    char file[TY_PATH_MAX];
    double start = ty_time_now();
    *out = NULL;
    const char* shown = scene_file(path, file);
    if (ty_gltf_is_file(shown))
    {
        ty_text text = {0};
        ty_status status = ty_gltf_scene_text(shown, &text, errors);
        if (status == TY_OK)
            status = ty_scene_load_memory(shown, text.data, text.size, options, out, errors);
        ty_text_term(&text);
        return status;
    }
    int first = errors->count;
    return finish(read_tree(shown, NULL, 0, options, errors), shown, start, first, out);
}

ty_status ty_scene_load_memory(const char* name, const void* bytes, size_t size, const ty_scene_options* options,
                               ty_scene** out, ty_error_list* errors)
{
    double start = ty_time_now();
    *out = NULL;
    int first = errors->count;
    return finish(read_tree(name, bytes, size, options, errors), name, start, first, out);
}

ty_timeline_def ty_scene_read_timeline(const char* path, const ty_scene_options* options)
{
    char file[TY_PATH_MAX];
    static const char none[] = "tsuya: 1\n"; // a glTF file tells of no time, but overrides may
    const char* shown = scene_file(path, file);
    ty_timeline_def timeline = ty_timeline_def_default();
    ty_error_list errors = {0};
    ty_loader* loader = read_tree(shown, ty_gltf_is_file(shown) ? none : NULL, sizeof none - 1, options, &errors);
    if (loader->root && ty_loader_resolve_tree(loader))
    {
        ty_frame_read_timeline(loader);
        timeline = loader->scene->timeline;
    }
    ty_scene* scene = loader->scene;
    ty_loader_destroy(loader);
    ty_scene_destroy(scene);
    ty_error_list_term(&errors);
    return timeline;
}

void ty_scene_destroy(ty_scene* scene)
{
    if (!scene)
        return;
    for (uint32_t i = 0; i < scene->resources->depth_field_count; ++i)
        ty_depth_field_destroy(scene->depth_fields[i]);
    ty_world_destroy(scene->world);
    for (int i = 0; scene->textures && i < scene->texture_count; ++i)
        ty_texture_destroy(scene->textures[i]);
    for (int i = 0; scene->environment_tables && i < scene->texture_count; ++i)
        ty_environment_table_term(&scene->environment_tables[i]);
    for (int i = 0; scene->surface_textures && i < scene->surface_texture_count; ++i)
        ty_mip_texture_destroy(scene->surface_textures[i]);
    ty_mip_cache_destroy(scene->texture_cache);
    for (int i = 0; scene->materials && i < scene->material_count; ++i)
        ty_material_destroy(scene->materials[i]);
    for (int i = 0; i < scene->resources->mesh_count; ++i)
        ty_mesh_destroy(scene->resources->meshes[i]);
    for (int i = 0; i < scene->resources->aggregate_count; ++i)
        ty_aggregate_destroy(scene->resources->aggregates[i]);
    for (int i = 0; i < scene->resources->passing_count; ++i)
    {
        char parent[TY_PATH_MAX];
        ty_folder_remove(scene->resources->passing[i]);
        ty_path_folder(scene->resources->passing[i], parent);
        ty_folder_remove(parent);
    }
    for (int i = 0; i < scene->resources->sequence_count; ++i)
        ty_mesh_sequence_destroy(scene->resources->sequences[i]);
    for (int i = 0; i < scene->resources->gltf_count; ++i)
        ty_gltf_scene_destroy(scene->resources->gltfs[i]);
    ty_color_destroy(scene->color);
    ty_free(scene->resources->recipe);
    if (scene->resources->loader)
        ty_loader_destroy(scene->resources->loader);
    ty_arena_destroy(scene->arena);
}
