// SPDX-License-Identifier: Apache-2.0
// XXH3-128 through libxxhash.
#include "exhaustion.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/status.h>
#include <xxhash.h>

// A ty_hasher is the library's own state: its size is the library's business.
static XXH3_state_t* state_of(ty_hasher* hasher)
{
    return (XXH3_state_t*)hasher;
}

static ty_hash hash_from(XXH128_hash_t hash)
{
    return (ty_hash){hash.low64, hash.high64};
}

ty_hasher* ty_hasher_create(void)
{
    XXH3_state_t* state = XXH3_createState();
    if (!state)
        ty_memory_exhausted(1, 576);
    TY_ASSERT(XXH3_128bits_reset(state) == XXH_OK);
    return (ty_hasher*)state;
}

void ty_hasher_add(ty_hasher* hasher, const void* bytes, size_t size)
{
    if (size > 0)
        TY_ASSERT(XXH3_128bits_update(state_of(hasher), bytes, size) == XXH_OK);
}

void ty_hasher_add_string(ty_hasher* hasher, const char* text)
{
    size_t length = strlen(text);
    uint8_t prefix[8];
    for (int i = 0; i < 8; i++)
        prefix[i] = (uint8_t)((uint64_t)length >> (8 * i));
    ty_hasher_add(hasher, prefix, sizeof(prefix));
    ty_hasher_add(hasher, text, length);
}

ty_hash ty_hasher_end(ty_hasher* hasher)
{
    ty_hash hash = hash_from(XXH3_128bits_digest(state_of(hasher)));
    ty_hasher_destroy(hasher);
    return hash;
}

void ty_hasher_destroy(ty_hasher* hasher)
{
    XXH3_freeState(state_of(hasher));
}

ty_hash ty_hash_bytes(const void* bytes, size_t size)
{
    return hash_from(XXH3_128bits(bytes, size));
}

void ty_hash_hex(ty_hash hash, char hex[33])
{
    snprintf(hex, 33, "%016llx%016llx", (unsigned long long)hash.high, (unsigned long long)hash.low);
}
