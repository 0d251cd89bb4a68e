// SPDX-License-Identifier: Apache-2.0
// IEEE 754 binary16 from and to float in integer arithmetic: the same bits on every CPU and under flush-to-zero.
#pragma once
#include <stdint.h>
#include <string.h>

#define TY_HALF_MAX 65504.0f

// Round to nearest, ties to even. Finite values beyond the range become +-65504; infinities and NaN stay what they are.
uint16_t ty_half_from_float(float value);

// Exact. Denormal halves are built from normal floats only, so that flush-to-zero changes nothing.
static inline float ty_half_to_float(uint16_t half)
{
    uint32_t sign = (uint32_t)(half & 0x8000u) << 16;
    uint32_t exponent = (half >> 10) & 31u, mantissa = half & 0x3ffu, bits;
    float value;
    if (exponent == 0)
    {
        const float smallest = 0x1p-24f;
        value = (float)(int)mantissa * smallest;
        memcpy(&bits, &value, sizeof bits);
    }
    else if (exponent == 31)
        bits = 0x7f800000u | mantissa << 13;
    else
        bits = (exponent + 112u) << 23 | mantissa << 13;
    bits |= sign;
    memcpy(&value, &bits, sizeof value);
    return value;
}
