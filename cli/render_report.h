// SPDX-License-Identifier: Apache-2.0
// What a render tells when it is done.
#pragma once
#include "cli.h"
#include <tsuya/renderer/render.h>

// Where the files are on standard output (or all statistics with --json), a summary on standard error, and
// --stats F.json. output NULL = nothing was written; preview "" = none.
TY_CHECKED ty_status ty_render_report(const ty_scene* scene, const ty_arguments* arguments,
                                      const ty_render_stats* stats, const char* output, const char* preview);
