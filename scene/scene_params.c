// SPDX-License-Identifier: Apache-2.0
// Tables and defaults of film, rendering and time.
#include <tsuya/scene/scene.h>

#define MANY 1e30 // a bound that bounds nothing but infinity

ty_film_def ty_film_def_default(void)
{
    return (ty_film_def){.size = {960, 540}, .filter = TY_FILTER_BLACKMAN_HARRIS, .filter_width = 3.0f, .half = true};
}

ty_render_def ty_render_def_default(void)
{
    return (ty_render_def){.integrator = TY_INTEGRATOR_PATH,
                           .samples = 64,
                           .max_depth = 16,
                           .roulette_depth = 5,
                           .indirect_subsurface = true,
                           .texture_filter = true,
                           .ao_distance = 0.05f,
                           .curvature_scale = 0.001f};
}

ty_timeline_def ty_timeline_def_default(void)
{
    return (ty_timeline_def){.fps = 24.0f, .start = 1, .end = 24};
}

ty_turntable_def ty_turntable_def_default(void)
{
    return (ty_turntable_def){.turn = TY_TURN_CAMERA, .axis = {0.0f, 1.0f, 0.0f}};
}

static void film_default(void* def)
{
    *(ty_film_def*)def = ty_film_def_default();
}

static void render_default(void* def)
{
    *(ty_render_def*)def = ty_render_def_default();
}

static void timeline_default(void* def)
{
    *(ty_timeline_def*)def = ty_timeline_def_default();
}

static void turntable_default(void* def)
{
    *(ty_turntable_def*)def = ty_turntable_def_default();
}

static const char* const filters[] = {"box", "gaussian", "blackman_harris", NULL};
static const char* const samplings[] = {"mis", "light", "bsdf", NULL};
static const char* const light_choices[] = {"place", "power", NULL};
static const char* const integrators[] = {"path", "albedo", "normal", "curvature", "ao", NULL};

static const char* const turns[] = {"camera", "objects", NULL};

static const ty_param film_rows[] = {
    {"size", TY_PARAM_INT2, "px", 1, 32768, NULL, NULL, offsetof(ty_film_def, size), "width and height", false},
    {"filter", TY_PARAM_ENUM, "", 0, 0, filters, NULL, offsetof(ty_film_def, filter), "pixel filter", false},
    {"filter_width", TY_PARAM_FLOAT, "px", 0.01, 16, NULL, NULL, offsetof(ty_film_def, filter_width),
     "full width of the filter", false},
    {"half", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_film_def, half), "beauty channels as half, else float",
     false},
};

static const ty_param render_rows[] = {
    {"integrator", TY_PARAM_ENUM, "", 0, 0, integrators, NULL, offsetof(ty_render_def, integrator),
     "path = light transport; the others show one property", false},
    {"samples", TY_PARAM_INT, "", 1, 65536, NULL, NULL, offsetof(ty_render_def, samples), "samples per pixel", false},
    {"max_depth", TY_PARAM_INT, "", 1, 4096, NULL, NULL, offsetof(ty_render_def, max_depth),
     "surface interactions of a path", false},
    {"roulette_depth", TY_PARAM_INT, "", 1, 4096, NULL, NULL, offsetof(ty_render_def, roulette_depth),
     "no Russian roulette before this many interactions", false},
    {"seed", TY_PARAM_SEED, "", 0, 0, NULL, NULL, offsetof(ty_render_def, seed), "of the sampler", false},
    {"animate_seed", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_render_def, animate_seed),
     "other noise in every frame, so that it does not stand still; a loop's first frame then differs from its next",
     false},
    {"light_sampling", TY_PARAM_ENUM, "", 0, 0, samplings, NULL, offsetof(ty_render_def, light_sampling),
     "how light is found: by lights and surfaces together, or one alone, for comparison", false},
    {"light_choice", TY_PARAM_ENUM, "", 0, 0, light_choices, NULL, offsetof(ty_render_def, light_choice),
     "which of many lights is sampled: by place, direction and power, or by power alone, for comparison", false},
    {"texture_filter", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_render_def, texture_filter),
     "average textures over what a ray stands for; false = look them up at the point", false},
    {"indirect_subsurface", TY_PARAM_BOOL, "", 0, 0, NULL, NULL, offsetof(ty_render_def, indirect_subsurface),
     "light goes through translucent bodies wherever it meets them; false = beyond a diffuse reflection they are "
     "matte, "
     "of the colour of a thick piece: faster and less noise, but light from body to body loses its depth",
     false},
    {"indirect_clamp", TY_PARAM_FLOAT, "", 0, MANY, NULL, NULL, offsetof(ty_render_def, indirect_clamp),
     "most that one path may add after its second scattering, caustics included: less noise, but the picture loses "
     "that light; 0 = no limit",
     false},
    {"ao_distance", TY_PARAM_FLOAT, "m", 0, MANY, NULL, NULL, offsetof(ty_render_def, ao_distance),
     "reach of ambient occlusion", false},
    {"curvature_scale", TY_PARAM_FLOAT, "m", 0, MANY, NULL, NULL, offsetof(ty_render_def, curvature_scale),
     "mean curvature times this is shown as grey around .5", false},
};

static const ty_param timeline_rows[] = {
    {"fps", TY_PARAM_FLOAT, "1/s", 0.001, 10000, NULL, NULL, offsetof(ty_timeline_def, fps), "frames a second", false},
    {"start", TY_PARAM_INT, "", -1e7, 1e7, NULL, NULL, offsetof(ty_timeline_def, start),
     "first frame: second 0 of textures and meshes", false},
    {"end", TY_PARAM_INT, "", -1e7, 1e7, NULL, NULL, offsetof(ty_timeline_def, end),
     "last frame; a loop is best keyed to end + 1", false},
};

static const ty_param turntable_rows[] = {
    {"turn", TY_PARAM_ENUM, "", 0, 0, turns, NULL, offsetof(ty_turntable_def, turn),
     "the camera goes round, or all objects turn under camera and lights that stay", false},
    {"angle", TY_PARAM_FLOAT, "deg", -36000, 36000, NULL, NULL, offsetof(ty_turntable_def, angle),
     "counter-clockwise seen against the axis; to be keyed", false},
    {"axis", TY_PARAM_FLOAT3, "", -1e9, 1e9, NULL, NULL, offsetof(ty_turntable_def, axis), "direction of the axis",
     false},
    {"about", TY_PARAM_FLOAT3, "m", -1e9, 1e9, NULL, NULL, offsetof(ty_turntable_def, about),
     "a point on the axis; the camera's look_at if not given", false},
};

static const ty_param_table film_table = {"film",
                                          "Size of the picture and how samples become pixels.",
                                          sizeof(ty_film_def),
                                          film_default,
                                          film_rows,
                                          TY_PARAM_COUNT(film_rows)};
static const ty_param_table render_table = {
    "render",    "How the picture is computed.", sizeof(ty_render_def), render_default,
    render_rows, TY_PARAM_COUNT(render_rows)};

const ty_param_table* ty_film_params(void)
{
    return &film_table;
}

const ty_param_table* ty_render_params(void)
{
    return &render_table;
}

static const ty_param_table timeline_table = {"timeline",
                                              "Frames and seconds. Any number, list of numbers or colour of camera, "
                                              "turntable, materials, lights and objects may be keyed.",
                                              sizeof(ty_timeline_def),
                                              timeline_default,
                                              timeline_rows,
                                              TY_PARAM_COUNT(timeline_rows)};
static const ty_param_table turntable_table = {"turntable",
                                               "A turn of the camera round the scene, or of the objects.",
                                               sizeof(ty_turntable_def),
                                               turntable_default,
                                               turntable_rows,
                                               TY_PARAM_COUNT(turntable_rows)};

const ty_param_table* ty_timeline_params(void)
{
    return &timeline_table;
}

const ty_param_table* ty_turntable_params(void)
{
    return &turntable_table;
}
