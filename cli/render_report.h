// SPDX-License-Identifier: Apache-2.0
// What a render tells when it is done.
#pragma once
#include "cli.h"
#include <tsuya/renderer/render.h>

json_t* ty_render_stats_json(const ty_scene* scene, const ty_render_stats* stats, const char* output);

// The names of the files of one frame of many, but with --json.
TY_CHECKED ty_status ty_render_report_files(const ty_arguments* arguments, const char* output, const char* preview);

// Where the files are on standard output (or all statistics with --json), a summary on standard error, and
// --stats F.json. output NULL = nothing was written; preview "" = none.
TY_CHECKED ty_status ty_render_report(const ty_scene* scene, const ty_arguments* arguments,
                                      const ty_render_stats* stats, const char* output, const char* preview);
