// SPDX-License-Identifier: Apache-2.0
// Float to half with round-to-nearest-even and saturation.
#include <tsuya/image/half.h>

// Drops the low `shift` bits (1..24) of value, ties to even.
static uint32_t round_shift(uint32_t value, uint32_t shift)
{
    uint32_t half = 1u << (shift - 1), kept = value >> shift, rest = value & ((1u << shift) - 1u);
    return kept + (rest > half || (rest == half && (kept & 1u)));
}

uint16_t ty_half_from_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu, exponent = magnitude >> 23;
    uint32_t half;
    if (magnitude > 0x7f800000u)
        half = 0x7e00u | ((magnitude >> 13) & 0x1ffu); // a quiet NaN with the leading payload bits
    else if (magnitude == 0x7f800000u)
        half = 0x7c00u;
    else if (exponent < 102) // below half of the smallest denormal, 2^-25
        half = 0;
    else if (exponent < 113)
        half = round_shift((magnitude & 0x7fffffu) | 0x800000u, 126u - exponent);
    else
    {
        half = round_shift(magnitude - (112u << 23), 13);
        if (half > 0x7bffu)
            half = 0x7bffu;
    }
    return (uint16_t)(sign | half);
}
