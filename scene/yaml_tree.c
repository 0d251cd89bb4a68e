// SPDX-License-Identifier: Apache-2.0
// Nodes of a positioned tree: creation, copies within bounds, mappings with a hash index, reports.
#include "yaml_tree.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/log.h>

#define LINEAR 16 // a mapping of more keys gets a hash index

ty_node* ty_node_create(ty_tree* tree, ty_node_kind kind, ty_place place)
{
    if (++tree->nodes > TY_TREE_MAX_NODES)
    {
        if (!tree->stopped)
            ty_report(tree->errors, place, TY_BAD_INPUT, "more than %d keys and values", TY_TREE_MAX_NODES);
        tree->stopped = true;
        return NULL;
    }
    ty_node* node = TY_ARENA_ALLOC(tree->arena, ty_node, 1);
    node->kind = kind;
    node->place = place;
    node->text = "";
    return node;
}

static void stop(ty_tree* tree, ty_place place, const char* text)
{
    if (!tree->stopped)
        ty_report(tree->errors, place, TY_BAD_INPUT, "%s", text);
    tree->stopped = true;
}

ty_node* ty_node_copy(ty_tree* tree, const ty_node* node, ty_place used, int depth)
{
    if (++tree->copied > TY_TREE_MAX_COPIED)
    {
        stop(tree, used, "aliases and variables expand to more than 100000 values");
        return NULL;
    }
    if (depth > TY_TREE_MAX_DEPTH)
    {
        stop(tree, used, "nested deeper than 64 levels once aliases and variables are expanded");
        return NULL;
    }
    ty_node* copy = ty_node_create(tree, node->kind, node->place);
    if (!copy)
        return NULL;
    copy->text = node->text;
    for (int i = 0; i < node->count; ++i)
    {
        ty_node* item = ty_node_copy(tree, node->items[i], used, depth + 1);
        if (!item)
            return NULL;
        if (node->kind == TY_NODE_MAP)
            ty_node_add(tree, copy, node->keys[i], item);
        else
            ty_node_append(tree, copy, item);
    }
    return copy;
}

static void make_room(ty_tree* tree, ty_node* node)
{
    if (node->count < node->capacity)
        return;
    int capacity = node->capacity ? node->capacity * 2 : 4;
    ty_node** items = TY_ARENA_ALLOC(tree->arena, ty_node*, capacity);
    if (node->count)
        memcpy(items, node->items, (size_t)node->count * sizeof(*items));
    node->items = items;
    if (node->kind == TY_NODE_MAP)
    {
        ty_key* keys = TY_ARENA_ALLOC(tree->arena, ty_key, capacity);
        if (node->count)
            memcpy(keys, node->keys, (size_t)node->count * sizeof(*keys));
        node->keys = keys;
    }
    node->capacity = capacity;
}

void ty_node_append(ty_tree* tree, ty_node* list, ty_node* item)
{
    TY_ASSERT(list->kind == TY_NODE_LIST);
    make_room(tree, list);
    list->items[list->count++] = item;
}

static uint32_t slot_of(const ty_node* map, const char* key)
{
    return (uint32_t)ty_hash_bytes(key, strlen(key)).low & (map->slot_count - 1);
}

static void index_add(ty_node* map, int index)
{
    uint32_t slot = slot_of(map, map->keys[index].text);
    while (map->slots[slot])
        slot = (slot + 1) & (map->slot_count - 1);
    map->slots[slot] = (uint32_t)index + 1;
}

static void index_rebuild(ty_tree* tree, ty_node* map)
{
    map->slots = NULL;
    map->slot_count = 0;
    if (map->count <= LINEAR)
        return;
    map->slot_count = 64;
    while (map->slot_count < (uint32_t)map->count * 4)
        map->slot_count *= 2;
    map->slots = TY_ARENA_ALLOC(tree->arena, uint32_t, map->slot_count);
    for (int i = 0; i < map->count; ++i)
        index_add(map, i);
}

void ty_node_add(ty_tree* tree, ty_node* map, ty_key key, ty_node* value)
{
    TY_ASSERT(map->kind == TY_NODE_MAP);
    make_room(tree, map);
    map->keys[map->count] = key;
    map->items[map->count++] = value;
    if (map->count > LINEAR && (uint32_t)map->count * 2 > map->slot_count)
        index_rebuild(tree, map);
    else if (map->slots)
        index_add(map, map->count - 1);
}

int ty_node_find(const ty_node* map, const char* key)
{
    if (!map || map->kind != TY_NODE_MAP)
        return -1;
    if (map->slots)
    {
        for (uint32_t slot = slot_of(map, key); map->slots[slot]; slot = (slot + 1) & (map->slot_count - 1))
            if (strcmp(map->keys[map->slots[slot] - 1].text, key) == 0)
                return (int)map->slots[slot] - 1;
        return -1;
    }
    for (int i = 0; i < map->count; ++i)
        if (strcmp(map->keys[i].text, key) == 0)
            return i;
    return -1;
}

ty_node* ty_node_get(const ty_node* map, const char* key)
{
    int index = ty_node_find(map, key);
    return index < 0 ? NULL : map->items[index];
}

void ty_node_remove(ty_tree* tree, ty_node* map, const char* key)
{
    int index = ty_node_find(map, key);
    if (index < 0)
        return;
    size_t after = (size_t)(map->count - index - 1);
    memmove(map->items + index, map->items + index + 1, after * sizeof(*map->items));
    memmove(map->keys + index, map->keys + index + 1, after * sizeof(*map->keys));
    --map->count;
    index_rebuild(tree, map);
}

bool ty_node_is_empty(const ty_node* node)
{
    return node->kind == TY_NODE_SCALAR ? node->text[0] == 0 : node->count == 0;
}

const char* ty_node_describe(const ty_node* node, char buffer[80])
{
    if (node->kind == TY_NODE_MAP)
        return "a mapping";
    if (node->kind == TY_NODE_LIST)
        snprintf(buffer, 80, "a list of %d", node->count);
    else if (node->text[0] == 0)
        return "nothing";
    else
        snprintf(buffer, 80, "'%.60s%s'", node->text, strlen(node->text) > 60 ? "..." : "");
    return buffer;
}

static void place_error(ty_error* error, ty_place place, ty_status status, const char* text)
{
    const ty_source* source = place.source;
    (void)ty_error_set_at(error, status, source->file, place.line, place.column,
                          source->argument ? "%s (in '%s %s')" : "%s", text, source->file, source->argument);
}

// The place of the key or item that the first word of path names below node, and the node itself; false: there is none.
static bool step_into(const ty_node** node, const char** path, ty_place* place)
{
    char word[TY_TREE_MAX_KEY];
    size_t length = strspn(*path, "abcdefghijklmnopqrstuvwxyz_0123456789");
    int index = -1, digits = 0;
    if (**path == '[' && sscanf(*path, "[%d]%n", &index, &digits) == 1 && digits > 0)
        length = (size_t)digits;
    else if (length > 0 && length < sizeof(word))
    {
        memcpy(word, *path, length);
        word[length] = 0;
        index = ty_node_find(*node, word);
    }
    if (index < 0 || (*node)->kind == TY_NODE_SCALAR || index >= (*node)->count)
        return false;
    *place = (*node)->kind == TY_NODE_MAP ? (*node)->keys[index].place : (*node)->items[index]->place;
    *node = (*node)->items[index];
    *path += length;
    *path += **path == '.';
    return true;
}

void ty_error_find_place(ty_error* error, const ty_node* root)
{
    if (error->file[0] || error->line > 0)
        return;
    const char* path = error->text;
    ty_place place = root->place;
    while (*path && *path != ':' && step_into(&root, &path, &place))
        ;
    const ty_error plain = *error;
    place_error(error, place, plain.status, plain.text);
}

void ty_report(ty_error_list* errors, ty_place place, ty_status status, const char* format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    ty_error error;
    place_error(&error, place, status, text);
    ty_error_list_add(errors, &error);
}

void ty_report_error(ty_error_list* errors, ty_place place, const char* what, const ty_error* error)
{
    char text[1536];
    ty_error_format(error, text, sizeof(text));
    ty_status status = error->status == TY_OK ? TY_INTERNAL : error->status;
    ty_report(errors, place, status, "%s: %s", what, text);
}

void ty_report_warning(ty_place place, const char* format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    ty_log(TY_LOG_WARNING, "%s:%d:%d: %s", place.source->file, place.line, place.column, text);
}
