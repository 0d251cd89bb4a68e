// SPDX-License-Identifier: Apache-2.0
// Figures of roots from files alone: their mesh, the closed parts of their host, their centre lines. Knows nothing of
// how they were made.
#pragma once
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/trace.h>

typedef struct roots_figures
{
    uint32_t triangles, components, boundary_edges, nonmanifold_edges;
    bool closed;                   // and outward: a single one is a shell and no void
    double corner_least, corner_1; // degrees: the least and that of 0.1 %
    double deepest, deeper;        // under the host, of the radius; against sink
    double gap_99;                 // on the attached side, of the radius
    uint32_t attached;             // vertices there
    double bend_least, bend_1;     // degrees: the least inner angle of centre lines, and that of 1 %
    double join_least, join_1;     // the same where lines meet
    int lines, parts;              // of the network: 1 = all are joined
    int unseen;                    // lines that no vertex belongs to
} roots_figures;

// The host: closed meshes in place, and perhaps a floor.
typedef struct roots_ground
{
    const char* const* paths;
    int count;
    bool has_floor; // at the lowest point
} roots_ground;

static int roots_order(const void* a, const void* b)
{
    double x = *(const double*)a, y = *(const double*)b;
    return x < y ? -1 : x > y;
}

// The value below which that share lies.
static double roots_share(double* values, size_t count, double share)
{
    if (count == 0)
        return 0.0;
    qsort(values, count, sizeof *values, roots_order);
    return values[(size_t)(share * (double)(count - 1))];
}

static double roots_angle(ty_vec3 u, ty_vec3 v)
{
    double x = (double)ty_dot(u, v), y = (double)ty_length(ty_cross(u, v));
    return atan2(y, x) * 180.0 / M_PI;
}

static void roots_measure_shape(const ty_mesh* mesh, roots_figures* out)
{
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    out->triangles = mesh->triangle_count;
    out->components = topology.components;
    out->boundary_edges = topology.boundary_edges;
    out->nonmanifold_edges = topology.nonmanifold_edges;
    out->closed = topology.closed;
    size_t count = 3 * (size_t)mesh->triangle_count;
    double* angles = malloc(count * sizeof *angles);
    for (size_t i = 0; i < count; i++)
    {
        const uint32_t* c = mesh->triangles[i / 3];
        ty_vec3 p = mesh->positions[c[i % 3]];
        angles[i] = roots_angle(ty_sub(mesh->positions[c[(i + 1) % 3]], p), ty_sub(mesh->positions[c[(i + 2) % 3]], p));
    }
    out->corner_1 = roots_share(angles, count, 0.001);
    out->corner_least = angles[0];
    free(angles);
}

// --- against the host ---

typedef struct roots_host_files
{
    ty_world* world;
    uint32_t part[8];
    int count;
    bool has_floor;
    float floor;
} roots_host_files;

static bool roots_host_open(const roots_ground* ground, roots_host_files* out, ty_mesh* meshes[8])
{
    ty_error error;
    ty_world_def def = ty_world_def_default();
    *out = (roots_host_files){.count = ground->count, .has_floor = ground->has_floor, .floor = 1e30f};
    if (ty_world_create(&def, &out->world, &error) != TY_OK)
        return false;
    for (int i = 0; i < ground->count; i++)
    {
        if (ty_mesh_read(ground->paths[i], &meshes[i], &error) != TY_OK ||
            ty_world_add_prototype(out->world, meshes[i], &out->part[i], &error) != TY_OK)
            return false;
        out->floor = fminf(out->floor, meshes[i]->bounds.low.y);
    }
    return ty_world_commit(out->world, &error) == TY_OK;
}

// Height over the host within reach, else reach; *up points away from it.
static float roots_height(const roots_host_files* host, ty_vec3 p, float reach, ty_vec3* up)
{
    float height = reach;
    *up = (ty_vec3){0.0f, 1.0f, 0.0f};
    if (host->has_floor && p.y - host->floor < height)
        height = p.y - host->floor;
    for (int i = 0; i < host->count; i++)
    {
        ty_closest c;
        if (!ty_world_closest(host->world, host->part[i], p, reach, &c))
            continue;
        float side = ty_world_inside(host->world, host->part[i], p) ? -1.0f : 1.0f;
        if (side * c.distance >= height)
            continue;
        height = side * c.distance;
        if (c.distance > 1e-9f)
            *up = ty_mul(ty_sub(p, c.position), side / c.distance);
    }
    return height;
}

// The shell of triangles says where a vertex looks, not the file's normals.
static ty_vec3* roots_normals(const ty_mesh* mesh)
{
    ty_vec3* out = calloc(mesh->vertex_count, sizeof *out);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* c = mesh->triangles[t];
        ty_vec3 p = mesh->positions[c[0]];
        ty_vec3 n = ty_cross(ty_sub(mesh->positions[c[1]], p), ty_sub(mesh->positions[c[2]], p));
        for (int k = 0; k < 3; k++)
            out[mesh->welds[c[k]]] = ty_add(out[mesh->welds[c[k]]], n);
    }
    return out;
}

static bool roots_measure_hold(const ty_mesh* mesh, const roots_host_files* host, roots_figures* out)
{
    const ty_mesh_attribute *radius = ty_mesh_find_attribute(mesh, "radius"),
                            *sink = ty_mesh_find_attribute(mesh, "sink");
    if (!radius || !sink)
        return false;
    double* gaps = malloc(mesh->vertex_count * sizeof *gaps);
    ty_vec3* normals = roots_normals(mesh);
    out->deeper = -1e30;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
    {
        ty_vec3 up;
        if (mesh->welds[v] != v)
            continue;
        float r = radius->values[v], height = roots_height(host, mesh->positions[v], 4.0f * r, &up) / r;
        out->deepest = fmax(out->deepest, (double)-height);
        out->deeper = fmax(out->deeper, (double)(-height - sink->values[v]));
        // of what passes between two parts of the host the side that its turns say is turned to it
        float turn = mesh->uvs[v].x - floorf(mesh->uvs[v].x) - 0.5f;
        if (sink->values[v] > 0.0f && height < 4.0f && fabsf(turn) > 0.25f &&
            ty_dot(up, ty_normalize(normals[v])) < -0.9f)
            gaps[out->attached++] = fmax((double)height, 0.0);
    }
    out->gap_99 = roots_share(gaps, out->attached, 0.99);
    free(gaps);
    free(normals);
    return true;
}

// --- centre lines ---

typedef struct roots_lines
{
    int points, lines;
    ty_vec3* at;
    int *line, *kind, *parent, *end; // of each point; of each line
} roots_lines;

// Only what is written by the program's own `--curves`: columns in that order.
static bool roots_lines_read(const char* path, roots_lines* out)
{
    ty_bytes bytes;
    ty_error error;
    int edges = 0;
    *out = (roots_lines){0};
    if (ty_file_read(path, (size_t)1 << 30, &bytes, &error) != TY_OK)
        return false;
    const char *text = (const char*)bytes.data, *vertex = strstr(text, "element vertex "),
               *edge = strstr(text, "element edge "), *line = strstr(text, "element line "),
               *body = strstr(text, "end_header\n");
    bool good = vertex && edge && line && body && sscanf(vertex, "element vertex %d", &out->points) == 1 &&
                sscanf(edge, "element edge %d", &edges) == 1 && sscanf(line, "element line %d", &out->lines) == 1;
    out->at = calloc((size_t)out->points + 1, sizeof *out->at);
    out->line = calloc((size_t)out->points + 1, sizeof(int));
    out->kind = calloc((size_t)out->lines + 1, sizeof(int));
    out->parent = calloc((size_t)out->lines + 1, sizeof(int));
    out->end = calloc((size_t)out->lines + 1, sizeof(int));
    char* c = good ? (char*)body + strlen("end_header\n") : NULL;
    for (int i = 0; good && i < out->points; i++)
    {
        float values[12];
        for (int k = 0; k < 12; k++)
            values[k] = strtof(c, &c);
        out->at[i] = (ty_vec3){values[0], values[1], values[2]};
        out->line[i] = (int)values[11];
        good = out->line[i] >= 0 && out->line[i] < out->lines;
    }
    for (int i = 0; good && i < 2 * edges; i++)
        (void)strtol(c, &c, 10);
    for (int i = 0; good && i < out->lines; i++)
    {
        out->kind[i] = (int)strtol(c, &c, 10);
        out->parent[i] = (int)strtol(c, &c, 10);
        out->end[i] = (int)strtol(c, &c, 10);
        (void)strtoul(c, &c, 10);
        (void)strtoul(c, &c, 10);
        good = out->parent[i] < out->lines && out->end[i] < out->lines;
    }
    ty_bytes_term(&bytes);
    return good;
}

static void roots_lines_term(roots_lines* lines)
{
    free(lines->at);
    free(lines->line);
    free(lines->kind);
    free(lines->parent);
    free(lines->end);
}

static int roots_part(int* above, int line)
{
    while (above[line] != line)
        line = above[line] = above[above[line]];
    return line;
}

// The straighter way from one end of a line into another, which it reaches at the point nearest to that end.
static double roots_join(const roots_lines* l, int end, int before, int other)
{
    int at = -1;
    double best = 0.0;
    for (int i = 0; i < l->points; i++)
        if (l->line[i] == other &&
            (at < 0 || ty_length(ty_sub(l->at[i], l->at[end])) < ty_length(ty_sub(l->at[at], l->at[end]))))
            at = i;
    for (int on = -1; at >= 0 && on <= 1; on += 2)
        if (at + on >= 0 && at + on < l->points && l->line[at + on] == other)
            best = fmax(best, roots_angle(ty_sub(l->at[before], l->at[end]), ty_sub(l->at[at + on], l->at[at])));
    return best;
}

// Of the ends of all lines but those of main roots (1), which run beside the trunk.
static void roots_measure_joins(const roots_lines* l, roots_figures* out)
{
    double* joins = malloc((2 * (size_t)l->lines + 1) * sizeof *joins);
    size_t count = 0;
    for (int i = 0; i + 1 < l->points; i++)
    {
        int line = l->line[i], before = l->line[i + 1];
        if ((i == 0 || l->line[i - 1] != line) && l->parent[line] >= 0 && l->kind[line] != 1)
            joins[count++] = roots_join(l, i, i + 1, l->parent[line]);
        if ((i + 2 == l->points || l->line[i + 2] != before) && before == line && l->end[line] >= 0)
            joins[count++] = roots_join(l, i + 1, i, l->end[line]);
    }
    out->join_1 = roots_share(joins, count, 0.01);
    out->join_least = count > 0 ? joins[0] : 180.0;
    free(joins);
}

static void roots_measure_lines(const roots_lines* l, const ty_mesh* mesh, roots_figures* out)
{
    double* bends = malloc(((size_t)l->points + 1) * sizeof *bends);
    int *above = malloc(((size_t)l->lines + 1) * sizeof *above), count = 0;
    bool* seen = calloc((size_t)l->lines + 1, sizeof *seen);
    const ty_mesh_attribute* root = ty_mesh_find_attribute(mesh, "root");
    for (int i = 1; i + 1 < l->points; i++)
        if (l->line[i - 1] == l->line[i] && l->line[i + 1] == l->line[i])
            bends[count++] = roots_angle(ty_sub(l->at[i - 1], l->at[i]), ty_sub(l->at[i + 1], l->at[i]));
    out->bend_1 = roots_share(bends, (size_t)count, 0.01);
    out->bend_least = count > 0 ? bends[0] : 180.0;
    out->lines = out->parts = out->unseen = l->lines;
    for (int i = 0; i < l->lines; i++)
        above[i] = i;
    for (int i = 0; i < 2 * l->lines; i++)
    {
        int other = i < l->lines ? l->parent[i] : l->end[i - l->lines];
        if (other < 0)
            continue;
        int a = roots_part(above, i % l->lines), b = roots_part(above, other);
        out->parts -= a != b;
        above[a] = b;
    }
    for (uint32_t v = 0; root && v < mesh->vertex_count; v++)
    {
        int line = (int)root->values[v];
        out->unseen -= line >= 0 && line < l->lines && !seen[line];
        seen[line >= 0 && line < l->lines ? line : l->lines] = true;
    }
    free(bends);
    free(above);
    free(seen);
}

// false: a file cannot be read or lacks what is needed.
static bool roots_measure(const char* mesh_path, const char* curves_path, const roots_ground* ground,
                          roots_figures* out)
{
    ty_error error;
    ty_mesh *mesh = NULL, *meshes[8] = {NULL};
    roots_host_files host;
    roots_lines lines;
    *out = (roots_figures){0};
    bool good = ty_mesh_read(mesh_path, &mesh, &error) == TY_OK && roots_host_open(ground, &host, meshes) &&
                roots_lines_read(curves_path, &lines);
    if (!good)
        return false;
    roots_measure_shape(mesh, out);
    good = roots_measure_hold(mesh, &host, out);
    roots_measure_lines(&lines, mesh, out);
    roots_measure_joins(&lines, out);
    roots_lines_term(&lines);
    ty_world_destroy(host.world);
    ty_mesh_destroy(mesh);
    for (int i = 0; i < ground->count; i++)
        ty_mesh_destroy(meshes[i]);
    return good;
}
