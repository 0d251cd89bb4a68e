// SPDX-License-Identifier: Apache-2.0
// One texture: the files of its frames, which of them a time shows, and lookups in those.
#include "mip_lookup.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

struct ty_mip_texture
{
    ty_mip_cache* cache;
    ty_mip_texture_def def;      // its texts are owned
    int first, frame_count;      // number of the first; 1 for a single image
    const ty_mip_image** frames; // [frame_count], NULL until they were shown
    const ty_mip_image* any;     // one of them: all are of its size
    const ty_mip_image* shown[2];
    float weight; // of the second
};

ty_mip_texture_def ty_mip_texture_def_default(void)
{
    return (ty_mip_texture_def){
        .wrap = {TY_WRAP_REPEAT, TY_WRAP_REPEAT}, .last = -1, .fps = 24.0f, .end = TY_SEQUENCE_STOP};
}

static ty_status find_frames(const ty_mip_texture_def* def, int* first, int* count, ty_error* error)
{
    ty_frame_numbers found;
    ty_status status = ty_frame_numbers_find(def->path, &found, error);
    if (status)
        return status;
    bool all = def->last < def->first;
    int last = all ? found.numbers[found.count - 1] : def->last;
    *first = all ? found.numbers[0] : def->first;
    *count = last - *first + 1;
    char list[400];
    if (ty_frame_numbers_missing(&found, *first, last, list, sizeof list) > 0)
        status = ty_error_set_at(error, TY_BAD_FILE, def->path, 0, 0, "frames %s missing of %d-%d", list, *first, last);
    ty_frame_numbers_term(&found);
    return status;
}

ty_status ty_mip_texture_create(ty_mip_cache* cache, const ty_mip_texture_def* def, ty_mip_texture** out,
                                ty_error* error)
{
    *out = NULL;
    int first = 0, count = 1;
    TY_ASSERT(def->fps > 0.0f);
    if (ty_path_is_sequence(def->path))
    {
        ty_status status = find_frames(def, &first, &count, error);
        if (status)
            return status;
    }
    ty_mip_texture* texture = TY_ALLOC(ty_mip_texture, 1);
    *texture = (ty_mip_texture){.cache = cache, .def = *def, .first = first, .frame_count = count};
    texture->def.path = ty_string_copy(def->path);
    texture->def.color_space = def->color_space ? ty_string_copy(def->color_space) : NULL;
    texture->def.channel = def->channel ? ty_string_copy(def->channel) : NULL;
    texture->frames = TY_ALLOC(const ty_mip_image*, count);
    *out = texture;
    return TY_OK;
}

void ty_mip_texture_destroy(ty_mip_texture* texture)
{
    if (!texture)
        return;
    ty_free((char*)texture->def.path);
    ty_free((char*)texture->def.color_space);
    ty_free((char*)texture->def.channel);
    ty_free(texture->frames);
    ty_free(texture);
}

int ty_mip_texture_frame_count(const ty_mip_texture* texture)
{
    return texture->frame_count;
}

static ty_status other_size(const char* path, int width, int height, int first_width, int first_height, ty_error* error)
{
    return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "a frame of %d x %d in a sequence of %d x %d", width, height,
                           first_width, first_height);
}

ty_status ty_mip_texture_verify(const ty_mip_texture* texture, ty_error* error)
{
    char path[TY_PATH_MAX];
    int width = 0, height = 0;
    ty_status status = TY_OK;
    for (int i = 0; i < texture->frame_count && !status; i++)
    {
        ty_image image;
        ty_path_frame(texture->def.path, texture->first + i, path);
        status = ty_image_read_channel(path, texture->def.channel, &image, error);
        if (status)
            break;
        width = i ? width : image.width;
        height = i ? height : image.height;
        if (image.width != width || image.height != height)
            status = other_size(path, image.width, image.height, width, height, error);
        ty_image_term(&image);
    }
    const char* space = texture->def.color_space;
    float black[3] = {0.0f, 0.0f, 0.0f};
    if (!status && !texture->def.channel && space && strcmp(space, "raw") != 0)
        status = ty_color_convert(texture->cache->color, space, "ACEScg", black, 1, 3, error);
    return status;
}

// Where a position in frames falls under repetition; false = outside. NaN and infinities are outside.
static bool wrap_position(int end, int count, double* position)
{
    double period = end == TY_SEQUENCE_MIRROR ? 2.0 * (count - 1) : count, p = *position;
    if (!(fabs(p) < 1e15))
        return false;
    switch ((ty_sequence_end)end)
    {
    case TY_SEQUENCE_STOP:
        return p >= 0.0 && p < (double)count;
    case TY_SEQUENCE_HOLD:
        *position = p < 0.0 ? 0.0 : p > count - 1 ? count - 1 : p;
        break;
    case TY_SEQUENCE_LOOP:
    case TY_SEQUENCE_MIRROR:
        *position = period > 0.0 ? p - period * floor(p / period) : 0.0;
        break;
    }
    return true;
}

bool ty_sequence_at(const ty_mip_texture_def* def, int frame_count, double seconds, int frame[2], float* weight)
{
    double position = (seconds - (double)def->start) * (double)def->fps, whole = floor(position + 0.5);
    // Frame times are quotients: 7 / 24 s times 24 may fall just short of 7.
    if (fabs(position - whole) < 1e-4)
        position = whole;
    *weight = 0.0f;
    frame[0] = frame[1] = 0;
    if (!wrap_position(def->end, frame_count, &position))
        return false;
    int base = (int)position, next = base + 1, last = frame_count - 1;
    bool mirror = def->end == TY_SEQUENCE_MIRROR, loop = def->end == TY_SEQUENCE_LOOP;
    frame[0] = base <= last ? base : mirror ? 2 * last - base : 0;
    frame[1] = next <= last ? next : mirror ? 2 * last - next : loop ? 0 : last;
    if (def->blend)
        *weight = (float)(position - (double)base);
    if (*weight <= 0.0f || frame[0] == frame[1])
    {
        frame[1] = frame[0];
        *weight = 0.0f;
    }
    return true;
}

static ty_status load_frame(ty_mip_texture* texture, int i, ty_error* error)
{
    char path[TY_PATH_MAX];
    const ty_mip_image* image = NULL;
    if (texture->frames[i])
        return TY_OK;
    ty_path_frame(texture->def.path, texture->first + i, path);
    ty_status status = ty_mip_cache_get(texture->cache, &texture->def, path, &image, error);
    if (status)
        return status;
    const ty_oiio_tile_file *file = &image->file, *other = texture->any ? &texture->any->file : file;
    if (file->width != other->width || file->height != other->height)
        return other_size(path, file->width, file->height, other->width, other->height, error);
    texture->any = texture->frames[i] = image;
    return TY_OK;
}

ty_status ty_mip_texture_set_time(ty_mip_texture* texture, double seconds, ty_error* error)
{
    int frame[2];
    float weight = 0.0f;
    if (!ty_path_is_sequence(texture->def.path))
        frame[0] = frame[1] = 0;
    else if (!ty_sequence_at(&texture->def, texture->frame_count, seconds, frame, &weight))
        return ty_error_set_at(error, TY_BAD_INPUT, texture->def.path, 0, 0,
                               "%g s is outside of the sequence's %g to %g s: say loop, hold or mirror", seconds,
                               (double)texture->def.start,
                               (double)texture->def.start + texture->frame_count / (double)texture->def.fps);
    for (int i = 0; i < 2; i++)
    {
        ty_status status = load_frame(texture, frame[i], error);
        if (status)
            return status;
    }
    texture->shown[0] = texture->frames[frame[0]];
    texture->shown[1] = texture->frames[frame[1]];
    texture->weight = weight;
    return TY_OK;
}

static ty_texel texel_of(const float v[4], int channels)
{
    if (channels < 3)
        return (ty_texel){ty_rgb_grey(v[0]), channels == 2 ? v[1] : 1.0f};
    return (ty_texel){ty_rgb_make(v[0], v[1], v[2]), channels == 4 ? v[3] : 1.0f};
}

ty_texel ty_mip_texture_sample(const ty_mip_texture* texture, ty_vec2 uv, ty_vec2 du, ty_vec2 dv)
{
    float first[4] = {0.0f, 0.0f, 0.0f, 0.0f}, second[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    const ty_mip_image* const* shown = texture->shown;
    ty_mip_image_add(texture->cache, shown[0], texture->def.wrap, uv, du, dv, 1.0f, first);
    ty_texel a = texel_of(first, shown[0]->file.channels);
    if (texture->weight <= 0.0f)
        return a;
    ty_mip_image_add(texture->cache, shown[1], texture->def.wrap, uv, du, dv, 1.0f, second);
    ty_texel b = texel_of(second, shown[1]->file.channels);
    return (ty_texel){ty_rgb_lerp(a.rgb, b.rgb, texture->weight), ty_lerp(a.alpha, b.alpha, texture->weight)};
}
