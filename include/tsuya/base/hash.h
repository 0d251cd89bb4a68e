// SPDX-License-Identifier: Apache-2.0
// 128-bit content hashes (XXH3) for cache keys and scene identity.
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct ty_hash
{
    uint64_t low, high;
} ty_hash;

typedef struct ty_hasher ty_hasher; // opaque stream

ty_hasher* ty_hasher_create(void);
void ty_hasher_add(ty_hasher* hasher, const void* bytes, size_t size);
void ty_hasher_add_string(ty_hasher* hasher, const char* text); // length first, so that "a","bc" differs from "ab","c"
ty_hash ty_hasher_end(ty_hasher* hasher);                       // also destroys the hasher
void ty_hasher_destroy(ty_hasher* hasher);                      // to give up; NULL is allowed

ty_hash ty_hash_bytes(const void* bytes, size_t size);
void ty_hash_hex(ty_hash hash, char hex[33]); // 32 digits and the end
