// SPDX-License-Identifier: Apache-2.0
// Aggregates made from recipes: those that succeed, and those that are refused with an answer that helps.
#pragma once
#include "base/cmocka_all.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>
#include <tsuya/geometry/mesh_file.h>
#include <unistd.h>

// m
static inline void set_bowl(ty_shape_def* shape, float radius, float height, float thickness, float foot_radius,
                            float foot_height)
{
    shape->radius = radius;
    shape->height = height;
    shape->thickness = thickness;
    shape->foot_radius = foot_radius;
    shape->foot_height = foot_height;
}

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

static inline double metric(const ty_aggregate* a, const char* name)
{
    char key[64];
    (void)snprintf(key, sizeof key, "\"%s\": ", name);
    const char* at = strstr(a->metrics, key);
    if (!at)
        fail_msg("no %s in %s", name, a->metrics);
    return atof(at + strlen(key));
}

// Into a new file, whose name replaces the XXXXXX of path, before an ending of four letters.
static inline void mesh_keep(const ty_mesh* mesh, char* path)
{
    ty_error error;
    int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(ty_ply_write(path, mesh, &error), TY_OK);
}
