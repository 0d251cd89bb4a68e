// SPDX-License-Identifier: Apache-2.0
// The surface of roots as a distance, anywhere: exact within one root, run together between roots, cut at the trunk's
// top and under the host; its normal, and the relief of bark over it.
#include "roots_skin.h"
#include <tsuya/base/noise.h>

// --- one segment ---

static float along(const roots_segment* s, ty_vec3 p)
{
    return ty_clamp(ty_dot(ty_sub(p, s->a), s->d) * s->length_1, 0.0f, 1.0f);
}

static ty_vec3 normal(const roots_segment* s, float t)
{
    return ty_mad(s->na, s->nd, t);
}

// A flat section is stretched to a round one, its lower half drawn out by the fill.
static float segment_distance(const roots_segment* s, ty_vec3 p, float* t)
{
    *t = along(s, p);
    ty_vec3 q = ty_sub(p, ty_mad(s->a, s->d, *t));
    float height = ty_dot(q, normal(s, *t)), side = ty_length_sqr(q) - height * height;
    height += ty_clamp(-height, 0.0f, roots_segment_fill(s, *t));
    return sqrtf(ty_max(side, 0.0f) + height * height * (1.0f + s->ea + *t * s->ed)) - roots_segment_radius(s, *t);
}

// Flutes along the root and small swellings across it.
static float segment_relief(const roots_skin* skin, const roots_segment* s, float t, ty_vec3 p)
{
    const ty_roots_recipe* recipe = skin->recipe;
    const roots_point* points = skin->network->points;
    ty_vec3 q = ty_sub(p, ty_mad(s->a, s->d, t)), n = normal(s, t);
    float stretch = sqrtf(1.0f + s->ea + t * s->ed) - 1.0f, r = roots_segment_radius(s, t);
    ty_vec3 side = ty_normalize(ty_mad(q, n, ty_dot(q, n) * stretch));
    uint32_t seed = (uint32_t)recipe->seed.value + (uint32_t)skin->network->lines[s->line].key;
    float way = ty_lerp(points[s->point].s, points[s->point + 1].s, t) / recipe->radius;
    ty_vec3 flute = ty_add(ty_mul(side, 1.3f), ty_vec3_make(0.22f * way, 0.0f, 0.31f * way));
    ty_vec3 swell = ty_add(ty_mul(side, 0.9f), ty_vec3_make(0.0f, 0.7f * way, 0.3f * way));
    ty_vec3 grain = ty_add(ty_mul(side, 4.5f), ty_vec3_make(0.6f * way, 1.3f * way, 0.0f));
    float fine = ty_clamp(r / (4.5f * skin->step) - 1.0f, 0.0f, 1.0f); // what cells cannot show is left out
    float sum = ty_value_noise(flute, seed) + 0.35f * ty_value_noise(swell, seed + 1u);
    sum += fine > 0.0f ? 0.3f * fine * ty_value_noise(grain, seed + 2u) : 0.0f;
    return recipe->bark * r * sum;
}

// --- what is near ---

enum
{
    MOST_NEAR = 24, // roots that run together at a place
};

// The nearest segment of each root that counts there, in the order of roots.
typedef struct near
{
    int count;
    int32_t segments[MOST_NEAR];
    float distances[MOST_NEAR];
} near;

static int block_at(const roots_skin* skin, ty_vec3 p)
{
    ty_vec3 q = ty_mul(ty_sub(p, skin->origin), 1.0f / (skin->step * TY_NET_BLOCK));
    int i = (int)floorf(q.x), j = (int)floorf(q.y), k = (int)floorf(q.z);
    if (i < 0 || j < 0 || k < 0 || i >= skin->blocks[0] || j >= skin->blocks[1] || k >= skin->blocks[2])
        return -1;
    return (k * skin->blocks[1] + j) * skin->blocks[0] + i;
}

// Where there is no room the farthest goes.
static void near_add(near* n, int32_t segment, float distance)
{
    if (n->count == MOST_NEAR)
    {
        int far = 0;
        for (int i = 1; i < MOST_NEAR; i++)
            far = n->distances[i] > n->distances[far] ? i : far;
        if (distance >= n->distances[far])
            return;
        for (n->count--; far < n->count; far++)
        {
            n->segments[far] = n->segments[far + 1];
            n->distances[far] = n->distances[far + 1];
        }
    }
    n->segments[n->count] = segment;
    n->distances[n->count++] = distance;
}

// A root that is farther than the nearest by more than they can run together changes nothing.
static void near_prune(const roots_skin* skin, near* n)
{
    float least = TY_FLOAT_MAX;
    int kept = 0;
    for (int i = 0; i < n->count; i++)
        least = ty_min(least, n->distances[i]);
    for (int i = 0; i < n->count; i++)
    {
        const roots_segment* s = &skin->segments[n->segments[i]];
        float wide = ty_max(s->ra, s->ra + s->rd);
        if (n->distances[i] - least > skin->recipe->join * wide + skin->step)
            continue;
        n->segments[kept] = n->segments[i];
        n->distances[kept++] = n->distances[i];
    }
    n->count = kept;
}

// A distance that is not below the least of those segments: that of one that seems near.
static float near_bound(const roots_skin* skin, ty_vec3 p, int32_t begin, int32_t end)
{
    int32_t best = skin->list[begin];
    float least = TY_FLOAT_MAX, t;
    for (int32_t i = begin; i < end; i++)
    {
        const roots_ball* b = &skin->balls[skin->list[i]];
        float power = ty_length_sqr(ty_sub(p, b->p)) - b->r * b->r;
        best = power < least ? skin->list[i] : best;
        least = ty_min(least, power);
    }
    return segment_distance(&skin->segments[best], p, &t);
}

// line -1 = all. Segments of roots that near_prune would drop are not asked.
static void near_find(const roots_skin* skin, ty_vec3 p, int line, near* out)
{
    int block = block_at(skin, p);
    int32_t i = block < 0 ? 0 : skin->begin[block], end = block < 0 ? 0 : skin->begin[block + 1];
    float bound = line < 0 && i < end ? near_bound(skin, p, i, end) : TY_FLOAT_MAX;
    out->count = 0;
    while (i < end)
    {
        int its = skin->balls[skin->list[i]].line;
        int32_t best = -1;
        float least = TY_FLOAT_MAX;
        for (; i < end && skin->balls[skin->list[i]].line == its; i++)
        {
            const roots_ball* b = &skin->balls[skin->list[i]];
            float t, limit = ty_min(bound + b->spread, least) + b->r;
            if ((line >= 0 && its != line) || limit < 0.0f || ty_length_sqr(ty_sub(p, b->p)) > limit * limit)
                continue;
            float d = segment_distance(&skin->segments[skin->list[i]], p, &t);
            best = d < least ? skin->list[i] : best;
            least = ty_min(least, d);
        }
        if (best >= 0)
            near_add(out, best, least);
        bound = ty_min(bound, least);
    }
    near_prune(skin, out);
}

// --- together ---

typedef struct gathered
{
    roots_sample sample;
    float radius, depth, open, relief;
} gathered;

static gathered segment_gathered(const roots_skin* skin, int32_t number, ty_vec3 p)
{
    const roots_segment* s = &skin->segments[number];
    gathered out = {.sample = {.segment = number, .line = s->line}};
    float t;
    out.sample.distance = segment_distance(s, p, &t);
    out.sample.at = t;
    out.radius = roots_segment_radius(s, t);
    out.depth = roots_segment_depth(s, t);
    out.open = roots_segment_open(s, t);
    return out;
}

// The polynomial smooth minimum (Quilez).
static void gather(const roots_skin* skin, gathered* all, gathered* one, const ty_vec3* bark)
{
    float k = roots_join_width(skin->recipe->join, all->radius, one->radius, all->open, one->open);
    float h = ty_clamp(0.5f + 0.5f * (all->sample.distance - one->sample.distance) / k, 0.0f, 1.0f);
    float mixed = 4.0f * h * (1.0f - h);
    if (bark && h > 0.0f)
        one->relief = segment_relief(skin, &skin->segments[one->sample.segment], one->sample.at, *bark);
    float distance = ty_lerp(all->sample.distance, one->sample.distance, h) - 0.25f * k * mixed;
    float join = ty_max(ty_max(all->sample.join, one->sample.join) * (1.0f - mixed), mixed);
    if (h > 0.5f)
        all->sample = one->sample;
    all->sample.join = join;
    all->sample.distance = distance;
    all->radius = ty_lerp(all->radius, one->radius, h);
    all->depth = ty_lerp(all->depth, one->depth, h);
    all->open = ty_lerp(all->open, one->open, h);
    all->relief = h > 0.0f ? ty_lerp(all->relief, one->relief, h) : all->relief;
}

// With the host's cut and the top's; count of n is not 0.
static gathered near_gather(const roots_skin* skin, const near* n, ty_vec3 p, bool held, bool barked)
{
    gathered all = segment_gathered(skin, n->segments[0], p);
    barked &= skin->recipe->bark > 0.0f;
    if (barked)
        all.relief = segment_relief(skin, &skin->segments[n->segments[0]], all.sample.at, p);
    for (int i = 1; i < n->count; i++)
    {
        gathered one = segment_gathered(skin, n->segments[i], p);
        gather(skin, &all, &one, barked ? &p : NULL);
    }
    float under = 0.0f, top;
    if (held && all.sample.distance < all.radius)
        all.sample.distance = roots_skin_hold(skin, all.sample.distance, all.depth, all.radius, p, &under);
    all.sample.distance = roots_skin_top(skin, all.sample.distance, p.y, &top);
    all.relief *= (1.0f - under) * (1.0f - top);
    return all;
}

static roots_sample sample_at(const roots_skin* skin, ty_vec3 p, int line)
{
    near n;
    near_find(skin, p, line, &n);
    if (n.count == 0)
        return (roots_sample){.distance = TY_FLOAT_MAX, .segment = -1, .line = -1};
    return near_gather(skin, &n, p, line < 0 && skin->host, false).sample;
}

roots_sample roots_skin_at(const roots_skin* skin, ty_vec3 p)
{
    return sample_at(skin, p, -1);
}

roots_sample roots_skin_line_at(const roots_skin* skin, ty_vec3 p, int line)
{
    return sample_at(skin, p, line);
}

roots_sample roots_skin_look(const roots_skin* skin, ty_vec3 p, ty_vec3* direction, float within, float* relief)
{
    // Four corners of a tetrahedron are enough for a gradient.
    static const float corners[4][3] = {{1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, 1, 1}};
    near n;
    near_find(skin, p, -1, &n);
    *direction = ty_vec3_make(0.0f, 1.0f, 0.0f);
    if (relief)
        *relief = 0.0f;
    if (n.count == 0)
        return (roots_sample){.distance = TY_FLOAT_MAX, .segment = -1, .line = -1};
    gathered all = near_gather(skin, &n, p, skin->host, false);
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 4; i++)
    {
        ty_vec3 d = {corners[i][0], corners[i][1], corners[i][2]};
        ty_vec3 q = ty_mad(p, d, 0.25f * skin->step);
        sum = ty_mad(sum, d, near_gather(skin, &n, q, skin->host, false).sample.distance);
    }
    if (ty_length_sqr(sum) > 0.0f)
        *direction = ty_normalize(sum);
    if (relief && fabsf(all.sample.distance) <= within)
        *relief = near_gather(skin, &n, p, skin->host, true).relief;
    return all.sample;
}

// The field is an approximation: what lies near the host is held against the mesh itself.
bool roots_skin_keep(const roots_skin* skin, roots_sample sample, ty_vec3* p)
{
    if (!skin->host)
        return false;
    roots_point own = roots_skin_point(skin, sample);
    return roots_host_keep(skin->host, own.sink * own.r, p);
}

// --- what stands there ---

roots_point roots_skin_point(const roots_skin* skin, roots_sample sample)
{
    const roots_point* a = &skin->network->points[skin->segments[sample.segment].point];
    const roots_point* b = a + 1;
    const roots_segment* s = &skin->segments[sample.segment];
    float t = sample.at, r = ty_lerp(a->r, b->r, t);
    return (roots_point){.p = ty_lerp3(a->p, b->p, t),
                         .n = ty_lerp3(a->n, b->n, t),
                         .r = r,
                         .flat = ty_lerp(a->flat, b->flat, t),
                         .sink = roots_segment_depth(s, t) / r,
                         .s = ty_lerp(a->s, b->s, t),
                         .birth = ty_lerp(a->birth, b->birth, t)};
}

ty_vec2 roots_skin_uv(const roots_skin* skin, ty_vec3 p, roots_sample sample)
{
    roots_point axis = roots_skin_point(skin, sample);
    ty_vec3 q = ty_sub(p, axis.p), t = ty_normalize(skin->segments[sample.segment].d);
    float angle = ty_atan2(ty_dot(q, ty_cross(t, axis.n)), ty_dot(q, axis.n));
    return (ty_vec2){0.5f + angle * (0.5f * TY_INV_PI), axis.s};
}
