// SPDX-License-Identifier: Apache-2.0
// Numbered files: patterns such as fill.####.exr.
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>

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
