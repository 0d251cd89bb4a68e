// SPDX-License-Identifier: Apache-2.0
// Any bytes as a GLB container.
#include <tsuya/geometry/aggregate.h>

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    ty_error error;
    ty_status status = ty_glb_check("fuzz.glb", bytes, size, &error);
    TY_ASSERT(status == TY_OK || status == TY_BAD_FILE);
    return 0;
}
