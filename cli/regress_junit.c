// SPDX-License-Identifier: Apache-2.0
// Results as JUnit XML, which CI servers read.
#include "regress.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>

// Text of an attribute; what XML 1.0 cannot hold becomes a question mark.
static void put_text(FILE* file, const char* text)
{
    for (; *text; text++)
    {
        unsigned char c = (unsigned char)*text;
        switch (c)
        {
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '&':
            fputs("&amp;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        case '\n':
        case '\t':
            fprintf(file, "&#%d;", c);
            break;
        default:
            fputc(c < 32 ? '?' : c, file);
        }
    }
}

static void put_case(FILE* file, const ty_regress_result* result)
{
    fputs("    <testcase classname=\"tsuya.regress\" name=\"", file);
    put_text(file, result->of->name);
    fprintf(file, "\" time=\"%.3f\"", result->seconds);
    if (!ty_regress_failed(result))
    {
        fputs("/>\n", file);
        return;
    }
    const char* element = result->verdict == TY_REGRESS_FAULT ? "error" : "failure";
    fprintf(file, ">\n      <%s message=\"", element);
    put_text(file, result->text);
    fputs("\"/>\n    </testcase>\n", file);
}

static void put_suite(FILE* file, const ty_regress_result* results, int count)
{
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
}

ty_status ty_regress_junit(const char* path, const ty_regress_result* results, int count, ty_error* error)
{
    static ty_atomic_file output; // paths: too large for the stack
    ty_status status = ty_atomic_begin(&output, path, error);
    if (status != TY_OK)
    {
        return status;
    }
    FILE* file = fopen(output.temporary, "wb");
    if (file)
    {
        put_suite(file, results, count);
    }
    bool bad = !file || ferror(file);
    if (file)
    {
        bad |= fclose(file) != 0;
    }
    if (!bad)
    {
        return ty_atomic_commit(&output, error);
    }
    status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: %s", strerror(errno));
    ty_atomic_abort(&output);
    return status;
}
