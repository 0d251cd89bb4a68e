// SPDX-License-Identifier: Apache-2.0
// EXR writing through OpenEXRCore: one part, scan lines, ZIP in blocks of 16 lines; the file is complete or absent.
#include "exr_core.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/image/exr.h>
#include <tsuya/image/half.h>
#include <unistd.h>

enum
{
    ZIP_LEVEL = 4, // level 6 takes half as long again for 5 % less
    BLOCK_LINES = 16,
};

typedef struct sink
{
    int fd;
    int error_number; // of the first write that failed
} sink;

static int64_t sink_write(exr_const_context_t context, void* user, const void* buffer, uint64_t size, uint64_t offset,
                          exr_stream_error_func_ptr_t report)
{
    (void)context;
    (void)report;
    sink* to = user;
    const char* bytes = buffer;
    for (uint64_t done = 0; done < size;)
    {
        ssize_t count = pwrite(to->fd, bytes + done, size - done, (off_t)(offset + done));
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
        {
            if (!to->error_number)
                to->error_number = count < 0 ? errno : ENOSPC;
            return -1;
        }
        done += (uint64_t)count;
    }
    return (int64_t)size;
}

static int by_name(const void* a, const void* b)
{
    return strcmp((*(const ty_exr_channel* const*)a)->name, (*(const ty_exr_channel* const*)b)->name);
}

static bool window_is_sane(const int window[4])
{
    for (int i = 0; i < 4; i++)
        if (window[i] > TY_EXR_MAX_COORDINATE || window[i] < -TY_EXR_MAX_COORDINATE)
            return false;
    return window[2] >= window[0] && window[3] >= window[1];
}

// What the format cannot hold is the caller's input, not the disk's fault.
static ty_status check_image(const char* path, const ty_exr* exr, const ty_exr_channel** sorted, ty_error* error)
{
    if (exr->channel_count < 1)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "an EXR image needs at least one channel");
    if (!window_is_sane(exr->data_window) || !window_is_sane(exr->display_window) ||
        ty_exr_width(exr) > TY_EXR_MAX_SIDE || ty_exr_height(exr) > TY_EXR_MAX_SIDE)
        return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0,
                               "the image's windows are empty or above %d pixels a side", TY_EXR_MAX_SIDE);
    for (int i = 0; i < exr->channel_count; i++)
        sorted[i] = &exr->channels[i];
    qsort(sorted, (size_t)exr->channel_count, sizeof *sorted, by_name);
    for (int i = 1; i < exr->channel_count; i++)
        if (strcmp(sorted[i - 1]->name, sorted[i]->name) == 0)
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "channel '%s' is there twice", sorted[i]->name);
    for (int i = 0; i < exr->attribute_count; i++)
        if (ty_exr_is_reserved(exr->attributes[i].name))
            return ty_error_set_at(error, TY_BAD_INPUT, path, 0, 0, "attribute '%s' belongs to the format",
                                   exr->attributes[i].name);
    return TY_OK;
}

static exr_result_t write_attribute(exr_context_t context, const ty_exr_attribute* a)
{
    switch (a->type)
    {
    case TY_EXR_STRING:
        return exr_attr_set_string(context, 0, a->name, a->text ? a->text : "");
    case TY_EXR_FLOAT1:
        return exr_attr_set_float(context, 0, a->name, a->value[0]);
    case TY_EXR_INT1:
        return exr_attr_set_int(context, 0, a->name, a->integer[0]);
    case TY_EXR_MATRIX44:
    {
        exr_attr_m44f_t matrix;
        memcpy(matrix.m, a->value, sizeof matrix.m);
        return exr_attr_set_m44f(context, 0, a->name, &matrix);
    }
    case TY_EXR_CHROMATICITIES:
    {
        exr_attr_chromaticities_t chromaticities;
        memcpy(&chromaticities, a->value, sizeof chromaticities);
        return exr_attr_set_chromaticities(context, 0, a->name, &chromaticities);
    }
    case TY_EXR_RATIONAL:
    {
        exr_attr_rational_t rational = {a->integer[0], (uint32_t)a->integer[1]};
        return exr_attr_set_rational(context, 0, a->name, &rational);
    }
    case TY_EXR_ENVMAP:
        return exr_attr_set_envmap(context, 0, a->name, (exr_envmap_t)a->integer[0]);
    }
    return EXR_ERR_INVALID_ATTR;
}

static exr_result_t write_header(exr_context_t context, const ty_exr* exr, const ty_exr_channel* const* sorted)
{
    exr_attr_box2i_t data = {.min = {.x = exr->data_window[0], .y = exr->data_window[1]},
                             .max = {.x = exr->data_window[2], .y = exr->data_window[3]}};
    exr_attr_box2i_t display = {.min = {.x = exr->display_window[0], .y = exr->display_window[1]},
                                .max = {.x = exr->display_window[2], .y = exr->display_window[3]}};
    exr_attr_v2f_t center = {.x = 0.0f, .y = 0.0f};
    int part = 0;
    exr_result_t result = exr_set_longname_support(context, 1);
    if (result == EXR_ERR_SUCCESS)
        result = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr(context, part, &display, &data, 1.0f, &center, 1.0f,
                                              EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
    for (int i = 0; i < exr->channel_count && result == EXR_ERR_SUCCESS; i++)
    {
        exr_pixel_type_t type = sorted[i]->type == TY_EXR_UINT   ? EXR_PIXEL_UINT
                                : sorted[i]->type == TY_EXR_HALF ? EXR_PIXEL_HALF
                                                                 : EXR_PIXEL_FLOAT;
        result = exr_add_channel(context, part, sorted[i]->name, type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    for (int i = 0; i < exr->attribute_count && result == EXR_ERR_SUCCESS; i++)
        result = write_attribute(context, &exr->attributes[i]);
    return result == EXR_ERR_SUCCESS ? exr_write_header(context) : result;
}

// Points the encoder at the lines of this chunk, halves by way of scratch.
static void aim(exr_encode_pipeline_t* encode, const ty_exr* exr, const ty_exr_channel* const* sorted,
                const exr_chunk_info_t* chunk, uint16_t* scratch)
{
    size_t width = (size_t)ty_exr_width(exr), count = width * (size_t)chunk->height;
    size_t first = (size_t)(chunk->start_y - exr->data_window[1]) * width;
    for (int i = 0; i < exr->channel_count; i++)
    {
        exr_coding_channel_info_t* from = &encode->channels[i];
        const float* pixels = (const float*)sorted[i]->pixels + first;
        bool half = sorted[i]->type == TY_EXR_HALF;
        from->user_bytes_per_element = half ? 2 : 4;
        from->user_data_type = from->data_type;
        from->user_pixel_stride = from->user_bytes_per_element;
        from->user_line_stride = (int32_t)width * from->user_bytes_per_element;
        from->encode_from_ptr = half ? (const uint8_t*)scratch : (const uint8_t*)pixels;
        if (half)
            for (size_t k = 0; k < count; k++)
                *scratch++ = ty_half_from_float(pixels[k]);
    }
}

static exr_result_t write_chunks(exr_context_t context, const ty_exr* exr, const ty_exr_channel* const* sorted,
                                 uint16_t* scratch)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int y = exr->data_window[1]; y <= exr->data_window[3] && result == EXR_ERR_SUCCESS; y += BLOCK_LINES)
    {
        bool first = y == exr->data_window[1];
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(context, 0, y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = first ? exr_encoding_initialize(context, 0, &chunk, &encode)
                           : exr_encoding_update(context, 0, &chunk, &encode);
        if (result != EXR_ERR_SUCCESS)
            break;
        aim(&encode, exr, sorted, &chunk, scratch);
        if (first)
            result = exr_encoding_choose_default_routines(context, 0, &encode);
        if (result == EXR_ERR_SUCCESS)
            result = exr_encoding_run(context, 0, &encode);
    }
    exr_encoding_destroy(context, &encode);
    return result;
}

static ty_status write_image(const char* path, const ty_exr* exr, const ty_exr_channel* const* sorted, sink* to,
                             ty_error* error)
{
    uint16_t* scratch = ty_try_alloc((size_t)exr->channel_count * BLOCK_LINES * (size_t)ty_exr_width(exr), 2);
    if (!scratch)
        return ty_exr_core_fail(error, path, EXR_ERR_OUT_OF_MEMORY);
    exr_context_initializer_t initializer;
    ty_exr_core_begin(&initializer);
    initializer.user_data = to;
    initializer.write_fn = sink_write;
    initializer.zip_level = ZIP_LEVEL;
    exr_context_t context = NULL;
    exr_result_t result = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &initializer);
    if (result == EXR_ERR_SUCCESS)
        result = write_header(context, exr, sorted);
    if (result == EXR_ERR_SUCCESS)
        result = write_chunks(context, exr, sorted, scratch);
    if (context)
    {
        exr_result_t finish = exr_finish(&context);
        result = result != EXR_ERR_SUCCESS ? result : finish;
    }
    ty_free(scratch);
    if (to->error_number)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "cannot write: %s", strerror(to->error_number));
    return result == EXR_ERR_SUCCESS ? TY_OK : ty_exr_core_fail(error, path, result);
}

// Writes the temporary and closes it: the last error of some file systems comes only then.
static ty_status write_temporary(const ty_atomic_file* file, const ty_exr* exr, const ty_exr_channel* const* sorted,
                                 ty_error* error)
{
    sink to = {.fd = open(file->temporary, O_WRONLY | O_TRUNC | O_CLOEXEC)};
    if (to.fd < 0)
        return ty_error_set_at(error, TY_BAD_FILE, file->path, 0, 0, "cannot write: %s", strerror(errno));
    ty_status status = write_image(file->path, exr, sorted, &to, error);
    if (close(to.fd) != 0 && !status)
        status = ty_error_set_at(error, TY_BAD_FILE, file->path, 0, 0, "cannot write: %s", strerror(errno));
    return status;
}

ty_status ty_exr_write(const char* path, const ty_exr* exr, ty_error* error)
{
    const ty_exr_channel** sorted = ty_alloc((size_t)exr->channel_count, sizeof *sorted);
    ty_status status = check_image(path, exr, sorted, error);
    ty_atomic_file file;
    if (!status)
        status = ty_atomic_begin(&file, path, error);
    if (!status)
    {
        status = write_temporary(&file, exr, sorted, error);
        if (status)
            ty_atomic_abort(&file);
        else
            status = ty_atomic_commit(&file, error);
    }
    ty_free(sorted);
    return status;
}
