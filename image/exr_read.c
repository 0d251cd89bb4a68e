// SPDX-License-Identifier: Apache-2.0
// EXR reading through OpenEXRCore from memory: refused or complete.
#include "exr_check.h"
#include "exr_core.h"
#include <tsuya/base/file.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/half.h>

#define MAX_FILE_SIZE ((size_t)16 << 30)

typedef struct source
{
    const uint8_t* bytes;
    size_t size;
} source;

static int64_t source_size(exr_const_context_t context, void* user)
{
    (void)context;
    return (int64_t)((const source*)user)->size;
}

// A short count at the end of the file is right: the library reads headers in blocks and knows what it needs.
static int64_t source_read(exr_const_context_t context, void* user, void* buffer, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    (void)context;
    (void)report;
    const source* from = user;
    uint64_t left = offset < from->size ? from->size - offset : 0, count = size < left ? size : left;
    memcpy(buffer, from->bytes + (from->size - left), count);
    return (int64_t)count;
}

// Kinds of EXR that another door reads.
static ty_status check_kind(const char* name, const ty_exr_claim* claim, ty_error* error)
{
    const char* kind = claim->deep                                  ? "deep"
                       : claim->multipart                           ? "a multi-part"
                       : claim->tiled                               ? "a tiled"
                       : claim->subsampled                          ? "subsampled"
                       : claim->compression >= EXR_COMPRESSION_DWAA ? "DWA compressed"
                                                                    : NULL;
    if (!kind)
        return TY_OK;
    if (claim->deep)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "deep EXR files cannot be read");
    return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0,
                           "%s EXR file: readable as a texture or light, but not as a render "
                           "(full-resolution scan lines in one part are needed)",
                           kind);
}

static ty_status read_channels(exr_context_t context, const char* name, ty_exr* exr, ty_error* error)
{
    const exr_attr_chlist_t* list = NULL;
    exr_result_t result = exr_get_channels(context, 0, &list);
    if (result != EXR_ERR_SUCCESS)
        return ty_exr_core_fail(error, name, result);
    exr->channels = TY_TRY_ALLOC(ty_exr_channel, list->num_channels);
    if (!exr->channels)
        return ty_exr_core_fail(error, name, EXR_ERR_OUT_OF_MEMORY);
    for (int i = 0; i < list->num_channels; i++)
    {
        const exr_attr_chlist_entry_t* entry = &list->entries[i];
        ty_exr_channel* channel = &exr->channels[i];
        if (strlen(entry->name.str) >= sizeof channel->name)
            return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "EXR channel name over 63 bytes");
        strcpy(channel->name, entry->name.str);
        channel->type = entry->pixel_type == EXR_PIXEL_UINT   ? TY_EXR_UINT
                        : entry->pixel_type == EXR_PIXEL_HALF ? TY_EXR_HALF
                                                              : TY_EXR_FLOAT;
        channel->pixels = TY_TRY_ALLOC(float, (size_t)ty_exr_width(exr) * (size_t)ty_exr_height(exr));
        if (!channel->pixels)
            return ty_exr_core_fail(error, name, EXR_ERR_OUT_OF_MEMORY);
        exr->channel_count = i + 1;
    }
    return TY_OK;
}

// False when the type is not one of ours.
static bool attribute_value(const exr_attribute_t* from, ty_exr_attribute* to)
{
    switch (from->type)
    {
    case EXR_ATTR_STRING:
        to->type = TY_EXR_STRING;
        return true;
    case EXR_ATTR_FLOAT:
        to->type = TY_EXR_FLOAT1;
        to->value[0] = from->f;
        return true;
    case EXR_ATTR_INT:
        to->type = TY_EXR_INT1;
        to->integer[0] = from->i;
        return true;
    case EXR_ATTR_M44F:
        to->type = TY_EXR_MATRIX44;
        memcpy(to->value, from->m44f->m, 16 * sizeof(float));
        return true;
    case EXR_ATTR_CHROMATICITIES:
        to->type = TY_EXR_CHROMATICITIES;
        memcpy(to->value, from->chromaticities, 8 * sizeof(float));
        return true;
    case EXR_ATTR_RATIONAL:
        to->type = TY_EXR_RATIONAL;
        to->integer[0] = from->rational->num;
        to->integer[1] = (int)from->rational->denom;
        return true;
    case EXR_ATTR_ENVMAP:
        to->type = TY_EXR_ENVMAP;
        to->integer[0] = from->uc;
        return true;
    default:
        return false;
    }
}

// Attributes of other types, of longer names and of the format itself are left out.
static ty_status read_attributes(exr_context_t context, const char* name, ty_exr* exr, ty_error* error)
{
    int32_t count = 0;
    exr_result_t result = exr_get_attribute_count(context, 0, &count);
    if (result != EXR_ERR_SUCCESS)
        return ty_exr_core_fail(error, name, result);
    exr->attributes = TY_TRY_ALLOC(ty_exr_attribute, count);
    if (!exr->attributes)
        return ty_exr_core_fail(error, name, EXR_ERR_OUT_OF_MEMORY);
    for (int i = 0; i < count; i++)
    {
        const exr_attribute_t* from = NULL;
        result = exr_get_attribute_by_index(context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &from);
        if (result != EXR_ERR_SUCCESS)
            return ty_exr_core_fail(error, name, result);
        ty_exr_attribute* to = &exr->attributes[exr->attribute_count];
        if (strlen(from->name) >= sizeof to->name || ty_exr_is_reserved(from->name) || !attribute_value(from, to))
            continue;
        strcpy(to->name, from->name);
        if (to->type == TY_EXR_STRING)
        {
            size_t length = from->string->length > 0 ? (size_t)from->string->length : 0;
            to->text = TY_TRY_ALLOC(char, length + 1);
            if (!to->text)
                return ty_exr_core_fail(error, name, EXR_ERR_OUT_OF_MEMORY);
            if (length)
                memcpy(to->text, from->string->str, length);
        }
        exr->attribute_count++;
    }
    return TY_OK;
}

// Sends the lines from y on to the channels' pixels, halves to consecutive rows of scratch.
static void aim(exr_decode_pipeline_t* decode, const ty_exr* exr, const exr_chunk_info_t* chunk, uint16_t* scratch)
{
    size_t width = (size_t)ty_exr_width(exr), first = (size_t)(chunk->start_y - exr->data_window[1]) * width;
    for (int i = 0; i < decode->channel_count; i++)
    {
        exr_coding_channel_info_t* to = &decode->channels[i];
        bool half = exr->channels[i].type == TY_EXR_HALF;
        to->user_bytes_per_element = half ? 2 : 4;
        to->user_data_type = to->data_type;
        to->user_pixel_stride = to->user_bytes_per_element;
        to->user_line_stride = (int32_t)width * to->user_bytes_per_element;
        to->decode_to_ptr = half ? (uint8_t*)scratch : (uint8_t*)((float*)exr->channels[i].pixels + first);
        if (half)
            scratch += width * (size_t)chunk->height;
    }
}

static void expand_halves(const ty_exr* exr, const exr_chunk_info_t* chunk, const uint16_t* scratch)
{
    size_t width = (size_t)ty_exr_width(exr), count = width * (size_t)chunk->height;
    size_t first = (size_t)(chunk->start_y - exr->data_window[1]) * width;
    for (int i = 0; i < exr->channel_count; i++)
    {
        if (exr->channels[i].type != TY_EXR_HALF)
            continue;
        float* pixels = (float*)exr->channels[i].pixels + first;
        for (size_t k = 0; k < count; k++)
            pixels[k] = ty_half_to_float(scratch[k]);
        scratch += count;
    }
}

static exr_result_t read_chunks(exr_context_t context, const ty_exr* exr, int lines, uint16_t* scratch)
{
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int y = exr->data_window[1]; y <= exr->data_window[3] && result == EXR_ERR_SUCCESS; y += lines)
    {
        bool first = y == exr->data_window[1];
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(context, 0, y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = first ? exr_decoding_initialize(context, 0, &chunk, &decode)
                           : exr_decoding_update(context, 0, &chunk, &decode);
        if (result != EXR_ERR_SUCCESS)
            break;
        if (decode.channel_count != exr->channel_count)
            result = EXR_ERR_CORRUPT_CHUNK;
        else
            aim(&decode, exr, &chunk, scratch);
        if (result == EXR_ERR_SUCCESS && first)
            result = exr_decoding_choose_default_routines(context, 0, &decode);
        if (result == EXR_ERR_SUCCESS)
            result = exr_decoding_run(context, 0, &decode);
        if (result == EXR_ERR_SUCCESS)
            expand_halves(exr, &chunk, scratch);
    }
    exr_decoding_destroy(context, &decode);
    return result;
}

static ty_status read_pixels(exr_context_t context, const char* name, const ty_exr* exr, ty_error* error)
{
    int32_t lines = 0, half_count = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &lines);
    if (result != EXR_ERR_SUCCESS || lines < 1)
        return ty_exr_core_fail(error, name, result != EXR_ERR_SUCCESS ? result : EXR_ERR_FILE_BAD_HEADER);
    for (int i = 0; i < exr->channel_count; i++)
        half_count += exr->channels[i].type == TY_EXR_HALF;
    size_t rows = (size_t)(lines < ty_exr_height(exr) ? lines : ty_exr_height(exr));
    uint16_t* scratch = TY_TRY_ALLOC(uint16_t, (size_t)half_count * rows * (size_t)ty_exr_width(exr));
    if (!scratch)
        return ty_exr_core_fail(error, name, EXR_ERR_OUT_OF_MEMORY);
    result = read_chunks(context, exr, lines, scratch);
    ty_free(scratch);
    return result == EXR_ERR_SUCCESS ? TY_OK : ty_exr_core_fail(error, name, result);
}

static ty_status read_image(exr_context_t context, const char* name, const ty_exr_claim* claim, ty_exr** out,
                            ty_error* error)
{
    exr_attr_box2i_t data, display;
    exr_result_t result = exr_get_data_window(context, 0, &data);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_display_window(context, 0, &display);
    if (result != EXR_ERR_SUCCESS)
        return ty_exr_core_fail(error, name, result);
    int data_window[4] = {data.min.x, data.min.y, data.max.x, data.max.y};
    int display_window[4] = {display.min.x, display.min.y, display.max.x, display.max.y};
    if (memcmp(data_window, claim->data_window, sizeof data_window) != 0)
        return ty_exr_core_fail(error, name, EXR_ERR_FILE_BAD_HEADER);
    ty_exr* exr = ty_exr_create(data_window, display_window);
    ty_status status = read_channels(context, name, exr, error);
    if (!status)
        status = read_attributes(context, name, exr, error);
    if (!status)
        status = read_pixels(context, name, exr, error);
    if (status)
        ty_exr_destroy(exr);
    else
        *out = exr;
    return status;
}

ty_status ty_exr_read_memory(const char* name, const void* bytes, size_t size, ty_exr** out, ty_error* error)
{
    *out = NULL;
    ty_exr_claim claim;
    ty_status status = ty_exr_check_header(name, bytes, size, &claim, error);
    if (!status)
        status = check_kind(name, &claim, error);
    if (!status)
        status = ty_exr_check_size(name, &claim, size, TY_EXR_MAX_SIDE, error);
    if (status)
        return status;
    source from = {bytes, size};
    exr_context_initializer_t initializer;
    ty_exr_core_begin(&initializer);
    initializer.user_data = &from;
    initializer.read_fn = source_read;
    initializer.size_fn = source_size;
    initializer.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_context_t context = NULL;
    exr_result_t result = exr_start_read(&context, name && name[0] ? name : "EXR", &initializer);
    if (result != EXR_ERR_SUCCESS)
        return ty_exr_core_fail(error, name, result);
    status = read_image(context, name, &claim, out, error);
    exr_finish(&context);
    return status;
}

ty_status ty_exr_read(const char* path, ty_exr** out, ty_error* error)
{
    *out = NULL;
    ty_bytes bytes;
    ty_status status = ty_file_read(path, MAX_FILE_SIZE, &bytes, error);
    if (status)
        return status;
    status = ty_exr_read_memory(path, bytes.data, bytes.size, out, error);
    ty_bytes_term(&bytes);
    return status;
}
