// SPDX-License-Identifier: Apache-2.0
// White surfaces of every build: what lies over what.
#pragma once
#include <tsuya/shading/material.h>

typedef enum stack_kind
{
    STACK_LAMBERT,
    STACK_CLAY, // rough diffuse
    STACK_PLASTIC,
    STACK_ROUGH_PLASTIC, // over clay
    STACK_METAL,
    STACK_GLASS,
    STACK_FUZZ,
    STACK_FUZZ_CLAY,
    STACK_FUZZ_PLASTIC,
    STACK_FUZZ_METAL,
    STACK_FUZZ_GLASS,
    STACK_COAT_LAMBERT, // the coat has a roughness of its own, .3
    STACK_COAT_PLASTIC,
    STACK_COAT_METAL,
    STACK_COAT_GLASS,
    STACK_ROUGH_COAT_METAL, // coat and metal alike
    STACK_FUZZ_COAT_PLASTIC,
    STACK_FUZZ_COAT_METAL,
    STACK_FUZZ_COAT_GLASS,
    STACK_ALL, // a share of everything
    STACK_COUNT
} stack_kind;

static const char* const stack_names[] = {
    "lambert",
    "clay",
    "plastic",
    "plastic over clay",
    "metal",
    "glass",
    "fuzz",
    "fuzz, clay",
    "fuzz, plastic",
    "fuzz, metal",
    "fuzz, glass",
    "coat, lambert",
    "coat, plastic",
    "coat, metal",
    "coat, glass",
    "rough coat, metal",
    "fuzz, coat, plastic",
    "fuzz, coat, metal",
    "fuzz, coat, glass",
    "all",
};

static inline bool stack_has(stack_kind kind, const char* part)
{
    return strstr(stack_names[kind], part) != NULL;
}

static inline ty_surface_def stack(stack_kind kind, float roughness)
{
    ty_surface_def d = ty_surface_def_default();
    bool all = kind == STACK_ALL;
    d.base_color = ty_input_scalar(1);
    d.specular_roughness = d.fuzz_roughness = ty_input_scalar(roughness);
    d.specular_weight = ty_input_scalar(0);
    if (stack_has(kind, "plastic") || stack_has(kind, "metal") || stack_has(kind, "glass") || all)
        d.specular_weight = ty_input_scalar(1);
    if (stack_has(kind, "clay") || all)
        d.base_diffuse_roughness = ty_input_scalar(roughness);
    if (stack_has(kind, "metal") || all)
        d.base_metalness = ty_input_scalar(all ? 0.4f : 1.0f);
    if (stack_has(kind, "glass") || all)
        d.transmission_weight = ty_input_scalar(all ? 0.4f : 1.0f);
    if (stack_has(kind, "fuzz") || all)
        d.fuzz_weight = ty_input_scalar(all ? 0.5f : 1.0f);
    if (stack_has(kind, "coat") || all)
        d.coat_weight = ty_input_scalar(all ? 0.5f : 1.0f);
    d.coat_roughness = ty_input_scalar(kind == STACK_ROUGH_COAT_METAL ? roughness : 0.3f);
    return d;
}
