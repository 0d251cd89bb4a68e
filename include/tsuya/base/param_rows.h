// SPDX-License-Identifier: Apache-2.0
// Short words for files that are parameter tables: rows of a table whose struct is OWNER, and the table. For .c files
// and private headers alone, as the words have no prefix.
#pragma once
#include <tsuya/base/params.h>

// A number, a text or a path.
#define FIELD(name, type, unit, low, high, member, help)                                                               \
    {                                                                                                                  \
        name, type, unit, low, high, NULL, NULL, offsetof(OWNER, member), help, false                                  \
    }
// One of choices, texts up to NULL.
#define CHOICE(name, choices, member, help)                                                                            \
    {                                                                                                                  \
        name, TY_PARAM_ENUM, "", 0, 0, choices, NULL, offsetof(OWNER, member), help, false                             \
    }
#define GROUP(name, table, member, help)                                                                               \
    {                                                                                                                  \
        name, TY_PARAM_GROUP, "", 0, 0, NULL, table, offsetof(OWNER, member), help, false                              \
    }
#define LIST(name, table, member, help)                                                                                \
    {                                                                                                                  \
        name, TY_PARAM_LIST, "", 0, 0, NULL, table, offsetof(OWNER, member), help, false                               \
    }
// The table of rows, whose defaults set_NAME(def) sets.
#define TABLE(name, heading, help, rows)                                                                               \
    static const ty_param_table name = {heading, help, sizeof(OWNER), set_##name, rows, TY_PARAM_COUNT(rows)}
