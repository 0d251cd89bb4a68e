// SPDX-License-Identifier: Apache-2.0
// How an aggregate begins: planned, seeded and inflated, or by one of the two other ways; and what falls onto it later.
#include "kit.h"
#include "start.h"
#include <tsuya/base/log.h>

#define FALLING_TILT 0.25f // rad, largest angle with the horizontal of a grain that falls onto the pile

// Lets grains fall onto the pile: in layers over its planned surface, so far apart that they do not touch.
void kit_drop(kit* k, int count)
{
    float length = 1.1f * k->mix.longest * (1.0f + 2.0f * k->mix.variation);
    ty_bounds interior = ty_container_interior(k->container);
    ty_vec3 center = ty_mul(ty_add(interior.low, interior.high), 0.5f);
    float rise = ty_max(0.55f * length, k->mix.widest > 0.75f * k->mix.longest ? length : 0.0f); // round ones: more
    float radius = 0.58f * ty_min(k->top.radius_x, k->top.radius_z), above = 0.6f * length;
    for (int i = 0; i < ty_pile_count(k->pile); i++) // over all that is there already
    {
        ty_vec3 p = ty_pile_bodies(k->pile)[i].position;
        above = ty_max(above, p.y - ty_fill_top_height(&k->top, p) + 0.6f * length);
    }
    int across = (int)(2.0f * radius / length) + 1, cells = across * across;
    int start = (int)(ty_rng_float(&k->rng) * (float)cells);
    for (int placed = 0, n = 0; placed < count; n++)
    {
        int cell = (start + n) % cells;
        float jitter = 0.12f * length, x = ((float)(cell % across) - 0.5f * (float)(across - 1)) * length;
        float z = ((float)(cell / across) - 0.5f * (float)(across - 1)) * length;
        x += ty_rng_range(&k->rng, -jitter, jitter);
        z += ty_rng_range(&k->rng, -jitter, jitter);
        float chance = ty_rng_float(&k->rng), layers = (float)(n / cells);
        if (x * x + z * z > radius * radius || chance > 0.85f) // some places stay empty, so that no lattice shows
            continue;
        ty_vec3 p = {center.x + x, 0.0f, center.z + z};
        p.y = ty_fill_top_height(&k->top, p) + above + layers * rise;
        ty_body body = kit_body(k, p, ty_min(k->fill->tilt, FALLING_TILT));
        ty_pile_add(k->pile, &body, 1);
        placed++;
    }
}

// --- the three starts ---

static ty_status inflate(kit* k, const ty_vec3* points, int count, ty_error* error)
{
    const ty_fill_def* fill = &k->recipe->fill;
    for (int i = 0; i < count; i++)
    {
        ty_body body = kit_body(k, points[i], fill->tilt);
        ty_pile_add(k->pile, &body, 1);
    }
    ty_pile_inflate(k->pile, &k->top, fill->sweeps, k->workers);
    ty_pile_measure(k->pile, &k->start, NULL);
    if (k->start.overlap_mean <= TY_PILE_PACKED)
        return TY_OK;
    float size = ty_pile_fit(k->pile, &k->top, fill->sweeps / 4, k->workers);
    if (ty_cancel_requested()) // before they were pushed apart
        return kit_interrupted("filling", error);
    return ty_error_set(error, TY_BAD_INPUT, "fill.density: %g; these elements pack to %.2f at most in this container",
                        (double)fill->density, (double)(fill->density * size * size * size));
}

static void thesis(kit* k, const ty_vec3* points, int count, double volume)
{
    ty_body* bodies = TY_ALLOC(ty_body, count);
    bool* gone = TY_ALLOC(bool, count);
    for (int i = 0; i < count; i++)
        bodies[i] = kit_body(k, points[i], k->recipe->fill.tilt);
    float spacing = ty_pow((float)(0.73 * volume / (double)count), 1.0f / 3.0f); // of a saturated Poisson-disk set
    k->removed = ty_fill_thesis(k->container, k->mix.grains, k->mix.grain_count, &k->recipe->fill.thesis, spacing,
                                bodies, count, gone);
    for (int i = 0; i < count; i++)
        if (!gone[i])
            ty_pile_add(k->pile, &bodies[i], 1);
    ty_free(bodies);
    ty_free(gone);
}

// All alike in one direction, at the pitch of the largest of them.
static ty_status lattice(kit* k, ty_vec3* points, int count, ty_error* error)
{
    ty_vec3 pitch = {0.0f, 0.0f, 0.0f};
    const mixture_kind* last = &k->mix.kinds[k->mix.end - 1];
    for (int i = 0; i < last->first + last->count; i++) // of layer 0
    {
        ty_vec3 size = ty_sub(k->mix.grains[i].mesh->bounds.high, k->mix.grains[i].mesh->bounds.low);
        pitch = ty_vec3_make(ty_max(pitch.x, size.x), ty_max(pitch.y, size.y), ty_max(pitch.z, size.z));
    }
    pitch = ty_mul(pitch, 1.02f);
    int found = ty_fill_lattice(k->container, pitch, count, points);
    for (int i = 0; i < found; i++)
    {
        ty_body body = kit_body(k, points[i], k->recipe->fill.tilt);
        body.rotation = ty_quat_identity();
        body.scale = ty_min(body.scale, 1.0f);
        ty_pile_add(k->pile, &body, 1);
    }
    if (found == count)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "fill.count: %d; a lattice has %d sites in this container", count, found);
}

// --- how many, how high ---

ty_status kit_count(kit* k, const char* place, float inset, int* out, ty_error* error)
{
    const ty_fill_def* fill = k->fill;
    *out = fill->count;
    if (fill->target == TY_FILL_COUNT)
        return TY_OK;
    float level = fill->target == TY_FILL_LEVEL ? fill->level : 0.0f;
    double space = ty_fill_space(k->container, level, fill->heap, inset) - k->spread;
    double count = space * (double)fill->density / (double)k->mix.volume;
    if (count >= 1.0 && count <= TY_FILL_MOST)
    {
        *out = (int)count;
        return TY_OK;
    }
    return ty_error_set(error, TY_BAD_INPUT,
                        "%sfill.%s: the space of %.4g cm^3 takes %.4g grains at a density of %g; 1..%d can be made",
                        place, fill->target == TY_FILL_LEVEL ? "level" : "density", space * 1e6, count,
                        (double)fill->density, TY_FILL_MOST);
}

static ty_status kit_start(kit* k, int count, double volume, float inset, ty_error* error)
{
    ty_vec3* points = TY_TRY_ALLOC(ty_vec3, count);
    if (!points)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d grains", count);
    ty_status status = TY_OK;
    if (k->recipe->fill.start == TY_FILL_LATTICE)
        status = lattice(k, points, count, error);
    else
    {
        status = ty_fill_seeds(k->container, &k->top, inset, volume, k->recipe->seed, count, points, error);
        if (status == TY_OK && k->recipe->fill.start == TY_FILL_THESIS)
            thesis(k, points, count, volume);
        else if (status == TY_OK)
            status = inflate(k, points, count, error);
    }
    ty_free(points);
    return status;
}

// In a closed space they begin as far as they lie in the end: from the narrow parts of a mesh, as an ear, none could
// get out.
float kit_inset(const kit* k)
{
    return (ty_container_is_open(k->container) ? 0.25f : 0.45f) * k->mix.width;
}

// How many of the count begin in the container, the space they take, and its upper surface. The sum over the space that
// a count came from and the plan sample it each their own way: a count that nobody gave is one that the plan holds.
static ty_status kit_plan(kit* k, float inset, int* count, double* volume, ty_error* error)
{
    const ty_fill_def* fill = &k->recipe->fill;
    for (bool given = fill->target == TY_FILL_COUNT;; given = true)
    {
        double capacity;
        *count = k->count;
        if (ty_container_is_open(k->container) && fill->start == TY_FILL_INFLATE)
            *count -= (int)((float)k->count * fill->sprinkle);
        *volume = (double)*count * (double)k->mix.volume / (double)fill->density;
        ty_status status = ty_fill_plan(k->container, *volume, fill->heap, inset, &k->top, &capacity, error);
        int most = (int)(capacity / *volume * (double)k->count);
        if (status == TY_OK && !ty_container_is_open(k->container) && capacity > 1.02 * *volume)
            ty_log(TY_LOG_WARNING, // what should be a rabbit has no ears
                   "fill.count: %d grains at a density of %g fill %.0f %% of the container, from below; %d fill it",
                   k->count, (double)fill->density, 100.0 * *volume / capacity, most);
        if (status == TY_OK)
            return TY_OK;
        if (given || most < 1)
            return ty_error_set(error, status,
                                "fill.count: %d grains at a density of %g; the container holds at most %d", k->count,
                                (double)fill->density, most);
        k->count = most;
    }
}

ty_status kit_fill(kit* k, ty_error* error)
{
    const ty_fill_def* fill = &k->recipe->fill;
    float inset = kit_inset(k);
    ty_status status = kit_count(k, "", inset, &k->count, error);
    if (status != TY_OK)
        return status;
    int count;
    double volume;
    status = kit_plan(k, inset, &count, &volume, error);
    if (status != TY_OK)
        return status;
    if (fill->start == TY_FILL_POUR)
    {
        k->wanted[0] = count;
        k->spread = volume;
        status = kit_pour_begin(k, error);
        bool in_film = k->recipe->animate.frames > 0; // which pours as it goes
        return status == TY_OK && !in_film ? kit_pour(k, error) : status;
    }
    status = kit_start(k, count, volume, inset, error);
    if (status != TY_OK)
        return status;
    if (fill->start != TY_FILL_INFLATE)
        ty_pile_measure(k->pile, &k->start, NULL);
    k->start_repeat = ty_pile_repeat(ty_pile_bodies(k->pile), ty_pile_count(k->pile), k->mix.width);
    ty_log(TY_LOG_INFO, "aggregate: %d grains placed, %d taken out, overlap %.2f %% of the width at most, %.3f %% mean",
           ty_pile_count(k->pile), k->removed, (double)k->start.overlap_max * 100.0,
           (double)k->start.overlap_mean * 100.0);
    kit_drop(k, k->count - count);
    k->count = k->wanted[0] = ty_pile_count(k->pile);
    k->spread = volume * (double)k->count / (double)count;
    return TY_OK;
}
