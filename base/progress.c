// SPDX-License-Identifier: Apache-2.0
// Progress of a long task, the clock, and the peak of memory.
#include "terminal.h"
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <time.h>
#include <tsuya/base/log.h>
#include <unistd.h>

enum
{
    progress_cells = 24,
    progress_steps = 20 // lines a task, where there is no terminal
};

static const double bar_interval = 0.1; // seconds between two drawings

static atomic_int progress_style = TY_PROGRESS_AUTO;

void ty_progress_set_style(ty_progress_style style)
{
    atomic_store(&progress_style, (int)style);
}

static ty_progress_style style_now(void)
{
    ty_progress_style style = (ty_progress_style)atomic_load(&progress_style);
    if (ty_log_get_level() < TY_LOG_INFO)
        return TY_PROGRESS_NONE;
    if (style == TY_PROGRESS_AUTO)
        return ty_terminal_is() ? TY_PROGRESS_BAR : TY_PROGRESS_LINES;
    return style;
}

double ty_time_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

uint64_t ty_memory_peak(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0)
        return 0;
    return (uint64_t)usage.ru_maxrss * 1024u;
}

// 59.4 -> "0:59", 3725 -> "1:02:05"
static void duration_format(double seconds, char text[32])
{
    long long s = seconds < 0.0 ? 0 : seconds > 3.6e9 ? 3600000000ll : (long long)(seconds + 0.5);
    if (s < 3600)
        snprintf(text, 32, "%lld:%02lld", s / 60, s % 60);
    else
        snprintf(text, 32, "%lld:%02lld:%02lld", s / 3600, s / 60 % 60, s % 60);
}

static int terminal_columns(void)
{
    struct winsize window;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0)
        return window.ws_col;
    return 80;
}

static void bar_draw(ty_progress* progress, const char* times, const char* detail)
{
    char cells[progress_cells + 1], text[512], line[560];
    int full = (int)(progress->last_fraction * progress_cells);
    for (int i = 0; i < progress_cells; i++)
        cells[i] = i < full ? '#' : '.';
    cells[progress_cells] = 0;
    int length = snprintf(text, sizeof(text), "%s [%s] %3d %% %s%s%s", progress->label, cells,
                          (int)(progress->last_fraction * 100.0), times, detail ? "  " : "", detail ? detail : "");
    // A line that wraps cannot be drawn over: cut it, but not within a UTF-8 character.
    int width = terminal_columns() - 1;
    if (length >= (int)sizeof(text))
        length = (int)sizeof(text) - 1;
    if (length > width)
        length = width;
    while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80)
        length--;
    int size = snprintf(line, sizeof(line), "\r\033[K%.*s", length, text);
    ty_terminal_write(line, (size_t)size);
    ty_terminal_set_bar(true);
    progress->shown = 1;
}

void ty_progress_begin(ty_progress* progress, const char* label)
{
    double now = ty_time_now();
    *progress = (ty_progress){label, now, now - 1.0, 0.0, 0};
}

// Time to go as it would be at the mean speed so far.
static void eta_format(const ty_progress* progress, double now, char text[48])
{
    char duration[32];
    text[0] = 0;
    if (progress->last_fraction < 1e-3)
        return;
    duration_format((now - progress->start_time) * (1.0 / progress->last_fraction - 1.0), duration);
    snprintf(text, 48, "%s left", duration);
}

void ty_progress_update(ty_progress* progress, double fraction, const char* detail)
{
    ty_progress_style style = style_now();
    if (!(fraction > progress->last_fraction))
        fraction = progress->last_fraction;
    if (fraction > 1.0)
        fraction = 1.0;
    bool step = (int)(fraction * progress_steps) > (int)(progress->last_fraction * progress_steps);
    progress->last_fraction = fraction;
    if (style == TY_PROGRESS_NONE)
        return;
    double now = ty_time_now();
    char eta[48];
    eta_format(progress, now, eta);
    if (style == TY_PROGRESS_BAR && now - progress->last_time >= bar_interval)
    {
        progress->last_time = now;
        bar_draw(progress, eta, detail);
    }
    // The line of 100 % is printed by the end, with the time taken.
    if (style == TY_PROGRESS_LINES && step && fraction < 1.0)
        ty_log(TY_LOG_INFO, "%s %d %% %s%s%s", progress->label, (int)(fraction * 100.0 + 1e-9), eta, detail ? "  " : "",
               detail ? detail : "");
}

void ty_progress_end(ty_progress* progress)
{
    if (style_now() == TY_PROGRESS_NONE)
        return;
    char duration[32];
    duration_format(ty_time_now() - progress->start_time, duration);
    progress->shown = 0;
    ty_log(TY_LOG_INFO, "%s %d %% in %s", progress->label, (int)(progress->last_fraction * 100.0 + 1e-9), duration);
}
