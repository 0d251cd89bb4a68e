// SPDX-License-Identifier: Apache-2.0
// The film: exact under any grouping and order, and its parts merge into the one run's bytes.
#include "renderer_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <unistd.h>

enum
{
    SAMPLES = 200
};

static ty_film_sample random_sample(ty_rng* rng)
{
    float size = ty_rng_float(rng) < 0.1f ? 120000.0f : 1.0f; // wide enough to fill every word of the sums
    ty_film_sample s = {.radiance = {size * ty_rng_float(rng), size * ty_rng_float(rng), size * ty_rng_float(rng)}};
    float share = ty_rng_float(rng); // the third group stays dark
    s.group[0] = ty_rgb_scale(s.radiance, share);
    s.group[1] = ty_rgb_scale(s.radiance, 1.0f - share);
    s.hit = s.covered = ty_rng_float(rng) < 0.8f;
    if (s.hit)
    {
        s.albedo = (ty_rgb){ty_rng_float(rng), ty_rng_float(rng), ty_rng_float(rng)};
        s.normal = ty_normalize((ty_vec3){ty_rng_range(rng, -1, 1), ty_rng_range(rng, -1, 1), 0.3f});
        s.position = (ty_vec3){ty_rng_float(rng), ty_rng_float(rng), ty_rng_float(rng)};
        s.depth = 1.0f + ty_rng_float(rng);
        s.instance = ty_rng_u32(rng) % 1000u + 1u;
    }
    return s;
}

static ty_film_sample sample_of(int x, int y, int index)
{
    ty_rng rng = ty_rng_make((ty_seed){1}, (uint64_t)(1000 * y + x), (uint64_t)index);
    return random_sample(&rng);
}

static ty_film* film_make(int begin, int end, unsigned aovs)
{
    static const char* const groups[] = {"default", "key", "a-rather-long-name-of-40-characters-1234"};
    ty_film_setup setup = {{20, 10}, {3, 2, 17, 8}, begin, end, aovs, true, groups, 3};
    ty_film* film;
    assert_int_equal(ty_film_create(&setup, &film, NULL), TY_OK);
    return film;
}

static void film_fill(ty_film* film, int begin, int end)
{
    for (int y = 2; y <= 8; ++y)
        for (int x = 3; x <= 17; ++x)
        {
            ty_pixel_sums sums = ty_pixel_sums_make(film->group_count);
            for (int i = begin; i < end; ++i)
            {
                ty_film_sample s = sample_of(x, y, i);
                assert_int_equal(ty_pixel_sums_add(&sums, &s, (uint32_t)i), TY_SAMPLE_GOOD);
            }
            ty_film_commit(film, x, y, &sums);
        }
}

static void assert_same_sums(const ty_film* a, const ty_film* b)
{
    for (int y = 2; y <= 8; ++y)
        for (int x = 3; x <= 17; ++x)
        {
            ty_pixel_sums p = ty_film_pixel(a, x, y), q = ty_film_pixel(b, x, y);
            assert_true(p.luminance_sqr == q.luminance_sqr && p.luminance == q.luminance);
            assert_memory_equal(p.radiance, q.radiance, sizeof p.radiance);
            assert_memory_equal(p.normal, q.normal, sizeof p.normal);
            assert_memory_equal(p.albedo, q.albedo, sizeof p.albedo);
            assert_memory_equal(p.group, q.group, sizeof p.group);
            assert_true(p.samples == q.samples && p.covered == q.covered && p.first_sample == q.first_sample &&
                        p.first_instance == q.first_instance && p.first_depth == q.first_depth);
            assert_memory_equal(&p.first_position, &q.first_position, sizeof p.first_position);
        }
}

static void test_any_split_and_order_is_exact(void** state)
{
    (void)state;
    const unsigned aovs = TY_AOV_ALL | TY_AOV_LIGHT;
    ty_film *whole = film_make(0, SAMPLES, aovs), *pieces = film_make(0, SAMPLES, aovs);
    film_fill(whole, 0, SAMPLES);
    const int cuts[][2] = {{77, 200}, {0, 1}, {9, 77}, {1, 9}};
    for (int i = 0; i < 4; ++i)
        film_fill(pieces, cuts[i][0], cuts[i][1]);
    assert_same_sums(whole, pieces);
    ty_film_destroy(whole);
    ty_film_destroy(pieces);
}

static void test_means_and_variance(void** state)
{
    (void)state;
    ty_film* film = film_make(0, SAMPLES, TY_AOV_ALL);
    film_fill(film, 0, SAMPLES);
    double sum = 0.0, luminance = 0.0, square = 0.0, normal = 0.0;
    int covered = 0, first = -1;
    for (int i = 0; i < SAMPLES; ++i)
    {
        ty_film_sample s = sample_of(5, 5, i);
        double y = (double)ty_luminance(s.radiance);
        sum += (double)s.radiance.g;
        normal += (double)s.normal.x;
        luminance += y;
        square += y * y;
        covered += s.covered;
        if (s.hit && first < 0)
            first = i;
    }
    ty_pixel_sums p = ty_film_pixel(film, 5, 5);
    assert_int_equal(p.samples, SAMPLES);
    assert_int_equal(p.covered, covered);
    assert_true(fabs((double)ty_fixed_mean(p.radiance[1], SAMPLES) / (sum / SAMPLES) - 1.0) < 1e-6);
    assert_true(fabs((double)ty_fixed_mean(p.normal[0], SAMPLES) - normal / SAMPLES) < 1e-6);
    double variance = (square - luminance * luminance / SAMPLES) / (SAMPLES - 1.0) / SAMPLES;
    assert_true(fabs((double)ty_film_variance(&p) / variance - 1.0) < 1e-5);
    ty_film_sample seen = sample_of(5, 5, first);
    assert_int_equal(p.first_sample, first);
    assert_int_equal(p.first_instance, seen.instance);
    assert_true(p.first_depth == seen.depth && p.first_position.y == seen.position.y);
    ty_film_destroy(film);
}

static float channel_at(const ty_exr* exr, const char* name, size_t i)
{
    const ty_exr_channel* channel = ty_exr_find_channel(exr, name);
    assert_non_null(channel);
    return ((const float*)channel->pixels)[i];
}

static ty_scene scene_make(void);

static void test_groups_add_up_to_the_beauty(void** state)
{
    (void)state;
    ty_scene scene = scene_make();
    ty_film* film = film_make(0, 64, TY_AOV_LIGHT);
    film->setup.half = false;
    film_fill(film, 0, 64);
    ty_film_write how = {.scene = &scene, .sample_end = 64};
    ty_exr* exr;
    assert_int_equal(ty_film_to_exr(film, &how, &exr, NULL), TY_OK);
    assert_int_equal(exr->channel_count, 3 + 9);
    for (size_t i = 0; i < 15 * 7; ++i)
    {
        float whole = channel_at(exr, "G", i), first = channel_at(exr, "light.default.G", i);
        float sum = first + channel_at(exr, "light.key.G", i);
        assert_true(first > 0.0f && first < whole);
        assert_true(fabsf(sum - whole) < 1e-6f * whole);
        assert_true(channel_at(exr, "light.a-rather-long-name-of-40-characters-1234.B", i) == 0.0f);
    }
    ty_exr_destroy(exr);
    ty_film_destroy(film);
}

static void test_constant_pixel_has_no_variance(void** state)
{
    (void)state;
    ty_pixel_sums sums = ty_pixel_sums_make(0);
    ty_film_sample s = {.radiance = {0.1f, 0.7f, 1234.567f}};
    for (uint32_t i = 0; i < 1000; ++i)
        assert_int_equal(ty_pixel_sums_add(&sums, &s, i), TY_SAMPLE_GOOD);
    assert_true(ty_film_variance(&sums) == 0.0f);
    assert_true(fabsf(ty_fixed_mean(sums.radiance[2], 1000) - 1234.567f) < 1e-3f);
}

static void test_bad_samples_are_counted_as_black(void** state)
{
    (void)state;
    ty_pixel_sums sums = ty_pixel_sums_make(0);
    ty_film_sample good = {.radiance = {1.0f, 1.0f, 1.0f}, .hit = true, .covered = true, .depth = 2.0f};
    ty_film_sample bad = good;
    bad.radiance.g = NAN;
    assert_int_equal(ty_pixel_sums_add(&sums, &bad, 0), TY_SAMPLE_DROPPED);
    bad.radiance.g = INFINITY;
    assert_int_equal(ty_pixel_sums_add(&sums, &bad, 1), TY_SAMPLE_DROPPED);
    bad = good;
    bad.normal.z = NAN;
    assert_int_equal(ty_pixel_sums_add(&sums, &bad, 2), TY_SAMPLE_DROPPED);
    assert_int_equal(ty_pixel_sums_add(&sums, &good, 3), TY_SAMPLE_GOOD);
    assert_int_equal(sums.samples, 4);
    assert_int_equal(sums.first_sample, 3);
    assert_true(ty_fixed_mean(sums.radiance[1], sums.samples) == 0.25f);
}

static void test_saturation_fits_the_longest_run(void** state)
{
    (void)state;
    ty_pixel_sums sums = ty_pixel_sums_make(0);
    ty_film_sample s = {.radiance = {1e9f, -1e9f, 131071.0f}};
    for (uint32_t i = 0; i < TY_SAMPLER_MAX_SAMPLES; ++i)
        if (ty_pixel_sums_add(&sums, &s, i) != TY_SAMPLE_SATURATED)
            fail();
    assert_true(fabsf(ty_fixed_mean(sums.radiance[0], sums.samples) - 131072.0f) < 0.1f);
    assert_true(fabsf(ty_fixed_mean(sums.radiance[1], sums.samples) + 131072.0f) < 0.1f);
    assert_true(ty_fixed_mean(sums.radiance[2], sums.samples) == 131071.0f);
    assert_true(ty_film_variance(&sums) == 0.0f);
    // The widest spread: half at each end. Variance of the mean = limit^2 n / (n - 1) / n.
    sums = ty_pixel_sums_make(0);
    for (uint32_t i = 0; i < TY_SAMPLER_MAX_SAMPLES; ++i)
    {
        float v = i & 1u ? 1e9f : -1e9f;
        ty_film_sample wide = {.radiance = {v, v, v}};
        (void)!ty_pixel_sums_add(&sums, &wide, i);
    }
    assert_true(fabs((double)ty_film_variance(&sums) * 65535.0 / (131072.0 * 131072.0) - 1.0) < 1e-5);
}

static void test_setup_is_checked(void** state)
{
    (void)state;
    ty_film* film;
    ty_error error;
    ty_film_setup good = {.size = {20, 10}, .crop = {0, 0, 19, 9}, .sample_end = 16, .aovs = TY_AOV_ALL}, bad = good;
    bad.aovs |= TY_AOV_LIGHT; // without a name
    assert_int_equal(ty_film_create(&bad, &film, &error), TY_USAGE);
    bad = good;
    bad.crop[2] = 20;
    assert_int_equal(ty_film_create(&bad, &film, &error), TY_USAGE);
    assert_null(film);
    bad = good;
    bad.sample_end = TY_SAMPLER_MAX_SAMPLES + 1;
    assert_int_equal(ty_film_create(&bad, &film, &error), TY_USAGE);
    bad = good;
    bad.sample_end = 0;
    assert_int_equal(ty_film_create(&bad, &film, &error), TY_USAGE);
    for (long call = 0; call < 5; ++call)
    {
        ty_memory_fail_after(call);
        assert_int_equal(ty_film_create(&good, &film, &error), TY_NO_MEMORY);
        assert_null(film);
    }
    ty_memory_fail_after(-1);
    assert_int_equal(ty_film_create(&good, &film, &error), TY_OK);
    ty_film_destroy(film);
}

// --- files ---

static ty_scene scene_make(void)
{
    ty_scene scene = {.recipe = "tsuya: 1\ncamera: {}\n", .overrides = ""};
    scene.camera = (ty_camera_def){.position = {0, 0, 1}, .up = {0, 1, 0}, .vfov = 1.0f, .film_height = 0.024f};
    scene.render.seed.value = 12345678901234567890ull;
    scene.render.samples = SAMPLES;
    strcpy(scene.hash, "0123456789abcdef0123456789abcdef");
    return scene;
}

typedef struct place
{
    char folder[64];
} place;

static int place_make(void** state)
{
    static place here;
    strcpy(here.folder, "/tmp/tsuya_film_XXXXXX");
    *state = &here;
    return mkdtemp(here.folder) ? 0 : -1;
}

static int place_remove(void** state)
{
    const place* here = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", here->folder);
    return system(command);
}

static const char* path_of(void** state, const char* name)
{
    static char paths[8][128];
    static int next;
    char* path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", ((const place*)*state)->folder, name);
    return path;
}

static void write_film(const ty_film* film, const ty_scene* scene, int begin, int end, bool part, const char* path)
{
    ty_film_write how = {scene, begin, end, part, false};
    ty_exr* exr;
    ty_error error;
    assert_int_equal(ty_film_to_exr(film, &how, &exr, &error), TY_OK);
    if (ty_exr_write(path, exr, &error))
        fail_msg("%s", error.text);
    ty_exr_destroy(exr);
}

static void write_range(const ty_scene* scene, int begin, int end, unsigned aovs, bool part, const char* path)
{
    ty_film* film = film_make(begin, end, aovs);
    film_fill(film, begin, end);
    write_film(film, scene, begin, end, part, path);
    ty_film_destroy(film);
}

static void assert_same_files(const char* a, const char* b)
{
    ty_bytes x, y;
    assert_int_equal(ty_file_read(a, 1 << 26, &x, NULL), TY_OK);
    assert_int_equal(ty_file_read(b, 1 << 26, &y, NULL), TY_OK);
    assert_int_equal(x.size, y.size);
    assert_memory_equal(x.data, y.data, x.size);
    ty_bytes_term(&x);
    ty_bytes_term(&y);
}

static void test_merge_gives_the_same_bytes(void** state)
{
    ty_scene scene = scene_make();
    const unsigned choices[] = {TY_AOV_ALL, TY_AOV_ALL | TY_AOV_LIGHT, TY_AOV_LIGHT,
                                0,          TY_AOV_Z | TY_AOV_ALPHA,   TY_AOV_INSTANCE | TY_AOV_VARIANCE};
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; ++i)
    {
        const char *whole = path_of(state, "whole.exr"), *merged = path_of(state, "merged.exr");
        const char* parts[3] = {path_of(state, "c.exr"), path_of(state, "a.exr"), path_of(state, "b.exr")};
        write_range(&scene, 0, SAMPLES, choices[i], false, whole);
        write_range(&scene, 100, SAMPLES, choices[i], true, parts[0]);
        write_range(&scene, 0, 32, choices[i], true, parts[1]);
        write_range(&scene, 32, 100, choices[i], true, parts[2]);
        ty_error error = {0};
        if (ty_film_merge(parts, 3, merged, &error))
            fail_msg("%s", error.text);
        assert_same_files(whole, merged);
    }
}

// Less than the scene asks for, and not from its beginning: the joined file is a part itself, and joins again.
static void test_merge_of_some_parts_is_a_part(void** state)
{
    ty_scene scene = scene_make();
    const char *a = path_of(state, "a.exr"), *b = path_of(state, "b.exr"), *c = path_of(state, "c.exr");
    const char *bc = path_of(state, "bc.exr"), *joined = path_of(state, "joined.exr"), *whole = path_of(state, "w.exr");
    write_range(&scene, 0, 32, TY_AOV_ALL, true, a);
    write_range(&scene, 32, 100, TY_AOV_ALL, true, b);
    write_range(&scene, 100, SAMPLES, TY_AOV_ALL, true, c);
    write_range(&scene, 32, SAMPLES, TY_AOV_ALL, true, bc);
    assert_int_equal(ty_film_merge((const char*[]){c, b}, 2, joined, NULL), TY_OK);
    assert_same_files(bc, joined);
    write_range(&scene, 0, SAMPLES, TY_AOV_ALL, false, whole);
    assert_int_equal(ty_film_merge((const char*[]){joined, a}, 2, c, NULL), TY_OK);
    assert_same_files(whole, c);
}

static void assert_merge_fails(const char* const* parts, int count, void** state, const char* expected)
{
    ty_error error = {0};
    const char* output = path_of(state, "refused.exr");
    assert_int_equal(ty_film_merge(parts, count, output, &error), TY_BAD_FILE);
    if (!strstr(error.text, expected))
        fail_msg("message \"%s\" does not say \"%s\"", error.text, expected);
    assert_false(ty_file_exists(output));
}

static void test_merge_refuses_what_does_not_fit(void** state)
{
    ty_scene scene = scene_make(), other = scene_make();
    other.hash[0] = 'f';
    const char *a = path_of(state, "a.exr"), *b = path_of(state, "b.exr"), *c = path_of(state, "c.exr");
    write_range(&scene, 0, 16, TY_AOV_ALL, true, a);
    write_range(&scene, 32, 48, TY_AOV_ALL, true, b);
    assert_merge_fails((const char*[]){b, a}, 2, state, "samples 16-31 are missing");
    write_range(&scene, 8, 24, TY_AOV_ALL, true, c);
    assert_merge_fails((const char*[]){a, c}, 2, state, "samples 8-15");
    write_range(&other, 16, 32, TY_AOV_ALL, true, c);
    assert_merge_fails((const char*[]){a, c}, 2, state, "tsuya/hash");
    write_range(&scene, 16, 32, TY_AOV_Z, true, c);
    assert_merge_fails((const char*[]){a, c}, 2, state, "channels");
    write_range(&scene, 16, 32, TY_AOV_ALL, false, c);
    assert_merge_fails((const char*[]){a, c}, 2, state, "not a part");
}

// One thing wrong in a part at a time.
static void test_merge_refuses_damaged_parts(void** state)
{
    const char* expected[] = {"part.R.1 is missing",   "channels differ", "holds 17 samples", "range is damaged",
                              "worldToNDC is missing", "not a part",      "display window"};
    ty_scene scene = scene_make();
    for (int kind = 0; kind < 7; ++kind)
    {
        const char *path = path_of(state, "damaged.exr"), *good = path_of(state, "good.exr");
        ty_film* film = film_make(0, 16, TY_AOV_ALL);
        film_fill(film, 0, 16);
        ty_film_write how = {&scene, 0, 16, true, false};
        ty_exr* exr;
        assert_int_equal(ty_film_to_exr(film, &how, &exr, NULL), TY_OK);
        for (int i = 0; i < exr->channel_count; ++i)
        {
            ty_exr_channel* c = &exr->channels[i];
            if ((kind == 0 && !strcmp(c->name, "part.R.1")) || (kind == 1 && !strcmp(c->name, "Z")))
                strcpy(c->name, kind ? "Zback" : "part.R.7");
            if (kind == 2 && !strcmp(c->name, "part.samples.0"))
                ((uint32_t*)c->pixels)[40] = 17;
        }
        for (int i = 0; i < exr->attribute_count; ++i)
        {
            ty_exr_attribute* a = &exr->attributes[i];
            if (kind == 3 && !strcmp(a->name, "tsuya/samples"))
                memcpy(a->text, "9-0 ", 4);
            if ((kind == 4 && !strcmp(a->name, "worldToNDC")) || (kind == 5 && !strcmp(a->name, "tsuya/part")))
                a->name[0] = 'x';
        }
        if (kind == 6)
            exr->display_window[0] = -1;
        assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
        // A part without Z counts as one that was not asked for Z: its channels differ from the good part's.
        write_range(&scene, 16, 32, TY_AOV_ALL, true, good);
        ty_error error = {0};
        const char* parts[] = {path, good};
        assert_int_equal(ty_film_merge(parts, 2, path_of(state, "out.exr"), &error), TY_BAD_FILE);
        if (!strstr(error.text, expected[kind]))
            fail_msg("message \"%s\" does not say \"%s\"", error.text, expected[kind]);
        ty_exr_destroy(exr);
        ty_film_destroy(film);
    }
}

static void test_attributes_and_channels(void** state)
{
    ty_scene scene = scene_make();
    const char* path = path_of(state, "all.exr");
    write_range(&scene, 0, 64, TY_AOV_ALL, false, path);
    ty_exr* exr;
    assert_int_equal(ty_exr_read(path, &exr, NULL), TY_OK);
    const char* names[] = {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "P.X", "albedo.B", "variance.Y"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i)
        assert_non_null(ty_exr_find_channel(exr, names[i]));
    assert_int_equal(ty_exr_find_channel(exr, "instance")->type, TY_EXR_UINT);
    assert_int_equal(ty_exr_find_channel(exr, "Z")->type, TY_EXR_FLOAT);
    assert_int_equal(ty_exr_find_channel(exr, "R")->type, TY_EXR_HALF);
    assert_int_equal(exr->channel_count, 16);
    assert_int_equal(exr->data_window[0], 3);
    assert_int_equal(exr->display_window[2], 19);
    assert_string_equal(ty_exr_find_attribute(exr, "tsuya/samples")->text, "0-63");
    assert_string_equal(ty_exr_find_attribute(exr, "tsuya/seed")->text, "12345678901234567890");
    assert_string_equal(ty_exr_find_attribute(exr, "tsuya/recipe")->text, scene.recipe);
    assert_true(ty_exr_find_attribute(exr, "chromaticities")->value[2] == 0.165f);
    assert_int_equal(ty_exr_find_attribute(exr, "worldToNDC")->type, TY_EXR_MATRIX44);
    assert_null(ty_exr_find_attribute(exr, "tsuya/partial"));
    ty_exr_destroy(exr);
}

// Stopped inside a pass: pixels average over their own counts, and the picture says so.
static void test_partial_film(void** state)
{
    (void)state;
    ty_scene scene = scene_make();
    ty_film* film = film_make(0, 64, 0);
    film_fill(film, 0, 16);
    ty_pixel_sums more = ty_pixel_sums_make(0);
    ty_film_sample black = {0};
    for (uint32_t i = 16; i < 32; ++i)
        (void)!ty_pixel_sums_add(&more, &black, i);
    float before = ty_fixed_mean(ty_film_pixel(film, 4, 4).radiance[0], 16);
    ty_film_commit(film, 4, 4, &more);
    ty_film_write how = {&scene, 0, 16, true, true};
    ty_exr* exr;
    assert_int_equal(ty_film_to_exr(film, &how, &exr, NULL), TY_OK);
    assert_int_equal(ty_exr_find_attribute(exr, "tsuya/partial")->integer[0], 1);
    assert_null(ty_exr_find_attribute(exr, "tsuya/part")); // its counts differ: it could not be merged
    const uint32_t* samples = ty_exr_find_channel(exr, "samples")->pixels;
    const float* red = ty_exr_find_channel(exr, "R")->pixels;
    assert_int_equal(samples[0], 16);
    assert_int_equal(samples[ty_film_index(film, 4, 4)], 32);
    assert_true(fabsf(red[ty_film_index(film, 4, 4)] - 0.5f * before) < 1e-5f * before);
    ty_exr_destroy(exr);
    ty_film_destroy(film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_split_and_order_is_exact),
        cmocka_unit_test(test_means_and_variance),
        cmocka_unit_test(test_groups_add_up_to_the_beauty),
        cmocka_unit_test(test_constant_pixel_has_no_variance),
        cmocka_unit_test(test_bad_samples_are_counted_as_black),
        cmocka_unit_test(test_saturation_fits_the_longest_run),
        cmocka_unit_test(test_setup_is_checked),
        cmocka_unit_test_setup_teardown(test_merge_gives_the_same_bytes, place_make, place_remove),
        cmocka_unit_test_setup_teardown(test_merge_of_some_parts_is_a_part, place_make, place_remove),
        cmocka_unit_test_setup_teardown(test_merge_refuses_what_does_not_fit, place_make, place_remove),
        cmocka_unit_test_setup_teardown(test_merge_refuses_damaged_parts, place_make, place_remove),
        cmocka_unit_test_setup_teardown(test_attributes_and_channels, place_make, place_remove),
        cmocka_unit_test_setup_teardown(test_partial_film, place_make, place_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
