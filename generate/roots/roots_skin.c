// SPDX-License-Identifier: Apache-2.0
// The surface of roots as a distance: exact within one root, run together between roots, cut at the trunk's top.
// Segments are found through blocks of a grid, so that it can be asked anywhere.
#include "roots_skin.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/log.h>
#include <tsuya/base/noise.h>

#define CUT_EDGE 0.4e-3f // m, rounding of the cut
#define MOST_BLOCKS 60e6 // of the grid, with or without roots

// --- one segment ---

static float along(const roots_segment* s, ty_vec3 p)
{
    return ty_clamp(ty_dot(ty_sub(p, s->a), s->d) * s->length_1, 0.0f, 1.0f);
}

// p about the axis.
static ty_vec3 across(const roots_segment* s, float t, ty_vec3 p)
{
    return ty_sub(p, ty_mad(s->a, s->d, t));
}

static ty_vec3 normal(const roots_segment* s, float t)
{
    return ty_mad(s->na, s->nd, t);
}

// A flat section is stretched to a round one.
static float segment_distance(const roots_segment* s, ty_vec3 p, float* t)
{
    *t = along(s, p);
    ty_vec3 q = across(s, *t, p);
    float height = ty_dot(q, normal(s, *t));
    return sqrtf(ty_length_sqr(q) + height * height * (s->ea + *t * s->ed)) - roots_segment_radius(s, *t);
}

// --- relief ---

// Flutes along the root and small swellings across it.
float roots_skin_relief(const roots_skin* skin, const roots_segment* s, float t, ty_vec3 p)
{
    const ty_roots_recipe* recipe = skin->recipe;
    const roots_point* points = skin->network->points;
    ty_vec3 q = across(s, t, p), n = normal(s, t);
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

// --- all of them ---

typedef struct gathered
{
    roots_sample sample;
    float radius, depth;
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
    all->depth = ty_lerp(all->depth, one->depth, h);
}

// The nearest of a root's segments from list[*i] on; *i goes on to the next root.
static gathered line_nearest(const roots_skin* skin, int32_t end, int32_t* i, ty_vec3 p)
{
    const roots_segment* segments = skin->segments;
    int line = segments[skin->list[*i]].line;
    gathered best = {{TY_FLOAT_MAX, -1, line, 0.0f, 0.0f}, 0.0f, 0.0f};
    for (; *i < end && segments[skin->list[*i]].line == line; ++*i)
    {
        float t, d = segment_distance(&segments[skin->list[*i]], p, &t);
        if (d < best.sample.distance)
        {
            best.sample.distance = d;
            best.sample.segment = skin->list[*i];
            best.sample.at = t;
        }
    }
    const roots_segment* s = &segments[best.sample.segment];
    best.radius = roots_segment_radius(s, best.sample.at);
    best.depth = roots_segment_depth(s, best.sample.at);
    if (skin->recipe->bark > 0.0f && best.sample.distance < 2.0f * best.radius)
        best.sample.distance -= roots_skin_relief(skin, s, best.sample.at, p);
    return best;
}

float roots_skin_hold(const roots_skin* skin, float distance, float depth, float radius, ty_vec3 p)
{
    float over = -(roots_host_value(skin->host, p, NULL) + depth), edge = ty_max(0.3f * radius, skin->step);
    float h = ty_clamp(0.5f - 0.5f * (distance - over) / edge, 0.0f, 1.0f);
    return ty_lerp(distance, over, h) + edge * h * (1.0f - h);
}

static int block_at(const roots_skin* skin, ty_vec3 p)
{
    ty_vec3 q = ty_mul(ty_sub(p, skin->origin), 1.0f / (skin->step * TY_NET_BLOCK));
    int i = (int)floorf(q.x), j = (int)floorf(q.y), k = (int)floorf(q.z);
    if (i < 0 || j < 0 || k < 0 || i >= skin->blocks[0] || j >= skin->blocks[1] || k >= skin->blocks[2])
        return -1;
    return (k * skin->blocks[1] + j) * skin->blocks[0] + i;
}

float roots_skin_cut(const roots_skin* skin, float distance, float y)
{
    float above = y - skin->network->top, edge = ty_max(CUT_EDGE, skin->step);
    float h = ty_clamp(0.5f - 0.5f * (distance - above) / edge, 0.0f, 1.0f);
    return ty_lerp(distance, above, h) + edge * h * (1.0f - h);
}

// line -1 = all.
static roots_sample sample_at(const roots_skin* skin, ty_vec3 p, int line)
{
    gathered all = {{TY_FLOAT_MAX, -1, -1, 0.0f, 0.0f}, 0.0f, 0.0f};
    int block = block_at(skin, p);
    if (block < 0)
        return all.sample;
    int32_t end = skin->begin[block + 1];
    for (int32_t i = skin->begin[block]; i < end;)
    {
        int its = skin->segments[skin->list[i]].line;
        gathered one = line_nearest(skin, end, &i, p);
        if (line < 0 || its == line)
            gather(skin, &all, &one);
    }
    if (all.sample.segment < 0)
        return all.sample;
    all.sample.line = skin->segments[all.sample.segment].line;
    if (line < 0 && skin->host && all.sample.distance < all.radius)
        all.sample.distance = roots_skin_hold(skin, all.sample.distance, all.depth, all.radius, p);
    all.sample.distance = roots_skin_cut(skin, all.sample.distance, p.y);
    return all.sample;
}

roots_sample roots_skin_at(const roots_skin* skin, ty_vec3 p)
{
    return sample_at(skin, p, -1);
}

roots_sample roots_skin_line_at(const roots_skin* skin, ty_vec3 p, int line)
{
    return sample_at(skin, p, line);
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

roots_point roots_skin_point(const roots_skin* skin, roots_sample sample)
{
    const roots_point* a = &skin->network->points[skin->segments[sample.segment].point];
    const roots_point* b = a + 1;
    float t = sample.at;
    return (roots_point){.p = ty_lerp3(a->p, b->p, t),
                         .n = ty_lerp3(a->n, b->n, t),
                         .r = ty_lerp(a->r, b->r, t),
                         .flat = ty_lerp(a->flat, b->flat, t),
                         .sink = ty_lerp(a->sink, b->sink, t),
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

// --- segments ---

static roots_segment segment_make(const roots_point* a, const roots_point* b, int line, int point)
{
    ty_vec3 d = ty_sub(b->p, a->p);
    float length = ty_length_sqr(d), ea = 1.0f / ty_sqr(a->flat) - 1.0f, eb = 1.0f / ty_sqr(b->flat) - 1.0f;
    return (roots_segment){.a = a->p,
                           .d = d,
                           .na = a->n,
                           .nd = ty_sub(b->n, a->n),
                           .length_1 = length > 0.0f ? 1.0f / length : 0.0f,
                           .ra = a->r,
                           .rd = b->r - a->r,
                           .ea = ea,
                           .ed = eb - ea,
                           .sink_a = a->sink * a->r,
                           .sink_d = b->sink * b->r - a->sink * a->r,
                           .line = line,
                           .point = point};
}

static bool segments_make(roots_skin* skin)
{
    const roots_network* net = skin->network;
    skin->segments = TY_TRY_ALLOC(roots_segment, net->point_count);
    if (!skin->segments)
        return false;
    for (int line = 0; line < net->line_count; line++)
        for (int i = 0; i + 1 < net->lines[line].count; i++)
        {
            int point = net->lines[line].first + i;
            skin->segments[skin->segment_count++] =
                segment_make(&net->points[point], &net->points[point + 1], line, point);
        }
    return true;
}

static ty_bounds segment_bounds(const roots_skin* skin, const roots_segment* s)
{
    const ty_roots_recipe* recipe = skin->recipe;
    float r = ty_max(s->ra, s->ra + s->rd);
    float reach = r * (1.0f + ROOTS_RELIEF_MOST * recipe->bark + 0.25f * recipe->join) + 3.0f * skin->step;
    ty_vec3 margin = {reach, reach, reach}, b = ty_add(s->a, s->d);
    return (ty_bounds){ty_sub(ty_min3(s->a, b), margin), ty_add(ty_max3(s->a, b), margin)};
}

// --- blocks ---

// Calls for each block that a segment reaches: counts, or writes where the count stands.
static void blocks_visit(roots_skin* skin, int segment, bool write)
{
    ty_bounds b = segment_bounds(skin, &skin->segments[segment]);
    float scale = 1.0f / (skin->step * TY_NET_BLOCK);
    ty_vec3 low = ty_mul(ty_sub(b.low, skin->origin), scale), high = ty_mul(ty_sub(b.high, skin->origin), scale);
    for (int k = (int)ty_max(low.z, 0.0f); k <= (int)high.z && k < skin->blocks[2]; k++)
        for (int j = (int)ty_max(low.y, 0.0f); j <= (int)high.y && j < skin->blocks[1]; j++)
            for (int i = (int)ty_max(low.x, 0.0f); i <= (int)high.x && i < skin->blocks[0]; i++)
            {
                int32_t* at = &skin->begin[(k * skin->blocks[1] + j) * skin->blocks[0] + i];
                if (write)
                    skin->list[*at] = segment;
                ++*at;
            }
}

static bool blocks_fill(roots_skin* skin)
{
    int count = skin->blocks[0] * skin->blocks[1] * skin->blocks[2];
    int64_t sum = 0;
    skin->begin = TY_TRY_ALLOC(int32_t, (int64_t)count + 1);
    if (!skin->begin)
        return false;
    for (int s = 0; s < skin->segment_count; s++)
        blocks_visit(skin, s, false);
    for (int b = 0; b <= count; b++)
    {
        int own = b < count ? skin->begin[b] : 0;
        skin->active_count += own > 0;
        skin->begin[b] = (int32_t)sum;
        sum += own;
    }
    skin->list = sum < INT32_MAX ? TY_TRY_ALLOC(int32_t, sum) : NULL;
    skin->active = TY_TRY_ALLOC(int32_t, skin->active_count);
    if (!skin->list || !skin->active)
        return false;
    for (int s = 0; s < skin->segment_count; s++)
        blocks_visit(skin, s, true);
    memmove(skin->begin + 1, skin->begin, (size_t)count * sizeof(int32_t)); // each stands at its end now
    skin->begin[0] = 0;
    for (int b = 0, i = 0; b < count; b++)
        if (skin->begin[b + 1] > skin->begin[b])
            skin->active[i++] = b;
    return true;
}

static ty_status size_plan(roots_skin* skin, ty_error* error)
{
    ty_bounds all = ty_bounds_empty();
    double blocks = 1.0;
    for (int s = 0; s < skin->segment_count; s++)
    {
        ty_bounds b = segment_bounds(skin, &skin->segments[s]);
        all.low = ty_min3(all.low, b.low);
        all.high = ty_max3(all.high, b.high);
    }
    if (skin->segment_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "not a single root could be grown");
    ty_vec3 size = ty_mul(ty_sub(all.high, all.low), 1.0f / (skin->step * TY_NET_BLOCK));
    const float extent[3] = {size.x, size.y, size.z};
    skin->origin = all.low;
    for (int i = 0; i < 3; i++)
        blocks *= (double)extent[i] + 1.0;
    if (!(blocks < MOST_BLOCKS))
        return ty_error_set(error, TY_BAD_INPUT, "detail: %g mm; for roots of this size it is at least %.3g mm",
                            (double)skin->step * 1e3, (double)skin->step * 1e3 * cbrt(blocks / MOST_BLOCKS));
    for (int i = 0; i < 3; i++)
        skin->blocks[i] = (int)extent[i] + 1;
    return TY_OK;
}

// --- all of it ---

ty_status roots_skin_create(const ty_roots_recipe* recipe, const roots_network* network, const roots_host* host,
                            roots_skin** out, ty_error* error)
{
    roots_skin* skin = TY_ALLOC(roots_skin, 1);
    *skin = (roots_skin){.recipe = recipe, .network = network, .host = host, .step = recipe->detail};
    *out = NULL;
    ty_status status = TY_OK;
    if (!segments_make(skin))
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for %d points of roots", network->point_count);
    if (status == TY_OK)
        status = size_plan(skin, error);
    if (status == TY_OK && !blocks_fill(skin))
        status =
            ty_error_set(error, TY_NO_MEMORY, "no memory for the surface of %d points of roots", network->point_count);
    if (status == TY_OK)
        *out = skin;
    else
        roots_skin_destroy(skin);
    return status;
}

void roots_skin_destroy(roots_skin* skin)
{
    if (!skin)
        return;
    ty_free(skin->segments);
    ty_free(skin->begin);
    ty_free(skin->list);
    ty_free(skin->active);
    ty_free(skin);
}

ty_status roots_skin_mesh(const roots_skin* skin, ty_workers* workers, ty_mesh** out, ty_error* error)
{
    enum
    {
        RELAX = 8, // rounds
    };
    const float corner = ty_radians(20.0f);
    ty_net_def def = {.origin = skin->origin,
                      .step = skin->step,
                      .blocks = {skin->blocks[0], skin->blocks[1], skin->blocks[2]},
                      .active = skin->active,
                      .active_count = skin->active_count,
                      .fill = roots_skin_fill,
                      .context = (void*)skin};
    double start = ty_time_now();
    ty_net* net;
    ty_net_pieces pieces = {0};
    *out = NULL;
    ty_status status = ty_net_create(&def, workers, &net, error);
    if (status != TY_OK)
        return status;
    double cut = ty_time_now();
    if (!ty_net_relax(net, RELAX, workers))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while the surface of roots was made");
    if (status == TY_OK)
        status = ty_net_mesh(net, out, &pieces, error);
    ty_net_destroy(net);
    if (status == TY_OK)
        status = ty_mesh_mend_corners(*out, corner, NULL, error);
    if (status == TY_OK)
        ty_log(TY_LOG_DEBUG, "roots: surface found in %.2f s, relaxed in %.2f s; %d shells, %d voids", cut - start,
               ty_time_now() - cut, pieces.shells, pieces.voids);
    else
    {
        ty_mesh_destroy(*out);
        *out = NULL;
    }
    return status;
}
