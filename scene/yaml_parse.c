// SPDX-License-Identifier: Apache-2.0
// The door to libyaml: events to nodes, bounded while it reads, with aliases copied in place.
#include "yaml_tree.h"
#include <string.h>
#include <yaml.h>

typedef struct ty_anchor
{
    const char* name;
    const ty_node* node; // NULL while the node is still being read: an alias to it would contain itself
} ty_anchor;

typedef struct ty_builder
{
    ty_tree* tree;
    const ty_source* source;
    yaml_parser_t parser;
    ty_anchor* anchors; // [TY_TREE_MAX_ANCHORS], from the first anchor on
    int anchor_count;
    const char* bytes;
} ty_builder;

static ty_place place_of(const ty_builder* builder, yaml_mark_t mark)
{
    const char* argument = builder->source->argument;
    if (argument && mark.line > 0) // behind the end: libyaml adds a line
        return (ty_place){builder->source, 1, (int)strlen(argument) + 1};
    int column = (int)mark.column + 1 + (mark.line == 0 ? builder->source->column : 0);
    return (ty_place){builder->source, (int)mark.line + 1, column};
}

static void stop_at(ty_builder* builder, ty_place place, const char* text)
{
    if (!builder->tree->stopped)
        ty_report(builder->tree->errors, place, TY_BAD_INPUT, "%s", text);
    builder->tree->stopped = true;
}

static void report_syntax(ty_builder* builder)
{
    const yaml_parser_t* parser = &builder->parser;
    ty_place place = place_of(builder, parser->problem_mark);
    if (parser->error == YAML_READER_ERROR)
    {
        place = (ty_place){builder->source, 1, 1};
        for (size_t i = 0; i < parser->problem_offset && builder->bytes[i]; ++i)
        {
            place.column = builder->bytes[i] == '\n' ? 1 : place.column + 1;
            place.line += builder->bytes[i] == '\n';
        }
    }
    if (!builder->tree->stopped)
        ty_report(builder->tree->errors, place, TY_BAD_INPUT, "this is not YAML: %s%s%s",
                  parser->problem ? parser->problem : "no more memory", parser->context ? " " : "",
                  parser->context ? parser->context : "");
    builder->tree->stopped = true;
}

// The next event; false after a syntax error, which is reported.
static bool next_event(ty_builder* builder, yaml_event_t* event)
{
    if (yaml_parser_parse(&builder->parser, event))
        return true;
    report_syntax(builder);
    return false;
}

static ty_anchor* open_anchor(ty_builder* builder, const yaml_char_t* name, ty_place place)
{
    if (!name)
        return NULL;
    if (builder->anchor_count == TY_TREE_MAX_ANCHORS)
    {
        stop_at(builder, place, "more than 1000 anchors");
        return NULL;
    }
    if (!builder->anchors)
        builder->anchors = TY_ARENA_ALLOC(builder->tree->arena, ty_anchor, TY_TREE_MAX_ANCHORS);
    ty_anchor* anchor = &builder->anchors[builder->anchor_count++];
    anchor->name = ty_arena_string(builder->tree->arena, (const char*)name);
    return anchor;
}

static ty_node* read_alias(ty_builder* builder, const yaml_event_t* event, int depth)
{
    const char* name = (const char*)event->data.alias.anchor;
    ty_place place = place_of(builder, event->start_mark);
    for (int i = builder->anchor_count - 1; i >= 0; --i)
    {
        if (strcmp(builder->anchors[i].name, name) != 0)
            continue;
        if (builder->anchors[i].node)
            return ty_node_copy(builder->tree, builder->anchors[i].node, place, depth);
        stop_at(builder, place, "an alias inside the value that it repeats");
        return NULL;
    }
    stop_at(builder, place, "an alias without its anchor");
    return NULL;
}

static ty_node* read_scalar(ty_builder* builder, const yaml_event_t* event)
{
    const char* value = (const char*)event->data.scalar.value;
    ty_place place = place_of(builder, event->start_mark);
    if (strlen(value) != event->data.scalar.length)
    {
        stop_at(builder, place, "a zero byte in a text");
        return NULL;
    }
    ty_anchor* anchor = open_anchor(builder, event->data.scalar.anchor, place);
    ty_node* node = ty_node_create(builder->tree, TY_NODE_SCALAR, place);
    if (!node)
        return NULL;
    node->text = ty_arena_string(builder->tree->arena, value);
    if (anchor)
        anchor->node = node;
    return node;
}

static ty_node* read_node(ty_builder* builder, const yaml_event_t* event, int depth);

// Reads the node that begins with the next event.
static ty_node* read_next(ty_builder* builder, int depth)
{
    yaml_event_t event;
    if (!next_event(builder, &event))
        return NULL;
    ty_node* node = read_node(builder, &event, depth);
    yaml_event_delete(&event);
    return node;
}

static bool read_list(ty_builder* builder, ty_node* list, int depth)
{
    for (;;)
    {
        yaml_event_t event;
        if (!next_event(builder, &event))
            return false;
        bool end = event.type == YAML_SEQUENCE_END_EVENT;
        ty_node* item = end ? NULL : read_node(builder, &event, depth + 1);
        yaml_event_delete(&event);
        if (end)
            return true;
        if (!item)
            return false;
        ty_node_append(builder->tree, list, item);
    }
}

// One key with its value. A key that is no word, or stands twice, is reported and left out.
static bool read_pair(ty_builder* builder, ty_node* map, const yaml_event_t* event, int depth)
{
    ty_node* key = read_node(builder, event, depth + 1);
    ty_node* value = key ? read_next(builder, depth + 1) : NULL;
    if (!value)
        return false;
    ty_error_list* errors = builder->tree->errors;
    int found = key->kind == TY_NODE_SCALAR ? ty_node_find(map, key->text) : -1;
    if (key->kind != TY_NODE_SCALAR)
        ty_report(errors, key->place, TY_BAD_INPUT, "a key must be a word, not a list or mapping");
    else if (key->text[0] == 0)
        ty_report(errors, key->place, TY_BAD_INPUT, "a key is missing before ':'");
    else if (strlen(key->text) > TY_TREE_MAX_KEY)
        ty_report(errors, key->place, TY_BAD_INPUT, "a key of more than %d bytes", TY_TREE_MAX_KEY);
    else if (found >= 0)
        ty_report(errors, key->place, TY_BAD_INPUT, "duplicate key '%s', first at line %d", key->text,
                  map->keys[found].place.line);
    else
        ty_node_add(builder->tree, map, (ty_key){key->text, key->place}, value);
    return true;
}

static bool read_map(ty_builder* builder, ty_node* map, int depth)
{
    for (;;)
    {
        yaml_event_t event;
        if (!next_event(builder, &event))
            return false;
        bool end = event.type == YAML_MAPPING_END_EVENT;
        bool good = end || read_pair(builder, map, &event, depth);
        yaml_event_delete(&event);
        if (end || !good)
            return good;
    }
}

static ty_node* read_collection(ty_builder* builder, const yaml_event_t* event, int depth)
{
    bool is_list = event->type == YAML_SEQUENCE_START_EVENT;
    ty_place place = place_of(builder, event->start_mark);
    const yaml_char_t* name = is_list ? event->data.sequence_start.anchor : event->data.mapping_start.anchor;
    ty_anchor* anchor = open_anchor(builder, name, place);
    ty_node* node = ty_node_create(builder->tree, is_list ? TY_NODE_LIST : TY_NODE_MAP, place);
    if (!node || !(is_list ? read_list(builder, node, depth) : read_map(builder, node, depth)))
        return NULL;
    if (anchor)
        anchor->node = node;
    return node;
}

static bool has_tag(const yaml_event_t* event)
{
    switch (event->type)
    {
    case YAML_SCALAR_EVENT:
        return event->data.scalar.tag != NULL;
    case YAML_SEQUENCE_START_EVENT:
        return event->data.sequence_start.tag != NULL;
    case YAML_MAPPING_START_EVENT:
        return event->data.mapping_start.tag != NULL;
    default:
        return false;
    }
}

static ty_node* read_node(ty_builder* builder, const yaml_event_t* event, int depth)
{
    ty_place place = place_of(builder, event->start_mark);
    if (depth > TY_TREE_MAX_DEPTH)
        stop_at(builder, place, "nested deeper than 64 levels");
    else if (has_tag(event))
        stop_at(builder, place, "YAML tags ('!name') have no meaning here");
    if (builder->tree->stopped)
        return NULL;
    ty_node* node = NULL;
    if (event->type == YAML_SCALAR_EVENT)
        node = read_scalar(builder, event);
    else if (event->type == YAML_ALIAS_EVENT)
        node = read_alias(builder, event, depth);
    else
        node = read_collection(builder, event, depth);
    return builder->tree->stopped ? NULL : node;
}

// Expects exactly one document, and reports anything else.
static ty_node* read_stream(ty_builder* builder)
{
    ty_node* root = NULL;
    for (;;)
    {
        yaml_event_t event;
        if (!next_event(builder, &event))
            return NULL;
        yaml_event_type_t type = event.type;
        ty_place place = place_of(builder, event.start_mark);
        yaml_event_delete(&event);
        if (type == YAML_STREAM_END_EVENT)
            break;
        if (type != YAML_DOCUMENT_START_EVENT)
            continue;
        if (root)
            stop_at(builder, place, "a second document ('---') in the file");
        else
            root = read_next(builder, 1);
        if (builder->tree->stopped)
            return NULL;
    }
    if (!root)
        stop_at(builder, (ty_place){builder->source, 1, 1 + builder->source->column}, "nothing is written here");
    return root;
}

ty_node* ty_tree_parse(ty_tree* tree, const ty_source* source, const void* bytes, size_t size)
{
    ty_builder builder = {.tree = tree, .source = source, .bytes = bytes};
    if (size > TY_TREE_MAX_FILE)
    {
        stop_at(&builder, (ty_place){source, 1, 1}, "larger than 16 MiB");
        return NULL;
    }
    if (!yaml_parser_initialize(&builder.parser))
    {
        ty_report(tree->errors, (ty_place){source, 1, 1}, TY_NO_MEMORY, "no memory for the YAML parser");
        tree->stopped = true;
        return NULL;
    }
    yaml_parser_set_input_string(&builder.parser, bytes, size);
    ty_node* root = read_stream(&builder);
    yaml_parser_delete(&builder.parser);
    return root;
}
