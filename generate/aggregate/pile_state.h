// SPDX-License-Identifier: Apache-2.0
// The inside of a pile: bodies, candidate contacts with the impulses they keep, contacts of the substep.
#pragma once
#include "candidates.h"
#include <tsuya/generate/pile.h>

enum
{
    PILE_WALL = -1,
    PILE_LID = 31,    // wall number of the lid during a fill
    PILE_PIECE = 256, // bodies that are shared at a time
};

#define PILE_TIGHT 0.03e-3f // m, gaps up to here are contacts of the substep
#define PILE_GAP_UNIT 8e-6f // m
#define PILE_GAP_MOST 255
#define PILE_MARGIN 0.3e-3f // m, least reach of a body for candidates; new ones when a ball moved .45 of its reach

// What the solver needs of a body, one cache line.
typedef struct motion
{
    ty_vec3 v, w;
    float inverse_mass;
    float inverse_inertia[6]; // world, with the mass: xx yy zz xy xz yz
    float load;               // sum of normal impulses in the relax sweep
    uint16_t quiet;           // substeps below the sleeping speed
    bool asleep;              // stands still with infinite mass until something hits it
    bool woken;
    bool slept; // when the settling was held
} motion;

// A candidate: ball of the pair's first body against a ball of the second, or against a wall.
typedef struct touch
{
    uint8_t a, b;
    uint8_t gap;          // PILE_GAP_UNITs when candidates were found, rounded down; the largest for all beyond
    float normal_impulse; // kept across substeps
    ty_vec3 tangent_impulse;
} touch;

typedef struct pair
{
    int a, b; // bodies, a < b; b = PILE_WALL
    int first;
    int slot; // of its contacts in this substep
    uint16_t count;
    uint16_t active; // contacts in this substep; behind them the pull, if there is one
    uint8_t gap;     // the least of its touches
    bool loaded;     // its touches may hold impulses
    bool bridged;    // by liquid, since they touched
    bool pulled;     // in this substep
} pair;

// Pairs and their touches, block by block; walls after all others.
typedef struct candidates
{
    pair* pairs;
    int pair_count, pair_capacity, wall_first;
    int* places; // [pair_count] in pairs, by ascending (a, b), walls after all others
    int place_capacity;
    touch* touches;
    int touch_count, touch_capacity;
} candidates;

typedef struct contact
{
    ty_vec3 normal; // towards body a
    ty_vec3 arm_a, arm_b;
    float gap;
    float normal_weight; // sum of inverse effective masses along the normal
    float tangent_mass;  // 1 / largest eigenvalue of the tangential one
    float normal_impulse;
    ty_vec3 tangent_impulse;
    int touch;
} contact;

typedef struct moving_wall
{
    ty_wall_motion now, seen; // seen: when candidates were last found
    float farthest;           // m, of the bodies from its origin, then
} moving_wall;

typedef struct pose
{
    ty_affine frame; // body to world, with the size
    ty_vec3 seen;    // position and rotation when candidates were last found
    ty_quat seen_rotation;
    float reach;  // m, candidates lie within the mean of two bodies' reaches; faster bodies reach farther
    float moved;  // m, a ball of it at most since candidates were found
    float travel; // m, a ball of it at most in this substep, as fast as it begins it
} pose;

// How a body differs from its element as made.
typedef struct bend
{
    ty_affine map;            // of the element's own frame
    float mean;               // stretch of a ball's radius
    float most;               // no length grows by more
    float inverse_inertia[6]; // per unit mass, as of the element
} bend;

// Where a settling ended, until something else is done to the pile.
typedef struct pile_pause
{
    bool held;      // it can go on
    bool rested;    // it ended at rest
    bool may_sleep; // as it was
    int settled;    // substeps of it
    int calm;       // checks in a row
} pile_pause;

// What the next substep reads, and what follows from it for those to come, is saved by pile_save.c.
struct ty_pile
{
    ty_pile_def def;
    float mean_volume, mean_width, max_radius;
    float* solid; // [grains], volume of the mesh over that of the union of its balls; NULL until it is asked for
    float margin; // m, for candidates of a settling pile: at least as far as a bridge reaches
    bool cohesive;
    float growth;           // common size factor, below 1 during a fill
    const ty_fill_top* lid; // during a fill
    ty_body* bodies;
    bend* bends; // NULL = all are as their elements are made
    pose* poses;
    motion* motions;
    ty_vec3* rolls;  // impulses of rolling resistance that are kept, in the world
    ty_ball* balls;  // world, body by body
    int* ball_first; // [count + 1], of each body in balls
    int ball_capacity;
    int count, capacity;
    candidates near, former; // former: those before, for the impulses that are kept
    pair_blocks blocks;      // of near
    contact* contacts;
    int contact_capacity;
    ty_wall_motion_fn* wall_fn;
    void* wall_context;
    moving_wall* walls; // NULL = they stand still
    bool stale;         // candidates must be found again
    bool may_sleep;     // bodies at rest are left out while a few still move
    float resized;      // m, by which balls have come nearer by their sizes since candidates were found
    pile_pause pause;
    float time; // s since the start
    int substeps;
};

static inline ty_ball* pile_balls(const ty_pile* pile, int body)
{
    return pile->balls + pile->ball_first[body];
}

// Turned and scaled to a size, then shifted: as ty_affine_from_trs, in half its steps.
static inline ty_affine pile_frame_of(ty_vec3 t, ty_quat q, float size)
{
    float twice = 2.0f * size, x = twice * q.x, y = twice * q.y, z = twice * q.z;
    float xx = x * q.x, yy = y * q.y, zz = z * q.z, xy = x * q.y, xz = x * q.z, yz = y * q.z;
    float wx = x * q.w, wy = y * q.w, wz = z * q.w;
    return (ty_affine){{size - (yy + zz), xy + wz, xz - wy},
                       {xy - wz, size - (xx + zz), yz + wx},
                       {xz + wy, yz - wx, size - (xx + yy)},
                       t};
}

// By how much a body reaches farther than its element.
static inline float pile_bent_reach(const ty_pile* pile, int body)
{
    return pile->bends ? pile->bends[body].most : 1.0f;
}

// m, about its centre.
static inline float pile_radius(const ty_pile* pile, int body)
{
    const ty_body* b = &pile->bodies[body];
    return pile->def.grains[b->grain].radius * b->scale * pile->growth * pile_bent_reach(pile, body);
}

static inline int pile_ball_count(const ty_pile* pile, int body)
{
    return pile->ball_first[body + 1] - pile->ball_first[body];
}

// pile.c
void pile_each_body(ty_pile* pile, ty_workers* workers, ty_range_fn* fn, void* context); // ranges of PILE_PIECE
void pile_turn(ty_body* body, ty_vec3 rotation_vector);

// pile_body.c
void pile_refresh(ty_pile* pile, int body); // frame, balls and inertia from position and rotation

// bend.c
bend pile_bend_none(const ty_element* element);

// wall.c
float pile_wall(const ty_pile* pile, int wall, ty_vec3 p, ty_vec3* normal);
int pile_moving_walls(const ty_pile* pile);                           // how many
void pile_walls_place(ty_pile* pile);                                 // where they are at this time
void pile_walls_see(ty_pile* pile);                                   // candidates are about to be found
bool pile_walls_moved(const ty_pile* pile);                           // too far for the candidates
ty_vec3 pile_in_wall(const ty_pile* pile, int wall, ty_vec3 p);       // world to the container's own frame
ty_vec3 pile_wall_velocity(const ty_pile* pile, int wall, ty_vec3 p); // m/s

// detect.c
// Candidates within margin, in blocks, with kept impulses. Equal bits for any worker count.
void pile_detect(ty_pile* pile, float margin, ty_workers* workers);
// A ball may have moved more than .45 of its body's reach. Notes how far those of each have.
bool pile_moved(ty_pile* pile, ty_workers* workers);

// contact.c: the same lists again from bodies that stand where they were then, with the reaches that are noted
void pile_detect_again(ty_pile* pile, ty_workers* workers);

// settle.c
void pile_substep(ty_pile* pile, ty_workers* workers);
void pile_body_wake(ty_pile* pile, int body);
void pile_body_sleep(motion* m);

// impulse.c
void pile_contacts_prepare(ty_pile* pile, ty_workers* workers); // those of the substep, with the kept impulses' kick
void pile_contacts_solve(ty_pile* pile, ty_workers* workers);
void pile_contacts_relax(ty_pile* pile, ty_workers* workers);

// bridge.c
void pile_bridge_init(ty_pile* pile);
void pile_bridge_prepare(ty_pile* pile, pair* p, bool touching); // the pull of a pair, behind its contacts

// polish.c
void pile_project(ty_pile* pile, ty_workers* workers); // one sweep of position corrections
void pile_refresh_all(ty_pile* pile, ty_workers* workers);

// packing.c
void pile_packing(ty_pile* pile, ty_pile_metrics* out); // phi and phi_balls
