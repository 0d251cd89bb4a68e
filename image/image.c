// SPDX-License-Identifier: Apache-2.0
// Image files as interleaved floats: recognised by content, checked for proportion, then read through OpenImageIO.
#include "exr_check.h"
#include "image_oiio.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <tsuya/base/file.h>
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

enum
{
    MAX_SIDE = 32768,
    MAX_CHANNELS = 1024,
    LEAD_SIZE = 16,
    // Bytes out for one byte in of an integer format: deflate and arithmetic coding of a flat image stay below.
    MAX_RATIO = 2000,
};

typedef struct known_format
{
    const char* name; // of OpenImageIO
    const char* magic;
    size_t offset, size;
} known_format;

// Content decides, not the extension. Readers that follow references to other files or play films are left out.
static const known_format formats[] = {
    {"openexr", "\x76\x2f\x31\x01", 0, 4},
    {"png", "\x89PNG\r\n\x1a\n", 0, 8},
    {"jpeg", "\xff\xd8\xff", 0, 3},
    {"tiff", "II*\0", 0, 4},
    {"tiff", "MM\0*", 0, 4},
    {"tiff", "II+\0", 0, 4},
    {"tiff", "MM\0+", 0, 4},
    {"hdr", "#?", 0, 2},
    {"bmp", "BM", 0, 2},
    {"webp", "WEBP", 8, 4},
    {"pnm", "P5", 0, 2},
    {"pnm", "P6", 0, 2},
    {"pnm", "Pf", 0, 2},
    {"pnm", "PF", 0, 2},
    {"dpx", "SDPX", 0, 4},
    {"dpx", "XPDS", 0, 4},
};

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

// Finds the format by the first bytes and the file's size.
static ty_status recognise(const char* path, const char** name, size_t* size, ty_error* error)
{
    struct stat about;
    FILE* file = NULL;
    if (stat(path, &about) != 0 || (S_ISREG(about.st_mode) && !(file = fopen(path, "rb"))))
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot read: %s", strerror(errno));
    if (!file)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot read: not a regular file");
    char lead[LEAD_SIZE] = {0};
    size_t count = fread(lead, 1, sizeof lead, file);
    fclose(file);
    if (count == 0)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "the file is empty");
    *size = (size_t)about.st_size;
    *name = strcasecmp(ty_path_extension(path), "tga") == 0 ? "targa" : NULL;
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (count >= formats[i].offset + formats[i].size &&
            memcmp(lead + formats[i].offset, formats[i].magic, formats[i].size) == 0)
        {
            *name = formats[i].name;
            break;
        }
    if (!*name)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                               "not an image in a known format (EXR, HDR, PNG, JPEG, TIFF, BMP, TGA, PNM, WebP, DPX)");
    return TY_OK;
}

// The EXR header is looked at before a library that trusts it is.
static ty_status check_exr(const char* path, size_t size, ty_error* error)
{
    ty_bytes bytes;
    ty_status status = ty_file_read(path, size, &bytes, error);
    if (status)
        return status;
    ty_exr_claim claim;
    status = ty_exr_check_header(path, bytes.data, bytes.size, &claim, error);
    if (!status && claim.deep)
        status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "deep EXR files cannot be read");
    if (!status)
        status = ty_exr_check_size(path, &claim, bytes.size, MAX_SIDE, error);
    ty_bytes_term(&bytes);
    return status;
}

static ty_status check_size(const char* path, const char* name, const ty_oiio_info* info, size_t size, ty_error* error)
{
    if (info->width < 1 || info->height < 1 || info->width > MAX_SIDE || info->height > MAX_SIDE ||
        info->channels < 1 || info->channels > MAX_CHANNELS)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                               "image of %d x %d pixels and %d channels: 1 to %d a side, 1 to %d channels", info->width,
                               info->height, info->channels, MAX_SIDE, MAX_CHANNELS);
    double claimed = (double)info->width * info->height * info->channels * info->bytes_per_channel;
    if (strcmp(name, "openexr") != 0 && claimed > (double)size * MAX_RATIO)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                               "header claims %d x %d pixels (%.1f MB), more than %zu bytes can hold: truncated or damaged",
                               info->width, info->height, claimed * 1e-6, size);
    return TY_OK;
}

static bool primaries_are(const float a[8], const float b[8])
{
    for (int i = 0; i < 8; i++)
        if (!(fabsf(a[i] - b[i]) < 2e-4f))
            return false;
    return true;
}

// Chromaticities say more than a reader's default for its format.
static const char* space_of(const ty_oiio_info* info)
{
    static const struct
    {
        const char* name;
        float primaries[8];
    } known[] = {
        {"ACEScg", {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f}},
        {"ACES2065-1", {0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f}},
        {"lin_rec709", {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}},
    };
    if (info->has_chromaticities)
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            if (primaries_are(info->chromaticities, known[i].primaries))
                return known[i].name;
    return info->color_space;
}

static ty_status read_open(const char* path, const char* name, ty_oiio_input* input, const ty_oiio_info* info,
                           size_t size, ty_image* out, ty_error* error)
{
    ty_status status = check_size(path, name, info, size, error);
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

ty_status ty_image_read(const char* path, ty_image* out, ty_error* error)
{
    *out = (ty_image){0};
    const char* name = NULL;
    size_t size = 0;
    ty_status status = recognise(path, &name, &size, error);
    if (!status && strcmp(name, "openexr") == 0)
        status = check_exr(path, size, error);
    if (status)
        return status;
    char text[512];
    ty_oiio_input* input = NULL;
    ty_oiio_info info;
    ty_oiio_result result = ty_oiio_open(name, path, &input, &info, text, sizeof text);
    if (result != TY_OIIO_OK)
        return shim_status(result, path, "cannot read image", text, error);
    status = read_open(path, name, input, &info, size, out, error);
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

static ty_status write_levels(const char* path, const ty_image* image, int bits, const void* levels, ty_error* error)
{
    ty_atomic_file file;
    ty_status status = ty_atomic_begin(&file, path, error);
    if (status)
        return status;
    char text[512];
    ty_oiio_result result =
        ty_oiio_write(output_format(path), file.temporary, image->width, image->height, image->channels, bits, levels,
                      image->color_space, text, sizeof text);
    if (result == TY_OIIO_OK)
        return ty_atomic_commit(&file, error);
    ty_atomic_abort(&file);
    return shim_status(result, path, "cannot write", text, error);
}

ty_status ty_image_write(const char* path, const ty_image* image, int bits, ty_error* error)
{
    ty_status status = check_output(path, image, bits, error);
    if (status)
        return status;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    void* levels = ty_try_alloc(count, (size_t)bits / 8);
    if (!levels)
        return shim_status(TY_OIIO_NO_MEMORY, path, "", "", error);
    quantise(image->pixels, count, bits, levels);
    status = write_levels(path, image, bits, levels, error);
    ty_free(levels);
    return status;
}
