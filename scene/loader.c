// SPDX-License-Identifier: Apache-2.0
// What every load begins with: the tree made final, the colour configuration, the search folders.
#include "loader.h"
#include <string.h>
#include <tsuya/base/log.h>

ty_loader* ty_loader_create(const char* folder, const ty_scene_options* options, ty_error_list* errors)
{
    ty_arena* arena = ty_arena_create(0);
    ty_arena* passing = ty_arena_create(0);
    ty_loader* loader = TY_ARENA_ALLOC(passing, ty_loader, 1);
    loader->options = options;
    loader->arena = arena;
    loader->tree = (ty_tree){.arena = passing};
    loader->files = (ty_files){.arena = arena, .sandbox = options->sandbox};
    loader->files.folder = ty_arena_string(arena, folder);
    loader->reader = (ty_reader){.arena = arena, .files = &loader->files, .context = loader};
    ty_loader_report_to(loader, errors);
    loader->scene = TY_ARENA_ALLOC(arena, ty_scene, 1);
    loader->scene->arena = arena;
    loader->scene->resources = TY_ARENA_ALLOC(arena, struct ty_scene_resources, 1);
    return loader;
}

void ty_loader_keep(ty_loader* loader)
{
    loader->kept_options = (ty_scene_options){.trace_path = loader->options->trace_path,
                                              .isa = loader->options->isa,
                                              .check_only = loader->options->check_only};
    loader->options = &loader->kept_options;
    loader->scene->resources->loader = loader;
    ty_loader_report_to(loader, NULL);
}

void ty_loader_report_to(ty_loader* loader, ty_error_list* errors)
{
    loader->errors = loader->tree.errors = loader->files.errors = loader->reader.errors = errors;
}

void ty_loader_destroy(ty_loader* loader)
{
    ty_arena_destroy(loader->tree.arena);
}

void* ty_loader_grow(ty_arena* arena, void* items, int count, int* capacity, size_t size)
{
    if (count < *capacity)
        return items;
    int larger = *capacity ? 2 * *capacity : 16;
    void* grown = ty_arena_alloc(arena, (size_t)larger, size);
    if (count)
        memcpy(grown, items, (size_t)count * size);
    *capacity = larger;
    return grown;
}

ty_status ty_loader_status(const ty_error_list* errors, int first)
{
    ty_status status = first < errors->count ? errors->items[first].status : TY_BAD_INPUT;
    for (int i = first; i < errors->count; ++i)
        if (errors->items[i].status != status)
            return TY_BAD_INPUT;
    return status;
}

ty_node* ty_section(ty_loader* loader, const char* name, ty_node_kind kind)
{
    char described[80];
    ty_node* node = ty_node_get(loader->root, name);
    if (!node || node->bad || ty_node_is_empty(node))
        return NULL;
    if (node->kind == kind)
        return node;
    ty_report(loader->errors, node->place, TY_BAD_INPUT, "'%s': expected a %s, got %s", name,
              kind == TY_NODE_MAP ? "mapping" : "list", ty_node_describe(node, described));
    return NULL;
}

// `search:` folders leave the tree: files found there are named by their own paths afterwards.
static void take_search(ty_loader* loader)
{
    ty_node* list = ty_section(loader, "search", TY_NODE_LIST);
    loader->files.search = TY_ARENA_ALLOC(loader->arena, const char*, list ? list->count : 0);
    for (int i = 0; list && i < list->count; ++i)
    {
        char path[TY_PATH_MAX], described[80];
        ty_node* item = list->items[i];
        bool is_name = item->kind == TY_NODE_SCALAR && item->text[0] && strlen(item->text) <= 1024;
        if (is_name)
            ty_path_join(loader->files.folder, item->text, path);
        if (is_name && ty_folder_exists(path))
            loader->files.search[loader->files.search_count++] = ty_arena_string(loader->arena, item->text);
        else if (!item->bad)
            ty_report(loader->errors, item->place, TY_BAD_INPUT, "'search': expected a folder, got %s",
                      ty_node_describe(item, described));
    }
    ty_node_remove(&loader->tree, loader->root, "search");
}

static void open_color(ty_loader* loader)
{
    const char *source = NULL, *named = NULL;
    ty_node* node = loader->is_recipe ? NULL : ty_node_get(loader->root, "ocio");
    if (node)
        named = ty_files_use(&loader->files, node, "ocio");
    if (node && !named)
        return;
    const char* path = ty_color_choose(loader->options->ocio, named, &source);
    ty_error error = {0};
    if (ty_color_create(path, &loader->scene->color, &error) == TY_OK)
        ty_log(TY_LOG_DEBUG, "colour configuration: %s (%s)", path ? path : "embedded", source);
    else if (node)
        ty_report_error(loader->errors, node->place, "ocio", &error);
    else
        ty_error_list_add(loader->errors, &error);
    loader->reader.color = loader->scene->color;
}

static void inline_recipes(ty_loader* loader)
{
    ty_node* assets = ty_section(loader, "assets", TY_NODE_MAP);
    for (int i = 0; assets && i < assets->count; ++i)
    {
        ty_node* asset = assets->items[i];
        for (int k = 0; asset->kind == TY_NODE_MAP && k < asset->count && !loader->tree.stopped; ++k)
            if (ty_recipe_is_place(asset->keys[k].text) && ty_recipe_is_file(asset->items[k]))
                ty_recipe_inline(loader, &asset->items[k], "recipe");
    }
}

// `calibration: FILE` of a material becomes what the file says, so that the recipe of a picture tells it.
static void inline_calibrations(ty_loader* loader)
{
    ty_node* materials = ty_section(loader, "materials", TY_NODE_MAP);
    for (int i = 0; materials && i < materials->count && !loader->tree.stopped; ++i)
    {
        ty_node* material = materials->items[i];
        int found = material->kind == TY_NODE_MAP ? ty_node_find(material, "calibration") : -1;
        if (found >= 0 && ty_recipe_is_file(material->items[found]))
            ty_recipe_inline(loader, &material->items[found], "calibration");
    }
}

// Bounds hold for the whole tree too, so that its text can be read again.
static bool is_deep(const ty_node* node, int depth)
{
    if (depth > TY_TREE_MAX_DEPTH)
        return true;
    for (int i = 0; i < node->count; ++i)
        if (is_deep(node->items[i], depth + 1))
            return true;
    return false;
}

bool ty_loader_resolve_tree(ty_loader* loader)
{
    ty_document_take_version(&loader->tree, loader->root);
    ty_override_sets(loader, true);
    loader->variables = ty_variables_take(&loader->tree, loader->root);
    ty_override_variables(loader);
    ty_scope scope = {&loader->tree, {loader->variables}, 1};
    ty_scope_expand(&scope, &loader->root, 1);
    if (loader->tree.stopped)
        return false;
    if (!loader->is_recipe)
        take_search(loader);
    ty_override_quick(loader);
    ty_override_sets(loader, false);
    return !loader->tree.stopped;
}

bool ty_loader_resolve(ty_loader* loader)
{
    if (!ty_loader_resolve_tree(loader))
        return false;
    if (!loader->is_recipe)
    {
        inline_recipes(loader);
        inline_calibrations(loader);
    }
    ty_override_check_defines(loader);
    if (loader->tree.stopped)
        return false;
    if (is_deep(loader->root, 1))
    {
        ty_report(loader->errors, loader->root->place, TY_BAD_INPUT, "nested deeper than %d levels", TY_TREE_MAX_DEPTH);
        return false;
    }
    ty_variables_warn_unused(loader->variables);
    open_color(loader);
    return true;
}
