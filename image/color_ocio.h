// SPDX-License-Identifier: Apache-2.0
// The C face of OpenColorIO. No exception passes; every failure leaves a reason in text.
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C"
{
#endif

    typedef enum ty_ocio_result
    {
        TY_OCIO_OK,
        TY_OCIO_FAILED,
        TY_OCIO_NO_MEMORY,
    } ty_ocio_result;

    typedef struct ty_ocio ty_ocio; // opaque: a configuration; any thread may use it

    // path NULL = the configuration is the YAML in embedded.
    ty_ocio_result ty_ocio_load(const char* path, const char* embedded, ty_ocio** out, char* text, size_t text_size);
    void ty_ocio_close(ty_ocio* ocio); // NULL is allowed

    // Differs between configurations that may convert differently; the files they refer to are part of it. Lives as
    // long as the configuration.
    const char* ty_ocio_identity(const ty_ocio* ocio);

    // Whether name is a colour space, an alias or a role.
    int ty_ocio_knows(const ty_ocio* ocio, const char* name);

    // Names by number, NULL past the last; they live as long as the configuration. Colour spaces first, then their
    // aliases.
    const char* ty_ocio_space(const ty_ocio* ocio, int index);
    const char* ty_ocio_display(const ty_ocio* ocio, int index);                   // the default first
    const char* ty_ocio_view(const ty_ocio* ocio, const char* display, int index); // the default first

    // In place. channels 3 or 4.
    ty_ocio_result ty_ocio_convert(const ty_ocio* ocio, const char* from, const char* to, float* pixels,
                                   long pixel_count, int channels, char* text, size_t text_size);
    ty_ocio_result ty_ocio_develop(const ty_ocio* ocio, const char* from, const char* display, const char* view,
                                   float* pixels, long pixel_count, int channels, char* text, size_t text_size);

#ifdef __cplusplus
}
#endif
