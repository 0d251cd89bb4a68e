// SPDX-License-Identifier: Apache-2.0
// Lets each checked allocation of a call fail in turn.
#pragma once
#include <tsuya/base/memory.h>

// Runs the call once, frees what it made, and returns its status.
typedef ty_status ty_sweep_fn(void* context);

// Fails the 0th, 1st, 2nd ... ty_try_ call of fn until fn gets through. Returns how many calls were made to fail;
// -1 when fn answered a failed allocation with anything but TY_NO_MEMORY, or did not get through in the end.
static inline int ty_alloc_sweep(ty_sweep_fn* fn, void* context)
{
    for (int i = 0; i < 10000; i++)
    {
        ty_memory_fail_after(i);
        ty_status status = fn(context);
        ty_memory_fail_after(-1);
        if (status == TY_OK)
            return i;
        if (status != TY_NO_MEMORY)
            return -1;
    }
    return -1;
}
