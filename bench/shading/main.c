// SPDX-License-Identifier: Apache-2.0
// Shading against random walks: bench_shading [--quick] [--threads N] [--out FOLDER] [sphere ellipsoid shapes ...].
// Exit status 1 when something does not hold.
#include "report.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/log.h>

typedef void group_fn(const bench_options* options);

static const struct
{
    const char* name;
    group_fn* run;
    bool quick; // part of the quick form
} groups[] = {
    {"furnace", bench_furnace, true},
    {"sphere", bench_sphere, true},
    {"ellipsoid", bench_ellipsoid, true},
    {"shapes", bench_nine_shapes, true},
    {"held", bench_held_out, true},
    {"channels", bench_channels, true},
    {"absorption", bench_absorption, true},
    {"stretched", bench_stretched, true},
    {"moisture", bench_moisture, true},
    {"laws", bench_laws, true},
    {"heap", bench_heap, false},
    {"pictures", bench_pictures, false},
    {"speed", bench_speed, false},
};

#define GROUPS (int)(sizeof groups / sizeof *groups)

static int usage(void)
{
    fprintf(stderr, "usage: bench_shading [--quick] [--threads N] [--out FOLDER] [GROUP...]\ngroups:");
    for (int i = 0; i < GROUPS; i++)
        fprintf(stderr, " %s", groups[i].name);
    fprintf(stderr, "\n");
    return 2;
}

int main(int argc, char** argv)
{
    ty_log_set_level(TY_LOG_WARNING);
    bench_options options = {.threads = 1};
    bool chosen[GROUPS] = {false}, any = false;
    for (int i = 1; i < argc; i++)
    {
        int group = 0;
        if (!strcmp(argv[i], "--quick"))
            options.quick = true;
        else if (!strcmp(argv[i], "--threads") && i + 1 < argc)
            options.threads = atoi(argv[++i]);
        else if (!strcmp(argv[i], "--out") && i + 1 < argc)
            options.folder = argv[++i];
        else
        {
            while (group < GROUPS && strcmp(groups[group].name, argv[i]) != 0)
                group++;
            if (group == GROUPS)
                return usage();
            chosen[group] = any = true;
        }
    }
    for (int i = 0; i < GROUPS; i++)
        if (any ? chosen[i] : groups[i].quick || !options.quick)
        {
            groups[i].run(&options);
            fflush(stdout);
        }
    printf("\n%d rows, %d fail\n", report_rows(), report_failures());
    return report_failures() > 0;
}
