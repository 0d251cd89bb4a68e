// SPDX-License-Identifier: Apache-2.0
// Tables of objects and assets.
#include "scene_params.h"
#include <string.h>

static void object_default(void* def)
{
    *(ty_object_def*)def = (ty_object_def){.scale = {1.0f, 1.0f, 1.0f}, .visible = {true, true, true, true, true}};
}

static void visible_default(void* def)
{
    *(ty_visible_def*)def = (ty_visible_def){true, true, true, true, true};
}

static void mesh_default(void* def)
{
    *(ty_mesh_asset_def*)def = (ty_mesh_asset_def){.sequence = {.fps = 24.0f, .last_frame = -1, .interpolate = 1}};
}

static void gltf_default(void* def)
{
    *(ty_gltf_asset_def*)def = (ty_gltf_asset_def){.light_scale = 1.0f};
}

static void texture_default(void* def)
{
    *(ty_texture_asset_def*)def = (ty_texture_asset_def){.wrap = TY_WRAP_REPEAT};
}

static void frames_default(void* def)
{
    ty_mip_texture_def texture = ty_mip_texture_def_default();
    *(ty_frames_asset_def*)def = (ty_frames_asset_def){.wrap = (int)texture.wrap[0],
                                                       .sequence = {.fps = texture.fps, .last_frame = texture.last}};
}

static void loop_default(void* def)
{
    frames_default(def);
    ((ty_frames_asset_def*)def)->sequence.loop = true;
}

static void aggregate_default(void* def)
{
    *(ty_aggregate_asset_def*)def =
        (ty_aggregate_asset_def){.velocity_scale = 1.0f, .sequence = {.fps = 24.0f, .last_frame = -1}};
}

static const ty_param visible_rows[] = {
    {"camera", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, camera), "by the camera itself", false},
    {"diffuse", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, diffuse),
     "to rays that leave matt and translucent surfaces", false},
    {"glossy", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, glossy), "in reflections", false},
    {"transmission", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, transmission),
     "through transmitting surfaces", false},
    {"shadow", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_visible_def, shadow), "whether it casts shadows",
     false},
};

static const ty_param_table visible_table = {
    "object.visible",       "Which rays meet an object: those of the camera, of a kind of scattering, of shadows.",
    sizeof(ty_visible_def), visible_default,
    visible_rows,           TY_PARAM_COUNT(visible_rows)};

static const ty_param object_rows[] = {
    {"name", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, name), "for messages, ids and --set",
     false},
    {"mesh", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, mesh), "a mesh or shape asset", false},
    {"aggregate", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, aggregate), "an aggregate asset",
     false},
    {"gltf", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, gltf),
     "a glTF asset: its nodes with their meshes and materials", false},
    {"file_lights", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_object_def, file_lights),
     "gltf: bring the file's lights as well", false},
    {"file_camera", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, file_camera),
     "gltf: name or number of the file's camera to look through where the scene has no section camera", false},
    {"material", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, material),
     "name of a material: of the whole, or of what 'materials' leaves; a glTF has its own", false},
    {"materials", TY_PARAM_NAMES, "", 0, 0, NULL, NULL, offsetof(ty_object_def, materials),
     "material of each slot that the file names (OBJ usemtl, glTF materials)", false},
    {"translate", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, offsetof(ty_object_def, translate), "applied last",
     false},
    {"rotate", TY_PARAM_FLOAT3, "deg", -36000, 36000, NULL, NULL, offsetof(ty_object_def, rotate),
     "about x, then y, then z", false},
    {"scale", TY_PARAM_FLOAT3, "", -1e9, 1e9, NULL, NULL, offsetof(ty_object_def, scale),
     "applied first; one number for all three", false},
    {"visible", TY_PARAM_GROUP, "", 0, 0, NULL, &visible_table, offsetof(ty_object_def, visible), "which rays meet it",
     false},
    {"light_group", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_object_def, light_group),
     "light group of what its material emits", false},
    {"lights", TY_PARAM_STRINGS, "", 0, 0, NULL, NULL, offsetof(ty_object_def, lights),
     "the only lights, glowing objects or light groups that light it, by name", false},
    {"exclude_lights", TY_PARAM_STRINGS, "", 0, 0, NULL, NULL, offsetof(ty_object_def, exclude_lights),
     "lights, glowing objects or light groups that do not light it", false},
};

static const ty_param gltf_rows[] = {
    {"gltf", TY_PARAM_PATH, "", 0, 0, NULL, NULL, offsetof(ty_gltf_asset_def, gltf), ".glb or .gltf", true},
    {"light_scale", TY_PARAM_FLOAT, "", 0, 1e9, NULL, NULL, offsetof(ty_gltf_asset_def, light_scale),
     "W/sr of a candela, W/m^2 of a lux; emission is W/(m^2 sr) as the file says it", false},
};

static const char* const wraps[] = {"repeat", "clamp", "mirror", NULL};

static const ty_param texture_rows[] = {
    {"texture", TY_PARAM_PATH, "", 0, 0, NULL, NULL, offsetof(ty_texture_asset_def, texture), "an image file", true},
    {"color_space", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_texture_asset_def, color_space),
     "of the image; if not given: guessed for colours, raw for numbers", false},
    {"wrap", TY_PARAM_ENUM, "", 0, 0, wraps, NULL, offsetof(ty_texture_asset_def, wrap), "outside 0..1", false},
};

static const char* const interpolations[] = {"none", "linear", NULL};

#define SEQUENCE_ROW(type, field, kind, unit, low, high, names, text)                                                  \
    {                                                                                                                  \
#field, kind, unit, low, high, names, NULL, offsetof(type, sequence.field), text, false                        \
    }
#define FPS_ROW(type)                                                                                                  \
    SEQUENCE_ROW(type, fps, TY_PARAM_FLOAT, "1/s", 0.001, 100000, NULL, "frames a second of the scene's time")
#define START_ROW(type)                                                                                                \
    SEQUENCE_ROW(type, start, TY_PARAM_FLOAT, "s", -1e6, 1e6, NULL,                                                    \
                 "when the first frame is shown; 0 = the timeline's start")
#define INTERPOLATE_ROW(type)                                                                                          \
    SEQUENCE_ROW(type, interpolate, TY_PARAM_ENUM, "", 0, 0, interpolations, "between one frame and the next")
#define SEQUENCE_ROWS(type)                                                                                            \
    FPS_ROW(type), START_ROW(type),                                                                                    \
        SEQUENCE_ROW(type, first_frame, TY_PARAM_INT, "", -999999999, 999999999, NULL,                                 \
                     "number of the first, with last_frame"),                                                          \
        SEQUENCE_ROW(type, last_frame, TY_PARAM_INT, "", -999999999, 999999999, NULL,                                  \
                     "number of the last; below first_frame: all there are"),                                          \
        SEQUENCE_ROW(type, loop, TY_PARAM_BOOL, "", 0, 0, NULL, "the first frame follows the last"),                   \
        SEQUENCE_ROW(type, mirror, TY_PARAM_BOOL, "", 0, 0, NULL, "back and forth"),                                   \
        SEQUENCE_ROW(type, hold, TY_PARAM_BOOL, "", 0, 0, NULL,                                                        \
                     "the first before, the last after; none of the three: an error")
#define INTERPOLATED_ROWS(type) SEQUENCE_ROWS(type), INTERPOLATE_ROW(type)

#define PICTURES_ROWS(key, text)                                                                                       \
    {key, TY_PARAM_PATH, "", 0, 0, NULL, NULL, offsetof(ty_frames_asset_def, frames), text, true},                     \
        {"color_space",                                                                                                \
         TY_PARAM_STRING,                                                                                              \
         "",                                                                                                           \
         0,                                                                                                            \
         0,                                                                                                            \
         NULL,                                                                                                         \
         NULL,                                                                                                         \
         offsetof(ty_frames_asset_def, color_space),                                                                   \
         "of the images; if not given: what they say or guessed for colours, raw for numbers",                         \
         false},                                                                                                       \
    {                                                                                                                  \
        "wrap", TY_PARAM_ENUM, "", 0, 0, wraps, NULL, offsetof(ty_frames_asset_def, wrap), "outside 0..1", false       \
    }

static const ty_param frames_rows[] = {
    PICTURES_ROWS("frames", "image files, #### for the number (fill.####.exr); or a recipe (file or in place)"),
    INTERPOLATED_ROWS(ty_frames_asset_def),
};

static const ty_param fill_rows[] = {
    PICTURES_ROWS("fill", "a recipe of kind fill (file or in place)"),
    INTERPOLATED_ROWS(ty_frames_asset_def),
};

static const ty_param filter_rows[] = {
    PICTURES_ROWS("filter", "a recipe of kind filter (file or in place)"),
    INTERPOLATED_ROWS(ty_frames_asset_def),
};

static const ty_param loop_rows[] = {
    PICTURES_ROWS("loop", "a recipe of kind loop (file or in place); its first frame follows its last"),
    FPS_ROW(ty_frames_asset_def),
    START_ROW(ty_frames_asset_def),
    INTERPOLATE_ROW(ty_frames_asset_def),
};

static const ty_param mesh_rows[] = {
    {"mesh", TY_PARAM_PATH, "", 0, 0, NULL, NULL, offsetof(ty_mesh_asset_def, mesh),
     "a recipe (file or in place), or .ply .obj .stl .fbx .dae .off .glb .gltf (all of it as one); .ply files with "
     "#### for the number (roots.####.ply) are animated, by what follows, and blur while the shutter is open; with "
     "interpolate: none each may have a topology of its own, and none blurs",
     true},
    INTERPOLATED_ROWS(ty_mesh_asset_def),
};

static const ty_param aggregate_rows[] = {
    {"aggregate", TY_PARAM_PATH, "", 0, 0, NULL, NULL, offsetof(ty_aggregate_asset_def, aggregate),
     "a recipe file (.yaml), a recipe in place, a .glb of instances, or .ply points; files with #### for the number "
     "(heap.####.glb) of the same instances in each are animated, by what follows: shown is the file of the time or "
     "the "
     "last before it",
     true},
    {"prototype", TY_PARAM_STRING, "", 0, 0, NULL, NULL, offsetof(ty_aggregate_asset_def, prototype),
     "for .ply points: the mesh or shape asset that stands at each", false},
    {"velocity_scale", TY_PARAM_FLOAT, "", -1000, 1000, NULL, NULL, offsetof(ty_aggregate_asset_def, velocity_scale),
     "of the instances' own velocities and spins, which blur them while the shutter is open: 0.5 for a film shown at "
     "half its speed, 0 = no blur",
     false},
    SEQUENCE_ROWS(ty_aggregate_asset_def),
};

static const ty_param_table object_table = {"object",
                                            "One entry of the list `objects`: a mesh, an aggregate or a glTF scene.",
                                            sizeof(ty_object_def),
                                            object_default,
                                            object_rows,
                                            TY_PARAM_COUNT(object_rows)};
static const ty_param_table mesh_table = {"asset.mesh",
                                          "A mesh file, or a sequence of them.",
                                          sizeof(ty_mesh_asset_def),
                                          mesh_default,
                                          mesh_rows,
                                          TY_PARAM_COUNT(mesh_rows)};
static const ty_param_table gltf_table = {"asset.gltf",
                                          "A glTF scene: meshes, materials, lights, cameras.",
                                          sizeof(ty_gltf_asset_def),
                                          gltf_default,
                                          gltf_rows,
                                          TY_PARAM_COUNT(gltf_rows)};
static const ty_param_table texture_table = {
    "asset.texture", "An image for inputs of materials.", sizeof(ty_texture_asset_def), texture_default,
    texture_rows,    TY_PARAM_COUNT(texture_rows)};
#define FRAMES_TABLE(name, text, defaults, rows)                                                                       \
    {                                                                                                                  \
        name, text, sizeof(ty_frames_asset_def), defaults, rows, TY_PARAM_COUNT(rows)                                  \
    }
static const ty_param_table frames_tables[] = {
    FRAMES_TABLE("asset.frames", "A sequence of images for inputs of materials.", frames_default, frames_rows),
    FRAMES_TABLE("asset.fill", "The frames of a fill for inputs of materials.", frames_default, fill_rows),
    FRAMES_TABLE("asset.loop", "The frames of a loop for inputs of materials.", loop_default, loop_rows),
    FRAMES_TABLE("asset.filter", "The frames of a filter for inputs of materials.", frames_default, filter_rows),
};
static const ty_param_table aggregate_table = {
    "asset.aggregate", "Many instances of a few meshes.", sizeof(ty_aggregate_asset_def), aggregate_default,
    aggregate_rows,    TY_PARAM_COUNT(aggregate_rows)};

const ty_param_table* ty_object_params(void)
{
    return &object_table;
}

const ty_param_table* ty_mesh_asset_params(void)
{
    return &mesh_table;
}

const ty_param_table* ty_gltf_asset_params(void)
{
    return &gltf_table;
}

const ty_param_table* ty_texture_asset_params(void)
{
    return &texture_table;
}

const ty_param_table* ty_frames_asset_params(const char* key)
{
    int i = 0;
    while (strcmp(frames_tables[i].params[0].name, key) != 0)
        ++i;
    return &frames_tables[i];
}

const ty_param_table* ty_aggregate_asset_params(void)
{
    return &aggregate_table;
}
