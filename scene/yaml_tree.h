// SPDX-License-Identifier: Apache-2.0
// A YAML document as a tree that knows where every key and value stands.
#pragma once
#include <stdint.h>
#include <tsuya/base/arena.h>

#define TY_TREE_MAX_FILE ((size_t)16 << 20) // bytes
#define TY_TREE_MAX_DEPTH 64
#define TY_TREE_MAX_NODES 1000000
#define TY_TREE_MAX_COPIED 100000 // nodes that come from aliases and variables
#define TY_TREE_MAX_FILES 64
#define TY_TREE_MAX_INCLUDE_DEPTH 16
#define TY_TREE_MAX_ANCHORS 1000
#define TY_TREE_MAX_KEY 256 // bytes

// Where text comes from.
typedef struct ty_source
{
    const char* file;     // as messages name it; "--set" and "-D" for overrides
    const char* base;     // folder of the file relative to the scene's folder, "" = that folder
    const char* argument; // of the command line, whole, or NULL
    int column;           // added to columns: where the value begins in argument
} ty_source;

typedef struct ty_place
{
    const ty_source* source;
    int line, column; // from 1
} ty_place;

typedef enum ty_node_kind
{
    TY_NODE_SCALAR,
    TY_NODE_LIST,
    TY_NODE_MAP
} ty_node_kind;

typedef struct ty_key
{
    const char* text;
    ty_place place;
} ty_key;

typedef struct ty_node ty_node;
struct ty_node
{
    ty_node_kind kind;
    bool bad; // reported already: whoever meets it says nothing more
    ty_place place;
    const char* text; // SCALAR; "" where nothing is written
    const char* path; // to open, once a name of a file was found; NULL before
    ty_node** items;  // LIST, MAP
    ty_key* keys;     // MAP
    int count, capacity;
    uint32_t* slots; // MAP: hash table of indices + 1, for more than a few keys
    uint32_t slot_count;
};

// A tree under construction, with what is left of the bounds.
typedef struct ty_tree
{
    ty_arena* arena;
    ty_error_list* errors; // borrowed
    int nodes, copied, files;
    bool stopped; // after a syntax error or a bound: nothing after it is worth reporting
} ty_tree;

// Parses one document; reports and returns NULL when there is none. Duplicate keys are reported and the first kept.
ty_node* ty_tree_parse(ty_tree* tree, const ty_source* source, const void* bytes, size_t size);

ty_node* ty_node_create(ty_tree* tree, ty_node_kind kind, ty_place place); // NULL and stopped when there are too many
// A deep copy, counted against the bound of copies; NULL and stopped beyond it. depth is that of the place it goes to.
ty_node* ty_node_copy(ty_tree* tree, const ty_node* node, ty_place used, int depth);
void ty_node_append(ty_tree* tree, ty_node* list, ty_node* item);
void ty_node_add(ty_tree* tree, ty_node* map, ty_key key, ty_node* value); // the key must be new
void ty_node_remove(ty_tree* tree, ty_node* map, const char* key);         // nothing if absent
int ty_node_find(const ty_node* map, const char* key);                     // index or -1; -1 for other kinds
ty_node* ty_node_get(const ty_node* map, const char* key);                 // NULL if absent
bool ty_node_is_empty(const ty_node* node); // nothing written, or an empty mapping or list
// "a list of 3", "a mapping", "'text'", "nothing": for messages.
const char* ty_node_describe(const ty_node* node, char buffer[80]);

// Where the error has no place: that of the key which its text begins with, as in "fill.density: ...", or of as much of
// it as is written below root.
void ty_error_find_place(ty_error* error, const ty_node* root);
// Adds an error at a place. Texts of command line overrides are quoted in full behind the message.
void ty_report(ty_error_list* errors, ty_place place, ty_status status, const char* format, ...) TY_PRINTF(4, 5);
// Adds an error of another floor at a place, with what it was about in front.
void ty_report_error(ty_error_list* errors, ty_place place, const char* what, const ty_error* error);
// A warning in the log, with its place.
void ty_report_warning(ty_place place, const char* format, ...) TY_PRINTF(2, 3);

// Canonical YAML of a tree: block mappings, lists of scalars in one line, no comments, "$" escaped. The caller frees
// it.
char* ty_tree_emit(const ty_node* root);
