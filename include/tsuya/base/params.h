// SPDX-License-Identifier: Apache-2.0
// Parameter tables: one row per field of a _def struct. From them come the YAML reader, help, schema and docs.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <tsuya/base/hash.h>
#include <tsuya/base/math.h>

// What a field holds in memory (at row.offset) and how it is written.
typedef enum ty_param_type
{
    TY_PARAM_BOOL,         // bool
    TY_PARAM_INT,          // int
    TY_PARAM_INT2,         // int[2]
    TY_PARAM_FLOAT,        // float
    TY_PARAM_FLOAT2,       // float[2]; one number written = both
    TY_PARAM_FLOAT3,       // ty_vec3; not extended from one number
    TY_PARAM_RGB,          // ty_rgb, ACEScg unless a colour space is named; one number = grey
    TY_PARAM_SEED,         // ty_seed
    TY_PARAM_STRING,       // const char*, owned by the reader's arena
    TY_PARAM_PATH,         // const char*, resolved against the file's folder and the search paths
    TY_PARAM_FRAMES,       // the same, or a pattern with #### for the numbers of frames
    TY_PARAM_ENUM,         // int, index into choices
    TY_PARAM_SCALAR_INPUT, // ty_input: a number, { texture: name, ... } or { attribute: name, scale:, offset: }
    TY_PARAM_COLOR_INPUT,  // ty_input with three channels
    TY_PARAM_VECTOR_INPUT, // ty_input with three signed numbers of a texture: -1 + 2 * texel unless said
    TY_PARAM_GROUP,        // a nested struct in place, described by group
    TY_PARAM_BRIEF_GROUP,  // the same; may be written as what its first row is, an input or a text
    TY_PARAM_LIST,         // ty_param_list of structs described by group
    TY_PARAM_POINTS,       // ty_param_list of ty_vec3: a list of [x, y, z]
    TY_PARAM_POINTS2,      // ty_param_list of ty_vec2: a list of [x, y]
    TY_PARAM_NAMES,        // ty_param_list of ty_param_name: a mapping of names to names
    TY_PARAM_STRINGS,      // ty_param_strings: a list of texts, or one
} ty_param_type;

typedef enum ty_input_mapping
{
    TY_MAPPING_UV,        // the mesh's texture coordinates
    TY_MAPPING_TRIPLANAR, // along three axes, by the normal; needs no uv
    TY_MAPPING_PLANAR,    // along y alone, from above; the same
} ty_input_mapping;

// Whose axes they are.
typedef enum ty_input_space
{
    TY_SPACE_OBJECT, // each instance has its own
    TY_SPACE_WORLD,
} ty_input_space;

typedef enum ty_input_channel
{
    TY_CHANNEL_ALL, // a number takes the first
    TY_CHANNEL_R,
    TY_CHANNEL_G,
    TY_CHANNEL_B,
    TY_CHANNEL_A,
    TY_CHANNEL_LUMINANCE,
} ty_input_channel;

// Where colours are multiplied: products of saturated ones differ between spaces.
typedef enum ty_input_product
{
    TY_PRODUCT_ACESCG,
    TY_PRODUCT_REC709, // as files mean it whose colours are of that space
} ty_input_product;

// A parameter of a surface: a constant, optionally times a texture or an attribute.
typedef struct ty_input
{
    ty_rgb value;          // a scalar uses .r
    const char* texture;   // asset name or path, NULL = none
    const char* attribute; // name of an attribute of instances, else of vertices; NULL = none
    float scale, offset;   // applied to what the texture or attribute gives: offset + scale * x
    int texture_index;     // set by scene/, -1 = none
    int attribute_index;   // set by scene/, -1 = none
    int product;           // ty_input_product, of value, texture and attribute
    // Of textures alone.
    int mapping, channel;     // ty_input_mapping, ty_input_channel
    ty_vec2 uv_x, uv_y, uv_t; // the texture is looked up at uv_x * u + uv_y * v + uv_t
    int space;                // ty_input_space, of all mappings but uv
    float size;               // m: side of one repetition, likewise
    float blend;              // 0..1: how far the three directions reach into one another
} ty_input;

static inline ty_input ty_input_make(ty_rgb value)
{
    return (ty_input){.value = value,
                      .scale = 1.0f,
                      .texture_index = -1,
                      .attribute_index = -1,
                      .uv_x = {1.0f, 0.0f},
                      .uv_y = {0.0f, 1.0f},
                      .size = 0.1f,
                      .blend = 0.3f};
}
static inline ty_input ty_input_scalar(float value)
{
    return ty_input_make((ty_rgb){value, value, value});
}
// offset + R(angle) (scale * uv), counter-clockwise as v goes up: as KHR_texture_transform but for its v downwards.
static inline void ty_input_place_uv(ty_input* input, ty_vec2 scale, float angle, ty_vec2 offset)
{
    float s, c;
    ty_sincos(angle, &s, &c);
    input->uv_x = (ty_vec2){scale.x * c, scale.x * s};
    input->uv_y = (ty_vec2){-scale.y * s, scale.y * c};
    input->uv_t = offset;
}

typedef struct ty_param_list
{
    void* items; // count structs of group->size bytes, owned by the reader's arena
    int count;
} ty_param_list;

// An entry of TY_PARAM_NAMES.
typedef struct ty_param_name
{
    const char *key, *value;
} ty_param_name;

typedef struct ty_param_strings
{
    const char** items; // owned by the reader's arena
    int count;
} ty_param_strings;

typedef struct ty_param_table ty_param_table;

typedef struct ty_param
{
    const char* name; // as in YAML
    ty_param_type type;
    const char* unit;           // "m", "deg" (stored in radians), "mm" (stored in metres), "um" (as it is), "s", "" ...
    double minimum, maximum;    // per component, inclusive, in the written unit; both 0 = unbounded
    const char* const* choices; // ENUM: names, NULL-terminated
    const ty_param_table* group; // GROUP, BRIEF_GROUP, LIST
    size_t offset;
    const char* help; // one line
    bool required;
} ty_param;

struct ty_param_table
{
    const char* name;               // "film", "material.cdrf" ...: also the heading in the reference
    const char* help;               // one or two sentences
    size_t size;                    // of the struct
    void (*set_default)(void* def); // defaults come from the struct's default function, nowhere else
    const ty_param* params;
    int count;
};

// Adds what def holds to the hash: values by their names, texts by their content, but of paths only whether there is
// one, as what stands in the file is another matter. skip: rows that do not count, by their dotted paths
// ("settle.max_seconds"), up to NULL; a group takes all below it.
void ty_params_add_to_hash(const ty_param_table* table, const void* def, const char* const* skip, ty_hasher* hasher);

#define TY_PARAM_COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))
