// SPDX-License-Identifier: Apache-2.0
// A folder of its own for a test's files, and the fixtures beside the sources.
#pragma once
#include "base/own_folder.h"

// A file of the fixtures.
static inline const char* fixture(const char* name)
{
    static char path[1024];
    snprintf(path, sizeof path, FIXTURES "/%s", name);
    return path;
}
