// SPDX-License-Identifier: Apache-2.0
// The list of generators.
#include <string.h>
#include <tsuya/generate/aggregate_recipe.h>
#include <tsuya/generate/asset.h>
#include <tsuya/generate/fill_recipe.h>
#include <tsuya/generate/filter_recipe.h>
#include <tsuya/generate/loop_recipe.h>
#include <tsuya/generate/roots_recipe.h>

static const ty_generator* const generators[] = {&ty_aggregate_generator, &ty_fill_generator, &ty_filter_generator,
                                                 &ty_loop_generator, &ty_roots_generator};

const ty_generator* const* ty_generator_list(int* count)
{
    *count = (int)(sizeof generators / sizeof *generators);
    return generators;
}

const ty_generator* ty_generator_find(const char* kind)
{
    int count;
    const ty_generator* const* list = ty_generator_list(&count);
    for (int i = 0; i < count; i++)
        if (strcmp(list[i]->kind, kind) == 0)
            return list[i];
    return NULL;
}
