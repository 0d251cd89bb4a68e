// SPDX-License-Identifier: Apache-2.0
// Fuzz target: the EXR reader on any bytes; what it accepts must be whole.
#include <stdlib.h>
#include <tsuya/image/exr.h>

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    ty_exr* exr = NULL;
    ty_error error;
    if (ty_exr_read_memory("fuzz.exr", bytes, size, &exr, &error) != TY_OK)
    {
        if (exr || !error.text[0])
            abort();
        return 0;
    }
    if (exr->channel_count < 1 || ty_exr_width(exr) < 1 || ty_exr_height(exr) < 1)
        abort();
    size_t count = (size_t)ty_exr_width(exr) * (size_t)ty_exr_height(exr);
    uint32_t sum = 0;
    for (int i = 0; i < exr->channel_count; i++)
        for (size_t k = 0; k < count; k++)
            sum += ((const uint32_t*)exr->channels[i].pixels)[k];
    volatile uint32_t keep = sum;
    (void)keep;
    ty_exr_destroy(exr);
    return 0;
}
