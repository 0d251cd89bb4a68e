// SPDX-License-Identifier: Apache-2.0
// Recipes: files put in place of their names, tables read, generators run.
#include "loader.h"
#include "nearest.h"
#include "number.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>

bool ty_recipe_is_file(const ty_node* node)
{
    if (node->kind != TY_NODE_SCALAR)
        return false;
    const char* extension = ty_path_extension(node->text);
    return strcmp(extension, "yaml") == 0 || strcmp(extension, "yml") == 0 || strcmp(extension, "json") == 0;
}

// A -D name is known as soon as one recipe declares it.
static void mark_defines(ty_loader* loader, const ty_variables* own)
{
    for (int i = 0; loader->defines->map && i < loader->defines->map->count; ++i)
        loader->defines->used[i] |= ty_node_find(own->map, loader->defines->map->keys[i].text) >= 0;
}

void ty_recipe_inline(ty_loader* loader, ty_node** slot)
{
    ty_node* name = *slot;
    ty_place place = name->place;
    const char* path = ty_files_find(&loader->files, name, "aggregate");
    name->bad |= path == NULL;
    if (!path)
        return;
    const char* base = "";
    if (strchr(name->text, '/'))
    {
        char folder[TY_PATH_MAX];
        ty_path_folder(name->text, folder);
        base = ty_arena_string(loader->arena, folder);
    }
    ty_node* root = ty_document_load(&loader->tree, &loader->files, path, base, &place);
    name->bad |= root == NULL;
    if (!root)
        return;
    ty_document_take_version(&loader->tree, root);
    ty_variables* own = ty_variables_take(&loader->tree, root);
    mark_defines(loader, own);
    ty_scope scope = {&loader->tree, {loader->defines, loader->variables, own}, 3};
    ty_scope_expand(&scope, &root, 4);
    *slot = root;
}

static const ty_generator* find_generator(ty_loader* loader, const ty_node* node)
{
    int count = 0;
    const ty_generator* const* list = ty_generator_list(&count);
    const char** names = TY_ALLOC(const char*, count + 1);
    for (int i = 0; i < count; ++i)
        names[i] = list[i]->kind;
    const ty_node* kind = ty_node_get(node, "kind");
    const ty_generator* generator = NULL;
    char nearest[TY_NEAREST_SIZE];
    if (!kind)
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "missing key 'kind' of a recipe%s",
                  ty_nearest("", names, count, nearest));
    else if (kind->kind != TY_NODE_SCALAR)
        ty_report(loader->errors, kind->place, TY_BAD_INPUT, "'kind': expected the name of a kind of recipe%s",
                  ty_nearest("", names, count, nearest));
    else if (!(generator = ty_generator_find(kind->text)) && !kind->bad)
        ty_report(loader->errors, kind->place, TY_BAD_INPUT, "unknown kind of recipe '%.200s'%s", kind->text,
                  ty_nearest(kind->text, names, count, nearest));
    ty_free(names);
    return generator;
}

bool ty_recipe_read(ty_loader* loader, ty_node* node, ty_recipe* recipe)
{
    static const char* const skip[] = {"kind", NULL};
    char described[80];
    if (node->kind != TY_NODE_MAP)
    {
        ty_report(loader->errors, node->place, TY_BAD_INPUT, "expected a recipe (a mapping with 'kind'), got %s",
                  ty_node_describe(node, described));
        return false;
    }
    recipe->node = node;
    recipe->generator = find_generator(loader, node);
    if (!recipe->generator)
        return false;
    recipe->def = ty_arena_alloc(loader->arena, 1, recipe->generator->params->size);
    recipe->files_begin = loader->files.count;
    bool good = ty_params_read(&loader->reader, node, recipe->generator->params, recipe->def, skip);
    recipe->files_end = loader->files.count;
    return good;
}

char* ty_recipe_text(const ty_recipe* recipe)
{
    char* body = ty_tree_emit(recipe->node);
    char* text = ty_string_format("tsuya: 1\n%s", body);
    ty_free(body);
    return text;
}

ty_status ty_recipe_key(const ty_recipe* recipe, const ty_files* files, char key[33], ty_error* error)
{
    ty_hasher* hasher = ty_hasher_create();
    char* text = ty_recipe_text(recipe);
    ty_hasher_add_string(hasher, recipe->generator->kind);
    ty_hasher_add_string(hasher, recipe->generator->build_id);
    ty_hasher_add_string(hasher, text); // holds the seed, if it is not the default of this build
    ty_free(text);
    ty_status status = ty_files_add_to_hash(files, recipe->files_begin, recipe->files_end, hasher, error);
    ty_hash_hex(ty_hasher_end(hasher), key);
    return status;
}

ty_status ty_recipe_run(const ty_recipe* recipe, const char* key, ty_workers* workers, ty_aggregate** out,
                        ty_error* error)
{
    ty_status status = recipe->generator->make(recipe->def, workers, out, error);
    if (!*out)
        return status;
    ty_free((*out)->recipe);
    ty_free((*out)->hash);
    (*out)->recipe = ty_recipe_text(recipe);
    (*out)->hash = ty_string_copy(key);
    return status;
}

// The recipe file as the root of a loader, read; false after reports.
static bool read_root(ty_loader* loader, const char* path, ty_recipe* recipe)
{
    int first = loader->errors->count;
    loader->is_recipe = true;
    loader->root = ty_document_load(&loader->tree, &loader->files, path, "", NULL);
    return loader->root && ty_loader_resolve(loader) && ty_recipe_read(loader, loader->root, recipe) &&
           loader->errors->count == first;
}

static ty_status make_and_write(ty_loader* loader, const ty_recipe* recipe, const char* output, ty_error* error)
{
    char key[33];
    ty_aggregate* aggregate = NULL;
    ty_status status = ty_recipe_key(recipe, &loader->files, key, error);
    if (status != TY_OK)
        return status;
    status = ty_recipe_run(recipe, key, loader->options->workers, &aggregate, error);
    if (aggregate)
    {
        ty_error write_error;
        ty_status written = ty_aggregate_write(output, aggregate, &write_error);
        if (written != TY_OK)
        {
            *error = write_error;
            status = written;
        }
    }
    ty_aggregate_destroy(aggregate);
    return status;
}

ty_status ty_recipe_make(const char* path, const char* output, const ty_scene_options* options, ty_error_list* errors)
{
    char folder[TY_PATH_MAX];
    ty_path_folder(path, folder);
    int first = errors->count;
    ty_loader* loader = ty_loader_create(folder, options, errors);
    ty_recipe recipe = {0};
    ty_status status = TY_OK;
    if (!read_root(loader, path, &recipe))
        status = ty_loader_status(errors, first);
    else if (!options->check_only)
    {
        ty_error error = {0};
        status = make_and_write(loader, &recipe, output, &error);
        if (status != TY_OK)
            ty_error_list_add(errors, &error);
    }
    ty_scene* scene = loader->scene;
    ty_loader_destroy(loader);
    ty_scene_destroy(scene);
    return status;
}
