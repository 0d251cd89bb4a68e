// SPDX-License-Identifier: Apache-2.0
// A body of a pile carried into the balls and the inertia that contacts are made of.
#include "pile_state.h"

// R J R^T for the rotation r.
static void inertia_to_world(const float body[6], const ty_affine* r, float factor, float out[6])
{
    ty_vec3 x = {r->x.x, r->y.x, r->z.x}, y = {r->x.y, r->y.y, r->z.y}, z = {r->x.z, r->y.z, r->z.z}; // rows
    ty_vec3 jx = ty_symmetric_times(body, x), jy = ty_symmetric_times(body, y), jz = ty_symmetric_times(body, z);
    out[0] = factor * ty_dot(x, jx), out[1] = factor * ty_dot(y, jy), out[2] = factor * ty_dot(z, jz);
    out[3] = factor * ty_dot(x, jy), out[4] = factor * ty_dot(x, jz), out[5] = factor * ty_dot(y, jz);
}

void pile_refresh(ty_pile* pile, int i)
{
    const ty_body* body = &pile->bodies[i];
    const ty_element* grain = &pile->def.grains[body->grain];
    ty_affine turned = pile_frame_of(body->position, body->rotation, 1.0f);
    float size = body->scale * pile->growth;
    pose* at = &pile->poses[i];
    at->frame = turned;
    at->frame.x = ty_mul(turned.x, size);
    at->frame.y = ty_mul(turned.y, size);
    at->frame.z = ty_mul(turned.z, size);
    const float* inverse_inertia = grain->inverse_inertia;
    float stretch = size;
    if (pile->bends)
    {
        at->frame = ty_affine_multiply(&at->frame, &pile->bends[i].map);
        inverse_inertia = pile->bends[i].inverse_inertia;
        stretch *= pile->bends[i].mean;
    }
    ty_ball* balls = pile_balls(pile, i);
    for (int k = 0; k < grain->ball_count; k++)
        balls[k] = (ty_ball){ty_map_point(&at->frame, grain->balls[k].center), grain->balls[k].radius * stretch};
    motion* m = &pile->motions[i];
    m->inverse_mass = pile->mean_volume / (grain->volume * body->scale * body->scale * body->scale);
    inertia_to_world(inverse_inertia, &turned, m->inverse_mass / (size * size), m->inverse_inertia);
}
