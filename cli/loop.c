// SPDX-License-Identifier: Apache-2.0
// `tsuya loop`: a recipe to frames by number, or to a film, and how seamless it is.
#include "video.h"
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>

static const char* const endings[] = {"exr", "png", "gif", "mp4", "mov", "mkv", NULL};

// --- the report ---

static double number(const json_t* object, const char* key)
{
    return json_number_value(json_object_get(object, key));
}

static void report_print(const json_t* report)
{
    const json_t *size = json_object_get(report, "volume"), *mean = json_object_get(report, "mean");
    printf("%d frames of %d x %d x %d voxels", (int)number(report, "frames"),
           (int)json_integer_value(json_array_get(size, 0)), (int)json_integer_value(json_array_get(size, 1)),
           (int)json_integer_value(json_array_get(size, 2)));
    if (number(report, "colors") > 0.0)
        printf(", %d colours", (int)number(report, "colors"));
    if (number(report, "outside") > 0.0)
        printf("\noutside  %.1f %% of the pixels lie beside the volume", 100.0 * number(report, "outside"));
    if (number(report, "start") > 0.0)
        printf("\nstart    frame 1 is at %.4f of the path", number(report, "start"));
    printf("\ninside   %.2f %% of the pixels (%.2f..%.2f)\n", 100.0 * number(mean, "density"),
           100.0 * number(report, "density_least"), 100.0 * number(report, "density_most"));
    printf("change   %.2f %% of the pixels a frame, at most %.2f %%; at the seam %.2f %%\n",
           100.0 * number(mean, "changed"), 100.0 * number(report, "changed_most"),
           100.0 * number(report, "changed_at_seam"));
    if (number(report, "changed_at_seam") > number(report, "changed_most"))
        printf("         the seam changes more than any other step: quiet_start puts it where the least changes\n");
    printf("speed    changes from a frame to the next by at most %.2f %%; at the seam by %.2f %%\n",
           100.0 * number(report, "speed_jump_most"), 100.0 * number(report, "speed_jump_at_seam"));
    printf("overlap  %.2f %%, Jaccard %.3f, kappa %.3f, means of all steps\n", 100.0 * number(mean, "overlap"),
           number(mean, "jaccard"), number(mean, "kappa"));
    printf("step     at most %.2f voxels; the pattern's wavelength is %.1f: %d frames are enough\n",
           number(report, "step_most"), number(report, "wavelength"), (int)number(report, "frames_needed"));
}

// --- the making ---

static ty_status check_output(const ty_arguments* arguments, const char* output)
{
    const ty_command* command = arguments->command;
    const char* report = ty_argument_text(arguments, "report", NULL);
    ty_status status = ty_film_check(command, output, endings, TY_OUTPUT_FRAMES);
    return status == TY_OK && report ? ty_output_check(command, "report", report, NULL, TY_OUTPUT_FILE) : status;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    const char* output = ty_argument_text(arguments, "output", NULL);
    double fps = 24.0, start = ty_time_now();
    char* report = NULL;
    ty_status status = check_output(arguments, output);
    if (status == TY_OK && ty_argument_has(arguments, "fps"))
        status = ty_argument_float(arguments, "fps", 0.1, 1000.0, &fps);
    if (status == TY_OK)
        status = ty_scene_arguments_read(arguments, &scene_arguments);
    if (status != TY_OK)
        return status;
    scene_arguments.options.report = &report;
    status = ty_film_make(arguments->positional[0], "loop", output, fps, &scene_arguments.options);
    ty_scene_arguments_term(&scene_arguments);
    if (status == TY_OK)
    {
        ty_log(TY_LOG_INFO, "made in %.1f s", ty_time_now() - start);
        status = ty_report_give(arguments, output, report, report_print);
    }
    ty_free(report);
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.####.exr", "the frames to write, from 1: also .png; or a film: .gif, .mp4, .mov, .mkv"},
    {"fps", 0, "N", "frames a second of a film (default 24)"},
    {"report", 0, "FILE.json", "the figures of every step as well"},
    {"json", 0, NULL, "print them instead of a summary"},
    TY_SCENE_OPTIONS,
};

const ty_command ty_command_loop = {
    "loop",
    "RECIPE -o OUT.####.exr",
    "cut the frames of a looping texture out of a volume",
    "tsuya loop scenes/loop_logo/mark.yaml -o out/logo.gif",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
