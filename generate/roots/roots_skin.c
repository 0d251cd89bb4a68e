// SPDX-License-Identifier: Apache-2.0
// The surface of roots as a distance: exact within one root, run together between roots, cut at the trunk's top.
// Segments are found through blocks of a grid, so that it can be asked anywhere.
#include "roots.h"
#include <string.h>
#include <tsuya/base/noise.h>

enum
{
    BLOCK = 4,                // corners of cells a side
    MOST_CORNERS = 150000000, // of the grid: 600 MB
};

#define CUT_EDGE 0.4e-3f // m, rounding of the cut

struct roots_skin
{
    const ty_roots_recipe* recipe;
    const roots_lines* lines;
    ty_vec3 origin;
    float step;
    int size[3], blocks[3];
    int* begin; // [blocks + 1] into list
    int* list;  // segments, in order
};

// --- one segment ---

static roots_point segment_point(const roots_segment* s, float t)
{
    roots_point p = {.p = ty_lerp3(s->a.p, s->b.p, t), .n = ty_lerp3(s->a.n, s->b.n, t)};
    p.r = ty_lerp(s->a.r, s->b.r, t);
    p.flat = ty_lerp(s->a.flat, s->b.flat, t);
    p.s = ty_lerp(s->a.s, s->b.s, t);
    return p;
}

// p about the axis; a flat section is stretched to a round one.
static ty_vec3 stretched(const roots_point* axis, ty_vec3 p)
{
    ty_vec3 q = ty_sub(p, axis->p);
    return ty_mad(q, axis->n, ty_dot(q, axis->n) * (1.0f / axis->flat - 1.0f));
}

static float segment_distance(const roots_segment* s, ty_vec3 p, float* at)
{
    ty_vec3 along = ty_sub(s->b.p, s->a.p);
    float length = ty_length_sqr(along);
    *at = length > 0.0f ? ty_clamp(ty_dot(ty_sub(p, s->a.p), along) / length, 0.0f, 1.0f) : 0.0f;
    roots_point axis = segment_point(s, *at);
    return ty_length(stretched(&axis, p)) - axis.r;
}

// --- relief ---

// Flutes along the root and small swellings across it, as lengths: about -1.4..1.4 times the depth of the bark.
static float relief(const roots_skin* skin, const roots_segment* s, float at, ty_vec3 p)
{
    const ty_roots_recipe* recipe = skin->recipe;
    roots_point axis = segment_point(s, at);
    ty_vec3 across = ty_normalize(stretched(&axis, p));
    uint32_t seed = (uint32_t)recipe->seed.value + 77u * (uint32_t)s->root;
    float along = axis.s / recipe->radius;
    ty_vec3 flute = ty_add(ty_mul(across, 1.3f), ty_vec3_make(0.22f * along, 0.0f, 0.31f * along));
    ty_vec3 swell = ty_add(ty_mul(across, 0.9f), ty_vec3_make(0.0f, 0.7f * along, 0.3f * along));
    ty_vec3 grain = ty_add(ty_mul(across, 4.5f), ty_vec3_make(0.6f * along, 1.3f * along, 0.0f));
    float fine = ty_clamp(axis.r / (4.5f * skin->step) - 1.0f, 0.0f, 1.0f); // what cells cannot show is left out
    float sum = ty_value_noise(flute, seed) + 0.35f * ty_value_noise(swell, seed + 1u);
    sum += fine > 0.0f ? 0.3f * fine * ty_value_noise(grain, seed + 2u) : 0.0f;
    return recipe->bark * axis.r * sum;
}

// --- all of them ---

typedef struct gathered
{
    roots_sample sample;
    float radius;
} gathered;

// The polynomial smooth minimum (Quilez) over a width in proportion to the thinner of both.
static void gather(const roots_skin* skin, gathered* all, const gathered* one)
{
    if (all->sample.segment < 0)
    {
        *all = *one;
        return;
    }
    float k = ty_max(skin->recipe->join * ty_min(all->radius, one->radius), 1e-9f);
    float h = ty_clamp(0.5f + 0.5f * (all->sample.distance - one->sample.distance) / k, 0.0f, 1.0f);
    float mixed = 4.0f * h * (1.0f - h);
    float distance = ty_lerp(all->sample.distance, one->sample.distance, h) - 0.25f * k * mixed;
    if (h > 0.5f)
    {
        all->sample.segment = one->sample.segment;
        all->sample.at = one->sample.at;
    }
    all->sample.join = ty_max(ty_max(all->sample.join, one->sample.join) * (1.0f - mixed), mixed);
    all->sample.distance = distance;
    all->radius = ty_lerp(all->radius, one->radius, h);
}

// The nearest of a root's segments from list[*i] on; *i goes on to the next root.
static gathered root_nearest(const roots_skin* skin, const int* list, int end, int* i, ty_vec3 p)
{
    const roots_segment* segments = skin->lines->segments;
    int root = segments[list[*i]].root;
    gathered best = {{TY_FLOAT_MAX, -1, 0.0f, 0.0f}, 0.0f};
    for (; *i < end && segments[list[*i]].root == root; ++*i)
    {
        float at, d = segment_distance(&segments[list[*i]], p, &at);
        if (d < best.sample.distance)
            best.sample = (roots_sample){d, list[*i], at, 0.0f};
    }
    const roots_segment* s = &segments[best.sample.segment];
    best.radius = ty_lerp(s->a.r, s->b.r, best.sample.at);
    if (skin->recipe->bark > 0.0f && best.sample.distance < 2.0f * best.radius)
        best.sample.distance -= relief(skin, s, best.sample.at, p);
    return best;
}

static int block_at(const roots_skin* skin, ty_vec3 p)
{
    ty_vec3 q = ty_mul(ty_sub(p, skin->origin), 1.0f / (skin->step * BLOCK));
    int i = (int)floorf(q.x), j = (int)floorf(q.y), k = (int)floorf(q.z);
    if (i < 0 || j < 0 || k < 0 || i >= skin->blocks[0] || j >= skin->blocks[1] || k >= skin->blocks[2])
        return -1;
    return (k * skin->blocks[1] + j) * skin->blocks[0] + i;
}

static roots_sample sample_cut(const roots_skin* skin, roots_sample sample, ty_vec3 p)
{
    float above = p.y - skin->lines->top;
    float h = ty_clamp(0.5f - 0.5f * (sample.distance - above) / CUT_EDGE, 0.0f, 1.0f);
    sample.distance = ty_lerp(sample.distance, above, h) + CUT_EDGE * h * (1.0f - h);
    return sample;
}

// root -1 = all.
static roots_sample sample_at(const roots_skin* skin, ty_vec3 p, int root)
{
    gathered all = {{TY_FLOAT_MAX, -1, 0.0f, 0.0f}, 0.0f};
    int block = block_at(skin, p);
    if (block < 0)
        return all.sample;
    int end = skin->begin[block + 1];
    for (int i = skin->begin[block]; i < end;)
    {
        int its = skin->lines->segments[skin->list[i]].root;
        gathered one = root_nearest(skin, skin->list, end, &i, p);
        if (root < 0 || its == root)
            gather(skin, &all, &one);
    }
    return all.sample.segment >= 0 ? sample_cut(skin, all.sample, p) : all.sample;
}

roots_sample roots_skin_at(const roots_skin* skin, ty_vec3 p)
{
    return sample_at(skin, p, -1);
}

roots_sample roots_skin_root_at(const roots_skin* skin, ty_vec3 p, int root)
{
    return sample_at(skin, p, root);
}

ty_vec3 roots_skin_normal(const roots_skin* skin, ty_vec3 p)
{
    // Four corners of a tetrahedron are enough for a gradient.
    static const float corners[4][3] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 4; i++)
    {
        ty_vec3 d = {corners[i][0], corners[i][1], corners[i][2]};
        roots_sample sample = roots_skin_at(skin, ty_mad(p, d, 0.25f * skin->step));
        if (sample.segment >= 0)
            sum = ty_mad(sum, d, sample.distance);
    }
    return ty_normalize(sum);
}

ty_vec2 roots_skin_uv(const roots_skin* skin, ty_vec3 p, roots_sample sample)
{
    const roots_segment* s = &skin->lines->segments[sample.segment];
    roots_point axis = segment_point(s, sample.at);
    ty_vec3 q = ty_sub(p, axis.p), t = ty_normalize(ty_sub(s->b.p, s->a.p));
    float angle = ty_atan2(ty_dot(q, ty_cross(t, axis.n)), ty_dot(q, axis.n));
    return (ty_vec2){0.5f + angle * (0.5f * TY_INV_PI), axis.s};
}

// --- blocks ---

static float segment_reach(const roots_skin* skin, const roots_segment* s)
{
    const ty_roots_recipe* recipe = skin->recipe;
    return ty_max(s->a.r, s->b.r) * (1.0f + 1.8f * recipe->bark + recipe->join) + 3.0f * skin->step;
}

static ty_bounds segment_bounds(const roots_skin* skin, const roots_segment* s)
{
    float reach = segment_reach(skin, s);
    ty_vec3 margin = {reach, reach, reach};
    return (ty_bounds){ty_sub(ty_min3(s->a.p, s->b.p), margin), ty_add(ty_max3(s->a.p, s->b.p), margin)};
}

// Calls for each block that a segment reaches: counts, or writes where the count stands.
static void blocks_visit(roots_skin* skin, int segment, bool write)
{
    ty_bounds b = segment_bounds(skin, &skin->lines->segments[segment]);
    float scale = 1.0f / (skin->step * BLOCK);
    ty_vec3 low = ty_mul(ty_sub(b.low, skin->origin), scale), high = ty_mul(ty_sub(b.high, skin->origin), scale);
    for (int k = (int)ty_max(low.z, 0.0f); k <= (int)high.z && k < skin->blocks[2]; k++)
        for (int j = (int)ty_max(low.y, 0.0f); j <= (int)high.y && j < skin->blocks[1]; j++)
            for (int i = (int)ty_max(low.x, 0.0f); i <= (int)high.x && i < skin->blocks[0]; i++)
            {
                int* at = &skin->begin[(k * skin->blocks[1] + j) * skin->blocks[0] + i];
                if (write)
                    skin->list[*at] = segment;
                ++*at;
            }
}

static ty_status blocks_fill(roots_skin* skin, ty_error* error)
{
    int count = skin->blocks[0] * skin->blocks[1] * skin->blocks[2];
    skin->begin = TY_TRY_ALLOC(int, count + 1);
    if (!skin->begin)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d blocks of roots", count);
    for (int s = 0; s < skin->lines->count; s++)
        blocks_visit(skin, s, false);
    int64_t sum = 0;
    for (int b = 0; b <= count; b++)
    {
        int own = b < count ? skin->begin[b] : 0;
        skin->begin[b] = (int)sum;
        sum += own;
    }
    skin->list = sum < INT32_MAX ? TY_TRY_ALLOC(int, sum) : NULL;
    if (!skin->list)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %lld pieces of roots", (long long)sum);
    for (int s = 0; s < skin->lines->count; s++)
        blocks_visit(skin, s, true);
    memmove(skin->begin + 1, skin->begin, (size_t)count * sizeof(int)); // each stands at its end now
    skin->begin[0] = 0;
    return TY_OK;
}

static ty_status size_plan(roots_skin* skin, ty_error* error)
{
    ty_bounds all = ty_bounds_empty();
    for (int s = 0; s < skin->lines->count; s++)
    {
        ty_bounds b = segment_bounds(skin, &skin->lines->segments[s]);
        all.low = ty_min3(all.low, b.low);
        all.high = ty_max3(all.high, b.high);
    }
    ty_vec3 size = ty_mul(ty_sub(all.high, all.low), 1.0f / skin->step);
    double corners = ((double)size.x + 2.0) * ((double)size.y + 2.0) * ((double)size.z + 2.0);
    if (!(corners < MOST_CORNERS))
        return ty_error_set(error, TY_BAD_INPUT,
                            "detail: %g mm; these roots would need %.3g cells, and there are at most %d million",
                            (double)skin->step * 1e3, corners, MOST_CORNERS / 1000000);
    const float extent[3] = {size.x, size.y, size.z};
    skin->origin = all.low;
    for (int i = 0; i < 3; i++)
    {
        skin->size[i] = (int)extent[i] + 2;
        skin->blocks[i] = (skin->size[i] + BLOCK - 1) / BLOCK;
    }
    return TY_OK;
}

ty_status roots_skin_create(const ty_roots_recipe* recipe, const roots_lines* lines, roots_skin** out, ty_error* error)
{
    roots_skin* skin = TY_ALLOC(roots_skin, 1);
    *skin = (roots_skin){.recipe = recipe, .lines = lines, .step = recipe->detail};
    ty_status status = size_plan(skin, error);
    if (status == TY_OK)
        status = blocks_fill(skin, error);
    *out = skin;
    if (status == TY_OK)
        return TY_OK;
    *out = NULL;
    roots_skin_destroy(skin);
    return status;
}

void roots_skin_destroy(roots_skin* skin)
{
    if (!skin)
        return;
    ty_free(skin->begin);
    ty_free(skin->list);
    ty_free(skin);
}

// --- the grid ---

typedef struct gridding
{
    const roots_skin* skin;
    roots_grid* grid;
} gridding;

static ty_vec3 corner_place(const roots_grid* grid, float i, float j, float k)
{
    return ty_mad(grid->origin, ty_vec3_make(i, j, k), grid->step);
}

// The distance changes by less than twice the way: relief and flat sections take it above one.
static void block_fill(const roots_skin* skin, const roots_grid* grid, const int first[3])
{
    const float half = 0.5f * (BLOCK - 1), away = 2.0f * 1.7321f * half * grid->step;
    ty_vec3 middle = corner_place(grid, (float)first[0] + half, (float)first[1] + half, (float)first[2] + half);
    float distance = roots_skin_at(skin, middle).distance;
    bool is_near = distance > -away && distance < away;
    for (int k = first[2]; k < first[2] + BLOCK && k < grid->size[2]; k++)
        for (int j = first[1]; j < first[1] + BLOCK && j < grid->size[1]; j++)
            for (int i = first[0]; i < first[0] + BLOCK && i < grid->size[0]; i++)
            {
                size_t at = ((size_t)k * (size_t)grid->size[1] + (size_t)j) * (size_t)grid->size[0] + (size_t)i;
                ty_vec3 p = corner_place(grid, (float)i, (float)j, (float)k);
                grid->values[at] = is_near ? roots_skin_at(skin, p).distance : distance;
            }
}

static void blocks_grid(void* context, int64_t begin, int64_t end, int worker)
{
    const gridding* g = context;
    const int* blocks = g->skin->blocks;
    (void)worker;
    for (int64_t b = begin; b < end; b++)
    {
        const int first[3] = {(int)(b % blocks[0]) * BLOCK, (int)(b / blocks[0] % blocks[1]) * BLOCK,
                              (int)(b / blocks[0] / blocks[1]) * BLOCK};
        block_fill(g->skin, g->grid, first);
    }
}

ty_status roots_skin_grid(const roots_skin* skin, ty_workers* workers, roots_grid* out, ty_error* error)
{
    *out = (roots_grid){.origin = skin->origin, .step = skin->step};
    memcpy(out->size, skin->size, sizeof out->size);
    size_t rows = (size_t)out->size[1] * (size_t)out->size[2];
    out->values = TY_TRY_ALLOC(float, rows*(size_t)out->size[0]);
    if (!out->values)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %zu cells of roots", rows * (size_t)out->size[0]);
    gridding g = {skin, out};
    int64_t blocks = (int64_t)skin->blocks[0] * skin->blocks[1] * skin->blocks[2];
    if (ty_parallel_for(workers, blocks, 256, blocks_grid, &g))
        return TY_OK;
    ty_free(out->values);
    out->values = NULL;
    return ty_error_set(error, TY_INTERRUPTED, "interrupted while the surface of roots was made");
}
