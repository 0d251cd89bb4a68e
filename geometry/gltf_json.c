// SPDX-License-Identifier: Apache-2.0
// Fields of a glTF file's JSON.
#include "gltf_json.h"
#include <float.h>
#include <math.h>
#include <string.h>

bool ty_gltf_read_index(const json_t* object, const char* key, int64_t fallback, uint64_t maximum, int64_t* out)
{
    const json_t* value = json_object_get(object, key);
    if (!value)
    {
        *out = fallback;
        return fallback != -2;
    }
    if (!json_is_integer(value) || json_integer_value(value) < 0 || (uint64_t)json_integer_value(value) > maximum)
        return false;
    *out = json_integer_value(value);
    return true;
}

ty_status ty_gltf_get_list(const ty_gltf_checker* c, const char* key, const json_t** out)
{
    *out = json_object_get(c->root, key);
    if (*out && !json_is_array(*out))
        return TY_GLTF_FAIL(c, "\"%s\" is not an array", key);
    return TY_OK;
}

void ty_gltf_copy_name(const json_t* object, char name[128])
{
    const char* text = json_string_value(json_object_get(object, "name"));
    size_t length = text ? strnlen(text, 127) : 0;
    // not in the middle of a character of UTF-8
    while (text && length > 0 && text[length] && ((unsigned char)text[length] & 0xc0) == 0x80)
        length--;
    for (size_t i = 0; i < length; i++)
        name[i] = (unsigned char)text[i] < 0x20 || text[i] == 0x7f ? '_' : text[i];
    name[length] = 0;
}

bool ty_gltf_read_floats_of(const json_t* object, const char* key, int count, float* out)
{
    const json_t* list = json_object_get(object, key);
    if (!list)
        return true;
    float values[16];
    if (count > 16 || json_array_size(list) != (size_t)count)
        return false;
    for (int i = 0; i < count; i++)
    {
        const json_t* item = json_array_get(list, (size_t)i);
        double value = json_number_value(item);
        if (!json_is_number(item) || !isfinite(value) || fabs(value) > (double)FLT_MAX)
            return false;
        values[i] = (float)value;
    }
    memcpy(out, values, (size_t)count * sizeof(float));
    return true;
}

bool ty_gltf_read_float(const json_t* object, const char* key, float minimum, float maximum, float* out)
{
    const json_t* item = json_object_get(object, key);
    if (!item)
        return true;
    double value = json_number_value(item);
    if (!json_is_number(item) || !(value >= (double)minimum && value <= (double)maximum))
        return false;
    *out = (float)value;
    return true;
}

const json_t* ty_gltf_extension(const json_t* object, const char* name)
{
    return json_object_get(json_object_get(object, "extensions"), name);
}

const ty_gltf_accessor* ty_gltf_get_accessor(const ty_gltf_checker* c, const json_t* index)
{
    if (!json_is_integer(index) || json_integer_value(index) < 0 ||
        (size_t)json_integer_value(index) >= c->accessor_count)
        return NULL;
    return &c->accessors[json_integer_value(index)];
}
