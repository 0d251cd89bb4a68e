// SPDX-License-Identifier: Apache-2.0
// Roots as their files tell of them, on hosts of many kinds: one manifold shell that holds on and goes no deeper.
#include "roots_hold.h"

#define HOST(name)                                                                                                     \
    static void roots_hold_on_to_a_##name(void** state)                                                                \
    {                                                                                                                  \
        (void)state;                                                                                                   \
        holds(#name, 1);                                                                                               \
    }

HOST(ground)
HOST(pillar)
HOST(compound)
HOST(knot)
HOST(bust)
HOST(ball)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_hold_on_to_a_ground),   cmocka_unit_test(roots_hold_on_to_a_pillar),
        cmocka_unit_test(roots_hold_on_to_a_compound), cmocka_unit_test(roots_hold_on_to_a_knot),
        cmocka_unit_test(roots_hold_on_to_a_bust),     cmocka_unit_test(roots_hold_on_to_a_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
