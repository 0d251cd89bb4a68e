// SPDX-License-Identifier: Apache-2.0
// A folder of its own for a test's files: removed with all of them.
#pragma once
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char test_folder[64];

static inline int folder_setup(void** state)
{
    (void)state;
    strcpy(test_folder, "test_XXXXXX");
    return mkdtemp(test_folder) ? 0 : -1;
}

// The number of files in the folder; with remove also removes them.
static inline int folder_count(int remove_them)
{
    int count = 0;
    DIR* folder = opendir(test_folder);
    for (struct dirent* entry; folder && (entry = readdir(folder));)
    {
        char path[400];
        snprintf(path, sizeof path, "%s/%s", test_folder, entry->d_name);
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        count++;
        if (remove_them)
            unlink(path);
    }
    if (folder)
        closedir(folder);
    return count;
}

static inline int folder_teardown(void** state)
{
    (void)state;
    folder_count(1);
    return rmdir(test_folder);
}

// A path in the folder; valid until the fourth call from now.
static inline const char* in_folder(const char* name)
{
    static char paths[4][200];
    static int next;
    char* path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", test_folder, name);
    return path;
}
