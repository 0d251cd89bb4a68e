// SPDX-License-Identifier: Apache-2.0
// Image files of every kind come in with their numbers; PNG, JPEG and TIFF go out and come back.
#include "base/cmocka_all.h"
#include "image_folder.h"
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/half.h>
#include <tsuya/image/image.h>

static ty_image read_ok(const char* path)
{
    ty_image image;
    ty_error error = {0};
    if (ty_image_read(path, &image, &error) != TY_OK)
        fail_msg("%s: %s", path, error.text);
    return image;
}

static void write_ok(const char* path, const ty_image* image, int bits)
{
    ty_error error = {0};
    if (ty_image_write(path, image, bits, &error) != TY_OK)
        fail_msg("%s: %s", path, error.text);
}

static void assert_refused(const char* path, const char* reason)
{
    ty_image image;
    ty_error error = {0};
    if (ty_image_read(path, &image, &error) != TY_BAD_FILE)
        fail_msg("%s: not refused (%s)", path, reason);
    assert_null(image.pixels);
    assert_string_equal(error.file, path);
    if (!strstr(error.text, reason))
        fail_msg("%s: '%s' does not say '%s'", path, error.text, reason);
}

static int thread_count(void)
{
    int count = 0;
    DIR* folder = opendir("/proc/self/task");
    for (struct dirent* entry; folder && (entry = readdir(folder));)
        count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

static void test_every_kind_of_exr_is_read(void** state)
{
    (void)state;
    ty_image first = read_ok(fixture("light.hdr"));
    ty_image_term(&first);
    usleep(1000000);              // its pool ends, see below
    int threads = thread_count(); // libraries behind OpenImageIO have some of their own once it is loaded
    static const struct
    {
        const char* name;
        float tolerance;
    } files[] = {{"tiled.exr", 0},    {"multipart.exr", 0}, {"dwaa.exr", 0.02f},
                 {"dwab.exr", 0.02f}, {"zips.exr", 0},      {"piz.exr", 0}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    {
        ty_image image = read_ok(fixture(files[i].name));
        assert_int_equal(image.width, 24);
        assert_int_equal(image.channels, 4);
        assert_true(image.is_float);
        for (int y = 0; y < image.height; y++)
            for (int x = 0; x < 24; x++)
            {
                const float* pixel = image.pixels + (y * 24 + x) * 4;
                float red = ((float)x + 0.5f * (float)y) / 16.0f;
                assert_true(fabsf(pixel[0] - red) <= files[i].tolerance);
                float blue = ty_half_to_float(ty_half_from_float(3.0f * red));
                assert_true(fabsf(pixel[2] - blue) <= files[i].tolerance * 3.0f);
                assert_true(pixel[3] == 1.0f);
            }
        ty_image_term(&image);
    }
    // OpenImageIO starts its pool before it can be told not to; those threads end when they come to look.
    for (int i = 0; i < 300 && thread_count() > threads; i++)
        usleep(10000);
    assert_true(thread_count() <= threads);
}

static void test_hdr_is_read(void** state)
{
    (void)state;
    ty_image image = read_ok(fixture("light.hdr"));
    assert_int_equal(image.width, 24);
    assert_int_equal(image.height, 20);
    assert_int_equal(image.channels, 3);
    assert_true(image.is_float);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 24; x++) // a shared exponent: errors relative to blue, the largest
        {
            float red = ((float)x + 0.5f * (float)y) / 16.0f;
            assert_true(fabsf(image.pixels[(y * 24 + x) * 3] - red) <= 3.0f * red / 128.0f);
        }
    ty_image_term(&image);
}

static void test_the_file_says_its_space(void** state)
{
    (void)state;
    ty_image image = read_ok(fixture("zips.exr"));
    assert_string_equal(image.color_space, "ACEScg"); // by its chromaticities
    ty_image_term(&image);
}

// Every level of the channel, alpha unlike 1.
static ty_image level_image(int channels, int bits)
{
    int side = bits == 16 ? 256 : 16;
    ty_image image = {.width = side, .height = side, .channels = channels};
    image.pixels = TY_ALLOC(float, side* side* channels);
    int count = side * side;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < channels; c++)
            image.pixels[i * channels + c] = (float)((i * (c + 1)) % count) / (float)(count - 1);
    return image;
}

static void test_png_and_tiff_keep_every_level(void** state)
{
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8)
        for (int channels = 1; channels <= 4; channels += channels == 1 ? 2 : 1)
            for (int tiff = 0; tiff < 2; tiff++)
            {
                const char* path = in_folder(tiff ? "a.tif" : "a.png");
                ty_image image = level_image(channels, bits);
                write_ok(path, &image, bits);
                ty_image back = read_ok(path);
                assert_int_equal(back.width, image.width);
                assert_int_equal(back.height, image.height);
                assert_int_equal(back.channels, channels);
                assert_false(back.is_float);
                double scale = bits == 16 ? 65535.0 : 255.0;
                for (int i = 0; i < image.width * image.height * channels; i++)
                    assert_int_equal(lround(back.pixels[i] * scale), lround(image.pixels[i] * scale));
                ty_image_term(&back);
                ty_image_term(&image);
            }
}

static void test_values_clamp_and_round(void** state)
{
    (void)state;
    float values[6] = {-1.0f, 2.0f, NAN, 90.6f / 255.0f, 90.4f / 255.0f, INFINITY};
    ty_image image = {.width = 6, .height = 1, .channels = 1, .pixels = values};
    write_ok(in_folder("a.png"), &image, 8);
    ty_image back = read_ok(in_folder("a.png"));
    static const int expected[6] = {0, 255, 0, 91, 90, 255};
    for (int i = 0; i < 6; i++)
        assert_int_equal(lround(back.pixels[i] * 255.0), expected[i]);
    ty_image_term(&back);
}

static void test_equal_images_give_equal_bytes(void** state)
{
    (void)state;
    static const char* const names[] = {"a.png", "a.jpg", "a.tiff"};
    ty_bytes first[3];
    ty_image image = level_image(3, 8);
    strcpy(image.color_space, "sRGB");
    for (int round = 0; round < 2; round++)
    {
        for (int i = 0; i < 3; i++)
        {
            ty_bytes bytes;
            write_ok(in_folder(names[i]), &image, 8);
            assert_int_equal(ty_file_read(in_folder(names[i]), 1 << 20, &bytes, NULL), TY_OK);
            if (round == 0)
                first[i] = bytes;
            else
            {
                assert_int_equal(bytes.size, first[i].size);
                assert_memory_equal(bytes.data, first[i].data, bytes.size);
                ty_bytes_term(&bytes);
                ty_bytes_term(&first[i]);
            }
        }
        usleep(round ? 0 : 1100000); // a time stamp would show
    }
    assert_int_equal(folder_count(0), 3);
    ty_image_term(&image);
}

static void test_jpeg_comes_back_near(void** state)
{
    (void)state;
    ty_image image = {.width = 32, .height = 32, .channels = 3, .pixels = TY_ALLOC(float, 32 * 32 * 3)};
    for (int i = 0; i < 32 * 32 * 3; i++)
        image.pixels[i] = (float)(i / 96) / 40.0f + 0.1f;
    write_ok(in_folder("a.jpg"), &image, 8);
    ty_image back = read_ok(in_folder("a.jpg"));
    assert_int_equal(back.channels, 3);
    for (int i = 0; i < 32 * 32 * 3; i++)
        assert_true(fabsf(back.pixels[i] - image.pixels[i]) < 0.02f);
    ty_image_term(&back);
    ty_image_term(&image);
}

static void test_truncated_files_are_refused(void** state)
{
    (void)state;
    static const char* const names[] = {"a.png", "a.jpg", "a.tif"};
    ty_image image = level_image(3, 16);
    for (int i = 0; i < 3; i++)
    {
        ty_bytes bytes;
        write_ok(in_folder(names[i]), &image, 8);
        assert_int_equal(ty_file_read(in_folder(names[i]), 1 << 24, &bytes, NULL), TY_OK);
        for (size_t part = 1; part < 8; part++)
        {
            assert_int_equal(ty_file_write(in_folder(names[i]), bytes.data, bytes.size * part / 8, NULL), TY_OK);
            assert_refused(in_folder(names[i]), i == 0 ? "PNG file ends" : "cannot read image: ");
        }
        ty_bytes_term(&bytes);
    }
    ty_image_term(&image);
    static const char* const fixtures[] = {"tiled.exr", "dwaa.exr", "multipart.exr", "light.hdr"};
    for (int i = 0; i < 4; i++)
    {
        ty_bytes bytes;
        assert_int_equal(ty_file_read(fixture(fixtures[i]), 1 << 24, &bytes, NULL), TY_OK);
        for (size_t part = 0; part < 16; part++)
        {
            if (i == 2 && part > 7)
                break; // the first part is whole
            assert_int_equal(ty_file_write(in_folder(fixtures[i]), bytes.data, bytes.size * part / 16, NULL), TY_OK);
            assert_refused(in_folder(fixtures[i]), "");
        }
        ty_bytes_term(&bytes);
    }
}

static void test_a_damaged_png_is_refused(void** state)
{
    (void)state;
    ty_image image = level_image(3, 8);
    ty_bytes bytes;
    write_ok(in_folder("a.png"), &image, 8);
    assert_int_equal(ty_file_read(in_folder("a.png"), 1 << 24, &bytes, NULL), TY_OK);
    for (size_t at = 8; at < bytes.size; at += 7)
    {
        bytes.data[at] ^= 0x10;
        assert_int_equal(ty_file_write(in_folder("a.png"), bytes.data, bytes.size, NULL), TY_OK);
        assert_refused(in_folder("a.png"), "PNG");
        bytes.data[at] ^= 0x10;
    }
    ty_bytes_term(&bytes);
    ty_image_term(&image);
}

static void test_what_is_no_image_is_refused(void** state)
{
    (void)state;
    assert_refused(in_folder("missing.png"), "No such file");
    assert_refused(test_folder, "");
    assert_int_equal(ty_file_write(in_folder("a.png"), "", 0, NULL), TY_OK);
    assert_refused(in_folder("a.png"), "empty");
    assert_int_equal(ty_file_write(in_folder("a.png"), "hello, world; hello", 19, NULL), TY_OK);
    assert_refused(in_folder("a.png"), "known format");
    // A play list: some readers would open what it names.
    assert_int_equal(ty_file_write(in_folder("a.png"), "#EXTM3U\n/etc/passwd\n", 20, NULL), TY_OK);
    assert_refused(in_folder("a.png"), "known format");
}

// A PNG header of 30000 x 30000 RGB pixels (2.7 GB) in 70 bytes.
static void test_false_claims_are_refused_at_once(void** state)
{
    (void)state;
    static const uint8_t png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,    0, 0,    13,
                                  'I',  'H', 'D', 'R', 0,    0,    0x75, 0x30, 0,    0, 0x75, 0x30,
                                  8,    2,   0,   0,   0,    0x94, 0x4c, 0x66, 0x9d, 0, 0,    0,
                                  0,    'I', 'E', 'N', 'D',  0xae, 0x42, 0x60, 0x82};
    assert_int_equal(ty_file_write(in_folder("a.png"), png, sizeof png, NULL), TY_OK);
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    assert_refused(in_folder("a.png"), "");
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 10000);
    static const char header[] = "P6\n20000 20000\n255\nabc";
    assert_int_equal(ty_file_write(in_folder("a.ppm"), header, sizeof header, NULL), TY_OK);
    assert_refused(in_folder("a.ppm"), "claims 20000 x 20000");
    static const char wide[] = "P6\n40000 2\n255\nabc";
    assert_int_equal(ty_file_write(in_folder("a.ppm"), wide, sizeof wide, NULL), TY_OK);
    assert_refused(in_folder("a.ppm"), "32768");
}

static void test_bad_outputs_are_refused(void** state)
{
    (void)state;
    ty_error error = {0};
    ty_image image = level_image(4, 8);
    assert_int_equal(ty_image_write(in_folder("a.gif"), &image, 8, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "png"));
    assert_int_equal(ty_image_write(in_folder("a.jpg"), &image, 16, &error), TY_BAD_INPUT);
    assert_int_equal(ty_image_write(in_folder("a.png"), &image, 12, &error), TY_BAD_INPUT);
    image.channels = 2;
    assert_int_equal(ty_image_write(in_folder("a.png"), &image, 8, &error), TY_BAD_INPUT);
    image.channels = 4;
    assert_int_equal(ty_image_write(in_folder("no/a.png"), &image, 8, &error), TY_BAD_FILE);
    assert_int_equal(folder_count(0), 0);
    ty_image_term(&image);
}

// A limit on the size of files stands for the full disk.
static void test_a_full_disk_leaves_the_old_file(void** state)
{
    (void)state;
    static const char* const names[] = {"a.png", "a.jpg", "a.tif"};
    ty_image small = level_image(3, 8), large = level_image(3, 16);
    uint32_t random = 1;
    for (int i = 0; i < 256 * 256 * 3; i++) // noise, which no format makes small
        large.pixels[i] = (float)((random = random * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
    struct rlimit saved, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &saved), 0);
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (int i = 0; i < 3; i++)
    {
        ty_bytes old, now;
        write_ok(in_folder(names[i]), &small, 8);
        assert_int_equal(ty_file_read(in_folder(names[i]), 1 << 20, &old, NULL), TY_OK);
        for (rlim_t size = 0; size < 20000; size += 5000)
        {
            limit = (struct rlimit){size, saved.rlim_max};
            setrlimit(RLIMIT_FSIZE, &limit);
            ty_error error = {0};
            ty_status status = ty_image_write(in_folder(names[i]), &large, 8, &error);
            setrlimit(RLIMIT_FSIZE, &saved);
            if (status != TY_BAD_FILE)
                fail_msg("%s at %d bytes: status %d", names[i], (int)size, (int)status);
            assert_non_null(strstr(error.text, "cannot write"));
        }
        assert_int_equal(ty_file_read(in_folder(names[i]), 1 << 20, &now, NULL), TY_OK);
        assert_int_equal(now.size, old.size);
        assert_memory_equal(now.data, old.data, old.size);
        ty_bytes_term(&old);
        ty_bytes_term(&now);
    }
    signal(SIGXFSZ, handler);
    assert_int_equal(folder_count(0), 3);
    ty_image_term(&small);
    ty_image_term(&large);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, folder_setup, folder_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_every_kind_of_exr_is_read),
        TEST(test_hdr_is_read),
        TEST(test_the_file_says_its_space),
        TEST(test_png_and_tiff_keep_every_level),
        TEST(test_values_clamp_and_round),
        TEST(test_equal_images_give_equal_bytes),
        TEST(test_jpeg_comes_back_near),
        TEST(test_truncated_files_are_refused),
        TEST(test_a_damaged_png_is_refused),
        TEST(test_what_is_no_image_is_refused),
        TEST(test_false_claims_are_refused_at_once),
        TEST(test_bad_outputs_are_refused),
        TEST(test_a_full_disk_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
