// SPDX-License-Identifier: Apache-2.0
// Rigid grains of balls under gravity: fill a space, settle with friction until at rest, polish overlaps away.
#pragma once
#include <tsuya/base/file.h>
#include <tsuya/generate/container.h>
#include <tsuya/generate/element.h>

// What pulls grains together. All zero but the density: nothing does.
typedef struct ty_bridge_def
{
    float tension;  // N/m, of the liquid between the grains, >= 0
    float angle;    // rad, of contact, 0..pi/2
    float volume;   // of a bridge, of the cube of the smaller ball's radius, 0..0.1
    float adhesion; // J/m^2, work of adhesion of sticky surfaces (starch), >= 0
    float density;  // kg/m^3, of the grains: gravity against it, > 0
} ty_bridge_def;

ty_bridge_def ty_bridge_def_default(void); // dry, cooked rice
// Of the grains' water, kg of water a kg in all: none up to .35, where all of it is within them; falls to none from
// three quarters of saturation on, as bridges flow together (Rungjiratananon et al. 2008).
ty_bridge_def ty_bridge_of_moisture(float wet_basis);
// How much of what can hold wet grains together does so, 0..1: rises and falls in the same bounds.
float ty_bridge_strength(float wet_basis);
// N at a gap of two balls with the harmonic mean radius 2 ab / (a + b) and the smaller radius given, metres (Willett
// et al. 2000), without regard to its rupture at (1 + angle / 2) V^(1/3).
float ty_bridge_pull(const ty_bridge_def* def, float radius, float mean_radius, float gap);
float ty_bridge_end(const ty_bridge_def* def, float radius);
// Pull-off force of Johnson, Kendall & Roberts 1971, which fades out over the first .03 mm.
float ty_adhesion_force(const ty_bridge_def* def, float mean_radius, float gap);

typedef struct ty_pile_def
{
    ty_vec3 gravity;          // m/s^2
    float friction;           // Coulomb coefficient, grains and walls alike, >= 0
    float rolling;            // rolling resistance, of half the mean width, >= 0
    float rate;               // substeps per second, 500..20000
    const ty_element* grains; // borrowed, must outlive the pile
    int grain_count;
    const ty_container* container; // borrowed; NULL = no walls
    ty_bridge_def bridge;
} ty_pile_def;

ty_pile_def ty_pile_def_default(void); // no grains, no walls

typedef struct ty_body
{
    ty_vec3 position; // m, of the centre of mass
    ty_quat rotation;
    ty_vec3 velocity; // m/s
    ty_vec3 spin;     // rad/s, world
    float scale;      // of the grain's own size
    uint32_t grain;   // index into the def's grains
} ty_body;

// The upper surface of a fill: level + crown * (1 - (x/rx)^2 - (z/rz)^2), or the product of both factors over a box.
typedef struct ty_fill_top
{
    float level, crown;       // m; crown >= 0
    float radius_x, radius_z; // m
    bool turned;
} ty_fill_top;

typedef struct ty_pile ty_pile; // opaque; one thread at a time drives it

// Copies def. The bodies keep their order: it is the identity of a result.
ty_pile* ty_pile_create(const ty_pile_def* def);
void ty_pile_destroy(ty_pile* pile); // NULL is allowed
void ty_pile_add(ty_pile* pile, const ty_body* bodies, int count);
void ty_pile_remove(ty_pile* pile,
                    const bool* gone); // [count]; the others keep their order and their contacts' impulses
int ty_pile_count(const ty_pile* pile);
const ty_body* ty_pile_bodies(const ty_pile* pile); // borrowed until the next change

float ty_fill_top_height(const ty_fill_top* top, ty_vec3 p); // of the surface above p, m

// Grows all bodies from half their size within the walls and below top, and pushes overlaps apart; velocities end at 0.
// Fill by inflation: Sakurai & Miyata 2014 in purpose, position projection (Macklin et al. 2014) in means.
void ty_pile_inflate(ty_pile* pile, const ty_fill_top* top, int sweeps, ty_workers* workers);

// Where a wall of the container is: a turn about the container's origin, then a shift; and how both change.
typedef struct ty_wall_motion
{
    ty_vec3 position; // m
    ty_quat rotation;
    ty_vec3 velocity; // m/s, of the container's origin
    ty_vec3 spin;     // rad/s, about it
} ty_wall_motion;

// Called for each wall once a substep, with the pile's time. Position and velocity must agree with each other.
typedef ty_wall_motion ty_wall_motion_fn(void* context, int wall, float seconds);
// From now on the walls move: nobody sleeps, and contacts take the wall's own velocity into account. NULL = they stand
// where the container has them. Fill before they move.
void ty_pile_move_walls(ty_pile* pile, ty_wall_motion_fn* fn, void* context);
// Other walls from now on; NULL = none. What bodies had from the walls before is forgotten. Borrowed as the def's.
void ty_pile_set_container(ty_pile* pile, const ty_container* container);
float ty_pile_time(const ty_pile* pile);      // s, all substeps so far
ty_vec3 ty_pile_gravity(const ty_pile* pile); // m/s^2, as it pulls by now: it comes up over the first .05 s

// One substep of 1/rate: soft contacts by sequential impulses that are kept from substep to substep, then a sweep
// without bias ("relax", Catto's soft step), friction, rolling resistance. Equal bits for any worker count.
void ty_pile_step(ty_pile* pile, ty_workers* workers);

// Rest is when speeds are calm, rms of the balls < .3 mm/s and none at 1.7 mm/s, at three checks in a row.
#define TY_PILE_CHECK_TIME 0.02f // s, between two checks
enum
{
    TY_PILE_CALM_CHECKS = 3,
};
bool ty_pile_speeds_are_calm(float rms, float largest);
bool ty_pile_is_calm(const ty_pile* pile); // once the pile has moved for .09 s, as gravity comes up first
void ty_pile_speeds(const ty_pile* pile, float* rms, float* largest); // of the balls, m/s

typedef enum ty_pile_end
{
    TY_PILE_REST,     // as many checks in a row were calm
    TY_PILE_TIME,     // max_seconds have passed
    TY_PILE_LOST,     // bodies fell over the rim and were taken out: go on after putting others in
    TY_PILE_CANCELED, // ty_cancel_requested
} ty_pile_end;

// Steps until at rest. Bodies lost over the rim are taken out and counted in *lost (NULL is allowed).
ty_pile_end ty_pile_settle(ty_pile* pile, float max_seconds, ty_workers* workers, int* lost);

// Goes on with a settling that ended by time or was canceled as if it had not, up to max_seconds from its begin; one
// that ended at rest stays at rest. After any other change to the pile it is ty_pile_settle.
ty_pile_end ty_pile_settle_on(ty_pile* pile, float max_seconds, ty_workers* workers, int* lost);

// All that the next substep and those after it depend on, but def and what moves the walls; of a pile whose bodies have
// changed their size since a substep found them anew, nearly all. The caller frees *out.
TY_CHECKED ty_status ty_pile_save(const ty_pile* pile, ty_bytes* out, ty_error* error);
// Into a new pile of the same def without bodies, whose walls move already if they do: what follows is, to the bit,
// what follows after the save. On failure (TY_BAD_FILE: damaged, or of another pile) there may be bodies: destroy it.
TY_CHECKED ty_status ty_pile_restore(ty_pile* pile, const void* bytes, size_t size, ty_workers* workers,
                                     ty_error* error);

// Projects overlaps away without velocities: for display; keep a copy of the bodies to go on from.
void ty_pile_polish(ty_pile* pile, int sweeps, ty_workers* workers);
void ty_pile_set_bodies(ty_pile* pile, const ty_body* bodies); // count as it is
// Bodies that grow or shrink where they are, by little each time: what they have is kept, contacts push apart what grew
// into each other. scales: [count].
void ty_pile_resize(ty_pile* pile, const float* scales);
void ty_pile_set_bridge(ty_pile* pile, const ty_bridge_def* bridge); // copied

// From now on the body is its element as map bends it within the element's own frame, before size and turn: balls move
// with it and grow by its mean stretch, the inertia follows, the mass stays. map's shift is not used.
void ty_pile_bend(ty_pile* pile, int body, const ty_affine* map);
bool ty_pile_is_bent(const ty_pile* pile);              // some body has been
ty_affine ty_pile_frame(const ty_pile* pile, int body); // element to world, with size and bend

typedef struct ty_pile_metrics
{
    int count;
    int floating;       // neither at a wall nor held at three points by two neighbours, gaps up to 2 % of the width;
                        // where grains stick to each other, one point holds
    float contacts;     // neighbours that touch, gaps up to 1 um, per grain, mean
    float loaded;       // those that press on it by over a hundredth of a mean grain's weight, per grain, mean
    float neighbours;   // those with gaps up to 2 % of the width, per grain, mean
    float overlap_max;  // of the mean width
    float overlap_mean; // over the pairs in contact
    float speed_rms;    // m/s, of the balls
    float speed_max;
    float phi;       // volume share of the grains' own meshes below the surface, 0 where the pile is too small to tell
    float phi_balls; // the same of the union of their balls
    int substeps;    // so far
} ty_pile_metrics;

// held (NULL is allowed): [count], false for floating bodies.
void ty_pile_measure(ty_pile* pile, ty_pile_metrics* out, bool* held);

// Sum of all bodies' momentum, unit masses of a mean grain: for tests of conservation.
ty_vec3 ty_pile_momentum(const ty_pile* pile);
// Distance below the pile's own upper surface, 0 at the top, per body: depth[count], m.
void ty_pile_depth(const ty_pile* pile, float* depth);
