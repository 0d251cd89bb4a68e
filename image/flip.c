// SPDX-License-Identifier: Apache-2.0
// FLIP of two display pictures: colour differences that a viewer sees, sharpened where edges or points differ.
#include "flip_filter.h"
#include "flip_run.h"
#include <math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/metrics.h>

// Constants of the paper: exponents of colour and features, and the point (p_c, p_t) of the redistribution.
#define COLOR_EXPONENT 0.7f
#define FEATURE_EXPONENT 0.5f
#define SPLIT_FROM 0.4f
#define SPLIT_TO 0.95f

struct ty_flip_run
{
    int width, height;
    ty_flip_kernels kernels;
    ty_workers* workers;
    float largest_color; // that the colours of a display can have: green to blue
    float* opponent[TY_FLIP_OPPONENT_COUNT];
    float* passes[TY_FLIP_PASS_COUNT];
    float* planes[2][TY_FLIP_PLANE_COUNT];
    // of the pass that runs
    ty_flip_pixel_fn* pixel;
    const void* context;
    float* map;
    bool keep_larger;
};

// City-block in lightness, Euclidean in chroma (HyAB, Abasi et al. 2020).
static float hyab(const float a[3], const float b[3])
{
    float da = a[1] - b[1], db = a[2] - b[2];
    return fabsf(a[0] - b[0]) + sqrtf(da * da + db * db);
}

static float largest_color(void)
{
    static const float green[3] = {0.0f, 1.0f, 0.0f}, blue[3] = {0.0f, 0.0f, 1.0f};
    float opponent[3], first[3], second[3];
    ty_flip_opponent(green, opponent);
    ty_flip_lab(opponent, first);
    ty_flip_opponent(blue, opponent);
    ty_flip_lab(opponent, second);
    return ty_pow(hyab(first, second), COLOR_EXPONENT);
}

static bool take_planes(ty_flip_run* run, float** planes, int count)
{
    for (int i = 0; i < count; i++)
        if (!(planes[i] = TY_TRY_ALLOC(float, (size_t)run->width*(size_t)run->height)))
            return false;
    return true;
}

static void free_planes(float** planes, int count)
{
    for (int i = 0; i < count; i++)
        ty_free(planes[i]);
}

void ty_flip_run_destroy(ty_flip_run* run)
{
    if (!run)
        return;
    free_planes(run->opponent, TY_FLIP_OPPONENT_COUNT);
    free_planes(run->passes, TY_FLIP_PASS_COUNT);
    for (int i = 0; i < 2; i++)
        free_planes(run->planes[i], TY_FLIP_PLANE_COUNT);
    ty_free(run);
}

ty_status ty_flip_run_create(int width, int height, float ppd, ty_workers* workers, ty_flip_run** out, ty_error* error)
{
    *out = NULL;
    if (!(ppd >= 1.0f && ppd <= TY_FLIP_PPD_MAX))
        return ty_error_set(error, TY_BAD_INPUT, "%g pixels a degree: FLIP takes 1 to %d", (double)ppd,
                            TY_FLIP_PPD_MAX);
    ty_flip_run* run = TY_ALLOC(ty_flip_run, 1);
    run->width = width;
    run->height = height;
    run->workers = workers;
    run->largest_color = largest_color();
    ty_flip_kernels_make(ppd, &run->kernels);
    bool good =
        take_planes(run, run->opponent, TY_FLIP_OPPONENT_COUNT) && take_planes(run, run->passes, TY_FLIP_PASS_COUNT);
    for (int i = 0; i < 2; i++)
        good = good && take_planes(run, run->planes[i], TY_FLIP_PLANE_COUNT);
    if (!good)
    {
        ty_flip_run_destroy(run);
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for FLIP of %d x %d pixels", width, height);
    }
    *out = run;
    return TY_OK;
}

static void fill_rows(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const ty_flip_run* run = context;
    for (int64_t i = begin * run->width; i < end * run->width; i++)
    {
        float rgb[3], opponent[3];
        run->pixel(run->context, i, rgb);
        ty_flip_opponent(rgb, opponent);
        for (int c = 0; c < TY_FLIP_OPPONENT_COUNT; c++)
            run->opponent[c][i] = opponent[c];
    }
}

void ty_flip_run_picture(ty_flip_run* run, int side, ty_flip_pixel_fn* pixel, const void* context)
{
    run->pixel = pixel;
    run->context = context;
    ty_parallel_for(run->workers, run->height, 16, fill_rows, run);
    ty_flip_filter filter = {.kernels = &run->kernels, .width = run->width, .height = run->height};
    for (int i = 0; i < TY_FLIP_OPPONENT_COUNT; i++)
        filter.opponent[i] = run->opponent[i];
    for (int i = 0; i < TY_FLIP_PASS_COUNT; i++)
        filter.passes[i] = run->passes[i];
    for (int i = 0; i < TY_FLIP_PLANE_COUNT; i++)
        filter.planes[i] = run->planes[side][i];
    ty_flip_filter_run(&filter, run->workers);
}

static float pixel_error(const ty_flip_run* run, int64_t i)
{
    float lab[2][3];
    for (int side = 0; side < 2; side++)
        for (int c = 0; c < 3; c++)
            lab[side][c] = run->planes[side][c][i];
    float color = ty_pow(hyab(lab[0], lab[1]), COLOR_EXPONENT), split = SPLIT_FROM * run->largest_color;
    color = color < split ? SPLIT_TO / split * color
                          : SPLIT_TO + (color - split) / (run->largest_color - split) * (1.0f - SPLIT_TO);
    float edge = fabsf(run->planes[0][TY_FLIP_EDGE][i] - run->planes[1][TY_FLIP_EDGE][i]);
    float point = fabsf(run->planes[0][TY_FLIP_POINT][i] - run->planes[1][TY_FLIP_POINT][i]);
    float feature = ty_min(ty_pow(ty_max(edge, point) * sqrtf(0.5f), FEATURE_EXPONENT), 1.0f);
    return color > 0.0f ? ty_clamp(ty_pow(color, 1.0f - feature), 0.0f, 1.0f) : 0.0f;
}

static void error_rows(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    const ty_flip_run* run = context;
    for (int64_t i = begin * run->width; i < end * run->width; i++)
    {
        float error = pixel_error(run, i);
        run->map[i] = run->keep_larger ? ty_max(run->map[i], error) : error;
    }
}

void ty_flip_run_errors(ty_flip_run* run, bool keep_larger, float* map)
{
    run->map = map;
    run->keep_larger = keep_larger;
    ty_parallel_for(run->workers, run->height, 16, error_rows, run);
}

static void display_pixel(const void* context, int64_t i, float rgb[3])
{
    const ty_image* image = context;
    for (int c = 0; c < 3; c++)
        rgb[c] = ty_clamp(image->pixels[3 * i + c], 0.0f, 1.0f);
}

static void encoded_pixel(const void* context, int64_t i, float rgb[3])
{
    display_pixel(context, i, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = rgb[c] <= 0.04045f ? rgb[c] / 12.92f : ty_pow((rgb[c] + 0.055f) / 1.055f, 2.4f);
}

ty_status ty_flip_ldr(const ty_image* reference, const ty_image* test, bool encoded, float ppd, ty_workers* workers,
                      float* map, ty_error* error)
{
    TY_ASSERT(reference->width == test->width && reference->height == test->height);
    TY_ASSERT(reference->channels == 3 && test->channels == 3);
    ty_flip_run* run;
    ty_status status = ty_flip_run_create(reference->width, reference->height, ppd, workers, &run, error);
    if (status != TY_OK)
        return status;
    ty_flip_run_picture(run, 0, encoded ? encoded_pixel : display_pixel, reference);
    ty_flip_run_picture(run, 1, encoded ? encoded_pixel : display_pixel, test);
    ty_flip_run_errors(run, false, map);
    ty_flip_run_destroy(run);
    return TY_OK;
}
