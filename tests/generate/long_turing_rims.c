// SPDX-License-Identifier: Apache-2.0
// The share of the gradient that is tangential at free rims: its mean and spread over many starts, by how soft the rim
// is.
#include "turing_fields.h"

static void free_rims_are_met_from_most_starts(void** state)
{
    (void)state;
    enum
    {
        STARTS = 64
    };
    for (int soft = 0; soft <= 3; soft++)
    {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < STARTS; i++)
        {
            ty_turing* field = disc(false, (float)soft);
            start_by_chance(field, 4242 + (uint64_t)i);
            run_until(field, 6000.0f);
            double tangential = 1.0 - (double)normal_share(field, 75.0f, 82.0f);
            sum += tangential / STARTS;
            squares += tangential * tangential / STARTS;
            ty_turing_destroy(field);
        }
        double spread = sqrt(squares - sum * sum);
        print_message("rim of %d cells: %.3f, spread %.3f\n", soft, sum, spread);
        assert_true(sum - 0.5 > 3.0 * spread / sqrt((double)STARTS)); // half were no direction
        assert_true(sum < 0.75);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_rims_are_met_from_most_starts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
