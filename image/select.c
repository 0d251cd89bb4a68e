// SPDX-License-Identifier: Apache-2.0
// Quickselect with a median of three as pivot.
#include "select.h"
#include <tsuya/base/math.h>

static float median_of_three(float a, float b, float c)
{
    return ty_max(ty_min(a, b), ty_min(ty_max(a, b), c));
}

float ty_select(float* values, int64_t count, int64_t k)
{
    int64_t low = 0, high = count - 1;
    while (low < high)
    {
        float pivot = median_of_three(values[low], values[low + (high - low) / 2], values[high]);
        int64_t i = low, j = high;
        while (i <= j)
        {
            while (values[i] < pivot)
                i++;
            while (values[j] > pivot)
                j--;
            if (i > j)
                break;
            float kept = values[i];
            values[i++] = values[j];
            values[j--] = kept;
        }
        if (k <= j)
            high = j;
        else if (k >= i)
            low = i;
        else
            break;
    }
    return values[k];
}
