// SPDX-License-Identifier: Apache-2.0
// The header check of EXR files. The layout is that of "OpenEXR File Layout" of the OpenEXR documentation.
#include "exr_check.h"
#include "exr_core.h"
#include <string.h>

enum
{
    // The library keeps attributes and channels sorted by insertion: without a bound, time grows with the square.
    MAX_ATTRIBUTES = 4096,
    MAX_CHANNELS = 1024,
    MAX_NAME = 255,
    VERSION_TILED = 0x200,
    VERSION_DEEP = 0x800,
    VERSION_MULTIPART = 0x1000,
    CHANNEL_RECORD = 16, // type, pLinear and padding, x and y sampling
};

typedef struct reader
{
    const uint8_t* bytes;
    size_t size, at;
} reader;

typedef struct raw_attribute
{
    const char *name, *type;
    const uint8_t* value;
    size_t size;
} raw_attribute;

static uint32_t u32_at(const uint8_t* bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static int32_t i32_at(const uint8_t* bytes)
{
    return (int32_t)u32_at(bytes);
}

bool ty_exr_is_magic(const void* bytes, size_t size)
{
    return size >= 4 && u32_at(bytes) == 20000630u;
}

// A zero-terminated name of at most MAX_NAME bytes; NULL when it is longer or runs over the end.
static const char* read_name(reader* r)
{
    size_t left = r->size - r->at, length = 0, limit = left < MAX_NAME + 1 ? left : MAX_NAME + 1;
    const char* name = (const char*)r->bytes + r->at;
    while (length < limit && name[length])
        length++;
    if (length == limit)
        return NULL;
    r->at += length + 1;
    return name;
}

static ty_status bad(ty_error* error, const char* file, const char* text)
{
    return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0, "%s", text);
}

// name[0] == 0 in *out marks the end of the header.
static ty_status read_attribute(reader* r, const char* file, raw_attribute* out, ty_error* error)
{
    *out = (raw_attribute){0};
    out->name = read_name(r);
    if (!out->name)
        return bad(error, file, "EXR header is truncated or has a name over 255 bytes");
    if (!out->name[0])
        return TY_OK;
    out->type = read_name(r);
    if (!out->type || !out->type[0] || r->size - r->at < 4)
        return bad(error, file, "EXR header is truncated or damaged");
    int32_t size = i32_at(r->bytes + r->at);
    r->at += 4;
    if (size < 0 || (size_t)size > r->size - r->at)
        return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0,
                               "EXR attribute '%.64s' claims %d bytes, the file has %zu more", out->name, (int)size,
                               r->size - r->at);
    out->value = r->bytes + r->at;
    out->size = (size_t)size;
    r->at += out->size;
    return TY_OK;
}

static ty_status take_channels(const raw_attribute* attribute, const char* file, ty_exr_claim* claim, ty_error* error)
{
    reader r = {attribute->value, attribute->size, 0};
    for (;;)
    {
        const char* name = read_name(&r);
        if (!name)
            return bad(error, file, "EXR channel list is damaged");
        if (!name[0])
            break;
        if (r.size - r.at < CHANNEL_RECORD)
            return bad(error, file, "EXR channel list is damaged");
        uint32_t type = u32_at(r.bytes + r.at);
        int32_t x_sampling = i32_at(r.bytes + r.at + 8), y_sampling = i32_at(r.bytes + r.at + 12);
        r.at += CHANNEL_RECORD;
        if (type > 2 || x_sampling < 1 || y_sampling < 1)
            return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0, "EXR channel '%.64s' has no valid type or sampling",
                                   name);
        claim->subsampled |= x_sampling != 1 || y_sampling != 1;
        claim->bytes_per_pixel += type == 1 ? 2 : 4;
        if (++claim->channel_count > MAX_CHANNELS)
            return bad(error, file, "EXR file has over 1024 channels");
    }
    if (claim->channel_count == 0)
        return bad(error, file, "EXR file has no channels");
    return TY_OK;
}

static ty_status take_window(const raw_attribute* attribute, const char* file, int window[4], ty_error* error)
{
    for (int i = 0; i < 4; i++)
    {
        window[i] = i32_at(attribute->value + 4 * i);
        if (window[i] > TY_EXR_MAX_COORDINATE || window[i] < -TY_EXR_MAX_COORDINATE)
            return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0, "EXR %s is out of range (%d)", attribute->name,
                                   window[i]);
    }
    if (window[2] < window[0] || window[3] < window[1])
        return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0, "EXR %s is empty (%d,%d to %d,%d)", attribute->name,
                               window[0], window[1], window[2], window[3]);
    return TY_OK;
}

static bool is(const raw_attribute* attribute, const char* name, const char* type, size_t size)
{
    return strcmp(attribute->name, name) == 0 && strcmp(attribute->type, type) == 0 &&
           (size == 0 || attribute->size == size);
}

static ty_status take_attribute(const raw_attribute* a, const char* file, ty_exr_claim* claim, ty_error* error)
{
    bool* seen = strcmp(a->name, "channels") == 0      ? &claim->has_channels
                 : strcmp(a->name, "dataWindow") == 0  ? &claim->has_data_window
                 : strcmp(a->name, "compression") == 0 ? &claim->has_compression
                                                       : NULL;
    if (is(a, "type", "string", 0))
    {
        claim->deep |= a->size >= 4 && memcmp(a->value, "deep", 4) == 0;
        claim->tiled |= a->size == 10 && memcmp(a->value, "tiledimage", 10) == 0;
        return TY_OK;
    }
    if (!seen)
        return TY_OK;
    if (*seen)
        return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0, "EXR header has two '%s'", a->name);
    *seen = true;
    if (is(a, "channels", "chlist", 0))
        return take_channels(a, file, claim, error);
    if (is(a, "dataWindow", "box2i", 16))
        return take_window(a, file, claim->data_window, error);
    if (is(a, "compression", "compression", 1) && a->value[0] <= EXR_COMPRESSION_DWAB)
    {
        claim->compression = a->value[0];
        return TY_OK;
    }
    return ty_error_set_at(error, TY_BAD_FILE, file, 0, 0, "EXR '%s' is damaged or unknown", a->name);
}

ty_status ty_exr_check_header(const char* name, const void* bytes, size_t size, ty_exr_claim* claim, ty_error* error)
{
    *claim = (ty_exr_claim){0};
    if (!ty_exr_is_magic(bytes, size) || size < 8)
        return bad(error, name, size == 0 ? "the file is empty" : "not an EXR file");
    reader r = {bytes, size, 8};
    uint32_t version = u32_at(r.bytes + 4);
    if ((version & 0xffu) != 2)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "EXR version %u is not known", version & 0xffu);
    claim->tiled = (version & VERSION_TILED) != 0;
    claim->deep = (version & VERSION_DEEP) != 0;
    claim->multipart = (version & VERSION_MULTIPART) != 0;
    for (int count = 0;; count++)
    {
        raw_attribute attribute;
        ty_status status = read_attribute(&r, name, &attribute, error);
        if (status)
            return status;
        if (!attribute.name[0])
            break;
        if (count == MAX_ATTRIBUTES)
            return bad(error, name, "EXR header has over 4096 attributes");
        status = take_attribute(&attribute, name, claim, error);
        if (status)
            return status;
    }
    if (!claim->has_channels || !claim->has_data_window || !claim->has_compression)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "EXR header has no %s",
                               !claim->has_channels      ? "channels"
                               : !claim->has_data_window ? "dataWindow"
                                                         : "compression");
    return TY_OK;
}

ty_status ty_exr_check_size(const char* name, const ty_exr_claim* claim, size_t size, int max_side, ty_error* error)
{
    // Bytes out for one byte in, at most: RLE 2 -> 128; deflate 1032; PXR24 deflates 3 of 4 bytes; PIZ about 10 bits
    // -> 512; B44A 3 -> 32; DWA deflates run lengths of 64 zero coefficients.
    static const int64_t ratio[] = {1, 64, 1032, 1032, 512, 1376, 11, 11, 100000, 100000};
    int64_t width = (int64_t)claim->data_window[2] - claim->data_window[0] + 1;
    int64_t height = (int64_t)claim->data_window[3] - claim->data_window[1] + 1;
    if (width > max_side || height > max_side)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "image of %lld x %lld pixels, at most %d a side",
                               (long long)width, (long long)height, max_side);
    int64_t claimed = width * height * claim->bytes_per_pixel, sampling = claim->subsampled ? 16 : 1;
    if (claimed / sampling / ratio[claim->compression] > (int64_t)size)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0,
                               "header claims %lld x %lld pixels (%.1f MB), more than %zu bytes can hold: truncated or "
                               "damaged",
                               (long long)width, (long long)height, (double)claimed * 1e-6, size);
    return TY_OK;
}
