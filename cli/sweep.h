// SPDX-License-Identifier: Apache-2.0
// A sweep in work: its cells, what is known of each, and what is made of all of them.
#pragma once
#include "render_job.h"
#include <tsuya/scene/sweep.h>

typedef struct ty_sweep_cell
{
    char name[TY_SWEEP_NAME_MAX]; // of its files
    char* output;                 // FOLDER/name.exr
    char* command;                // what makes the same bytes again
    char hash[33];                // of its scene
    int corner[2], size[2];       // of its picture's window, pixels
    bool found;                   // was there, up to date, before this run
    bool done;                    // its picture is there
    ty_status status;
    char fault[512]; // why not
    double seconds;  // of rendering; below 0 = not known
} ty_sweep_cell;

typedef struct ty_sweep_job
{
    const ty_arguments* arguments;
    ty_sweep sweep;
    ty_sweep_cell* cells; // [sweep.cell_count]
    const char* folder;
    ty_scene_arguments base, scene; // without a cell's overrides; with those of the cell in work
    int fixed_sets;                 // of base: those in front of a cell's
    ty_render_job render;
    json_t* record; // as an earlier run left it, NULL = none
    int reference;  // cell
} ty_sweep_job;

// --- sweep_cells.c ---

// The scene's options with a cell's overrides, in job->scene; output and window of the cell into job->render.
void ty_sweep_set_cell(ty_sweep_job* job, int cell);
// "tsuya render ..." in the words of a shell. output NULL = without -o.
char* ty_sweep_command(const ty_sweep_job* job, int cell, const char* output);
// Every cell's scene is read and checked, and which pictures are up to date. All mistakes are told, each once.
TY_CHECKED ty_status ty_sweep_check(ty_sweep_job* job);
// Renders what is missing. A cell that fails is told, and the others go on; only a signal ends it.
TY_CHECKED ty_status ty_sweep_render(ty_sweep_job* job);

// --- sweep_record.c: FOLDER/sweep.json, what a sweep knows beyond its pictures ---

TY_CHECKED ty_status ty_sweep_record_write(const ty_sweep_job* job);
void ty_sweep_record_read(ty_sweep_job* job); // an unreadable one counts as none
// Seconds that a cell took, as recorded for the same scene; below 0 = not known.
double ty_sweep_record_seconds(const ty_sweep_job* job, const ty_sweep_cell* cell);
