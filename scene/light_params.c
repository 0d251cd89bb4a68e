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
                          .color = {1.0f, 1.0f, 1.0f},
                          .center = {0.0f, 1.0f, 0.0f},
                          .up = {0.0f, 1.0f, 0.0f},
                          .size = {1.0f, 1.0f},
                          .radius = 0.1f,
                          .axis = {1.0f, 0.0f, 0.0f},
                          .length = 1.0f,
                          .cone = ty_radians(45.0f),
                          .penumbra = 0.2f,
                          .zenith = {0.12f, 0.22f, 0.5f},
                          .horizon = {0.6f, 0.68f, 0.8f},
                          .ground = {0.16f, 0.14f, 0.12f},
                          .falloff = 0.5f,
                          .sun_irradiance = {3.0f, 2.8f, 2.5f},
                          .sun_elevation = ty_radians(40.0f),
                          .sun_angle = ty_radians(0.53f),
                          .camera_visible = true,
                          .visible = {true, true, true, true, true},
                          .shadows = true};
}

static void light_default(void* def)
{
    *(ty_light_def*)def = ty_light_def_default();
}

static void visible_default(void* def)
{
    *(ty_visible_def*)def = (ty_visible_def){true, true, true, true, true};
}

static const char* const kinds[] = {"environment", "sky",   "rectangle", "disk",        "sphere",
                                    "cylinder",    "point", "spot",      "directional", NULL};

static const ty_param visible_rows[] = {
    {"camera", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, camera), "by the camera itself", false},
    {"diffuse", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, diffuse),
     "from matt and translucent surfaces: whether it lights them", false},
    {"glossy", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, glossy), "in reflections", false},
    {"transmission", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, transmission),
     "through transmitting surfaces", false},
};

static const ty_param_table visible_table = {
    "light.visible",        "Which rays see a light: those of the camera, or of a kind of scattering.",
    sizeof(ty_visible_def), visible_default,
    visible_rows,           TY_PARAM_COUNT(visible_rows)};

#define AT(field) offsetof(ty_light_def, field)

static const ty_param rows[] = {
    {"name", TY_PARAM_STRING, "", 0, 0, NULL, NULL, AT(name), "for linking and overrides: lights.NAME.radiance", false},
    {"type", TY_PARAM_ENUM, "", 0, 0, kinds, NULL, AT(kind), "kind of light", true},
    {"group", TY_PARAM_STRING, "", 0, 0, NULL, NULL, AT(group),
     "light group: its light becomes the channels light.GROUP.R, G, B", false},
    {"radiance", TY_PARAM_RGB, "W/(m^2 sr)", 0, MANY, NULL, NULL, AT(radiance),
     "environment (times the image), rectangle, disk, sphere, cylinder", false},
    {"intensity", TY_PARAM_RGB, "W/sr", 0, MANY, NULL, NULL, AT(intensity), "point; spot: along its axis", false},
    {"irradiance", TY_PARAM_RGB, "W/m^2", 0, MANY, NULL, NULL, AT(irradiance), "directional: on a plane that faces it",
     false},
    {"power", TY_PARAM_FLOAT, "W", 0, MANY, NULL, NULL, AT(power),
     "all the light that leaves it, in place of radiance or intensity", false},
    {"color", TY_PARAM_RGB, "", 0, MANY, NULL, NULL, AT(color), "factor", false},
    {"exposure", TY_PARAM_FLOAT, "", -64, 64, NULL, NULL, AT(exposure), "factor in stops: 1 doubles the light", false},
    {"center", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, AT(center),
     "where it stands; directional light goes from here towards target", false},
    {"target", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, AT(target),
     "what a rectangle, disk or spot faces, or a directional light goes towards", false},
    {"up", TY_PARAM_FLOAT3, "", -1e9, 1e9, NULL, NULL, AT(up), "direction of a rectangle's height or an image's top",
     false},
    {"size", TY_PARAM_FLOAT2, "m", 1e-9, 1e9, NULL, NULL, AT(size), "rectangle: full width and height", false},
    {"radius", TY_PARAM_FLOAT, "m", 1e-9, 1e9, NULL, NULL, AT(radius), "disk, sphere, cylinder", false},
    {"axis", TY_PARAM_FLOAT3, "", -1e9, 1e9, NULL, NULL, AT(axis), "cylinder: direction of its length", false},
    {"length", TY_PARAM_FLOAT, "m", 1e-9, 1e9, NULL, NULL, AT(length), "cylinder: lit on its round side alone", false},
    {"cone", TY_PARAM_FLOAT, "deg", 0.01, 179.9, NULL, NULL, AT(cone), "spot: full angle, beyond which it is dark",
     false},
    {"penumbra", TY_PARAM_FLOAT, "", 0, 1, NULL, NULL, AT(penumbra),
     "spot: share of the half angle over which it fades to nothing", false},
    {"angle", TY_PARAM_FLOAT, "deg", 0, 180, NULL, NULL, AT(angle),
     "directional: full angle of its disc; 0 = sharp shadows", false},
    {"zenith", TY_PARAM_RGB, "W/(m^2 sr)", 0, MANY, NULL, NULL, AT(zenith), "sky: radiance overhead", false},
    {"horizon", TY_PARAM_RGB, "W/(m^2 sr)", 0, MANY, NULL, NULL, AT(horizon), "sky: radiance at the horizon", false},
    {"ground", TY_PARAM_RGB, "W/(m^2 sr)", 0, MANY, NULL, NULL, AT(ground), "sky: radiance from below", false},
    {"falloff", TY_PARAM_FLOAT, "", 0.05, 16, NULL, NULL, AT(falloff),
     "sky: the gradient is (sine of the height)^falloff; small = a narrow bright horizon", false},
    {"sun_irradiance", TY_PARAM_RGB, "W/m^2", 0, MANY, NULL, NULL, AT(sun_irradiance),
     "sky: of the sun on a plane that faces it; 0 = no sun", false},
    {"sun_elevation", TY_PARAM_FLOAT, "deg", -90, 90, NULL, NULL, AT(sun_elevation), "sky: above the horizon", false},
    {"sun_azimuth", TY_PARAM_FLOAT, "deg", -3600, 3600, NULL, NULL, AT(sun_azimuth), "sky: from -z over +x", false},
    {"sun_angle", TY_PARAM_FLOAT, "deg", 0, 90, NULL, NULL, AT(sun_angle), "sky: full angle of the sun's disc", false},
    {"image", TY_PARAM_PATH, "", 0, 0, NULL, NULL, AT(image),
     "environment: latitude-longitude image, y up; spot: what it projects over its cone", false},
    {"color_space", TY_PARAM_STRING, "", 0, 0, NULL, NULL, AT(color_space),
     "of the image; guessed from the file if not given", false},
    {"rotate", TY_PARAM_FLOAT, "deg", -3600, 3600, NULL, NULL, AT(rotate), "environment, sky: about +y", false},
    {"orientation", TY_PARAM_FLOAT3, "deg", -3600, 3600, NULL, NULL, AT(orientation),
     "environment: about x, then y, then z, before rotate", false},
    {"camera_visible", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, AT(camera_visible), "the same as visible: { camera }",
     false},
    {"visible", TY_PARAM_GROUP, "", 0, 0, NULL, &visible_table, AT(visible), "which rays see it", false},
    {"shadows", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, AT(shadows), "false: it shines through everything", false},
};

static const ty_param_table table = {
    "light", "One entry of the list `lights`.", sizeof(ty_light_def), light_default, rows, TY_PARAM_COUNT(rows)};

const ty_param_table* ty_light_params(void)
{
    return &table;
}

static bool is_among(const char* key, const char* const* keys)
{
    for (int i = 0; keys[i]; ++i)
        if (strcmp(keys[i], key) == 0)
            return true;
    return false;
}

bool ty_light_has_key(ty_light_kind kind, const char* key)
{
    static const char* const common[] = {"name", "type", "group", "color", "exposure", "visible", "shadows", NULL};
    static const char* const keys[][12] = {
        [TY_LIGHT_ENVIRONMENT] = {"radiance", "image", "color_space", "rotate", "orientation", "camera_visible"},
        [TY_LIGHT_SKY] = {"zenith", "horizon", "ground", "falloff", "sun_irradiance", "sun_elevation", "sun_azimuth",
                          "sun_angle", "rotate", "camera_visible"},
        [TY_LIGHT_RECTANGLE] = {"radiance", "power", "center", "target", "up", "size", "camera_visible"},
        [TY_LIGHT_DISK] = {"radiance", "power", "center", "target", "radius", "camera_visible"},
        [TY_LIGHT_SPHERE] = {"radiance", "power", "center", "radius", "camera_visible"},
        [TY_LIGHT_CYLINDER] = {"radiance", "power", "center", "axis", "length", "radius", "camera_visible"},
        [TY_LIGHT_POINT] = {"intensity", "power", "center"},
        [TY_LIGHT_SPOT] = {"intensity", "power", "center", "target", "up", "cone", "penumbra", "image", "color_space"},
        [TY_LIGHT_DIRECTIONAL] = {"irradiance", "center", "target", "angle", "camera_visible"},
    };
    return is_among(key, common) || is_among(key, keys[kind]);
}

const char* ty_light_kind_name(ty_light_kind kind)
{
    return kinds[kind];
}
