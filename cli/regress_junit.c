// SPDX-License-Identifier: Apache-2.0
// Results as JUnit XML, which CI servers read.
#include "markup.h"
#include "regress.h"
#include <stdio.h>

static void put_case(FILE* file, const ty_regress_result* result)
{
    fputs("    <testcase classname=\"tsuya.regress\" name=\"", file);
    ty_markup_text(file, result->of->name);
    fprintf(file, "\" time=\"%.3f\"", result->seconds);
    if (!ty_regress_failed(result))
    {
        fputs("/>\n", file);
        return;
    }
    const char* element = result->verdict == TY_REGRESS_FAULT ? "error" : "failure";
    fprintf(file, ">\n      <%s message=\"", element);
    ty_markup_text(file, result->text);
    fputs("\"/>\n    </testcase>\n", file);
}

typedef struct suite
{
    const ty_regress_result* results;
    int count;
} suite;

static ty_status put_suite(FILE* file, const void* context, ty_error* error)
{
    (void)error;
    const ty_regress_result* results = ((const suite*)context)->results;
    int count = ((const suite*)context)->count;
    int tests = 0, failures = 0, faults = 0;
    double seconds = 0.0;
    for (int i = 0; i < count; i++)
    {
        tests += results[i].verdict != TY_REGRESS_NOT_RUN;
        failures += results[i].verdict == TY_REGRESS_DIFFERS;
        faults += results[i].verdict == TY_REGRESS_FAULT;
        seconds += results[i].seconds;
    }
    fprintf(file,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"tsuya regress\" "
            "tests=\"%d\" failures=\"%d\" errors=\"%d\" time=\"%.3f\">\n",
            tests, failures, faults, seconds);
    for (int i = 0; i < count; i++)
    {
        if (results[i].verdict != TY_REGRESS_NOT_RUN)
        {
            put_case(file, &results[i]);
        }
    }
    fputs("  </testsuite>\n</testsuites>\n", file);
    return TY_OK;
}

ty_status ty_regress_junit(const char* path, const ty_regress_result* results, int count, ty_error* error)
{
    const suite all = {results, count};
    return ty_output_write(path, put_suite, &all, error);
}
