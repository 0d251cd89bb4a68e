// SPDX-License-Identifier: Apache-2.0
// Table and defaults of lights, and which keys belong to which kind.
#include "scene_params.h"
#include <string.h>

#define MANY 1e30

ty_light_def ty_light_def_default(void)
{
    return (ty_light_def){.kind = TY_LIGHT_ENVIRONMENT,
                          .radiance = {1.0f, 1.0f, 1.0f},
                          .intensity = {1.0f, 1.0f, 1.0f},
                          .irradiance = {1.0f, 1.0f, 1.0f},
                          .center = {0.0f, 1.0f, 0.0f},
                          .up = {0.0f, 1.0f, 0.0f},
                          .size = {1.0f, 1.0f},
                          .radius = 0.1f,
                          .camera_visible = true};
}

static void light_default(void* def)
{
    *(ty_light_def*)def = ty_light_def_default();
}

static const char* const kinds[] = {"environment", "rectangle", "sphere", "point", "directional", NULL};

static const ty_param rows[] = {
    {"name", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_light_def, name), "for overrides: lights.NAME.radiance",
     false},
    {"type", TY_PARAM_ENUM, "", 0, 0, kinds, NULL, offsetof(ty_light_def, kind), "kind of light", true},
    {"radiance", TY_PARAM_RGB, "W/(m^2 sr)", 0, MANY, NULL, NULL, offsetof(ty_light_def, radiance),
     "environment (times the image), rectangle, sphere", false},
    {"intensity", TY_PARAM_RGB, "W/sr", 0, MANY, NULL, NULL, offsetof(ty_light_def, intensity), "point", false},
    {"irradiance", TY_PARAM_RGB, "W/m^2", 0, MANY, NULL, NULL, offsetof(ty_light_def, irradiance),
     "directional: on a plane that faces it", false},
    {"center", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, offsetof(ty_light_def, center),
     "place of a rectangle, sphere or point; directional light goes from here towards target", false},
    {"target", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, offsetof(ty_light_def, target),
     "what a rectangle faces, or a directional light goes towards", false},
    {"up", TY_PARAM_FLOAT3, "", -1e9, 1e9, NULL, NULL, offsetof(ty_light_def, up), "rectangle: direction of its height",
     false},
    {"size", TY_PARAM_FLOAT2, "m", 1e-9, 1e9, NULL, NULL, offsetof(ty_light_def, size),
     "rectangle: full width and height", false},
    {"radius", TY_PARAM_FLOAT, "m", 1e-9, 1e9, NULL, NULL, offsetof(ty_light_def, radius), "sphere", false},
    {"image", TY_PARAM_PATH, "", 0, 0, NULL, NULL, offsetof(ty_light_def, image),
     "environment: latitude-longitude image, y up", false},
    {"color_space", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_light_def, color_space),
     "of the image; guessed from the file if not given", false},
    {"rotate", TY_PARAM_FLOAT, "deg", -3600, 3600, NULL, NULL, offsetof(ty_light_def, rotate), "environment: about +y",
     false},
    {"camera_visible", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_light_def, camera_visible),
     "environment, rectangle, sphere: seen by the camera itself", false},
};

static const ty_param_table table = {
    "light", "One entry of the list `lights`.", sizeof(ty_light_def), light_default, rows, TY_PARAM_COUNT(rows)};

const ty_param_table* ty_light_params(void)
{
    return &table;
}

bool ty_light_has_key(ty_light_kind kind, const char* key)
{
    static const char* const keys[][8] = {
        [TY_LIGHT_ENVIRONMENT] = {"type", "radiance", "image", "color_space", "rotate", "camera_visible"},
        [TY_LIGHT_RECTANGLE] = {"type", "radiance", "center", "target", "up", "size", "camera_visible"},
        [TY_LIGHT_SPHERE] = {"type", "radiance", "center", "radius", "camera_visible"},
        [TY_LIGHT_POINT] = {"type", "intensity", "center"},
        [TY_LIGHT_DIRECTIONAL] = {"type", "irradiance", "center", "target"},
    };
    if (strcmp(key, "name") == 0)
        return true;
    for (int i = 0; i < 8 && keys[kind][i]; ++i)
        if (strcmp(keys[kind][i], key) == 0)
            return true;
    return false;
}

const char* ty_light_kind_name(ty_light_kind kind)
{
    return kinds[kind];
}
