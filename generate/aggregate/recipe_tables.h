// SPDX-License-Identifier: Apache-2.0
// The tables of which the table of an aggregate's recipe consists.
#pragma once
#include "mixture.h"
#include <tsuya/base/param_rows.h>

extern const ty_param_table recipe_element, recipe_container;                             // recipe_element.c
extern const ty_param_table recipe_settle, recipe_press, recipe_moisture, recipe_animate; // recipe_settle.c
