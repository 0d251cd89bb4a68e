// SPDX-License-Identifier: Apache-2.0
// Parts: the exact sums as UINT channels "part.NAME.word", and back.
#include "film.h"
#include "sampler.h"
#include <stdio.h>
#include <string.h>

typedef struct sum_field
{
    const char* name;
    size_t offset; // in ty_pixel_sums
    int words;     // of 32 bits, the lowest first
    unsigned aov;  // any of these; 0 = always
} sum_field;

#define FIRST_AOVS (TY_AOV_Z | TY_AOV_P | TY_AOV_INSTANCE)

static const sum_field fields[] = {
    {"R", offsetof(ty_pixel_sums, radiance[0]), 2, 0},
    {"G", offsetof(ty_pixel_sums, radiance[1]), 2, 0},
    {"B", offsetof(ty_pixel_sums, radiance[2]), 2, 0},
    {"samples", offsetof(ty_pixel_sums, samples), 1, 0},
    {"covered", offsetof(ty_pixel_sums, covered), 1, 0},
    {"N.X", offsetof(ty_pixel_sums, normal[0]), 2, TY_AOV_N},
    {"N.Y", offsetof(ty_pixel_sums, normal[1]), 2, TY_AOV_N},
    {"N.Z", offsetof(ty_pixel_sums, normal[2]), 2, TY_AOV_N},
    {"albedo.R", offsetof(ty_pixel_sums, albedo[0]), 2, TY_AOV_ALBEDO},
    {"albedo.G", offsetof(ty_pixel_sums, albedo[1]), 2, TY_AOV_ALBEDO},
    {"albedo.B", offsetof(ty_pixel_sums, albedo[2]), 2, TY_AOV_ALBEDO},
    {"Y", offsetof(ty_pixel_sums, luminance), 2, TY_AOV_VARIANCE},
    {"YY", offsetof(ty_pixel_sums, luminance_sqr), 4, TY_AOV_VARIANCE},
    {"first", offsetof(ty_pixel_sums, first_sample), 1, FIRST_AOVS},
};

enum
{
    FIELD_COUNT = sizeof fields / sizeof fields[0],
    WORD_COUNT = 27 + TY_LIGHT_GROUPS * 3 * 2
};

typedef struct word
{
    size_t offset;    // of its field
    int words, index; // of the field, and which of them
    uint32_t* pixels;
} word;

static uint32_t get_word(const ty_pixel_sums* sums, const word* w)
{
    const unsigned char* p = (const unsigned char*)sums + w->offset;
    uint32_t narrow;
    uint64_t wide;
    ty_u128 widest;
    switch (w->words)
    {
    case 1:
        memcpy(&narrow, p, sizeof narrow);
        return narrow;
    case 2:
        memcpy(&wide, p, sizeof wide);
        return (uint32_t)(wide >> 32 * w->index);
    default:
        memcpy(&widest, p, sizeof widest);
        return (uint32_t)(widest >> 32 * w->index);
    }
}

// Words start from zero sums and are put once each.
static void put_word(ty_pixel_sums* sums, const word* w, uint32_t value)
{
    unsigned char* p = (unsigned char*)sums + w->offset;
    uint64_t wide;
    ty_u128 widest;
    switch (w->words)
    {
    case 1:
        memcpy(p, &value, sizeof value);
        break;
    case 2:
        memcpy(&wide, p, sizeof wide);
        wide |= (uint64_t)value << 32 * w->index;
        memcpy(p, &wide, sizeof wide);
        break;
    default:
        memcpy(&widest, p, sizeof widest);
        widest |= (ty_u128)value << 32 * w->index;
        memcpy(p, &widest, sizeof widest);
        break;
    }
}

static int add_words(word* words, char names[][64], int count, const char* name, size_t offset, int width)
{
    for (int i = 0; i < width; ++i, ++count)
    {
        TY_ASSERT(count < WORD_COUNT);
        words[count] = (word){offset, width, i, NULL};
        snprintf(names[count], 64, TY_PART_CHANNEL "%s.%d", name, i);
    }
    return count;
}

// group_names: [group_count]
static int list_words(unsigned aovs, const char* const* group_names, int group_count, word words[WORD_COUNT],
                      char names[WORD_COUNT][64])
{
    int count = 0;
    for (int f = 0; f < FIELD_COUNT; ++f)
        if (!fields[f].aov || aovs & fields[f].aov)
            count = add_words(words, names, count, fields[f].name, fields[f].offset, fields[f].words);
    for (int g = 0; g < group_count; ++g)
        for (int c = 0; c < 3; ++c)
        {
            char name[TY_GROUP_CHANNEL_SIZE];
            ty_film_group_channel(group_names[g], c, name);
            size_t offset = offsetof(ty_pixel_sums, group) + (size_t)(3 * g + c) * sizeof(uint64_t);
            count = add_words(words, names, count, name, offset, 2);
        }
    return count;
}

void ty_film_add_part_channels(const ty_film* film, ty_exr* exr)
{
    word words[WORD_COUNT];
    char names[WORD_COUNT][64];
    const char* groups[TY_LIGHT_GROUPS];
    for (uint32_t g = 0; g < film->group_count; ++g)
        groups[g] = film->group_names[g];
    int count = list_words(film->setup.aovs, groups, (int)film->group_count, words, names);
    for (int w = 0; w < count; ++w)
        words[w].pixels = ty_exr_add_channel(exr, names[w], TY_EXR_UINT);
    const int* crop = film->setup.crop;
    for (int y = crop[1]; y <= crop[3]; ++y)
        for (int x = crop[0]; x <= crop[2]; ++x)
        {
            ty_pixel_sums sums = ty_film_pixel(film, x, y);
            for (int w = 0; w < count; ++w)
                words[w].pixels[ty_film_index(film, x, y)] = get_word(&sums, &words[w]);
        }
    ty_exr_add_int(exr, TY_KEY_PART, 1);
}

static ty_status read_setup(const ty_exr* exr, const char* name, ty_film_setup* setup, ty_error* error)
{
    static const struct
    {
        const char* channel;
        unsigned aov;
    } marks[] = {{"A", TY_AOV_ALPHA},
                 {"Z", TY_AOV_Z},
                 {"N.X", TY_AOV_N},
                 {"P.X", TY_AOV_P},
                 {"albedo.R", TY_AOV_ALBEDO},
                 {"variance.Y", TY_AOV_VARIANCE},
                 {"instance", TY_AOV_INSTANCE}};
    const ty_exr_attribute* part = ty_exr_find_attribute(exr, TY_KEY_PART);
    const ty_exr_attribute* range = ty_exr_find_attribute(exr, TY_KEY_SAMPLES);
    const ty_exr_channel* red = ty_exr_find_channel(exr, "R");
    if (!part || part->type != TY_EXR_INT1 || part->integer[0] != 1 || !range || range->type != TY_EXR_STRING || !red)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "not a part: it was not written with --samples A-B");
    *setup = (ty_film_setup){.half = red->type == TY_EXR_HALF};
    int first, last;
    if (!range->text || sscanf(range->text, "%6d-%6d", &first, &last) != 2 || first < 0 || last < first ||
        last >= TY_SAMPLER_MAX_SAMPLES)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "its sample range is damaged");
    setup->sample_begin = first;
    setup->sample_end = last + 1;
    const int* display = exr->display_window;
    if (display[0] != 0 || display[1] != 0 || display[2] < 0 || display[3] < 0 || display[2] >= 1 << 20 ||
        display[3] >= 1 << 20)
        return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "its display window does not begin at 0,0");
    setup->size[0] = display[2] + 1;
    setup->size[1] = display[3] + 1;
    memcpy(setup->crop, exr->data_window, sizeof setup->crop);
    for (size_t i = 0; i < sizeof marks / sizeof marks[0]; ++i)
        setup->aovs |= ty_exr_find_channel(exr, marks[i].channel) ? marks[i].aov : 0u;
    return TY_OK;
}

// The light groups by their first channels, "light.NAME.R", in the order of the file.
static ty_status read_groups(const ty_exr* exr, const char* name, char groups[][TY_LIGHT_GROUP_NAME + 1], int* count,
                             ty_error* error)
{
    const size_t head = strlen(TY_GROUP_CHANNEL), tail = strlen(".R");
    *count = 0;
    for (int i = 0; i < exr->channel_count; ++i)
    {
        const char* channel = exr->channels[i].name;
        size_t length = strlen(channel);
        if (length <= head + tail || strncmp(channel, TY_GROUP_CHANNEL, head) != 0 ||
            strcmp(channel + length - tail, ".R") != 0)
            continue;
        if (*count == TY_LIGHT_GROUPS || length - head - tail > TY_LIGHT_GROUP_NAME)
            return ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "its light groups are damaged");
        snprintf(groups[(*count)++], TY_LIGHT_GROUP_NAME + 1, "%.*s", (int)(length - head - tail), channel + head);
    }
    return TY_OK;
}

// Pixels of a channel that must be of a type; NULL with *status set when it is not so.
static const void* need(const ty_exr* exr, const char* name, const char* channel, ty_exr_type type, ty_status* status,
                        ty_error* error)
{
    const ty_exr_channel* found = ty_exr_find_channel(exr, channel);
    if (found && found->type == type)
        return found->pixels;
    if (!*status)
        *status = ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "channel %s is %s", channel,
                                  found ? "of the wrong type" : "missing");
    return NULL;
}

typedef struct first_channels
{
    const float *z, *x, *y, *position_z;
    const uint32_t* instance;
} first_channels;

static first_channels find_first(const ty_exr* exr, const char* name, unsigned aovs, ty_status* status, ty_error* error)
{
    first_channels f = {0};
    if (aovs & TY_AOV_Z)
        f.z = need(exr, name, "Z", TY_EXR_FLOAT, status, error);
    if (aovs & TY_AOV_P)
    {
        f.x = need(exr, name, "P.X", TY_EXR_FLOAT, status, error);
        f.y = need(exr, name, "P.Y", TY_EXR_FLOAT, status, error);
        f.position_z = need(exr, name, "P.Z", TY_EXR_FLOAT, status, error);
    }
    if (aovs & TY_AOV_INSTANCE)
        f.instance = need(exr, name, "instance", TY_EXR_UINT, status, error);
    return f;
}

static ty_pixel_sums read_pixel(const word* words, int count, const first_channels* f, size_t i)
{
    ty_pixel_sums sums = {.first_depth = TY_FILM_Z_NONE};
    for (int w = 0; w < count; ++w)
        put_word(&sums, &words[w], words[w].pixels[i]);
    if (f->z)
        sums.first_depth = f->z[i];
    if (f->x)
        sums.first_position = (ty_vec3){f->x[i], f->y[i], f->position_z[i]};
    if (f->instance)
        sums.first_instance = f->instance[i];
    return sums;
}

ty_status ty_film_from_part(const ty_exr* exr, const char* name, ty_film** out, ty_error* error)
{
    *out = NULL;
    ty_film_setup setup;
    ty_status status = read_setup(exr, name, &setup, error);
    if (status)
        return status;
    char group_names[TY_LIGHT_GROUPS][TY_LIGHT_GROUP_NAME + 1];
    const char* groups[TY_LIGHT_GROUPS];
    if ((status = read_groups(exr, name, group_names, &setup.group_count, error)))
        return status;
    for (int g = 0; g < setup.group_count; ++g)
        groups[g] = group_names[g];
    setup.groups = groups;
    setup.aovs |= setup.group_count ? TY_AOV_LIGHT : 0u;
    word words[WORD_COUNT];
    char names[WORD_COUNT][64];
    int count = list_words(setup.aovs, groups, setup.group_count, words, names);
    for (int w = 0; w < count; ++w)
        words[w].pixels = (uint32_t*)need(exr, name, names[w], TY_EXR_UINT, &status, error);
    first_channels first = find_first(exr, name, setup.aovs, &status, error);
    ty_film* film = NULL;
    if (status || (status = ty_film_create(&setup, &film, error)))
        return status;
    for (int y = setup.crop[1]; y <= setup.crop[3] && !status; ++y)
        for (int x = setup.crop[0]; x <= setup.crop[2] && !status; ++x)
        {
            ty_pixel_sums sums = read_pixel(words, count, &first, ty_film_index(film, x, y));
            if (sums.samples != (uint32_t)(setup.sample_end - setup.sample_begin))
                status = ty_error_set_at(error, TY_BAD_FILE, name, 0, 0, "pixel %d,%d holds %u samples, expected %d", x,
                                         y, (unsigned)sums.samples, setup.sample_end - setup.sample_begin);
            ty_film_commit(film, x, y, &sums);
        }
    if (status)
        ty_film_destroy(film);
    else
        *out = film;
    return status;
}

void ty_film_group_channel(const char* group, int component, char name[TY_GROUP_CHANNEL_SIZE])
{
    snprintf(name, TY_GROUP_CHANNEL_SIZE, TY_GROUP_CHANNEL "%.*s.%c", TY_LIGHT_GROUP_NAME, group, "RGB"[component]);
}
