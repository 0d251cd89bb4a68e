// SPDX-License-Identifier: Apache-2.0
// Messages and progress on standard error. Standard output belongs to results.
#pragma once
#include <stdint.h>
#include <tsuya/base/status.h>

typedef enum ty_log_level
{
    TY_LOG_ERROR,
    TY_LOG_WARNING,
    TY_LOG_INFO,
    TY_LOG_DEBUG
} ty_log_level;

void ty_log_set_level(ty_log_level level); // default TY_LOG_INFO
ty_log_level ty_log_get_level(void);

// One line, "tsuya: warning: ..." in colour on a terminal unless NO_COLOR is set. Any thread; lines do not mix.
void ty_log(ty_log_level level, const char* format, ...) TY_PRINTF(2, 3);
void ty_log_error(const ty_error* error); // at TY_LOG_ERROR, with its place

// Progress of one long task: a bar with percent and time to go on a terminal, a line every 5 % otherwise; its end says
// the time taken. Nothing below TY_LOG_INFO.
typedef enum ty_progress_style
{
    TY_PROGRESS_AUTO,
    TY_PROGRESS_BAR,
    TY_PROGRESS_LINES,
    TY_PROGRESS_NONE
} ty_progress_style;

typedef struct ty_progress
{
    const char* label; // borrowed
    double start_time; // seconds, monotonic
    double last_time;
    double last_fraction;
    int shown; // whether a bar stands on the line
} ty_progress;

void ty_progress_set_style(ty_progress_style style);
void ty_progress_begin(ty_progress* progress, const char* label);
// fraction 0..1; detail (NULL = none) is appended, e.g. "4.1 Mray/s 120 MB". Cheap to call often; one thread at a time.
void ty_progress_update(ty_progress* progress, double fraction, const char* detail);
void ty_progress_end(ty_progress* progress);

double ty_time_now(void);      // seconds, monotonic
uint64_t ty_memory_peak(void); // bytes, resident peak of this process
