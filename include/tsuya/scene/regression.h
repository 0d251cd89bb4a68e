// SPDX-License-Identifier: Apache-2.0
// A list of scenes with reference pictures and how far a render may be from them: regress.yaml.
#pragma once
#include <tsuya/base/arena.h>
#include <tsuya/base/params.h>

#define TY_REGRESSION_UNJUDGED 1e30f

// Largest errors that pass, by metric (image/metrics.h); TY_REGRESSION_UNJUDGED = any. psnr is a smallest value, 0 =
// any.
typedef struct ty_regression_limits
{
    float rmse, relmse, trelmse, mae, psnr, max, flip, hdrflip;
} ty_regression_limits;

typedef struct ty_regression_case
{
    const char* name;
    const char* scene;            // path of a scene file or folder
    const char* reference;        // path of an .exr or .png; need not exist
    ty_param_strings set, define; // as --set and -D
    ty_param_strings layers;      // that are compared; count 0 = beauty
    ty_regression_limits limits;  // those of the file where the case says nothing
} ty_regression_case;

typedef struct ty_regression
{
    ty_arena* arena; // owns everything
    const char* path;
    ty_regression_case* cases;
    int case_count;
} ty_regression;

// path: the file, or a folder with regress.yaml. On failure *out is empty and errors holds every mistake found.
TY_CHECKED ty_status ty_regression_load(const char* path, ty_regression* out, ty_error_list* errors);
void ty_regression_term(ty_regression* regression);
const ty_param_table* ty_regression_params(void);
