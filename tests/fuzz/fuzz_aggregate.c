// SPDX-License-Identifier: Apache-2.0
// Any bytes as the JSON of an aggregate file, around a BIN chunk of 4 KiB: what is checked before the importer runs.
#include <string.h>
#include <tsuya/geometry/aggregate.h>

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    const size_t bin_size = 4096, json_size = (size + 3) & ~(size_t)3, total = 28 + json_size + bin_size;
    const uint32_t head[5] = {0x46546c67u, 2, (uint32_t)total, (uint32_t)json_size, 0x4e4f534au};
    const uint32_t tail[2] = {(uint32_t)bin_size, 0x004e4942u};
    uint8_t* file = ty_alloc(total, 1);
    memcpy(file, head, sizeof head);
    memset(file + 20, ' ', json_size);
    if (size)
        memcpy(file + 20, bytes, size);
    memcpy(file + 20 + json_size, tail, sizeof tail);
    ty_error error;
    ty_status status = ty_aggregate_check("fuzz.glb", file, total, &error);
    TY_ASSERT(status == TY_OK || status == TY_BAD_FILE);
    ty_bytes state;
    status = ty_aggregate_find_state("fuzz.glb", file, total, &state, &error);
    TY_ASSERT(status == TY_OK ? state.size <= bin_size : status == TY_BAD_FILE);
    ty_bytes_term(&state);
    ty_free(file);
    return 0;
}
