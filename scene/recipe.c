// SPDX-License-Identifier: Apache-2.0
// Recipes: files put in place of their names, tables read, generators run.
#include "loader.h"
#include "nearest.h"
#include "number.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/aggregate_export.h>
#include <tsuya/geometry/mesh_file.h>

#define MOST_STATE ((size_t)4 << 30) // bytes of a file that frames go on from

// Where a recipe may stand in an asset, by what it makes; and the kinds whose frames have a place of their own.
static const char* const places[] = {"aggregate", "mesh", "frames", "fill", "loop", "filter"};

bool ty_recipe_is_place(const char* key)
{
    for (int i = 0; i < TY_PARAM_COUNT(places); ++i)
        if (strcmp(places[i], key) == 0)
            return true;
    return false;
}

bool ty_recipe_belongs(const ty_generator* generator, const char* place)
{
    return strcmp(places[generator->product], place) == 0 || strcmp(generator->kind, place) == 0;
}

int ty_recipe_frames(const ty_recipe* recipe)
{
    const ty_generator* generator = recipe->generator;
    int count = generator->frame_count ? generator->frame_count(recipe->def) : 0;
    return generator->product == TY_PRODUCT_FRAMES || (generator->product == TY_PRODUCT_MESH && count > 1) ? count : 0;
}

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

void ty_recipe_inline(ty_loader* loader, ty_node** slot, const char* what)
{
    ty_node* name = *slot;
    ty_place place = name->place;
    const char* path = ty_files_find(&loader->files, name, what);
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

// Every table of a recipe, with its files noted; false after a report.
static bool read_recipe(ty_loader* loader, ty_node* node, ty_recipe* recipe)
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

bool ty_recipe_read(ty_loader* loader, ty_node* node, const char* place, ty_recipe* recipe)
{
    if (!read_recipe(loader, node, recipe))
        return false;
    if (!place || ty_recipe_belongs(recipe->generator, place))
        return true;
    if (ty_generator_find(place))
        ty_report(loader->errors, ty_node_get(node, "kind")->place, TY_BAD_INPUT,
                  "'%s': expected a recipe of kind '%s', got one of kind '%s'", place, place, recipe->generator->kind);
    else
        ty_report(loader->errors, ty_node_get(node, "kind")->place, TY_BAD_INPUT,
                  "'%s': a recipe of kind '%s' makes what is named by '%s'", place, recipe->generator->kind,
                  places[recipe->generator->product]);
    return false;
}

static bool lists(const ty_node* list, const char* text)
{
    for (int i = 0; i < list->count; ++i)
        if (strcmp(list->items[i]->text, text) == 0)
            return true;
    return false;
}

// It goes into the recipe itself, so that the key of what is made, and the recipe of a picture, tell of it.
static void add_output(ty_loader* loader, ty_recipe* recipe, const char* output)
{
    const ty_param_table* table = recipe->generator->params;
    ty_node* list = ty_node_get(recipe->node, "outputs");
    if (list && list->kind == TY_NODE_LIST && lists(list, output))
        return;
    ty_node* name = ty_node_create(&loader->tree, TY_NODE_SCALAR, recipe->node->place);
    if (!list && name && (list = ty_node_create(&loader->tree, TY_NODE_LIST, recipe->node->place)))
        ty_node_add(&loader->tree, recipe->node, (ty_key){"outputs", recipe->node->place}, list);
    if (!name || !list || list->kind != TY_NODE_LIST)
        return; // too large a tree, or wrong and reported
    name->text = output;
    ty_node_append(&loader->tree, list, name);
    for (int i = 0; i < table->count; ++i)
        if (strcmp(table->params[i].name, "outputs") == 0)
            (void)ty_param_read(&loader->reader, list, &table->params[i], (char*)recipe->def + table->params[i].offset);
}

bool ty_recipe_bring_channel(ty_loader* loader, ty_recipe* recipe, const ty_node* channel)
{
    ty_frame_channel channels[TY_FRAME_CHANNELS];
    const char* names[TY_FRAME_CHANNELS];
    char nearest[TY_NEAREST_SIZE];
    int count = recipe->generator->channels ? recipe->generator->channels(recipe->def, channels) : 0;
    for (int i = 0; i < count; ++i)
    {
        names[i] = channels[i].name;
        if (strcmp(names[i], channel->text) == 0)
        {
            add_output(loader, recipe, channels[i].output);
            return true;
        }
    }
    ty_report(
        loader->errors, channel->place, TY_BAD_INPUT,
        "'channel': all, r, g, b, a, luminance, or one of what a recipe of kind '%s' makes; it makes no '%.100s'%s",
        recipe->generator->kind, channel->text, ty_nearest(channel->text, names, count, nearest));
    return false;
}

char* ty_recipe_text(const ty_recipe* recipe)
{
    char* body = ty_tree_emit(recipe->node);
    char* text = ty_string_format("tsuya: 1\n%s", body);
    ty_free(body);
    return text;
}

ty_status ty_recipe_key(const ty_recipe* recipe, ty_files* files, char key[33], ty_error* error)
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

typedef struct frame_writer
{
    const char *pattern, *text, *key;
    const ty_color* color;   // NULL: frames are EXR files
    const char* picture;     // a pattern of pictures beside them; NULL = none
    const char* state;       // of a run: a file; NULL = none
    ty_frame_volume* volume; // path NULL = none
} frame_writer;

static ty_status write_frame(void* context, int frame, ty_exr* image, ty_error* error)
{
    const frame_writer* writer = context;
    char path[TY_PATH_MAX];
    if (writer->volume->path)
    {
        ty_status put = ty_frame_volume_put(writer->volume, frame, image, error);
        if (put != TY_OK)
            return put;
    }
    ty_exr_add_string(image, "tsuya/recipe", writer->text);
    ty_exr_add_string(image, "tsuya/hash", writer->key);
    ty_path_frame(writer->pattern, frame, path);
    ty_status status = ty_frame_write(path, image, writer->color, error);
    if (status != TY_OK || !writer->picture)
        return status;
    ty_path_frame(writer->picture, frame, path);
    return ty_frame_write(path, image, writer->color, error);
}

static ty_status write_state(void* context, ty_exr* state, ty_error* error)
{
    const frame_writer* writer = context;
    ty_exr_add_string(state, "tsuya/recipe", writer->text);
    return ty_exr_write(writer->state, state, error);
}

static void sign(char** recipe, char** hash, char* text, const char* key)
{
    ty_free(*recipe);
    ty_free(*hash);
    *recipe = text;
    *hash = ty_string_copy(key);
}

static ty_status write_film(void* context, int frame, ty_aggregate* aggregate, ty_error* error)
{
    const frame_writer* writer = context;
    char path[TY_PATH_MAX];
    sign(&aggregate->recipe, &aggregate->hash, ty_string_copy(writer->text), writer->key);
    ty_path_frame(writer->pattern, frame, path);
    return ty_aggregate_export(path, aggregate, false, error);
}

static ty_status write_growth(void* context, int frame, ty_mesh* mesh, ty_error* error)
{
    const frame_writer* writer = context;
    char path[TY_PATH_MAX];
    sign(&mesh->recipe, &mesh->hash, ty_string_copy(writer->text), writer->key);
    ty_path_frame(writer->pattern, frame, path);
    return ty_mesh_export(path, mesh, error);
}

// roots.ply, roots.lod1.ply, roots.lod2.ply ...
static ty_status write_level(void* context, int level, ty_mesh* mesh, ty_error* error)
{
    const frame_writer* writer = context;
    char path[TY_PATH_MAX];
    const char* extension = ty_path_extension(writer->pattern);
    int stem = (int)(strlen(writer->pattern) - strlen(extension)) - 1;
    sign(&mesh->recipe, &mesh->hash, ty_string_copy(writer->text), writer->key);
    snprintf(path, sizeof path, "%.*s.lod%d.%s", stem, writer->pattern, level, extension);
    return ty_mesh_export(path, mesh, error);
}

// What is made of roots besides their mesh.
static ty_status write_beside(const ty_made* made, const ty_scene_options* options, ty_error* error)
{
    ty_status status = TY_OK;
    if (made->curves)
        status = ty_file_write(options->curves, made->curves, strlen(made->curves), error);
    if (status == TY_OK && made->host)
        status = ty_mesh_export(options->host, made->host, error);
    return status;
}

// Where what is made goes, and what it is made from besides the recipe.
typedef struct making
{
    const char *key, *output;
    const char* cache;               // for what another run can use; NULL = none
    const ty_color* color;           // NULL: frames are EXR files
    const ty_bytes* state;           // to go on from, or NULL
    const ty_scene_options* options; // where else frames, their state and a report go; NULL = nowhere
    bool partial;                    // an aggregate that was interrupted and holds its state is written as well
} making;

static ty_status write_made(const ty_recipe* recipe, const making* m, ty_workers* workers, ty_error* error)
{
    const ty_scene_options none = {0}, *options = m->options ? m->options : &none;
    char* text = ty_recipe_text(recipe);
    ty_frame_volume volume = {.path = options->volume};
    if (volume.path)
        volume.depth = recipe->generator->frame_count(recipe->def);
    frame_writer writer = {m->output, text, m->key, m->color, options->picture, options->state, &volume};
    ty_made made = {
        .frames = {write_frame, writer.state ? write_state : NULL, &writer}, .state = m->state, .cache = m->cache};
    if (recipe->generator->product == TY_PRODUCT_AGGREGATE && ty_path_is_sequence(m->output))
        made.film = (ty_aggregate_sink){write_film, &writer};
    if (recipe->generator->product == TY_PRODUCT_MESH && ty_path_is_sequence(m->output))
        made.growth = (ty_mesh_sink){write_growth, &writer};
    if (m->options) // in a scene there is but one
        made.levels = (ty_mesh_sink){write_level, &writer};
    made.wants_report = options->report != NULL;
    made.wants_curves = options->curves != NULL;
    made.wants_host = options->host != NULL;
    ty_status status = recipe->generator->make(recipe->def, workers, &made, error), written = TY_OK;
    ty_error write_error = {0};
    written = ty_frame_volume_end(&volume, status == TY_OK, &write_error);
    if (made.report && options->report)
        *options->report = made.report;
    else
        ty_free(made.report);
    if (made.aggregate && (status != TY_INTERRUPTED || m->partial))
    {
        sign(&made.aggregate->recipe, &made.aggregate->hash, ty_string_copy(text), m->key);
        written = ty_aggregate_export(m->output, made.aggregate, false, &write_error);
    }
    if (made.mesh)
    {
        sign(&made.mesh->recipe, &made.mesh->hash, ty_string_copy(text), m->key);
        written = ty_mesh_export(m->output, made.mesh, &write_error);
    }
    if (status == TY_OK && written == TY_OK)
        written = write_beside(&made, options, &write_error);
    ty_aggregate_destroy(made.aggregate);
    ty_mesh_destroy(made.mesh);
    ty_mesh_destroy(made.host);
    ty_free(made.curves);
    ty_free(text);
    if (status == TY_BAD_INPUT || status == TY_BAD_FILE) // where the recipe names the file, if the error does not
        ty_error_find_place(error, recipe->node);
    if (written == TY_OK)
        return status;
    *error = write_error;
    return written;
}

ty_status ty_recipe_write(const ty_recipe* recipe, const char* key, const char* output, const char* cache,
                          ty_workers* workers, ty_error* error)
{
    return write_made(recipe, &(making){.key = key, .output = output, .cache = cache}, workers, error);
}

// The recipe file as the root of a loader, read; false after reports.
static bool read_root(ty_loader* loader, const char* path, ty_recipe* recipe)
{
    int first = loader->errors->count;
    loader->is_recipe = true;
    loader->root = ty_document_load(&loader->tree, &loader->files, path, "", NULL);
    return loader->root && ty_loader_resolve(loader) && read_recipe(loader, loader->root, recipe) &&
           loader->errors->count == first;
}

static ty_status write_element(const ty_recipe* recipe, int number, const char* key, const char* output,
                               ty_error* error)
{
    ty_mesh* mesh;
    ty_status status = recipe->generator->element(recipe->def, number, &mesh, error);
    if (status == TY_BAD_INPUT)
        ty_error_find_place(error, recipe->node);
    if (status != TY_OK)
        return status;
    sign(&mesh->recipe, &mesh->hash, ty_recipe_text(recipe), key);
    status = ty_ply_write(output, mesh, error);
    ty_mesh_destroy(mesh);
    return status;
}

static ty_status make_and_write(ty_loader* loader, const ty_recipe* recipe, int element, const char* output,
                                ty_error* error)
{
    char key[33];
    ty_status status = ty_recipe_key(recipe, &loader->files, key, error);
    if (status != TY_OK)
        return status;
    if (element > 0)
        return write_element(recipe, element, key, output, error);
    int frames = recipe->generator->product == TY_PRODUCT_FRAMES ? recipe->generator->frame_count(recipe->def) : 1;
    if (frames > 1 && !ty_path_is_sequence(output))
        return ty_error_set(error, TY_USAGE, "%d frames do not go into '%s': it needs #### where their number goes",
                            frames, output);
    const char* resume = loader->options->resume;
    ty_bytes state = {0};
    if (resume)
        status = recipe->generator->product == TY_PRODUCT_AGGREGATE ? ty_aggregate_read_state(resume, &state, error)
                                                                    : ty_file_read(resume, MOST_STATE, &state, error);
    char cache[TY_PATH_MAX];
    ty_error unkept; // costs time, not the asset
    bool keeps = ty_scene_cache_folder(loader->options->cache_folder, cache, &unkept) == TY_OK && cache[0];
    const making m = {key, output, keeps ? cache : NULL, loader->scene->color, resume ? &state : NULL, loader->options,
                      true};
    if (status == TY_OK)
        status = write_made(recipe, &m, loader->options->workers, error);
    ty_bytes_term(&state);
    return status;
}

static bool is_kind(ty_loader* loader, const ty_recipe* recipe, const char* kind)
{
    if (!kind || strcmp(recipe->generator->kind, kind) == 0)
        return true;
    ty_report(loader->errors, ty_node_get(recipe->node, "kind")->place, TY_BAD_INPUT,
              "expected a recipe of kind '%s', got '%s'", kind, recipe->generator->kind);
    return false;
}

ty_status ty_recipe_make(const char* path, const char* kind, const char* output, int element,
                         const ty_scene_options* options, ty_error_list* errors)
{
    char folder[TY_PATH_MAX];
    ty_path_folder(path, folder);
    int first = errors->count;
    ty_loader* loader = ty_loader_create(folder, options, errors);
    ty_recipe recipe = {0};
    ty_status status = TY_OK;
    if (!read_root(loader, path, &recipe) || !is_kind(loader, &recipe, kind))
        status = ty_loader_status(errors, first);
    else if (!options->check_only)
    {
        ty_error error = {0};
        status = make_and_write(loader, &recipe, element, output, &error);
        if (status != TY_OK)
            ty_error_list_add(errors, &error);
    }
    ty_scene* scene = loader->scene;
    ty_loader_destroy(loader);
    ty_scene_destroy(scene);
    return status;
}
