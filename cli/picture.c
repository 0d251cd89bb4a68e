// SPDX-License-Identifier: Apache-2.0
// Reading pictures for comparison, and grouping their channels.
#include "picture.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/memory.h>
#include <tsuya/image/color.h>
#include <tsuya/image/half.h>

// The space of a scanline EXR: what its chromaticities say, else linear Rec.709 as the format has it.
static void name_space(ty_picture* picture)
{
    const ty_exr_attribute* attribute = ty_exr_find_attribute(picture->exr, "chromaticities");
    bool told = attribute && attribute->type == TY_EXR_CHROMATICITIES;
    const char* space = told ? ty_chromaticities_space(attribute->value) : "lin_rec709";
    snprintf(picture->color_space, sizeof picture->color_space, "%s", space ? space : "ACEScg");
}

static ty_status planes_of(const ty_image* image, ty_picture* out, ty_error* error)
{
    static const char* const grey[] = {"Y", "A"};
    static const char* const color[] = {"R", "G", "B", "A"};
    if (image->channels > 4)
    {
        return ty_error_set_at(error, TY_BAD_FILE, out->path, 0, 0,
                               "%d channels in a file that is no scanline, single-part EXR: which are which is not "
                               "known",
                               image->channels);
    }
    int window[4] = {0, 0, image->width - 1, image->height - 1};
    out->exr = ty_exr_create(window, window);
    for (int c = 0; c < image->channels; c++)
    {
        float* plane = ty_exr_add_channel(out->exr, image->channels < 3 ? grey[c] : color[c], TY_EXR_FLOAT);
        for (int64_t i = 0; i < (int64_t)image->width * image->height; i++)
        {
            plane[i] = image->pixels[i * image->channels + c];
        }
    }
    return TY_OK;
}

static ty_status read_other(const char* path, ty_picture* out, ty_error* error)
{
    ty_image image;
    ty_status status = ty_image_read(path, &image, error);
    if (status != TY_OK)
    {
        return status;
    }
    out->is_display = !image.is_float;
    snprintf(out->color_space, sizeof out->color_space, "%s", image.color_space[0] ? image.color_space : "lin_rec709");
    status = planes_of(&image, out, error);
    ty_image_term(&image);
    return status;
}

ty_status ty_picture_read(const char* path, ty_picture* out, ty_error* error)
{
    *out = (ty_picture){.path = path};
    if (strcmp(ty_path_extension(path), "exr") == 0 && ty_exr_read(path, &out->exr, error) == TY_OK)
    {
        name_space(out);
        return TY_OK;
    }
    return read_other(path, out, error); // says what is wrong with an EXR too
}

void ty_picture_from_render(ty_exr* exr, const char* path, ty_picture* out)
{
    *out = (ty_picture){.path = path, .exr = exr};
    int64_t count = (int64_t)ty_exr_width(exr) * ty_exr_height(exr);
    for (int c = 0; c < exr->channel_count; c++)
    {
        float* pixels = exr->channels[c].pixels;
        for (int64_t i = 0; i < count && exr->channels[c].type == TY_EXR_HALF; i++)
        {
            pixels[i] = ty_half_to_float(ty_half_from_float(pixels[i]));
        }
    }
    name_space(out);
}

void ty_picture_term(ty_picture* picture)
{
    ty_exr_destroy(picture->exr);
    *picture = (ty_picture){0};
}

// --- layers ---

static void split_name(const char* channel, char layer[64], const char** component)
{
    const char* dot = strrchr(channel, '.');
    bool beauty = strlen(channel) == 1 && strchr("RGBY", channel[0]);
    snprintf(layer, 64, "%.*s", dot ? (int)(dot - channel) : 63, beauty ? "beauty" : channel);
    *component = dot ? dot + 1 : channel;
}

// Red before green before blue, x before y before z, whatever the file's order.
static int rank(const char* component)
{
    static const char* const known[] = {"R", "X", "r", "x", "G", "Y", "g", "y", "B", "Z", "b", "z", "A", "a"};
    for (int i = 0; i < TY_PARAM_COUNT(known); i++)
    {
        if (strcmp(component, known[i]) == 0)
        {
            return i / 4;
        }
    }
    return 4;
}

static void add_channel(ty_layer* layer, const char* name)
{
    if (layer->channel_count == TY_LAYER_CHANNELS)
    {
        return;
    }
    char ignored[64];
    const char *mine, *other;
    split_name(name, ignored, &mine);
    int i = layer->channel_count++;
    for (; i > 0; i--)
    {
        split_name(layer->channels[i - 1], ignored, &other);
        if (rank(other) <= rank(mine))
        {
            break;
        }
        memcpy(layer->channels[i], layer->channels[i - 1], sizeof layer->channels[i]);
    }
    snprintf(layer->channels[i], sizeof layer->channels[i], "%s", name);
}

static ty_layer* find_layer(ty_layer* layers, int* count, const char* name)
{
    for (int i = 0; i < *count; i++)
    {
        if (strcmp(layers[i].name, name) == 0)
        {
            return &layers[i];
        }
    }
    if (*count == TY_LAYERS_MAX)
    {
        return NULL;
    }
    ty_layer* layer = &layers[(*count)++];
    *layer = (ty_layer){0};
    snprintf(layer->name, sizeof layer->name, "%s", name);
    return layer;
}

int ty_picture_layers(const ty_picture* picture, ty_layer out[TY_LAYERS_MAX])
{
    int count = 0;
    for (int i = 0; i < picture->exr->channel_count; i++)
    {
        char name[64];
        const char* component;
        split_name(picture->exr->channels[i].name, name, &component);
        ty_layer* layer = find_layer(out, &count, name);
        if (layer)
        {
            add_channel(layer, picture->exr->channels[i].name);
        }
    }
    for (int i = 1; i < count; i++)
    {
        if (strcmp(out[i].name, "beauty") == 0)
        {
            ty_layer first = out[i];
            memmove(&out[1], &out[0], (size_t)i * sizeof out[0]);
            out[0] = first;
        }
    }
    return count;
}

bool ty_layer_is_color(const ty_layer* layer)
{
    static const char* const wanted[] = {"R", "G", "B"};
    char ignored[64];
    const char* component;
    for (int i = 0; i < 3 && layer->channel_count == 3; i++)
    {
        split_name(layer->channels[i], ignored, &component);
        if (strcmp(component, wanted[i]) != 0)
        {
            return false;
        }
    }
    return layer->channel_count == 3;
}

ty_status ty_picture_take(const ty_picture* picture, const ty_layer* layer, const int window[4], ty_image* out,
                          ty_error* error)
{
    int width = window[2] - window[0] + 1, height = window[3] - window[1] + 1;
    *out = (ty_image){.width = width, .height = height, .channels = layer->channel_count};
    out->pixels = TY_TRY_ALLOC(float, (size_t)width*(size_t)height*(size_t)layer->channel_count);
    if (!out->pixels)
    {
        return ty_error_set_at(error, TY_NO_MEMORY, picture->path, 0, 0, "not enough memory to compare");
    }
    const int* data = picture->exr->data_window;
    for (int c = 0; c < layer->channel_count; c++)
    {
        const ty_exr_channel* channel = ty_exr_find_channel(picture->exr, layer->channels[c]);
        for (int64_t i = 0; i < (int64_t)width * height; i++)
        {
            int64_t x = window[0] - data[0] + i % width, y = window[1] - data[1] + i / width;
            int64_t from = y * ty_exr_width(picture->exr) + x;
            out->pixels[i * layer->channel_count + c] = channel->type == TY_EXR_UINT
                                                            ? (float)((const uint32_t*)channel->pixels)[from]
                                                            : ((const float*)channel->pixels)[from];
        }
    }
    return TY_OK;
}
