// SPDX-License-Identifier: Apache-2.0
// Small corners of closed meshes made larger: edges are flipped and collapsed, vertices moved, one bad triangle after
// the other. Corners know the one across their edge (corner table: Rossignac, Safonova & Szymczak 2001).
#include <string.h>
#include <tsuya/geometry/surface_net.h>

enum
{
    ROUNDS = 12,
    MOST_RING = 48, // corners about a vertex that are looked at
    NONE = -1,
};

#define BETTER 1e-3f // by which a cosine has to get smaller

typedef struct mend
{
    ty_mesh* mesh;
    int32_t* across; // [3 triangles] the corner on the other side of the edge that faces the corner
    int32_t* corner; // [vertices] one of the vertex' corners, NONE: it is gone
    bool* gone;      // [triangles]
    float least;     // cosine of the corner that is asked for
} mend;

static inline int32_t after(int32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

static inline int32_t before(int32_t c)
{
    return c % 3 == 0 ? c + 2 : c - 1;
}

static inline uint32_t vertex(const mend* m, int32_t c)
{
    return m->mesh->triangles[c / 3][c % 3];
}

static inline ty_vec3 place(const mend* m, int32_t c)
{
    return m->mesh->positions[vertex(m, c)];
}

// The next corner of the same vertex, counter-clockwise.
static inline int32_t swing(const mend* m, int32_t c)
{
    return after(m->across[after(c)]);
}

static void pair_set(mend* m, int32_t a, int32_t b)
{
    m->across[a] = b;
    m->across[b] = a;
}

// Cosine of the smallest angle; 1 for what has no area.
static float sharpest(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 ab = ty_sub(b, a), bc = ty_sub(c, b), ca = ty_sub(a, c);
    float x = ty_length_sqr(ab), y = ty_length_sqr(bc), z = ty_length_sqr(ca);
    if (!(x > 0.0f && y > 0.0f && z > 0.0f))
        return 1.0f;
    float at_a = -ty_dot(ca, ab) / sqrtf(z * x), at_b = -ty_dot(ab, bc) / sqrtf(x * y);
    return ty_max(at_a, ty_max(at_b, -ty_dot(bc, ca) / sqrtf(y * z)));
}

static float triangle_sharpest(const mend* m, int32_t triangle)
{
    return sharpest(place(m, 3 * triangle), place(m, 3 * triangle + 1), place(m, 3 * triangle + 2));
}

static ty_vec3 normal(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    return ty_cross(ty_sub(b, a), ty_sub(c, a));
}

static ty_vec3 triangle_normal(const mend* m, int32_t t)
{
    return normal(place(m, 3 * t), place(m, 3 * t + 1), place(m, 3 * t + 2));
}

// Whether two normals, of any length, are less than 60 degrees apart.
static bool agree(ty_vec3 a, ty_vec3 b)
{
    float dot = ty_dot(a, b);
    return dot > 0.0f && dot * dot > 0.25f * ty_length_sqr(a) * ty_length_sqr(b);
}

// The corners of a vertex; 0: more than there is room for.
static int ring_find(const mend* m, int32_t first, int32_t out[MOST_RING])
{
    int count = 0;
    int32_t c = first;
    do
    {
        if (count == MOST_RING)
            return 0;
        out[count++] = c;
        c = swing(m, c);
    } while (c != first);
    return count;
}

// --- flips ---

static bool are_linked(const mend* m, int32_t c, uint32_t other)
{
    int32_t ring[MOST_RING];
    int count = ring_find(m, c, ring);
    for (int i = 0; i < count; i++)
        if (vertex(m, after(ring[i])) == other)
            return true;
    return count == 0;
}

// Turns the edge that faces corner c, if both triangles get better for it.
static bool flip(mend* m, int32_t c)
{
    int32_t o = m->across[c];
    ty_vec3 p = place(m, c), a = place(m, after(c)), b = place(m, before(c)), q = place(m, o);
    float now = ty_max(sharpest(p, a, b), sharpest(q, b, a)), then = ty_max(sharpest(p, a, q), sharpest(p, q, b));
    if (then >= now - BETTER)
        return false;
    ty_vec3 mean = ty_add(ty_normalize(normal(p, a, b)), ty_normalize(normal(q, b, a)));
    if (!agree(normal(p, a, q), mean) || !agree(normal(p, q, b), mean) || are_linked(m, c, vertex(m, o)))
        return false;
    // (p a b) (q b a) become (p a q) and (q b p): a and b keep a corner each, the others move by one.
    int32_t ca = after(c), cb = before(c), oa = before(o), ob = after(o);
    uint32_t vp = vertex(m, c), va = vertex(m, ca), vb = vertex(m, cb), vq = vertex(m, o);
    int32_t beyond_a = m->across[ob], beyond_b = m->across[ca]; // across q-a and p-b
    m->mesh->triangles[cb / 3][cb % 3] = vq;
    m->mesh->triangles[oa / 3][oa % 3] = vp;
    pair_set(m, c, beyond_a);
    pair_set(m, o, beyond_b);
    pair_set(m, ca, ob);
    m->corner[vp] = c;
    m->corner[vq] = o;
    m->corner[va] = ca;
    m->corner[vb] = ob;
    return true;
}

// --- collapses ---

// The worst of the triangles about ring's vertex if it stood at p, but those that hold skip; 2 where one turns over.
static float ring_sharpest(const mend* m, const int32_t* ring, int count, ty_vec3 p, uint32_t skip)
{
    float worst = -1.0f;
    for (int i = 0; i < count; i++)
    {
        uint32_t a = vertex(m, after(ring[i])), b = vertex(m, before(ring[i]));
        if (a == skip || b == skip)
            continue;
        ty_vec3 pa = m->mesh->positions[a], pb = m->mesh->positions[b];
        ty_vec3 old = triangle_normal(m, ring[i] / 3);
        bool flat = triangle_sharpest(m, ring[i] / 3) > 0.99985f; // its normal says nothing
        if (!flat && !agree(normal(p, pa, pb), old))
            return 2.0f;
        worst = ty_max(worst, sharpest(p, pa, pb));
    }
    return worst;
}

static float ring_worst(const mend* m, const int32_t* ring, int count)
{
    float worst = -1.0f;
    for (int i = 0; i < count; i++)
        worst = ty_max(worst, triangle_sharpest(m, ring[i] / 3));
    return worst;
}

// Only the two vertices that face the edge are next to both of its ends.
static bool link_is_simple(const mend* m, const int32_t* a, int count_a, const int32_t* b, int count_b)
{
    int shared = 0;
    for (int i = 0; i < count_a; i++)
        for (int j = 0; j < count_b; j++)
            shared += vertex(m, after(a[i])) == vertex(m, after(b[j]));
    return shared == 2;
}

static bool has_more_than_three(const mend* m, int32_t c)
{
    int32_t ring[MOST_RING];
    return ring_find(m, c, ring) > 3;
}

static void triangle_drop(mend* m, int32_t c)
{
    // c faces the edge that goes; the two others become one
    int32_t u = m->across[after(c)], w = m->across[before(c)];
    pair_set(m, u, w);
    m->gone[c / 3] = true;
    m->corner[vertex(m, c)] = after(u);
}

// Draws the edge that faces corner c together, to one of its ends or its middle, if the worst of all triangles about it
// gets better by that much.
static bool collapse(mend* m, int32_t c, float better)
{
    int32_t ca = after(c), cb = before(c), o = m->across[c], ring_a[MOST_RING], ring_b[MOST_RING];
    uint32_t a = vertex(m, ca), b = vertex(m, cb);
    int na = ring_find(m, ca, ring_a), nb = ring_find(m, cb, ring_b);
    if (na == 0 || nb == 0 || na + nb > MOST_RING || !link_is_simple(m, ring_a, na, ring_b, nb) ||
        !has_more_than_three(m, c) || !has_more_than_three(m, o))
        return false;
    ty_vec3 pa = place(m, ca), pb = place(m, cb), best = pa;
    float now = ty_max(ring_worst(m, ring_a, na), ring_worst(m, ring_b, nb)), then = 2.0f;
    for (int i = 0; i < 3; i++)
    {
        ty_vec3 p = i == 0 ? ty_lerp3(pa, pb, 0.5f) : i == 1 ? pa : pb;
        float worst = ty_max(ring_sharpest(m, ring_a, na, p, b), ring_sharpest(m, ring_b, nb, p, a));
        best = worst < then ? p : best;
        then = ty_min(then, worst);
    }
    if (then > now - better)
        return false;
    int32_t kept = NONE;
    for (int i = 0; i < na; i++)
        if (ring_a[i] / 3 != c / 3 && ring_a[i] / 3 != o / 3)
            kept = ring_a[i];
    for (int i = 0; i < nb; i++)
        m->mesh->triangles[ring_b[i] / 3][ring_b[i] % 3] = a;
    triangle_drop(m, c);
    triangle_drop(m, o);
    m->corner[b] = NONE;
    m->corner[a] = kept;
    m->mesh->positions[a] = best;
    return true;
}

// --- moves ---

// Moves the corner's vertex within the plane of its surroundings.
static bool move(mend* m, int32_t c)
{
    int32_t ring[MOST_RING];
    int count = ring_find(m, c, ring);
    if (count == 0)
        return false;
    ty_vec3 p = place(m, c), middle = {0.0f, 0.0f, 0.0f}, n = middle;
    for (int i = 0; i < count; i++)
    {
        middle = ty_add(middle, place(m, after(ring[i])));
        n = ty_add(n, triangle_normal(m, ring[i] / 3));
    }
    ty_vec3 shift = ty_sub(ty_mul(middle, 1.0f / (float)count), p);
    n = ty_normalize(n);
    shift = ty_mad(shift, n, -ty_dot(shift, n));
    float now = ring_worst(m, ring, count);
    for (float part = 1.0f; part > 0.2f; part *= 0.5f)
    {
        ty_vec3 q = ty_mad(p, shift, part);
        if (ring_sharpest(m, ring, count, q, UINT32_MAX) < now - BETTER)
        {
            m->mesh->positions[vertex(m, c)] = q;
            return true;
        }
    }
    return false;
}

static bool triangle_mend(mend* m, int32_t t)
{
    int32_t longest = 3 * t, shortest = 3 * t;
    float length[3];
    for (int k = 0; k < 3; k++)
        length[k] = ty_length_sqr(ty_sub(place(m, after(3 * t + k)), place(m, before(3 * t + k))));
    for (int k = 1; k < 3; k++)
    {
        longest = length[k] > length[longest % 3] ? 3 * t + k : longest;
        shortest = length[k] < length[shortest % 3] ? 3 * t + k : shortest;
    }
    if (flip(m, longest) || collapse(m, shortest, BETTER))
        return true;
    for (int k = 0; k < 3; k++)
        if (move(m, 3 * t + k))
            return true;
    for (int k = 0; k < 3; k++)
        if (flip(m, 3 * t + k) || collapse(m, 3 * t + k, BETTER))
            return true;
    return collapse(m, shortest, -1e-5f); // slivers side by side, as about a neck: at least they get fewer
}

// --- the table ---

static uint32_t lower_end(const mend* m, int32_t c)
{
    uint32_t a = vertex(m, after(c)), b = vertex(m, before(c));
    return a < b ? a : b;
}

// Corners sorted by the lower end of the edge they face; those of one edge find each other there.
static bool across_find(mend* m)
{
    const ty_mesh* mesh = m->mesh;
    int32_t corners = (int32_t)(3 * mesh->triangle_count);
    int32_t* first = TY_TRY_ALLOC(int32_t, (size_t)mesh->vertex_count + 1);
    int32_t* list = TY_TRY_ALLOC(int32_t, corners);
    bool held = first && list;
    for (int32_t c = 0; held && c < corners; c++)
        first[1 + lower_end(m, c)]++;
    for (uint32_t v = 0; held && v < mesh->vertex_count; v++)
        first[v + 1] += first[v];
    for (int32_t c = 0; held && c < corners; c++)
    {
        m->corner[vertex(m, c)] = c;
        m->across[c] = NONE;
        list[first[lower_end(m, c)]++] = c;
    }
    for (uint32_t v = 0; held && v < mesh->vertex_count; v++) // first[v] is where v's end now
        for (int32_t i = v ? first[v - 1] : 0; i < first[v]; i++)
            for (int32_t j = i + 1; j < first[v] && m->across[list[i]] == NONE; j++)
                if (vertex(m, after(list[i])) == vertex(m, before(list[j])) &&
                    vertex(m, before(list[i])) == vertex(m, after(list[j])))
                    pair_set(m, list[i], list[j]);
    ty_free(first);
    ty_free(list);
    return held;
}

static void compact(mend* m)
{
    ty_mesh* mesh = m->mesh;
    uint32_t vertices = 0, triangles = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (m->corner[v] != NONE)
        {
            mesh->positions[vertices] = mesh->positions[v];
            m->corner[v] = (int32_t)vertices++;
        }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        if (!m->gone[t])
        {
            for (int k = 0; k < 3; k++)
                mesh->triangles[triangles][k] = (uint32_t)m->corner[mesh->triangles[t][k]];
            triangles++;
        }
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
}

// A round over all triangles that are too sharp; how many got better, and the worst that there was.
static int round_run(mend* m, float* worst)
{
    int better = 0;
    *worst = -1.0f;
    for (int32_t t = 0; t < (int32_t)m->mesh->triangle_count; t++)
    {
        float sharp = m->gone[t] ? -1.0f : triangle_sharpest(m, t);
        *worst = ty_max(*worst, sharp);
        if (sharp > m->least)
            better += triangle_mend(m, t);
    }
    return better;
}

ty_status ty_mesh_mend_corners(ty_mesh* mesh, float corner, float* smallest, ty_error* error)
{
    mend m = {.mesh = mesh,
              .across = TY_TRY_ALLOC(int32_t, 3 * (size_t)mesh->triangle_count),
              .corner = TY_TRY_ALLOC(int32_t, mesh->vertex_count),
              .gone = TY_TRY_ALLOC(bool, mesh->triangle_count),
              .least = ty_cos(corner)};
    bool held = m.across && m.corner && m.gone && across_find(&m);
    float worst = 1.0f;
    for (int i = 0; held && i < ROUNDS && round_run(&m, &worst) > 0; i++)
        continue;
    if (held)
        round_run(&m, &worst);
    if (held)
        compact(&m);
    if (smallest)
        *smallest = ty_acos(ty_clamp(worst, -1.0f, 1.0f));
    ty_free(m.across);
    ty_free(m.corner);
    ty_free(m.gone);
    return held ? TY_OK : ty_error_set(error, TY_NO_MEMORY, "no memory to mend %u triangles", mesh->triangle_count);
}
