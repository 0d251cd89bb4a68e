// SPDX-License-Identifier: Apache-2.0
// Lists of frames and patterns of their names.
#include "frames.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>

enum
{
    MOST_FRAMES = 1000000,
    MOST_NUMBER = 10000000,
    MOST_DIGITS = 9
};

typedef struct range
{
    long first, last, step;
} range;

// A whole number with a sign; *text moves over it.
static bool take_number(const char** text, long* out)
{
    char* end;
    errno = 0;
    if (strspn(*text, "+-0123456789") == 0)
    {
        return false;
    }
    *out = strtol(*text, &end, 10);
    bool good = end != *text && !errno && *out >= -MOST_NUMBER && *out <= MOST_NUMBER;
    *text = end;
    return good;
}

// "A", "A-B" or "A-B:STEP" up to a comma or the end.
static bool take_range(const char** text, range* out)
{
    if (!take_number(text, &out->first))
    {
        return false;
    }
    out->last = out->first;
    out->step = 1;
    if (**text == '-')
    {
        ++*text;
        if (!take_number(text, &out->last))
        {
            return false;
        }
        if (**text == ':')
        {
            ++*text;
            if (!take_number(text, &out->step))
            {
                return false;
            }
        }
    }
    return **text == ',' || **text == '\0';
}

static int by_number(const void* a, const void* b)
{
    return *(const int*)a - *(const int*)b; // both within MOST_NUMBER
}

static ty_status add_range(const range* r, ty_frame_list* list, int* capacity, ty_error* error)
{
    if (r->last < r->first || r->step < 1)
    {
        return ty_error_set(error, TY_USAGE, "%ld-%ld:%ld: a range goes up, by steps of at least 1", r->first, r->last,
                            r->step);
    }
    long count = (r->last - r->first) / r->step + 1;
    if (list->count + count > MOST_FRAMES)
    {
        return ty_error_set(error, TY_USAGE, "more than %d frames", MOST_FRAMES);
    }
    while (list->count + count > *capacity)
    {
        *capacity = *capacity ? 2 * *capacity : 64;
        int* larger = TY_ALLOC(int, *capacity);
        if (list->count)
        {
            memcpy(larger, list->frames, (size_t)list->count * sizeof *larger);
        }
        ty_free(list->frames);
        list->frames = larger;
    }
    for (long i = 0; i < count; i++)
    {
        list->frames[list->count++] = (int)(r->first + i * r->step);
    }
    return TY_OK;
}

static void sort_unique(ty_frame_list* list)
{
    qsort(list->frames, (size_t)list->count, sizeof *list->frames, by_number);
    int kept = 0;
    for (int i = 0; i < list->count; i++)
    {
        if (kept == 0 || list->frames[kept - 1] != list->frames[i])
        {
            list->frames[kept++] = list->frames[i];
        }
    }
    list->count = kept;
}

ty_status ty_frame_list_parse(const char* text, int start, int end, ty_frame_list* out, ty_error* error)
{
    *out = (ty_frame_list){0};
    int capacity = 0;
    if (strcmp(text, "all") == 0)
    {
        return add_range(&(range){start, end, 1}, out, &capacity, error);
    }
    const char* next = text;
    ty_status status = TY_OK;
    do
    {
        range r;
        status = take_range(&next, &r)
                     ? add_range(&r, out, &capacity, error)
                     : ty_error_set(error, TY_USAGE, "'%.200s' is no list of frames like 1-24:2,40 (or all)", text);
    } while (status == TY_OK && *next++ == ',');
    if (status != TY_OK)
    {
        ty_frame_list_term(out);
        return status;
    }
    sort_unique(out);
    return TY_OK;
}

ty_status ty_frame_list_read(const ty_arguments* arguments, const ty_scene_options* options, ty_frame_list* out)
{
    ty_error error;
    const char* text = ty_argument_text(arguments, "frames", "");
    ty_timeline_def timeline = {0};
    if (strcmp(text, "all") == 0)
    {
        timeline = ty_scene_read_timeline(arguments->positional[0], options);
        timeline.end = timeline.end < timeline.start ? timeline.start : timeline.end; // a mistake that loading tells
    }
    if (ty_frame_list_parse(text, timeline.start, timeline.end, out, &error) != TY_OK)
    {
        return ty_usage(arguments->command, "--frames: %s", error.text);
    }
    return TY_OK;
}

void ty_frame_list_term(ty_frame_list* list)
{
    ty_free(list->frames);
    *list = (ty_frame_list){0};
}

void ty_frame_pattern(const char* text, char out[TY_PATH_MAX])
{
    snprintf(out, TY_PATH_MAX, "%s", text);
    const char* slash = strrchr(text, '/');
    const char* percent = strchr(slash ? slash : text, '%');
    if (!percent)
    {
        return;
    }
    const char* digits = percent + 1 + (percent[1] == '0');
    int width = *digits >= '1' && *digits <= '0' + MOST_DIGITS ? *digits - '0' : 1;
    const char* letter = digits + (*digits >= '1' && *digits <= '0' + MOST_DIGITS);
    if (*letter == 'd')
    {
        snprintf(out, TY_PATH_MAX, "%.*s%.*s%s", (int)(percent - text), text, width, "#########", letter + 1);
    }
}
