// SPDX-License-Identifier: Apache-2.0
// The value of a track at a moment, and its text in the tree.
#include "timeline.h"
#include <stdio.h>
#include <string.h>

// What lies outside the keys comes back to where it stands for. False: it goes on by the slope of that end.
static bool wrap(const ty_track* track, ty_moment moment, double* time)
{
    double first = track->times[0], last = track->times[track->key_count - 1], period = last - first;
    double frame = moment.frame, at = frame + moment.offset;
    bool loops = (at >= last && track->after == TY_OUTSIDE_LOOP) || (at < first && track->before == TY_OUTSIDE_LOOP);
    if (loops && period > 0.0)
    {
        double past = fmod(frame - first, period);
        at = first + (past < 0.0 ? past + period : past) + moment.offset;
        at = at >= last ? at - period : at < first ? at + period : at;
    }
    ty_outside outside = at < first ? track->before : track->after;
    *time = at;
    if ((at >= first && at <= last) || period <= 0.0)
        return true;
    if (outside == TY_OUTSIDE_CONTINUE)
        return false;
    double past = fmod(fabs(at - first), 2.0 * period);
    if (outside == TY_OUTSIDE_MIRROR)
        *time = first + (past > period ? 2.0 * period - past : past);
    return true;
}

// Slope of the curve at an end, for what goes on beyond it.
static double end_slope(const ty_track* track, int component, bool after)
{
    int n = track->components, i = after ? track->key_count - 2 : 0;
    const double *t = track->times + i, *v = track->values + (ptrdiff_t)i * n + component;
    if (track->interpolation == TY_INTERPOLATE_SMOOTH)
        return track->slopes[(ptrdiff_t)(after ? i + 1 : i) * n + component];
    return track->interpolation == TY_INTERPOLATE_LINEAR ? (v[n] - v[0]) / (t[1] - t[0]) : 0.0;
}

// Between keys i and i + 1, at the share s of the way.
static double between(const ty_track* track, int i, int component, double s)
{
    int n = track->components;
    const double* v = track->values + (ptrdiff_t)i * n + component;
    double rise = v[n] - v[0], width = track->times[i + 1] - track->times[i];
    const double* m = track->slopes + (ptrdiff_t)i * n + component;
    switch (track->interpolation)
    {
    case TY_INTERPOLATE_HOLD:
        return s < 1.0 ? v[0] : v[n];
    case TY_INTERPOLATE_EASE:
        return v[0] + rise * (s * s * (3.0 - 2.0 * s));
    case TY_INTERPOLATE_SMOOTH: // cubic Hermite
        return v[0] + rise * (s * s * (3.0 - 2.0 * s)) + width * s * (1.0 - s) * (m[0] * (1.0 - s) - m[n] * s);
    case TY_INTERPOLATE_LINEAR:
        break;
    }
    return v[0] + rise * s;
}

// The last key that is not after time; the first if all are.
static int key_before(const ty_track* track, double time)
{
    int low = 0, high = track->key_count; // times[low] <= time < times[high]
    while (high - low > 1)
    {
        int middle = (low + high) / 2;
        *(track->times[middle] <= time ? &low : &high) = middle;
    }
    return low;
}

double ty_track_value(const ty_track* track, int component, ty_moment moment)
{
    double time = 0.0;
    int last = track->key_count - 1;
    const double* values = track->values + component;
    if (!wrap(track, moment, &time))
    {
        bool after = time > track->times[last];
        int key = after ? last : 0;
        return values[(ptrdiff_t)key * track->components] +
               end_slope(track, component, after) * (time - track->times[key]);
    }
    if (time <= track->times[0])
        return values[0];
    if (time >= track->times[last])
        return values[(ptrdiff_t)last * track->components];
    int low = key_before(track, time), high = low + 1;
    if (!(time > track->times[low]))
        return values[(ptrdiff_t)low * track->components];
    return between(track, low, component, (time - track->times[low]) / (track->times[high] - track->times[low]));
}

bool ty_track_covers(const ty_track* track, double frame)
{
    ty_outside outside = frame < track->times[0]                      ? track->before
                         : frame > track->times[track->key_count - 1] ? track->after
                                                                      : TY_OUTSIDE_HOLD;
    return outside != TY_OUTSIDE_ERROR;
}

static void check_outside(const ty_track* track, ty_moment moment, ty_error_list* errors)
{
    double at = moment.frame, first = track->times[0], last = track->times[track->key_count - 1];
    bool early = at < first;
    if (!ty_track_covers(track, at))
        ty_report(errors, track->keyed->place, TY_BAD_INPUT, "frame %.9g is %s key, frame %.9g (%s: error)", at,
                  early ? "ahead of the first" : "after the last", early ? first : last, early ? "before" : "after");
}

static bool write_text(ty_node* node, const ty_track* track, double value)
{
    char text[TY_TRACK_TEXT];
    if (track->is_word)
        snprintf(text, sizeof text, "%s", value > 0.5 ? "true" : "false");
    else
        snprintf(text, sizeof text, "%.17g", value);
    if (strcmp(text, node->text) == 0)
        return false;
    memcpy((char*)node->text, text, sizeof text); // its buffer, made with the track
    return true;
}

static bool evaluate(ty_track* track, ty_moment moment)
{
    bool changed = false;
    ty_place place = track->keyed_at[key_before(track, moment.frame + moment.offset)];
    for (int c = 0; c < track->components; ++c)
    {
        ty_node* node = track->is_list ? track->value->items[c] : track->value;
        changed |= write_text(node, track, ty_track_value(track, c, moment));
        node->place = place;
    }
    track->value->place = place;
    return changed;
}

void ty_timeline_evaluate(ty_timeline* timeline, int entry, ty_moment moment, ty_error_list* errors)
{
    ty_animated* animated = &timeline->entries[entry];
    for (int i = 0; i < animated->track_count; ++i)
    {
        ty_track* track = &timeline->tracks[animated->first_track + i];
        if (errors)
            check_outside(track, moment, errors);
        animated->changed |= evaluate(track, moment);
    }
}

void ty_timeline_show_keys(ty_timeline* timeline, bool keys)
{
    for (int i = 0; i < timeline->track_count; ++i)
    {
        ty_track* track = &timeline->tracks[i];
        if (keys)
            track->standing = *track->slot;
        *track->slot = keys ? track->keyed : track->standing;
    }
}

int ty_timeline_find(const ty_timeline* timeline, ty_section_kind section, int index)
{
    for (int i = 0; i < timeline->entry_count; ++i)
        if (timeline->entries[i].section == section && timeline->entries[i].index == index)
            return i;
    return -1;
}
