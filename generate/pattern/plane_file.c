// SPDX-License-Identifier: Apache-2.0
// Images of patterns: found with all their frames, read as planes, refused when their sizes change.
#include "plane_file.h"
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

const char* const ty_plane_channel_names[] = {"luminance", "r", "g", "b", "a", NULL};

void ty_planes_term(ty_planes* planes)
{
    ty_free(planes->values);
    *planes = (ty_planes){0};
}

static ty_status frames_check(const char* path, const char* key, int first, int last, ty_error* error)
{
    char missing[128];
    ty_frame_numbers numbers;
    ty_status status = ty_frame_numbers_find(path, &numbers, error);
    if (status != TY_OK)
        return status;
    int count = ty_frame_numbers_missing(&numbers, first, last, missing, sizeof missing);
    ty_frame_numbers_term(&numbers);
    if (count == 0)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s: '%s' lacks %d of the frames %d..%d: %s", key, path, count, first,
                        last, missing);
}

static ty_status size_check(const ty_plane_file* file, const char* path, int width, int height, ty_error* error)
{
    if (width == file->width && height == file->height)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s: '%s' has %d x %d pixels, the first has %d x %d", file->key, path,
                        width, height, file->width, file->height);
}

static ty_status image_read(const ty_plane_file* file, int frame, ty_image* image, ty_error* error)
{
    char path[TY_PATH_MAX];
    ty_path_frame(file->path, frame, path);
    ty_status status = ty_image_read(path, image, error);
    if (status != TY_OK)
        return status;
    status = size_check(file, path, image->width, image->height, error); // it may have changed since
    if (status != TY_OK)
        ty_image_term(image);
    return status;
}

ty_status ty_plane_file_open(const char* path, const char* key, int first, int last, ty_plane_file* out,
                             ty_error* error)
{
    char name[TY_PATH_MAX];
    bool sequence = ty_path_is_sequence(path);
    *out = (ty_plane_file){path, key, 0, 0};
    ty_status status = sequence ? frames_check(path, key, first, last, error) : TY_OK;
    for (int frame = first; frame <= (sequence ? last : first) && status == TY_OK; frame++)
    {
        int width, height;
        ty_path_frame(path, frame, name);
        status = ty_image_read_size(name, &width, &height, error);
        if (status == TY_OK && frame == first)
        {
            out->width = width;
            out->height = height;
        }
        if (status == TY_OK)
            status = size_check(out, name, width, height, error);
    }
    return status;
}

// Interleaved to planes; channels beyond the first three are left out.
static ty_status planes_take(const ty_image* image, ty_planes* out, ty_error* error)
{
    const int count = 3;
    size_t size = (size_t)image->width * (size_t)image->height, step = (size_t)image->channels;
    *out = (ty_planes){image->width, image->height, count, TY_TRY_ALLOC(float, size*(size_t)count)};
    if (!out->values)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for an image of %d x %d", image->width, image->height);
    for (int c = 0; c < count; c++)
        for (size_t i = 0; i < size; i++)
            out->values[(size_t)c * size + i] = image->pixels[i * step + (size_t)c];
    return TY_OK;
}

static float channel_of(const float* pixel, int channels, ty_plane_channel channel)
{
    bool grey = channels < 3;
    if (channel == TY_PLANE_A)
        return channels == 2 ? pixel[1] : channels >= 4 ? pixel[3] : 1.0f;
    if (channel == TY_PLANE_LUMINANCE)
        return grey ? pixel[0] : 0.2126f * pixel[0] + 0.7152f * pixel[1] + 0.0722f * pixel[2];
    return pixel[grey ? 0 : channel - TY_PLANE_R];
}

ty_status ty_plane_file_read_channel(const ty_plane_file* file, int frame, ty_plane_channel channel, float** out,
                                     ty_error* error)
{
    ty_image image;
    *out = NULL;
    ty_status status = image_read(file, frame, &image, error);
    if (status != TY_OK)
        return status;
    size_t size = (size_t)image.width * (size_t)image.height;
    *out = TY_TRY_ALLOC(float, size);
    if (*out)
        for (size_t i = 0; i < size; i++)
            (*out)[i] = channel_of(image.pixels + i * (size_t)image.channels, image.channels, channel);
    else
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for an image of %d x %d", image.width, image.height);
    ty_image_term(&image);
    return status;
}

// Three channels a pixel; grey three times.
static void grey_to_rgb(const ty_image* image, float* rgb)
{
    size_t size = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < size; i++)
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] =
                channel_of(image->pixels + i * (size_t)image->channels, image->channels, TY_PLANE_R + c);
}

ty_status ty_plane_file_read_color(const ty_plane_file* file, int frame, const ty_color* color, ty_planes* out,
                                   ty_error* error)
{
    ty_image image;
    *out = (ty_planes){0};
    ty_status status = image_read(file, frame, &image, error);
    if (status != TY_OK)
        return status;
    ty_image rgb = image;
    rgb.channels = 3;
    rgb.pixels = TY_TRY_ALLOC(float, 3 * (size_t)image.width * (size_t)image.height);
    if (!rgb.pixels)
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for an image of %d x %d", image.width, image.height);
    if (status == TY_OK)
    {
        const char* space = ty_color_guess_space(color, image.is_float, image.color_space);
        grey_to_rgb(&image, rgb.pixels);
        status = ty_color_convert(color, space, "ACEScg", rgb.pixels, image.width * image.height, 3, error);
    }
    if (status == TY_OK)
        status = planes_take(&rgb, out, error);
    ty_free(rgb.pixels);
    ty_image_term(&image);
    return status;
}
