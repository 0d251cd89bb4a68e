// SPDX-License-Identifier: Apache-2.0
// Foreign code in a child process: its output, its errors, its crashes, its excesses.
#include "alloc_sweep.h"
#include "cmocka_all.h"
#include "process.h"
#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>

static bool memory_is_limited(void)
{
#if defined(__SANITIZE_ADDRESS__)
    return false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    return false;
#else
    return true;
#endif
#else
    return true;
#endif
}

// The n bytes that a child writes: a pattern, so that lost or doubled parts show.
static ty_status write_pattern(const void* context, int output_fd, ty_error* error)
{
    size_t size = *(const size_t*)context;
    uint8_t* bytes = ty_alloc(size, 1);
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(i * 7 + (i >> 8));
    ty_status status = ty_child_write(output_fd, bytes, size / 3, error);
    if (!status)
        status = ty_child_write(output_fd, bytes + size / 3, size - size / 3, error);
    ty_free(bytes);
    return status;
}

static void test_output_of_any_size(void** state)
{
    (void)state;
    const size_t sizes[] = {0, 1, 4096, 65535, 65536, 65537, 20000000};
    for (int k = 0; k < 7; k++)
    {
        ty_bytes output;
        ty_error error;
        if (ty_child_run(NULL, write_pattern, &sizes[k], &output, &error))
            fail_msg("%s", error.text);
        assert_int_equal(output.size, sizes[k]);
        size_t wrong = 0;
        for (size_t i = 0; i < output.size; i++)
            wrong += output.data[i] != (uint8_t)(i * 7 + (i >> 8));
        assert_int_equal(wrong, 0);
        assert_int_equal(output.data[output.size], 0); // ends with a zero
        ty_bytes_term(&output);
    }
}

static int open_descriptors(void)
{
    int count = 0;
    for (int fd = 0; fd < 256; fd++)
        count += fcntl(fd, F_GETFD) >= 0;
    return count;
}

// Runs fn with def, expects the status and a text, and that nothing is left: no bytes, no descriptor, no process.
static void assert_ends(const ty_child_def* def, ty_child_fn* fn, const void* context, ty_status expected,
                        const char* reason)
{
    int before = open_descriptors();
    ty_bytes output = {(uint8_t*)1, 1};
    ty_error error;
    memset(&error, 0, sizeof(error));
    assert_int_equal(ty_child_run(def, fn, context, &output, &error), expected);
    assert_int_equal(error.status, expected);
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
    assert_null(output.data);
    assert_int_equal(output.size, 0);
    assert_int_equal(open_descriptors(), before);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
}

static ty_status fail_with_place(const void* context, int output_fd, ty_error* error)
{
    (void)context;
    if (ty_child_write(output_fd, "partial", 7, error))
        return TY_INTERNAL;
    return ty_error_set_at(error, TY_BAD_INPUT, "mesh.obj", 12, 3, "face names vertex %d of 8", 9);
}

static void test_error_comes_back(void** state)
{
    (void)state;
    assert_ends(NULL, fail_with_place, NULL, TY_BAD_INPUT, "face names vertex 9 of 8");
    ty_bytes output;
    ty_error error;
    assert_int_equal(ty_child_run(NULL, fail_with_place, NULL, &output, &error), TY_BAD_INPUT);
    assert_string_equal(error.file, "mesh.obj");
    assert_int_equal(error.line, 12);
    assert_int_equal(error.column, 3);
}

static ty_status raise_signal(const void* context, int output_fd, ty_error* error)
{
    (void)output_fd, (void)error;
    raise(*(const int*)context);
    return TY_OK;
}

static ty_status call_exit(const void* context, int output_fd, ty_error* error)
{
    (void)output_fd, (void)error;
    _exit(*(const int*)context);
}

static void test_crash(void** state)
{
    (void)state;
    const int faults[] = {SIGSEGV, SIGABRT, SIGFPE, SIGKILL};
    for (int i = 0; i < 4; i++)
    {
        char reason[64];
        snprintf(reason, sizeof(reason), "crashed (signal %d", faults[i]);
        assert_ends(NULL, raise_signal, &faults[i], TY_BAD_FILE, reason);
    }
    int code = 0;
    assert_ends(NULL, call_exit, &code, TY_BAD_FILE, "without a result (exit status 0)");
    code = 3;
    assert_ends(NULL, call_exit, &code, TY_BAD_FILE, "exit status 3");
}

static ty_status sleep_long(const void* context, int output_fd, ty_error* error)
{
    (void)error;
    if (context) // gives up its output and lives on
        close(output_fd);
    while (pause() < 0)
        continue;
    return TY_OK;
}

static ty_status loop_forever(const void* context, int output_fd, ty_error* error)
{
    (void)context, (void)output_fd, (void)error;
    volatile bool forever = true;
    while (forever)
        continue;
    return TY_OK;
}

static void test_timeout(void** state)
{
    (void)state;
    const ty_child_def def = {.seconds = 0.3};
    double before = ty_time_now();
    assert_ends(&def, sleep_long, NULL, TY_BAD_FILE, "more than 0.3 seconds");
    assert_ends(&def, sleep_long, &def, TY_BAD_FILE, "more than 0.3 seconds");
    assert_ends(&def, loop_forever, NULL, TY_BAD_FILE, "more than 0.3 seconds");
    double taken = ty_time_now() - before;
    assert_true(taken >= 0.9 && taken < 5.0);
}

static ty_status take_memory(const void* context, int output_fd, ty_error* error)
{
    (void)context, (void)output_fd, (void)error;
    ty_free(ty_alloc((size_t)512 << 20, 1));
    return TY_OK;
}

static ty_status ask_for_memory(const void* context, int output_fd, ty_error* error)
{
    (void)context, (void)output_fd;
    void* memory = ty_try_alloc((size_t)512 << 20, 1);
    ty_free(memory);
    return memory ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "512 MB refused");
}

static void test_memory_limit(void** state)
{
    (void)state;
    if (!memory_is_limited())
        skip();
    const ty_child_def def = {.memory_bytes = (size_t)256 << 20};
    assert_ends(&def, take_memory, NULL, TY_BAD_FILE, "more than 256 MB");
    assert_ends(&def, ask_for_memory, NULL, TY_NO_MEMORY, "512 MB refused");
    const ty_child_def larger = {.memory_bytes = (size_t)1024 << 20};
    ty_bytes output;
    assert_int_equal(ty_child_run(&larger, take_memory, NULL, &output, NULL), TY_OK);
    ty_bytes_term(&output);
}

static ty_status write_forever(const void* context, int output_fd, ty_error* error)
{
    (void)context;
    static const char bytes[10000];
    for (;;)
    {
        ty_status status = ty_child_write(output_fd, bytes, sizeof(bytes), error);
        if (status)
            return status;
    }
}

static void test_too_much_output(void** state)
{
    (void)state;
    const ty_child_def def = {.max_output = 1000000};
    assert_ends(&def, write_forever, NULL, TY_BAD_FILE, "more than 1000000 bytes");
    size_t size = 1000000;
    ty_bytes output;
    assert_int_equal(ty_child_run(&def, write_pattern, &size, &output, NULL), TY_OK); // exactly the bound
    ty_bytes_term(&output);
    size++;
    assert_ends(&def, write_pattern, &size, TY_BAD_FILE, "more than 1000000 bytes");
}

static ty_status print_noise(const void* context, int output_fd, ty_error* error)
{
    (void)context;
    printf("noise of an importer\n");
    fflush(stdout);
    return ty_child_write(output_fd, "result", 6, error);
}

static void run_noise(void* context)
{
    (void)context;
    dup2(STDERR_FILENO, STDOUT_FILENO); // so that the noise would be seen
    ty_bytes output;
    ty_status status = ty_child_run(NULL, print_noise, NULL, &output, NULL);
    _exit(status == TY_OK && output.size == 6 ? 0 : 1);
}

static void test_prints_go_nowhere(void** state)
{
    (void)state;
    process_end end = process_run(run_noise, NULL);
    assert_int_equal(end.exit_status, 0);
    assert_null(strstr(end.text, "noise"));
}

static void test_cancel_ends_the_child(void** state)
{
    (void)state;
    ty_cancel_request(SIGTERM);
    assert_ends(NULL, sleep_long, NULL, TY_TERMINATED, "interrupted");
    ty_cancel_clear();
    ty_cancel_request(SIGINT);
    assert_ends(NULL, sleep_long, NULL, TY_INTERRUPTED, "interrupted");
    ty_cancel_clear();
}

static ty_status run_once(void* context)
{
    ty_bytes output;
    ty_status status = ty_child_run(NULL, write_pattern, context, &output, NULL);
    ty_bytes_term(&output);
    return status;
}

static void test_parent_without_memory(void** state)
{
    (void)state;
    size_t size = 300000;
    assert_true(ty_alloc_sweep(run_once, &size) >= 3);
}

int main(void)
{
    mallopt(M_PERTURB, 0x5a); // fresh memory is not zero by chance
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_output_of_any_size),
        cmocka_unit_test(test_error_comes_back),
        cmocka_unit_test(test_crash),
        cmocka_unit_test(test_timeout),
        cmocka_unit_test(test_memory_limit),
        cmocka_unit_test(test_too_much_output),
        cmocka_unit_test(test_prints_go_nowhere),
        cmocka_unit_test(test_cancel_ends_the_child),
        cmocka_unit_test(test_parent_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
