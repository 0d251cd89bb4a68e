// SPDX-License-Identifier: Apache-2.0
// The table of marks: what they are called, their rates, and how these vary from cell to cell.
#include "fill_run.h"
#include <stdio.h>
#include <string.h>
#include <tsuya/base/memory.h>

// --- the table ---

// Where u v^2 = F (1 - u) = (F + k) v, v above 0: u (1 - u) = (F + k)^2 / F, which has a solution up to
// k = sqrt(F) / 2 - F.
static ty_vec2 plain_state(ty_gray_scott_rates rates)
{
    float sum = rates.feed + rates.kill;
    float square = rates.feed > 0.0f ? 1.0f - 4.0f * sum * sum / rates.feed : -1.0f;
    if (square < 0.0f)
        return (ty_vec2){1.0f, 0.0f};
    float u = 0.5f * (1.0f - sqrtf(square));
    return (ty_vec2){u, sum / u};
}

void fill_marks_take(fill_run* run)
{
    const ty_fill_recipe* r = run->recipe;
    int count;
    const ty_fill_preset* presets = ty_fill_presets(&count);
    run->own = (ty_fill_mark){.preset = r->preset,
                              .feed = r->feed,
                              .kill = r->kill,
                              .color = r->high,
                              .ground = r->low,
                              .opacity = 1.0f,
                              .ground_opacity = 1.0f,
                              .seed = {.radius = 5.0f, .seed = {1}}};
    run->marks = r->marks.count > 0 ? r->marks.items : &run->own;
    run->mark_count = r->marks.count > 0 ? r->marks.count : 1;
    for (int i = 0; i < run->mark_count && i < TY_GRAY_SCOTT_MARKS; i++)
    {
        const ty_fill_mark* mark = &run->marks[i];
        const ty_fill_preset* preset = &presets[mark->preset];
        run->rates[i] = (ty_gray_scott_rates){fill_or(mark->feed, preset->feed), fill_or(mark->kill, preset->kill)};
        run->plain[i] = plain_state(run->rates[i]);
        run->varies = run->varies || mark->seed.jitter > 0.0f;
    }
    run->varies = run->varies || r->variation > 0.0f;
    run->level = fill_or(r->level, run->plain[0].y > 0.0f ? 0.5f * run->plain[0].y : 0.15f);
}

int fill_mark_find(const fill_run* run, const char* name, const char* key, ty_error* error)
{
    int number, length = 0;
    for (int i = 0; i < run->mark_count; i++)
        if (run->marks[i].name && strcmp(run->marks[i].name, name) == 0)
            return i;
    if (sscanf(name, "%d%n", &number, &length) == 1 && !name[length] && number >= 0 && number < run->mark_count)
        return number;
    char names[512] = "";
    for (int i = 0; i < run->mark_count; i++)
    {
        size_t used = strlen(names);
        const char* text = run->marks[i].name ? run->marks[i].name : "";
        snprintf(names + used, sizeof names - used, "%s%d%s%.40s", i > 0 ? ", " : "", i, *text ? " " : "", text);
    }
    (void)ty_error_set(error, TY_BAD_INPUT, "%s: no mark '%.100s' in the table; it has %s", key, name, names);
    return -1;
}

ty_status fill_marks_check(const fill_run* run, ty_error* error)
{
    if (run->mark_count > TY_GRAY_SCOTT_MARKS)
        return ty_error_set(error, TY_BAD_INPUT, "marks: %d rows; a table has at most %d", run->mark_count,
                            TY_GRAY_SCOTT_MARKS);
    for (int i = 0; i < run->mark_count; i++)
        for (int j = 0; j < i; j++)
            if (run->marks[i].name && run->marks[j].name && strcmp(run->marks[i].name, run->marks[j].name) == 0)
                return ty_error_set(error, TY_BAD_INPUT, "marks[%d].name: '%.100s' is the name of mark %d already", i,
                                    run->marks[i].name, j);
    for (int i = 0; i < run->mark_count; i++)
        if (run->marks[i].name && strcmp(run->marks[i].name, "closed") == 0)
            return ty_error_set(error, TY_BAD_INPUT, "marks[%d].name: 'closed' is what closed cells are called", i);
    return TY_OK;
}

// --- how rates vary ---

// Values of a lattice that wraps, blended by cubics: -1..1, smooth.
static float lattice_value(const float* lattice, int nx, int ny, float x, float y)
{
    int i = (int)floorf(x), j = (int)floorf(y);
    float fx = ty_smoothstep(x - (float)i), fy = ty_smoothstep(y - (float)j);
    const float *row = lattice + (j % ny) * nx, *next = lattice + ((j + 1) % ny) * nx;
    int a = i % nx, b = (i + 1) % nx;
    return ty_lerp(ty_lerp(row[a], row[b], fx), ty_lerp(next[a], next[b], fx), fy);
}

void fill_noise(fill_run* run)
{
    const ty_fill_recipe* r = run->recipe;
    int w = run->width, h = run->height;
    int nx = (int)ty_max(1.0f, floorf((float)w / r->variation_size + 0.5f));
    int ny = (int)ty_max(1.0f, floorf((float)h / r->variation_size + 0.5f));
    float* lattice = TY_ALLOC(float, nx* ny);
    ty_rng rng = ty_rng_make(r->seed, 0x66656564, 0);
    for (int i = 0; i < nx * ny; i++)
        lattice[i] = ty_rng_range(&rng, -1.0f, 1.0f);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            run->noise[fill_cell(run, x, y)] =
                lattice_value(lattice, nx, ny, (float)(x * nx) / (float)w, (float)(y * ny) / (float)h);
    ty_free(lattice);
}

static float cell_noise(ty_seed seed, size_t cell)
{
    ty_rng rng = ty_rng_make(seed, 0x6a697474, (uint64_t)cell);
    return ty_rng_range(&rng, -1.0f, 1.0f);
}

// Of the map at the middle of a cell, beyond those of the first mark.
static ty_status map_vary(const fill_run* run, ty_error* error)
{
    const ty_fill_map* map = &run->recipe->map;
    float *feed = run->cover, *kill = run->near_x;
    for (int y = 0; y < run->height; y++)
        for (int x = 0; x < run->width; x++)
        {
            size_t at = fill_cell(run, x, y);
            float up = 1.0f - ((float)y + 0.5f) / (float)run->height, right = ((float)x + 0.5f) / (float)run->width;
            feed[at] = ty_lerp(map->feed[0], map->feed[1], up) - run->rates[0].feed;
            kill[at] = ty_lerp(map->kill[0], map->kill[1], right) - run->rates[0].kill;
        }
    return ty_gray_scott_vary(run->field, feed, kill, error);
}

ty_status fill_vary(const fill_run* run, ty_error* error)
{
    if (run->recipe->map.feed[1] > 0.0f)
        return map_vary(run, error);
    if (!run->varies)
        return TY_OK;
    float* feed = run->cover; // nobody covers anything now
    for (int y = 0; y < run->height; y++)
    {
        const uint8_t* marks = ty_gray_scott_marks_seen(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            int mark = fill_mark_of(marks[x]);
            const ty_fill_seeding* seed = &run->marks[mark].seed;
            size_t at = fill_cell(run, x, y);
            float more = run->noise ? run->recipe->variation * run->noise[at] : 0.0f;
            if (seed->jitter > 0.0f)
                more += seed->jitter * cell_noise(seed->seed, at);
            feed[at] = run->rates[mark].feed * more;
        }
    }
    return ty_gray_scott_vary(run->field, feed, NULL, error);
}
