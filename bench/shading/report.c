// SPDX-License-Identifier: Apache-2.0
// Rows of the report.
#include "report.h"
#include <math.h>
#include <stdio.h>

static int rows, failures;

static bool count(bool holds)
{
    rows++;
    failures += !holds;
    printf("  %s\n", holds ? "holds" : "FAILS");
    fflush(stdout);
    return holds;
}

void report_title(const char* title, const char* columns)
{
    printf("\n%s\n", title);
    if (columns)
        printf("%s\n", columns);
}

bool report_near(const char* name, double measured, double expected, double tolerance)
{
    printf("  %-46s %9.4f   expected %7.4f +- %.4f", name, measured, expected, tolerance);
    return count(fabs(measured - expected) <= tolerance);
}

bool report_most(const char* name, double measured, double expected, double limit)
{
    printf("  %-46s %9.4f   expected %7.4f, at most %.4f", name, measured, expected, limit);
    return count(measured <= limit);
}

bool report_least(const char* name, double measured, double expected, double limit)
{
    printf("  %-46s %9.4f   expected %7.4f, at least %.4f", name, measured, expected, limit);
    return count(measured >= limit);
}

bool report_holds(const char* name, bool holds)
{
    printf("  %-74s", name);
    return count(holds);
}

int report_failures(void)
{
    return failures;
}

int report_rows(void)
{
    return rows;
}
