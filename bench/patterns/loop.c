// SPDX-License-Identifier: Apache-2.0
// Slicing of looping textures: 512^3 voxels to 180 frames of 1024^2 pixels, against the straightforward loop in double
// precision in the same run. bench_patterns_loop [voxels [pixels [frames [threads]]]].
#include "../../generate/pattern/loop_frame.h"
#include "../cpu_time.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

typedef struct bench
{
    ty_loop_recipe recipe;
    ty_loop_volume volume;
    ty_workers* workers;
} bench;

// Waves in all directions: about a third inside, 24 voxels from one to the next.
static void volume_fill(ty_loop_volume* v)
{
    float* wave = TY_ALLOC(float, v->size[0]);
    for (int i = 0; i < v->size[0]; i++)
        wave[i] = ty_sin((float)i * (2.0f * TY_PI / 24.0f));
    for (int z = 0; z < v->size[2]; z++)
        for (int y = 0; y < v->size[1]; y++)
            for (int x = 0; x < v->size[0]; x++)
                v->values[ty_loop_voxel(v, x, y, z)] = ty_loop_number_of(0.45f + 0.16f * (wave[x] + wave[y] + wave[z]));
    ty_free(wave);
    ty_loop_volume_close(v);
}

// As one would write it: a float volume, doubles, eight tests of the border.
static void slice_plain(const bench* b, const float* voxels, int i, float* out)
{
    const int* size = b->volume.size;
    ty_loop_grid g = ty_loop_motion_grid(&b->recipe, size, i, b->recipe.frames);
    for (int y = 0; y < b->recipe.size[1]; y++)
        for (int x = 0; x < b->recipe.size[0]; x++)
        {
            double p[3] = {g.origin.x + x * (double)g.across.x + y * (double)g.down.x,
                           g.origin.y + x * (double)g.across.y + y * (double)g.down.y,
                           g.origin.z + x * (double)g.across.z + y * (double)g.down.z};
            double sum = 0.0;
            int at[3];
            for (int k = 0; k < 3; k++)
                at[k] = (int)floor(p[k]);
            for (int c = 0; c < 8; c++)
            {
                int q[3] = {at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2)};
                double weight = 1.0;
                bool inside = true;
                for (int k = 0; k < 3; k++)
                {
                    double f = p[k] - at[k];
                    weight *= q[k] > at[k] ? f : 1.0 - f;
                    inside &= q[k] >= 0 && q[k] < size[k];
                }
                if (inside)
                    sum += weight *
                           (double)
                               voxels[((size_t)q[2] * (size_t)size[1] + (size_t)q[1]) * (size_t)size[0] + (size_t)q[0]];
            }
            out[(size_t)y * (size_t)b->recipe.size[0] + (size_t)x] = (float)sum;
        }
}

static double time_plain(const bench* b, int every)
{
    const int* size = b->volume.size;
    float* voxels = TY_ALLOC(float, (size_t)size[0] * (size_t)size[1] * (size_t)size[2]);
    float* out = TY_ALLOC(float, (size_t)b->recipe.size[0] * (size_t)b->recipe.size[1]);
    size_t n = 0;
    for (int z = 0; z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++)
                voxels[n++] = (float)b->volume.values[ty_loop_voxel(&b->volume, x, y, z)] / TY_LOOP_ONE;
    double start = cpu_seconds();
    int frames = 0;
    for (int i = 0; i < b->recipe.frames; i += every, frames++)
        slice_plain(b, voxels, i, out);
    double seconds = cpu_seconds() - start;
    ty_free(voxels);
    ty_free(out);
    return seconds / frames;
}

// Seconds a frame of elapsed and of processor time; painted: with edges, colours and an image.
static void time_frames(const bench* b, bool painted, double* elapsed, double* processor)
{
    ty_loop_painter* painter = NULL;
    ty_error error;
    if (ty_loop_painter_create(&b->recipe, &b->volume, b->workers, &painter, &error) != TY_OK)
        exit(1);
    double start = ty_time_now(), start_cpu = cpu_seconds();
    for (int i = 0; i < b->recipe.frames; i++)
    {
        const float* values;
        ty_exr* image = NULL;
        ty_status status = painted ? ty_loop_painter_paint(painter, i, &image, &error)
                                   : ty_loop_painter_slice(painter, i, b->recipe.frames, &values, &error);
        if (status != TY_OK)
            exit(1);
        ty_exr_destroy(image);
    }
    *elapsed = (ty_time_now() - start) / b->recipe.frames;
    *processor = (cpu_seconds() - start_cpu) / b->recipe.frames;
    ty_loop_painter_destroy(painter);
}

int main(int argc, char** argv)
{
    int voxels = argc > 1 ? atoi(argv[1]) : 512, pixels = argc > 2 ? atoi(argv[2]) : 1024;
    bench b = {.recipe = ty_loop_recipe_default()};
    ty_error error;
    b.recipe.frames = argc > 3 ? atoi(argv[3]) : 180;
    b.recipe.size[0] = b.recipe.size[1] = pixels;
    if (ty_loop_volume_create((const int[3]){voxels, voxels, voxels}, false, false, &b.volume, &error) != TY_OK ||
        ty_workers_create(argc > 4 ? atoi(argv[4]) : 0, &b.workers, &error) != TY_OK)
    {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    volume_fill(&b.volume);
    double million = 1e-6 * pixels * pixels, elapsed, processor;
    double plain = time_plain(&b, b.recipe.frames / 12 + 1);
    printf("%d^3 voxels, %d frames of %d^2 pixels, %d threads\n", voxels, b.recipe.frames, pixels,
           ty_workers_count(b.workers));
    printf("%-22s %8.2f ms of processor a frame, %7.1f Msample/s a core\n", "doubles, one by one", 1e3 * plain,
           million / plain);
    for (int painted = 0; painted < 2; painted++)
    {
        time_frames(&b, painted, &elapsed, &processor);
        printf("%-22s %8.2f ms of processor a frame, %7.1f Msample/s a core, %5.1f times as fast; %.2f s in all\n",
               painted ? "slices, edges, image" : "slices", 1e3 * processor, million / processor, plain / processor,
               elapsed * b.recipe.frames);
    }
    ty_workers_destroy(b.workers);
    ty_loop_volume_term(&b.volume);
    return 0;
}
