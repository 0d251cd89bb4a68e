// SPDX-License-Identifier: Apache-2.0
// The results of a regression run.
#pragma once
#include "comparison.h"
#include <tsuya/scene/regression.h>

typedef enum ty_regress_verdict
{
    TY_REGRESS_PASSED,
    TY_REGRESS_DIFFERS, // beyond a limit, or not comparable
    TY_REGRESS_FAULT,   // could not be rendered or read: status says why
    TY_REGRESS_UPDATED, // the reference was written
    TY_REGRESS_KEPT,    // the reference is what was rendered
    TY_REGRESS_NOT_RUN, // left out by --only
} ty_regress_verdict;

typedef struct ty_regress_result
{
    const ty_regression_case* of;
    ty_regress_verdict verdict;
    ty_status status;
    ty_comparison comparison;
    ty_limit limits[TY_METRIC_COUNT];
    int limit_count;
    double seconds;
    char text[1024]; // why, in one line
} ty_regress_result;

static inline bool ty_regress_failed(const ty_regress_result* result)
{
    return result->verdict == TY_REGRESS_DIFFERS || result->verdict == TY_REGRESS_FAULT;
}

// JUnit XML of those that ran.
TY_CHECKED ty_status ty_regress_junit(const char* path, const ty_regress_result* results, int count, ty_error* error);
