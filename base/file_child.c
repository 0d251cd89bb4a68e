// SPDX-License-Identifier: Apache-2.0
// A function in a child process with limits, so that a crash in foreign code is an error of the file it read.
#include "sanitize.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>
#include <unistd.h>

enum
{
    poll_slice = 50 // milliseconds between two looks at the clock and the cancel flag
};

// What the child says at its end is its ty_error, in one write.
_Static_assert(sizeof(ty_error) <= PIPE_BUF, "it fits a pipe without a reader");

typedef struct child_run
{
    ty_child_def def;
    pid_t pid;
    int output_fd, result_fd; // -1 = at its end
    double deadline;
    ty_bytes output;
    size_t capacity;
    ty_error result;
    size_t result_size;
} child_run;

ty_status ty_child_write(int output_fd, const void* bytes, size_t size, ty_error* error)
{
    if (ty_descriptor_write(output_fd, bytes, size))
        return TY_OK;
    return ty_error_set(error, TY_BAD_FILE, "cannot write to the parent process: %s", strerror(errno));
}

// --- in the child ---

static void limit_set(int resource, rlim_t value)
{
    struct rlimit limit;
    if (getrlimit(resource, &limit) != 0)
        return;
    limit.rlim_cur = limit.rlim_max == RLIM_INFINITY || value < limit.rlim_max ? value : limit.rlim_max;
    limit.rlim_max = limit.rlim_cur;
    // A limit that the system refuses leaves the clock of the parent.
    (void)setrlimit(resource, &limit);
}

// Bytes of address space in use now.
static rlim_t address_space(void)
{
    char text[64] = "";
    unsigned long long pages = 0;
    int fd = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return 0;
    ssize_t size = read(fd, text, sizeof(text) - 1);
    close(fd);
    for (ssize_t i = 0; i < size && text[i] >= '0' && text[i] <= '9'; i++)
        pages = pages * 10 + (unsigned long long)(text[i] - '0');
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void limits_apply(const ty_child_def* def)
{
    limit_set(RLIMIT_CORE, 0);
    limit_set(RLIMIT_CPU, (rlim_t)def->seconds + 2);
    if (!TY_ASAN) // its shadow memory alone exceeds any sensible limit
        limit_set(RLIMIT_AS, address_space() + def->memory_bytes);
}

static _Noreturn void child_main(const child_run* run, int output_fd, int result_fd, ty_child_fn* fn,
                                 const void* context)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // Handlers belong to the parent; a fault must show as the signal it is.
    const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS, SIGXCPU};
    for (size_t i = 0; i < sizeof(signals) / sizeof(signals[0]); i++)
        signal(signals[i], SIG_DFL);
    // Importers may print; standard output belongs to results.
    int null_fd = open("/dev/null", O_WRONLY);
    if (null_fd >= 0 && output_fd > STDERR_FILENO && result_fd > STDERR_FILENO)
        dup2(null_fd, STDOUT_FILENO);
    limits_apply(&run->def);
    ty_error result;
    memset(&result, 0, sizeof(result));
    result.status = fn(context, output_fd, &result);
    close(output_fd);
    ty_status sent = ty_child_write(result_fd, &result, sizeof(result), NULL);
    _exit(sent ? TY_INTERNAL : TY_OK);
}

// --- in the parent ---

static ty_status output_reserve(child_run* run, ty_error* error)
{
    if (run->output.size + 1 < run->capacity)
        return TY_OK;
    size_t capacity = run->capacity ? 2 * run->capacity : 65536;
    uint8_t* grown = ty_try_grow(run->output.data, run->output.size, capacity, 1);
    if (!grown)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for the %zu bytes that the importer gives", capacity);
    run->output.data = grown;
    run->capacity = capacity;
    return TY_OK;
}

static ty_status output_take(child_run* run, ty_error* error)
{
    ty_status status = output_reserve(run, error);
    if (status)
        return status;
    ssize_t count = read(run->output_fd, run->output.data + run->output.size, run->capacity - 1 - run->output.size);
    if (count < 0)
        return errno == EINTR ? TY_OK
                              : ty_error_set(error, TY_BAD_FILE, "cannot read from the importer: %s", strerror(errno));
    if (count == 0)
    {
        close(run->output_fd);
        run->output_fd = -1;
    }
    run->output.size += (size_t)count;
    if (run->output.size > run->def.max_output)
        return ty_error_set(error, TY_BAD_FILE, "the importer gives more than %zu bytes", run->def.max_output);
    return TY_OK;
}

static void result_take(child_run* run)
{
    char* target = (char*)&run->result;
    ssize_t count = read(run->result_fd, target + run->result_size, sizeof(run->result) - run->result_size);
    if (count < 0 && errno == EINTR)
        return;
    if (count > 0)
        run->result_size += (size_t)count;
    if (count <= 0 || run->result_size == sizeof(run->result))
    {
        close(run->result_fd);
        run->result_fd = -1;
    }
}

static ty_status still_allowed(const child_run* run, ty_error* error)
{
    if (ty_cancel_requested())
        return ty_error_set(error, ty_cancel_signal() == SIGTERM ? TY_TERMINATED : TY_INTERRUPTED, "interrupted");
    if (ty_time_now() > run->deadline)
        return ty_error_set(error, TY_BAD_FILE, "the importer took more than %g seconds", run->def.seconds);
    return TY_OK;
}

static ty_status pipes_drain(child_run* run, ty_error* error)
{
    while (run->output_fd >= 0 || run->result_fd >= 0)
    {
        ty_status status = still_allowed(run, error);
        if (status)
            return status;
        struct pollfd polls[2] = {{run->output_fd, POLLIN, 0}, {run->result_fd, POLLIN, 0}};
        if (poll(polls, 2, poll_slice) <= 0)
            continue;
        if (run->output_fd >= 0 && polls[0].revents)
            status = output_take(run, error);
        if (status)
            return status;
        if (run->result_fd >= 0 && polls[1].revents)
            result_take(run);
    }
    return TY_OK;
}

// Waits for the end of the child; one that closed its pipes and lives on is bound by the same deadline.
static ty_status child_wait(child_run* run, int* wait_status, ty_error* error)
{
    const struct timespec pause = {0, 1000000};
    for (;;)
    {
        pid_t ended = waitpid(run->pid, wait_status, WNOHANG);
        if (ended == run->pid)
        {
            run->pid = 0;
            return TY_OK;
        }
        if (ended < 0 && errno != EINTR)
        {
            run->pid = 0;
            return ty_error_set(error, TY_INTERNAL, "lost the importer: %s", strerror(errno));
        }
        ty_status status = still_allowed(run, error);
        if (status)
            return status;
        nanosleep(&pause, NULL);
    }
}

static void child_kill(child_run* run)
{
    if (run->pid <= 0)
        return;
    kill(run->pid, SIGKILL);
    while (waitpid(run->pid, NULL, 0) < 0 && errno == EINTR)
        continue;
}

// From the way the child ended and what it said to a status.
static ty_status child_judge(child_run* run, int wait_status, ty_error* error)
{
    ty_error* result = &run->result;
    if (WIFSIGNALED(wait_status) && WTERMSIG(wait_status) == SIGXCPU)
        return ty_error_set(error, TY_BAD_FILE, "the importer took more than %g seconds", run->def.seconds);
    if (WIFSIGNALED(wait_status))
        return ty_error_set(error, TY_BAD_FILE, "importer crashed (signal %d, %s)", WTERMSIG(wait_status),
                            strsignal(WTERMSIG(wait_status)));
    if (WEXITSTATUS(wait_status) == TY_NO_MEMORY && run->result_size == 0)
        return ty_error_set(error, TY_BAD_FILE, "the importer needs more than %zu MB of memory",
                            run->def.memory_bytes >> 20);
    if (WEXITSTATUS(wait_status) != TY_OK || run->result_size != sizeof(*result))
        return ty_error_set(error, TY_BAD_FILE, "the importer ended without a result (exit status %d)",
                            WEXITSTATUS(wait_status));
    if (result->status == TY_OK)
        return TY_OK;
    // Foreign code ran beside this text.
    result->file[sizeof(result->file) - 1] = 0;
    result->text[sizeof(result->text) - 1] = 0;
    if (error)
        *error = *result;
    return result->status;
}

static ty_status child_start(child_run* run, ty_child_fn* fn, const void* context, ty_error* error)
{
    int output[2], result[2];
    if (pipe2(output, O_CLOEXEC) != 0)
        return ty_error_set(error, TY_BAD_FILE, "cannot make a pipe: %s", strerror(errno));
    if (pipe2(result, O_CLOEXEC) != 0)
    {
        ty_status status = ty_error_set(error, TY_BAD_FILE, "cannot make a pipe: %s", strerror(errno));
        close(output[0]);
        close(output[1]);
        return status;
    }
    run->pid = fork();
    if (run->pid == 0)
    {
        close(output[0]);
        close(result[0]);
        child_main(run, output[1], result[1], fn, context);
    }
    int saved = errno;
    close(output[1]);
    close(result[1]);
    run->output_fd = output[0];
    run->result_fd = result[0];
    if (run->pid < 0)
        return ty_error_set(error, TY_BAD_FILE, "cannot start a process: %s", strerror(saved));
    return TY_OK;
}

ty_status ty_child_run(const ty_child_def* def, ty_child_fn* fn, const void* context, ty_bytes* output, ty_error* error)
{
    *output = (ty_bytes){0};
    child_run run = {.def = def ? *def : (ty_child_def){0}, .output_fd = -1, .result_fd = -1};
    if (run.def.memory_bytes == 0)
        run.def.memory_bytes = (size_t)4 << 30;
    if (!(run.def.seconds > 0.0))
        run.def.seconds = 60.0;
    if (run.def.max_output == 0)
        run.def.max_output = (size_t)2 << 30;
    run.deadline = ty_time_now() + run.def.seconds;
    int wait_status = 0;
    ty_status status = child_start(&run, fn, context, error);
    if (!status)
        status = pipes_drain(&run, error);
    if (!status)
        status = child_wait(&run, &wait_status, error);
    if (!status)
        status = child_judge(&run, wait_status, error);
    child_kill(&run);
    if (run.output_fd >= 0)
        close(run.output_fd);
    if (run.result_fd >= 0)
        close(run.result_fd);
    if (status)
        ty_bytes_term(&run.output);
    else
    {
        run.output.data[run.output.size] = 0;
        *output = run.output;
    }
    return status;
}
