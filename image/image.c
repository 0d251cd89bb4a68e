// SPDX-License-Identifier: Apache-2.0
// Image files as interleaved floats: recognised by content, checked for proportion, then read through OpenImageIO.
#include "image_check.h"
#include "image_oiio.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <tsuya/base/file.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>
#include <tsuya/image/image.h>

enum
{
    MAX_CHANNELS = 1024,
};

#define MAX_FILE_SIZE ((size_t)16 << 30)

void ty_image_term(ty_image* image)
{
    ty_free(image->pixels);
    *image = (ty_image){0};
}

static ty_status shim_status(ty_oiio_result result, const char* path, const char* doing, const char* text,
                             ty_error* error)
{
    if (result == TY_OIIO_NO_MEMORY)
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "not enough memory for the image");
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "%s: %s", doing, text);
}

// Looks at the file's bytes: its format, its size, and whether they are fit for a library.
static ty_status inspect(const char* path, const char** format, size_t* size, ty_error* error)
{
    ty_bytes bytes;
    ty_status status = ty_file_read(path, MAX_FILE_SIZE, &bytes, error);
    if (status)
        return status;
    *size = bytes.size;
    *format = ty_image_format(path, bytes.data, bytes.size);
    if (bytes.size == 0)
        status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "the file is empty");
    else if (!*format)
        status =
            ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                            "not an image in a known format (EXR, HDR, PNG, JPEG, TIFF, BMP, TGA, PNM, WebP, DPX)");
    else
        status = ty_image_check(path, *format, bytes.data, bytes.size, error);
    ty_bytes_term(&bytes);
    return status;
}

static ty_status check_info(const char* path, const char* format, const ty_oiio_info* info, size_t size,
                            ty_error* error)
{
    if (info->channels < 1 || info->channels > MAX_CHANNELS)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "image of %d channels; 1 to %d are read", info->channels,
                               MAX_CHANNELS);
    if (strcmp(format, "openexr") == 0) // was checked with the ratio of its compression
        return TY_OK;
    int64_t bytes_per_pixel = (int64_t)info->channels * info->bytes_per_channel;
    return ty_image_check_claim(path, info->width, info->height, bytes_per_pixel, size, error);
}

// Chromaticities say more than a reader's default for its format.
static const char* space_of(const ty_oiio_info* info)
{
    const char* space = info->has_chromaticities ? ty_chromaticities_space(info->chromaticities) : NULL;
    return space ? space : info->color_space;
}

static ty_status read_open(const char* path, const char* format, ty_oiio_input* input, const ty_oiio_info* info,
                           size_t size, ty_image* out, ty_error* error)
{
    ty_status status = check_info(path, format, info, size, error);
    if (status)
        return status;
    size_t count = (size_t)info->width * (size_t)info->height * (size_t)info->channels;
    float* pixels = TY_TRY_ALLOC(float, count);
    if (!pixels)
        return shim_status(TY_OIIO_NO_MEMORY, path, "", "", error);
    char text[512];
    ty_oiio_result result = ty_oiio_read(input, pixels, text, sizeof text);
    if (result != TY_OIIO_OK)
    {
        ty_free(pixels);
        return shim_status(result, path, "cannot read image", text, error);
    }
    *out = (ty_image){.width = info->width, .height = info->height, .channels = info->channels, .pixels = pixels};
    out->is_float = info->is_float != 0;
    snprintf(out->color_space, sizeof out->color_space, "%s", space_of(info));
    return TY_OK;
}

static ty_status input_open(const char* path, const char** format, size_t* size, ty_oiio_input** input,
                            ty_oiio_info* info, ty_error* error)
{
    char text[512];
    ty_status status = inspect(path, format, size, error);
    if (status)
        return status;
    ty_oiio_result result = ty_oiio_open(*format, path, input, info, text, sizeof text);
    return result == TY_OIIO_OK ? TY_OK : shim_status(result, path, "cannot read image", text, error);
}

ty_status ty_image_read(const char* path, ty_image* out, ty_error* error)
{
    *out = (ty_image){0};
    const char* format = NULL;
    size_t size = 0;
    ty_oiio_input* input = NULL;
    ty_oiio_info info;
    ty_status status = input_open(path, &format, &size, &input, &info, error);
    if (status)
        return status;
    status = read_open(path, format, input, &info, size, out, error);
    ty_oiio_close(input);
    return status;
}

ty_status ty_image_read_size(const char* path, int* width, int* height, ty_error* error)
{
    const char* format = NULL;
    size_t size = 0;
    ty_oiio_input* input = NULL;
    ty_oiio_info info;
    ty_status status = input_open(path, &format, &size, &input, &info, error);
    if (status)
        return status;
    status = check_info(path, format, &info, size, error);
    *width = info.width;
    *height = info.height;
    ty_oiio_close(input);
    return status;
}

static const char* output_format(const char* path)
{
    const char* extension = ty_path_extension(path);
    static const char* const known[][2] = {
        {"png", "png"}, {"jpg", "jpeg"}, {"jpeg", "jpeg"}, {"tif", "tiff"}, {"tiff", "tiff"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcasecmp(extension, known[i][0]) == 0)
            return known[i][1];
    return NULL;
}

// 0..1 to the integers of that many bits, to nearest; NaN becomes 0.
static void quantise(const float* from, size_t count, int bits, void* to)
{
    float scale = bits == 16 ? 65535.0f : 255.0f;
    for (size_t i = 0; i < count; i++)
    {
        float value = from[i] > 0.0f ? ty_min(from[i], 1.0f) : 0.0f;
        unsigned level = (unsigned)(value * scale + 0.5f);
        if (bits == 16)
            ((uint16_t*)to)[i] = (uint16_t)level;
        else
            ((uint8_t*)to)[i] = (uint8_t)level;
    }
}

static ty_status check_output(const char* path, const ty_image* image, int bits, ty_error* error)
{
    const char* format = output_format(path);
    if (!format)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0,
                               "cannot write images with the extension '%s'; known: png, jpg, jpeg, tif, tiff",
                               ty_path_extension(path));
    if (bits != 8 && (bits != 16 || strcmp(format, "jpeg") == 0))
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "%d bits: %s holds 8%s", bits, format,
                               strcmp(format, "jpeg") == 0 ? "" : " or 16");
    if (image->channels != 1 && image->channels != 3 && image->channels != 4)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "%d channels: 1, 3 or 4 are needed", image->channels);
    if (image->width < 1 || image->height < 1)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "the image is empty");
    return TY_OK;
}

static ty_status encode_levels(const char* path, const ty_image* image, int bits, const void* levels, ty_bytes* out,
                               ty_error* error)
{
    char text[512];
    ty_oiio_output* output = NULL;
    ty_oiio_result result = ty_oiio_encode(output_format(path), image->width, image->height, image->channels, bits,
                                           levels, image->color_space, &output, text, sizeof text);
    if (result != TY_OIIO_OK)
        return shim_status(result, path, "cannot write", text, error);
    size_t size = 0;
    const void* bytes = ty_oiio_output_bytes(output, &size);
    out->data = TY_TRY_ALLOC(uint8_t, size + 1);
    if (out->data)
        memcpy(out->data, bytes, size);
    out->size = out->data ? size : 0;
    ty_oiio_output_destroy(output);
    return out->data ? TY_OK : shim_status(TY_OIIO_NO_MEMORY, path, "", "", error);
}

ty_status ty_image_encode(const char* path, const ty_image* image, int bits, ty_bytes* out, ty_error* error)
{
    *out = (ty_bytes){0};
    ty_status status = check_output(path, image, bits, error);
    if (status)
        return status;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    void* levels = ty_try_alloc(count, (size_t)bits / 8);
    if (!levels)
        return shim_status(TY_OIIO_NO_MEMORY, path, "", "", error);
    quantise(image->pixels, count, bits, levels);
    status = encode_levels(path, image, bits, levels, out, error);
    ty_free(levels);
    return status;
}

ty_status ty_image_write(const char* path, const ty_image* image, int bits, ty_error* error)
{
    ty_bytes bytes;
    ty_status status = ty_image_encode(path, image, bits, &bytes, error);
    if (status == TY_OK)
        status = ty_file_write(path, bytes.data, bytes.size, error);
    ty_bytes_term(&bytes);
    return status;
}
