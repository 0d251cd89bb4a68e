// SPDX-License-Identifier: Apache-2.0
// The shortest way over the nodes of a grid that lie near the host's surface: A* (Hart, Nilsson and Raphael 1968).
#include "roots_growth.h"

enum
{
    MOST_NODES = 1 << 14,
    TABLE = 1 << 15,
};

typedef struct node
{
    int at[3];
    int from;       // node, -1 = the first
    float way, sum; // m, so far, and with what is left at least
    bool done;
} node;

typedef struct geodesic
{
    const roots_host* host;
    ty_vec3 origin, goal;
    float step, height;
    node* nodes;
    int count;
    int* table; // nodes by hash, -1 = none
    int* heap;  // by sum; a node may stand in it more than once
    int heap_count, heap_capacity;
} geodesic;

static ty_vec3 place(const geodesic* g, const int at[3])
{
    return ty_mad(g->origin, ty_vec3_make((float)at[0], (float)at[1], (float)at[2]), g->step);
}

static void heap_push(geodesic* g, int n)
{
    if (g->heap_count == g->heap_capacity)
    {
        int capacity = 2 * g->heap_capacity;
        g->heap = ty_grow(g->heap, (size_t)g->heap_capacity, (size_t)capacity, sizeof(int));
        g->heap_capacity = capacity;
    }
    int i = g->heap_count++;
    while (i > 0 && g->nodes[g->heap[(i - 1) / 2]].sum > g->nodes[n].sum)
    {
        g->heap[i] = g->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    g->heap[i] = n;
}

static int heap_pop(geodesic* g)
{
    int top = g->heap[0], last = g->heap[--g->heap_count], i = 0;
    for (;;)
    {
        int child = 2 * i + 1;
        if (child >= g->heap_count)
            break;
        child += child + 1 < g->heap_count && g->nodes[g->heap[child + 1]].sum < g->nodes[g->heap[child]].sum;
        if (g->nodes[last].sum <= g->nodes[g->heap[child]].sum)
            break;
        g->heap[i] = g->heap[child];
        i = child;
    }
    g->heap[i] = last;
    return top;
}

// The slot where the node stands or belongs.
static int slot_of(const geodesic* g, const int at[3])
{
    uint32_t h = ty_mix32((uint32_t)at[0] * 73856093u ^ (uint32_t)at[1] * 19349663u ^ (uint32_t)at[2] * 83492791u);
    for (h %= TABLE; g->table[h] >= 0; h = (h + 1) % TABLE)
    {
        const int* own = g->nodes[g->table[h]].at;
        if (own[0] == at[0] && own[1] == at[1] && own[2] == at[2])
            break;
    }
    return (int)h;
}

// A shorter way to a node, which is made where it lies near the surface.
static void reach(geodesic* g, const int at[3], int from, float way)
{
    int slot = slot_of(g, at), n = g->table[slot];
    if (n >= 0 && (g->nodes[n].done || g->nodes[n].way <= way))
        return;
    ty_vec3 p = place(g, at);
    float left = ty_length(ty_sub(g->goal, p));
    if (n < 0)
    {
        float off = roots_host_value(g->host, p, NULL) - g->height;
        bool end = from < 0 || left < 1.8f * g->step;
        if (g->count == MOST_NODES || (!end && (off < -0.6f * g->step || off > 1.2f * g->step)))
            return;
        n = g->table[slot] = g->count++;
        g->nodes[n] = (node){{at[0], at[1], at[2]}, from, way, 0.0f, false};
    }
    g->nodes[n].from = from;
    g->nodes[n].way = way;
    g->nodes[n].sum = way + left;
    heap_push(g, n);
}

static void neighbours(geodesic* g, int n, float longest)
{
    for (int c = 0; c < 27; c++)
    {
        const int off[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1}, *own = g->nodes[n].at;
        int at[3] = {own[0] + off[0], own[1] + off[1], own[2] + off[2]};
        float way = g->nodes[n].way + g->step * sqrtf((float)(off[0] * off[0] + off[1] * off[1] + off[2] * off[2]));
        if (c != 13 && way < 1.2f * longest) // steps along axes and diagonals are longer than the way itself
            reach(g, at, n, way);
    }
}

static int way_back(const geodesic* g, int n, ty_vec3 a, ty_vec3 b, ty_vec3* out, int most)
{
    int count = 2;
    for (int i = n; g->nodes[i].from >= 0; i = g->nodes[i].from)
        count++;
    if (count > most)
        return 0;
    out[0] = a;
    out[count - 1] = b;
    for (int i = n, k = count - 2; g->nodes[i].from >= 0; i = g->nodes[i].from)
        out[k--] = place(g, g->nodes[i].at);
    return count;
}

int roots_geodesic(const roots_host* host, ty_vec3 a, ty_vec3 b, float height, float longest, ty_vec3* out, int most)
{
    geodesic g = {.host = host, .origin = a, .goal = b, .height = height, .heap_capacity = 1024};
    g.step = ty_max(ty_length(ty_sub(b, a)) / 32.0f, host->field.step);
    g.nodes = TY_ALLOC(node, MOST_NODES);
    g.table = TY_ALLOC(int, TABLE);
    g.heap = TY_ALLOC(int, g.heap_capacity);
    for (int i = 0; i < TABLE; i++)
        g.table[i] = -1;
    reach(&g, (const int[3]){0, 0, 0}, -1, 0.0f);
    int count = 0;
    while (g.heap_count && !count)
    {
        int n = heap_pop(&g);
        if (g.nodes[n].done)
            continue;
        g.nodes[n].done = true;
        if (ty_length(ty_sub(place(&g, g.nodes[n].at), b)) < 0.9f * g.step)
            count = way_back(&g, n, a, b, out, most);
        else
            neighbours(&g, n, longest);
    }
    ty_free(g.nodes);
    ty_free(g.table);
    ty_free(g.heap);
    return count;
}
