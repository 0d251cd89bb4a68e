// SPDX-License-Identifier: Apache-2.0
// What the files that mend corners share: triangles by their corners, each of which knows the one across its edge.
#pragma once
#include <tsuya/geometry/surface_net.h>

enum
{
    MEND_RING = 48, // corners about a vertex that are looked at
    MEND_NONE = -1,
};

#define MEND_BETTER 1e-3f // by which a cosine has to get smaller

typedef struct mend
{
    ty_mesh* mesh;
    int32_t* across; // [3 triangles] the corner on the other side of the edge that faces the corner
    int32_t* corner; // [vertices] one of the vertex' corners, MEND_NONE: it is gone
    bool* gone;      // [triangles]
    float least;     // cosine of the corner that is asked for
    bool searching;  // into any direction
    ty_mesh_hold* hold;
    void* context;
} mend;

static inline int32_t mend_after(int32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}

static inline int32_t mend_before(int32_t c)
{
    return c % 3 == 0 ? c + 2 : c - 1;
}

static inline uint32_t mend_vertex(const mend* m, int32_t c)
{
    return m->mesh->triangles[c / 3][c % 3];
}

static inline ty_vec3 mend_place(const mend* m, int32_t c)
{
    return m->mesh->positions[mend_vertex(m, c)];
}

// Where a vertex may stand that is meant for p.
static inline ty_vec3 mend_held(const mend* m, ty_vec3 p)
{
    return m->hold ? m->hold(m->context, p) : p;
}

// The next corner of the same vertex, counter-clockwise.
static inline int32_t mend_swing(const mend* m, int32_t c)
{
    return mend_after(m->across[mend_after(c)]);
}

static inline ty_vec3 mend_normal(ty_vec3 a, ty_vec3 b, ty_vec3 c)
{
    return ty_cross(ty_sub(b, a), ty_sub(c, a));
}

static inline ty_vec3 mend_triangle_normal(const mend* m, int32_t t)
{
    return mend_normal(mend_place(m, 3 * t), mend_place(m, 3 * t + 1), mend_place(m, 3 * t + 2));
}

// Whether two normals, of any length, are less apart than the angle of that cosine, 0..1.
static inline bool mend_agree(ty_vec3 a, ty_vec3 b, float cosine)
{
    float dot = ty_dot(a, b);
    return dot > 0.0f && dot * dot > ty_sqr(cosine) * ty_length_sqr(a) * ty_length_sqr(b);
}

// Cosine of the smallest angle; 1 for what has no area.
float mend_sharpest(ty_vec3 a, ty_vec3 b, ty_vec3 c);
float mend_triangle_sharpest(const mend* m, int32_t triangle);
// The corners of a vertex; 0: more than there is room for.
int mend_ring_find(const mend* m, int32_t first, int32_t out[MEND_RING]);
// The worst of the triangles about ring's vertex if it stood at p, but those that hold skip; 2 where one turns by more
// than the angle of that cosine.
float mend_ring_sharpest(const mend* m, const int32_t* ring, int count, ty_vec3 p, uint32_t skip, float cosine);
float mend_ring_worst(const mend* m, const int32_t* ring, int count);
// Moves the corner's vertex within the plane of its surroundings. false: nothing is better.
bool mend_move(mend* m, int32_t c);
// The same into any direction, as about necks that have no room for corners.
bool mend_search(mend* m, int32_t c);
