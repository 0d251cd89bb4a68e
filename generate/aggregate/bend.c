// SPDX-License-Identifier: Apache-2.0
// Bodies of a pile that are no longer what their elements were made as: stretched, sheared, still rigid.
#include "pile_state.h"
#include <string.h>

static ty_affine symmetric_matrix(const float s[6], float unit)
{
    return (ty_affine){{unit * s[0], unit * s[3], unit * s[4]},
                       {unit * s[3], unit * s[1], unit * s[5]},
                       {unit * s[4], unit * s[5], unit * s[2]},
                       {0.0f, 0.0f, 0.0f}};
}

static ty_affine transposed(const ty_affine* m)
{
    return (ty_affine){
        {m->x.x, m->y.x, m->z.x}, {m->x.y, m->y.y, m->z.y}, {m->x.z, m->y.z, m->z.z}, {0.0f, 0.0f, 0.0f}};
}

static float trace(const ty_affine* m)
{
    return m->x.x + m->y.y + m->z.z;
}

// tr(m) 1 - m: from inertia I to the second moment C = tr(I) / 2 - I (half: .5), and back (1).
static ty_affine trace_less(const ty_affine* m, float half)
{
    float t = half * trace(m);
    return (ty_affine){{t - m->x.x, -m->x.y, -m->x.z},
                       {-m->y.x, t - m->y.y, -m->y.z},
                       {-m->z.x, -m->z.y, t - m->z.z},
                       {0.0f, 0.0f, 0.0f}};
}

// Of the element as it is bent, mass kept: C -> B C B^T. Scaled by the trace meanwhile, against overflow.
static void inertia_bend(const float made[6], const ty_affine* map, float out[6])
{
    float unit = made[0] + made[1] + made[2];
    ty_affine inverse = symmetric_matrix(made, 1.0f / unit), inertia, back = transposed(map);
    memcpy(out, made, 6 * sizeof *out);
    if (!ty_affine_invert(&inverse, &inertia))
        return;
    ty_affine moment = trace_less(&inertia, 0.5f);
    moment = ty_affine_multiply(map, &moment);
    moment = ty_affine_multiply(&moment, &back);
    inertia = trace_less(&moment, 1.0f);
    if (!ty_affine_invert(&inertia, &inverse))
        return;
    const float bent[6] = {inverse.x.x, inverse.y.y, inverse.z.z, inverse.x.y, inverse.x.z, inverse.y.z};
    for (int i = 0; i < 6; i++)
        out[i] = unit * bent[i];
}

// A bound of the largest stretch: the square root of the norms by columns and by rows.
static float stretch_most(const ty_affine* m)
{
    ty_affine t = transposed(m);
    float norms[2] = {0.0f, 0.0f};
    const ty_affine* of[2] = {m, &t};
    for (int k = 0; k < 2; k++)
    {
        const ty_vec3 columns[3] = {of[k]->x, of[k]->y, of[k]->z};
        for (int i = 0; i < 3; i++)
            norms[k] = ty_max(norms[k], fabsf(columns[i].x) + fabsf(columns[i].y) + fabsf(columns[i].z));
    }
    return sqrtf(norms[0] * norms[1]);
}

bend pile_bend_none(const ty_element* element)
{
    bend b = {.map = ty_affine_identity(), .mean = 1.0f, .most = 1.0f};
    memcpy(b.inverse_inertia, element->inverse_inertia, sizeof b.inverse_inertia);
    return b;
}

void ty_pile_bend(ty_pile* pile, int body, const ty_affine* map)
{
    if (!pile->bends)
    {
        pile->bends = TY_ALLOC(bend, pile->capacity);
        for (int i = 0; i < pile->count; i++)
            pile->bends[i] = pile_bend_none(&pile->def.grains[pile->bodies[i].grain]);
    }
    bend* b = &pile->bends[body];
    const ty_element* element = &pile->def.grains[pile->bodies[body].grain];
    b->map = *map;
    b->map.t = ty_vec3_make(0.0f, 0.0f, 0.0f);
    b->mean = ty_pow(fabsf(ty_affine_determinant(map)), 1.0f / 3.0f);
    b->most = ty_max(stretch_most(map), b->mean);
    inertia_bend(element->inverse_inertia, map, b->inverse_inertia);
    pile->max_radius = ty_max(pile->max_radius, element->radius * pile->bodies[body].scale * b->most);
    pile_refresh(pile, body);
    pile->stale = true;
}

ty_affine ty_pile_frame(const ty_pile* pile, int i)
{
    const ty_body* body = &pile->bodies[i];
    float size = body->scale * pile->growth;
    ty_affine frame = pile_frame_of(body->position, body->rotation, size);
    return pile->bends ? ty_affine_multiply(&frame, &pile->bends[i].map) : frame;
}

bool ty_pile_is_bent(const ty_pile* pile)
{
    return pile->bends != NULL;
}
