// SPDX-License-Identifier: Apache-2.0
// The film as a picture: channels and attributes of its EXR file.
#include "camera.h"
#include "film.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/log.h>

#define HALF_MAX 65504.0f

typedef enum field
{
    FIELD_RADIANCE,
    FIELD_ALPHA,
    FIELD_NORMAL,
    FIELD_ALBEDO,
    FIELD_POSITION,
    FIELD_DEPTH,
    FIELD_VARIANCE,
    FIELD_INSTANCE,
    FIELD_SAMPLES,
} field;

typedef struct channel
{
    const char* name;
    field from;
    int component;
    unsigned aov;     // 0 = always
    ty_exr_type type; // HALF: float where the setup says so
} channel;

static const channel channels[] = {
    {"R", FIELD_RADIANCE, 0, 0, TY_EXR_HALF},
    {"G", FIELD_RADIANCE, 1, 0, TY_EXR_HALF},
    {"B", FIELD_RADIANCE, 2, 0, TY_EXR_HALF},
    {"A", FIELD_ALPHA, 0, TY_AOV_ALPHA, TY_EXR_HALF},
    {"Z", FIELD_DEPTH, 0, TY_AOV_Z, TY_EXR_FLOAT},
    {"N.X", FIELD_NORMAL, 0, TY_AOV_N, TY_EXR_HALF},
    {"N.Y", FIELD_NORMAL, 1, TY_AOV_N, TY_EXR_HALF},
    {"N.Z", FIELD_NORMAL, 2, TY_AOV_N, TY_EXR_HALF},
    {"P.X", FIELD_POSITION, 0, TY_AOV_P, TY_EXR_FLOAT},
    {"P.Y", FIELD_POSITION, 1, TY_AOV_P, TY_EXR_FLOAT},
    {"P.Z", FIELD_POSITION, 2, TY_AOV_P, TY_EXR_FLOAT},
    {"albedo.R", FIELD_ALBEDO, 0, TY_AOV_ALBEDO, TY_EXR_HALF},
    {"albedo.G", FIELD_ALBEDO, 1, TY_AOV_ALBEDO, TY_EXR_HALF},
    {"albedo.B", FIELD_ALBEDO, 2, TY_AOV_ALBEDO, TY_EXR_HALF},
    {"variance.Y", FIELD_VARIANCE, 0, TY_AOV_VARIANCE, TY_EXR_FLOAT},
    {"instance", FIELD_INSTANCE, 0, TY_AOV_INSTANCE, TY_EXR_UINT},
    {"samples", FIELD_SAMPLES, 0, 0, TY_EXR_UINT}, // of a partial picture alone: the last row
};

enum
{
    CHANNEL_COUNT = sizeof channels / sizeof channels[0]
};

static float component(ty_vec3 v, int i)
{
    return i == 0 ? v.x : i == 1 ? v.y : v.z;
}

static float float_value(const ty_pixel_sums* s, const channel* c)
{
    switch (c->from)
    {
    case FIELD_RADIANCE:
        return ty_fixed_mean(s->radiance[c->component], s->samples);
    case FIELD_ALPHA:
        return s->samples ? (float)((double)s->covered / (double)s->samples) : 0.0f;
    case FIELD_NORMAL:
        return ty_fixed_mean(s->normal[c->component], s->samples);
    case FIELD_ALBEDO:
        return ty_fixed_mean(s->albedo[c->component], s->samples);
    case FIELD_POSITION:
        return component(s->first_position, c->component);
    case FIELD_DEPTH:
        return s->first_depth;
    case FIELD_VARIANCE:
        return ty_film_variance(s);
    case FIELD_INSTANCE:
    case FIELD_SAMPLES:
        break;
    }
    return 0.0f;
}

static void write_pixel(const ty_pixel_sums* sums, const ty_exr_type types[CHANNEL_COUNT],
                        void* const pixels[CHANNEL_COUNT], size_t i)
{
    for (int c = 0; c < CHANNEL_COUNT; ++c)
    {
        if (!pixels[c])
            continue;
        if (types[c] == TY_EXR_UINT)
        {
            ((uint32_t*)pixels[c])[i] = channels[c].from == FIELD_INSTANCE ? sums->first_instance : sums->samples;
            continue;
        }
        float value = float_value(sums, &channels[c]);
        ((float*)pixels[c])[i] = types[c] == TY_EXR_HALF ? ty_clamp(value, -HALF_MAX, HALF_MAX) : value;
    }
}

static ty_exr_type channel_type(const channel* row, bool half)
{
    return row->type == TY_EXR_HALF && !half ? TY_EXR_FLOAT : row->type;
}

static bool has_channel(const ty_exr* exr, const char* name, ty_exr_type type)
{
    const ty_exr_channel* found = ty_exr_find_channel(exr, name);
    return found && found->type == type;
}

bool ty_film_setup_matches(const ty_film_setup* setup, const ty_exr* exr)
{
    int expected = 0, there = 0;
    bool same = true;
    for (int c = 0; c < CHANNEL_COUNT; ++c)
    {
        const channel* row = &channels[c];
        if (row->from == FIELD_SAMPLES || (row->aov && !(setup->aovs & row->aov)))
            continue;
        same = same && has_channel(exr, row->name, channel_type(row, setup->half));
        ++expected;
    }
    for (int g = 0; setup->aovs & TY_AOV_LIGHT && g < setup->group_count; ++g)
        for (int c = 0; c < 3; ++c, ++expected)
        {
            char name[TY_GROUP_CHANNEL_SIZE];
            ty_film_group_channel(setup->groups[g], c, name);
            same = same && has_channel(exr, name, setup->half ? TY_EXR_HALF : TY_EXR_FLOAT);
        }
    for (int i = 0; i < exr->channel_count; ++i)
        there += strncmp(exr->channels[i].name, TY_PART_CHANNEL, sizeof TY_PART_CHANNEL - 1) != 0;
    return same && there == expected;
}

// The beauty by light groups.
static void add_groups(const ty_film* film, ty_exr* exr)
{
    ty_exr_type type = film->setup.half ? TY_EXR_HALF : TY_EXR_FLOAT;
    size_t count = (size_t)film->width * (size_t)film->height;
    for (uint32_t g = 0; g < film->group_count; ++g)
        for (int c = 0; c < 3; ++c)
        {
            char name[TY_GROUP_CHANNEL_SIZE];
            ty_film_group_channel(film->group_names[g], c, name);
            float* pixels = ty_exr_add_channel(exr, name, type);
            for (size_t i = 0; i < count; ++i)
            {
                uint64_t sum = film->groups[i * film->group_count + g].sum[c];
                float value = ty_fixed_mean(sum, film->beauty[i].samples);
                pixels[i] = type == TY_EXR_HALF ? ty_clamp(value, -HALF_MAX, HALF_MAX) : value;
            }
        }
}

void ty_film_add_channels(const ty_film* film, bool partial, ty_exr* exr)
{
    void* pixels[CHANNEL_COUNT] = {0};
    ty_exr_type types[CHANNEL_COUNT];
    for (int c = 0; c < CHANNEL_COUNT; ++c)
    {
        const channel* row = &channels[c];
        types[c] = channel_type(row, film->setup.half);
        bool present = row->from == FIELD_SAMPLES ? partial : !row->aov || film->setup.aovs & row->aov;
        pixels[c] = present ? ty_exr_add_channel(exr, row->name, types[c]) : NULL;
    }
    const int* crop = film->setup.crop;
    for (int y = crop[1]; y <= crop[3]; ++y)
        for (int x = crop[0]; x <= crop[2]; ++x)
        {
            ty_pixel_sums sums = ty_film_pixel(film, x, y);
            write_pixel(&sums, types, pixels, ty_film_index(film, x, y));
        }
    add_groups(film, exr);
}

void ty_film_add_range(int sample_begin, int sample_end, ty_exr* exr)
{
    char text[32];
    snprintf(text, sizeof text, "%d-%d", sample_begin, sample_end - 1);
    ty_exr_add_string(exr, TY_KEY_SAMPLES, text);
}

static const char* integrator_name(int kind)
{
    static const char* const names[] = {"path", "albedo", "normal", "curvature", "ao"};
    return names[kind];
}

// Whole rates, those of television (24000/1001), else thousandths.
static void add_frame_rate(float fps, ty_exr* exr)
{
    static const unsigned denominators[] = {1, 1001, 1000};
    double rate = fps > 0.0f ? (double)fps : 24.0;
    unsigned d = 1000;
    for (int i = 2; i >= 0; --i)
        if (fabs(rate * denominators[i] - floor(rate * denominators[i] + 0.5)) < 1e-5 * rate * denominators[i])
            d = denominators[i];
    ty_exr_add_rational(exr, "framesPerSecond", (int)floor(rate * d + 0.5), d);
}

// What is the same for every part of one picture; ty_film_merge carries it over.
static void add_scene_attributes(const ty_film* film, const ty_scene* scene, ty_exr* exr)
{
    static const float acescg[8] = TY_ACESCG_CHROMATICITIES;
    float matrix[16];
    char seed[32];
    ty_camera camera;
    ty_camera_init(&camera, &scene->camera, film->setup.size);
    ty_exr_add_chromaticities(exr, acescg);
    ty_camera_world_to_camera(&camera, matrix);
    ty_exr_add_matrix(exr, "worldToCamera", matrix);
    if (ty_camera_world_to_ndc(&camera, matrix))
        ty_exr_add_matrix(exr, "worldToNDC", matrix);
    snprintf(seed, sizeof seed, "%" PRIu64, scene->render.seed.value);
    ty_exr_add_string(exr, "tsuya/version", TSUYA_VERSION);
    ty_exr_add_string(exr, "tsuya/isa", scene->world ? ty_world_isa(scene->world) : "");
    ty_exr_add_string(exr, "tsuya/hash", scene->hash);
    ty_exr_add_string(exr, "tsuya/overrides", scene->overrides ? scene->overrides : "");
    ty_exr_add_string(exr, "tsuya/seed", seed);
    ty_exr_add_string(exr, "tsuya/integrator", integrator_name(scene->render.integrator));
    ty_exr_add_string(exr, "tsuya/recipe", scene->recipe ? scene->recipe : "");
    ty_exr_add_int(exr, TY_KEY_PLANNED, scene->render.samples);
    if (camera.projection == TY_PROJECTION_EQUIRECTANGULAR)
        ty_exr_add_latlong(exr);
    add_frame_rate(scene->timeline.fps, exr);
    ty_exr_add_float(exr, "tsuya/frame", (float)scene->frame);
}

static bool is_uniform(const ty_film* film, int samples)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < count; ++i)
        if (film->beauty[i].samples != (uint32_t)samples)
            return false;
    return true;
}

ty_status ty_film_to_exr(const ty_film* film, const ty_film_write* how, ty_exr** out, ty_error* error)
{
    *out = NULL;
    if (how->sample_begin < 0 || how->sample_end <= how->sample_begin)
        return ty_error_set(error, TY_USAGE, "there is no complete sample to write");
    int display_window[4] = {0, 0, film->setup.size[0] - 1, film->setup.size[1] - 1};
    ty_exr* exr = ty_exr_create(film->setup.crop, display_window);
    ty_film_add_channels(film, how->partial, exr);
    add_scene_attributes(film, how->scene, exr);
    ty_film_add_range(how->sample_begin, how->sample_end, exr);
    if (how->partial)
        ty_exr_add_int(exr, TY_KEY_PARTIAL, 1);
    if (how->part && is_uniform(film, how->sample_end - how->sample_begin))
        ty_film_add_part_channels(film, exr);
    else if (how->part)
        ty_log(TY_LOG_WARNING, "stopped within a pass: the picture is written without its sums and cannot be merged");
    *out = exr;
    return TY_OK;
}
