// SPDX-License-Identifier: Apache-2.0
// The image in memory that EXR files are read into and written from.
#include <string.h>
#include <tsuya/image/exr.h>

ty_exr* ty_exr_create(const int data_window[4], const int display_window[4])
{
    ty_exr* exr = TY_ALLOC(ty_exr, 1);
    memcpy(exr->data_window, data_window, sizeof exr->data_window);
    memcpy(exr->display_window, display_window, sizeof exr->display_window);
    return exr;
}

void ty_exr_destroy(ty_exr* exr)
{
    if (!exr)
        return;
    for (int i = 0; i < exr->channel_count; i++)
        ty_free(exr->channels[i].pixels);
    for (int i = 0; i < exr->attribute_count; i++)
        ty_free(exr->attributes[i].text);
    ty_free(exr->channels);
    ty_free(exr->attributes);
    ty_free(exr);
}

void* ty_exr_add_channel(ty_exr* exr, const char* name, ty_exr_type type)
{
    TY_ASSERT(name[0] && strlen(name) < sizeof exr->channels->name);
    TY_ASSERT(!ty_exr_find_channel(exr, name));
    TY_ASSERT(ty_exr_width(exr) > 0 && ty_exr_height(exr) > 0);
    size_t count = (size_t)exr->channel_count;
    exr->channels = ty_grow(exr->channels, count, count + 1, sizeof *exr->channels);
    ty_exr_channel* channel = &exr->channels[exr->channel_count++];
    *channel = (ty_exr_channel){.type = type};
    strcpy(channel->name, name);
    channel->pixels = ty_alloc((size_t)ty_exr_width(exr) * (size_t)ty_exr_height(exr), sizeof(float));
    return channel->pixels;
}

// The attribute of that name, emptied, or a new one.
static ty_exr_attribute* set_attribute(ty_exr* exr, const char* name, ty_exr_attribute_type type)
{
    TY_ASSERT(name[0] && strlen(name) < sizeof exr->attributes->name);
    ty_exr_attribute* attribute = (ty_exr_attribute*)ty_exr_find_attribute(exr, name);
    if (attribute)
        ty_free(attribute->text);
    else
    {
        size_t count = (size_t)exr->attribute_count;
        exr->attributes = ty_grow(exr->attributes, count, count + 1, sizeof *exr->attributes);
        attribute = &exr->attributes[exr->attribute_count++];
    }
    *attribute = (ty_exr_attribute){.type = type};
    strcpy(attribute->name, name);
    return attribute;
}

void ty_exr_add_string(ty_exr* exr, const char* name, const char* text)
{
    char* copy = ty_string_copy(text); // first: text may be the one that is replaced
    set_attribute(exr, name, TY_EXR_STRING)->text = copy;
}

void ty_exr_add_float(ty_exr* exr, const char* name, float value)
{
    set_attribute(exr, name, TY_EXR_FLOAT1)->value[0] = value;
}

void ty_exr_add_int(ty_exr* exr, const char* name, int value)
{
    set_attribute(exr, name, TY_EXR_INT1)->integer[0] = value;
}

void ty_exr_add_matrix(ty_exr* exr, const char* name, const float value[16])
{
    memcpy(set_attribute(exr, name, TY_EXR_MATRIX44)->value, value, 16 * sizeof(float));
}

void ty_exr_add_chromaticities(ty_exr* exr, const float value[8])
{
    memcpy(set_attribute(exr, "chromaticities", TY_EXR_CHROMATICITIES)->value, value, 8 * sizeof(float));
}

void ty_exr_add_rational(ty_exr* exr, const char* name, int numerator, unsigned denominator)
{
    ty_exr_attribute* attribute = set_attribute(exr, name, TY_EXR_RATIONAL);
    attribute->integer[0] = numerator;
    attribute->integer[1] = (int)denominator;
}

void ty_exr_add_latlong(ty_exr* exr)
{
    set_attribute(exr, "envmap", TY_EXR_ENVMAP)->integer[0] = 0;
}

const ty_exr_channel* ty_exr_find_channel(const ty_exr* exr, const char* name)
{
    for (int i = 0; i < exr->channel_count; i++)
        if (strcmp(exr->channels[i].name, name) == 0)
            return &exr->channels[i];
    return NULL;
}

const ty_exr_attribute* ty_exr_find_attribute(const ty_exr* exr, const char* name)
{
    for (int i = 0; i < exr->attribute_count; i++)
        if (strcmp(exr->attributes[i].name, name) == 0)
            return &exr->attributes[i];
    return NULL;
}
