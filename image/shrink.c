// SPDX-License-Identifier: Apache-2.0
// Pictures made smaller by means over areas, first across, then down.
#include <tsuya/base/math.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/image.h>

// The mean of `from` values, `stride` apart, over the piece i of `to` equal ones.
static double piece_mean(const float* values, int64_t stride, int from, int i, int to)
{
    double begin = (double)i * from / to, end = (double)(i + 1) * from / to, sum = 0.0;
    for (int k = (int)begin; k < from && k < end; k++)
    {
        double low = k > begin ? k : begin, high = k + 1 < end ? k + 1 : end;
        sum += (high - low) * (double)values[k * stride];
    }
    return sum / (end - begin);
}

ty_status ty_image_shrink(const ty_image* image, int width, int height, ty_image* out, ty_error* error)
{
    TY_ASSERT(width >= 1 && width <= image->width && height >= 1 && height <= image->height);
    int64_t channels = image->channels, row = channels * image->width, narrow = channels * width;
    *out = *image;
    out->pixels = NULL;
    float* across = TY_TRY_ALLOC(float, narrow * image->height);
    float* pixels = across ? TY_TRY_ALLOC(float, narrow* height) : NULL;
    if (!pixels)
    {
        ty_free(across);
        return ty_error_set(error, TY_NO_MEMORY, "not enough memory for a smaller picture");
    }
    for (int64_t i = 0; i < narrow * image->height; i++)
    {
        int64_t y = i / narrow, x = i % narrow / channels, c = i % channels;
        across[i] = (float)piece_mean(image->pixels + y * row + c, channels, image->width, (int)x, width);
    }
    for (int64_t i = 0; i < narrow * height; i++)
    {
        pixels[i] = (float)piece_mean(across + i % narrow, narrow, image->height, (int)(i / narrow), height);
    }
    ty_free(across);
    out->width = width;
    out->height = height;
    out->pixels = pixels;
    return TY_OK;
}
