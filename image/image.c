// SPDX-License-Identifier: Apache-2.0
// Image files as interleaved floats: recognised by content, checked for proportion, then read through OpenImageIO.
#include "image_check.h"
#include "image_oiio.h"
#include <limits.h>
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

// An open file whose header has been looked at.
typedef struct opened
{
    const char *path, *format;
    size_t size;
    ty_oiio_input* input;
    ty_oiio_info info;
} opened;

static ty_status read_range(const opened* file, int begin, int end, ty_image* out, ty_error* error)
{
    const char* path = file->path;
    const ty_oiio_info* info = &file->info;
    size_t count = (size_t)info->width * (size_t)info->height * (size_t)(end - begin);
    float* pixels = TY_TRY_ALLOC(float, count);
    if (!pixels)
        return shim_status(TY_OIIO_NO_MEMORY, path, "", "", error);
    char text[512];
    ty_oiio_result result = ty_oiio_read(file->input, begin, end, pixels, text, sizeof text);
    if (result != TY_OIIO_OK)
    {
        ty_free(pixels);
        return shim_status(result, path, "cannot read image", text, error);
    }
    *out = (ty_image){.width = info->width, .height = info->height, .channels = end - begin, .pixels = pixels};
    out->is_float = info->is_float != 0;
    snprintf(out->color_space, sizeof out->color_space, "%s", space_of(info));
    return TY_OK;
}

// On success the caller closes out->input.
static ty_status input_open(const char* path, opened* out, ty_error* error)
{
    char text[512];
    *out = (opened){.path = path};
    ty_status status = inspect(path, &out->format, &out->size, error);
    if (status)
        return status;
    ty_oiio_result result = ty_oiio_open(out->format, path, &out->input, &out->info, text, sizeof text);
    if (result != TY_OIIO_OK)
        return shim_status(result, path, "cannot read image", text, error);
    status = check_info(path, out->format, &out->info, out->size, error);
    if (status)
        ty_oiio_close(out->input);
    return status;
}

ty_status ty_image_read(const char* path, ty_image* out, ty_error* error)
{
    opened file;
    *out = (ty_image){0};
    ty_status status = input_open(path, &file, error);
    if (status)
        return status;
    status = read_range(&file, 0, file.info.channels, out, error);
    ty_oiio_close(file.input);
    return status;
}

// Of the first part; -1 = none.
static int find_channel(const opened* file, const char* name)
{
    for (int i = 0; i < file->info.channels; i++)
        if (strcmp(ty_oiio_channel_name(file->input, i), name) == 0)
            return i;
    return -1;
}

static ty_status no_channel(const opened* file, const char* name, ty_error* error)
{
    char list[400] = "";
    for (int i = 0; i < file->info.channels && strlen(list) < sizeof list - 1; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i > 0 ? ", " : "",
                 ty_oiio_channel_name(file->input, i));
    return ty_error_set_at(error, TY_BAD_INPUT, file->path, 0, 0, "no channel '%.100s'; the file has %s", name, list);
}

// The channels that are the picture, in the order in which they are to be; returns how many.
static int picture_channels(const opened* file, int channel[4])
{
    static const char* const names[] = {"R", "G", "B", "A"};
    int count = 0, grey = find_channel(file, "Y"), alpha = find_channel(file, "A");
    while (count < 4 && (channel[count] = find_channel(file, names[count])) >= 0)
        count++;
    if (count >= 3)
        return count;
    channel[0] = grey;
    channel[1] = alpha;
    if (grey >= 0)
        return alpha >= 0 ? 2 : 1;
    for (count = 0; count < 4 && count < file->info.channels; count++)
        channel[count] = count;
    return count;
}

// In place: of each pixel the channels wanted.
static void keep_channels(ty_image* image, const int* channel, int count)
{
    size_t size = (size_t)image->width * (size_t)image->height, all = (size_t)image->channels;
    for (size_t i = 0; i < size; i++)
    {
        float kept[4];
        for (int c = 0; c < count; c++)
            kept[c] = image->pixels[i * all + (size_t)channel[c]];
        memcpy(image->pixels + i * (size_t)count, kept, (size_t)count * sizeof *kept);
    }
    image->channels = count;
}

ty_status ty_image_read_channel(const char* path, const char* channel, ty_image* out, ty_error* error)
{
    opened file;
    *out = (ty_image){0};
    ty_status status = input_open(path, &file, error);
    if (status)
        return status;
    int wanted[4], count = channel ? 1 : picture_channels(&file, wanted), begin = INT_MAX, end = 0;
    if (channel)
        wanted[0] = find_channel(&file, channel);
    for (int c = 0; c < count; c++)
    {
        begin = wanted[c] < begin ? wanted[c] : begin;
        end = wanted[c] + 1 > end ? wanted[c] + 1 : end;
    }
    status = begin < 0 ? no_channel(&file, channel, error) : read_range(&file, begin, end, out, error);
    ty_oiio_close(file.input);
    if (status)
        return status;
    for (int c = 0; c < count; c++)
        wanted[c] -= begin;
    keep_channels(out, wanted, count);
    return TY_OK;
}

ty_status ty_image_read_size(const char* path, int* width, int* height, ty_error* error)
{
    opened file;
    ty_status status = input_open(path, &file, error);
    if (status)
        return status;
    *width = file.info.width;
    *height = file.info.height;
    ty_oiio_close(file.input);
    return TY_OK;
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
