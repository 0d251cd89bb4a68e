// SPDX-License-Identifier: Apache-2.0
// Overrides of the command line: --set path=value into the tree, -D name=value into the variables.
#include "loader.h"
#include "nearest.h"
#include "number.h"
#include "text.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_STEPS 32

typedef struct ty_override
{
    ty_loader* loader;
    const ty_source* source;
    char* path; // steps, each terminated
    const char* steps[MAX_STEPS];
    int columns[MAX_STEPS];
    int step_count;
    ty_node* value;
} ty_override;

static ty_source* make_source(ty_loader* loader, const char* flag, const char* argument, size_t value_begin)
{
    ty_source* source = TY_ARENA_ALLOC(loader->tree.arena, ty_source, 1);
    source->file = flag;
    source->base = "";
    source->argument = ty_arena_string(loader->tree.arena, argument);
    source->column = (int)value_begin;
    return source;
}

// Splits argument at its first '=' and parses what follows; NULL after a report.
static ty_node* parse_value(ty_loader* loader, const char* flag, const char* argument, const ty_source** source)
{
    const char* equals = strlen(argument) < INT_MAX ? strchr(argument, '=') : NULL;
    size_t begin = equals ? (size_t)(equals - argument) + 1 : 0;
    *source = make_source(loader, flag, argument, begin);
    if (!equals || equals == argument)
    {
        ty_report(loader->errors, (ty_place){*source, 1, 1}, TY_BAD_INPUT, "expected %s",
                  strcmp(flag, "-D") == 0 ? "name=value" : "path=value, as in camera.vfov=30");
        return NULL;
    }
    return ty_tree_parse(&loader->tree, *source, equals + 1, strlen(equals + 1));
}

static bool split_path(ty_override* o, size_t length)
{
    o->path = ty_arena_string(o->loader->tree.arena, o->source->argument);
    o->path[length] = 0;
    char* step = o->path;
    for (;;)
    {
        char* dot = strchr(step, '.');
        if (dot)
            *dot = 0;
        int column = (int)(step - o->path) + 1;
        if (!*step || o->step_count == MAX_STEPS)
        {
            ty_report(o->loader->errors, (ty_place){o->source, 1, column}, TY_BAD_INPUT, "%s",
                      *step ? "more than 32 steps in a path" : "a step of the path is empty");
            return false;
        }
        o->columns[o->step_count] = column;
        o->steps[o->step_count++] = step;
        if (!dot)
            return true;
        step = dot + 1;
    }
}

static ty_place step_place(const ty_override* o, int step)
{
    return (ty_place){o->source, 1, o->columns[step]};
}

// Whether keys of the mapping that holds this step are names of the user, so that a new one is rather a slip.
static bool holds_names(const ty_override* o, int step)
{
    const char* section = o->steps[0];
    if (o->loader->is_recipe)
        return step == 1 && strcmp(section, "vars") == 0;
    return step == 1 &&
           (strcmp(section, "materials") == 0 || strcmp(section, "assets") == 0 || strcmp(section, "vars") == 0);
}

static ty_node** step_into_map(ty_override* o, ty_node* map, int step)
{
    bool last = step + 1 == o->step_count;
    int index = ty_node_find(map, o->steps[step]);
    if (index >= 0)
        return &map->items[index];
    if (holds_names(o, step) && (!last || strcmp(o->steps[0], "vars") == 0))
    {
        char nearest[TY_NEAREST_SIZE];
        ty_report(o->loader->errors, step_place(o, step), TY_BAD_INPUT, "no '%.200s' in %s%s", o->steps[step],
                  o->steps[0], ty_nearest_key(o->steps[step], map, nearest));
        return NULL;
    }
    // an unknown key is reported, with its place here, by the table that meets it
    ty_node* made = ty_node_create(&o->loader->tree, TY_NODE_MAP, step_place(o, step));
    if (!made)
        return NULL;
    ty_node_add(&o->loader->tree, map, (ty_key){o->steps[step], step_place(o, step)}, made);
    return &map->items[map->count - 1];
}

static ty_node** step_into_list(ty_override* o, ty_node* list, int step)
{
    const char* name = o->steps[step];
    char* end = NULL;
    long index = strtol(name, &end, 10);
    if (*end == 0 && index >= 0 && index < list->count)
        return &list->items[index];
    for (int i = 0; *end && i < list->count; ++i)
    {
        const ty_node* its_name = ty_node_get(list->items[i], "name");
        if (its_name && its_name->kind == TY_NODE_SCALAR && strcmp(its_name->text, name) == 0)
            return &list->items[i];
    }
    const char** names = TY_ALLOC(const char*, list->count);
    for (int i = 0; i < list->count; ++i)
    {
        const ty_node* its_name = ty_node_get(list->items[i], "name");
        names[i] = its_name && its_name->kind == TY_NODE_SCALAR ? its_name->text : NULL;
    }
    char nearest[TY_NEAREST_SIZE] = "";
    if (*end)
        ty_nearest(name, names, list->count, nearest);
    ty_free(names);
    ty_report(o->loader->errors, step_place(o, step), TY_BAD_INPUT, "no entry '%.200s' in the list, which has %d%s",
              name, list->count, nearest);
    return NULL;
}

// What a file is that stands at the third step: of an asset its recipe, of a material its calibration; NULL = none.
static const char* file_at_step(const ty_override* o)
{
    if (!o->loader->is_recipe && strcmp(o->steps[0], "assets") == 0 && ty_recipe_is_place(o->steps[2]))
        return "recipe";
    return strcmp(o->steps[0], "materials") == 0 && strcmp(o->steps[2], "calibration") == 0 ? "calibration" : NULL;
}

static void set_value(ty_override* o)
{
    ty_node** slot = &o->loader->root;
    for (int step = 0; step < o->step_count; ++step)
    {
        char described[80];
        if (step == 3 && file_at_step(o) && ty_recipe_is_file(*slot))
            ty_recipe_inline(o->loader, slot, file_at_step(o));
        ty_node* node = *slot;
        if (node->bad)
            return;
        if (node->kind == TY_NODE_SCALAR && !node->text[0]) // a section left empty
            node->kind = TY_NODE_MAP;
        if (node->kind == TY_NODE_SCALAR)
        {
            ty_report(o->loader->errors, step_place(o, step), TY_BAD_INPUT, "'%s' is %s: there is no '%s' in it",
                      step ? o->steps[step - 1] : "the file", ty_node_describe(node, described), o->steps[step]);
            return;
        }
        slot = node->kind == TY_NODE_MAP ? step_into_map(o, node, step) : step_into_list(o, node, step);
        if (!slot)
            return;
    }
    *slot = o->value;
}

static void apply_set(ty_loader* loader, const char* argument, bool early)
{
    ty_override o = {.loader = loader};
    o.value = parse_value(loader, "--set", argument, &o.source);
    if (!o.value || !split_path(&o, strcspn(argument, "=")))
        return;
    if (!early)
    {
        ty_scope scope = {&loader->tree, {loader->variables}, 1};
        ty_scope_expand(&scope, &o.value, 1);
    }
    set_value(&o);
}

void ty_override_sets(ty_loader* loader, bool early)
{
    for (int i = 0; i < loader->options->set_count && !loader->tree.stopped; ++i)
    {
        const char* argument = loader->options->sets[i];
        bool is_early = strncmp(argument, "vars.", 5) == 0 || strncmp(argument, "search", 6) == 0;
        if (is_early == early)
            apply_set(loader, argument, early);
    }
}

// False for a size that the table is going to report.
static bool film_size(const ty_loader* loader, int size[2])
{
    memcpy(size, ty_film_def_default().size, 2 * sizeof size[0]);
    const ty_node* film = ty_node_get(loader->root, "film");
    const ty_node* list = film ? ty_node_get(film, "size") : NULL;
    if (!list)
        return !film || film->kind == TY_NODE_MAP || ty_node_is_empty(film);
    for (int i = 0; i < 2; ++i)
    {
        double value = 0.0;
        bool is_number = list->kind == TY_NODE_LIST && list->count == 2 && list->items[i]->kind == TY_NODE_SCALAR &&
                         ty_number_parse(list->items[i]->text, &value);
        if (!is_number || !(value >= 1.0 && value <= 65536.0) || floor(value) < value)
            return false;
        size[i] = (int)value;
    }
    return true;
}

void ty_override_quick(ty_loader* loader)
{
    if (!loader->options->quick || loader->is_recipe || loader->tree.stopped)
        return;
    int size[2];
    char text[64];
    if (!film_size(loader, size))
        return;
    snprintf(text, sizeof text, "film.size=[%d, %d]", (size[0] + 1) / 2, (size[1] + 1) / 2);
    apply_set(loader, text, false);
    apply_set(loader, "render.samples=16", false);
}

void ty_override_variables(ty_loader* loader)
{
    ty_node* extra = NULL;
    for (int i = 0; i < loader->options->variable_count && !loader->tree.stopped; ++i)
    {
        const char* argument = loader->options->variables[i];
        const ty_source* source = NULL;
        ty_node* value = parse_value(loader, "-D", argument, &source);
        if (!value)
            continue;
        char* name = ty_arena_string(loader->tree.arena, argument);
        name[strcspn(name, "=")] = 0;
        int index = ty_node_find(loader->variables->map, name);
        if (index >= 0)
        {
            loader->variables->map->items[index] = value;
            continue;
        }
        if (!extra)
            extra = ty_node_create(&loader->tree, TY_NODE_MAP, (ty_place){source, 1, 1});
        if (!extra)
            return;
        index = ty_node_find(extra, name);
        if (index >= 0)
            extra->items[index] = value;
        else
            ty_node_add(&loader->tree, extra, (ty_key){name, {source, 1, 1}}, value);
    }
    loader->defines = ty_variables_create(&loader->tree, extra);
}

void ty_override_check_defines(ty_loader* loader)
{
    const ty_node* map = loader->defines->map;
    for (int i = 0; map && i < map->count; ++i)
    {
        char nearest[TY_NEAREST_SIZE];
        if (!loader->defines->used[i])
            ty_report(loader->errors, map->keys[i].place, TY_BAD_INPUT, "no variable '%.200s'%s", map->keys[i].text,
                      ty_nearest_key(map->keys[i].text, loader->variables->map, nearest));
    }
}

const char* ty_override_text(ty_arena* arena, const ty_scene_options* options)
{
    ty_text text = {0};
    for (int i = 0; i < options->variable_count; ++i)
        ty_text_format(&text, "%s-D %s", text.size ? " " : "", options->variables[i]);
    if (options->quick)
        ty_text_format(&text, "%s--quick", text.size ? " " : "");
    for (int i = 0; i < options->set_count; ++i)
        ty_text_format(&text, "%s--set %s", text.size ? " " : "", options->sets[i]);
    char* whole = ty_text_take(&text);
    const char* copy = ty_arena_string(arena, whole);
    ty_free(whole);
    return copy;
}
