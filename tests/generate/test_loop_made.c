// SPDX-License-Identifier: Apache-2.0
// Looping textures from their recipes: the logo comes back as it was, colours stay with what carries them, sources and
// builders give what they say, mistakes are refused with their place.
#include "base/alloc_sweep.h"
#include "base/own_folder.h"
#include "loop_frames.h"
#include <tsuya/base/hash.h>
#include <tsuya/base/log.h>
#include <tsuya/image/color.h>
#include <tsuya/image/image.h>

enum
{
    SIDE = 48
};

typedef struct kept
{
    float* planes[4]; // of the frame that is kept
    int frame, channels, count;
    ty_hasher* hasher; // of all
} kept;

static ty_status keep(void* context, int frame, ty_exr* image, ty_error* error)
{
    kept* k = context;
    (void)error;
    size_t size = (size_t)ty_exr_width(image) * (size_t)ty_exr_height(image) * sizeof(float);
    k->count++;
    k->channels = image->channel_count;
    for (int c = 0; c < image->channel_count; c++)
        ty_hasher_add(k->hasher, image->channels[c].pixels, size);
    for (int c = 0; frame == k->frame && c < image->channel_count; c++)
    {
        k->planes[c] = ty_alloc(size, 1);
        memcpy(k->planes[c], image->channels[c].pixels, size);
    }
    return TY_OK;
}

static ty_status make(const ty_loop_recipe* recipe, int frame, ty_workers* workers, kept* k, ty_hash* hash,
                      ty_error* error)
{
    *k = (kept){.frame = frame, .hasher = ty_hasher_create()};
    const ty_frame_sink sink = {.put = keep, .context = k};
    ty_status status = ty_loop_make(recipe, workers, &sink, NULL, error);
    *hash = ty_hasher_end(k->hasher);
    return status;
}

static void forget(kept* k)
{
    for (int c = 0; c < 4; c++)
        ty_free(k->planes[c]);
}

static void image_write(const char* path, int width, int height, const float* rgb)
{
    ty_image image = {.width = width, .height = height, .channels = 3, .pixels = (float*)rgb};
    assert_int_equal(ty_image_write(path, &image, 8, NULL), TY_OK);
}

// Bars of as many colours on a background, and thin diagonals.
static float* logo_write(const char* path, int colors)
{
    float* rgb = TY_ALLOC(float, 3 * SIDE * SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
        {
            bool on = (x >= 5 && x < 43 && y >= 6 && y < 30) || (x + y == 70 && y > 31 && x < SIDE - 2);
            int bar = (x - 5) * colors / 38 < colors ? (x - 5) * colors / 38 : colors - 1;
            float* c = rgb + 3 * (y * SIDE + x);
            c[0] = on ? (float)(bar * 37 % 256) / 255.0f : 250.0f / 255.0f;
            c[1] = on ? (float)(bar * 91 % 256) / 255.0f : 240.0f / 255.0f;
            c[2] = on ? (float)(40 + bar * 11) / 255.0f : 30.0f / 255.0f;
        }
    image_write(path, SIDE, SIDE, rgb);
    return rgb;
}

static ty_loop_part part_default(void)
{
    const ty_param_table* table = ty_loop_recipe_table.params[0].group;
    ty_loop_part part;
    assert_int_equal(sizeof part, table->size);
    table->set_default(&part);
    return part;
}

static ty_loop_recipe recipe_of(ty_loop_part* parts, int count)
{
    ty_loop_recipe recipe = ty_loop_recipe_default();
    recipe.volume = (ty_param_list){parts, count};
    recipe.frames = 8;
    recipe.size[0] = recipe.size[1] = SIDE;
    return recipe;
}

static ty_loop_part logo_part(const char* path, int colors)
{
    ty_loop_part part = part_default();
    part.reaction.logo = path;
    part.reaction.depth = 25;
    part.reaction.every = 25;
    part.colors = colors;
    return part;
}

static void the_logo_is_there_at_frame_1(void** state)
{
    (void)state;
    static const int counts[] = {1, 3, 16};
    for (int i = 0; i < 6; i++)
    {
        char path[128];
        snprintf(path, sizeof path, "%s/logo%d.png", test_folder, counts[i % 3]);
        float* rgb = logo_write(path, counts[i % 3]);
        ty_loop_part part = logo_part(path, counts[i % 3]);
        part.mix = i < 3 ? TY_LOOP_MIX_LARGEST : TY_LOOP_MIX_BLEND;
        part.twist = i % 2 ? 2.0f : 0.0f; // about the logo
        part.reaction.gaps = i < 3 ? 0.0f : 0.7f;
        ty_loop_recipe recipe = recipe_of(&part, 1);
        recipe.motion.easing = 0.5f;
        kept k;
        ty_hash hash;
        ty_color* color;
        assert_int_equal(make(&recipe, 1, NULL, &k, &hash, NULL), TY_OK);
        assert_int_equal(k.count, 8);
        assert_int_equal(k.channels, 3);
        float* seen = TY_ALLOC(float, 3 * SIDE * SIDE);
        for (int p = 0; p < SIDE * SIDE; p++)
            for (int c = 0; c < 3; c++)
                seen[3 * p + c] = k.planes[c][p];
        assert_int_equal(ty_color_create(NULL, &color, NULL), TY_OK);
        assert_int_equal(ty_color_convert(color, "ACEScg", "srgb_texture", seen, SIDE * SIDE, 3, NULL), TY_OK);
        for (int p = 0; p < 3 * SIDE * SIDE; p++)
            assert_int_equal((int)(seen[p] * 255.0f + 0.5f), (int)(rgb[p] * 255.0f + 0.5f));
        ty_color_destroy(color);
        ty_free(seen);
        ty_free(rgb);
        forget(&k);
    }
}

// The logo with its background transparent.
static float* clear_logo_write(const char* path, int colors)
{
    float *rgb = logo_write(path, colors), *rgba = TY_ALLOC(float, 4 * SIDE * SIDE);
    for (int p = 0; p < SIDE * SIDE; p++)
    {
        memcpy(rgba + 4 * p, rgb + 3 * p, 3 * sizeof *rgb);
        rgba[4 * p + 3] = rgb[3 * p] == 250.0f / 255.0f ? 0.0f : 1.0f;
    }
    ty_image image = {.width = SIDE, .height = SIDE, .channels = 4, .pixels = rgba};
    assert_int_equal(ty_image_write(path, &image, 8, NULL), TY_OK);
    ty_free(rgb);
    return rgba;
}

static void clear_backgrounds_stay_clear(void** state)
{
    (void)state;
    const char* path = in_folder("clear.png");
    float* rgba = clear_logo_write(path, 3);
    for (int i = 0; i < 4; i++)
    {
        ty_loop_part part = logo_part(path, i < 2 ? 3 : 0); // of no colours: where the recipe says so
        part.mix = i == 1 ? TY_LOOP_MIX_BLEND : TY_LOOP_MIX_LARGEST;
        ty_loop_recipe recipe = recipe_of(&part, 1);
        recipe.clear = i >= 2;
        recipe.high = (ty_rgb){0.5f, i == 2 ? 0.5f : 0.25f, 0.5f};
        recipe.low = (ty_rgb){0.9f, 0.2f, 0.1f}; // is not seen
        for (int frame = 1; frame <= 3; frame += 2)
        {
            kept k;
            ty_hash hash;
            int edges = 0;
            assert_int_equal(make(&recipe, frame, NULL, &k, &hash, NULL), TY_OK);
            assert_int_equal(k.channels, i == 2 ? 2 : 4);
            const float* alpha = k.planes[k.channels - 1];
            for (int p = 0; p < SIDE * SIDE; p++)
            {
                edges += alpha[p] > 0.0f && alpha[p] < 1.0f;
                assert_true(alpha[p] >= 0.0f && alpha[p] <= 1.0f);
                if (frame == 1)
                    assert_true(alpha[p] == rgba[4 * p + 3]);
                for (int c = 0; c < k.channels - 1; c++)
                {
                    float full = c == 1 && i == 3 ? 0.25f : 0.5f; // multiplied by alpha
                    assert_true(i < 2 ? k.planes[c][p] <= alpha[p] : k.planes[c][p] == alpha[p] * full);
                    assert_true(alpha[p] > 0.0f || k.planes[c][p] == 0.0f);
                }
            }
            assert_true(frame == 1 ? edges == 0 : edges > 50);
            forget(&k);
        }
    }
    ty_free(rgba);
}

static void seventeen_colors_become_sixteen(void** state)
{
    (void)state;
    ty_loop_labels labels;
    const int cells[2] = {0, 0};
    float* rgb = logo_write(in_folder("many.png"), 30);
    assert_int_equal(ty_loop_labels_read(in_folder("many.png"), "logo", 16, cells, NULL, &labels, NULL), TY_OK);
    assert_int_equal(labels.palette.count, 16);
    double sum = 0.0;
    int inside = 0;
    for (int p = 0; p < SIDE * SIDE; p++)
    {
        bool on = rgb[3 * p] * 255.0f != 250.0f;
        assert_true((labels.labels[p] != TY_LOOP_BACKGROUND) == on);
        inside += on;
        for (int c = 0; on && c < 3; c++)
            sum += fabs((double)labels.palette.colors[labels.labels[p]][c] - 255.0 * (double)rgb[3 * p + c]);
    }
    print_message("thirty colours as sixteen: mean error %.1f of 255\n", sum / (3.0 * inside));
    assert_true(sum / (3.0 * inside) < 32.0);
    ty_loop_labels_term(&labels);
    ty_free(rgb);
}

// --- colours in the reaction ---

static void colors_add_up_to_v(void** state)
{
    (void)state;
    enum
    {
        K = 3,
        N = 64
    };
    ty_loop_reaction def = part_default().reaction;
    ty_gray_scott_def field_def = ty_gray_scott_def_default();
    field_def.width = field_def.height = N;
    field_def.rates[0] = (ty_gray_scott_rates){def.feed, def.kill};
    ty_gray_scott* field;
    assert_int_equal(ty_gray_scott_create(&field_def, &field, NULL), TY_OK);
    float *front = TY_ALLOC(float, K*N*N), *back = TY_ALLOC(float, K*N*N);
    for (int y = 20; y < 44; y++)
        for (int x = 20; x < 44; x++)
        {
            ty_gray_scott_u(field, y)[x] = 0.5f;
            ty_gray_scott_v(field, y)[x] = 0.25f;
            front[((x - 20) / 8) * N * N + y * N + x] = 0.25f;
        }
    for (int i = 0; i < 3000; i++)
    {
        assert_true(ty_loop_colors_step(field, &def, (const int[2]){N, N}, K, front, back, NULL));
        ty_gray_scott_step(field, 1, NULL);
        float* done = back;
        back = front;
        front = done;
    }
    double worst = 0.0, most = 0.0;
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++)
        {
            double sum = 0.0, v = (double)ty_gray_scott_v(field, y)[x];
            for (int c = 0; c < K; c++)
                sum += (double)front[c * N * N + y * N + x];
            worst = fmax(worst, fabs(sum - v));
            most = fmax(most, v);
        }
    print_message("sum of colours against v after 3000 steps: %.1e of %.2f\n", worst, most);
    assert_true(most > 0.2 && worst < 2e-4);
    ty_free(front);
    ty_free(back);
    ty_gray_scott_destroy(field);
}

static void colors_stay_and_change_no_shape(void** state)
{
    (void)state;
    ty_free(logo_write(in_folder("logo.png"), 2));
    const char* path = in_folder("logo.png");
    ty_loop_part plain = logo_part(path, 0), colored = logo_part(path, 2), blended = logo_part(path, 2);
    blended.mix = TY_LOOP_MIX_BLEND;
    ty_loop_recipe recipes[] = {recipe_of(&plain, 1), recipe_of(&colored, 1), recipe_of(&blended, 1)};
    ty_loop_volume volumes[3];
    for (int i = 0; i < 3; i++)
        assert_int_equal(ty_loop_volume_make(&recipes[i], NULL, &volumes[i], NULL), TY_OK);
    int64_t count[2] = {0, 0}, strayed = 0;
    for (size_t i = 0; i < volumes[0].count; i++)
    {
        assert_int_equal(volumes[0].values[i], volumes[1].values[i]);
        assert_int_equal(volumes[0].values[i], volumes[2].values[i]);
        if (volumes[1].values[i] < TY_LOOP_ONE / 2)
            continue;
        int x = (int)(i % volumes[1].row), label = volumes[1].labels[i];
        const uint8_t* own = volumes[1].palette.colors[label];
        count[label]++;
        // Left and right of the middle, well away from where they meet.
        strayed += (x > 10 && x < 20 && label != volumes[1].labels[ty_loop_voxel(&volumes[1], 12, 18, 12)]) ||
                   (x > 28 && x < 40 && label != volumes[1].labels[ty_loop_voxel(&volumes[1], 38, 18, 12)]);
        for (int c = 0; c < 3; c++) // a mean of the two
            assert_true(abs(volumes[2].tints[3 * i + (size_t)c] - own[c]) <=
                        abs(volumes[1].palette.colors[0][c] - volumes[1].palette.colors[1][c]));
    }
    assert_true(count[0] > 1000 && count[1] > 1000 && strayed == 0);
    for (int i = 0; i < 3; i++)
        ty_loop_volume_term(&volumes[i]);
}

static void gaps_let_wide_areas_live(void** state)
{
    (void)state;
    ty_free(logo_write(in_folder("logo.png"), 1));
    ty_loop_part whole = logo_part(in_folder("logo.png"), 0), part = whole;
    whole.reaction.feed = part.reaction.feed = 0.025f;
    whole.reaction.kill = part.reaction.kill = 0.0525f;
    whole.reaction.every = part.reaction.every = 200;
    part.reaction.gaps = 0.6f;
    ty_loop_recipe recipes[] = {recipe_of(&whole, 1), recipe_of(&part, 1)};
    int inside[2] = {0, 0};
    for (int i = 0; i < 2; i++)
    {
        ty_loop_volume v;
        assert_int_equal(ty_loop_volume_make(&recipes[i], NULL, &v, NULL), TY_OK);
        for (int y = 12; y < 24; y++) // amid the bars
            for (int x = 16; x < 32; x++)
                inside[i] += v.values[ty_loop_voxel(&v, x, y, 15)] > TY_LOOP_ONE / 2;
        ty_loop_volume_term(&v);
    }
    print_message("inside amid the logo after 600 steps: %d of 192 cells, with gaps %d\n", inside[0], inside[1]);
    assert_true(inside[1] > inside[0] + 10);
}

// --- builders ---

static float* ramp_write(const char* path, int size)
{
    float* rgb = TY_ALLOC(float, 3 * size * size);
    for (int i = 0; i < size * size; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (float)(i % size * 7 + i / size * 3 + 20) / 255.0f;
    image_write(path, size, size, rgb);
    return rgb;
}

static void builders_turn_mirror_and_unite(void** state)
{
    (void)state;
    enum
    {
        N = 15
    };
    float* rgb = ramp_write(in_folder("ramp.png"), N);
    ty_loop_part parts[2] = {part_default(), part_default()};
    for (int i = 0; i < 2; i++)
    {
        parts[i].source = TY_LOOP_STILL;
        parts[i].files = in_folder("ramp.png");
        parts[i].depth = N;
    }
    ty_loop_recipe one = recipe_of(parts, 1), both = recipe_of(parts, 2);
    ty_loop_volume v, turned, mirrored, twisted, united;
    assert_int_equal(ty_loop_volume_make(&one, NULL, &v, NULL), TY_OK);
    parts[0].rotate.x = TY_PI / 2.0f; // y to z: up becomes towards us
    assert_int_equal(ty_loop_volume_make(&one, NULL, &turned, NULL), TY_OK);
    parts[0].rotate.x = 0.0f;
    parts[0].mirror = TY_LOOP_MIRROR_X;
    assert_int_equal(ty_loop_volume_make(&one, NULL, &mirrored, NULL), TY_OK);
    parts[0].mirror = TY_LOOP_MIRROR_NONE;
    parts[0].twist = TY_PI;
    assert_int_equal(ty_loop_volume_make(&one, NULL, &twisted, NULL), TY_OK);
    parts[0].twist = 0.0f;
    parts[1].rotate.x = TY_PI / 2.0f;
    assert_int_equal(ty_loop_volume_make(&both, NULL, &united, NULL), TY_OK);
    for (int z = 0; z < N; z++)
        for (int y = 0; y < N; y++)
            for (int x = 0; x < N; x++)
            {
                size_t at = ty_loop_voxel(&v, x, y, z);
                assert_int_equal(v.values[at], ty_loop_number_of(rgb[3 * (y * N + x)]));
                // What was at height y (row N - 1 - y) is now at depth z.
                assert_int_equal(turned.values[at], v.values[ty_loop_voxel(&v, x, N - 1 - z, 0)]);
                assert_int_equal(mirrored.values[at], v.values[ty_loop_voxel(&v, x < N / 2 ? N - 1 - x : x, y, z)]);
                assert_int_equal(united.values[at],
                                 v.values[at] > turned.values[at] ? v.values[at] : turned.values[at]);
                if (z == N / 2)
                    assert_int_equal(twisted.values[at], v.values[at]);
            }
    // A quarter at both ends, opposite ways: seen from the front, counter-clockwise at the higher end.
    assert_true(abs(twisted.values[ty_loop_voxel(&v, 9, 6, N - 1)] - v.values[ty_loop_voxel(&v, 8, 9, 0)]) <= 1);
    assert_true(abs(twisted.values[ty_loop_voxel(&v, 8, 9, 0)] - v.values[ty_loop_voxel(&v, 9, 6, 0)]) <= 1);
    ty_loop_volume* all[] = {&v, &turned, &mirrored, &twisted, &united};
    for (int i = 0; i < 5; i++)
        ty_loop_volume_term(all[i]);
    ty_free(rgb);
}

static void raw_files_and_stacks_are_read(void** state)
{
    (void)state;
    uint8_t bytes[7 + 2 * 24];
    for (int i = 0; i < (int)sizeof bytes; i++)
        bytes[i] = (uint8_t)(i * 37);
    assert_int_equal(ty_file_write(in_folder("v.raw"), bytes, sizeof bytes, NULL), TY_OK);
    ty_loop_part part = part_default();
    part.source = TY_LOOP_RAW;
    part.raw = (ty_loop_raw){in_folder("v.raw"), 4, 3, 2, TY_LOOP_U16, 7, true};
    ty_loop_recipe recipe = recipe_of(&part, 1);
    ty_loop_volume v;
    assert_int_equal(ty_loop_volume_make(&recipe, NULL, &v, NULL), TY_OK);
    for (int i = 0; i < 24; i++)
        assert_int_equal(v.values[ty_loop_voxel(&v, i % 4, i / 4 % 3, i / 12)],
                         bytes[7 + 2 * i] * 256 + bytes[8 + 2 * i]);
    ty_loop_volume_term(&v);
    for (int z = 3; z < 6; z++)
    {
        float rgb[3 * 4];
        char name[32];
        for (int i = 0; i < 12; i++)
            rgb[i] = (float)(z * 20 + i / 3) / 255.0f;
        snprintf(name, sizeof name, "s.%04d.png", z);
        image_write(in_folder(name), 2, 2, rgb);
    }
    part = part_default();
    part.source = TY_LOOP_STACK;
    part.files = in_folder("s.####.png");
    recipe = recipe_of(&part, 1);
    assert_int_equal(ty_loop_volume_make(&recipe, NULL, &v, NULL), TY_OK);
    assert_int_equal(v.size[2], 3);
    for (int i = 0; i < 12; i++)
        assert_int_equal(v.values[ty_loop_voxel(&v, i % 2, i / 2 % 2, i / 4)],
                         ty_loop_number_of((float)((3 + i / 4) * 20 + i % 4) / 255.0f));
    ty_loop_volume_term(&v);
}

static void frames_of_a_fill_are_slices(void** state)
{
    (void)state;
    ty_loop_part part = part_default();
    part.source = TY_LOOP_FILL;
    part.fill.cells[0] = part.fill.cells[1] = 64;
    part.fill.drops.radius = 6.0f;
    part.fill.scale = 1;
    part.fill.steps = 1500;
    part.fill.drops.count = 6;
    part.fill.loop = (ty_pattern_loop){5, 1400, 0.0f};
    ty_loop_recipe recipe = recipe_of(&part, 1);
    ty_loop_volume v;
    assert_int_equal(ty_loop_volume_make(&recipe, NULL, &v, NULL), TY_OK);
    assert_int_equal(v.size[0], 64);
    assert_int_equal(v.size[2], 5);
    int differ = 0, inside = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++)
        {
            differ += v.values[ty_loop_voxel(&v, x, y, 1)] != v.values[ty_loop_voxel(&v, x, y, 4)];
            inside += v.values[ty_loop_voxel(&v, x, y, 0)] > TY_LOOP_ONE / 2;
        }
    assert_true(differ > 100 && inside > 20);
    ty_loop_volume_term(&v);
}

// --- what is seen ---

// Overlap of the frames at 20 and 26 degrees, the seed of all being drops.
static double overlap_at(const ty_loop_volume* volume, ty_vec3 center, float width, float height)
{
    ty_loop_recipe recipe = ty_loop_recipe_default();
    recipe.size[0] = recipe.size[1] = 128;
    recipe.plane = (ty_loop_plane){.center = center, .size = {width, height}};
    recipe.sampling = TY_LOOP_NEAREST;
    uint8_t *a = loop_inside(&recipe, volume, 10), *b = loop_inside(&recipe, volume, 13);
    int first = 0, both = 0;
    for (int i = 0; i < 128 * 128; i++)
    {
        first += a[i];
        both += a[i] & b[i];
    }
    ty_free(a);
    ty_free(b);
    return (double)both / first;
}

static void beside_the_axis_more_changes(void** state)
{
    (void)state;
    ty_loop_part part = part_default();
    part.reaction.cells[0] = part.reaction.cells[1] = 128;
    part.reaction.depth = 128;
    part.reaction.start = 3000;
    part.reaction.drops.count = 16;
    ty_loop_recipe recipe = recipe_of(&part, 1);
    ty_loop_volume v;
    assert_int_equal(ty_loop_volume_make(&recipe, NULL, &v, NULL), TY_OK);
    double centred = overlap_at(&v, (ty_vec3){0.0f, 0.0f, 0.0f}, 2.0f, 2.0f);
    double beside = overlap_at(&v, (ty_vec3){0.625f, 0.5f, 0.0f}, 0.75f, 0.5f);
    print_message("overlap of 20 and 26 degrees: centred %.3f, beside the axis %.3f\n", centred, beside);
    assert_true(beside < centred - 0.05);
    ty_loop_volume_term(&v);
}

static void threads_change_no_bit(void** state)
{
    (void)state;
    ty_hash first = {0, 0};
    ty_free(logo_write(in_folder("logo.png"), 5));
    for (int threads = 1; threads <= 3; threads++)
    {
        ty_loop_part part = logo_part(in_folder("logo.png"), 5);
        part.twist = 1.0f;
        part.mix = TY_LOOP_MIX_BLEND;
        ty_loop_recipe recipe = recipe_of(&part, 1);
        recipe.size[0] = 77;
        recipe.blur = 0.5f;
        recipe.blur_samples = 3;
        ty_workers* workers;
        kept k;
        ty_hash hash;
        assert_int_equal(ty_workers_create(threads, &workers, NULL), TY_OK);
        assert_int_equal(make(&recipe, 0, workers, &k, &hash, NULL), TY_OK);
        if (threads == 1)
            first = hash;
        assert_memory_equal(&first, &hash, sizeof hash);
        ty_workers_destroy(workers);
    }
}

// --- mistakes ---

static void must_refuse(const ty_loop_recipe* recipe, const char* text)
{
    kept k;
    ty_hash hash;
    ty_error error = {0};
    assert_int_equal(make(recipe, 0, NULL, &k, &hash, &error), TY_BAD_INPUT);
    if (!strstr(error.text, text))
        fail_msg("'%s' does not say '%s'", error.text, text);
    assert_int_equal(k.count, 0);
}

static void mistakes_are_refused(void** state)
{
    (void)state;
    ty_free(logo_write(in_folder("logo.png"), 2));
    ty_free(ramp_write(in_folder("t.0001.png"), 4));
    ty_free(ramp_write(in_folder("t.0003.png"), 4));
    ty_loop_part good = logo_part(in_folder("logo.png"), 2), part = good;
    ty_loop_recipe recipe = recipe_of(&part, 1), wrong = recipe;
    part.reaction.depth = 24;
    must_refuse(&recipe,
                "volume[0].reaction.depth: 24; with a logo an odd number, so that it lies in the middle: 23 or 25");
    part = good;
    part.range[0] = part.range[1] = 0.3f;
    must_refuse(&recipe, "volume[0].range: [0.3, 0.3]; two different numbers");
    part = good;
    wrong.axis.direction = (ty_vec3){0.0f, 0.0f, 0.0f};
    must_refuse(&wrong, "axis.direction: [0, 0, 0]; any length but zero");
    wrong = recipe;
    wrong.plane.center = (ty_vec3){0.9f, 0.0f, 3.0f};
    must_refuse(&wrong,
                "plane: at frame 1 it lies outside the volume, which reaches to x 1, y 1, z 0.520833 both ways");
    wrong = recipe;
    wrong.plane.rotate.y = 1.0f;
    wrong.motion.kind = TY_LOOP_ORBIT;
    must_refuse(&wrong, "plane.rotate: a turned rectangle does not tile; 0, 0, 0 in an orbit");
    ty_loop_key keys[2] = {{.at = 0.5f, .scale = {1, 1}}, {.at = 0.25f, .scale = {1, 1}}};
    wrong = recipe;
    wrong.motion.keys = (ty_param_list){keys, 2};
    must_refuse(&wrong, "motion.keys[1].at: 0.25; above that of the key before, 0.5");
    part = part_default();
    part.source = TY_LOOP_STACK;
    must_refuse(&recipe, "volume[0].files: missing");
    part.files = in_folder("t.####.png");
    must_refuse(&recipe, "lacks 1 of the frames 1..3: 2");
    must_refuse(&(ty_loop_recipe){.frames = 1, .size = {4, 4}}, "volume: it has no part; at least 1");
    part = part_default();
    part.source = TY_LOOP_RAW;
    must_refuse(&recipe, "volume[0].raw.file: missing");
    part.raw = (ty_loop_raw){in_folder("t.0001.png"), 9, 9, 9, TY_LOOP_U8, 0, false};
    must_refuse(&recipe, "9 x 9 x 9 numbers of 1 and a header of 0 are 729");
    part.raw.width = 0;
    must_refuse(&recipe, "volume[0].raw.width: the volume is empty; 1..2048 voxels");
    const uint8_t zeros[27] = {0};
    assert_int_equal(ty_file_write(in_folder("zero.raw"), zeros, sizeof zeros, NULL), TY_OK);
    part.raw = (ty_loop_raw){in_folder("zero.raw"), 3, 3, 3, TY_LOOP_U8, 0, false};
    must_refuse(&recipe, "volume: it is empty; its largest number is 0.0000");
    wrong = recipe;
    wrong.motion.kind = TY_LOOP_ORBIT;
    const uint8_t ones[27] = {255};
    assert_int_equal(ty_file_write(in_folder("zero.raw"), ones, sizeof ones, NULL), TY_OK);
    must_refuse(&wrong, "motion.kind: an orbit needs a volume that wraps in x and y");
}

// What can be told before the reaction runs is told before it runs: this one would take a day.
static void mistakes_cost_nothing(void** state)
{
    (void)state;
    ty_loop_part parts[2] = {part_default(), part_default()};
    parts[0].reaction.cells[0] = parts[0].reaction.cells[1] = 1024;
    parts[0].reaction.start = parts[0].reaction.every = 1000000;
    ty_loop_recipe good = recipe_of(parts, 1), wrong = good;
    wrong.axis.direction = (ty_vec3){0.0f, 0.0f, 0.0f};
    must_refuse(&wrong, "axis.direction: [0, 0, 0]; any length but zero");
    wrong = good;
    wrong.plane.center.x = 3.0f;
    wrong.motion.kind = TY_LOOP_REST;
    wrong.plane.center.z = 1.0f;
    must_refuse(&wrong,
                "plane: at frame 1 it lies outside the volume, which reaches to x 1, y 1, z 0.125977 both ways");
    wrong = good;
    wrong.motion.kind = TY_LOOP_ORBIT;
    parts[0].twist = 1.0f;
    must_refuse(&wrong, "motion.kind: an orbit needs a volume that wraps in x and y");
    parts[0].twist = 0.0f;
    wrong = recipe_of(parts, 2);
    parts[1].source = TY_LOOP_RAW;
    must_refuse(&wrong, "volume[1].raw.file: missing");
    parts[1].raw = (ty_loop_raw){in_folder("t.0001.png"), 9, 9, 9, TY_LOOP_U16, 3, false};
    must_refuse(&wrong, "9 x 9 x 9 numbers of 2 and a header of 3 are 1461");
    parts[1] = part_default();
    parts[1].reaction.time_step = 9.0f;
    must_refuse(&wrong, "volume[1].reaction.time_step: 9");
    parts[1] = logo_part(in_folder("logo.png"), 2);
    must_refuse(&wrong, "volume[1].colors: all parts have colours of one mix, or none has any");
    parts[1].reaction.depth = 4;
    must_refuse(&wrong, "volume[1].reaction.depth: 4; with a logo an odd number");
    parts[1] = part_default();
    parts[1].source = TY_LOOP_FILL;
    parts[1].fill.loop.span = 1 + parts[1].fill.steps;
    must_refuse(&wrong, "volume[1].fill.loop.span: 8001;");
    parts[1] = part_default();
    parts[1].range[0] = parts[1].range[1] = 2.0f;
    must_refuse(&wrong, "volume[1].range: [2, 2]; two different numbers");
    parts[0].reaction.cells[0] = parts[0].reaction.cells[1] = parts[0].reaction.depth = 2048;
    must_refuse(&good, "volume: 2048 x 2048 x 2048 voxels; at most 2147483647 in all");
}

static ty_status make_once(void* context)
{
    kept k;
    ty_hash hash;
    ty_error error;
    ty_status status = make(context, 0, NULL, &k, &hash, &error);
    assert_true(status == TY_OK || k.count == 0);
    return status;
}

static void memory_that_is_not_there_is_a_status(void** state)
{
    (void)state;
    ty_free(logo_write(in_folder("logo.png"), 30));
    ty_loop_part parts[2] = {logo_part(in_folder("logo.png"), 4), logo_part(in_folder("logo.png"), 4)};
    for (int i = 0; i < 2; i++)
    {
        parts[i].mix = TY_LOOP_MIX_BLEND;
        parts[i].reaction.depth = 3;
        parts[i].reaction.every = 1;
    }
    parts[0].twist = 1.0f;
    ty_loop_recipe recipe = recipe_of(parts, 2);
    recipe.frames = 2;
    int failed = ty_alloc_sweep(make_once, &recipe);
    print_message("allocations that failed in turn: %d\n", failed);
    assert_true(failed > 12);
}

int main(void)
{
    ty_log_set_level(TY_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_logo_is_there_at_frame_1),
        cmocka_unit_test(clear_backgrounds_stay_clear),
        cmocka_unit_test(seventeen_colors_become_sixteen),
        cmocka_unit_test(colors_add_up_to_v),
        cmocka_unit_test(colors_stay_and_change_no_shape),
        cmocka_unit_test(gaps_let_wide_areas_live),
        cmocka_unit_test(builders_turn_mirror_and_unite),
        cmocka_unit_test(raw_files_and_stacks_are_read),
        cmocka_unit_test(frames_of_a_fill_are_slices),
        cmocka_unit_test(beside_the_axis_more_changes),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(memory_that_is_not_there_is_a_status),
        cmocka_unit_test(mistakes_are_refused),
        cmocka_unit_test(mistakes_cost_nothing),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
