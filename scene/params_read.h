// SPDX-License-Identifier: Apache-2.0
// From a positioned tree to the structs that parameter tables describe.
#pragma once
#include "scene_files.h"
#include <tsuya/base/params.h>
#include <tsuya/image/color.h>

// What reading needs besides the tree. What a struct points to afterwards is the tree's (texts) or in arena (lists,
// paths).
typedef struct ty_reader
{
    ty_arena* arena;
    ty_error_list* errors;
    ty_files* files;
    const ty_color* color; // NULL: colours are taken as ACEScg (the configuration could not be loaded)
    // What a texture or attribute of an input refers to; index or -1 after a report. NULL where inputs cannot have
    // them.
    // layer: the name of a channel that alone counts, NULL = the picture; is_data: numbers, not colours; by_uv: needs
    // texture coordinates
    int (*find_texture)(void* context, ty_node* name, const ty_node* layer, bool is_data, bool by_uv,
                        const int wrap[2]);
    int (*find_attribute)(void* context, const ty_node* name);
    void* context;
} ty_reader;

// Fills *def (defaults first) from a mapping and reports everything wrong with it. skip: further keys that are somebody
// else's business, NULL-terminated, or NULL. False when there was anything to report.
bool ty_params_read(ty_reader* reader, ty_node* node, const ty_param_table* table, void* def, const char* const* skip);

// One value by itself; false after a report.
bool ty_param_read(ty_reader* reader, ty_node* node, const ty_param* row, void* field);

// "'name': expected a number 0..1, got a list of 2"
void ty_param_report_type(ty_reader* reader, const ty_node* node, const ty_param* row);
bool ty_param_in_range(ty_reader* reader, const ty_node* node, const ty_param* row, double value); // reports
bool ty_param_read_number(ty_reader* reader, const ty_node* node, const ty_param* row, float* out);
// The numbers of a list of exactly count; false after a report.
bool ty_param_read_numbers(ty_reader* reader, const ty_node* node, const ty_param* row, float* out, int count);
bool ty_param_read_rgb(ty_reader* reader, ty_node* node, const ty_param* row, ty_rgb* out);
// mapping, uv, channel, space, size and blend of an input that has a texture; *layer: a channel that is none of the
// picture's.
bool ty_param_read_mapping(ty_reader* reader, const ty_node* node, ty_input* input, int wrap[2], const ty_node** layer);
bool ty_param_read_input(ty_reader* reader, ty_node* node, const ty_param* row, ty_input* out);
// Reports every key of a mapping that is not among keys (NULL-terminated); of = what the mapping is.
bool ty_params_check_keys(ty_reader* reader, const ty_node* map, const char* const* keys, const char* of);
