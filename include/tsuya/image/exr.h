// SPDX-License-Identifier: Apache-2.0
// EXR files through OpenEXRCore: single part, scanline, planar channels, typed attributes.
#pragma once
#include <stdint.h>
#include <tsuya/base/memory.h>

typedef enum ty_exr_type
{
    TY_EXR_UINT,  // pixels are uint32_t
    TY_EXR_HALF,  // pixels in memory are float, half in the file
    TY_EXR_FLOAT, // pixels are float
} ty_exr_type;

typedef struct ty_exr_channel
{
    char name[64];
    ty_exr_type type;
    void* pixels; // row-major [height][width] of the data window, float or uint32_t
} ty_exr_channel;

typedef enum ty_exr_attribute_type
{
    TY_EXR_STRING,
    TY_EXR_FLOAT1,
    TY_EXR_INT1,
    TY_EXR_MATRIX44,       // value[16], row-major as EXR's m44f
    TY_EXR_CHROMATICITIES, // value[8]: rx ry gx gy bx by wx wy
    TY_EXR_RATIONAL,       // integer[0] / integer[1]
    TY_EXR_ENVMAP,         // integer[0]: 0 = latitude and longitude, 1 = cube
} ty_exr_attribute_type;

typedef struct ty_exr_attribute
{
    char name[64];
    ty_exr_attribute_type type;
    char* text; // STRING, of any length
    float value[16];
    int integer[2];
} ty_exr_attribute;

// Windows are inclusive {x0, y0, x1, y1}, y down. Owns pixels and texts when it comes from ty_exr_read or the add
// calls.
typedef struct ty_exr
{
    int data_window[4];
    int display_window[4];
    ty_exr_channel* channels;
    int channel_count;
    ty_exr_attribute* attributes;
    int attribute_count;
} ty_exr;

static inline int ty_exr_width(const ty_exr* exr)
{
    return exr->data_window[2] - exr->data_window[0] + 1;
}
static inline int ty_exr_height(const ty_exr* exr)
{
    return exr->data_window[3] - exr->data_window[1] + 1;
}

// An image without channels; freed with ty_exr_destroy.
ty_exr* ty_exr_create(const int data_window[4], const int display_window[4]);
void ty_exr_destroy(ty_exr* exr); // NULL is allowed

// Adds a channel of zeros and returns its pixels (owned by exr). Set all windows before. A name has 1 to 63 bytes and
// is not there yet.
void* ty_exr_add_channel(ty_exr* exr, const char* name, ty_exr_type type);
// Set the attribute of that name (1 to 63 bytes): added, or replaced when it is there. Texts are copied.
void ty_exr_add_string(ty_exr* exr, const char* name, const char* text);
void ty_exr_add_float(ty_exr* exr, const char* name, float value);
void ty_exr_add_int(ty_exr* exr, const char* name, int value);
void ty_exr_add_matrix(ty_exr* exr, const char* name, const float value[16]);
void ty_exr_add_chromaticities(ty_exr* exr, const float value[8]);
void ty_exr_add_rational(ty_exr* exr, const char* name, int numerator, unsigned denominator);
void ty_exr_add_latlong(ty_exr* exr); // the standard attribute `envmap`: latitude and longitude

const ty_exr_channel* ty_exr_find_channel(const ty_exr* exr, const char* name);     // NULL if absent
const ty_exr_attribute* ty_exr_find_attribute(const ty_exr* exr, const char* name); // NULL if absent

// Halves round to nearest even and saturate at +-65504. What the format cannot hold (no channels, a name twice, an
// attribute of the format's own, over 65536 a side) is TY_BAD_INPUT, a device that refuses TY_BAD_FILE.
// Atomic, ZIP compressed, channels sorted by name as the format wants, no timestamps: equal input, equal bytes.
TY_CHECKED ty_status ty_exr_write(const char* path, const ty_exr* exr, ty_error* error);

// Reads any scanline single-part file with full-resolution channels; attributes of other types are left out. Sizes are
// checked against the file's size before memory is taken. Tiled, multi-part, deep or DWA files are TY_BAD_FILE that
// says so (use ty_image_read).
TY_CHECKED ty_status ty_exr_read(const char* path, ty_exr** out, ty_error* error);
// From memory, for fuzzing and parts: name is used in messages.
TY_CHECKED ty_status ty_exr_read_memory(const char* name, const void* bytes, size_t size, ty_exr** out,
                                        ty_error* error);
