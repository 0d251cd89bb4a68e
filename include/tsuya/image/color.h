// SPDX-License-Identifier: Apache-2.0
// Colour management through OpenColorIO. Scene colour is linear ACEScg.
#pragma once
#include <tsuya/base/math.h>
#include <tsuya/base/status.h>

typedef struct ty_color ty_color; // opaque: a loaded configuration; processors are cached inside; any thread may use it

// path NULL = the embedded configuration: roles; ACEScg, ACES2065-1, lin_rec709 and its aliases, sRGB texture,
// Rec.1886 texture, raw; displays sRGB and Rec.1886 with views "ACES 1.0 SDR" (default), "Untonemapped", "Raw".
TY_CHECKED ty_status ty_color_create(const char* path, ty_color** out, ty_error* error);
void ty_color_destroy(ty_color* color); // NULL is allowed

// A text that differs between configurations that may convert differently: for keys of what was converted. Borrowed.
const char* ty_color_identity(const ty_color* color);

// The configuration to use by precedence: command line > scene > $OCIO > embedded. Arguments may be NULL.
// *source says which won ("--ocio", "scene", "$OCIO", "embedded"), for the log.
const char* ty_color_choose(const char* command_line, const char* scene, const char** source);

// The space a file is in when nobody says: the file's own claim if the configuration knows it, else
// sRGB texture for integers and linear Rec.709 for floats.
const char* ty_color_guess_space(const ty_color* color, bool is_float, const char* claim);

// Primaries and white of ACEScg, for TY_EXR_CHROMATICITIES.
#define TY_ACESCG_CHROMATICITIES                                                                                       \
    {                                                                                                                  \
        0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f                                             \
    }

// The space with these primaries and white (rx ry gx gy bx by wx wy): "ACEScg", "ACES2065-1", "lin_rec709"; NULL for
// others.
const char* ty_chromaticities_space(const float chromaticities[8]);

// In place on pixel_count pixels of `channels` floats (3 or 4; alpha untouched) from one space to another.
TY_CHECKED ty_status ty_color_convert(const ty_color* color, const char* from, const char* to, float* pixels,
                                      int pixel_count, int channels, ty_error* error);

// A single colour to ACEScg; used for scene files.
TY_CHECKED ty_status ty_color_to_acescg(const ty_color* color, const char* from, ty_rgb* value, ty_error* error);

// Scene-linear ACEScg to display values 0..1 in place. display/view NULL = the defaults. exposure in stops.
TY_CHECKED ty_status ty_color_develop(const ty_color* color, const char* display, const char* view, float exposure,
                                      float* pixels, int pixel_count, int channels, ty_error* error);

// Writes the names of displays and views, one "display: view, view" a line, into buffer.
void ty_color_describe(const ty_color* color, char* buffer, size_t size);
