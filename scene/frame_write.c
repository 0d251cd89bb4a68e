// SPDX-License-Identifier: Apache-2.0
// Frames that a generator makes, to files: EXR as they are, PNG as sRGB shows them.
#include "loader.h"
#include <string.h>
#include <tsuya/image/image.h>

static ty_status png_write(const char* path, const ty_exr* frame, const ty_color* color, ty_error* error)
{
    const ty_exr_channel* planes[4] = {ty_exr_find_channel(frame, "R"), ty_exr_find_channel(frame, "G"),
                                       ty_exr_find_channel(frame, "B"), ty_exr_find_channel(frame, "A")};
    const ty_exr_channel* grey = ty_exr_find_channel(frame, "Y");
    int channels = planes[3] ? 4 : 3;
    ty_image image = {.width = ty_exr_width(frame), .height = ty_exr_height(frame), .channels = channels};
    size_t size = (size_t)image.width * (size_t)image.height;
    image.pixels = TY_TRY_ALLOC(float, size*(size_t)channels);
    if (!image.pixels)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a picture of %d x %d", image.width, image.height);
    for (int c = 0; c < channels; c++)
    {
        const ty_exr_channel* plane = planes[c] ? planes[c] : grey;
        for (size_t i = 0; plane && i < size; i++)
            image.pixels[i * (size_t)channels + (size_t)c] = ((const float*)plane->pixels)[i];
    }
    for (size_t i = 0; planes[3] && i < size; i++) // such files hold colours that are not multiplied by their alpha
    {
        float* pixel = image.pixels + 4 * i;
        for (int c = 0; c < 3 && pixel[3] > 0.0f; c++)
            pixel[c] /= pixel[3];
    }
    ty_status status =
        ty_color_convert(color, "ACEScg", "srgb_texture", image.pixels, image.width * image.height, channels, error);
    if (status == TY_OK)
        status = ty_image_write(path, &image, 8, error);
    ty_image_term(&image);
    return status;
}

ty_status ty_frame_write(const char* path, const ty_exr* frame, const ty_color* color, ty_error* error)
{
    return strcmp(ty_path_extension(path), "png") == 0 ? png_write(path, frame, color, error)
                                                       : ty_exr_write(path, frame, error);
}
