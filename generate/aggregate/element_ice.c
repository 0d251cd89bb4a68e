// SPDX-License-Identifier: Apache-2.0
// A flake of ice: a box cut by planes, each cut closed by a new face, so that the surface stays closed and convex.
#include "element_kinds.h"

enum
{
    CUTS = 22,
    TRIES = 12,
    MAX_FACES = 6 + CUTS,
    MAX_CORNERS = 40,  // of a face
    MAX_POINTS = 1200, // in all, dropped ones among them
};

#define CREASE 0.21f // rad: edges of neighbouring facets stay sharp

typedef struct face
{
    int corners[MAX_CORNERS]; // counter-clockwise seen from outside
    int count;
} face;

typedef struct polyhedron
{
    ty_vec3 points[MAX_POINTS];
    int point_count;
    face faces[MAX_FACES];
    int face_count;
} polyhedron;

static void polyhedron_box(polyhedron* p, ty_vec3 half)
{
    static const int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    p->point_count = 8;
    p->face_count = 6;
    for (int i = 0; i < 8; i++)
        p->points[i] = ty_mul3(half, ty_vec3_make(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f));
    for (int f = 0; f < 6; f++)
    {
        p->faces[f].count = 4;
        for (int k = 0; k < 4; k++)
            p->faces[f].corners[k] = sides[f][k];
    }
}

// The points that a plane makes on edges; each edge is asked for by its two faces and gets one point.
typedef struct cut
{
    float height[MAX_POINTS];
    int from[MAX_CORNERS], to[MAX_CORNERS], point[MAX_CORNERS];
    int count;
    int leaves[MAX_CORNERS], enters[MAX_CORNERS]; // a face's way along the plane: from point to point
    int side_count;
} cut;

static int cut_edge(polyhedron* p, cut* c, int a, int b)
{
    int low = a < b ? a : b, high = a < b ? b : a;
    for (int i = 0; i < c->count; i++)
        if (c->from[i] == low && c->to[i] == high)
            return c->point[i];
    float t = c->height[low] / (c->height[low] - c->height[high]);
    c->from[c->count] = low;
    c->to[c->count] = high;
    c->point[c->count] = p->point_count;
    c->count++;
    p->points[p->point_count] = ty_lerp3(p->points[low], p->points[high], t);
    return p->point_count++;
}

static void face_cut(polyhedron* p, cut* c, face* f)
{
    face kept = {.count = 0};
    int leaves = -1, enters = -1;
    for (int k = 0; k < f->count; k++)
    {
        int a = f->corners[k], b = f->corners[(k + 1) % f->count];
        bool in_a = c->height[a] < 0.0f, in_b = c->height[b] < 0.0f;
        if (in_a)
            kept.corners[kept.count++] = a;
        if (in_a == in_b)
            continue;
        int point = cut_edge(p, c, a, b);
        kept.corners[kept.count++] = point;
        *(in_a ? &leaves : &enters) = point;
    }
    *f = kept;
    if (leaves < 0)
        return;
    c->leaves[c->side_count] = leaves;
    c->enters[c->side_count++] = enters;
}

// The new face goes along the faces' cuts the other way round.
static void cut_close(polyhedron* p, const cut* c)
{
    face* f = &p->faces[p->face_count++];
    f->count = 0;
    for (int at = c->enters[0]; f->count < c->side_count;)
    {
        f->corners[f->count++] = at;
        int next = 0;
        while (next < c->side_count && c->enters[next] != at)
            next++;
        TY_ASSERT(next < c->side_count);
        at = c->leaves[next];
    }
}

static void faces_drop_empty(polyhedron* p)
{
    int kept = 0;
    for (int i = 0; i < p->face_count; i++)
        if (p->faces[i].count >= 3)
            p->faces[kept++] = p->faces[i];
    p->face_count = kept;
}

// Takes away what lies beyond dot(n, x) = height. False, with nothing done, when the plane misses, comes too near to a
// corner, which would make slivers, or makes too many points.
static bool polyhedron_cut(polyhedron* p, cut* c, ty_vec3 n, float height, float least)
{
    bool hits = false;
    c->count = c->side_count = 0;
    if (p->point_count > MAX_POINTS - MAX_CORNERS)
        return false;
    for (int i = 0; i < p->face_count; i++)
        for (int k = 0; k < p->faces[i].count; k++)
        {
            int at = p->faces[i].corners[k];
            c->height[at] = ty_dot(n, p->points[at]) - height;
            hits |= c->height[at] > 0.0f;
            if (fabsf(c->height[at]) < least)
                return false;
        }
    if (!hits)
        return false;
    for (int i = 0; i < p->face_count; i++)
        face_cut(p, c, &p->faces[i]);
    cut_close(p, c);
    faces_drop_empty(p);
    return true;
}

static ty_mesh* polyhedron_mesh(const polyhedron* p)
{
    static const uint32_t unused = UINT32_MAX;
    uint32_t* number = TY_ALLOC(uint32_t, MAX_POINTS);
    uint32_t vertices = 0, triangles = 0;
    for (int i = 0; i < MAX_POINTS; i++)
        number[i] = unused;
    for (int i = 0; i < p->face_count; i++)
    {
        triangles += (uint32_t)p->faces[i].count - 2;
        for (int k = 0; k < p->faces[i].count; k++)
            if (number[p->faces[i].corners[k]] == unused)
                number[p->faces[i].corners[k]] = vertices++;
    }
    ty_mesh* mesh = ty_mesh_create(vertices, triangles);
    uint32_t t = 0;
    for (int i = 0; mesh && i < p->face_count; i++)
    {
        const face* f = &p->faces[i];
        for (int k = 0; k < f->count; k++)
            mesh->positions[number[f->corners[k]]] = p->points[f->corners[k]];
        for (int k = 2; k < f->count; k++, t++)
        {
            mesh->triangles[t][0] = number[f->corners[0]];
            mesh->triangles[t][1] = number[f->corners[k - 1]];
            mesh->triangles[t][2] = number[f->corners[k]];
        }
    }
    ty_free(number);
    return mesh;
}

// Planes that touch an ellipsoid of the flake's half sizes, a little nearer or farther; towards the golden angle's
// directions, so that no side is left out.
static void flake_cut(polyhedron* p, cut* c, ty_vec3 half, ty_rng* rng)
{
    for (int i = 0; i < CUTS; i++)
        for (int tries = 0; tries < TRIES; tries++)
        {
            float y = 1.0f - 2.0f * ((float)i + 0.5f) / CUTS, r = ty_safe_sqrt(1.0f - y * y), sine, cosine;
            ty_sincos(2.39996323f * (float)i, &sine, &cosine);
            ty_vec3 n = {r * cosine, y, r * sine};
            n.x += ty_rng_range(rng, -0.45f, 0.45f);
            n.y += ty_rng_range(rng, -0.45f, 0.45f);
            n.z += ty_rng_range(rng, -0.45f, 0.45f);
            float height = ty_rng_range(rng, 0.72f, 1.0f);
            ty_vec3 scaled = {n.x / half.x, n.y / half.y, n.z / half.z};
            float length = ty_length(scaled);
            if (polyhedron_cut(p, c, ty_mul(scaled, 1.0f / length), height * ty_length(n) / length, 0.03f * half.z))
                break;
        }
}

ty_status ty_ice_mesh(const ty_element_def* def, ty_seed seed, int variant, ty_mesh** out, ty_error* error)
{
    ty_rng rng = ty_rng_make(seed, 0x696365, (uint64_t)variant);
    float bell[3];
    for (int i = 0; i < 3; i++)
        bell[i] = 1.0f + 2.0f * def->variation * ty_clamp(ty_element_bell(&rng), -2.0f, 2.0f);
    ty_vec3 half = {0.5f * def->length * bell[0], 0.5f * def->width * bell[1], 0.5f * def->thickness * bell[2]};
    polyhedron* p = TY_ALLOC(polyhedron, 1);
    cut* c = TY_ALLOC(cut, 1);
    polyhedron_box(p, half);
    flake_cut(p, c, half, &rng);
    *out = polyhedron_mesh(p);
    ty_free(c);
    ty_free(p);
    if (!*out)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a flake of ice");
    ty_mesh_compute_welds(*out);
    ty_mesh_compute_normals(*out, CREASE);
    ty_mesh_compute_curvature(*out, 0);
    return TY_OK;
}
