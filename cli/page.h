// SPDX-License-Identifier: Apache-2.0
// A report as one HTML file that needs nothing beside it: pictures whose exposure can be changed, side against side,
// with their measures. cli/page/ holds what it looks like and does.
#pragma once
#include "cli.h"
#include <tsuya/image/metrics.h>

typedef enum ty_page_kind
{
    TY_PAGE_VIEW,    // scene-linear ACEScg, shown through the view
    TY_PAGE_DISPLAY, // display values, encoded; exposure is applied to their light
    TY_PAGE_FIXED,   // display values that exposure does not touch, as heat maps
} ty_page_kind;

typedef struct ty_page
{
    json_t* data; // what the script reads; the caller adds title, facts, cells, pairs ..., see ty_page_begin
    ty_bytes* pictures;
    int picture_count;
    bool views;          // some picture is shown through the view
    ty_develop_def view; // which
    const char* title;   // borrowed
} ty_page;

// An empty page of that kind, "sweep" or "compare", whose table shows these metrics. End it with ty_page_term.
void ty_page_begin(ty_page* page, const char* kind, const char* title, const ty_develop_def* view,
                   const bool metrics[TY_METRIC_COUNT]);
void ty_page_term(ty_page* page);

// How many pixels a side become one, so that pictures of that size are clear and the file stays within bounds.
int ty_page_factor(int64_t pixels_of_all, int longest_side);
// Adds three channels, made smaller by factor. corner: of the window, in pixels. Its index goes into *index.
TY_CHECKED ty_status ty_page_add(ty_page* page, const ty_image* image, ty_page_kind kind, int factor,
                                 const int corner[2], int* index, ty_error* error);
// Measures of one picture against another, by the names of ty_metric; NaN = not known. broken: bits of metrics beyond a
// limit.
void ty_page_add_pair(ty_page* page, int reference, int test, const double* values, unsigned broken);
TY_CHECKED ty_status ty_page_write(const ty_page* page, const char* path, ty_error* error);
