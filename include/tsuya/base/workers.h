// SPDX-License-Identifier: Apache-2.0
// A pool of threads with stable worker indices. The only file of the project that starts threads is workers.c.
#pragma once
#include <stdint.h>
#include <tsuya/base/status.h>

typedef struct ty_workers ty_workers; // opaque

// thread_count 0 = all cores (at most 256). The calling thread is worker 0. Flush-to-zero is set on every worker,
// the caller included, while it runs a range. Waiting is passive. TY_USAGE for a count out of range, TY_NO_MEMORY when
// the system starts no more threads; *out is NULL then.
TY_CHECKED ty_status ty_workers_create(int thread_count, ty_workers** out, ty_error* error);
void ty_workers_destroy(ty_workers* workers); // NULL is allowed
int ty_workers_count(const ty_workers* workers);

// Called with disjoint [begin, end) that cover [0, count); worker is 0..count-1 and stable during the call.
typedef void ty_range_fn(void* context, int64_t begin, int64_t end, int worker);

// Runs fn over [0, count) in pieces of at most grain, handed out in order, and returns when all are done.
// Which worker gets which piece is not determined: results may not depend on it. Not re-entrant.
// Returns false when cancelled (pieces not yet begun are left out). workers NULL = on the caller alone.
bool ty_parallel_for(ty_workers* workers, int64_t count, int64_t grain, ty_range_fn* fn, void* context);

// The same, but all pieces are done whether cancelled or not: for steps that must be whole, and are short.
void ty_parallel_all(ty_workers* workers, int64_t count, int64_t grain, ty_range_fn* fn, void* context);

// The cancel flag is one for the process, so that a signal handler can set it. Async-signal-safe.
void ty_cancel_request(int signal_number); // remembers the first signal; 0 = cancelled without a signal
bool ty_cancel_requested(void);
int ty_cancel_signal(void);
void ty_cancel_clear(void);
