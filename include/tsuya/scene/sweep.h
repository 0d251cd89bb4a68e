// SPDX-License-Identifier: Apache-2.0
// Variations of a scene: values of parameters as a grid of cells, each with overrides and a name of its own.
#pragma once
#include <tsuya/base/arena.h>

#define TY_SWEEP_AXES 16      // most parameters that vary
#define TY_SWEEP_VALUES 10000 // most values of one of them
#define TY_SWEEP_NAME_MAX 160 // bytes of a cell's name with its end
#define TY_SWEEP_SYNTAX "a,b,c or FROM:TO:COUNT or FROM:TO:COUNT:log"

typedef struct ty_sweep_value
{
    const char* text;     // as --set or -D takes it
    const char* override; // "name=text"
    int column;           // where it begins in the argument, from 1
    bool literal;         // written there as it is; else one of a range
} ty_sweep_value;

typedef struct ty_sweep_axis
{
    const char* argument; // "camera.vfov=10:30:3"
    const char* name;     // in front of the =
    bool is_variable;     // for -D; else a path for --set
    ty_sweep_value* values;
    int count;
} ty_sweep_axis;

typedef struct ty_sweep
{
    ty_arena* arena; // owns everything
    ty_sweep_axis* axes;
    int axis_count;
    bool zip; // cell i has value i of every axis; else every combination, the last axis changing fastest
    int cell_count;
} ty_sweep;

typedef struct ty_sweep_def
{
    const char* const* arguments; // NAME=VALUES each
    int argument_count;
    bool zip;
    int most_cells;
} ty_sweep_def;

// Values are separated by commas outside brackets and quotes; an item NUMBER:NUMBER:COUNT is a range with both ends, in
// equal steps, or in equal ratios with :log. Numbers of ranges have six digits, more where six do not tell them apart.
// A name with a dot, or of a section of scenes, is a path; any other is a variable. On failure *out is empty and errors
// holds every mistake, with its place in the argument.
TY_CHECKED ty_status ty_sweep_parse(const ty_sweep_def* def, ty_sweep* out, ty_error_list* errors);
void ty_sweep_term(ty_sweep* sweep);

int ty_sweep_index(const ty_sweep* sweep, int cell, int axis); // of the axis' value
const ty_sweep_value* ty_sweep_value_at(const ty_sweep* sweep, int cell, int axis);

// The name of a cell's files, without extension: "moisture=0.2,camera.vfov=20". A pure function of names and values, of
// letters, digits and . _ + - = , ~ alone, different for different values. What does not fit so is shortened or
// replaced, and a hash of the values follows.
void ty_sweep_name(const ty_sweep* sweep, int cell, char out[TY_SWEEP_NAME_MAX]);

// Mistakes that loading reports in a cell's overrides stand in the argument that they come from. False: in no argument.
bool ty_sweep_place_error(const ty_sweep* sweep, int cell, ty_error* error);
