// SPDX-License-Identifier: Apache-2.0
// Whether sequences and keys reach over the frames that will be asked for: known before the first is rendered.
#include "loader.h"
#include <tsuya/image/mip_texture.h>

typedef bool covers_fn(const ty_loader* loader, const void* what, int frame);

typedef struct shown_sequence
{
    const ty_mip_texture_def* timing;
    int frame_count;
} shown_sequence;

static double seconds_at(const ty_loader* loader, int frame)
{
    const ty_timeline_def* timeline = &loader->scene->timeline;
    return (frame - timeline->start) / (double)timeline->fps;
}

static bool sequence_covers(const ty_loader* loader, const void* what, int frame)
{
    const shown_sequence* sequence = what;
    int shown[2];
    float weight;
    return ty_sequence_at(sequence->timing, sequence->frame_count, seconds_at(loader, frame), shown, &weight);
}

static bool track_covers(const ty_loader* loader, const void* what, int frame)
{
    (void)loader;
    return ty_track_covers(what, frame);
}

// How many of the frames asked for are not covered; the first few of them as a text.
static int find_outside(const ty_loader* loader, covers_fn* covers, const void* what, char* text, size_t size)
{
    const ty_scene_options* options = loader->options;
    ty_frame_numbers outside = {.numbers = TY_ALLOC(int, options->frame_count)};
    for (int i = 0; i < options->frame_count; ++i)
        if (!covers(loader, what, options->frames[i]))
            outside.numbers[outside.count++] = options->frames[i];
    int count = outside.count;
    ty_frame_numbers_text(&outside, text, size);
    ty_frame_numbers_term(&outside);
    return count;
}

// The first and the last frame of the timeline stand for all between them.
static void check_timeline(ty_loader* loader, const shown_sequence* sequence, double begin, double end, ty_place place)
{
    const int frames[2] = {loader->scene->timeline.start, loader->scene->timeline.end};
    for (int i = 0; i < 2; ++i)
    {
        if (sequence_covers(loader, sequence, frames[i]))
            continue;
        ty_report(
            loader->errors, place, TY_BAD_INPUT,
            "frame %d of the timeline, at %g s, is outside of the sequence's %g to %g s: say loop, hold or mirror",
            frames[i], seconds_at(loader, frames[i]), begin, end);
        return;
    }
}

void ty_check_sequence_covers(ty_loader* loader, const ty_mip_texture_def* timing, int frame_count, ty_place place)
{
    const shown_sequence sequence = {timing, frame_count};
    double begin = (double)timing->start, end = begin + frame_count / (double)timing->fps;
    if (loader->options->frame_count == 0)
    {
        check_timeline(loader, &sequence, begin, end, place);
        return;
    }
    char text[400];
    int count = find_outside(loader, sequence_covers, &sequence, text, sizeof text);
    if (count > 0)
        ty_report(loader->errors, place, TY_BAD_INPUT,
                  "%d of the %d frames are outside of the sequence's %g to %g s: %s; say loop, hold or mirror", count,
                  loader->options->frame_count, begin, end, text);
}

void ty_check_keys_cover(ty_loader* loader)
{
    char text[400];
    for (int i = 0; i < loader->timeline.track_count && loader->options->frame_count > 0; ++i)
    {
        const ty_track* track = &loader->timeline.tracks[i];
        if (track->before != TY_OUTSIDE_ERROR && track->after != TY_OUTSIDE_ERROR)
            continue;
        int count = find_outside(loader, track_covers, track, text, sizeof text);
        if (count > 0)
            ty_report(loader->errors, track->keyed->place, TY_BAD_INPUT,
                      "%d of the %d frames are outside of the keys, which go from %.9g to %.9g: %s", count,
                      loader->options->frame_count, track->times[0], track->times[track->key_count - 1], text);
    }
}
