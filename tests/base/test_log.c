// SPDX-License-Identifier: Apache-2.0
// Messages and progress as they arrive on standard error, through a pipe and on a terminal.
#include "cmocka_all.h"
#include "process.h"
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <tsuya/base/log.h>
#include <tsuya/base/workers.h>

static void log_all_levels(void* context)
{
    if (context)
        ty_log_set_level(*(ty_log_level*)context);
    ty_log(TY_LOG_ERROR, "an error of %d", 5);
    ty_log(TY_LOG_WARNING, "a warning");
    ty_log(TY_LOG_INFO, "a line");
    ty_log(TY_LOG_DEBUG, "a detail");
}

static void test_levels(void** state)
{
    (void)state;
    assert_string_equal(process_run(log_all_levels, NULL).text,
                        "tsuya: error: an error of 5\ntsuya: warning: a warning\ntsuya: a line\n");
    ty_log_level level = TY_LOG_DEBUG;
    assert_non_null(strstr(process_run(log_all_levels, &level).text, "tsuya: debug: a detail\n"));
    level = TY_LOG_ERROR;
    assert_string_equal(process_run(log_all_levels, &level).text, "tsuya: error: an error of 5\n");
    assert_int_equal(ty_log_get_level(), TY_LOG_INFO);
}

static void log_hostile(void* context)
{
    (void)context;
    ty_log(TY_LOG_INFO, "%s", "\033[31mred\rname\x7f 艶");
    ty_error error;
    ty_error_set_at(&error, TY_BAD_INPUT, "s.yaml", 4, 2, "unknown key 'colour'");
    ty_log_error(&error);
    char large[10000];
    memset(large, 'x', sizeof(large) - 1);
    large[sizeof(large) - 1] = 0;
    ty_log(TY_LOG_INFO, "%s", large);
}

static void test_text_cannot_command_the_terminal(void** state)
{
    (void)state;
    process_end end = process_run(log_hostile, NULL);
    assert_non_null(strstr(end.text, "tsuya: ?[31mred?name? 艶\n"));
    assert_non_null(strstr(end.text, "tsuya: error: s.yaml:4:2: unknown key 'colour'\n"));
    size_t length = strlen(end.text);
    assert_true(length < sizeof(end.text) - 1); // cut
    assert_int_equal(end.text[length - 1], '\n');
}

static void log_many(void* context, int64_t begin, int64_t end, int worker)
{
    (void)context, (void)worker;
    for (int64_t i = begin; i < end; i++)
        ty_log(TY_LOG_INFO, "%02lld-%02lld-%02lld-%02lld", (long long)i, (long long)i, (long long)i, (long long)i);
}

static void log_from_threads(void* context)
{
    (void)context;
    ty_workers* workers;
    if (ty_workers_create(4, &workers, NULL))
        _exit(1);
    ty_parallel_for(workers, 99, 1, log_many, NULL);
    ty_workers_destroy(workers);
}

static void test_lines_do_not_mix(void** state)
{
    (void)state;
    process_end end = process_run(log_from_threads, NULL);
    int lines = 0, seen[99] = {0};
    for (char* line = strtok(end.text, "\n"); line; line = strtok(NULL, "\n"), lines++)
    {
        int a, b, c, d;
        assert_int_equal(sscanf(line, "tsuya: %d-%d-%d-%d", &a, &b, &c, &d), 4);
        assert_true(a == b && b == c && c == d && a >= 0 && a < 99);
        seen[a]++;
    }
    assert_int_equal(lines, 99);
    for (int i = 0; i < 99; i++)
        assert_int_equal(seen[i], 1);
}

static void run_progress(void* context)
{
    if (context)
        ty_progress_set_style(*(ty_progress_style*)context);
    ty_progress progress;
    ty_progress_begin(&progress, "pack");
    for (int i = 0; i <= 10000; i++)
        ty_progress_update(&progress, i / 10000.0, "3 Mray/s");
    ty_progress_end(&progress);
}

static int count_of(const char* text, const char* part)
{
    int count = 0;
    for (const char* at = text; (at = strstr(at, part)); at += strlen(part))
        count++;
    return count;
}

static void test_progress_lines(void** state)
{
    (void)state;
    process_end end = process_run(run_progress, NULL); // a pipe: lines
    assert_int_equal(count_of(end.text, "\n"), 20);
    assert_int_equal(count_of(end.text, "3 Mray/s"), 19);
    for (int percent = 5; percent < 100; percent += 5)
    {
        char line[32];
        snprintf(line, sizeof(line), "tsuya: pack %d %% ", percent);
        assert_int_equal(count_of(end.text, line), 1);
    }
    assert_int_equal(count_of(end.text, "tsuya: pack 100 % in 0:0"), 1);
    ty_progress_style style = TY_PROGRESS_NONE;
    assert_string_equal(process_run(run_progress, &style).text, "");
}

static void progress_backwards(void* context)
{
    (void)context;
    ty_progress progress;
    ty_progress_begin(&progress, "odd");
    const double fractions[] = {0.5, 0.2, -1.0, 0.0 / 0.0, 0.52, 7.0};
    for (int i = 0; i < 6; i++)
        ty_progress_update(&progress, fractions[i], NULL);
    ty_progress_end(&progress);
}

static void test_progress_takes_any_number(void** state)
{
    (void)state;
    process_end end = process_run(progress_backwards, NULL);
    assert_int_equal(count_of(end.text, "\n"), 2);
    assert_int_equal(count_of(end.text, "odd 50 %"), 1);
    assert_int_equal(count_of(end.text, "odd 100 % in"), 1);
}

static void run_bar(void* context)
{
    (void)context;
    ty_progress_style style = TY_PROGRESS_BAR;
    ty_progress_set_style(style);
    ty_progress progress;
    ty_progress_begin(&progress, "trace");
    const struct timespec pause = {0, 120000000};
    ty_progress_update(&progress, 0.25, "a detail that is far too long for a line of eighty columns, whatever it says");
    for (int i = 0; i < 1000; i++)
        ty_progress_update(&progress, 0.26, NULL); // within a tenth of a second: not drawn
    ty_log(TY_LOG_INFO, "in between");
    nanosleep(&pause, NULL);
    ty_progress_update(&progress, 0.5, "fine");
    ty_progress_end(&progress);
}

static void test_progress_bar(void** state)
{
    (void)state;
    process_end end = process_run(run_bar, NULL);
    assert_int_equal(count_of(end.text, "trace ["), 2);
    assert_non_null(strstr(end.text, "[######..................]  25 %"));
    assert_non_null(strstr(end.text, "[############............]  50 %"));
    assert_non_null(strstr(end.text, "\r\033[Ktsuya: in between\n")); // the bar makes way
    assert_non_null(strstr(end.text, "\r\033[Ktsuya: trace 50 % in 0:00\n"));
    const char* bar = strstr(end.text, "trace [");
    assert_true(strcspn(bar, "\r") <= 79);
}

// The same program on a terminal of its own.
static void on_terminal(void (*fn)(void* context), char text[4096])
{
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0)
        skip(); // a container without pseudo terminals
    assert_true(grantpt(master) == 0 && unlockpt(master) == 0);
    pid_t pid = fork();
    if (pid == 0)
    {
        int terminal = open(ptsname(master), O_RDWR | O_NOCTTY);
        struct winsize window = {.ws_row = 24, .ws_col = 60};
        ioctl(terminal, TIOCSWINSZ, &window);
        dup2(terminal, STDERR_FILENO);
        fn(NULL);
        _exit(0);
    }
    size_t size = 0;
    ssize_t count;
    while (size < 4095)
    {
        if ((count = read(master, text + size, 4095 - size)) > 0)
            size += (size_t)count;
        else if (waitpid(pid, NULL, WNOHANG) != 0)
            break;
    }
    text[size] = 0;
    close(master);
}

static void log_and_progress(void* context)
{
    (void)context;
    setenv("TERM", "xterm", 1);
    unsetenv("NO_COLOR");
    log_all_levels(NULL);
    run_progress(NULL);
}

static void log_without_color(void* context)
{
    setenv("NO_COLOR", "1", 1);
    log_all_levels(context);
}

static void test_terminal(void** state)
{
    (void)state;
    char text[4096];
    on_terminal(log_and_progress, text);
    assert_non_null(strstr(text, "tsuya: \033[1;31merror: \033[0man error of 5"));
    assert_non_null(strstr(text, "pack [")); // a bar by itself
    assert_null(strstr(text, "tsuya: pack 5 %"));
    assert_true(strcspn(strstr(text, "pack ["), "\r") <= 59);
    on_terminal(log_without_color, text);
    assert_non_null(strstr(text, "tsuya: error: an error of 5"));
    assert_null(strchr(text, '\033'));
}

static void test_clock_and_memory(void** state)
{
    (void)state;
    const struct timespec pause = {0, 20000000};
    double before = ty_time_now();
    nanosleep(&pause, NULL);
    double taken = ty_time_now() - before;
    assert_true(taken >= 0.0199 && taken < 2.0);
    uint64_t peak = ty_memory_peak();
    assert_true(peak > 500000 && peak < (uint64_t)1 << 42);
    volatile char* bytes = malloc(50000000);
    for (size_t i = 0; i < 50000000; i += 1024)
        bytes[i] = 1;
    assert_true(ty_memory_peak() >= peak + 40000000);
    free((char*)bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_levels),
        cmocka_unit_test(test_text_cannot_command_the_terminal),
        cmocka_unit_test(test_lines_do_not_mix),
        cmocka_unit_test(test_progress_lines),
        cmocka_unit_test(test_progress_takes_any_number),
        cmocka_unit_test(test_progress_bar),
        cmocka_unit_test(test_terminal),
        cmocka_unit_test(test_clock_and_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
