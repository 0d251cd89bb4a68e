// SPDX-License-Identifier: Apache-2.0
// Numbered files: patterns such as fill.####.exr.
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>

// The last run of '#' in the file's own name; NULL if none.
static const char* run_find(const char* path, int* width)
{
    const char *slash = strrchr(path, '/'), *last = strrchr(path, '#');
    if (!last || (slash && last < slash))
        return NULL;
    const char* first = last;
    while (first > path && first[-1] == '#')
        --first;
    *width = (int)(last - first) + 1;
    return first;
}

bool ty_path_is_sequence(const char* path)
{
    int width;
    return run_find(path, &width) != NULL;
}

void ty_path_frame(const char* pattern, int frame, char out[TY_PATH_MAX])
{
    int width = 0, size;
    const char* run = run_find(pattern, &width);
    if (run)
        size = snprintf(out, TY_PATH_MAX, "%.*s%0*d%s", (int)(run - pattern), pattern, width, frame, run + width);
    else
        size = snprintf(out, TY_PATH_MAX, "%s", pattern);
    if (size < 0 || size >= TY_PATH_MAX)
        out[0] = 0;
}

enum
{
    MAX_FRAMES = 1 << 20,
};

// The number in a file's name, if ty_path_frame gives that very name for it: fill.7.exr is no frame of fill.####.exr.
static bool frame_of(const char* pattern, const char* name, int* frame)
{
    char expected[TY_PATH_MAX];
    int width = 0;
    const char* run = run_find(pattern, &width);
    if (strncmp(name, pattern, (size_t)(run - pattern)) != 0)
        return false;
    errno = 0;
    long number = strtol(name + (run - pattern), NULL, 10);
    if (errno || number < -999999999 || number > 999999999)
        return false;
    ty_path_frame(pattern, (int)number, expected);
    *frame = (int)number;
    return strcmp(expected, name) == 0;
}

static int by_number(const void* a, const void* b)
{
    int x = *(const int*)a, y = *(const int*)b;
    return (x > y) - (x < y);
}

static void add_number(ty_frame_numbers* frames, int* capacity, int number)
{
    if (frames->count == *capacity)
    {
        *capacity = *capacity ? 2 * *capacity : 64;
        frames->numbers = ty_grow(frames->numbers, (size_t)frames->count, (size_t)*capacity, sizeof(*frames->numbers));
    }
    frames->numbers[frames->count++] = number;
}

ty_status ty_frame_numbers_find(const char* pattern, ty_frame_numbers* out, ty_error* error)
{
    char folder[TY_PATH_MAX], path[TY_PATH_MAX];
    const char *slash = strrchr(pattern, '/'), *name = slash ? slash + 1 : pattern;
    int number, capacity = 0;
    *out = (ty_frame_numbers){0};
    TY_ASSERT(ty_path_is_sequence(pattern));
    ty_path_folder(pattern, folder);
    DIR* listing = opendir(folder);
    if (!listing)
        return ty_error_set_at(error, TY_BAD_FILE, pattern, 0, 0, "no frames: cannot read the folder: %s",
                               strerror(errno));
    for (struct dirent* entry = readdir(listing); entry && out->count < MAX_FRAMES; entry = readdir(listing))
    {
        if (!frame_of(name, entry->d_name, &number))
            continue;
        ty_path_frame(pattern, number, path);
        if (ty_file_exists(path))
            add_number(out, &capacity, number);
    }
    closedir(listing);
    if (out->count == 0)
        return ty_error_set_at(error, TY_BAD_FILE, pattern, 0, 0, "a sequence without frames: no file fits the name");
    qsort(out->numbers, (size_t)out->count, sizeof(*out->numbers), by_number);
    return TY_OK;
}

void ty_frame_numbers_term(ty_frame_numbers* frames)
{
    ty_free(frames->numbers);
    *frames = (ty_frame_numbers){0};
}

// Appends "7" or "12-14"; false when it does not fit beside the "..." that then ends the text.
static bool append_range(char* text, size_t size, int first, int last)
{
    char range[32];
    size_t used = strlen(text);
    int length = first == last ? snprintf(range, sizeof range, "%s%d", used ? ", " : "", first)
                               : snprintf(range, sizeof range, "%s%d-%d", used ? ", " : "", first, last);
    bool fits = used + (size_t)length + sizeof(", ...") <= size;
    snprintf(text + used, size - used, "%s", fits ? range : used ? ", ..." : "...");
    return fits;
}

int ty_frame_numbers_missing(const ty_frame_numbers* frames, int first, int last, char* text, size_t size)
{
    int missing = 0, expected = first;
    bool room = true;
    text[0] = 0;
    for (int i = 0; i <= frames->count; ++i)
    {
        int present = i < frames->count ? frames->numbers[i] : last + 1;
        if (present < expected)
            continue;
        int end = present <= last ? present - 1 : last;
        if (end >= expected)
        {
            missing += end - expected + 1;
            room = room && append_range(text, size, expected, end);
        }
        if (present >= last)
            break;
        expected = present + 1;
    }
    return missing;
}

void ty_frame_numbers_text(const ty_frame_numbers* frames, char* text, size_t size)
{
    bool room = true;
    text[0] = 0;
    for (int i = 0, end; i < frames->count && room; i = end)
    {
        for (end = i + 1; end < frames->count && frames->numbers[end] == frames->numbers[end - 1] + 1;)
            ++end;
        room = append_range(text, size, frames->numbers[i], frames->numbers[end - 1]);
    }
}
