// SPDX-License-Identifier: Apache-2.0
// `tsuya turntable`: a scene all round, as frames that close into a loop.
#include "render_job.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_FRAMES = 100000,
    FRAMES = 48,
    MOST_NUMBER = 10000000, // of a frame
};

// "x,y,z" to an override that lists them; the table reads the numbers.
static ty_status read_point(const ty_arguments* arguments, const char* name, ty_scene_arguments* scene)
{
    const char* text = ty_argument_text(arguments, name, NULL);
    int commas = 0;
    for (const char* c = text; c && *c; c++)
    {
        commas += *c == ',';
    }
    if (!text)
    {
        return TY_OK;
    }
    if (commas != 2 || strlen(text) > 60 || strspn(text, "+-.0123456789eE, ") != strlen(text))
    {
        return ty_usage(arguments->command, "--%s: '%s' is not x,y,z", name, text);
    }
    ty_scene_arguments_set(scene, "turntable.%s=[%s]", name, text);
    return TY_OK;
}

// The turn is keyed in the scene, so that the recipe of every frame tells it. The last key is the moment of the first:
// the frame after the last is the first, and not among the frames.
static ty_status set_turn(const ty_arguments* arguments, ty_scene_arguments* scene, int start, int count)
{
    const char* turn = ty_argument_text(arguments, "turn", "camera");
    if (strcmp(turn, "camera") != 0 && strcmp(turn, "objects") != 0)
    {
        return ty_usage(arguments->command, "--turn: '%s' is neither camera nor objects", turn);
    }
    ty_status status = read_point(arguments, "about", scene);
    status = status == TY_OK ? read_point(arguments, "axis", scene) : status;
    if (status == TY_OK)
    {
        ty_scene_arguments_set(scene, "turntable.turn=%s", turn);
        ty_scene_arguments_set(scene, "turntable.angle={ keys: { %d: 0, %d: %d }, after: loop }", start, start + count,
                               ty_argument_has(arguments, "clockwise") ? -360 : 360);
    }
    return status;
}

// The turn begins with the scene's time.
static ty_status find_start(const ty_arguments* arguments, const ty_scene_arguments* scene, int count, int* start)
{
    ty_timeline_def timeline = ty_scene_read_timeline(arguments->positional[0], &scene->options);
    *start = timeline.start;
    if (timeline.start > MOST_NUMBER - count)
    {
        return ty_usage(arguments->command, "%d frames from the timeline's %d on go beyond %d", count, timeline.start,
                        MOST_NUMBER);
    }
    return TY_OK;
}

static ty_status run(const ty_arguments* arguments)
{
    static ty_scene_arguments scene_arguments;
    long count = FRAMES;
    ty_status status = TY_OK;
    if (ty_argument_has(arguments, "frames"))
    {
        status = ty_argument_int(arguments, "frames", 1, MOST_FRAMES, &count);
    }
    status = status == TY_OK ? ty_scene_arguments_read(arguments, &scene_arguments) : status;
    int start = 1;
    status = status == TY_OK ? find_start(arguments, &scene_arguments, (int)count, &start) : status;
    status = status == TY_OK ? set_turn(arguments, &scene_arguments, start, (int)count) : status;
    if (status != TY_OK)
    {
        ty_scene_arguments_term(&scene_arguments);
        return status;
    }
    ty_frame_list list = {.frames = TY_ALLOC(int, count), .count = (int)count};
    for (int i = 0; i < list.count; i++)
    {
        list.frames[i] = start + i;
    }
    status = ty_render_run(arguments, &scene_arguments, list);
    ty_scene_arguments_term(&scene_arguments);
    return status;
}

static const ty_option options[] = {
    {"frames", 'f', "N", "frames of a whole turn (default 48), numbered from the scene's timeline.start"},
    {"turn", 0, "WHAT", "camera (default): it goes round; objects: they turn under camera and lights"},
    {"about", 0, "x,y,z", "a point on the axis (default: what the camera looks at)"},
    {"axis", 0, "x,y,z", "direction of the axis (default: up, 0,1,0)"},
    {"clockwise", 0, NULL, "seen from above; else counter-clockwise"},
    TY_RENDER_OPTIONS,
};

const ty_command ty_command_turntable = {
    "turntable",
    "SCENE [--frames N] [options]",
    "render a scene all round, as a loop of frames",
    "tsuya turntable scenes/rice_bowl --frames 96 -o out/turn.####.exr --video out/turn.mp4",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
