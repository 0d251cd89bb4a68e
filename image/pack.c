// SPDX-License-Identifier: Apache-2.0
// Halves by planes of bytes and differences, as EXR's ZIP has them, deflated.
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/half.h>
#include <tsuya/image/pack.h>
#include <zlib.h>

enum
{
    LEVEL = 6
};

static uint8_t* take_planes(const ty_image* image, size_t size)
{
    uint8_t* bytes = TY_TRY_ALLOC(uint8_t, size);
    size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    for (size_t i = 0; bytes && i < count * channels; i++)
    {
        float value = image->pixels[i];
        uint16_t half = value == value ? ty_half_from_float(ty_clamp(value, -TY_HALF_MAX, TY_HALF_MAX)) : 0;
        uint8_t* plane = bytes + 2 * count * (i % channels) + i / channels;
        plane[0] = (uint8_t)(half >> 8);
        plane[count] = (uint8_t)(half & 0xffu);
    }
    for (size_t i = size; bytes && i-- > 1;)
    {
        bytes[i] = (uint8_t)(bytes[i] - bytes[i - 1]);
    }
    return bytes;
}

ty_status ty_pack_halves(const ty_image* image, ty_bytes* out, ty_error* error)
{
    size_t size = 2 * (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    *out = (ty_bytes){0};
    uint8_t* bytes = take_planes(image, size);
    uLongf packed = compressBound((uLong)size);
    uint8_t* data = bytes ? TY_TRY_ALLOC(uint8_t, packed + 1) : NULL;
    if (!data)
    {
        ty_free(bytes);
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory to pack a picture");
    }
    int result = compress2(data, &packed, bytes, (uLong)size, LEVEL);
    ty_free(bytes);
    if (result != Z_OK)
    {
        ty_free(data);
        return ty_error_set(error, result == Z_MEM_ERROR ? TY_NO_MEMORY : TY_INTERNAL, "zlib: error %d", result);
    }
    data[packed] = 0;
    *out = (ty_bytes){data, packed};
    return TY_OK;
}
