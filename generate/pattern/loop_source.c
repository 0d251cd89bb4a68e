// SPDX-License-Identifier: Apache-2.0
// Where volumes come from beside reactions: frames of a fill, stacks of pictures, one picture, raw files.
#include "loop_volume.h"
#include "plane_file.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>

typedef struct source
{
    const ty_loop_part* part;
    int index; // of the part
    float low, scale;
    ty_loop_volume* volume;
} source;

static void slice_put(const source* s, int z, const float* values)
{
    int w = s->volume->size[0], h = s->volume->size[1];
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            s->volume->values[ty_loop_voxel(s->volume, x, y, z)] =
                ty_loop_number_of((values[(size_t)y * (size_t)w + (size_t)x] - s->low) * s->scale);
}

// --- fill ---

typedef struct fill_sink
{
    const source* s;
    int count;
} fill_sink;

// v, Y, or the luminance of R, G, B; else the first channel.
static const float* channel_of(const ty_exr* image, float** made)
{
    static const char *const alone[] = {"v", "Y"}, *const colors[] = {"R", "G", "B"};
    const ty_exr_channel* found[3];
    bool all = true;
    for (int i = 0; i < 2; i++)
        if (ty_exr_find_channel(image, alone[i]))
            return ty_exr_find_channel(image, alone[i])->pixels;
    for (int i = 0; i < 3; i++)
        all &= (found[i] = ty_exr_find_channel(image, colors[i])) != NULL;
    if (!all)
        return image->channels[0].pixels;
    size_t n = (size_t)ty_exr_width(image) * (size_t)ty_exr_height(image);
    *made = TY_ALLOC(float, n);
    for (size_t i = 0; i < n; i++)
        (*made)[i] = ty_luminance((ty_rgb){((const float*)found[0]->pixels)[i], ((const float*)found[1]->pixels)[i],
                                           ((const float*)found[2]->pixels)[i]});
    return *made;
}

static ty_status fill_take(void* context, int frame, ty_exr* image, ty_error* error)
{
    fill_sink* sink = context;
    const source* s = sink->s;
    int size[3] = {ty_exr_width(image), ty_exr_height(image), sink->count};
    ty_status status = TY_OK;
    if (!s->volume->values)
        status = ty_loop_volume_create(size, false, false, s->volume, error);
    if (status == TY_OK && (frame < 1 || frame > sink->count || memcmp(size, s->volume->size, sizeof size) != 0))
        status = ty_error_set(error, TY_INTERNAL, "volume[%d].fill: frame %d of another size", s->index, frame);
    if (status != TY_OK)
        return status;
    float* made = NULL;
    slice_put(s, frame - 1, channel_of(image, &made));
    ty_free(made);
    return TY_OK;
}

static ty_status fill_make(const source* s, ty_workers* workers, ty_error* error)
{
    fill_sink sink = {s, ty_fill_generator.frame_count(&s->part->fill)};
    ty_made made = {.frames = {.put = fill_take, .context = &sink}};
    ty_status status = ty_fill_generator.make(&s->part->fill, workers, &made, error);
    ty_free(made.report);
    return ty_loop_part_error(status, s->index, "fill", error);
}

// --- pictures ---

static ty_status missing(const source* s, const char* key, const char* what, ty_error* error)
{
    return ty_error_set(error, TY_BAD_INPUT, "volume[%d].%s: %s", s->index, key, what);
}

static ty_status slice_read_colors(const source* s, const char* path, const char* key, int z, ty_error* error)
{
    ty_loop_labels labels;
    ty_loop_volume* v = s->volume;
    ty_status status =
        ty_loop_labels_read(path, key, s->part->colors, v->size, z == 0 ? NULL : &v->palette, &labels, error);
    if (status != TY_OK)
        return status;
    if (z == 0)
        v->palette = labels.palette;
    ty_loop_labels_put(&labels, z, v);
    ty_loop_labels_term(&labels);
    return TY_OK;
}

static ty_status slice_read(const source* s, const ty_plane_file* file, int frame, int z, ty_error* error)
{
    char path[TY_PATH_MAX];
    float* values = NULL;
    if (s->part->colors > 0)
    {
        ty_path_frame(file->path, frame, path);
        return slice_read_colors(s, path, file->key, z, error);
    }
    ty_status status = ty_plane_file_read_channel(file, frame, (ty_plane_channel)s->part->channel, &values, error);
    if (status == TY_OK)
        slice_put(s, z, values);
    ty_free(values);
    return status;
}

// Every frame from the first to the last that is there.
static ty_status frames_find(const char* path, int* first, int* last, ty_error* error)
{
    ty_frame_numbers numbers;
    *first = *last = 0;
    if (!ty_path_is_sequence(path))
        return TY_OK;
    ty_status status = ty_frame_numbers_find(path, &numbers, error);
    if (status != TY_OK)
        return status;
    *first = numbers.numbers[0];
    *last = numbers.numbers[numbers.count - 1];
    ty_frame_numbers_term(&numbers);
    return TY_OK;
}

typedef struct pictures
{
    char key[64];
    ty_plane_file file;
    int first, last; // frames
    int size[3];     // of the volume
} pictures;

static ty_status pictures_find(const source* s, pictures* out, ty_error* error)
{
    const ty_loop_part* part = s->part;
    bool stack = part->source == TY_LOOP_STACK;
    snprintf(out->key, sizeof out->key, "volume[%d].files", s->index);
    if (!part->files)
        return missing(s, "files", "missing; the pictures of the volume", error);
    if (stack != ty_path_is_sequence(part->files))
        return missing(s, "files",
                       stack ? "a stack is named with #### for the number of the slice"
                             : "a still is one picture, without #",
                       error);
    ty_status status = frames_find(part->files, &out->first, &out->last, error);
    int count = out->last - out->first + 1;
    if (status == TY_OK && stack && count > TY_LOOP_DEPTH)
        status = ty_error_set(error, TY_BAD_INPUT, "%s: %d slices; at most %d", out->key, count, TY_LOOP_DEPTH);
    if (status == TY_OK)
        status = ty_plane_file_open(part->files, out->key, out->first, out->last, &out->file, error);
    out->size[0] = out->file.width;
    out->size[1] = out->file.height;
    out->size[2] = stack ? count : part->depth;
    return status;
}

static ty_status pictures_make(const source* s, ty_error* error)
{
    pictures p = {0};
    ty_loop_volume* v = s->volume;
    ty_status status = pictures_find(s, &p, error);
    if (status == TY_OK)
        status = ty_loop_volume_create(p.size, s->part->colors > 0, s->part->mix == TY_LOOP_MIX_BLEND, v, error);
    int count = p.last - p.first + 1;
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        status = slice_read(s, &p.file, p.first + i, i, error);
        if (status == TY_OK && ty_cancel_requested())
            status = ty_error_set(error, TY_INTERRUPTED, "interrupted while pictures were read");
    }
    for (int z = count; z < p.size[2] && status == TY_OK; z++) // of a still
        ty_loop_volume_copy(v, ty_loop_voxel(v, 0, 0, z), ty_loop_voxel(v, 0, 0, 0), v->slice);
    return status;
}

// --- raw ---

static size_t number_size(const ty_loop_raw* raw)
{
    return raw->type == TY_LOOP_U8 ? 1 : raw->type == TY_LOOP_U16 ? 2 : 4;
}

static float number_at(const ty_loop_raw* raw, const uint8_t* bytes, size_t i)
{
    uint8_t b[4];
    size_t size = number_size(raw);
    for (size_t k = 0; k < size; k++) // little-endian, as our machines are
        b[k] = bytes[i * size + (raw->big_endian ? size - 1 - k : k)];
    uint32_t bits = b[0];
    for (size_t k = 1; k < size; k++)
        bits |= (uint32_t)b[k] << (8 * k);
    float value;
    if (raw->type == TY_LOOP_U8)
        return (float)bits / 255.0f;
    if (raw->type == TY_LOOP_U16)
        return (float)bits / 65535.0f;
    memcpy(&value, &bits, sizeof value);
    return isfinite(value) ? value : 0.0f;
}

// Whether a file of so many bytes is the volume.
static ty_status raw_check(const source* s, size_t bytes, ty_error* error)
{
    const ty_loop_raw* raw = &s->part->raw;
    size_t voxels = (size_t)raw->width * (size_t)raw->height * (size_t)raw->depth;
    size_t want = voxels * number_size(raw) + (size_t)raw->header;
    if (bytes == want)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT,
                        "volume[%d].raw: '%s' has %zu bytes; %d x %d x %d numbers of %zu and a header of %d are %zu",
                        s->index, raw->file, bytes, raw->width, raw->height, raw->depth, number_size(raw), raw->header,
                        want);
}

static ty_status raw_find(const source* s, int size[3], ty_error* error)
{
    static const char* const sides[] = {"raw.width", "raw.height", "raw.depth"};
    const ty_loop_raw* raw = &s->part->raw;
    size_t bytes;
    size[0] = raw->width;
    size[1] = raw->height;
    size[2] = raw->depth;
    if (!raw->file)
        return missing(s, "raw.file", "missing; the numbers of the volume", error);
    for (int k = 0; k < 3; k++)
        if (size[k] < 1)
            return missing(s, sides[k], "the volume is empty; 1..2048 voxels", error);
    ty_status status = ty_file_size(raw->file, &bytes, error);
    return status == TY_OK ? raw_check(s, bytes, error) : status;
}

static ty_status raw_make(const source* s, ty_error* error)
{
    const ty_loop_raw* raw = &s->part->raw;
    int size[3];
    ty_bytes bytes = {0};
    ty_status status = raw_find(s, size, error);
    if (status == TY_OK)
        status = ty_file_read(raw->file, (size_t)64 << 30, &bytes, error);
    if (status == TY_OK)
        status = raw_check(s, bytes.size, error); // it may have changed since
    if (status == TY_OK)
        status = ty_loop_volume_create(size, false, false, s->volume, error);
    size_t i = 0;
    for (int z = 0; status == TY_OK && z < size[2]; z++)
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++, i++)
                s->volume->values[ty_loop_voxel(s->volume, x, y, z)] =
                    ty_loop_number_of((number_at(raw, bytes.data + raw->header, i) - s->low) * s->scale);
    ty_bytes_term(&bytes);
    return status;
}

// --- of any kind ---

ty_status ty_loop_source_check(const ty_loop_part* part, int index, int size[3], ty_error* error)
{
    source s = {.part = part, .index = index};
    pictures p = {0};
    ty_status status = ty_loop_range(part, index, 1.0f, &s.low, &s.scale, error);
    if (status != TY_OK)
        return status;
    switch ((ty_loop_source)part->source)
    {
    case TY_LOOP_REACTION:
        return ty_loop_reaction_check(part, index, size, error);
    case TY_LOOP_FILL:
        status = ty_loop_part_error(ty_fill_size(&part->fill, size, error), index, "fill", error);
        size[2] = ty_fill_generator.frame_count(&part->fill);
        break;
    case TY_LOOP_RAW:
        status = raw_find(&s, size, error);
        break;
    default:
        status = pictures_find(&s, &p, error);
        memcpy(size, p.size, sizeof p.size);
        break;
    }
    return status == TY_OK ? ty_loop_size_check(size, error) : status;
}

ty_status ty_loop_source_make(const ty_loop_part* part, int index, ty_workers* workers, ty_loop_volume* out,
                              ty_error* error)
{
    source s = {.part = part, .index = index, .volume = out};
    *out = (ty_loop_volume){0};
    if (part->source == TY_LOOP_REACTION)
        return ty_loop_reaction_make(part, index, workers, out, error);
    ty_status status = ty_loop_range(part, index, 1.0f, &s.low, &s.scale, error);
    if (status == TY_OK && part->source == TY_LOOP_FILL)
        status = fill_make(&s, workers, error);
    else if (status == TY_OK && part->source == TY_LOOP_RAW)
        status = raw_make(&s, error);
    else if (status == TY_OK)
        status = pictures_make(&s, error);
    out->wrap[0] = out->wrap[1] = part->wraps;
    if (status != TY_OK)
        ty_loop_volume_term(out);
    return status;
}
