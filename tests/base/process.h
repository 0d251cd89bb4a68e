// SPDX-License-Identifier: Apache-2.0
// Runs a function in a forked process and catches its end and its standard error.
#pragma once
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct process_end
{
    int exit_status; // -1 when a signal ended it
    int signal;
    char text[4096]; // standard error
} process_end;

static inline process_end process_run(void (*fn)(void* context), void* context)
{
    process_end end = {-1, 0, ""};
    int ends[2];
    if (pipe(ends) != 0)
        abort();
    pid_t pid = fork();
    if (pid == 0)
    {
        dup2(ends[1], STDERR_FILENO);
        close(ends[0]);
        close(ends[1]);
        fn(context);
        _exit(0);
    }
    close(ends[1]);
    size_t size = 0;
    ssize_t count;
    while ((count = read(ends[0], end.text + size, sizeof(end.text) - 1 - size)) > 0)
        size += (size_t)count;
    close(ends[0]);
    int status = 0;
    waitpid(pid, &status, 0);
    if (WIFEXITED(status))
        end.exit_status = WEXITSTATUS(status);
    else
        end.signal = WTERMSIG(status);
    return end;
}
