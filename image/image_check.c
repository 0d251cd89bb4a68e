// SPDX-License-Identifier: Apache-2.0
// Formats by their first bytes; PNG chunk by chunk (ISO/IEC 15948), since libpng prints what it does not like.
#include "image_check.h"
#include "exr_check.h"
#include <stdbool.h>
#include <string.h>
#include <strings.h>
#include <tsuya/base/file.h>

enum
{
    // Bytes out for one byte in: deflate gives 1032, the arithmetic coding of flat images a little more.
    MAX_RATIO = 2000,
    PNG_SIGNATURE = 8,
    PNG_CHUNK_FRAME = 12, // length, type, CRC
    PNG_HEADER = 13,
};

typedef struct known_format
{
    const char* name; // of OpenImageIO
    const char* magic;
    size_t offset, size;
} known_format;

// Readers that follow references to other files or play films are left out.
static const known_format formats[] = {
    {"openexr", "\x76\x2f\x31\x01", 0, 4},
    {"png", "\x89PNG\r\n\x1a\n", 0, 8},
    {"jpeg", "\xff\xd8\xff", 0, 3},
    {"tiff", "II*\0", 0, 4},
    {"tiff", "MM\0*", 0, 4},
    {"tiff", "II+\0", 0, 4},
    {"tiff", "MM\0+", 0, 4},
    {"hdr", "#?R", 0, 3},
    {"bmp", "BM", 0, 2},
    {"webp", "WEBP", 8, 4},
    {"pnm", "P5", 0, 2},
    {"pnm", "P6", 0, 2},
    {"pnm", "Pf", 0, 2},
    {"pnm", "PF", 0, 2},
    {"dpx", "SDPX", 0, 4},
    {"dpx", "XPDS", 0, 4},
};

const char* ty_image_format(const char* path, const void* bytes, size_t size)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (size >= formats[i].offset + formats[i].size &&
            memcmp((const char*)bytes + formats[i].offset, formats[i].magic, formats[i].size) == 0)
            return formats[i].name;
    return strcasecmp(ty_path_extension(path), "tga") == 0 ? "targa" : NULL; // has no magic number
}

ty_status ty_image_check_claim(const char* path, int64_t width, int64_t height, int64_t bytes_per_pixel, size_t size,
                               ty_error* error)
{
    if (width < 1 || height < 1 || width > TY_IMAGE_MAX_SIDE || height > TY_IMAGE_MAX_SIDE)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "image of %lld x %lld pixels; 1 to %d a side are read",
                               (long long)width, (long long)height, TY_IMAGE_MAX_SIDE);
    int64_t claimed = width * height * bytes_per_pixel;
    if (claimed / MAX_RATIO > (int64_t)size)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                               "header claims %lld x %lld pixels (%.1f MB), more than %zu bytes can hold: truncated or "
                               "damaged",
                               (long long)width, (long long)height, (double)claimed * 1e-6, size);
    return TY_OK;
}

static uint32_t big_u32(const uint8_t* bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | (uint32_t)bytes[3];
}

static void crc_table(uint32_t table[256])
{
    for (uint32_t i = 0; i < 256; i++)
    {
        table[i] = i;
        for (int k = 0; k < 8; k++)
            table[i] = table[i] & 1u ? 0xedb88320u ^ table[i] >> 1 : table[i] >> 1;
    }
}

static uint32_t crc_of(const uint32_t table[256], const uint8_t* bytes, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++)
        crc = table[(crc ^ bytes[i]) & 255u] ^ crc >> 8;
    return ~crc;
}

static ty_status check_png_header(const char* path, const uint8_t* chunk, uint32_t length, size_t size, ty_error* error)
{
    if (memcmp(chunk + 4, "IHDR", 4) != 0 || length != PNG_HEADER)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "PNG file does not begin with its header");
    static const uint8_t channels[8] = {1, 0, 3, 1, 2, 0, 4, 0}; // by colour type
    int64_t bits = (int64_t)chunk[16] * channels[chunk[17] & 7];
    return ty_image_check_claim(path, big_u32(chunk + 8), big_u32(chunk + 12), (bits + 7) / 8, size, error);
}

static ty_status check_png(const char* path, const uint8_t* bytes, size_t size, ty_error* error)
{
    uint32_t table[256];
    crc_table(table);
    bool is_first = true;
    for (size_t at = PNG_SIGNATURE;; is_first = false)
    {
        if (size - at < PNG_CHUNK_FRAME)
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "PNG file ends early: truncated");
        const uint8_t* chunk = bytes + at;
        uint32_t length = big_u32(chunk);
        if (length > size - at - PNG_CHUNK_FRAME)
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                                   "PNG file ends inside of chunk '%.4s': truncated or damaged", chunk + 4);
        if (crc_of(table, chunk + 4, (size_t)length + 4) != big_u32(chunk + 8 + length))
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "PNG chunk '%.4s' is damaged (wrong CRC)",
                                   chunk + 4);
        ty_status status = is_first ? check_png_header(path, chunk, length, size, error) : TY_OK;
        if (status || memcmp(chunk + 4, "IEND", 4) == 0)
            return status;
        at += (size_t)length + PNG_CHUNK_FRAME;
    }
}

static ty_status check_exr(const char* path, const void* bytes, size_t size, ty_error* error)
{
    ty_exr_claim claim;
    ty_status status = ty_exr_check_header(path, bytes, size, &claim, error);
    if (!status && claim.deep)
        status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "deep EXR files cannot be read");
    return status ? status : ty_exr_check_size(path, &claim, size, TY_IMAGE_MAX_SIDE, error);
}

ty_status ty_image_check(const char* path, const char* format, const void* bytes, size_t size, ty_error* error)
{
    if (strcmp(format, "openexr") == 0)
        return check_exr(path, bytes, size, error);
    return strcmp(format, "png") == 0 ? check_png(path, bytes, size, error) : TY_OK;
}
