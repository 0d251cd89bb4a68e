// SPDX-License-Identifier: Apache-2.0
// Values that change with time: `{ keys: { frame: value } }` in the tree, evaluated into plain text for one moment, so
// that no reader of tables needs to know of keys.
#pragma once
#include "params_read.h"

// What stands at index of a section of the file, has keys, and is read again when they give other values.
typedef enum ty_section_kind
{
    TY_SECTION_CAMERA,
    TY_SECTION_TURNTABLE,
    TY_SECTION_MATERIAL,
    TY_SECTION_LIGHT,
    TY_SECTION_OBJECT,
} ty_section_kind;

typedef enum ty_interpolation
{
    TY_INTERPOLATE_LINEAR,
    TY_INTERPOLATE_SMOOTH, // monotone cubic
    TY_INTERPOLATE_EASE,   // at rest at each key
    TY_INTERPOLATE_HOLD,
} ty_interpolation;

typedef enum ty_outside
{
    TY_OUTSIDE_HOLD,
    TY_OUTSIDE_LOOP, // the last key's moment is the first's
    TY_OUTSIDE_MIRROR,
    TY_OUTSIDE_CONTINUE, // by the slope at the end
    TY_OUTSIDE_ERROR,
} ty_outside;

// A time in frames. The offset within the shutter stays apart, so that a loop's rounding is that of its first round.
typedef struct ty_moment
{
    double frame, offset;
} ty_moment;

typedef struct ty_track
{
    ty_node* keyed;    // as written: what a recipe shows
    ty_node** slot;    // where it stands in the tree
    ty_node* value;    // evaluated: scalars with buffers of their own
    ty_node* standing; // while keys are shown: what stood in the slot, value or what a reader made of it
    bool is_list;
    bool is_word; // true and false: held
    int components, key_count;
    double* times;      // [key_count], rising
    double* values;     // [key_count][components]
    double* slopes;     // the same, per frame; SMOOTH
    ty_place* keyed_at; // [key_count]
    ty_interpolation interpolation;
    ty_outside before, after;
} ty_track;

typedef struct ty_animated
{
    ty_section_kind section;
    int index; // of the entry in its section
    int first_track, track_count;
    bool changed; // since somebody cleared it
} ty_animated;

typedef struct ty_timeline
{
    ty_track* tracks;
    ty_animated* entries; // each with its tracks, in the order of the file
    int track_count, track_capacity, entry_count, entry_capacity;
} ty_timeline;

enum
{
    TY_TRACK_TEXT = 32 // bytes of a value's text
};

// Finds every keyed value below root and puts a plain one in its place; reports those that make no sense or stand where
// nothing changes with time.
void ty_timeline_collect(ty_timeline* timeline, ty_tree* tree, ty_reader* reader, ty_node* root);
// Gives the tracks of an entry their values; marks it as changed when any is another than before. errors NULL: what is
// outside where that is an error is not told.
void ty_timeline_evaluate(ty_timeline* timeline, int entry, ty_moment moment, ty_error_list* errors);
bool ty_track_covers(const ty_track* track, double frame); // it is not outside where that is an error
// One component of a track at a moment; within its keys, so neither ERROR nor a report.
double ty_track_value(const ty_track* track, int component, ty_moment moment);
// Puts what is written back in place of the values, or the values again.
void ty_timeline_show_keys(ty_timeline* timeline, bool keys);
// Index of the entry, or -1 when nothing of it is keyed.
int ty_timeline_find(const ty_timeline* timeline, ty_section_kind section, int index);
