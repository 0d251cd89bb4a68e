// SPDX-License-Identifier: Apache-2.0
// The walls of a pile: the container's, which may move, and the lid of a fill.
#include "pile_state.h"

// The lid's distance to first order, from the height and its slope.
static float lid_wall(const ty_fill_top* top, ty_vec3 p, ty_vec3* normal)
{
    const float d = 1e-4f;
    float y = ty_fill_top_height(top, p);
    float sx = (ty_fill_top_height(top, ty_vec3_make(p.x + d, p.y, p.z)) - y) / d;
    float sz = (ty_fill_top_height(top, ty_vec3_make(p.x, p.y, p.z + d)) - y) / d;
    ty_vec3 n = {sx, -1.0f, sz};
    float length = ty_length(n);
    *normal = ty_mul(n, 1.0f / length);
    return (y - p.y) / length;
}

ty_vec3 pile_in_wall(const ty_pile* pile, int wall, ty_vec3 p)
{
    if (!pile->walls)
        return p;
    const ty_wall_motion* m = &pile->walls[wall].now;
    ty_quat back = {-m->rotation.x, -m->rotation.y, -m->rotation.z, m->rotation.w};
    return ty_quat_rotate(back, ty_sub(p, m->position));
}

float pile_wall(const ty_pile* pile, int wall, ty_vec3 p, ty_vec3* normal)
{
    if (wall == PILE_LID)
        return lid_wall(pile->lid, p, normal);
    float distance = ty_container_wall(pile->def.container, wall, pile_in_wall(pile, wall, p), normal);
    if (pile->walls)
        *normal = ty_quat_rotate(pile->walls[wall].now.rotation, *normal);
    return distance;
}

ty_vec3 pile_wall_velocity(const ty_pile* pile, int wall, ty_vec3 p)
{
    if (!pile->walls || wall == PILE_LID)
        return ty_vec3_make(0.0f, 0.0f, 0.0f);
    const ty_wall_motion* m = &pile->walls[wall].now;
    return ty_add(m->velocity, ty_cross(m->spin, ty_sub(p, m->position)));
}

int pile_moving_walls(const ty_pile* pile)
{
    return pile->walls ? ty_container_wall_count(pile->def.container) : 0;
}

void pile_walls_place(ty_pile* pile)
{
    for (int w = 0; w < pile_moving_walls(pile); w++)
        pile->walls[w].now = pile->wall_fn(pile->wall_context, w, pile->time);
}

void pile_walls_see(ty_pile* pile)
{
    for (int w = 0; w < pile_moving_walls(pile); w++)
    {
        moving_wall* wall = &pile->walls[w];
        wall->seen = wall->now;
        wall->farthest = 0.0f;
        for (int i = 0; i < pile->count; i++)
            wall->farthest = ty_max(wall->farthest, ty_length(ty_sub(pile->bodies[i].position, wall->now.position)));
        wall->farthest += pile->max_radius;
    }
}

// As of a body: an angle is at most 2.1 times the distance of its quaternions.
bool pile_walls_moved(const ty_pile* pile)
{
    for (int w = 0; w < pile_moving_walls(pile); w++)
    {
        const moving_wall* wall = &pile->walls[w];
        ty_quat p = wall->now.rotation, q = wall->seen.rotation;
        float turn = ty_sqr(p.x - q.x) + ty_sqr(p.y - q.y) + ty_sqr(p.z - q.z) + ty_sqr(p.w - q.w);
        float shift = ty_length(ty_sub(wall->now.position, wall->seen.position));
        if (shift + 2.1f * wall->farthest * sqrtf(turn) > 0.45f * pile->margin)
            return true;
    }
    return false;
}

void ty_pile_move_walls(ty_pile* pile, ty_wall_motion_fn* fn, void* context)
{
    ty_free(pile->walls);
    pile->walls = NULL;
    pile->pause.held = false;
    pile->wall_fn = fn;
    pile->wall_context = context;
    if (fn && pile->def.container)
        pile->walls = TY_ALLOC(moving_wall, ty_container_wall_count(pile->def.container));
    pile_walls_place(pile);
    pile->stale = true;
}

void ty_pile_set_container(ty_pile* pile, const ty_container* container)
{
    pile->def.container = container;
    pile->near.pair_count = pile->near.wall_first;
    ty_pile_move_walls(pile, NULL, NULL);
}

float ty_pile_time(const ty_pile* pile)
{
    return pile->time;
}

float ty_fill_top_height(const ty_fill_top* top, ty_vec3 p)
{
    float x = ty_sqr(p.x / top->radius_x), z = ty_sqr(p.z / top->radius_z);
    float share = top->turned ? 1.0f - x - z : ty_max(0.0f, 1.0f - x) * ty_max(0.0f, 1.0f - z);
    return top->level + top->crown * ty_max(0.0f, share);
}
