// SPDX-License-Identifier: Apache-2.0
// Tables of a fill's recipe that its own table refers to.
#pragma once
#include <tsuya/generate/fill_recipe.h>

#define FIELD(name, type, unit, low, high, member, help)                                                               \
    {                                                                                                                  \
        name, type, unit, low, high, NULL, NULL, offsetof(OWNER, member), help, false                                  \
    }
#define GROUP(name, table, member, help)                                                                               \
    {                                                                                                                  \
        name, TY_PARAM_GROUP, "", 0, 0, NULL, table, offsetof(OWNER, member), help, false                              \
    }
#define CHOICE(name, choices, member, help)                                                                            \
    {                                                                                                                  \
        name, TY_PARAM_ENUM, "", 0, 0, choices, NULL, offsetof(OWNER, member), help, false                             \
    }
#define LIST(name, table, member, help)                                                                                \
    {                                                                                                                  \
        name, TY_PARAM_LIST, "", 0, 0, NULL, table, offsetof(OWNER, member), help, false                               \
    }

extern const char* const fill_preset_names[]; // as ty_fill_presets has them, up to NULL
extern const char* const fill_convention_names[];
extern const char* const fill_op_names[];
extern const ty_param_table fill_mark_table, fill_event_table, fill_region_table, fill_auto_table, fill_run_table;
