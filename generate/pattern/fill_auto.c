// SPDX-License-Identifier: Apache-2.0
// Marks that follow the pattern and count for feed and kill.
#include "fill_run.h"

bool fill_needs_distance(const fill_run* run)
{
    const ty_fill_auto* autos = run->recipe->autos.items;
    bool band = run->outputs.distance;
    for (int i = 0; i < run->recipe->autos.count; i++)
        band = band || autos[i].where == TY_FILL_WHERE_BAND;
    return band;
}

static bool is_there(const fill_run* run, const ty_fill_auto* a, size_t at, float v, float distance)
{
    switch (a->where)
    {
    case TY_FILL_WHERE_HOLE:
        return v < run->level;
    case TY_FILL_WHERE_FILLED:
        return v >= run->level;
    case TY_FILL_WHERE_BAND:
        return distance >= a->reach[0] && distance < a->reach[1];
    default:
        return run->trail[at] >= 0.0f;
    }
}

static void rule_apply(fill_run* run, const ty_fill_auto* a, int mark, int over)
{
    for (int y = 0; y < run->height; y++)
    {
        uint8_t* marks = ty_gray_scott_marks(run->field, y);
        const float* v = ty_gray_scott_v(run->field, y);
        for (int x = 0; x < run->width; x++)
        {
            size_t at = fill_cell(run, x, y);
            if ((over < 0 || fill_mark_of(marks[x]) == over) &&
                is_there(run, a, at, v[x], run->distance ? run->distance[at] : 0.0f))
                marks[x] = (uint8_t)((marks[x] & TY_GRAY_SCOTT_BARRIER) | mark);
        }
    }
}

ty_status fill_auto_mark(fill_run* run, ty_error* error)
{
    const ty_fill_auto* autos = run->recipe->autos.items;
    bool any = false;
    for (int i = 0; i < run->recipe->autos.count; i++)
        if (autos[i].rates)
        {
            any = true;
            rule_apply(run, &autos[i], fill_mark_find(run, autos[i].mark, "auto", error),
                       autos[i].over ? fill_mark_find(run, autos[i].over, "auto", error) : -1);
        }
    return any ? fill_vary(run, error) : TY_OK;
}
