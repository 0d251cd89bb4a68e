// SPDX-License-Identifier: Apache-2.0
// A picture against its reference: what `compare` tells and `regress` judges.
#pragma once
#include "picture.h"
#include <tsuya/image/metrics.h>

typedef struct ty_comparison_def
{
    const char* const* layers; // names, NULL = beauty (or the only layer); "all"
    int layer_count;
    const char* const* channels; // exact channels that make one layer of their own; count 0 = none
    int channel_count;
    bool metrics[TY_METRIC_COUNT]; // those to compute
    const int* crop;               // {x0, y0, x1, y1} inclusive, NULL = the whole data window
    const char* mask;              // "CHANNEL>NUMBER" (<, =) of mask_of, NULL = all pixels
    const ty_picture* mask_of;     // NULL = the reference
    float ppd;                     // of FLIP
    double peak;                   // of PSNR, 0 = the reference's largest value (display pictures: 1)
    ty_develop_def develop;        // how linear pictures are looked at by LDR-FLIP
    bool keep;                     // keep what reports show
    ty_workers* workers;
} ty_comparison_def;

ty_comparison_def ty_comparison_def_default(void); // beauty, every metric

typedef struct ty_compared_layer
{
    ty_layer layer;
    double value[TY_METRIC_COUNT]; // NaN where a metric does not apply or was not asked for
    ty_pixel_errors worst;         // x, y in the picture's pixels
    double mean[2];                // of reference and test, over the pixels that count
    ty_image shown[2];             // display colours of reference and test, three channels, if kept
    ty_image light[2];             // scene-linear ACEScg of both, if kept; NULL pixels where there is none
    float* error_map;              // [height][width], 0..1: FLIP of colours, else share of the largest difference
} ty_compared_layer;

typedef struct ty_comparison
{
    ty_compared_layer* layers;
    int layer_count;
    int window[4];        // what was compared
    bool differs;         // not comparable: difference says why; layers is empty
    char difference[512]; // size, channels, values that are not finite
} ty_comparison;

// TY_OK also for pictures that differ or cannot be compared (see differs); anything else is a fault of the files' or of
// the request, told in error. Free out with term in any case.
TY_CHECKED ty_status ty_compare(const ty_picture* reference, const ty_picture* test, const ty_comparison_def* def,
                                ty_comparison* out, ty_error* error);
void ty_comparison_term(ty_comparison* comparison);

// A bound on a metric: "flip>0.05" fails above .05, "psnr<40" below 40.
typedef struct ty_limit
{
    ty_metric metric;
    double bound;
    bool below; // fails below the bound
} ty_limit;
bool ty_limit_parse(const char* text, ty_limit* out);
// Whether a layer breaks it; a metric that is not known of a layer is not judged there.
bool ty_limit_breaks(const ty_limit* limit, const ty_compared_layer* layer);
// The metrics of which a layer breaks a limit, as bits 1 << ty_metric.
unsigned ty_limits_broken(const ty_limit* limits, int count, const ty_compared_layer* layer);

// The error map in colours; the caller frees the pixels.
TY_CHECKED ty_status ty_comparison_heat(const ty_compared_layer* layer, ty_image* out, ty_error* error);

// One self-contained page: pictures with a wipe, a flip and a heat view, and the numbers.
typedef struct ty_report_entry
{
    const char *title, *reference, *test; // file names
    const ty_comparison* comparison;
    const ty_limit* limits;
    int limit_count;
    const char* fault; // why there is no comparison, NULL = none
    bool failed;
} ty_report_entry;
// The page of `compare`; view: how scene-linear pictures are shown.
TY_CHECKED ty_status ty_compare_report(const char* path, const ty_report_entry* entry, const ty_develop_def* view,
                                       ty_error* error);
TY_CHECKED ty_status ty_comparison_report(const char* path, const char* title, const ty_report_entry* entries,
                                          int count, ty_error* error);
