// SPDX-License-Identifier: Apache-2.0
// The pool: threads that sleep on a condition until a range is there, and take pieces of it from a counter.
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>
#include <unistd.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

enum
{
    workers_limit = 256
};

// --- flush-to-zero ---

#if defined(__SSE__)
typedef unsigned float_mode;
static float_mode float_mode_flush(void)
{
    float_mode before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u); // flush-to-zero and denormals-are-zero
    return before;
}
static void float_mode_restore(float_mode mode)
{
    _mm_setcsr(mode);
}
#elif defined(__aarch64__)
typedef uint64_t float_mode;
static float_mode float_mode_flush(void)
{
    float_mode before;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before));
    __asm__ volatile("msr fpcr, %0" : : "r"(before | (1ull << 24)));
    return before;
}
static void float_mode_restore(float_mode mode)
{
    __asm__ volatile("msr fpcr, %0" : : "r"(mode));
}
#else
typedef int float_mode;
static float_mode float_mode_flush(void)
{
    return 0;
}
static void float_mode_restore(float_mode mode)
{
    (void)mode;
}
#endif

// --- cancelling ---

static atomic_int cancel_flag;
static atomic_int cancel_signal;
_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "a signal handler sets the cancel flag");

void ty_cancel_request(int signal_number)
{
    int none = 0;
    atomic_compare_exchange_strong(&cancel_signal, &none, signal_number);
    atomic_store(&cancel_flag, 1);
}

bool ty_cancel_requested(void)
{
    return atomic_load_explicit(&cancel_flag, memory_order_relaxed) != 0;
}

int ty_cancel_signal(void)
{
    return atomic_load(&cancel_signal);
}

void ty_cancel_clear(void)
{
    atomic_store(&cancel_flag, 0);
    atomic_store(&cancel_signal, 0);
}

// --- the range ---

// Written by the caller before the threads wake, constant while they run; only next changes.
typedef struct range_job
{
    ty_range_fn* fn;
    void* context;
    int64_t count, grain, piece_count;
    bool whole;                            // a cancel request leaves nothing out
    _Alignas(64) atomic_int_fast64_t next; // piece
} range_job;

typedef struct worker_thread
{
    ty_workers* pool;
    pthread_t thread;
    int index;
} worker_thread;

struct ty_workers
{
    range_job job;
    int count; // the caller included
    bool busy; // touched by the caller only
    pthread_mutex_t mutex;
    pthread_cond_t start, done;
    uint64_t generation; // of the job; guarded by mutex, as are running and stop
    int running;         // threads that have not finished this generation
    bool stop;
    worker_thread threads[]; // count - 1; worker i + 1 is threads[i]
};

static void job_run(range_job* job, int worker)
{
    float_mode before = float_mode_flush();
    while (job->whole || !ty_cancel_requested())
    {
        int64_t piece = atomic_fetch_add_explicit(&job->next, 1, memory_order_relaxed);
        if (piece >= job->piece_count)
            break;
        int64_t begin = piece * job->grain;
        int64_t end = job->count - begin > job->grain ? begin + job->grain : job->count;
        job->fn(job->context, begin, end, worker);
    }
    float_mode_restore(before);
}

static void* thread_main(void* argument)
{
    worker_thread* self = argument;
    ty_workers* pool = self->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;)
    {
        while (!pool->stop && pool->generation == seen)
            pthread_cond_wait(&pool->start, &pool->mutex);
        if (pool->stop)
            break;
        seen = pool->generation;
        pthread_mutex_unlock(&pool->mutex);
        job_run(&pool->job, self->index);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->running == 0)
            pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

static void job_init(range_job* job, int64_t count, int64_t grain, bool whole, ty_range_fn* fn, void* context)
{
    job->whole = whole;
    job->fn = fn;
    job->context = context;
    job->count = count;
    job->grain = grain > 0 ? grain : 1;
    job->piece_count = count / job->grain + (count % job->grain != 0);
    atomic_store_explicit(&job->next, 0, memory_order_relaxed);
}

static void range_run(ty_workers* workers, int64_t count, int64_t grain, bool whole, ty_range_fn* fn, void* context)
{
    if (count <= 0)
        return;
    if (!workers)
    {
        range_job job;
        job_init(&job, count, grain, whole, fn, context);
        job_run(&job, 0);
        return;
    }
    TY_ASSERT(!workers->busy);
    workers->busy = true;
    job_init(&workers->job, count, grain, whole, fn, context);
    bool shared = workers->count > 1 && workers->job.piece_count > 1;
    if (shared)
    {
        pthread_mutex_lock(&workers->mutex);
        workers->generation++;
        workers->running = workers->count - 1;
        pthread_cond_broadcast(&workers->start);
        pthread_mutex_unlock(&workers->mutex);
    }
    job_run(&workers->job, 0);
    if (shared)
    {
        pthread_mutex_lock(&workers->mutex);
        while (workers->running > 0)
            pthread_cond_wait(&workers->done, &workers->mutex);
        pthread_mutex_unlock(&workers->mutex);
    }
    workers->busy = false;
}

bool ty_parallel_for(ty_workers* workers, int64_t count, int64_t grain, ty_range_fn* fn, void* context)
{
    range_run(workers, count, grain, false, fn, context);
    return !ty_cancel_requested();
}

void ty_parallel_all(ty_workers* workers, int64_t count, int64_t grain, ty_range_fn* fn, void* context)
{
    range_run(workers, count, grain, true, fn, context);
}

// --- creation ---

static int core_count(void)
{
    cpu_set_t set;
    int count = 0;
    if (sched_getaffinity(0, sizeof(set), &set) == 0)
        count = CPU_COUNT(&set);
    if (count < 1)
        count = (int)sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > workers_limit ? workers_limit : count;
}

// Signals are for the thread that began: the pool inherits a mask that blocks all but the ones of a fault.
static void signals_block(sigset_t* before)
{
    sigset_t blocked;
    sigfillset(&blocked);
    const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT, SIGSYS};
    for (size_t i = 0; i < sizeof(faults) / sizeof(faults[0]); i++)
        sigdelset(&blocked, faults[i]);
    pthread_sigmask(SIG_SETMASK, &blocked, before);
}

static void pool_stop(ty_workers* workers, int thread_count)
{
    pthread_mutex_lock(&workers->mutex);
    workers->stop = true;
    pthread_cond_broadcast(&workers->start);
    pthread_mutex_unlock(&workers->mutex);
    for (int i = 0; i < thread_count; i++)
        pthread_join(workers->threads[i].thread, NULL);
    pthread_cond_destroy(&workers->start);
    pthread_cond_destroy(&workers->done);
    pthread_mutex_destroy(&workers->mutex);
    ty_free(workers);
}

ty_status ty_workers_create(int thread_count, ty_workers** out, ty_error* error)
{
    *out = NULL;
    if (thread_count < 0 || thread_count > workers_limit)
        return ty_error_set(error, TY_USAGE, "%d threads asked for; the range is 1 to %d, or 0 for all cores",
                            thread_count, workers_limit);
    int count = thread_count ? thread_count : core_count();
    ty_workers* workers = ty_alloc(1, sizeof(ty_workers) + (size_t)(count - 1) * sizeof(worker_thread));
    workers->count = count;
    pthread_mutex_init(&workers->mutex, NULL);
    pthread_cond_init(&workers->start, NULL);
    pthread_cond_init(&workers->done, NULL);
    sigset_t before;
    signals_block(&before);
    int made = 0, failure = 0;
    for (; made < count - 1 && !failure; made += !failure)
    {
        worker_thread* thread = &workers->threads[made];
        thread->pool = workers;
        thread->index = made + 1;
        failure = pthread_create(&thread->thread, NULL, thread_main, thread);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (failure)
    {
        pool_stop(workers, made);
        return ty_error_set(error, TY_NO_MEMORY, "cannot start thread %d of %d: %s", made + 2, count,
                            strerror(failure));
    }
    *out = workers;
    return TY_OK;
}

void ty_workers_destroy(ty_workers* workers)
{
    if (workers)
        pool_stop(workers, workers->count - 1);
}

int ty_workers_count(const ty_workers* workers)
{
    return workers->count;
}
