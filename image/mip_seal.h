// SPDX-License-Identifier: Apache-2.0
// What converted files end in: their size and hash, by which a file that was cut off or changed is known.
#pragma once
#include <tsuya/base/hash.h>
#include <tsuya/base/status.h>

// Adds the first bytes of a file, at most size of them.
TY_CHECKED ty_status ty_file_hash(const char* path, uint64_t size, ty_hasher* hasher, ty_error* error);

// Appends the seal to a complete file. Image readers do not look behind the last tile.
TY_CHECKED ty_status ty_mip_seal(const char* path, ty_error* error);
// Reads the file to its end: whether it is as it was sealed.
bool ty_mip_is_sealed(const char* path);
