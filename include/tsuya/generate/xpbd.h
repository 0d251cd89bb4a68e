// SPDX-License-Identifier: Apache-2.0
// Elastic elements of balls by extended position based dynamics: many substeps of one iteration each (Macklin et al.
// 2016, 2019), multipliers from 0 in each. For bodies that bend and are pressed; piles of it creep and do not rest.
#pragma once
#include <tsuya/generate/pile.h>

// Particles i and j keep their distance. Index into the body's balls.
typedef struct ty_stretch
{
    int a, b;
    float length;     // m
    float compliance; // m/N: length / (modulus * area)
} ty_stretch;

// share x_a + (1 - share) x_c - x_b keeps its vector `rest` in the body's frame: zero for straight, even segments when
// share is a half. The spec form x_a - 2 x_b + x_c is twice that. a < 0: a clamp, x_c - x_b keeps it.
typedef struct ty_bend
{
    int a, b, c;
    float share;
    ty_vec3 rest;
    float compliance; // m/N, in the form above: a quarter of l^3 / (E I); at a clamp half of l^3 / (E I)
} ty_bend;

// A body as it is made, at rest and in its own frame. Arrays are borrowed until the body is added.
typedef struct ty_soft_body
{
    const ty_ball* balls;
    const float* masses; // kg a ball; 0 = it does not move
    int ball_count;
    const ty_stretch* stretches;
    int stretch_count;
    const ty_bend* bends;
    int bend_count;
    float match;               // N/m, stiffness of the whole against its own shape, 0 = none (Müller et al. 2005)
    const int (*triangles)[3]; // closed, outward: their volume is kept; NULL = no such constraint
    int triangle_count;
    float bulk;  // Pa, modulus of that volume
    float swell; // of the volume at rest, 1 = as made
} ty_soft_body;

typedef struct ty_xpbd_def
{
    ty_vec3 gravity;               // m/s^2
    float rate;                    // substeps per second
    float friction;                // Coulomb coefficient
    float modulus;                 // Pa, Young's, of contacts and of the bodies made of elements
    float density;                 // kg/m^3, of elements
    float damping;                 // s: damping is stiffness times this
    float push_out;                // m/s, largest speed at which an overlap is undone
    ty_bridge_def bridge;          // what pulls bodies together; its density is not used
    const ty_container* container; // borrowed; NULL = no walls
} ty_xpbd_def;

ty_xpbd_def ty_xpbd_def_default(void);

typedef struct ty_xpbd ty_xpbd; // opaque; one thread at a time drives it

ty_xpbd* ty_xpbd_create(const ty_xpbd_def* def); // copies def
void ty_xpbd_destroy(ty_xpbd* x);                // NULL is allowed
// Copies the body, scaled, turned and moved; returns its number. All its balls start with velocity.
int ty_xpbd_add(ty_xpbd* x, const ty_soft_body* body, ty_vec3 position, ty_quat rotation, float scale,
                ty_vec3 velocity);
// The body of an element: neighbouring balls are joined, straight rows of three resist bending, the whole its shape.
int ty_xpbd_add_element(ty_xpbd* x, const ty_element* element, const ty_body* body);
void ty_xpbd_push(ty_xpbd* x, int number, ty_vec3 force); // N, from now on

int ty_xpbd_body_count(const ty_xpbd* x);
int ty_xpbd_particle_count(const ty_xpbd* x);
int ty_xpbd_first_particle(const ty_xpbd* x, int body);
ty_vec3 ty_xpbd_position(const ty_xpbd* x, int number);
ty_vec3 ty_xpbd_velocity(const ty_xpbd* x, int number);

// One substep of 1/rate. Equal bits for any worker count.
void ty_xpbd_step(ty_xpbd* x, ty_workers* workers);

// Squeezes the container towards center, a point within or at its surface, to these shares of its extents: 1 = as made.
void ty_xpbd_squeeze(ty_xpbd* x, ty_vec3 center, ty_vec3 share);
void ty_xpbd_lid(ty_xpbd* x, float height); // a wall that keeps everything below; infinity = none

// The frame of a body: where its element stands, and how far it is bent, sheared and flattened.
// frame maps the element's coordinates (at its own size) to the world; rotation is the rigid part of it.
void ty_xpbd_frame(const ty_xpbd* x, int body, ty_body* rigid, ty_affine* frame);

// Sums over all particles; the rest by definition of the constraints.
// J: kinetic and of gravity; with elastic also of springs, shapes, volumes and contacts. What a hit leaves in springs
// that are stiff against 1/rate^2 counts in full there, though the next substep takes it away.
double ty_xpbd_energy(const ty_xpbd* x, bool elastic);
ty_vec3 ty_xpbd_momentum(const ty_xpbd* x);                        // kg m/s
ty_vec3 ty_xpbd_spin(const ty_xpbd* x);                            // kg m^2/s, about the origin
float ty_xpbd_volume(const ty_xpbd* x, int body);                  // m^3 within the triangles
void ty_xpbd_speeds(const ty_xpbd* x, float* rms, float* largest); // m/s
