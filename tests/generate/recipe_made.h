// SPDX-License-Identifier: Apache-2.0
// Aggregates made from recipes: those that succeed, and those that are refused with an answer that helps.
#pragma once
#include "base/cmocka_all.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>

static inline ty_aggregate* made(const ty_aggregate_recipe* recipe, ty_workers* workers)
{
    ty_aggregate* out = NULL;
    ty_error error = {0};
    if (ty_aggregate_make(recipe, workers, &out, &error) != TY_OK)
        fail_msg("%s", error.text);
    return out;
}

// What is said holds both texts: names the field, tells the range.
static inline void assert_fails(const ty_aggregate_recipe* recipe, ty_status expected, const char* field,
                                const char* range)
{
    ty_aggregate* out = (ty_aggregate*)1;
    ty_error error = {0};
    assert_int_equal(ty_aggregate_make(recipe, NULL, &out, &error), expected);
    assert_null(out);
    if (!strstr(error.text, field) || !strstr(error.text, range))
        fail_msg("'%s' does not name '%s' and '%s'", error.text, field, range);
}

static inline void assert_refused(const ty_aggregate_recipe* recipe, const char* field, const char* range)
{
    assert_fails(recipe, TY_BAD_INPUT, field, range);
}

// name: in quotes, as in the metrics' JSON.
static inline double metric(const ty_aggregate* a, const char* name)
{
    const char* at = strstr(a->metrics, name);
    assert_non_null(at);
    return atof(at + strlen(name) + 2);
}
