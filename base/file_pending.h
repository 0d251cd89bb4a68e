// SPDX-License-Identifier: Apache-2.0
// Temporaries that a signal's exit path removes: files, and folders with the files in them.
#pragma once

// To be called before path is made: a signal in between finds it. -1 when too many are pending. Copies path, which is
// shorter than TY_PATH_MAX.
int pending_add(const char* path);
void pending_drop(int slot); // -1 is allowed
