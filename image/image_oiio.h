// SPDX-License-Identifier: Apache-2.0
// The C face of OpenImageIO. No exception passes; every failure leaves a reason in text.
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C"
{
#endif

    typedef enum ty_oiio_result
    {
        TY_OIIO_OK,
        TY_OIIO_FAILED,
        TY_OIIO_NO_MEMORY,
    } ty_oiio_result;

    typedef struct ty_oiio_input ty_oiio_input; // opaque: an open file

    typedef struct ty_oiio_info
    {
        int width, height, channels;
        int bytes_per_channel; // in the file
        int is_float;
        int has_chromaticities;
        float chromaticities[8]; // rx ry gx gy bx by wx wy
        char color_space[64];
    } ty_oiio_info;

    // format is OpenImageIO's name of the reader ("png"); text holds text_size bytes. On failure *out is NULL.
    ty_oiio_result ty_oiio_open(const char* format, const char* path, ty_oiio_input** out, ty_oiio_info* info,
                                char* text, size_t text_size);
    // The first part at full resolution, interleaved; pixels has width * height * (end - begin) elements, of the
    // channels from begin to before end.
    ty_oiio_result ty_oiio_read(ty_oiio_input* input, int begin, int end, float* pixels, char* text, size_t text_size);
    const char* ty_oiio_channel_name(const ty_oiio_input* input, int channel); // until it is closed; "" = none
    void ty_oiio_close(ty_oiio_input* input);                                  // NULL is allowed

    typedef struct ty_oiio_output ty_oiio_output; // opaque: the bytes of a file

    // levels is uint8_t or uint16_t by bits (8, 16), interleaved. color_space may be "". The file is made in memory:
    // the library's PNG writer does not notice a full disk. On failure *out is NULL.
    ty_oiio_result ty_oiio_encode(const char* format, int width, int height, int channels, int bits, const void* levels,
                                  const char* color_space, ty_oiio_output** out, char* text, size_t text_size);
    const void* ty_oiio_output_bytes(const ty_oiio_output* output, size_t* size); // borrowed
    void ty_oiio_output_destroy(ty_oiio_output* output);                          // NULL is allowed

#ifdef __cplusplus
}
#endif
