// SPDX-License-Identifier: Apache-2.0
// Where an event is: the signed distance of its shape from each cell, to a share of the cell.
#include "fill_run.h"
#include <tsuya/base/memory.h>
#include <tsuya/base/noise.h>

typedef struct shape
{
    const ty_fill_event* event;
    ty_vec2 center;
    float radius, sine, cosine;
    float length; // of a brush's stroke so far
} shape;

static float length2(float x, float y)
{
    return sqrtf(x * x + y * y);
}

static float box_distance(const shape* s, float x, float y)
{
    float px = x - s->center.x, py = y - s->center.y;
    float dx = fabsf(s->cosine * px + s->sine * py) - 0.5f * s->event->size[0];
    float dy = fabsf(s->cosine * py - s->sine * px) - 0.5f * s->event->size[1];
    float out = length2(ty_max(dx, 0.0f), ty_max(dy, 0.0f));
    return out + ty_min(ty_max(dx, dy), 0.0f);
}

static float segment_distance(ty_vec2 a, ty_vec2 b, float x, float y, float most)
{
    float ex = b.x - a.x, ey = b.y - a.y, square = ex * ex + ey * ey;
    float t = square > 0.0f ? ((x - a.x) * ex + (y - a.y) * ey) / square : 0.0f;
    t = ty_clamp(t, 0.0f, ty_min(1.0f, most));
    return length2(x - a.x - t * ex, y - a.y - t * ey);
}

static float polygon_distance(const shape* s, float x, float y)
{
    const ty_vec2* p = s->event->points.items;
    int n = s->event->points.count;
    float nearest = TY_FLOAT_MAX;
    bool inside = false;
    for (int i = 0, j = n - 1; i < n; j = i++)
    {
        nearest = ty_min(nearest, segment_distance(p[j], p[i], x, y, 1.0f));
        if ((p[i].y > y) != (p[j].y > y) && x < (p[j].x - p[i].x) * (y - p[i].y) / (p[j].y - p[i].y) + p[i].x)
            inside = !inside;
    }
    return inside ? -nearest : nearest;
}

static float brush_distance(const shape* s, float x, float y)
{
    const ty_vec2* p = s->event->points.items;
    float left = s->length, nearest = length2(x - p[0].x, y - p[0].y);
    for (int i = 1; i < s->event->points.count && left > 0.0f; i++)
    {
        float length = length2(p[i].x - p[i - 1].x, p[i].y - p[i - 1].y);
        if (length > 0.0f)
            nearest = ty_min(nearest, segment_distance(p[i - 1], p[i], x, y, left / length));
        left -= length;
    }
    return nearest - s->radius;
}

static float shape_distance(const shape* s, float x, float y)
{
    switch (s->event->shape)
    {
    case TY_FILL_CIRCLE:
        return length2(x - s->center.x, y - s->center.y) - s->radius;
    case TY_FILL_RECTANGLE:
        return box_distance(s, x, y);
    case TY_FILL_POLYGON:
        return polygon_distance(s, x, y);
    case TY_FILL_BRUSH:
        return brush_distance(s, x, y);
    default:
        return -TY_FLOAT_MAX; // all of it
    }
}

// The nearest of the shape's images over the edges that wrap.
static float wrapped_distance(const fill_run* run, const shape* s, float x, float y)
{
    int reach_x = run->wrap_x ? 1 : 0, reach_y = run->wrap_y ? 1 : 0;
    float nearest = TY_FLOAT_MAX;
    for (int j = -reach_y; j <= reach_y; j++)
        for (int i = -reach_x; i <= reach_x; i++)
            nearest = ty_min(nearest, shape_distance(s, x + (float)(i * run->width), y + (float)(j * run->height)));
    return nearest;
}

// How the shape is at that frame of at..until.
static shape shape_at(const ty_fill_event* e, int frame)
{
    float t = e->until > e->at ? (float)(frame - e->at) / (float)(e->until - e->at) : 0.0f;
    shape s = {.event = e, .center = {e->center[0], e->center[1]}, .radius = e->radius};
    if (e->to[0] >= 0.0f || e->to[1] >= 0.0f)
        s.center = (ty_vec2){ty_lerp(e->center[0], e->to[0], t), ty_lerp(e->center[1], e->to[1], t)};
    if (e->radius_to >= 0.0f)
        s.radius = ty_lerp(e->radius, e->radius_to, t);
    ty_sincos(e->angle, &s.sine, &s.cosine);
    const ty_vec2* p = e->points.items;
    for (int i = 1; i < e->points.count; i++)
        s.length += length2(p[i].x - p[i - 1].x, p[i].y - p[i - 1].y);
    s.length = e->until > e->at ? t * s.length : 2.0f * s.length + 1.0f; // all of it, whatever was rounded
    return s;
}

static float share(float distance, float feather)
{
    if (feather > 0.0f)
        return ty_clamp(0.5f - distance / feather, 0.0f, 1.0f);
    return distance < 0.0f ? 1.0f : 0.0f;
}

// Inside or not, cell by cell; with a soft edge the distance from the other kind.
static ty_status image_cover(const fill_run* run, int event, int frame, ty_error* error)
{
    float* mask;
    const ty_fill_event* e = (const ty_fill_event*)run->recipe->events.items + event;
    ty_status status = fill_mask_read(run, &run->events[event], e->channel, frame, &mask, error);
    if (status != TY_OK)
        return status;
    size_t cells = fill_cells(run);
    for (size_t i = 0; i < cells; i++)
        run->cover[i] = mask[i] >= e->threshold ? 1.0f : 0.0f;
    for (int side = 0; side < 2 && e->feather > 0.0f; side++)
    {
        for (size_t i = 0; i < cells; i++)
        {
            bool there = (mask[i] >= e->threshold) == (side == 0);
            run->near_x[i] = there ? (float)(i % (size_t)run->width) : NAN;
            run->near_y[i] = there ? (float)(i / (size_t)run->width) : NAN;
        }
        fill_nearest(run);
        for (size_t i = 0; i < cells; i++)
        {
            float d = length2(run->near_x[i] - (float)(i % (size_t)run->width),
                              run->near_y[i] - (float)(i / (size_t)run->width));
            if (d > 0.0f)
                run->cover[i] = share(side == 0 ? d - 0.5f : 0.5f - d, e->feather);
        }
    }
    ty_free(mask);
    return TY_OK;
}

static float roughness(const ty_fill_seeding* seeding, float x, float y)
{
    enum
    {
        BUMP = 7 // cells from one to the next
    };
    uint32_t seed = ty_mix32((uint32_t)seeding->seed.value);
    return seeding->rough * 1.5f * ty_value_noise((ty_vec3){x / BUMP, y / BUMP, 0.5f}, seed);
}

typedef struct covering
{
    const fill_run* run;
    const shape* shape;
    const ty_fill_seeding* seeding; // whose outlines are rough; NULL = none
    float feather;
} covering;

static void rows_cover(void* context, int64_t begin, int64_t end, int worker)
{
    const covering* c = context;
    const fill_run* run = c->run;
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < run->width; x++)
        {
            float px = (float)x + 0.5f, py = (float)y + 0.5f, d = wrapped_distance(run, c->shape, px, py);
            if (c->seeding)
                d += roughness(c->seeding, px, py);
            run->cover[fill_cell(run, x, y)] = share(d, c->feather);
        }
}

ty_status fill_shape_cover(const fill_run* run, int event, int frame, ty_error* error)
{
    const ty_fill_event* e = (const ty_fill_event*)run->recipe->events.items + event;
    ty_status status = TY_OK;
    int mark = e->mark ? fill_mark_find(run, e->mark, "events", error) : 0;
    const ty_fill_seeding* seeding = &run->marks[mark < 0 ? 0 : mark].seed;
    bool rough = e->mark && seeding->rough > 0.0f && e->shape != TY_FILL_ALL;
    // What u and v are set to covers cells at an outline by their shares, else frames would show stairs.
    bool blends = e->op == TY_FILL_HOLE || e->op == TY_FILL_FILL;
    shape s = shape_at(e, frame);
    covering c = {run, &s, rough ? seeding : NULL, e->feather == 0.0f && blends ? 1.0f : e->feather};
    if (e->shape == TY_FILL_IMAGE)
        status = image_cover(run, event, frame, error);
    else
        ty_parallel_all(run->workers, run->height, 16, rows_cover, &c);
    for (size_t i = 0; e->invert && status == TY_OK && i < fill_cells(run); i++)
        run->cover[i] = 1.0f - run->cover[i];
    return status;
}
