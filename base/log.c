// SPDX-License-Identifier: Apache-2.0
// Messages on standard error: one write(2) a line, so that lines of several threads do not mix.
#include "terminal.h"
#include <errno.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <unistd.h>

static atomic_int log_level = TY_LOG_INFO;
static atomic_int terminal_state; // 0 = not asked yet, else 1 + (bit 0: terminal, bit 1: colour)
static atomic_int bar_shown;

void ty_log_set_level(ty_log_level level)
{
    atomic_store(&log_level, (int)level);
}

ty_log_level ty_log_get_level(void)
{
    return (ty_log_level)atomic_load(&log_level);
}

static int terminal_ask(void)
{
    int state = atomic_load(&terminal_state);
    if (state)
        return state - 1;
    const char* no_color = getenv("NO_COLOR");
    const char* term = getenv("TERM");
    bool terminal = isatty(STDERR_FILENO) == 1;
    bool color = terminal && !(no_color && no_color[0]) && !(term && strcmp(term, "dumb") == 0);
    atomic_store(&terminal_state, 1 + (terminal ? 1 : 0) + (color ? 2 : 0));
    return (terminal ? 1 : 0) + (color ? 2 : 0);
}

bool ty_terminal_is(void)
{
    return terminal_ask() & 1;
}

void ty_terminal_write(const char* bytes, size_t size)
{
    while (size > 0)
    {
        ssize_t written = write(STDERR_FILENO, bytes, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return; // there is nowhere left to complain
        bytes += written;
        size -= (size_t)written;
    }
}

void ty_terminal_set_bar(bool shown)
{
    atomic_store(&bar_shown, shown);
}

// Names of files and materials come from outside: their control characters must not reach the terminal.
static void controls_remove(char* text)
{
    for (unsigned char* c = (unsigned char*)text; *c; c++)
        if ((*c < 0x20 && *c != '\n' && *c != '\t') || *c == 0x7f)
            *c = '?';
}

static const char* const level_names[] = {"error: ", "warning: ", "", "debug: "};
static const char* const level_colors[] = {"\033[1;31m", "\033[1;33m", "", "\033[2m"};

void ty_log(ty_log_level level, const char* format, ...)
{
    if ((int)level > atomic_load(&log_level))
        return;
    char text[3072], line[3200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof(text), format, arguments);
    va_end(arguments);
    controls_remove(text);
    bool color = (terminal_ask() & 2) && level_colors[level][0];
    // A progress bar that stands on the line is erased; its next update draws it anew.
    const char* erase = atomic_exchange(&bar_shown, 0) ? "\r\033[K" : "";
    int length = snprintf(line, sizeof(line), "%stsuya: %s%s%s%s\n", erase, color ? level_colors[level] : "",
                          level_names[level], color ? "\033[0m" : "", text);
    ty_terminal_write(line, (size_t)length);
}

void ty_log_error(const ty_error* error)
{
    char text[sizeof(error->file) + sizeof(error->text) + 32];
    ty_error_format(error, text, sizeof(text));
    ty_log(TY_LOG_ERROR, "%s", text);
}
