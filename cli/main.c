// SPDX-License-Identifier: Apache-2.0
// The program: finds the command and leaves with its status.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/suggest.h>
#include <tsuya/base/workers.h>

static const ty_command* const commands[] = {
    &ty_command_render,    //
    &ty_command_turntable, //
    &ty_command_sweep,     //
    &ty_command_develop,   //
    &ty_command_merge,     //
    &ty_command_compare,   //
    &ty_command_regress,   //
    &ty_command_check,     //
    &ty_command_info,      //
    &ty_command_params,    //
    &ty_command_pack,      //
    &ty_command_fill,      //
    &ty_command_filter,    //
    &ty_command_loop,      //
    &ty_command_roots,     //
    &ty_command_export,    //
    &ty_command_moisture,  //
    &ty_command_calibrate, //
    &ty_command_doctor,    //
};
enum
{
    COMMAND_COUNT = sizeof commands / sizeof commands[0]
};

static void print_help(void)
{
    printf("tsuya %s: an offline ray-traced renderer for organic aggregates\n\n", TSUYA_VERSION);
    printf("usage: tsuya COMMAND ...\n\n");
    for (int i = 0; i < COMMAND_COUNT; i++)
    {
        printf("  %-9s %s\n", commands[i]->name, commands[i]->summary);
    }
    printf("\n`tsuya COMMAND --help` tells a command's options; results go to standard output, messages to standard "
           "error.\nExit status: 0 done, 1 differs, 2 usage, 3 bad scene or recipe, 4 file or device error, 5 memory, "
           "6 non-finite "
           "samples,\n7 not at rest, 70 internal error, 129/130/143 stopped by a signal.\n\n"
           "example: tsuya render scenes/rice_bowl -o out/rice_bowl.exr --quick --develop\n");
}

static const ty_command* find_command(const char* name)
{
    for (int i = 0; i < COMMAND_COUNT; i++)
    {
        if (strcmp(commands[i]->name, name) == 0)
        {
            return commands[i];
        }
    }
    return NULL;
}

static ty_status unknown_command(const char* name)
{
    const char* names[COMMAND_COUNT];
    for (int i = 0; i < COMMAND_COUNT; i++)
    {
        names[i] = commands[i]->name;
    }
    const char* near = ty_suggest_name(name, names, COMMAND_COUNT);
    ty_log(TY_LOG_ERROR, "unknown command '%s'%s%s%s (tsuya --help lists them)", name, near ? "; did you mean '" : "",
           near ? near : "", near ? "'?" : "");
    return TY_USAGE;
}

static ty_status run_command(int argc, char** argv)
{
    const ty_command* command = find_command(argv[1]);
    if (!command)
    {
        return unknown_command(argv[1]);
    }
    for (int i = 2; i < argc && strcmp(argv[i], "--") != 0; i++)
    {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
        {
            ty_command_help(command);
            return ty_output_finish();
        }
    }
    static ty_arguments arguments; // 6 kB, and there is one command line
    ty_status status = ty_arguments_parse(command, argc - 2, argv + 2, &arguments);
    return status == TY_OK ? command->run(&arguments) : status;
}

int main(int argc, char** argv)
{
#if defined(__x86_64__)
    if (!__builtin_cpu_supports("avx2"))
    {
        ty_log(TY_LOG_ERROR, "this build needs a CPU with AVX2; configure with -DTSUYA_ARCH=x86-64 for older ones");
        return TY_INTERNAL;
    }
#endif
    ty_signals_install();
    if (argc < 2 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0)
    {
        print_help();
        return argc < 2 ? TY_USAGE : (int)ty_output_finish();
    }
    if (strcmp(argv[1], "--version") == 0)
    {
        printf("tsuya %s\n", TSUYA_VERSION);
        return (int)ty_output_finish();
    }
    ty_status status = run_command(argc, argv);
    ty_atomic_abort_all();
    // Whatever floor noticed the stop, the status names the signal.
    bool stopped = status == TY_INTERRUPTED || status == TY_TERMINATED;
    return stopped && ty_cancel_signal() > 0 ? 128 + ty_cancel_signal() : (int)status;
}
