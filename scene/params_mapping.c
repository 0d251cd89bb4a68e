// SPDX-License-Identifier: Apache-2.0
// How the texture of an input lies on the surface, and which of its channels counts.
#include "params_read.h"
#include <string.h>

static const char* const mappings[] = {"uv", "triplanar", "planar", NULL};
static const char* const spaces[] = {"object", "world", NULL};
static const char* const wraps[] = {"repeat", "clamp", "mirror", NULL};
static const char* const channels[] = {"all", "r", "g", "b", "a", "luminance", NULL};

typedef struct placement
{
    float scale[2], offset[2];
    float rotate;
} placement;

static void placement_default(void* def)
{
    *(placement*)def = (placement){.scale = {1.0f, 1.0f}};
}

static const ty_param placement_rows[] = {
    {.name = "scale",
     .type = TY_PARAM_FLOAT2,
     .unit = "",
     .minimum = -1e6,
     .maximum = 1e6,
     .offset = offsetof(placement, scale)},
    {.name = "offset",
     .type = TY_PARAM_FLOAT2,
     .unit = "",
     .minimum = -1e6,
     .maximum = 1e6,
     .offset = offsetof(placement, offset)},
    {.name = "rotate",
     .type = TY_PARAM_FLOAT,
     .unit = "deg",
     .minimum = -36000,
     .maximum = 36000,
     .offset = offsetof(placement, rotate)},
};

static const ty_param_table placement_table = {.name = "uv",
                                               .size = sizeof(placement),
                                               .set_default = placement_default,
                                               .params = placement_rows,
                                               .count = TY_PARAM_COUNT(placement_rows)};

static const ty_param rows[] = {
    {.name = "mapping", .type = TY_PARAM_ENUM, .unit = "", .choices = mappings, .offset = offsetof(ty_input, mapping)},
    {.name = "space", .type = TY_PARAM_ENUM, .unit = "", .choices = spaces, .offset = offsetof(ty_input, space)},
    {.name = "size",
     .type = TY_PARAM_FLOAT,
     .unit = "m",
     .minimum = 1e-6,
     .maximum = 1e6,
     .offset = offsetof(ty_input, size)},
    {.name = "blend",
     .type = TY_PARAM_FLOAT,
     .unit = "",
     .minimum = 0,
     .maximum = 1,
     .offset = offsetof(ty_input, blend)},
};

// One word, or one for u and one for v.
static bool read_wrap(ty_reader* reader, ty_node* said, int wrap[2])
{
    static const ty_param row = {.name = "wrap", .type = TY_PARAM_ENUM, .unit = "", .choices = wraps};
    bool two = said->kind == TY_NODE_LIST && said->count == 2;
    bool good = ty_param_read(reader, two ? said->items[0] : said, &row, &wrap[0]);
    wrap[1] = wrap[0];
    return good && (!two || ty_param_read(reader, said->items[1], &row, &wrap[1]));
}

// One of the picture's own, or a further one of the file, by its name.
static bool read_channel(ty_reader* reader, ty_node* said, ty_input* input, const ty_node** layer)
{
    static const ty_param row = {.name = "channel", .type = TY_PARAM_STRING, .unit = ""};
    const char* name;
    if (!ty_param_read(reader, said, &row, &name))
        return false;
    for (int i = 0; channels[i]; ++i)
        if (strcmp(channels[i], name) == 0)
        {
            input->channel = i;
            return true;
        }
    *layer = said;
    return true;
}

bool ty_param_read_mapping(ty_reader* reader, const ty_node* node, ty_input* input, int wrap[2], const ty_node** layer)
{
    bool good = true;
    ty_node* channel = ty_node_get(node, "channel");
    if (channel)
        good = read_channel(reader, channel, input, layer);
    for (int i = 0; i < TY_PARAM_COUNT(rows); ++i)
    {
        ty_node* value = ty_node_get(node, rows[i].name);
        if (!value)
            continue;
        good &= ty_param_read(reader, value, &rows[i], (char*)input + rows[i].offset);
        bool blends = rows[i].offset == offsetof(ty_input, blend);
        if (i > 0 && input->mapping != TY_MAPPING_TRIPLANAR && (blends || input->mapping != TY_MAPPING_PLANAR))
        {
            ty_report(reader->errors, value->place, TY_BAD_INPUT, "'%s' means nothing without 'mapping: triplanar'%s",
                      rows[i].name, blends ? "" : " or 'planar'");
            good = false;
        }
    }
    ty_node *uv = ty_node_get(node, "uv"), *said = ty_node_get(node, "wrap");
    if (said)
        good &= read_wrap(reader, said, wrap);
    placement place;
    if (!uv)
        return good;
    if (!ty_params_read(reader, uv, &placement_table, &place, NULL))
        return false;
    ty_input_place_uv(input, (ty_vec2){place.scale[0], place.scale[1]}, place.rotate,
                      (ty_vec2){place.offset[0], place.offset[1]});
    return good;
}
