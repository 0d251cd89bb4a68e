// SPDX-License-Identifier: Apache-2.0
// EXR files that are no good are refused with a reason; outputs are complete or absent.
#include "base/alloc_sweep.h"
#include "base/cmocka_all.h"
#include "base/process.h"
#include "image_folder.h"
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/image/exr.h>

static ty_exr* noise_image(int width, int height)
{
    const int window[4] = {0, 0, width - 1, height - 1};
    ty_exr* exr = ty_exr_create(window, window);
    float* r = ty_exr_add_channel(exr, "R", TY_EXR_HALF);
    uint32_t* id = ty_exr_add_channel(exr, "id", TY_EXR_UINT);
    uint32_t random = 3;
    for (int i = 0; i < width * height; i++)
    {
        random = random * 1664525u + 1013904223u;
        id[i] = random >> 20;
        r[i] = (float)(random >> 24);
    }
    ty_exr_add_string(exr, "tsuya/recipe", "a: 1");
    return exr;
}

// The bytes of a sound file.
static ty_bytes sound_bytes(void)
{
    ty_exr* exr = noise_image(20, 35);
    ty_bytes bytes;
    assert_int_equal(ty_exr_write(in_folder("sound.exr"), exr, NULL), TY_OK);
    assert_int_equal(ty_file_read(in_folder("sound.exr"), 1 << 20, &bytes, NULL), TY_OK);
    ty_exr_destroy(exr);
    return bytes;
}

static void refused(const void* bytes, size_t size, const char* reason)
{
    ty_exr* exr = (ty_exr*)&exr;
    ty_error error = {0};
    assert_int_equal(ty_exr_read_memory("bad.exr", bytes, size, &exr, &error), TY_BAD_FILE);
    assert_null(exr);
    assert_string_equal(error.file, "bad.exr");
    assert_true(error.text[0]);
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
}

static uint8_t* find(ty_bytes bytes, const char* text)
{
    return memmem(bytes.data, bytes.size, text, strlen(text) + 1);
}

static void test_what_is_no_exr_is_refused(void** state)
{
    (void)state;
    refused("", 0, "empty");
    refused("abc", 3, "not an EXR");
    refused("\x89PNG\r\n\x1a\n0000", 12, "not an EXR");
    refused("\x76\x2f\x31\x01\x07\0\0\0\0\0", 10, "version");
    refused("\x76\x2f\x31\x01\x02\0\0\0\0\0", 10, "no channels");
    ty_exr* exr = NULL;
    ty_error error = {0};
    assert_int_equal(ty_exr_read(in_folder("missing.exr"), &exr, &error), TY_BAD_FILE);
    assert_null(exr);
}

static void test_every_truncation_is_refused(void** state)
{
    (void)state;
    ty_bytes bytes = sound_bytes();
    for (size_t size = 0; size < bytes.size; size++)
    {
        uint8_t* copy = TY_ALLOC(uint8_t, size); // of its own, so that a sanitizer sees a read past the end
        memcpy(copy, bytes.data, size);
        refused(copy, size, "");
        ty_free(copy);
    }
    ty_bytes_term(&bytes);
}

// A flipped bit may stay unseen, but nothing half comes back and nothing falls over.
static void test_flipped_bits_do_no_harm(void** state)
{
    (void)state;
    ty_bytes bytes = sound_bytes();
    int refusals = 0;
    for (size_t i = 0; i < bytes.size * 8; i++)
    {
        bytes.data[i / 8] ^= (uint8_t)(1u << i % 8);
        ty_exr* exr = NULL;
        ty_error error = {0};
        ty_status status = ty_exr_read_memory("flip.exr", bytes.data, bytes.size, &exr, &error);
        assert_true(status == TY_OK ? exr && exr->channel_count > 0 : !exr && error.text[0]);
        refusals += status != TY_OK;
        ty_exr_destroy(exr);
        bytes.data[i / 8] ^= (uint8_t)(1u << i % 8);
    }
    assert_true(refusals > 1000);
    ty_bytes_term(&bytes);
}

static void set_int(uint8_t* at, int value)
{
    memcpy(at, &value, sizeof value);
}

static void test_false_claims_are_refused_at_once(void** state)
{
    (void)state;
    ty_bytes bytes = sound_bytes();
    uint8_t* window = find(bytes, "dataWindow") + sizeof "dataWindow" + sizeof "box2i" + 4;
    set_int(window + 8, 32767); // 32768 x 16384 x 6 bytes, 3.2 GB
    set_int(window + 12, 16383);
    refused(bytes.data, bytes.size, "header claims 32768 x 16384 pixels");
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    refused(bytes.data, bytes.size, "can hold");
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 10000);
    set_int(window + 8, 1 << 20);
    refused(bytes.data, bytes.size, "at most 65536");
    set_int(window + 8, 2147483647);
    refused(bytes.data, bytes.size, "out of range");
    set_int(window + 8, -1);
    refused(bytes.data, bytes.size, "is empty");
    set_int(window - 4, 1 << 30);
    refused(bytes.data, bytes.size, "claims 1073741824 bytes");
    ty_bytes_term(&bytes);
}

static void test_kinds_for_the_other_door_are_named(void** state)
{
    (void)state;
    static const char* const files[][2] = {
        {"tiled.exr", "tiled"}, {"multipart.exr", "multi-part"}, {"dwaa.exr", "DWA"}, {"dwab.exr", "DWA"}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    {
        ty_exr* exr = NULL;
        ty_error error = {0};
        assert_int_equal(ty_exr_read(fixture(files[i][0]), &exr, &error), TY_BAD_FILE);
        assert_null(exr);
        assert_non_null(strstr(error.text, files[i][1]));
        assert_non_null(strstr(error.text, "readable as a texture"));
    }
    ty_bytes bytes = sound_bytes();
    set_int(find(bytes, "R") + 2 + 8, 2);
    refused(bytes.data, bytes.size, "subsampled");
    bytes.data[5] |= 8;
    refused(bytes.data, bytes.size, "deep");
    ty_bytes_term(&bytes);
}

static void test_bad_images_are_not_written(void** state)
{
    (void)state;
    const int window[4] = {0, 0, 1, 1};
    ty_error error = {0};
    ty_exr* exr = ty_exr_create(window, window);
    assert_int_equal(ty_exr_write(in_folder("a.exr"), exr, &error), TY_BAD_INPUT);
    ty_exr_add_channel(exr, "R", TY_EXR_HALF);
    exr->display_window[2] = -1;
    assert_int_equal(ty_exr_write(in_folder("a.exr"), exr, &error), TY_BAD_INPUT);
    exr->display_window[2] = 1;
    ty_exr_add_string(exr, "compression", "none");
    assert_int_equal(ty_exr_write(in_folder("a.exr"), exr, &error), TY_BAD_INPUT);
    assert_non_null(strstr(error.text, "compression"));
    ty_exr_destroy(exr);
    assert_int_equal(folder_count(0), 0);
}

static void assert_unwritable(const char* path, const char* reason)
{
    ty_exr* exr = noise_image(200, 300);
    ty_error error = {0};
    assert_int_equal(ty_exr_write(path, exr, &error), TY_BAD_FILE);
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
    ty_exr_destroy(exr);
}

// A limit on the size of files stands for the full disk: pwrite fails in the middle.
static void test_a_full_disk_leaves_the_old_file(void** state)
{
    (void)state;
    ty_bytes old = sound_bytes();
    struct rlimit saved, small = {20000, RLIM_INFINITY};
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &saved), 0);
    small.rlim_max = saved.rlim_max;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (rlim_t size = 0; size < 60000; size += size < 1000 ? 60 : 3000)
    {
        small.rlim_cur = size;
        setrlimit(RLIMIT_FSIZE, &small);
        ty_exr* exr = noise_image(200, 300);
        ty_error error = {0};
        ty_status status = ty_exr_write(in_folder("sound.exr"), exr, &error);
        setrlimit(RLIMIT_FSIZE, &saved);
        assert_int_equal(status, TY_BAD_FILE);
        assert_non_null(strstr(error.text, "cannot write: File too large"));
        ty_exr_destroy(exr);
        assert_int_equal(folder_count(0), 1);
    }
    signal(SIGXFSZ, handler);
    ty_bytes now;
    assert_int_equal(ty_file_read(in_folder("sound.exr"), 1 << 20, &now, NULL), TY_OK);
    assert_int_equal(now.size, old.size);
    assert_memory_equal(now.data, old.data, old.size);
    ty_bytes_term(&now);
    ty_bytes_term(&old);
}

static void test_unwritable_outputs_say_why(void** state)
{
    (void)state;
    assert_unwritable(in_folder("no/such/folder/a.exr"), "No such file");
    assert_unwritable(test_folder, "folder");
    assert_int_equal(mkfifo(in_folder("pipe.exr"), 0600), 0);
    assert_unwritable(in_folder("pipe.exr"), "not a regular file");
    if (geteuid() != 0) // root may write anywhere
    {
        chmod(test_folder, 0500);
        assert_unwritable(in_folder("a.exr"), "Permission");
        chmod(test_folder, 0700);
    }
    assert_int_equal(folder_count(0), 1);
}

static void read_damaged(void* context)
{
    const ty_bytes* bytes = context;
    ty_exr* exr = NULL;
    if (ty_exr_read_memory("bad.exr", bytes->data, bytes->size - 9, &exr, NULL) != TY_BAD_FILE)
        _exit(1);
}

static void test_the_library_prints_nothing(void** state)
{
    (void)state;
    ty_bytes bytes = sound_bytes();
    process_end end = process_run(read_damaged, &bytes);
    assert_int_equal(end.exit_status, 0);
    assert_string_equal(end.text, "");
    ty_bytes_term(&bytes);
}

static ty_status write_and_read(void* context)
{
    const ty_exr* exr = context;
    ty_exr* back = NULL;
    ty_status status = ty_exr_write(in_folder("a.exr"), exr, NULL);
    if (!status)
        status = ty_exr_read(in_folder("a.exr"), &back, NULL);
    ty_exr_destroy(back);
    return status;
}

static void test_every_allocation_may_fail(void** state)
{
    (void)state;
    ty_exr* exr = noise_image(20, 35);
    int count = ty_alloc_sweep(write_and_read, exr);
    assert_true(count > 20);
    ty_exr_destroy(exr);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, folder_setup, folder_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_what_is_no_exr_is_refused),
        TEST(test_every_truncation_is_refused),
        TEST(test_flipped_bits_do_no_harm),
        TEST(test_false_claims_are_refused_at_once),
        TEST(test_kinds_for_the_other_door_are_named),
        TEST(test_bad_images_are_not_written),
        TEST(test_a_full_disk_leaves_the_old_file),
        TEST(test_unwritable_outputs_say_why),
        TEST(test_the_library_prints_nothing),
        TEST(test_every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
