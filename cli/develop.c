// SPDX-License-Identifier: Apache-2.0
// `tsuya develop`: scene-linear EXR to a display image.
#include "cli.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

// Interleaved RGB of an EXR; grey files give three equal channels. NULL pixels = no such channels.
static ty_image rgb_of_exr(const ty_exr* exr)
{
    const ty_exr_channel* planes[3] = {ty_exr_find_channel(exr, "R"), ty_exr_find_channel(exr, "G"),
                                       ty_exr_find_channel(exr, "B")};
    const ty_exr_channel* grey = ty_exr_find_channel(exr, "Y");
    ty_image image = {.width = ty_exr_width(exr), .height = ty_exr_height(exr), .channels = 3};
    size_t count = (size_t)image.width * (size_t)image.height;
    for (int c = 0; c < 3; c++)
    {
        planes[c] = planes[c] ? planes[c] : grey;
        if (!planes[c] || planes[c]->type == TY_EXR_UINT)
        {
            return image;
        }
    }
    image.pixels = TY_ALLOC(float, count * 3);
    for (size_t i = 0; i < count; i++)
    {
        for (int c = 0; c < 3; c++)
        {
            image.pixels[3 * i + (size_t)c] = ((const float*)planes[c]->pixels)[i];
        }
    }
    return image;
}

ty_status ty_develop_pixels(const ty_develop_def* def, float* pixels, int count, int channels, ty_error* error)
{
    const char* source;
    ty_color* color;
    ty_status status = ty_color_create(ty_color_choose(def->ocio, NULL, &source), &color, error);
    if (status != TY_OK)
    {
        return status;
    }
    status = ty_color_develop(color, def->display, def->view, def->exposure, pixels, count, channels, error);
    ty_color_destroy(color);
    return status;
}

ty_status ty_develop_check(const ty_develop_def* def)
{
    ty_error error;
    ty_status status = ty_develop_pixels(def, NULL, 0, 3, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    return status;
}

static ty_status develop_image(ty_image* image, const ty_develop_def* def, const char* output, ty_error* error)
{
    ty_status status = ty_develop_pixels(def, image->pixels, image->width * image->height, image->channels, error);
    return status == TY_OK ? ty_image_write(output, image, def->bits, error) : status;
}

ty_status ty_develop(const ty_exr* exr, const ty_develop_def* def, const char* output, ty_error* error)
{
    ty_image image = rgb_of_exr(exr);
    if (!image.pixels)
    {
        return ty_error_set(error, TY_BAD_FILE, "no R, G, B (or Y) channels to develop");
    }
    ty_status status = develop_image(&image, def, output, error);
    ty_image_term(&image);
    return status;
}

ty_status ty_develop_options(const ty_arguments* arguments, ty_develop_def* def)
{
    *def = (ty_develop_def){.display = ty_argument_text(arguments, "display", NULL),
                            .view = ty_argument_text(arguments, "view", NULL),
                            .ocio = ty_argument_text(arguments, "ocio", NULL),
                            .bits = 8};
    if (ty_argument_has(arguments, "exposure"))
    {
        double exposure;
        ty_status status = ty_argument_float(arguments, "exposure", -64, 64, &exposure);
        if (status != TY_OK)
        {
            return status;
        }
        def->exposure = (float)exposure;
    }
    const char* bits = ty_argument_text(arguments, "bits", "8");
    if (strcmp(bits, "8") != 0 && strcmp(bits, "16") != 0)
    {
        return ty_usage(arguments->command, "--bits: '%s' is neither 8 nor 16", bits);
    }
    def->bits = bits[0] == '8' ? 8 : 16;
    return TY_OK;
}

// Scanline EXRs through our own door; every other image (tiled, multi-part, DWA, HDR) as OpenImageIO reads it.
static ty_status develop_file(const char* input, const ty_develop_def* def, const char* output, ty_error* error)
{
    ty_exr* exr;
    if (strcmp(ty_path_extension(input), "exr") == 0 && ty_exr_read(input, &exr, error) == TY_OK)
    {
        ty_status status = ty_develop(exr, def, output, error);
        ty_exr_destroy(exr);
        return status;
    }
    ty_image image;
    ty_status status = ty_image_read(input, &image, error);
    if (status != TY_OK)
    {
        return status;
    }
    bool fits = image.is_float && (image.channels == 3 || image.channels == 4);
    status = fits ? develop_image(&image, def, output, error)
                  : ty_error_set_at(error, TY_BAD_FILE, input, 0, 0,
                                    "develop takes scene-linear images of 3 or 4 float channels");
    ty_image_term(&image);
    return status;
}

static ty_status run(const ty_arguments* arguments)
{
    const char* output = ty_argument_text(arguments, "output", NULL);
    ty_develop_def def;
    ty_status status = ty_develop_options(arguments, &def);
    if (status != TY_OK)
    {
        return status;
    }
    if (!output)
    {
        return ty_usage(arguments->command, "where to? give -o OUT.png");
    }
    ty_error error = {0};
    status = develop_file(arguments->positional[0], &def, output, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
    }
    return status;
}

static const ty_option options[] = {
    {"output", 'o', "OUT.png", "the image to write (png, jpg, tif)"},
    {"display", 0, "D", "display of the OCIO configuration (default: sRGB)"},
    {"view", 0, "V", "view (default: ACES 1.0 SDR; also Untonemapped, Raw)"},
    {"exposure", 'e', "EV", "stops, before the view"},
    {"bits", 0, "8|16", "bits a channel (default 8)"},
    {"ocio", 0, "FILE", "OpenColorIO configuration"},
};

const ty_command ty_command_develop = {
    "develop",
    "IN.exr -o OUT.png",
    "turn a scene-linear EXR into a display image",
    "tsuya develop out/rice_bowl.exr -o out/rice_bowl.png --exposure 0.5",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
