// SPDX-License-Identifier: Apache-2.0
// Joining parts: sums add up exactly, so the result is the one run's, byte for byte.
#include "film.h"
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>

// What every part must share, in the order in which a picture carries it.
static const char* const carried[] = {"chromaticities",   "worldToCamera", "worldToNDC",      "tsuya/version",
                                      "tsuya/isa",        "tsuya/hash",    "tsuya/overrides", "tsuya/seed",
                                      "tsuya/integrator", "tsuya/recipe",  TY_KEY_PLANNED,    "envmap",
                                      "framesPerSecond",  "tsuya/frame"};

enum
{
    CARRIED_COUNT = sizeof carried / sizeof carried[0]
};

typedef struct part
{
    const char* path;
    int sample_begin, sample_end;
} part;

static void copy_attribute(const ty_exr_attribute* a, ty_exr* to)
{
    switch (a->type)
    {
    case TY_EXR_STRING:
        ty_exr_add_string(to, a->name, a->text ? a->text : "");
        break;
    case TY_EXR_MATRIX44:
        ty_exr_add_matrix(to, a->name, a->value);
        break;
    case TY_EXR_CHROMATICITIES:
        ty_exr_add_chromaticities(to, a->value);
        break;
    case TY_EXR_FLOAT1:
        ty_exr_add_float(to, a->name, a->value[0]);
        break;
    case TY_EXR_INT1:
        ty_exr_add_int(to, a->name, a->integer[0]);
        break;
    case TY_EXR_RATIONAL:
        ty_exr_add_rational(to, a->name, a->integer[0], (unsigned)a->integer[1]);
        break;
    case TY_EXR_ENVMAP:
        ty_exr_add_latlong(to);
        break;
    }
}

static bool same_attribute(const ty_exr_attribute* a, const ty_exr_attribute* b)
{
    if (!b || a->type != b->type)
        return false;
    if (a->type == TY_EXR_STRING)
        return strcmp(a->text ? a->text : "", b->text ? b->text : "") == 0;
    size_t floats = a->type == TY_EXR_MATRIX44 ? 16 : a->type == TY_EXR_CHROMATICITIES ? 8 : 1;
    if (a->type == TY_EXR_INT1 || a->type == TY_EXR_RATIONAL || a->type == TY_EXR_ENVMAP)
        return a->integer[0] == b->integer[0] && (a->type != TY_EXR_RATIONAL || a->integer[1] == b->integer[1]);
    return memcmp(a->value, b->value, floats * sizeof(float)) == 0;
}

// A picture of all directions says so, and has no matrix to the picture's plane.
static bool is_wanted(const ty_exr* exr, const char* name)
{
    bool all_round = ty_exr_find_attribute(exr, "envmap") != NULL;
    return strcmp(name, "envmap") == 0 ? all_round : strcmp(name, "worldToNDC") != 0 || !all_round;
}

static ty_status read_part(const char* path, ty_exr** exr, ty_film** film, ty_error* error)
{
    *film = NULL;
    ty_status status = ty_exr_read(path, exr, error);
    if (status)
        return status;
    for (int i = 0; i < CARRIED_COUNT && !status; ++i)
        if (is_wanted(*exr, carried[i]) && !ty_exr_find_attribute(*exr, carried[i]))
            status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "not a part: attribute %s is missing", carried[i]);
    if (!status)
        status = ty_film_from_part(*exr, path, film, error);
    return status;
}

static ty_status check_same(const ty_exr* whole, const ty_film* sum, const ty_exr* exr, const ty_film* film,
                            const char* path, ty_error* error)
{
    for (int i = 0; i < CARRIED_COUNT; ++i)
        if (is_wanted(whole, carried[i]) &&
            !same_attribute(ty_exr_find_attribute(whole, carried[i]), ty_exr_find_attribute(exr, carried[i])))
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "its %s differs from the first part's", carried[i]);
    const ty_film_setup *a = &sum->setup, *b = &film->setup;
    if (memcmp(a->size, b->size, sizeof a->size) != 0 || memcmp(a->crop, b->crop, sizeof a->crop) != 0)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "its size or crop differs from the first part's");
    bool same_groups = sum->group_count == film->group_count &&
                       memcmp(sum->group_names, film->group_names, sizeof sum->group_names) == 0;
    if (a->aovs != b->aovs || a->half != b->half || !same_groups)
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "its channels differ from the first part's");
    return TY_OK;
}

static void add_film(ty_film* sum, const ty_film* film)
{
    for (int y = film->setup.crop[1]; y <= film->setup.crop[3]; ++y)
        for (int x = film->setup.crop[0]; x <= film->setup.crop[2]; ++x)
        {
            ty_pixel_sums sums = ty_film_pixel(film, x, y);
            ty_film_commit(sum, x, y, &sums);
        }
}

static int by_begin(const void* a, const void* b)
{
    return ((const part*)a)->sample_begin - ((const part*)b)->sample_begin;
}

// The ranges must follow each other without a gap: sorts them by their begin.
static ty_status check_ranges(part* parts, int count, ty_error* error)
{
    qsort(parts, (size_t)count, sizeof *parts, by_begin);
    int done = parts[0].sample_end;
    for (int i = 1; i < count; ++i)
    {
        if (parts[i].sample_begin > done)
            return ty_error_set(error, TY_BAD_FILE, "samples %d-%d are missing: no part holds them", done,
                                parts[i].sample_begin - 1);
        if (parts[i].sample_begin < done)
            return ty_error_set_at(error, TY_BAD_FILE, parts[i].path, 0, 0, "samples %d-%d are in %s as well",
                                   parts[i].sample_begin, (done < parts[i].sample_end ? done : parts[i].sample_end) - 1,
                                   parts[i - 1].path);
        done = parts[i].sample_end;
    }
    return TY_OK;
}

// All the samples that the scene asks for make a picture; fewer make a larger part.
static ty_status write_joined(const ty_exr* first, const ty_film* sum, int begin, int end, const char* output,
                              ty_error* error)
{
    ty_exr* exr = ty_exr_create(first->data_window, first->display_window);
    ty_film_add_channels(sum, false, exr);
    for (int i = 0; i < CARRIED_COUNT; ++i)
        if (is_wanted(first, carried[i]))
            copy_attribute(ty_exr_find_attribute(first, carried[i]), exr);
    ty_film_add_range(begin, end, exr);
    if (begin != 0 || end != ty_exr_find_attribute(first, TY_KEY_PLANNED)->integer[0])
        ty_film_add_part_channels(sum, exr);
    ty_status status = ty_exr_write(output, exr, error);
    ty_exr_destroy(exr);
    return status;
}

ty_status ty_film_merge(const char* const* paths, int count, const char* output, ty_error* error)
{
    if (count < 1)
        return ty_error_set(error, TY_USAGE, "there are no parts to merge");
    part* parts = TY_ALLOC(part, count);
    ty_exr* first = NULL;
    ty_film* sum = NULL;
    ty_status status = TY_OK;
    for (int i = 0; i < count && !status; ++i)
    {
        ty_exr* exr = NULL;
        ty_film* film = NULL;
        status = read_part(paths[i], &exr, &film, error);
        if (!status)
        {
            parts[i] = (part){paths[i], film->setup.sample_begin, film->setup.sample_end};
            status = i ? check_same(first, sum, exr, film, paths[i], error) : TY_OK;
        }
        if (!status && i)
            add_film(sum, film);
        if (i == 0)
        {
            first = exr;
            sum = film;
            continue;
        }
        ty_exr_destroy(exr);
        ty_film_destroy(film);
    }
    if (!status)
        status = check_ranges(parts, count, error);
    if (!status)
        status = write_joined(first, sum, parts[0].sample_begin, parts[count - 1].sample_end, output, error);
    ty_exr_destroy(first);
    ty_film_destroy(sum);
    ty_free(parts);
    return status;
}
