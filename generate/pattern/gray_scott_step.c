// SPDX-License-Identifier: Apache-2.0
// Gray–Scott in time, a row after the other: one operation order, no FMA.
#include "gray_scott_field.h"
#include <string.h>

enum
{
    PIECE_CELLS = 32768 // of a range: less is not worth waking a thread
};

// Rows beyond the edge are those of the far side, or copies of the edge.
static int row_near(const ty_gray_scott* field, int y)
{
    int h = field->def.height;
    if (field->def.wrap_y)
        return y < 0 ? y + h : y >= h ? y - h : y;
    return y < 0 ? 0 : y >= h ? h - 1 : y;
}

static void edges_copy(const ty_gray_scott* field, float* row)
{
    int w = field->def.width;
    row[-1] = row[field->def.wrap_x ? w - 1 : 0];
    row[w] = row[field->def.wrap_x ? 0 : w - 1];
}

static void edges_fill(ty_gray_scott* field)
{
    int w = field->def.width, h = field->def.height;
    for (int y = 0; y < h; y++)
    {
        edges_copy(field, field->front.u + gs_cell(field, y));
        edges_copy(field, field->front.v + gs_cell(field, y));
        uint8_t* marks = ty_gray_scott_marks(field, y);
        marks[-1] = marks[field->def.wrap_x ? w - 1 : 0];
        marks[w] = marks[field->def.wrap_x ? 0 : w - 1];
    }
    for (int y = -1; y <= h; y += h + 1)
        memcpy(ty_gray_scott_marks(field, y) - 1, ty_gray_scott_marks(field, row_near(field, y)) - 1, (size_t)w + 2);
}

typedef struct around
{
    const float *up, *at, *down;
    const uint8_t *marks_up, *marks_at, *marks_down;
} around;

static bool closed(uint8_t mark)
{
    return (mark & TY_GRAY_SCOTT_BARRIER) != 0;
}

// What is behind a barrier is as the cell itself. A corner is closed too where both of its edges are.
static void sums(const around* a, int x, float* edges, float* corners)
{
    float c = a->at[x];
    bool up = closed(a->marks_up[x]), down = closed(a->marks_down[x]);
    bool left = closed(a->marks_at[x - 1]), right = closed(a->marks_at[x + 1]);
    *edges = ((up ? c : a->up[x]) + (left ? c : a->at[x - 1])) + ((right ? c : a->at[x + 1]) + (down ? c : a->down[x]));
    float up_left = closed(a->marks_up[x - 1]) || (up && left) ? c : a->up[x - 1];
    float up_right = closed(a->marks_up[x + 1]) || (up && right) ? c : a->up[x + 1];
    float down_left = closed(a->marks_down[x - 1]) || (down && left) ? c : a->down[x - 1];
    float down_right = closed(a->marks_down[x + 1]) || (down && right) ? c : a->down[x + 1];
    *corners = (up_left + down_left) + (up_right + down_right);
}

static void row_step(const ty_gray_scott* field, int y)
{
    const gs_rates* r = &field->rates;
    size_t at = gs_cell(field, y), up = gs_cell(field, row_near(field, y - 1)),
           down = gs_cell(field, row_near(field, y + 1));
    const uint8_t* marks = field->marks + gs_cell(field, y + 1);
    const around u = {field->front.u + up,  field->front.u + at, field->front.u + down, marks - field->stride, marks,
                      marks + field->stride};
    const around v = {field->front.v + up,  field->front.v + at, field->front.v + down, marks - field->stride, marks,
                      marks + field->stride};
    float *out_u = field->back.u + at, *out_v = field->back.v + at;
    for (int x = 0; x < field->def.width; x++)
    {
        int mark = marks[x] % TY_GRAY_SCOTT_MARKS;
        float a = u.at[x], b = v.at[x], edges_u, corners_u, edges_v, corners_v;
        float feed = r->feed[mark] + (field->feed ? field->feed[at + (size_t)x] : 0.0f);
        float kill = r->kill[mark] + (field->kill ? field->kill[at + (size_t)x] : 0.0f);
        sums(&u, x, &edges_u, &corners_u);
        sums(&v, x, &edges_v, &corners_v);
        float near_u = r->edge_u * edges_u, near_v = r->edge_v * edges_v;
        if (field->def.stencil == 9)
        {
            near_u += r->corner_u * corners_u;
            near_v += r->corner_v * corners_v;
        }
        float reaction = r->time_step * (a * b * b);
        out_u[x] = closed(marks[x]) ? a : (((r->base_u - feed) * a + near_u) + feed) - reaction;
        out_v[x] = closed(marks[x]) ? b : ((r->base_v - (feed + kill)) * b + near_v) + reaction;
    }
    edges_copy(field, out_u);
    edges_copy(field, out_v);
}

static void rows_step(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    for (int y = (int)begin; y < (int)end; y++)
        row_step(context, y);
}

void ty_gray_scott_step(ty_gray_scott* field, int step_count, ty_workers* workers)
{
    edges_fill(field); // cells may have been set from outside
    int64_t rows = PIECE_CELLS / field->def.width + 1;
    for (int i = 0; i < step_count; i++)
    {
        if (!ty_parallel_for(workers, field->def.height, rows, rows_step, field))
            return;
        gs_planes done = field->back;
        field->back = field->front;
        field->front = done;
    }
}
