// SPDX-License-Identifier: Apache-2.0
// An aggregate from its recipe, and what it tells of itself.
#pragma once
#include "base/cmocka_all.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>
#include <tsuya/geometry/mesh_file.h>
#include <unistd.h>

static double rest_metric(const ty_aggregate* a, const char* name)
{
    char key[64];
    snprintf(key, sizeof key, "\"%s\": ", name);
    const char* at = strstr(a->metrics, key);
    if (!at)
        fail_msg("no %s in %s", name, a->metrics);
    return atof(at + strlen(key));
}

static ty_aggregate* rest_made(const ty_aggregate_recipe* recipe, ty_workers* workers)
{
    ty_aggregate* out = NULL;
    ty_error error = {0};
    if (ty_aggregate_make(recipe, workers, &out, &error) != TY_OK)
        fail_msg("%s", error.text);
    return out;
}
