// SPDX-License-Identifier: Apache-2.0
// The inside of the elastic solver: particles, bodies with their constraints, candidate contacts.
#pragma once
#include "candidates.h"
#include <tsuya/generate/xpbd.h>

enum
{
    XPBD_WALL = -1,
    XPBD_LID = 31,
};

#define XPBD_MARGIN 0.4e-3f // m, gaps up to here are candidates; found anew when particles may have moved half of it

typedef struct particle
{
    ty_vec3 x, v;
    ty_vec3 shift; // m, since the substep began: velocities come from it, free of the rounding of x
    ty_vec3 force; // N, from outside
    float inverse_mass, radius;
} particle;

typedef struct soft
{
    int first, count; // particles; rest as well
    int stretch_first, stretch_count;
    int bend_first, bend_count;
    int triangle_first, triangle_count;
    float match, bulk, volume; // N/m, Pa, m^3 to be kept
    float mass, scale;
    bool fixed; // a particle of it does not move: the frame stays, momentum is not its own
    ty_quat rotation;
    ty_vec3 center, rest_center; // of mass, world and made
    float radius;                // about the centre
    float fastest;               // m/s, of its particles
    uint32_t grain;
} soft;

typedef struct near
{
    int a, b; // particles; b is a wall's number in a wall's pair
} near;

typedef struct couple
{
    int a, b; // bodies, a < b; b = XPBD_WALL
    int first, count;
    bool wet; // a bridge of water joins them
} couple;

struct ty_xpbd
{
    ty_xpbd_def def;
    particle* particles;
    ty_vec3* rest; // of each particle, in the body's frame, scaled
    int particle_count, particle_capacity, rest_capacity;
    soft* bodies;
    int body_count, body_capacity;
    ty_stretch* stretches;
    int stretch_count, stretch_capacity;
    ty_bend* bends;
    int bend_count, bend_capacity;
    int (*triangles)[3];
    int triangle_count, triangle_capacity;
    near* nears;
    int near_count, near_capacity;
    couple *couples, *old_couples;
    int couple_count, couple_capacity, old_couple_count, old_couple_capacity, wall_first;
    int* order;
    int order_capacity;
    pair_blocks blocks;
    float moved; // m, how far particles may have come since candidates were found
    bool stale, cohesive;
    float margin; // m, gaps up to here are candidates
    float lid;
    ty_vec3 squeeze, squeeze_center;
};

static inline void particle_move(particle* p, ty_vec3 direction, float distance)
{
    ty_vec3 d = ty_mul(direction, distance);
    p->x = ty_add(p->x, d);
    p->shift = ty_add(p->shift, d);
}

// xpbd_body.c: runs on one body's particles alone
void xpbd_body_solve(ty_xpbd* x, soft* body);
void xpbd_body_measure(ty_xpbd* x, soft* body); // centre, radius, rotation
double xpbd_body_energy(const ty_xpbd* x, const soft* body);

// xpbd_contact.c
void xpbd_detect(ty_xpbd* x);
void xpbd_contacts_solve(ty_xpbd* x, ty_workers* workers);
double xpbd_contacts_energy(const ty_xpbd* x);
float xpbd_wall(const ty_xpbd* x, int wall, ty_vec3 p, ty_vec3* normal);
