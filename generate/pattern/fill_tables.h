// SPDX-License-Identifier: Apache-2.0
// Tables of a fill's recipe that its own table refers to.
#pragma once
#include <tsuya/base/param_rows.h>
#include <tsuya/generate/fill_recipe.h>

extern const char* const fill_preset_names[]; // as ty_fill_presets has them, up to NULL
extern const char* const fill_convention_names[];
void fill_matte_name(const char* mark, int number, char name[64]); // of the channel; a mark without a name: NULL
bool fill_has_closed_cells(const ty_fill_recipe* recipe);
extern const ty_param_table fill_mark_table, fill_event_table, fill_region_table, fill_auto_table, fill_run_table;
