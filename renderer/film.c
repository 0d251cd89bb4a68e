// SPDX-License-Identifier: Apache-2.0
// Sums per pixel in fixed point.
#include "film.h"
#include "sampler.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

static ty_status check_setup(const ty_film_setup* setup, ty_error* error)
{
    const int *size = setup->size, *crop = setup->crop;
    if (size[0] < 1 || size[1] < 1)
        return ty_error_set(error, TY_USAGE, "film size %d x %d: both must be at least 1", size[0], size[1]);
    if (crop[0] < 0 || crop[1] < 0 || crop[2] < crop[0] || crop[3] < crop[1] || crop[2] >= size[0] ||
        crop[3] >= size[1])
        return ty_error_set(error, TY_USAGE, "crop %d,%d,%d,%d is not inside the picture 0,0,%d,%d", crop[0], crop[1],
                            crop[2], crop[3], size[0] - 1, size[1] - 1);
    if (setup->sample_begin < 0 || setup->sample_end <= setup->sample_begin ||
        setup->sample_end > TY_SAMPLER_MAX_SAMPLES)
        return ty_error_set(error, TY_USAGE, "samples %d-%d: expected a range within 0-%d", setup->sample_begin,
                            setup->sample_end - 1, TY_SAMPLER_MAX_SAMPLES - 1);
    if (setup->aovs & TY_AOV_LIGHT && (setup->group_count < 1 || setup->group_count > TY_LIGHT_GROUPS))
        return ty_error_set(error, TY_USAGE, "%d light groups: expected 1 to %d", setup->group_count, TY_LIGHT_GROUPS);
    return TY_OK;
}

static void name_groups(ty_film* film, const ty_film_setup* setup)
{
    film->setup.groups = NULL; // ours from now on
    film->group_count = setup->aovs & TY_AOV_LIGHT ? (uint32_t)setup->group_count : 0u;
    for (uint32_t g = 0; g < film->group_count; ++g)
        snprintf(film->group_names[g], sizeof film->group_names[g], "%s", setup->groups[g]);
}

ty_status ty_film_create(const ty_film_setup* setup, ty_film** out, ty_error* error)
{
    *out = NULL;
    ty_status status = check_setup(setup, error);
    if (status)
        return status;
    ty_film* film = TY_ALLOC(ty_film, 1);
    film->setup = *setup;
    name_groups(film, setup);
    film->width = setup->crop[2] - setup->crop[0] + 1;
    film->height = setup->crop[3] - setup->crop[1] + 1;
    size_t count = (size_t)film->width * (size_t)film->height;
    unsigned first = TY_AOV_Z | TY_AOV_P | TY_AOV_INSTANCE;
    film->beauty = TY_TRY_ALLOC(ty_plane_beauty, count);
    film->moments = setup->aovs & TY_AOV_VARIANCE ? TY_TRY_ALLOC(ty_plane_moments, count) : NULL;
    film->normal = setup->aovs & TY_AOV_N ? TY_TRY_ALLOC(ty_plane_vector, count) : NULL;
    film->albedo = setup->aovs & TY_AOV_ALBEDO ? TY_TRY_ALLOC(ty_plane_vector, count) : NULL;
    film->first = setup->aovs & first ? TY_TRY_ALLOC(ty_plane_first, count) : NULL;
    film->groups = film->group_count ? TY_TRY_ALLOC(ty_plane_vector, count * film->group_count) : NULL;
    if (!film->beauty || (setup->aovs & TY_AOV_VARIANCE && !film->moments) ||
        (setup->aovs & TY_AOV_N && !film->normal) || (setup->aovs & TY_AOV_ALBEDO && !film->albedo) ||
        (setup->aovs & first && !film->first) || (film->group_count && !film->groups))
    {
        ty_film_destroy(film);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a film of %d x %d pixels", setup->size[0],
                            setup->size[1]);
    }
    for (size_t i = 0; film->first && i < count; ++i)
        film->first[i] = (ty_plane_first){.sample = TY_FILM_NO_SAMPLE, .depth = TY_FILM_Z_NONE};
    *out = film;
    return TY_OK;
}

void ty_film_destroy(ty_film* film)
{
    if (!film)
        return;
    ty_free(film->beauty);
    ty_free(film->moments);
    ty_free(film->normal);
    ty_free(film->albedo);
    ty_free(film->first);
    ty_free(film->groups);
    ty_free(film);
}

ty_pixel_sums ty_pixel_sums_make(uint32_t group_count)
{
    return (ty_pixel_sums){
        .group_count = group_count, .first_sample = TY_FILM_NO_SAMPLE, .first_depth = TY_FILM_Z_NONE};
}

// Nearest multiple of 2^-30, ties to even; clamped, which the caller may want to know.
static inline uint64_t fixed_from_float(float value, bool* clamped)
{
    double scaled = (double)value * TY_FILM_SCALE, limit = (double)TY_FILM_LIMIT;
    double within = scaled < limit ? scaled : limit;
    within = within > -limit ? within : -limit;
    *clamped |= within != scaled;
    return (uint64_t)__builtin_llrint(within);
}

static void add_first(ty_pixel_sums* sums, const ty_film_sample* sample, uint32_t index)
{
    if (index >= sums->first_sample)
        return;
    sums->first_sample = index;
    sums->first_instance = sample->instance;
    sums->first_position = sample->position;
    sums->first_depth = sample->depth;
}

static inline bool add_vector(uint64_t sum[3], float x, float y, float z)
{
    bool clamped = false;
    sum[0] += fixed_from_float(x, &clamped);
    sum[1] += fixed_from_float(y, &clamped);
    sum[2] += fixed_from_float(z, &clamped);
    return clamped;
}

// 0, or nan where a component is infinite or nan.
static inline float nought(float x, float y, float z)
{
    return 0.0f * x + 0.0f * y + 0.0f * z;
}

static bool is_finite(const ty_film_sample* s)
{
    float sum = nought(s->radiance.r, s->radiance.g, s->radiance.b);
    if (s->hit)
        sum += nought(s->albedo.r, s->albedo.g, s->albedo.b) + nought(s->normal.x, s->normal.y, s->normal.z) +
               nought(s->position.x, s->position.y, s->position.z) + 0.0f * s->depth;
    return sum == 0.0f;
}

ty_sample_fate ty_pixel_sums_add(ty_pixel_sums* sums, const ty_film_sample* s, uint32_t index)
{
    sums->samples++;
    if (!is_finite(s))
        return TY_SAMPLE_DROPPED;
    sums->covered += s->covered;
    if (s->hit)
    {
        add_first(sums, s, index);
        (void)add_vector(sums->normal, s->normal.x, s->normal.y, s->normal.z);
        (void)add_vector(sums->albedo, s->albedo.r, s->albedo.g, s->albedo.b);
    }
    bool clamped = add_vector(sums->radiance, s->radiance.r, s->radiance.g, s->radiance.b), luminance_clamped = false;
    for (uint32_t g = 0; g < sums->group_count; ++g)
        (void)add_vector(sums->group[g], s->group[g].r, s->group[g].g, s->group[g].b);
    int64_t y = (int64_t)fixed_from_float(ty_luminance(s->radiance), &luminance_clamped);
    uint64_t magnitude = (uint64_t)(y < 0 ? -y : y);
    sums->luminance += (uint64_t)y;
    sums->luminance_sqr += (ty_u128)magnitude * magnitude;
    return clamped ? TY_SAMPLE_SATURATED : TY_SAMPLE_GOOD;
}

static void commit_vector(ty_plane_vector* plane, size_t i, const uint64_t sum[3])
{
    for (int c = 0; plane && c < 3; ++c)
        plane[i].sum[c] += sum[c];
}

void ty_film_commit(ty_film* film, int x, int y, const ty_pixel_sums* sums)
{
    size_t i = ty_film_index(film, x, y);
    for (int c = 0; c < 3; ++c)
        film->beauty[i].radiance[c] += sums->radiance[c];
    film->beauty[i].samples += sums->samples;
    film->beauty[i].covered += sums->covered;
    commit_vector(film->normal, i, sums->normal);
    commit_vector(film->albedo, i, sums->albedo);
    for (uint32_t g = 0; g < film->group_count; ++g)
        commit_vector(film->groups, i * film->group_count + g, sums->group[g]);
    if (film->moments)
    {
        film->moments[i].luminance += sums->luminance;
        film->moments[i].luminance_sqr += sums->luminance_sqr;
    }
    if (film->first && sums->first_sample < film->first[i].sample)
        film->first[i] =
            (ty_plane_first){sums->first_sample, sums->first_instance, sums->first_position, sums->first_depth};
}

ty_pixel_sums ty_film_pixel(const ty_film* film, int x, int y)
{
    size_t i = ty_film_index(film, x, y);
    ty_pixel_sums sums = ty_pixel_sums_make(film->group_count);
    sums.samples = film->beauty[i].samples;
    sums.covered = film->beauty[i].covered;
    for (int c = 0; c < 3; ++c)
    {
        sums.radiance[c] = film->beauty[i].radiance[c];
        sums.normal[c] = film->normal ? film->normal[i].sum[c] : 0;
        sums.albedo[c] = film->albedo ? film->albedo[i].sum[c] : 0;
    }
    for (uint32_t g = 0; g < film->group_count; ++g)
        memcpy(sums.group[g], film->groups[i * film->group_count + g].sum, sizeof sums.group[g]);
    if (film->moments)
    {
        sums.luminance = film->moments[i].luminance;
        sums.luminance_sqr = film->moments[i].luminance_sqr;
    }
    if (film->first)
    {
        sums.first_sample = film->first[i].sample;
        sums.first_instance = film->first[i].instance;
        sums.first_position = film->first[i].position;
        sums.first_depth = film->first[i].depth;
    }
    return sums;
}

float ty_film_variance(const ty_pixel_sums* sums)
{
    uint32_t n = sums->samples;
    if (n < 2)
        return 0.0f;
    int64_t sum = (int64_t)sums->luminance;
    uint64_t magnitude = sum < 0 ? 0u - (uint64_t)sum : (uint64_t)sum;
    // n * sum of squares - square of the sum, exactly: n <= 2^16 and terms below 2^94 fit into 128 bits.
    ty_u128 spread = n * sums->luminance_sqr - (ty_u128)magnitude * magnitude;
    double squared_scale = TY_FILM_SCALE * TY_FILM_SCALE, count = n;
    return (float)((double)spread / squared_scale / (count * count * (count - 1.0)));
}
