// SPDX-License-Identifier: Apache-2.0
// Filtered textures: reductions of constants and ramps, what lies outside of 0..1, sequences, the cache of files.
#include "base/cmocka_all.h"
#include "image_folder.h"
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/rng.h>
#include <tsuya/base/workers.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/mip_texture.h>
#include <unistd.h>

static ty_color* color;
static ty_mip_cache* cache;

static ty_mip_cache* make_cache(const char* folder, uint64_t memory)
{
    ty_mip_cache* made = NULL;
    ty_error error;
    if (folder)
        mkdir(folder, 0777);
    const ty_mip_cache_def def = {folder, memory};
    assert_int_equal(ty_mip_cache_create(&def, color, &made, &error), TY_OK);
    return made;
}

static int setup(void** state)
{
    if (ty_color_create(NULL, &color, NULL) != TY_OK || folder_setup(state) != 0)
        return -1;
    char path[TY_PATH_MAX];
    snprintf(path, sizeof path, "%s", in_folder("cache"));
    cache = make_cache(path, TY_MIP_CACHE_BYTES);
    return 0;
}

static int teardown(void** state)
{
    ty_mip_cache_destroy(cache);
    ty_color_destroy(color);
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", test_folder);
    return system(command);
}

typedef float texel_fn(int x, int y, int channel);

static const char* write_image(const char* name, int width, int height, int channels, texel_fn* value)
{
    static char path[TY_PATH_MAX];
    static const char* const names[] = {"R", "G", "B", "A"};
    const int window[4] = {0, 0, width - 1, height - 1};
    ty_exr* exr = ty_exr_create(window, window);
    for (int c = 0; c < channels; c++)
    {
        float* pixels = ty_exr_add_channel(exr, channels == 1 ? "Y" : names[c], TY_EXR_FLOAT);
        for (int i = 0; i < width * height; i++)
            pixels[i] = value(i % width, i / width, c);
    }
    snprintf(path, sizeof path, "%s", in_folder(name));
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    return path;
}

static ty_mip_texture* open_def(ty_mip_cache* in, const ty_mip_texture_def* def, double seconds)
{
    ty_mip_texture* texture = NULL;
    ty_error error = {0};
    if (ty_mip_texture_create(in, def, &texture, &error) != TY_OK ||
        ty_mip_texture_set_time(texture, seconds, &error) != TY_OK)
        fail_msg("%s", error.text);
    return texture;
}

static ty_mip_texture* open_image(const char* path, const char* space, ty_wrap wrap)
{
    ty_mip_texture_def def = ty_mip_texture_def_default();
    def.path = path;
    def.color_space = space;
    def.wrap[0] = def.wrap[1] = wrap;
    return open_def(cache, &def, 0.0);
}

static const ty_vec2 none = {0.0f, 0.0f};

static float sample(const ty_mip_texture* texture, float u, float v)
{
    return ty_mip_texture_sample(texture, (ty_vec2){u, v}, none, none).rgb.r;
}

static void assert_near(float value, float expected, float tolerance)
{
    if (!(fabsf(value - expected) <= tolerance))
        fail_msg("%.9g, expected %.9g +- %g", (double)value, (double)expected, (double)tolerance);
}

static float ramp(int x, int y, int channel)
{
    return channel == 0 ? ((float)x + 0.5f) / 256.0f : channel == 1 ? 1.0f - ((float)y + 0.5f) / 128.0f : 0.3f;
}

// A ramp stays a ramp under every footprint that stays within it, and a constant a constant. Half has 11 bits.
static void test_ramp_and_constant_at_any_footprint(void** state)
{
    (void)state;
    ty_mip_texture* texture = open_image(write_image("ramp.exr", 256, 128, 3, ramp), "raw", TY_WRAP_CLAMP);
    ty_rng rng = ty_rng_make((ty_seed){1}, 0, 0);
    for (int i = 0; i < 4000; i++)
    {
        float width = ty_exp(ty_rng_range(&rng, -7.0f, -1.6f)), turn = ty_rng_range(&rng, 0.0f, 6.0f);
        float ratio = i % 4 ? ty_exp(ty_rng_range(&rng, -4.0f, 0.0f)) : 0.0f;
        ty_vec2 uv = {ty_rng_range(&rng, 0.3f, 0.7f), ty_rng_range(&rng, 0.3f, 0.7f)};
        ty_vec2 du = {width * ty_cos(turn), width * ty_sin(turn)};
        ty_vec2 dv = {-ratio * du.y, ratio * du.x};
        ty_texel texel = ty_mip_texture_sample(texture, uv, du, dv);
        assert_near(texel.rgb.r, uv.x, 5e-4f);
        assert_near(texel.rgb.g, uv.y, 5e-4f);
        assert_near(texel.rgb.b, 0.3f, 1.5e-4f);
        assert_true(texel.alpha == 1.0f);
    }
    ty_mip_texture_destroy(texture);
    ty_mip_texture_destroy(NULL);
}

static float checker(int x, int y, int channel)
{
    (void)channel;
    return (float)((x + y) & 1);
}

// Footprints over many squares give their mean, however they lie; none gives the square itself.
static void test_checker_is_averaged(void** state)
{
    (void)state;
    ty_mip_texture* texture = open_image(write_image("checker.exr", 192, 192, 1, checker), "raw", TY_WRAP_REPEAT);
    ty_rng rng = ty_rng_make((ty_seed){2}, 0, 0);
    for (int i = 0; i < 1000; i++)
    {
        ty_vec2 uv = {ty_rng_range(&rng, -3.0f, 3.0f), ty_rng_range(&rng, -3.0f, 3.0f)};
        float width = ty_rng_range(&rng, 4.0f, 40.0f) / 192.0f, turn = ty_rng_range(&rng, 0.0f, 6.0f);
        ty_vec2 du = {width * ty_cos(turn), width * ty_sin(turn)};
        ty_vec2 dv = {-0.6f * du.y, 0.6f * du.x};
        assert_near(ty_mip_texture_sample(texture, uv, du, dv).rgb.g, 0.5f, 2e-3f);
    }
    assert_near(sample(texture, 10.5f / 192.0f, 20.5f / 192.0f), 1.0f, 0.0f); // row 171 from above
    assert_near(sample(texture, 11.5f / 192.0f, 20.5f / 192.0f), 0.0f, 0.0f);
    // A thin footprint along a diagonal of one colour sees more of that colour: probes lie along its axis.
    ty_vec2 diagonal = {12.0f / 192.0f, 12.0f / 192.0f};
    ty_vec2 at = {80.5f / 192.0f, 80.5f / 192.0f};
    float along = ty_mip_texture_sample(texture, at, diagonal, none).rgb.r;
    assert_near(along, 2.0f / 3.0f, 0.03f); // the mean of a bilinear checker along its diagonal
    ty_mip_texture_destroy(texture);
}

static float stripes(int x, int y, int channel)
{
    return (float)((channel ? y : x) & 1);
}

// A footprint along a stripe sees that stripe alone, one across them their mean, whichever of du and dv is the longer.
static void test_footprints_have_a_direction(void** state)
{
    (void)state;
    ty_mip_texture* texture = open_image(write_image("stripes.exr", 64, 64, 3, stripes), "raw", TY_WRAP_REPEAT);
    const ty_vec2 at = {20.5f / 64.0f, 31.5f / 64.0f}, u = {12.0f / 64.0f, 0.0f}, v = {0.0f, 12.0f / 64.0f};
    for (int swap = 0; swap < 2; swap++)
    {
        ty_rgb along_u = ty_mip_texture_sample(texture, at, swap ? none : u, swap ? u : none).rgb;
        ty_rgb along_v = ty_mip_texture_sample(texture, at, swap ? none : v, swap ? v : none).rgb;
        assert_near(along_u.r, 0.5f, 1e-2f);
        assert_near(along_u.g, 0.0f, 1e-3f);
        assert_near(along_v.r, 0.0f, 1e-3f);
        assert_near(along_v.g, 0.5f, 1e-2f);
    }
    ty_mip_texture_destroy(texture);
}

// Odd sides lose no texel: the mean of the whole image is what its last reduction holds.
static float bumpy(int x, int y, int channel)
{
    (void)channel;
    return (float)((x * 7 + y * 13) % 11);
}

static void test_last_level_is_the_mean(void** state)
{
    (void)state;
    static const int sizes[][2] = {{7, 5}, {1, 9}, {64, 64}, {65, 3}, {130, 77}, {1, 1}};
    for (int s = 0; s < 6; s++)
    {
        int width = sizes[s][0], height = sizes[s][1];
        double mean = 0.0;
        for (int i = 0; i < width * height; i++)
            mean += (double)bumpy(i % width, i / width, 0) / (width * height);
        ty_mip_texture* texture = open_image(write_image("odd.exr", width, height, 1, bumpy), "raw", TY_WRAP_REPEAT);
        const ty_vec2 du = {8.0f, 0.0f}, dv = {0.0f, 8.0f};
        assert_near(ty_mip_texture_sample(texture, (ty_vec2){0.2f, 0.4f}, du, dv).rgb.b, (float)mean, 4e-3f);
        ty_mip_texture_destroy(texture);
    }
}

static float index_of(int x, int y, int channel)
{
    (void)channel;
    return (float)(x + 1 + 100 * y);
}

// 130 texels a row: tiles end within the image, and every neighbour is looked up across their borders.
static void test_texels_and_wraps(void** state)
{
    (void)state;
    const int n = 130;
    const char* path = write_image("index.exr", n, 3, 1, index_of);
    for (int wrap = TY_WRAP_REPEAT; wrap <= TY_WRAP_MIRROR; wrap++)
    {
        ty_mip_texture* texture = open_image(path, "raw", (ty_wrap)wrap);
        for (int i = -2 * n; i < 3 * n; i++)
        {
            int repeat = ((i % n) + n) % n, mirror = ((i % (2 * n)) + 2 * n) % (2 * n),
                clamp = i < 0    ? 0
                        : i >= n ? n - 1
                                 : i;
            mirror = mirror >= n ? 2 * n - 1 - mirror : mirror;
            int x = wrap == TY_WRAP_REPEAT ? repeat : wrap == TY_WRAP_MIRROR ? mirror : clamp;
            assert_near(sample(texture, ((float)i + 0.5f) / (float)n, 0.5f), (float)(x + 101), 2e-2f);
        }
        assert_near(sample(texture, 64.0f / (float)n, 5.0f / 6.0f), 64.5f, 1e-2f); // between two tiles, top row
        static const float odd[] = {NAN, INFINITY, -INFINITY, 1e9f, -1e9f, 1e30f};
        for (int i = 0; i < 6; i++)
        {
            assert_true(isfinite(sample(texture, odd[i], odd[5 - i])));
            ty_vec2 d = {odd[i], odd[5 - i]};
            assert_true(isfinite(ty_mip_texture_sample(texture, (ty_vec2){0.5f, 0.5f}, d, d).rgb.r));
        }
        ty_mip_texture_destroy(texture);
    }
}

// Both axes go on by themselves.
static void test_wraps_of_each_axis(void** state)
{
    (void)state;
    char path[TY_PATH_MAX];
    snprintf(path, sizeof path, "%s", write_image("index.exr", 5, 3, 1, index_of));
    for (int pair = 0; pair < 9; pair++)
    {
        ty_mip_texture_def def = ty_mip_texture_def_default();
        def.path = path;
        def.color_space = "raw";
        def.wrap[0] = (ty_wrap)(pair % 3);
        def.wrap[1] = (ty_wrap)(pair / 3);
        ty_mip_texture *both = open_def(cache, &def, 0.0), *u = open_image(path, "raw", def.wrap[0]),
                       *v = open_image(path, "raw", def.wrap[1]);
        for (float at = -2.1f; at < 3.0f; at += 0.13f)
        {
            assert_near(sample(both, at, 0.4f), sample(u, at, 0.4f), 0.0f);
            assert_near(sample(both, 0.4f, at), sample(v, 0.4f, at), 0.0f);
        }
        ty_mip_texture_destroy(both);
        ty_mip_texture_destroy(u);
        ty_mip_texture_destroy(v);
    }
}

static float four(int x, int y, int channel)
{
    (void)x, (void)y;
    static const float values[4] = {1.0f, 0.0f, 0.0f, 0.25f};
    return values[channel];
}

static void test_spaces_and_channels(void** state)
{
    (void)state;
    ty_mip_texture* texture = open_image(write_image("rgba.exr", 2, 2, 4, four), NULL, TY_WRAP_REPEAT);
    ty_texel texel = ty_mip_texture_sample(texture, (ty_vec2){0.5f, 0.5f}, none, none);
    assert_near(texel.rgb.r, 0.6130974f, 4e-4f); // linear Rec.709 where nobody says
    assert_near(texel.rgb.g, 0.0701937f, 1e-4f);
    assert_near(texel.alpha, 0.25f, 0.0f); // is no colour
    ty_mip_texture_destroy(texture);
    texture = open_image(write_image("rgba.exr", 2, 2, 4, four), "raw", TY_WRAP_REPEAT);
    assert_near(sample(texture, 0.5f, 0.5f), 1.0f, 0.0f);
    ty_mip_texture* other = open_image(in_folder("rgba.exr"), "ACES2065-1", TY_WRAP_REPEAT); // the same file, otherwise
    assert_true(sample(other, 0.5f, 0.5f) > 1.2f);
    ty_mip_texture_destroy(other);
    ty_mip_texture_destroy(texture);
    texture = open_image(write_image("grey.exr", 2, 2, 1, four), NULL, TY_WRAP_REPEAT);
    texel = ty_mip_texture_sample(texture, (ty_vec2){0.5f, 0.5f}, none, none);
    assert_near(texel.rgb.g, 1.0f, 1e-3f);
    assert_near(texel.rgb.b, 1.0f, 1e-3f);
    ty_mip_texture_destroy(texture);
}

static float level_value;

static float constant(int x, int y, int channel)
{
    (void)x, (void)y, (void)channel;
    return level_value;
}

// Frame k has the value 8 k.
static void write_frames(int first, int last)
{
    for (int i = first; i <= last; i++)
    {
        char name[32];
        snprintf(name, sizeof name, "f.%04d.exr", i);
        level_value = 8.0f * (float)i;
        write_image(name, 4, 4, 1, constant);
    }
}

static ty_mip_texture_def sequence_def(const char* pattern)
{
    ty_mip_texture_def def = ty_mip_texture_def_default();
    def.path = pattern;
    def.color_space = "raw";
    return def;
}

static float shown_at(ty_mip_texture* texture, double seconds)
{
    ty_error error = {0};
    if (ty_mip_texture_set_time(texture, seconds, &error) != TY_OK)
        return -1.0f;
    return sample(texture, 0.4f, 0.7f) / 8.0f;
}

static void test_sequences_end_as_told(void** state)
{
    (void)state;
    char pattern[TY_PATH_MAX];
    snprintf(pattern, sizeof pattern, "%s", in_folder("f.####.exr"));
    write_frames(5, 8);
    //                         -5 -4 -3 -2 -1  0  1  2  3  4  5  6  7  8   frames after the first
    static const int expected[4][14] = {
        [TY_SEQUENCE_STOP] = {-1, -1, -1, -1, -1, 5, 6, 7, 8, -1, -1, -1, -1, -1},
        [TY_SEQUENCE_HOLD] = {5, 5, 5, 5, 5, 5, 6, 7, 8, 8, 8, 8, 8, 8},
        [TY_SEQUENCE_LOOP] = {8, 5, 6, 7, 8, 5, 6, 7, 8, 5, 6, 7, 8, 5},
        [TY_SEQUENCE_MIRROR] = {6, 7, 8, 7, 6, 5, 6, 7, 8, 7, 6, 5, 6, 7},
    };
    for (int end = 0; end < 4; end++)
    {
        ty_mip_texture_def def = sequence_def(pattern);
        def.end = end;
        def.fps = 24.0f;
        def.start = 2.0f;
        ty_mip_texture* texture = open_def(cache, &def, 2.0);
        for (int i = 0; i < 14; i++) // at the frame's time as a quotient, and late in the frame
        {
            assert_near(shown_at(texture, 2.0 + (i - 5) / 24.0), (float)expected[end][i], 1e-5f);
            assert_near(shown_at(texture, 2.0 + (i - 5 + 0.99) / 24.0), (float)expected[end][i], 1e-5f);
        }
        ty_mip_texture_destroy(texture);
    }
}

static void test_frames_are_blended(void** state)
{
    (void)state;
    char pattern[TY_PATH_MAX];
    snprintf(pattern, sizeof pattern, "%s", in_folder("f.####.exr"));
    write_frames(0, 3);
    ty_mip_texture_def def = sequence_def(pattern);
    def.blend = true;
    def.end = TY_SEQUENCE_LOOP;
    def.fps = 1.0f;
    ty_mip_texture* texture = open_def(cache, &def, 0.0);
    assert_near(shown_at(texture, 1.5), 1.5f, 0.0f); // halfway is the mean
    assert_near(shown_at(texture, 1.25), 1.25f, 1e-6f);
    assert_near(shown_at(texture, 3.5), 1.5f, 0.0f); // between the last and the first
    assert_near(shown_at(texture, 7.0), 3.0f, 0.0f);
    ty_mip_texture_destroy(texture);
    def.end = TY_SEQUENCE_STOP;
    texture = open_def(cache, &def, 3.5);
    assert_near(shown_at(texture, 3.5), 3.0f, 0.0f); // the last frame stands for its time
    assert_near(shown_at(texture, 4.0), -1.0f, 0.0f);
    ty_mip_texture_destroy(texture);
    def.end = TY_SEQUENCE_MIRROR;
    texture = open_def(cache, &def, 0.0);
    assert_near(shown_at(texture, 3.5), 2.5f, 0.0f);
    assert_near(shown_at(texture, 5.5), 0.5f, 0.0f);
    ty_mip_texture_destroy(texture);
    def.first = 1;
    def.last = 2;
    def.end = TY_SEQUENCE_LOOP;
    texture = open_def(cache, &def, 0.0);
    assert_near(shown_at(texture, 2.0), 1.0f, 0.0f); // a part of what is there
    ty_mip_texture_destroy(texture);
}

static void assert_refused(const ty_mip_texture_def* def, const char* reason)
{
    ty_mip_texture* texture = NULL;
    ty_error error = {0};
    ty_status status = ty_mip_texture_create(cache, def, &texture, &error);
    if (status == TY_OK)
        status = ty_mip_texture_verify(texture, &error);
    ty_mip_texture_destroy(texture);
    assert_int_equal(status, TY_BAD_FILE);
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
}

static void test_bad_sequences(void** state)
{
    (void)state;
    char pattern[TY_PATH_MAX];
    snprintf(pattern, sizeof pattern, "%s", in_folder("f.####.exr"));
    ty_mip_texture_def def = sequence_def(pattern);
    assert_refused(&def, "without frames");
    write_frames(1, 6);
    unlink(in_folder("f.0002.exr"));
    unlink(in_folder("f.0004.exr"));
    unlink(in_folder("f.0005.exr"));
    assert_refused(&def, "frames 2, 4-5 missing of 1-6");
    def.first = 1;
    def.last = 8;
    assert_refused(&def, "frames 2, 4-5, 7-8 missing of 1-8");
    write_frames(2, 5);
    write_image("f.0004.exr", 4, 5, 1, constant);
    def.last = 6;
    assert_refused(&def, "a frame of 4 x 5 in a sequence of 4 x 4");
    ty_mip_texture* texture = open_def(cache, &def, 2.0 / 24.0);
    ty_error error;
    assert_int_equal(ty_mip_texture_set_time(texture, 3.0 / 24.0, &error), TY_BAD_FILE);
    assert_non_null(strstr(error.file, "f.0004.exr"));
    assert_near(sample(texture, 0.5f, 0.5f), 24.0f, 0.0f); // as before
    assert_int_equal(ty_mip_texture_set_time(texture, 6.0 / 24.0, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "outside"));
    ty_mip_texture_destroy(texture);
    assert_int_equal(ty_file_write(in_folder("f.0004.exr"), "no image", 8, NULL), TY_OK);
    assert_refused(&def, "not an image");
}

static ty_mip_cache_stats stats_of(const ty_mip_cache* of)
{
    ty_mip_cache_stats stats;
    ty_mip_cache_get_stats(of, &stats);
    return stats;
}

static void test_files_are_converted_once(void** state)
{
    (void)state;
    char folder[TY_PATH_MAX], path[TY_PATH_MAX];
    snprintf(folder, sizeof folder, "%s", in_folder("kept"));
    snprintf(path, sizeof path, "%s", write_image("once.exr", 8, 8, 1, index_of));
    ty_mip_texture_def def = sequence_def(path);
    for (int run = 0; run < 3; run++)
    {
        if (run == 2) // the same name, another content
            write_image("once.exr", 8, 8, 1, checker);
        ty_mip_cache* kept = make_cache(folder, TY_MIP_CACHE_BYTES);
        ty_mip_texture *first = open_def(kept, &def, 0.0), *second = open_def(kept, &def, 0.0);
        assert_int_equal(stats_of(kept).files_converted, run != 1);
        assert_int_equal(stats_of(kept).files_found, run == 1);
        assert_near(sample(first, 1.0f / 16.0f, 1.0f / 16.0f), run == 2 ? 1.0f : 701.0f, 0.5f);
        uint64_t read = stats_of(kept).tiles_read;
        assert_int_equal(ty_mip_texture_set_time(first, 5.0, NULL), TY_OK);
        (void)sample(second, 0.5f, 0.5f);
        assert_int_equal(stats_of(kept).tiles_read, read); // nothing is read again
        ty_mip_texture_destroy(first);
        ty_mip_texture_destroy(second);
        ty_mip_cache_destroy(kept);
    }
}

static void damage(const char* folder)
{
    char command[TY_PATH_MAX + 64];
    snprintf(command, sizeof command, "for f in %s/*.exr; do head -c 300 $f > $f.x; mv $f.x $f; done", folder);
    assert_int_equal(system(command), 0);
}

static void test_damaged_and_missing_folders(void** state)
{
    (void)state;
    char folder[TY_PATH_MAX];
    snprintf(folder, sizeof folder, "%s", in_folder("kept"));
    ty_mip_texture_def def = sequence_def(write_image("once.exr", 8, 8, 1, index_of));
    for (int run = 0; run < 3; run++)
    {
        if (run == 1)
            damage(folder);
        ty_mip_cache* made = make_cache(run == 2 ? NULL : folder, TY_MIP_CACHE_BYTES);
        ty_mip_texture* texture = open_def(made, &def, 0.0);
        assert_int_equal(stats_of(made).files_converted, 1);
        assert_near(sample(texture, 1.0f / 16.0f, 1.0f / 16.0f), 701.0f, 0.5f);
        assert_int_equal(ty_mip_cache_check(made, NULL), TY_OK);
        ty_mip_texture_destroy(texture);
        ty_mip_cache_destroy(made);
    }
}

static void run_in(const char* folder, const char* command)
{
    char text[TY_PATH_MAX + 128];
    snprintf(text, sizeof text, "cd %s && for f in *.exr; do %s; done", folder, command);
    assert_int_equal(system(text), 0);
}

// What lies behind the header is found damaged before a lookup meets it, and the file is as good as new afterwards.
static void test_damaged_tiles_are_made_again(void** state)
{
    (void)state;
    static const char* const damages[] = {
        "true",
        "truncate -s 5000 $f",
        "true",
        "truncate -s -1 $f",
        "printf x | dd of=$f bs=1 seek=$(($(stat -c %s $f) / 2)) conv=notrunc status=none",
        "printf x >>$f",
        "truncate -s 0 $f",
        "head -c 64 /dev/zero >>$f",
        "true",
    };
    char folder[TY_PATH_MAX];
    snprintf(folder, sizeof folder, "%s", in_folder("kept"));
    ty_mip_texture_def def = sequence_def(write_image("once.exr", 512, 512, 1, bumpy));
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++)
    {
        mkdir(folder, 0777);
        if (i > 0)
            run_in(folder, damages[i]);
        bool damaged = i == 0 || strcmp(damages[i], "true") != 0;
        ty_mip_cache* made = make_cache(folder, TY_MIP_CACHE_BYTES);
        ty_mip_texture* texture = open_def(made, &def, 0.0);
        assert_int_equal(stats_of(made).files_converted, damaged);
        assert_int_equal(stats_of(made).files_found, !damaged);
        assert_near(sample(texture, 460.5f / 512.0f, 1.0f - 460.5f / 512.0f), bumpy(460, 460, 0), 0.0f);
        assert_int_equal(ty_mip_cache_check(made, NULL), TY_OK);
        ty_mip_texture_destroy(texture);
        ty_mip_cache_destroy(made);
    }
}

// Cut off behind its header while it is open: found only when a tile is looked up, which is then black and counted.
static void test_unreadable_tiles_are_told(void** state)
{
    (void)state;
    char folder[TY_PATH_MAX], command[TY_PATH_MAX + 64];
    snprintf(folder, sizeof folder, "%s", in_folder("kept"));
    ty_mip_cache* made = make_cache(folder, TY_MIP_CACHE_BYTES);
    ty_mip_texture_def def = sequence_def(write_image("once.exr", 512, 512, 1, bumpy));
    ty_mip_texture* texture = open_def(made, &def, 0.0);
    snprintf(command, sizeof command, "for f in %s/*.exr; do truncate -s 5000 $f; done", folder);
    assert_int_equal(system(command), 0);
    assert_near(sample(texture, 0.9f, 0.1f), 0.0f, 0.0f);
    ty_error error = {0};
    assert_int_equal(ty_mip_cache_check(made, &error), TY_BAD_FILE);
    assert_non_null(strstr(error.text, "cannot be read"));
    ty_mip_texture_destroy(texture);
    ty_mip_cache_destroy(made);
}

typedef struct lookups
{
    const ty_mip_texture* texture;
    ty_texel* results;
} lookups;

static void look_up(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    lookups* l = context;
    for (int64_t i = begin; i < end; i++)
    {
        ty_rng rng = ty_rng_make((ty_seed){4}, (uint64_t)i, 0);
        ty_vec2 uv = {ty_rng_float(&rng), ty_rng_float(&rng)};
        float width = ty_exp(ty_rng_range(&rng, -9.0f, -2.0f)), turn = ty_rng_range(&rng, 0.0f, 6.0f);
        ty_vec2 du = {width * ty_cos(turn), width * ty_sin(turn)};
        float ratio = ty_rng_float(&rng);
        l->results[i] = ty_mip_texture_sample(l->texture, uv, du, (ty_vec2){-ratio * du.y, ratio * du.x});
    }
}

// The least memory holds a fifth of the texture. Not a bit depends on that, or on who looks up what.
static void test_same_bits_for_any_threads_and_memory(void** state)
{
    (void)state;
    enum
    {
        COUNT = 20000
    };
    ty_mip_texture_def def = sequence_def(write_image("large.exr", 2048, 2048, 4, bumpy));
    char folder[TY_PATH_MAX];
    snprintf(folder, sizeof folder, "%s", in_folder("kept"));
    lookups l = {.results = TY_ALLOC(ty_texel, COUNT)};
    ty_texel* first = TY_ALLOC(ty_texel, COUNT);
    for (int run = 0; run < 4; run++)
    {
        ty_mip_cache* made = make_cache(folder, run % 2 ? (uint64_t)16 << 20 : TY_MIP_CACHE_BYTES);
        ty_mip_texture* texture = open_def(made, &def, 0.0);
        ty_workers* workers = NULL;
        assert_int_equal(ty_workers_create(run / 2 ? 3 : 1, &workers, NULL), TY_OK);
        l.texture = texture;
        assert_true(ty_parallel_for(workers, COUNT, 64, look_up, &l));
        ty_workers_destroy(workers);
        if (run == 0)
            memcpy(first, l.results, COUNT * sizeof(ty_texel));
        assert_memory_equal(first, l.results, COUNT * sizeof(ty_texel));
        ty_mip_cache_stats stats = stats_of(made);
        if (run % 2)
        {
            assert_true(stats.tiles_read > 3 * 1024); // came and went
            assert_true(stats.bytes_now < (uint64_t)17 << 20);
        }
        ty_mip_texture_destroy(texture);
        ty_mip_cache_destroy(made);
    }
    ty_free(first);
    ty_free(l.results);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_ramp_and_constant_at_any_footprint),
        TEST(test_checker_is_averaged),
        TEST(test_footprints_have_a_direction),
        TEST(test_last_level_is_the_mean),
        TEST(test_texels_and_wraps),
        TEST(test_wraps_of_each_axis),
        TEST(test_spaces_and_channels),
        TEST(test_sequences_end_as_told),
        TEST(test_frames_are_blended),
        TEST(test_bad_sequences),
        TEST(test_files_are_converted_once),
        TEST(test_damaged_and_missing_folders),
        TEST(test_damaged_tiles_are_made_again),
        TEST(test_unreadable_tiles_are_told),
        TEST(test_same_bits_for_any_threads_and_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
