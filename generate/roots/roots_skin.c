// SPDX-License-Identifier: Apache-2.0
// The surface of roots, from segments in blocks of a grid to one mesh: cut, relaxed, bark raised, corners mended.
#include "roots_skin.h"
#include <math.h>
#include <string.h>
#include <tsuya/base/log.h>

#define MOST_BLOCKS 60e6 // of the grid, with or without roots

// --- segments ---

// How a root lies on the host at a point of its line, m.
typedef struct resting
{
    float depth; // how deep it may reach under it
    float fill;  // how far its lower half is drawn out to get there
} resting;

#define FILL_MOST 0.6f    // of the radius
#define DEPTH_LEAST 0.05f // of the radius, where it touches the host at all

// The underside has to come down to the depth that it may have, and a bit farther: what lies on the host fills what is
// rough under it, and what comes near it takes hold. The host cuts off what is too much. With a `sink` of 0 roots only
// touch it.
static resting resting_at(const roots_skin* skin, const roots_point* p)
{
    if (!skin->host || skin->recipe->growth.sink <= 0.0f)
        return (resting){p->sink * p->r, 0.0f};
    float lift = roots_host_value(skin->host, p->p, NULL) - (p->flat - p->sink) * p->r, most = FILL_MOST * p->r;
    if (p->sink <= 0.0f && lift > most)
        return (resting){0.0f, 0.0f};
    float fill = lift + 0.15f * p->r + 0.35f * skin->host->field.step;
    return (resting){ty_max(p->sink, DEPTH_LEAST) * p->r, ty_clamp(fill, 0.2f * p->r, most)};
}

static roots_segment segment_make(const roots_point* a, const roots_point* b, resting ra, resting rb, int line,
                                  int point)
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
                           .sink_a = ra.depth,
                           .sink_d = rb.depth - ra.depth,
                           .fill_a = ra.fill,
                           .fill_d = rb.fill - ra.fill,
                           .line = line,
                           .point = point};
}

// How far a point of a line is out of the root that the line leaves or grows into there, of its radius.
static float open_at(const roots_network* net, const roots_line* line, const roots_point* p)
{
    float open = 1.0f;
    for (int end = 0; end < 2; end++)
    {
        int other = end ? line->end : line->parent, point = end ? line->end_point : line->parent_point;
        if (other < 0 || point < 0 || net->lines[other].kind == ROOTS_TRUNK || line->kind == ROOTS_MAIN)
            continue;
        const roots_point* q = &net->points[point];
        float part = ty_min(ty_length_sqr(ty_sub(p->p, q->p)) / ty_sqr(q->r), 1.0f);
        open = ty_min(open, part * (2.0f - part));
    }
    return open;
}

// Of the segments of one line, from the first on.
static void balls_make(roots_skin* skin, int first)
{
    float widest = 0.0f;
    for (int i = first; i < skin->segment_count; i++)
    {
        const roots_segment* s = &skin->segments[i];
        float wide = ty_max(s->ra, s->ra + s->rd), fill = ty_max(s->fill_a, s->fill_a + s->fill_d);
        float reach = 0.5f * ty_length(s->d) + wide + fill + 1e-3f * skin->step;
        skin->balls[i] = (roots_ball){.p = ty_mad(s->a, s->d, 0.5f), .r = reach, .line = s->line};
        widest = ty_max(widest, wide);
    }
    for (int i = first; i < skin->segment_count; i++)
        skin->balls[i].spread = skin->recipe->join * widest + skin->step;
}

static bool segments_make(roots_skin* skin)
{
    const roots_network* net = skin->network;
    skin->segments = TY_TRY_ALLOC(roots_segment, net->point_count);
    skin->balls = TY_TRY_ALLOC(roots_ball, net->point_count);
    if (!skin->segments || !skin->balls)
        return false;
    for (int line = 0; line < net->line_count; line++)
    {
        resting ra, rb = resting_at(skin, &net->points[net->lines[line].first]);
        int first = skin->segment_count;
        for (int i = 0; i + 1 < net->lines[line].count; i++)
        {
            int point = net->lines[line].first + i;
            const roots_point *a = &net->points[point], *b = a + 1;
            roots_segment* s = &skin->segments[skin->segment_count++];
            ra = rb;
            rb = resting_at(skin, b);
            *s = segment_make(a, b, ra, rb, line, point);
            s->open_a = open_at(net, &net->lines[line], a);
            s->open_d = open_at(net, &net->lines[line], b) - s->open_a;
        }
        balls_make(skin, first);
    }
    return true;
}

static ty_bounds segment_bounds(const roots_skin* skin, const roots_segment* s)
{
    const ty_roots_recipe* recipe = skin->recipe;
    float r = ty_max(s->ra, s->ra + s->rd);
    float reach = r * (1.0f + ROOTS_RELIEF_MOST * recipe->bark + recipe->join) + 3.0f * skin->step;
    reach += ty_max(s->fill_a, s->fill_a + s->fill_d);
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
    ty_free(skin->balls);
    ty_free(skin->begin);
    ty_free(skin->list);
    ty_free(skin->active);
    ty_free(skin);
}

// --- the mesh ---

typedef struct raising
{
    const roots_skin* skin;
    ty_mesh* mesh;
} raising;

// No vertex goes deeper than it may.
static ty_vec3 vertex_hold(void* context, ty_vec3 p)
{
    const roots_skin* skin = context;
    for (int i = 0; i < 3; i++) // it may come to another root
    {
        ty_vec3 was = p;
        roots_sample sample = roots_skin_at(skin, p);
        if (sample.segment >= 0)
            roots_skin_keep(skin, sample, &p);
        if (memcmp(&was, &p, sizeof p) == 0)
            break;
    }
    return p;
}

// Between the grid's nodes the net knows the field in part, of roots hardly wider than a cell least: each vertex goes
// to the zero of the roots themselves, some parts of a cell, and out by the relief of the bark, and not too deep.
static void vertices_raise(void* context, int64_t begin, int64_t end, int worker)
{
    const raising* r = context;
    float most = 0.2f * r->skin->step, near = 0.1f * most;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        ty_vec3 *p = &r->mesh->positions[v], n;
        float relief;
        roots_sample sample = roots_skin_look(r->skin, *p, &n, near, &relief);
        for (int i = 0; i < 4 && sample.segment >= 0 && fabsf(sample.distance) > near; i++)
        {
            *p = ty_mad(*p, n, -ty_clamp(sample.distance, -most, most));
            sample = roots_skin_look(r->skin, *p, &n, i < 3 ? near : TY_FLOAT_MAX, &relief);
        }
        if (sample.segment < 0)
            continue;
        *p = vertex_hold((void*)r->skin, ty_mad(*p, n, relief - ty_clamp(sample.distance, -most, most)));
    }
}

// --- the underside ---

// What the triangles about each vertex face, of any length.
static ty_vec3* faces_sum(const ty_mesh* mesh)
{
    ty_vec3* out = TY_TRY_ALLOC(ty_vec3, mesh->vertex_count);
    for (uint32_t t = 0; out && t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        ty_vec3 p = mesh->positions[c[0]];
        ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
        for (int k = 0; k < 3; k++)
            out[c[k]] = ty_add(out[c[k]], n);
    }
    return out;
}

typedef struct seating
{
    const roots_skin* skin;
    ty_mesh* mesh;
    const ty_vec3* faces;
} seating;

// Roots hardly wider than a cell may have no vertices but those on their flanks: what faces the host from a little way
// above it goes down into it.
static void vertices_seat(void* context, int64_t begin, int64_t end, int worker)
{
    const seating* s = context;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        ty_vec3 *p = &s->mesh->positions[v], up, face = s->faces[v];
        float height = roots_host_value(s->skin->host, *p, &up), along = ty_dot(up, face);
        if (height < 0.0f || along > -0.7f * ty_length(up) * ty_length(face))
            continue;
        roots_sample sample = roots_skin_at(s->skin, *p);
        if (sample.segment < 0)
            continue;
        roots_point own = roots_skin_point(s->skin, sample);
        if (own.sink > 0.0f && height < FILL_MOST * own.r && ty_dot(ty_sub(*p, own.p), own.n) < 0.0f)
            *p = vertex_hold((void*)s->skin, ty_mad(*p, ty_normalize(up), -height - 0.5f * own.sink * own.r));
    }
}

static ty_status surface_seat(const roots_skin* skin, ty_mesh* mesh, ty_workers* workers, ty_error* error)
{
    if (!skin->host)
        return TY_OK;
    seating s = {skin, mesh, faces_sum(mesh)};
    if (!s.faces)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %u vertices of roots", mesh->vertex_count);
    ty_parallel_all(workers, mesh->vertex_count, 1024, vertices_seat, &s);
    ty_free((void*)s.faces);
    return TY_OK;
}

// --- all of it ---

typedef struct sorting
{
    const roots_skin* skin;
    uint8_t* kinds;  // roots_block, [active_count]
    int32_t* blocks; // [active_count] those that are mixed, then those inside
    int mixed, solid;
} sorting;

static void blocks_look(void* context, int64_t begin, int64_t end, int worker)
{
    const sorting* s = context;
    (void)worker;
    for (int64_t i = begin; i < end; i++)
        s->kinds[i] = (uint8_t)roots_skin_block(s->skin, s->skin->active[i]);
}

// What lies inside of thick roots, or only in reach of roots that run together, is not stored.
static bool blocks_sort(sorting* s, ty_workers* workers)
{
    int count = s->skin->active_count;
    s->kinds = TY_TRY_ALLOC(uint8_t, count);
    s->blocks = TY_TRY_ALLOC(int32_t, count);
    if (!s->kinds || !s->blocks)
        return false;
    ty_parallel_all(workers, count, 256, blocks_look, s);
    for (int i = 0; i < count; i++)
        if (s->kinds[i] == ROOTS_BLOCK_MIXED)
            s->blocks[s->mixed++] = s->skin->active[i];
    for (int i = 0; i < count; i++)
        if (s->kinds[i] == ROOTS_BLOCK_INSIDE)
            s->blocks[s->mixed + s->solid++] = s->skin->active[i];
    return true;
}

static ty_status surface_find(const roots_skin* skin, ty_workers* workers, ty_mesh** out, ty_net_pieces* pieces,
                              ty_error* error)
{
    enum
    {
        RELAX = 8, // rounds
    };
    sorting sorted = {skin, NULL, NULL, 0, 0};
    if (!blocks_sort(&sorted, workers))
    {
        ty_free(sorted.kinds);
        ty_free(sorted.blocks);
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a surface of %d blocks", skin->active_count);
    }
    ty_net_def def = {.origin = skin->origin,
                      .step = skin->step,
                      .blocks = {skin->blocks[0], skin->blocks[1], skin->blocks[2]},
                      .active = sorted.blocks,
                      .active_count = sorted.mixed,
                      .solid = sorted.blocks + sorted.mixed,
                      .solid_count = sorted.solid,
                      .fill = roots_skin_fill,
                      .context = (void*)skin};
    ty_net* net;
    double start = ty_time_now();
    ty_status status = ty_net_create(&def, workers, &net, error);
    ty_free(sorted.kinds);
    ty_free(sorted.blocks);
    if (status != TY_OK)
        return status;
    double cut = ty_time_now();
    status = ty_net_relax(net, RELAX, workers)
                 ? ty_net_mesh(net, out, pieces, error)
                 : ty_error_set(error, TY_INTERRUPTED, "interrupted while the surface of roots was made");
    ty_net_destroy(net);
    ty_log(TY_LOG_DEBUG, "roots: surface found in %.2f s, relaxed in %.2f s; %d shells, %d voids", cut - start,
           ty_time_now() - cut, pieces->shells, pieces->voids);
    return status;
}

ty_status roots_skin_mesh(const roots_skin* skin, ty_workers* workers, ty_mesh** out, ty_error* error)
{
    const float corner = ty_radians(20.0f);
    ty_net_pieces pieces = {0};
    *out = NULL;
    ty_status status = surface_find(skin, workers, out, &pieces, error);
    if (status != TY_OK)
        return status;
    raising r = {skin, *out};
    double start = ty_time_now();
    if (!ty_parallel_for(workers, (*out)->vertex_count, 1024, vertices_raise, &r))
        status = ty_error_set(error, TY_INTERRUPTED, "interrupted while the surface of roots was made");
    if (status == TY_OK)
        status = surface_seat(skin, *out, workers, error);
    double raised = ty_time_now();
    if (status == TY_OK)
        status = ty_mesh_mend_corners(*out, corner, vertex_hold, (void*)skin, NULL, error);
    ty_log(TY_LOG_DEBUG, "roots: bark raised in %.2f s, corners mended in %.2f s", raised - start,
           ty_time_now() - raised);
    if (status != TY_OK)
    {
        ty_mesh_destroy(*out);
        *out = NULL;
    }
    return status;
}
