// SPDX-License-Identifier: Apache-2.0
// The files a scene names: where they are looked for, what is allowed, what goes into its hash.
#pragma once
#include "yaml_tree.h"
#include <tsuya/base/file.h>
#include <tsuya/base/hash.h>

typedef struct ty_file_entry
{
    const char* text; // relative to the scene's folder, or absolute
    const char* path; // to open
    ty_hash content;
    bool frames; // text and path are patterns: the files of all their frames
    bool hashed; // content is known: a file is read once, however many frames there are
} ty_file_entry;

typedef struct ty_files
{
    ty_arena* arena;
    ty_error_list* errors;
    const char* folder;  // of the scene
    const char** search; // further folders, relative to folder or absolute
    int search_count;
    bool sandbox; // nothing outside folder
    ty_file_entry* entries;
    int count, capacity;
} ty_files;

// The path to open of the file that node names: tried beside the file that says it, then in the search folders. The
// node's text becomes relative to the scene's folder; asked again, the node gives the same. Missing, no regular file,
// outside a sandbox: reported, NULL.
const char* ty_files_find(ty_files* files, ty_node* node, const char* what);
// The same, and the file's content belongs to the scene (see ty_files_add_to_hash).
const char* ty_files_use(ty_files* files, ty_node* node, const char* what);
// A pattern with #### for the numbers of frames, of which at least one is there.
const char* ty_files_use_frames(ty_files* files, ty_node* node, const char* what);
// Either, by whether the name has a #.
const char* ty_files_use_either(ty_files* files, ty_node* node, const char* what);
// Adds names and contents of entries [begin, end) in order.
TY_CHECKED ty_status ty_files_add_to_hash(ty_files* files, int begin, int end, ty_hasher* hasher, ty_error* error);
