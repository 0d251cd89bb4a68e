// SPDX-License-Identifier: Apache-2.0
// Small corners made larger by moves of their vertices; what the corners about a vertex are like.
#include "mesh_mend.h"

// --- corners ---

float mend_sharpest(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    ty_vec3 ab = ty_sub(b, a), bc = ty_sub(c, b), ca = ty_sub(a, c);
    float x = ty_length_sqr(ab), y = ty_length_sqr(bc), z = ty_length_sqr(ca);
    if (!(x > 0.0f && y > 0.0f && z > 0.0f))
        return 1.0f;
    float at_a = -ty_dot(ca, ab) / sqrtf(z * x), at_b = -ty_dot(ab, bc) / sqrtf(x * y);
    return ty_max(at_a, ty_max(at_b, -ty_dot(bc, ca) / sqrtf(y * z)));
}

float mend_triangle_sharpest(const mend* m, int32_t triangle)
{
    return mend_sharpest(mend_place(m, 3 * triangle), mend_place(m, 3 * triangle + 1), mend_place(m, 3 * triangle + 2));
}

int mend_ring_find(const mend* m, int32_t first, int32_t out[MEND_RING])
{
    int count = 0;
    int32_t c = first;
    do
    {
        if (count == MEND_RING)
            return 0;
        out[count++] = c;
        c = mend_swing(m, c);
    } while (c != first);
    return count;
}

float mend_ring_sharpest(const mend* m, const int32_t* ring, int count, ty_vec3 p, uint32_t skip, float cosine)
{
    float worst = -1.0f;
    for (int i = 0; i < count; i++)
    {
        uint32_t a = mend_vertex(m, mend_after(ring[i])), b = mend_vertex(m, mend_before(ring[i]));
        if (a == skip || b == skip)
            continue;
        ty_vec3 pa = m->mesh->positions[a], pb = m->mesh->positions[b];
        ty_vec3 old = mend_triangle_normal(m, ring[i] / 3);
        bool flat = mend_triangle_sharpest(m, ring[i] / 3) > 0.99985f; // its normal says nothing
        if (!flat && !mend_agree(mend_normal(p, pa, pb), old, cosine))
            return 2.0f;
        worst = ty_max(worst, mend_sharpest(p, pa, pb));
    }
    return worst;
}

float mend_ring_worst(const mend* m, const int32_t* ring, int count)
{
    float worst = -1.0f;
    for (int i = 0; i < count; i++)
        worst = ty_max(worst, mend_triangle_sharpest(m, ring[i] / 3));
    return worst;
}

// --- moves ---

bool mend_move(mend* m, int32_t c)
{
    int32_t ring[MEND_RING];
    int count = mend_ring_find(m, c, ring);
    if (count == 0)
        return false;
    ty_vec3 p = mend_place(m, c), middle = {0.0f, 0.0f, 0.0f}, n = middle;
    for (int i = 0; i < count; i++)
    {
        middle = ty_add(middle, mend_place(m, mend_after(ring[i])));
        n = ty_add(n, mend_triangle_normal(m, ring[i] / 3));
    }
    ty_vec3 shift = ty_sub(ty_mul(middle, 1.0f / (float)count), p);
    n = ty_normalize(n);
    shift = ty_mad(shift, n, -ty_dot(shift, n));
    float now = mend_ring_worst(m, ring, count);
    for (float part = 1.0f; part > 0.2f; part *= 0.5f)
    {
        ty_vec3 q = mend_held(m, ty_mad(p, shift, part));
        if (mend_ring_sharpest(m, ring, count, q, UINT32_MAX, 0.5f) < now - MEND_BETTER)
        {
            m->mesh->positions[mend_vertex(m, c)] = q;
            return true;
        }
    }
    return false;
}

bool mend_search(mend* m, int32_t c)
{
    enum
    {
        WAYS = 14, // towards the faces and the corners of a cube
    };
    int32_t ring[MEND_RING];
    int count = mend_ring_find(m, c, ring);
    ty_vec3 p = mend_place(m, c), best = p;
    float now = mend_ring_worst(m, ring, count), then = now - MEND_BETTER, reach = 0.0f;
    for (int i = 0; i < count; i++)
        reach += ty_length(ty_sub(mend_place(m, mend_after(ring[i])), p)) / (float)count;
    for (float part = 0.4f; count > 0 && part > 0.04f && then == now - MEND_BETTER; part *= 0.5f)
        for (int way = 0; way < WAYS; way++)
        {
            int corner = way - 6;
            ty_vec3 d = way >= 6 ? ty_vec3_make(corner & 1 ? 0.577f : -0.577f, corner & 2 ? 0.577f : -0.577f,
                                                corner & 4 ? 0.577f : -0.577f)
                                 : ty_vec3_make(way / 2 == 0 ? 1.0f : 0.0f, way / 2 == 1 ? 1.0f : 0.0f,
                                                way / 2 == 2 ? 1.0f : 0.0f);
            ty_vec3 q = mend_held(m, ty_mad(p, d, (way < 6 && way & 1 ? -part : part) * reach));
            float worst = mend_ring_sharpest(m, ring, count, q, UINT32_MAX, 0.1f);
            best = worst < then ? q : best;
            then = ty_min(then, worst);
        }
    if (then == now - MEND_BETTER)
        return false;
    m->mesh->positions[mend_vertex(m, c)] = best;
    return true;
}
