// SPDX-License-Identifier: Apache-2.0
// Variables: $name becomes the value of name, wherever it stands as a whole scalar.
#include "document.h"
#include "nearest.h"
#include <string.h>

ty_variables* ty_variables_create(ty_tree* tree, ty_node* map)
{
    ty_variables* variables = TY_ARENA_ALLOC(tree->arena, ty_variables, 1);
    int count = map ? map->count : 0;
    variables->map = map;
    variables->busy = TY_ARENA_ALLOC(tree->arena, bool, count);
    variables->used = TY_ARENA_ALLOC(tree->arena, bool, count);
    return variables;
}

ty_variables* ty_variables_take(ty_tree* tree, ty_node* root)
{
    char described[80];
    ty_node* map = ty_node_get(root, "vars");
    if (map && map->kind != TY_NODE_MAP && !ty_node_is_empty(map))
        ty_report(tree->errors, map->place, TY_BAD_INPUT, "'vars': expected a mapping of names to values, got %s",
                  ty_node_describe(map, described));
    ty_node_remove(tree, root, "vars");
    return ty_variables_create(tree, map && map->kind == TY_NODE_MAP ? map : NULL);
}

void ty_variables_warn_unused(const ty_variables* variables)
{
    for (int i = 0; variables->map && i < variables->map->count; ++i)
        if (!variables->used[i])
            ty_report_warning(variables->map->keys[i].place, "variable '%s' is not used", variables->map->keys[i].text);
}

static void report_unknown(const ty_scope* scope, ty_node* node)
{
    char nearest[TY_NEAREST_SIZE] = "";
    const char* name = node->text + 1;
    for (int i = 0; i < scope->count && strncmp(nearest, "; did", 5) != 0; ++i)
        if (scope->layers[i]->map)
            ty_nearest_key(name, scope->layers[i]->map, nearest);
    ty_report(scope->tree->errors, node->place, TY_BAD_INPUT, "unknown variable '$%.200s'%s", name, nearest);
    node->text = "";
    node->bad = true;
}

static void replace(ty_scope* scope, ty_node** slot, ty_variables* variables, int index, int depth)
{
    ty_node* use = *slot;
    variables->used[index] = true;
    if (variables->busy[index])
    {
        ty_report(scope->tree->errors, use->place, TY_BAD_INPUT, "variable '%s' stands in its own value", use->text);
        use->text = "";
        use->bad = true;
        return;
    }
    ty_node* value = ty_node_copy(scope->tree, variables->map->items[index], use->place, depth);
    if (!value)
        return;
    *slot = value;
    variables->busy[index] = true;
    ty_scope_expand(scope, slot, depth);
    variables->busy[index] = false;
}

static void expand_scalar(ty_scope* scope, ty_node** slot, int depth)
{
    ty_node* node = *slot;
    if (node->text[0] != '$')
        return;
    if (node->text[1] == '$')
    {
        node->text += 1;
        return;
    }
    for (int i = 0; i < scope->count; ++i)
    {
        int index = ty_node_find(scope->layers[i]->map, node->text + 1);
        if (index < 0)
            continue;
        replace(scope, slot, scope->layers[i], index, depth);
        return;
    }
    report_unknown(scope, node);
}

void ty_scope_expand(ty_scope* scope, ty_node** slot, int depth)
{
    if (scope->tree->stopped)
        return;
    if ((*slot)->kind == TY_NODE_SCALAR)
        expand_scalar(scope, slot, depth);
    else
        for (int i = 0; i < (*slot)->count; ++i)
            ty_scope_expand(scope, &(*slot)->items[i], depth + 1);
}
