// SPDX-License-Identifier: Apache-2.0
// Small corners of closed meshes made larger: edges are flipped and collapsed, vertices moved, one bad triangle after
// the other. Corners know the one across their edge (corner table: Rossignac, Safonova & Szymczak 2001).
#include "mesh_mend.h"
#include <string.h>

enum
{
    ROUNDS = 12,
};

#define SLIVER 0.9563f // cosine of 17 degrees: below it vertices may leave the surface a little

static void pair_set(mend* m, int32_t a, int32_t b)
{
    m->across[a] = b;
    m->across[b] = a;
}

// --- flips ---

static bool are_linked(const mend* m, int32_t c, uint32_t other)
{
    int32_t ring[MEND_RING];
    int count = mend_ring_find(m, c, ring);
    for (int i = 0; i < count; i++)
        if (mend_vertex(m, mend_after(ring[i])) == other)
            return true;
    return count == 0;
}

// Turns the edge that faces corner c, if both triangles get better for it.
static bool flip(mend* m, int32_t c)
{
    int32_t o = m->across[c];
    ty_vec3 p = mend_place(m, c), a = mend_place(m, mend_after(c)), b = mend_place(m, mend_before(c)),
            q = mend_place(m, o);
    float now = ty_max(mend_sharpest(p, a, b), mend_sharpest(q, b, a)),
          then = ty_max(mend_sharpest(p, a, q), mend_sharpest(p, q, b));
    if (then >= now - MEND_BETTER)
        return false;
    ty_vec3 mean = ty_add(ty_normalize(mend_normal(p, a, b)), ty_normalize(mend_normal(q, b, a)));
    if (!mend_agree(mend_normal(p, a, q), mean, 0.5f) || !mend_agree(mend_normal(p, q, b), mean, 0.5f) ||
        are_linked(m, c, mend_vertex(m, o)))
        return false;
    // (p a b) (q b a) become (p a q) and (q b p): a and b keep a corner each, the others move by one.
    int32_t ca = mend_after(c), cb = mend_before(c), oa = mend_before(o), ob = mend_after(o);
    uint32_t vp = mend_vertex(m, c), va = mend_vertex(m, ca), vb = mend_vertex(m, cb), vq = mend_vertex(m, o);
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

// Only the two vertices that face the edge are next to both of its ends.
static bool link_is_simple(const mend* m, const int32_t* a, int count_a, const int32_t* b, int count_b)
{
    int shared = 0;
    for (int i = 0; i < count_a; i++)
        for (int j = 0; j < count_b; j++)
            shared += mend_vertex(m, mend_after(a[i])) == mend_vertex(m, mend_after(b[j]));
    return shared == 2;
}

static bool has_more_than_three(const mend* m, int32_t c)
{
    int32_t ring[MEND_RING];
    return mend_ring_find(m, c, ring) > 3;
}

static void triangle_drop(mend* m, int32_t c)
{
    // c faces the edge that goes; the two others become one
    int32_t u = m->across[mend_after(c)], w = m->across[mend_before(c)];
    pair_set(m, u, w);
    m->gone[c / 3] = true;
    m->corner[mend_vertex(m, c)] = mend_after(u);
}

// Draws the edge that faces corner c together, to one of its ends or its middle, if the worst of all triangles about it
// gets better by that much.
static bool collapse(mend* m, int32_t c, float better)
{
    int32_t ca = mend_after(c), cb = mend_before(c), o = m->across[c], ring_a[MEND_RING], ring_b[MEND_RING];
    uint32_t a = mend_vertex(m, ca), b = mend_vertex(m, cb);
    int na = mend_ring_find(m, ca, ring_a), nb = mend_ring_find(m, cb, ring_b);
    if (na == 0 || nb == 0 || na + nb > MEND_RING || !link_is_simple(m, ring_a, na, ring_b, nb) ||
        !has_more_than_three(m, c) || !has_more_than_three(m, o))
        return false;
    ty_vec3 pa = mend_place(m, ca), pb = mend_place(m, cb), best = pa;
    float now = ty_max(mend_ring_worst(m, ring_a, na), mend_ring_worst(m, ring_b, nb)), then = 2.0f;
    for (int i = 0; i < 3; i++)
    {
        ty_vec3 p = i == 0 ? mend_held(m, ty_lerp3(pa, pb, 0.5f)) : i == 1 ? pa : pb;
        float worst =
            ty_max(mend_ring_sharpest(m, ring_a, na, p, b, 0.5f), mend_ring_sharpest(m, ring_b, nb, p, a, 0.5f));
        best = worst < then ? p : best;
        then = ty_min(then, worst);
    }
    if (then > now - better)
        return false;
    int32_t kept = MEND_NONE;
    for (int i = 0; i < na; i++)
        if (ring_a[i] / 3 != c / 3 && ring_a[i] / 3 != o / 3)
            kept = ring_a[i];
    for (int i = 0; i < nb; i++)
        m->mesh->triangles[ring_b[i] / 3][ring_b[i] % 3] = a;
    triangle_drop(m, c);
    triangle_drop(m, o);
    m->corner[b] = MEND_NONE;
    m->corner[a] = kept;
    m->mesh->positions[a] = best;
    return true;
}

static bool triangle_mend(mend* m, int32_t t)
{
    int32_t longest = 3 * t, shortest = 3 * t;
    float length[3];
    for (int k = 0; k < 3; k++)
        length[k] = ty_length_sqr(ty_sub(mend_place(m, mend_after(3 * t + k)), mend_place(m, mend_before(3 * t + k))));
    for (int k = 1; k < 3; k++)
    {
        longest = length[k] > length[longest % 3] ? 3 * t + k : longest;
        shortest = length[k] < length[shortest % 3] ? 3 * t + k : shortest;
    }
    if (flip(m, longest) || collapse(m, shortest, MEND_BETTER))
        return true;
    for (int k = 0; k < 3; k++)
        if (mend_move(m, 3 * t + k))
            return true;
    for (int k = 0; k < 3; k++)
        if (flip(m, 3 * t + k) || collapse(m, 3 * t + k, MEND_BETTER))
            return true;
    if (collapse(m, shortest, -1e-5f)) // slivers side by side, as about a neck: at least they get fewer
        return true;
    for (int k = 0; k < 3 && m->searching && mend_triangle_sharpest(m, t) > SLIVER; k++)
        if (mend_search(m, 3 * t + k))
            return true;
    return false;
}

// --- the table ---

static uint32_t lower_end(const mend* m, int32_t c)
{
    uint32_t a = mend_vertex(m, mend_after(c)), b = mend_vertex(m, mend_before(c));
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
        m->corner[mend_vertex(m, c)] = c;
        m->across[c] = MEND_NONE;
        list[first[lower_end(m, c)]++] = c;
    }
    for (uint32_t v = 0; held && v < mesh->vertex_count; v++) // first[v] is where v's end now
        for (int32_t i = v ? first[v - 1] : 0; i < first[v]; i++)
            for (int32_t j = i + 1; j < first[v] && m->across[list[i]] == MEND_NONE; j++)
                if (mend_vertex(m, mend_after(list[i])) == mend_vertex(m, mend_before(list[j])) &&
                    mend_vertex(m, mend_before(list[i])) == mend_vertex(m, mend_after(list[j])))
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
        if (m->corner[v] != MEND_NONE)
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
        float sharp = m->gone[t] ? -1.0f : mend_triangle_sharpest(m, t);
        *worst = ty_max(*worst, sharp);
        if (sharp > m->least)
            better += triangle_mend(m, t);
    }
    return better;
}

ty_status ty_mesh_mend_corners(ty_mesh* mesh, float corner, ty_mesh_hold* hold, void* context, float* smallest,
                               ty_error* error)
{
    mend m = {.mesh = mesh,
              .across = TY_TRY_ALLOC(int32_t, 3 * (size_t)mesh->triangle_count),
              .corner = TY_TRY_ALLOC(int32_t, mesh->vertex_count),
              .gone = TY_TRY_ALLOC(bool, mesh->triangle_count),
              .least = ty_cos(corner),
              .hold = hold,
              .context = context};
    bool held = m.across && m.corner && m.gone && across_find(&m);
    float worst = 1.0f;
    for (int phase = 0; held && phase < 2; phase++) // vertices leave the surface only where nothing else helps
    {
        m.searching = phase == 1;
        for (int i = 0; i < ROUNDS && (phase == 0 || worst > SLIVER) && round_run(&m, &worst) > 0; i++)
            continue;
    }
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
