// SPDX-License-Identifier: Apache-2.0
// How far one picture is from another: errors of pixels, and FLIP.
#pragma once
#include <tsuya/base/workers.h>
#include <tsuya/image/image.h>

typedef enum ty_metric
{
    TY_METRIC_RMSE,    // sqrt(mean (t - r)^2) over pixels and channels
    TY_METRIC_RELMSE,  // mean (t - r)^2 / (r^2 + .01)
    TY_METRIC_TRELMSE, // the same without the .1 % of pixels that are farthest off: blind to fireflies
    TY_METRIC_MAE,     // mean |t - r|
    TY_METRIC_PSNR,    // dB, 20 log10(peak / rmse); infinite for equal pictures
    TY_METRIC_MAX,     // the largest |t - r|
    TY_METRIC_FLIP,    // mean LDR-FLIP of display pictures, 0..1
    TY_METRIC_HDRFLIP, // mean HDR-FLIP of scene-linear pictures, 0..1
    TY_METRIC_COUNT
} ty_metric;

const char* ty_metric_name(ty_metric metric); // "rmse", ...
bool ty_metric_find(const char* name, ty_metric* out);
static inline bool ty_metric_rises(ty_metric metric) // whether more means better
{
    return metric == TY_METRIC_PSNR;
}

// The errors of pixels and where the largest stands.
typedef struct ty_pixel_errors
{
    double value[TY_METRIC_COUNT]; // RMSE to MAX; the others are left alone
    int x, y, channel;             // of the largest difference
    float reference, test;         // the values there
} ty_pixel_errors;

// Both pictures have one size and number of channels, and only finite values. mask (NULL = all): [height][width], the
// pixels that count; at least one does. peak 0 = the largest magnitude of the reference there. Sums run in double
// precision in the order of the pixels. TY_NO_MEMORY leaves *out as it was.
TY_CHECKED ty_status ty_pixel_errors_measure(const ty_image* reference, const ty_image* test, const uint8_t* mask,
                                             double peak, ty_pixel_errors* out, ty_error* error);

typedef struct ty_non_finite
{
    int64_t count; // values that are NaN or infinite
    int x, y, channel;
    float value; // the first, row by row
} ty_non_finite;
ty_non_finite ty_image_find_non_finite(const ty_image* image);

// Pixels a degree of a 0.7 m wide screen of 3840 pixels seen from 0.7 m, as in the paper on FLIP.
#define TY_FLIP_PPD 67.0206f

// LDR-FLIP (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: "FLIP: A Difference Evaluator for
// Alternating Images", 2020). Pictures of one size and three channels; display values 0..1, sRGB encoded when encoded
// is set, else linear. map: [height][width], the error of each pixel, 0..1. ppd: pixels a degree, 1..1000. The result
// does not depend on the workers (NULL = the caller alone). On failure map is undefined.
TY_CHECKED ty_status ty_flip_ldr(const ty_image* reference, const ty_image* test, bool encoded, float ppd,
                                 ty_workers* workers, float* map, ty_error* error);

// HDR-FLIP (Andersson, Nilsson, Shirley, Akenine-Möller: "Visualizing Errors in Rendered High Dynamic Range Images",
// 2021): the largest LDR-FLIP over exposures that take the reference from its brightest to its median luminance
// through a filmic curve. Pictures are linear Rec.709; negative values count as 0.
TY_CHECKED ty_status ty_flip_hdr(const ty_image* reference, const ty_image* test, float ppd, ty_workers* workers,
                                 float* map, ty_error* error);

// Mean of map over the mask (NULL = all).
double ty_map_mean(const float* map, const uint8_t* mask, int64_t count);

// Black, violet, red, yellow, white with lightness rising in even steps of OKLab; s in 0..1. sRGB encoded 0..1.
void ty_heat_color(float s, float out[3]);
