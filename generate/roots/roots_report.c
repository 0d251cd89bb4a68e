// SPDX-License-Identifier: Apache-2.0
// Figures of roots: what was asked for and what grew, how the mesh holds on to its host, and how well it is made.
#include "roots_output.h"
#include <stdlib.h>

enum
{
    BINS = 18000,  // of angles, 0.01 degrees each
    PLACES = 8192, // on the host, of its coverage
};

static const char* const kind_names[ROOTS_KINDS] = {"trunk", "main", "aerial", "first", "second", "fine"};

// --- angles ---

// How many angles fall into each hundredth of a degree.
typedef struct angles
{
    uint32_t bins[BINS];
    uint64_t count;
    float least; // degrees
} angles;

static void angle_add(angles* a, ty_vec3 u, ty_vec3 v)
{
    float angle = ty_atan2(ty_length(ty_cross(u, v)), ty_dot(u, v)) * (180.0f * TY_INV_PI);
    int bin = (int)(angle * (BINS / 180.0f));
    a->bins[bin < BINS ? bin : BINS - 1]++;
    a->least = a->count == 0 ? angle : ty_min(a->least, angle);
    a->count++;
}

static double angle_below(const angles* a, double share)
{
    uint64_t sum = 0, wanted = (uint64_t)(share * (double)a->count);
    int bin = 0;
    while (bin < BINS - 1 && (sum += a->bins[bin]) <= wanted)
        bin++;
    return bin * (180.0 / BINS);
}

static void corners_count(const ty_mesh* mesh, angles* out)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++)
        {
            const uint32_t* c = mesh->triangles[t];
            ty_vec3 p = mesh->positions[c[k]];
            angle_add(out, ty_sub(mesh->positions[c[(k + 1) % 3]], p), ty_sub(mesh->positions[c[(k + 2) % 3]], p));
        }
}

static void bends_count(const roots_network* net, angles* out)
{
    for (int l = 0; l < net->line_count; l++)
        for (int i = net->lines[l].first + 1; i + 1 < net->lines[l].first + net->lines[l].count; i++)
        {
            ty_vec3 p = net->points[i].p;
            angle_add(out, ty_sub(net->points[i - 1].p, p), ty_sub(net->points[i + 1].p, p));
        }
}

// --- against the host ---

typedef struct touch
{
    const roots_result* result;
    const float *radius, *sink;
    float* height; // [vertex_count] over the host, of the radius; TY_FLOAT_MAX where it is far
    bool* facing;  // [vertex_count] it lies on the attached side
} touch;

static void heights_measure(void* context, int64_t begin, int64_t end, int worker)
{
    const touch* t = context;
    const ty_mesh* mesh = t->result->mesh;
    (void)worker;
    for (int64_t v = begin; v < end; v++)
    {
        ty_vec3 n;
        float r = t->radius[v], about = roots_host_value(t->result->host, mesh->positions[v], NULL);
        t->height[v] = TY_FLOAT_MAX;
        if (about > 2.0f * r + 2.0f * t->result->host->field.step)
            continue;
        t->height[v] = roots_host_exact(t->result->host, mesh->positions[v], 4.0f * r, &n) / r;
        t->facing[v] = t->sink[v] > 0.0f && ty_dot(n, mesh->normals[v]) < -0.9f;
    }
}

static int floats_compare(const void* a, const void* b)
{
    float x = *(const float*)a, y = *(const float*)b;
    return x < y ? -1 : x > y;
}

static double heights_below(float* values, uint32_t count, double share)
{
    if (count == 0)
        return 0.0;
    qsort(values, count, sizeof *values, floats_compare);
    return (double)values[(uint32_t)(share * (double)(count - 1))];
}

static void put_touch(const roots_result* result, ty_workers* workers, ty_sink* out)
{
    const ty_mesh* mesh = result->mesh;
    touch t = {.result = result,
               .radius = ty_mesh_find_attribute(mesh, "radius")->values,
               .sink = ty_mesh_find_attribute(mesh, "sink")->values,
               .height = TY_ALLOC(float, mesh->vertex_count),
               .facing = TY_ALLOC(bool, mesh->vertex_count)};
    float deepest = 0.0f, over = -TY_FLOAT_MAX;
    uint32_t count = 0;
    ty_parallel_all(workers, mesh->vertex_count, 1024, heights_measure, &t);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        deepest = ty_max(deepest, -t.height[v]);
        over = ty_max(over, -t.height[v] - t.sink[v]);
        if (t.facing[v])
            t.height[count++] = ty_max(t.height[v], 0.0f);
    }
    ty_sink_format(out, ", \"deepest\": %.4f, \"deeper_than_sink\": %.4f, \"gap_p99\": %.4f", (double)deepest,
                   (double)over, heights_below(t.height, count, 0.99));
    ty_free(t.height);
    ty_free(t.facing);
}

// Share of the host's surface that lies under roots: places spread evenly over its area.
static double coverage(const roots_result* result)
{
    const ty_mesh* host = result->host->mesh;
    double area = 0.0, sum = 0.0;
    int covered = 0, place = 0;
    for (uint32_t t = 0; t < 2 * host->triangle_count; t++) // once for the area, once for the places
    {
        const uint32_t* c = host->triangles[t % host->triangle_count];
        ty_vec3 a = host->positions[c[0]], u = ty_sub(host->positions[c[1]], a), v = ty_sub(host->positions[c[2]], a);
        double own = 0.5 * (double)ty_length(ty_cross(u, v));
        if (t < host->triangle_count)
        {
            area += own;
            continue;
        }
        for (sum += own; place < PLACES && (place + 0.5) * area < sum * PLACES; place++)
        {
            float x = 0.75487766f * (float)(place % 4096), y = 0.56984029f * (float)(place % 4096);
            x -= floorf(x);
            y -= floorf(y);
            if (x + y > 1.0f)
            {
                x = 1.0f - x;
                y = 1.0f - y;
            }
            roots_sample sample = roots_skin_at(result->skin, ty_mad(ty_mad(a, u, x), v, y));
            covered += sample.segment >= 0 && sample.distance < 0.0f;
        }
    }
    return (double)covered / PLACES;
}

// --- the whole ---

static int root_of(int* above, int line)
{
    while (above[line] != line)
        line = above[line] = above[above[line]];
    return line;
}

// Parts of the network that nothing joins.
static int parts_count(const roots_network* net)
{
    int* above = TY_ALLOC(int, net->line_count);
    int parts = net->line_count;
    for (int i = 0; i < net->line_count; i++)
        above[i] = i;
    for (int i = 0; i < net->line_count; i++)
    {
        const int others[2] = {net->lines[i].parent, net->lines[i].end};
        for (int k = 0; k < 2; k++)
        {
            if (others[k] < 0)
                continue;
            int a = root_of(above, i), b = root_of(above, others[k]);
            parts -= a != b;
            above[a] = b;
        }
    }
    ty_free(above);
    return parts;
}

static void put_angles(const roots_result* result, ty_sink* out)
{
    angles* a = TY_ALLOC(angles, 2);
    corners_count(result->mesh, &a[0]);
    bends_count(result->network, &a[1]);
    ty_sink_format(out, ",\n \"corner_least\": %.2f, \"corner_p01\": %.2f, \"bend_least\": %.2f, \"bend_p1\": %.2f",
                   (double)a[0].least, angle_below(&a[0], 0.001), (double)a[1].least, angle_below(&a[1], 0.01));
    ty_free(a);
}

char* roots_report(const roots_result* result, ty_workers* workers)
{
    const roots_network* net = result->network;
    const ty_mesh* mesh = result->mesh;
    ty_sink out = {0};
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    ty_sink_format(&out, "{\"roots\": {");
    for (int k = 0, any = 0; k < ROOTS_KINDS; k++)
        if (net->requested[k] > 0 || net->grown[k] > 0)
            ty_sink_format(&out, "%s\"%s\": {\"requested\": %d, \"grown\": %d}", any++ ? ", " : "", kind_names[k],
                           net->requested[k], net->grown[k]);
    ty_sink_format(&out, "},\n \"lines\": %d, \"points\": %d, \"parts\": %d", net->line_count, net->point_count,
                   parts_count(net));
    put_touch(result, workers, &out);
    if (result->skin)
        ty_sink_format(&out, ", \"coverage\": %.4f", coverage(result));
    put_angles(result, &out);
    roots_compare(result, workers, &out);
    ty_sink_format(&out,
                   ",\n \"vertices\": %u, \"triangles\": %u, \"shells\": %u, \"closed\": %s, \"boundary_edges\": %u, "
                   "\"nonmanifold_edges\": %u, \"area\": %.6g, \"volume\": %.6g",
                   topology.welded_vertices, mesh->triangle_count, topology.components,
                   topology.closed ? "true" : "false", topology.boundary_edges, topology.nonmanifold_edges,
                   topology.area, topology.volume);
    ty_sink_format(&out, ",\n \"seconds\": {\"host\": %.3f, \"grow\": %.3f, \"surface\": %.3f}}\n",
                   result->host_seconds, result->grow_seconds, result->surface_seconds);
    ty_sink_put(&out, "", 1);
    return (char*)out.bytes;
}
