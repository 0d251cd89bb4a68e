// SPDX-License-Identifier: Apache-2.0
// Packed pixels are the halves of the picture again, to the bit.
#include "base/cmocka_all.h"
#include <math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/half.h>
#include <tsuya/image/pack.h>
#include <zlib.h>

enum
{
    WIDTH = 37,
    HEIGHT = 11,
    COUNT = WIDTH * HEIGHT,
    SIZE = 6 * COUNT
};

static ty_image make_image(void)
{
    ty_image image = {.width = WIDTH, .height = HEIGHT, .channels = 3};
    image.pixels = TY_ALLOC(float, 3 * COUNT);
    for (int i = 0; i < 3 * COUNT; i++)
    {
        image.pixels[i] = (float)(i % 7 ? 1 : -1) * exp2f((float)(i * 37 % 40) - 20.0f) * (1.0f + (float)(i % 5));
    }
    return image;
}

static void test_round_trip(void** state)
{
    (void)state;
    ty_error error;
    ty_bytes packed;
    ty_image image = make_image();
    image.pixels[0] = NAN;
    image.pixels[1] = INFINITY;
    assert_int_equal(ty_pack_halves(&image, &packed, &error), TY_OK);
    static uint8_t bytes[SIZE + 1];
    uLongf size = sizeof bytes;
    assert_int_equal(uncompress(bytes, &size, packed.data, (uLong)packed.size), Z_OK);
    assert_int_equal(size, SIZE);
    for (int i = 1; i < SIZE; i++)
    {
        bytes[i] = (uint8_t)(bytes[i] + bytes[i - 1]);
    }
    for (int i = 0; i < 3 * COUNT; i++)
    {
        const uint8_t* plane = bytes + 2 * COUNT * (i % 3) + i / 3;
        int expected = i == 0 ? 0 : i == 1 ? 0x7bff : ty_half_from_float(image.pixels[i]);
        assert_int_equal(plane[0] << 8 | plane[COUNT], expected);
    }
    ty_bytes_term(&packed);
    ty_image_term(&image);
}

// Even pictures are small, and memory may run out.
static void test_size(void** state)
{
    (void)state;
    ty_error error;
    ty_bytes packed;
    ty_image image = make_image();
    for (int i = 0; i < 3 * COUNT; i++)
    {
        image.pixels[i] = (float)(i / 3 % WIDTH) / WIDTH;
    }
    assert_int_equal(ty_pack_halves(&image, &packed, &error), TY_OK);
    assert_true(packed.size < SIZE / 8);
    ty_bytes_term(&packed);
    for (int call = 0; call < 2; call++)
    {
        ty_memory_fail_after(call);
        assert_int_equal(ty_pack_halves(&image, &packed, &error), TY_NO_MEMORY);
        assert_null(packed.data);
    }
    ty_memory_fail_after(-1);
    ty_image_term(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_size)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
