// SPDX-License-Identifier: Apache-2.0
// A whole run of a fill: 1920 x 1080 cells, 60 steps a frame, its frames painted and written as EXR files; how much of
// it is the kernel, painting and writing. bench_patterns_fill [frames [threads [cells a pixel's side, 1 or 4]]]:
// seconds for 240 frames, from as many as were made (40 by default).
#include "../cpu_time.h"
#include <stdio.h>
#include <stdlib.h>
#include <tsuya/base/log.h>
#include <tsuya/generate/fill_recipe.h>

enum
{
    STEPS = 60,
    FRAMES = 240 // that figures are for
};

typedef struct seconds
{
    double clock, work;
} seconds;

static seconds now(void)
{
    return (seconds){ty_time_now(), cpu_seconds()};
}

static void add_since(seconds* sum, seconds since)
{
    seconds end = now();
    sum->clock += end.clock - since.clock;
    sum->work += end.work - since.work;
}

static void die(const ty_error* error)
{
    fprintf(stderr, "bench_patterns_fill: %s\n", error->text);
    exit(1);
}

static ty_status put(void* context, int frame, ty_exr* image, ty_error* error)
{
    (void)frame;
    seconds begin = now();
    ty_status status = ty_exr_write("bench_patterns_fill.exr", image, error);
    add_since(context, begin);
    return status;
}

static ty_fill_recipe recipe_make(int frames, int scale)
{
    ty_fill_recipe r = ty_fill_recipe_default();
    r.cells[0] = 1920 / scale;
    r.cells[1] = 1080 / scale;
    r.scale = scale;
    r.tile = TY_PATTERN_TILE_NONE;
    r.drops.count = 600 / (scale * scale);
    r.run.frames = frames;
    r.run.steps = STEPS;
    return r;
}

// The same number of steps of a field of that size, from the same drops.
static seconds kernel_time(const ty_fill_recipe* r, ty_workers* workers)
{
    ty_gray_scott_def def = ty_gray_scott_def_default();
    ty_gray_scott* field;
    ty_error error;
    int count;
    const ty_fill_preset* stripes = ty_fill_presets(&count);
    def.width = r->cells[0];
    def.height = r->cells[1];
    def.wrap_x = def.wrap_y = false;
    def.rates[0] = (ty_gray_scott_rates){stripes->feed, stripes->kill};
    if (ty_gray_scott_create(&def, &field, &error) != TY_OK)
        die(&error);
    ty_rng rng = ty_rng_make(r->seed, 0, 0);
    for (int i = 0; i < r->drops.count; i++)
    {
        float x = ty_rng_range(&rng, 0.0f, (float)def.width), y = ty_rng_range(&rng, 0.0f, (float)def.height);
        ty_gray_scott_drop(field, x, y, r->drops.radius, &rng);
    }
    seconds begin = now(), sum = {0};
    for (int frame = 1; frame < r->run.frames; frame++)
        ty_gray_scott_step(field, STEPS, workers);
    add_since(&sum, begin);
    ty_gray_scott_destroy(field);
    return sum;
}

static void line(const char* what, seconds s, double frames)
{
    printf("%-28s %6.2f s on the clock, %6.2f s of processors\n", what, s.clock * FRAMES / frames,
           s.work * FRAMES / frames);
}

int main(int argc, char** argv)
{
    int frames = argc > 1 ? atoi(argv[1]) : 40, scale = argc > 3 ? atoi(argv[3]) : 1;
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(argc > 2 ? atoi(argv[2]) : 0, &workers, &error) != TY_OK)
        die(&error);
    ty_fill_recipe recipe = recipe_make(frames, scale);
    seconds writing = {0}, whole = {0}, kernel = kernel_time(&recipe, workers), begin = now();
    const ty_frame_sink sink = {put, NULL, &writing};
    if (ty_fill_make(&recipe, workers, &sink, &error) != TY_OK)
        die(&error);
    add_since(&whole, begin);
    seconds painting = {whole.clock - writing.clock - kernel.clock, whole.work - writing.work - kernel.work};
    printf("whole run: 1920 x 1080 pixels of %d x %d cells, %d frames of %d steps, %d threads\n", recipe.cells[0],
           recipe.cells[1], FRAMES, STEPS, ty_workers_count(workers));
    line("kernel", kernel, frames - 1);
    line("painting and all else", painting, frames);
    line("writing, EXR of one channel", writing, frames);
    ty_workers_destroy(workers);
    remove("bench_patterns_fill.exr");
    return 0;
}
