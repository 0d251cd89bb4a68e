// SPDX-License-Identifier: Apache-2.0
// Scene and recipe files as one tree each: includes merged, variables replaced.
#pragma once
#include "scene_files.h"

// The file at path with its includes; base as in ty_source; named_at = what names it, NULL for the first file. NULL
// after a report.
ty_node* ty_document_load(ty_tree* tree, ty_files* files, const char* path, const char* base, const ty_place* named_at);
// The same from memory; name stands in messages.
ty_node* ty_document_parse(ty_tree* tree, ty_files* files, const char* name, const void* bytes, size_t size);
// Requires `tsuya: 1` and takes it out.
void ty_document_take_version(ty_tree* tree, ty_node* root);

// A `vars:` mapping.
typedef struct ty_variables
{
    ty_node* map; // NULL = none
    bool *busy, *used;
} ty_variables;

// Where names are looked up, first layer first.
typedef struct ty_scope
{
    ty_tree* tree;
    ty_variables* layers[3];
    int count;
} ty_scope;

// Takes `vars` out of root.
ty_variables* ty_variables_take(ty_tree* tree, ty_node* root);
ty_variables* ty_variables_create(ty_tree* tree, ty_node* map); // map may be NULL
void ty_variables_warn_unused(const ty_variables* variables);
// Replaces every scalar $name below *slot by the value of name, and $$ by $. Unknown names and circles are reported.
void ty_scope_expand(ty_scope* scope, ty_node** slot, int depth);
