// SPDX-License-Identifier: Apache-2.0
// The pool: each index once, stable worker indices, flush-to-zero, cancelling.
#include "cmocka_all.h"
#include <float.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>
#include <time.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/workers.h>
#include <unistd.h>

static ty_workers* pool_of(int thread_count)
{
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(thread_count, &workers, &error))
        fail_msg("%s", error.text);
    return workers;
}

typedef struct coverage
{
    unsigned char* visits; // one an index
    int64_t count, grain;
    int worker_count;
    atomic_int broken;
    atomic_int inside[256]; // how many calls a worker index is in
} coverage;

static void cover(void* context, int64_t begin, int64_t end, int worker)
{
    coverage* c = context;
    if (begin < 0 || end > c->count || begin >= end || end - begin > c->grain || worker < 0 ||
        worker >= c->worker_count || begin % c->grain != 0)
    {
        atomic_fetch_add(&c->broken, 1);
        return;
    }
    if (atomic_fetch_add(&c->inside[worker], 1) != 0)
        atomic_fetch_add(&c->broken, 1); // two threads with one index
    for (int64_t i = begin; i < end; i++)
        c->visits[i]++;
    atomic_fetch_sub(&c->inside[worker], 1);
}

static void check_coverage(ty_workers* workers, int worker_count, int64_t count, int64_t grain)
{
    coverage c = {.visits = TY_ALLOC(unsigned char, count), .count = count, .grain = grain};
    c.worker_count = worker_count;
    assert_true(ty_parallel_for(workers, count, grain, cover, &c));
    assert_int_equal(atomic_load(&c.broken), 0);
    for (int64_t i = 0; i < count; i++)
        assert_int_equal(c.visits[i], 1);
    ty_free(c.visits);
}

static void test_each_index_once(void** state)
{
    (void)state;
    const int64_t counts[] = {0, 1, 2, 7, 64, 1000, 4097}, grains[] = {1, 2, 3, 64, 5000};
    for (int threads = 1; threads <= 5; threads++)
    {
        ty_workers* workers = pool_of(threads);
        assert_int_equal(ty_workers_count(workers), threads);
        for (size_t i = 0; i < sizeof(counts) / sizeof(counts[0]); i++)
            for (size_t k = 0; k < sizeof(grains) / sizeof(grains[0]); k++)
                check_coverage(workers, threads, counts[i], grains[k]);
        ty_workers_destroy(workers);
    }
    check_coverage(NULL, 1, 1000, 7); // on the caller alone
    ty_workers_destroy(NULL);
}

static void count_one(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    atomic_fetch_add((atomic_llong*)context, end - begin);
}

// Many short ranges one after another: a wake-up that is lost or doubled would hang or miscount.
static void test_many_short_ranges(void** state)
{
    (void)state;
    ty_workers* workers = pool_of(4);
    atomic_llong sum = 0;
    for (int i = 0; i < 3000; i++)
        assert_true(ty_parallel_for(workers, 5, 1, count_one, &sum));
    assert_int_equal(atomic_load(&sum), 15000);
    assert_true(ty_parallel_for(workers, 10, 0, count_one, &sum)); // grain below 1 is 1
    assert_true(ty_parallel_for(workers, -3, 1, count_one, &sum)); // nothing to do
    assert_int_equal(atomic_load(&sum), 15010);
    ty_workers_destroy(workers);
}

static void count_late(void* context, int64_t begin, int64_t end, int worker)
{
    const struct timespec pause = {0, worker ? 3000000 : 100000};
    nanosleep(&pause, NULL);
    count_one(context, begin, end, worker);
}

// The caller runs out of pieces first and must wait for those that others hold.
static void test_returns_when_all_are_done(void** state)
{
    (void)state;
    ty_workers* workers = pool_of(4);
    for (int i = 1; i <= 20; i++)
    {
        atomic_llong sum = 0;
        assert_true(ty_parallel_for(workers, 8, 1, count_late, &sum));
        assert_int_equal(atomic_load(&sum), 8);
    }
    ty_workers_destroy(workers);
}

static void test_huge_range_does_not_overflow(void** state)
{
    (void)state;
    atomic_llong sum = 0;
    int64_t count = INT64_MAX - 1;
    assert_true(ty_parallel_for(NULL, count, INT64_MAX, count_one, &sum));
    assert_true(atomic_load(&sum) == count);
    atomic_store(&sum, 0);
    assert_true(ty_parallel_for(NULL, count, INT64_MAX / 2 + 7, count_one, &sum));
    assert_true(atomic_load(&sum) == count);
}

typedef struct presence
{
    atomic_int arrived, expected;
    atomic_int subnormal;
} presence;

static volatile float tiny = FLT_MIN, half = 0.5f, subnormal = FLT_MIN / 4.0f, large = 0x1p100f;

// Whether this thread makes (1) or takes (2) subnormal numbers. By bits, as a comparison takes them for zero.
static int subnormals(void)
{
    float made = tiny * half;
    uint32_t bits;
    memcpy(&bits, &made, sizeof(bits));
    return (bits != 0 ? 1 : 0) + (subnormal * large != 0.0f ? 2 : 0);
}

// Holds its piece until every worker has one, so that each worker is seen.
static void meet(void* context, int64_t begin, int64_t end, int worker)
{
    (void)begin, (void)end, (void)worker;
    presence* p = context;
    if (subnormals() != 0)
        atomic_fetch_add(&p->subnormal, 1);
    atomic_fetch_add(&p->arrived, 1);
    const struct timespec pause = {0, 100000};
    for (int i = 0; i < 100000 && atomic_load(&p->arrived) < atomic_load(&p->expected); i++)
        nanosleep(&pause, NULL);
}

static void test_flush_to_zero_on_all_workers(void** state)
{
    (void)state;
#if defined(__SSE__) || defined(__aarch64__)
    assert_int_equal(subnormals(), 3); // the caller's own mode
    for (int threads = 1; threads <= 4; threads++)
    {
        ty_workers* workers = pool_of(threads);
        presence p = {.expected = threads};
        assert_true(ty_parallel_for(workers, threads, 1, meet, &p));
        assert_int_equal(atomic_load(&p.arrived), threads); // so all of them ran at the same time
        assert_int_equal(atomic_load(&p.subnormal), 0);
        assert_int_equal(subnormals(), 3); // and it is given back
        ty_workers_destroy(workers);
    }
#else
    skip();
#endif
}

static void cancel_at_ten(void* context, int64_t begin, int64_t end, int worker)
{
    (void)end, (void)worker;
    atomic_fetch_add((atomic_int*)context, 1);
    if (begin == 10)
        ty_cancel_request(SIGINT);
}

static void test_cancel_leaves_pieces_out(void** state)
{
    (void)state;
    ty_workers* workers = pool_of(3);
    atomic_int calls = 0;
    assert_false(ty_parallel_for(workers, 1000000, 1, cancel_at_ten, &calls));
    assert_true(atomic_load(&calls) >= 11 && atomic_load(&calls) < 1000000);
    assert_true(ty_cancel_requested());
    atomic_store(&calls, 0);
    assert_false(ty_parallel_for(workers, 100, 1, cancel_at_ten, &calls)); // still cancelled
    assert_int_equal(atomic_load(&calls), 0);
    ty_cancel_clear();
    check_coverage(workers, 3, 1000, 10); // the pool is as before
    ty_workers_destroy(workers);
}

static void on_signal(int number)
{
    ty_cancel_request(number);
}

static void test_cancel_from_a_signal(void** state)
{
    (void)state;
    assert_false(ty_cancel_requested());
    assert_int_equal(ty_cancel_signal(), 0);
    signal(SIGUSR1, on_signal);
    raise(SIGUSR1);
    ty_cancel_request(SIGTERM);
    assert_true(ty_cancel_requested());
    assert_int_equal(ty_cancel_signal(), SIGUSR1); // the first
    ty_cancel_clear();
    assert_int_equal(ty_cancel_signal(), 0);
    ty_cancel_request(0);
    assert_true(ty_cancel_requested());
    assert_int_equal(ty_cancel_signal(), 0);
    ty_cancel_clear();
    assert_false(ty_cancel_requested());
}

static void test_thread_count(void** state)
{
    (void)state;
    ty_workers* workers = (ty_workers*)state;
    ty_error error;
    assert_int_equal(ty_workers_create(-1, &workers, &error), TY_USAGE);
    assert_null(workers);
    assert_int_equal(ty_workers_create(257, &workers, &error), TY_USAGE);
    assert_non_null(strstr(error.text, "257"));
    workers = pool_of(0);
    assert_in_range(ty_workers_count(workers), 1, 256);
    assert_true(ty_workers_count(workers) <= sysconf(_SC_NPROCESSORS_CONF));
    check_coverage(workers, ty_workers_count(workers), 500, 9);
    ty_workers_destroy(workers);
}

// Waiting threads sleep: an idle pool takes no processor time.
static void test_waiting_is_passive(void** state)
{
    (void)state;
    ty_workers* workers = pool_of(4);
    check_coverage(workers, 4, 100, 1);
    const struct timespec pause = {0, 200000000};
    clock_t before = clock();
    nanosleep(&pause, NULL);
    double used = (double)(clock() - before) / CLOCKS_PER_SEC;
    assert_true(used < 0.05);
    ty_workers_destroy(workers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_index_once),
        cmocka_unit_test(test_many_short_ranges),
        cmocka_unit_test(test_returns_when_all_are_done),
        cmocka_unit_test(test_huge_range_does_not_overflow),
        cmocka_unit_test(test_flush_to_zero_on_all_workers),
        cmocka_unit_test(test_cancel_leaves_pieces_out),
        cmocka_unit_test(test_cancel_from_a_signal),
        cmocka_unit_test(test_thread_count),
        cmocka_unit_test(test_waiting_is_passive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
