// SPDX-License-Identifier: Apache-2.0
// The tables of which the table of an aggregate's recipe consists.
#pragma once
#include "mixture.h"

// A row of a table whose struct is OWNER, of a number or a path.
#define FIELD(name, type, unit, low, high, member, help)                                                               \
    {                                                                                                                  \
        name, type, unit, low, high, NULL, NULL, offsetof(OWNER, member), help, false                                  \
    }

extern const ty_param_table recipe_element, recipe_container;                             // recipe_element.c
extern const ty_param_table recipe_settle, recipe_press, recipe_moisture, recipe_animate; // recipe_settle.c
