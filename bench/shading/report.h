// SPDX-License-Identifier: Apache-2.0
// Tables of what was measured beside what is expected; remembers whether all of it holds.
#pragma once
#include <stdbool.h>

typedef struct bench_options
{
    bool quick;
    int threads;
    const char* folder; // of cached walks, tables and curves; NULL = none are kept
} bench_options;

void report_title(const char* title, const char* columns);
// One line: is it within tolerance of expected?
bool report_near(const char* name, double measured, double expected, double tolerance);
// Is it at most the limit? expected is what it was measured at before, for the reader.
bool report_most(const char* name, double measured, double expected, double limit);
bool report_least(const char* name, double measured, double expected, double limit);
// A promise that a line printed elsewhere makes.
bool report_holds(const char* name, bool holds);
int report_failures(void);
int report_rows(void);

// --- what is measured ---

void bench_sphere(const bench_options* options);
void bench_ellipsoid(const bench_options* options);
void bench_nine_shapes(const bench_options* options);
void bench_held_out(const bench_options* options);
void bench_channels(const bench_options* options);
void bench_absorption(const bench_options* options);
void bench_stretched(const bench_options* options);
void bench_moisture(const bench_options* options);
void bench_laws(const bench_options* options);
void bench_furnace(const bench_options* options);
void bench_heap(const bench_options* options);
void bench_pictures(const bench_options* options);
void bench_speed(const bench_options* options);
