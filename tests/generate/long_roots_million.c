// SPDX-License-Identifier: Apache-2.0
// Roots over a rough ball of a million triangles, as their files tell of them.
#include "roots_hold.h"

static void roots_hold_on_to_a_million_triangles(void** state)
{
    (void)state;
    holds("ball", 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_hold_on_to_a_million_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
