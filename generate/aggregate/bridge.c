// SPDX-License-Identifier: Apache-2.0
// Cohesion of a pile: bridges of water after Willett et al. 2000 and the adhesion of starch, as pulls in the warm
// start. The contact's own impulse then grows by what they pull, so that friction holds with it.
#include "contact_place.h"

#define DRY 0.35f       // wet basis up to which all water is within the grains
#define SATURATED 0.76f // wet basis at which water fills the space between cooked grains at a packing of .6
#define CAPILLARY 0.75f // degree of saturation from which bridges flow together
#define FULL 0.02f      // volume of a bridge, of the cube of the radius, from a degree of saturation of PENDULAR
#define PENDULAR 0.3f

ty_bridge_def ty_bridge_def_default(void)
{
    return (ty_bridge_def){.density = 1100.0f};
}

static float saturation_of(float wet_basis)
{
    return ty_clamp((wet_basis - DRY) / (SATURATED - DRY), 0.0f, 1.0f);
}

ty_bridge_def ty_bridge_of_moisture(float wet_basis)
{
    ty_bridge_def def = ty_bridge_def_default();
    float saturation = saturation_of(wet_basis);
    def.volume = FULL * ty_min(1.0f, saturation / PENDULAR);
    def.tension = saturation > 0.0f ? 0.072f * ty_min(1.0f, (1.0f - saturation) / (1.0f - CAPILLARY)) : 0.0f;
    return def;
}

float ty_bridge_strength(float wet_basis)
{
    float saturation = saturation_of(wet_basis);
    return ty_min(ty_min(1.0f, saturation / PENDULAR), (1.0f - saturation) / (1.0f - CAPILLARY));
}

float ty_bridge_end(const ty_bridge_def* def, float radius)
{
    return (1.0f + 0.5f * def->angle) * ty_pow(def->volume, 1.0f / 3.0f) * radius;
}

float ty_bridge_pull(const ty_bridge_def* def, float radius, float mean_radius, float gap)
{
    if (def->volume <= 0.0f)
        return 0.0f;
    float s = ty_max(0.0f, gap) * sqrtf(mean_radius / (def->volume * radius * radius * radius));
    return 2.0f * TY_PI * mean_radius * def->tension * ty_cos(def->angle) / (1.0f + 1.05f * s + 2.5f * s * s);
}

float ty_adhesion_force(const ty_bridge_def* def, float mean_radius, float gap)
{
    float share = ty_clamp(1.0f - gap / PILE_TIGHT, 0.0f, 1.0f);
    return 0.75f * TY_PI * def->adhesion * mean_radius * share;
}

void pile_bridge_init(ty_pile* pile)
{
    const ty_bridge_def* def = &pile->def.bridge;
    pile->cohesive = (def->tension > 0.0f && def->volume > 0.0f) || def->adhesion > 0.0f;
    pile->margin = PILE_MARGIN;
    float largest = 0.0f;
    for (int i = 0; i < pile->def.grain_count; i++)
        for (int k = 0; k < pile->def.grains[i].ball_count; k++)
            largest = ty_max(largest, pile->def.grains[i].balls[k].radius);
    if (pile->cohesive)
        pile->margin = ty_max(PILE_MARGIN, 1.2f * ty_bridge_end(def, largest));
}

// The touch of a pair that is nearest, without a bound on its gap.
static bool nearest_place(const ty_pile* pile, const pair* p, contact* nearest)
{
    nearest->gap = TY_FLOAT_MAX;
    for (int i = p->first; i < p->first + p->count; i++)
    {
        contact c = {.touch = i};
        if (pile_contact_place(pile, p, &pile->near.touches[i], nearest->gap, &c))
            *nearest = c;
    }
    return nearest->gap < TY_FLOAT_MAX;
}

void pile_bridge_prepare(ty_pile* pile, pair* p, bool touching)
{
    const ty_bridge_def* def = &pile->def.bridge;
    contact* c = &pile->contacts[p->slot + p->active];
    p->bridged |= touching;
    if ((!p->bridged && p->active == 0) || !nearest_place(pile, p, c))
        return;
    const touch* t = &pile->near.touches[c->touch];
    float a = pile_balls(pile, p->a)[t->a].radius, b = p->b >= 0 ? pile_balls(pile, p->b)[t->b].radius : TY_FLOAT_MAX;
    float radius = ty_min(a, b), mean = 2.0f * a / (1.0f + a / b); // 2 a b / (a + b); of a wall 2 a
    if (c->gap > ty_bridge_end(def, radius))
        p->bridged = false;
    float force = ty_adhesion_force(def, mean, c->gap);
    if (p->bridged)
        force += ty_bridge_pull(def, radius, mean, c->gap);
    c->normal_impulse = -force / (def->density * pile->mean_volume * pile->def.rate);
    c->tangent_impulse = ty_vec3_make(0.0f, 0.0f, 0.0f);
    p->pulled = force > 0.0f;
}
