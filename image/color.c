// SPDX-License-Identifier: Apache-2.0
// Colour management: which configuration, which names, and pixels through OpenColorIO.
#include "color_config.h"
#include "color_ocio.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <tsuya/base/suggest.h>
#include <tsuya/image/color.h>
#include <tsuya/image/half.h>

struct ty_color
{
    ty_ocio* ocio;
};

enum
{
    MAX_NAMES = 256,
    SAME_COUNT = 7,
};

// Names under which the spaces that the program itself asks for stand in other configurations; roles last.
static const char* const same_spaces[][SAME_COUNT] = {
    {"ACEScg", "lin_ap1", "ACES - ACEScg", "scene_linear"},
    {"srgb_texture", "sRGB - Texture", "srgb_tx", "Utility - sRGB - Texture", "sRGB", "color_picking"},
    {"lin_rec709", "Linear Rec.709 (sRGB)", "lin_rec709_srgb", "lin_srgb", "Utility - Linear - sRGB", "linear sRGB",
     "scene_linear"},
    {"raw", "Raw", "Utility - Raw", "data"},
};

ty_status ty_color_create(const char* path, ty_color** out, ty_error* error)
{
    *out = NULL;
    if (path && !ty_file_exists(path))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "no such OpenColorIO configuration");
    char text[512];
    ty_ocio* ocio = NULL;
    ty_ocio_result result = ty_ocio_load(path, ty_color_embedded_config, &ocio, text, sizeof text);
    if (result == TY_OCIO_NO_MEMORY)
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "not enough memory for the OpenColorIO configuration");
    if (result != TY_OCIO_OK)
        return ty_error_set_at(error, path ? TY_BAD_FILE : TY_INTERNAL, path, 0, 0, "OpenColorIO: %s", text);
    *out = TY_ALLOC(ty_color, 1);
    (*out)->ocio = ocio;
    return TY_OK;
}

void ty_color_destroy(ty_color* color)
{
    if (!color)
        return;
    ty_ocio_close(color->ocio);
    ty_free(color);
}

const char* ty_color_identity(const ty_color* color)
{
    return ty_ocio_identity(color->ocio);
}

const char* ty_color_choose(const char* command_line, const char* scene, const char** source)
{
    const char* paths[] = {command_line, scene, getenv("OCIO")};
    const char* const names[] = {"--ocio", "scene", "$OCIO"};
    for (int i = 0; i < 3; i++)
        if (paths[i] && paths[i][0])
        {
            *source = names[i];
            return paths[i];
        }
    *source = "embedded";
    return NULL;
}

// The configuration's name for name: itself, or for one of ours what other configurations call it. NULL if none.
static const char* find_space(const ty_color* color, const char* name)
{
    if (ty_ocio_knows(color->ocio, name))
        return name;
    for (size_t row = 0; row < sizeof same_spaces / sizeof *same_spaces; row++)
        if (strcmp(name, same_spaces[row][0]) == 0)
            for (int i = 1; i < SAME_COUNT && same_spaces[row][i]; i++)
                if (ty_ocio_knows(color->ocio, same_spaces[row][i]))
                    return same_spaces[row][i];
    return NULL;
}

const char* ty_color_guess_space(const ty_color* color, bool is_float, const char* claim)
{
    if (claim && claim[0] && ty_ocio_knows(color->ocio, claim))
        return claim;
    const char* usual = is_float ? "lin_rec709" : "srgb_texture";
    const char* found = find_space(color, usual);
    return found ? found : usual;
}

static bool primaries_are(const float a[8], const float b[8])
{
    for (int i = 0; i < 8; i++)
        if (!(fabsf(a[i] - b[i]) < 2e-4f))
            return false;
    return true;
}

const char* ty_chromaticities_space(const float chromaticities[8])
{
    static const struct
    {
        const char* name;
        float primaries[8];
    } known[] = {
        {"ACEScg", TY_ACESCG_CHROMATICITIES},
        {"ACES2065-1", {0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f}},
        {"lin_rec709", {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (primaries_are(chromaticities, known[i].primaries))
            return known[i].name;
    return NULL;
}

// "unknown <kind> 'name'; did you mean 'x'? known: a, b, c"
static ty_status unknown_name(ty_error* error, const char* kind, const char* name, const char* const* known, int count)
{
    char list[700] = "";
    size_t used = 0;
    for (int i = 0; i < count && used < sizeof list; i++)
    {
        int written = snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", known[i]);
        used += written > 0 ? (size_t)written : 0;
    }
    if (used >= sizeof list)
        memcpy(list + sizeof list - 4, "...", 4);
    const char* near = ty_suggest_name(name, known, count);
    return ty_error_set(error, TY_BAD_INPUT, "unknown %s '%.100s'%s%s%s; known: %s", kind, name,
                        near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "", list);
}

static ty_status resolve_space(const ty_color* color, const char* name, const char** out, ty_error* error)
{
    *out = find_space(color, name);
    if (*out)
        return TY_OK;
    const char* known[MAX_NAMES];
    int count = 0;
    while (count < MAX_NAMES && (known[count] = ty_ocio_space(color->ocio, count)))
        count++;
    return unknown_name(error, "colour space", name, known, count);
}

// The known name that equals name; name NULL = the first.
static ty_status pick(const char* kind, const char* name, const char* const* known, int count, const char** out,
                      ty_error* error)
{
    for (int i = 0; i < count; i++)
        if (!name || strcmp(known[i], name) == 0)
        {
            *out = known[i];
            return TY_OK;
        }
    return unknown_name(error, kind, name ? name : "", known, count);
}

static ty_status resolve_display(const ty_color* color, const char* name, const char** out, ty_error* error)
{
    const char* known[MAX_NAMES];
    int count = 0;
    while (count < MAX_NAMES && (known[count] = ty_ocio_display(color->ocio, count)))
        count++;
    return pick("display", name, known, count, out, error);
}

static ty_status resolve_view(const ty_color* color, const char* display, const char* name, const char** out,
                              ty_error* error)
{
    const char* known[MAX_NAMES];
    int count = 0;
    while (count < MAX_NAMES && (known[count] = ty_ocio_view(color->ocio, display, count)))
        count++;
    return pick("view", name, known, count, out, error);
}

static ty_status finish(ty_ocio_result result, const char* text, ty_error* error)
{
    if (result == TY_OCIO_OK)
        return TY_OK;
    if (result == TY_OCIO_NO_MEMORY)
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for a colour transform");
    return ty_error_set(error, TY_BAD_INPUT, "OpenColorIO: %s", text);
}

ty_status ty_color_convert(const ty_color* color, const char* from, const char* to, float* pixels, int pixel_count,
                           int channels, ty_error* error)
{
    TY_ASSERT(channels == 3 || channels == 4);
    const char *source = NULL, *target = NULL;
    ty_status status = resolve_space(color, from, &source, error);
    if (!status)
        status = resolve_space(color, to, &target, error);
    if (status || pixel_count <= 0)
        return status;
    char text[512];
    return finish(ty_ocio_convert(color->ocio, source, target, pixels, pixel_count, channels, text, sizeof text), text,
                  error);
}

ty_status ty_color_to_acescg(const ty_color* color, const char* from, ty_rgb* value, ty_error* error)
{
    float pixel[3] = {value->r, value->g, value->b};
    ty_status status = ty_color_convert(color, from, "ACEScg", pixel, 1, 3, error);
    if (!status)
        *value = ty_rgb_make(pixel[0], pixel[1], pixel[2]);
    return status;
}

// NaN becomes 0.
static void clamp_pixels(float* pixels, int pixel_count, int channels, float scale, float low, float high)
{
    for (int i = 0; i < pixel_count; i++)
        for (int k = 0; k < 3; k++)
        {
            float value = pixels[(size_t)i * (size_t)channels + (size_t)k] * scale;
            pixels[(size_t)i * (size_t)channels + (size_t)k] = value == value ? ty_clamp(value, low, high) : 0.0f;
        }
}

ty_status ty_color_develop(const ty_color* color, const char* display, const char* view, float exposure, float* pixels,
                           int pixel_count, int channels, ty_error* error)
{
    TY_ASSERT(channels == 3 || channels == 4);
    const char *source = NULL, *chosen_display = NULL, *chosen_view = NULL;
    ty_status status = resolve_space(color, "ACEScg", &source, error);
    if (!status)
        status = resolve_display(color, display, &chosen_display, error);
    if (!status)
        status = resolve_view(color, chosen_display, view, &chosen_view, error);
    if (status || pixel_count <= 0)
        return status;
    // Beyond the range of half every view is saturated, and infinities would turn into NaN in the matrices.
    clamp_pixels(pixels, pixel_count, channels, (float)exp2((double)exposure), -TY_HALF_MAX, TY_HALF_MAX);
    char text[512];
    ty_ocio_result result = ty_ocio_develop(color->ocio, source, chosen_display, chosen_view, pixels, pixel_count,
                                            channels, text, sizeof text);
    if (result == TY_OCIO_OK)
        clamp_pixels(pixels, pixel_count, channels, 1.0f, 0.0f, 1.0f);
    return finish(result, text, error);
}

void ty_color_describe(const ty_color* color, char* buffer, size_t size)
{
    size_t used = 0;
    if (size)
        buffer[0] = '\0';
    const char *display, *view;
    for (int i = 0; (display = ty_ocio_display(color->ocio, i)); i++)
    {
        if (used < size)
            used += (size_t)snprintf(buffer + used, size - used, "%s:", display);
        for (int k = 0; (view = ty_ocio_view(color->ocio, display, k)); k++)
            if (used < size)
                used += (size_t)snprintf(buffer + used, size - used, "%s %s", k ? "," : "", view);
        if (used < size)
            used += (size_t)snprintf(buffer + used, size - used, "\n");
    }
}
