// SPDX-License-Identifier: Apache-2.0
// A hole that closes in so many frames: its radius, the speed of a front with its rates, and from both the steps.
#include "fill_run.h"

enum
{
    LENGTH = 640, // cells of the line that a front runs on
    BEGIN = 160,
    SETTLE = 1500, // of time, before it is measured
    MEASURE = 3000
};

// A disc closes in 72 r where a straight front goes .01456 a unit of time: 1.048 times later than it would.
static const double curved = 72.0 * 0.01456;

static float front_place(ty_gray_scott* field, float level)
{
    const float* v = ty_gray_scott_v(field, 0);
    for (int x = LENGTH - 2; x > 0; x--)
        if (v[x] >= level && v[x + 1] < level)
            return (float)x + (v[x] - level) / (v[x] - v[x + 1]);
    return 0.0f;
}

// Cells a step, of a straight front into what is empty and has those rates.
static ty_status front_speed(const fill_run* run, int mark, double* out, ty_error* error)
{
    ty_gray_scott_def def = run->def;
    ty_gray_scott* field;
    def.width = LENGTH;
    def.height = 8;
    def.wrap_x = false;
    def.rates[0] = run->rates[mark];
    def.rate_count = 1;
    ty_status status = ty_gray_scott_create(&def, &field, error);
    if (status != TY_OK)
        return status;
    for (int y = 0; y < def.height; y++)
        for (int x = 0; x < BEGIN; x++)
        {
            ty_gray_scott_u(field, y)[x] = run->plain[0].x;
            ty_gray_scott_v(field, y)[x] = run->plain[0].y;
        }
    int settle = (int)((float)SETTLE / def.time_step), measure = (int)((float)MEASURE / def.time_step);
    ty_gray_scott_step(field, settle, NULL);
    float begin = front_place(field, run->level);
    ty_gray_scott_step(field, measure, NULL);
    *out = (double)(front_place(field, run->level) - begin) / measure;
    ty_gray_scott_destroy(field);
    return TY_OK;
}

// Of the largest disc that is in the hole, cells.
static ty_status hole_radius(const fill_run* run, int event, double* out, ty_error* error)
{
    const ty_fill_event* e = (const ty_fill_event*)run->recipe->events.items + event;
    ty_status status = fill_shape_cover(run, event, e->at, error);
    double most = 0.0;
    if (status != TY_OK)
        return status;
    for (size_t i = 0; i < fill_cells(run); i++)
    {
        bool filled = run->cover[i] <= 0.5f;
        run->near_x[i] = filled ? (float)(i % (size_t)run->width) : NAN;
        run->near_y[i] = filled ? (float)(i / (size_t)run->width) : NAN;
    }
    fill_nearest(run);
    for (size_t i = 0; i < fill_cells(run); i++)
    {
        double dx = (double)run->near_x[i] - (double)(i % (size_t)run->width);
        double dy = (double)run->near_y[i] - (double)(i / (size_t)run->width), d = sqrt(dx * dx + dy * dy);
        most = d > most ? d : most;
    }
    *out = most + 0.5; // its middle may lie between four cells, .7 from each, the outline half a cell before the next
    return most > 0.0 ? TY_OK : ty_error_set(error, TY_BAD_INPUT, "events[%d].close: the hole holds no cell", event);
}

ty_status fill_solve_steps(fill_run* run, ty_error* error)
{
    const ty_fill_event* events = run->recipe->events.items;
    int found = -1;
    for (int i = 0; i < run->recipe->events.count; i++)
        if (events[i].close > 0 && found >= 0)
            return ty_error_set(error, TY_BAD_INPUT,
                                "events[%d].close: events[%d] tells already how fast time goes; one hole alone can", i,
                                found);
        else if (events[i].close > 0)
            found = i;
    if (found < 0)
        return TY_OK;
    double radius = 0.0, speed = 0.0;
    int mark = events[found].mark ? fill_mark_find(run, events[found].mark, "events", error) : 0;
    if (run->plain[0].y == 0.0f)
        return ty_error_set(error, TY_BAD_INPUT,
                            "events[%d].close: the first mark has no plain state that could close it", found);
    ty_status status = hole_radius(run, found, &radius, error);
    if (status == TY_OK)
        status = front_speed(run, mark, &speed, error);
    if (status == TY_OK && speed < 1e-5)
        return ty_error_set(error, TY_BAD_INPUT, "events[%d].close: with feed %g and kill %g no front moves into it",
                            found, (double)run->rates[mark].feed, (double)run->rates[mark].kill);
    if (status == TY_OK)
        run->steps = curved * radius / speed / events[found].close;
    return status;
}
