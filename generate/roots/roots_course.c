// SPDX-License-Identifier: Apache-2.0
// Where tips want to go: towards the ground, by chance, away from others and from what is in the way, and back to the
// course that each has about the host. All is smooth and a function of place, so that small changes stay small.
#include "roots_march.h"
#include <tsuya/base/noise.h>

#define SLOPE 0.2f // of the course that a root winds along, per octave and weight of chance
#define WIND 2.0f  // how far it winds, of half the way from root to root

static const ty_vec3 down = {0.0f, -1.0f, 0.0f};

// --- where others are ---

static uint32_t cell_hash(int x, int y, int z)
{
    uint32_t h = ty_mix32((uint32_t)x) ^ ty_mix32((uint32_t)y * 3u + 1u) ^ ty_mix32((uint32_t)z * 5u + 2u);
    return ty_mix32(h) % MARCH_CELLS;
}

void course_pass(march* m, int whose, float way)
{
    ty_vec3 p = m->tips[whose].p;
    if (m->trace_count == m->trace_capacity)
    {
        int capacity = m->trace_capacity ? 2 * m->trace_capacity : 4096;
        m->traces = ty_grow(m->traces, (size_t)m->trace_capacity, (size_t)capacity, sizeof(trace));
        m->trace_capacity = capacity;
    }
    ty_vec3 q = ty_mul(p, 1.0f / m->cell);
    int cell[3] = {(int)floorf(q.x), (int)floorf(q.y), (int)floorf(q.z)};
    int* head = &m->heads[cell_hash(cell[0], cell[1], cell[2])];
    m->traces[m->trace_count] = (trace){p, way, whose, *head, {cell[0], cell[1], cell[2]}};
    *head = m->trace_count++;
}

// Away from the roots that are near, below 1: an integral over their ways, whatever the steps. To which side is settled
// by whose plane comes first about the host: two that meet head on would part by what else happens.
static ty_vec3 repulsion(const march* m, int own, ty_vec3 p)
{
    ty_vec3 across = m->tips[own].across, ahead = {across.z, 0.0f, -across.x};
    bool lanes = m->g->recipe->growth.repel > 0.0f;
    ty_vec3 q = ty_mul(p, 1.0f / m->cell), sum = {0.0f, 0.0f, 0.0f};
    int low[3] = {(int)floorf(q.x) - 1, (int)floorf(q.y) - 1, (int)floorf(q.z) - 1};
    for (int c = 0; c < 27; c++)
    {
        const int at[3] = {low[0] + c % 3, low[1] + c / 3 % 3, low[2] + c / 9};
        for (int i = m->heads[cell_hash(at[0], at[1], at[2])]; i >= 0; i = m->traces[i].next)
        {
            const trace* one = &m->traces[i];
            if (one->tip == own || one->cell[0] != at[0] || one->cell[1] != at[1] || one->cell[2] != at[2])
                continue;
            ty_vec3 away = ty_sub(p, one->p);
            float d = ty_length(away), side = ty_dot(m->tips[one->tip].across, ahead);
            if (d >= m->cell || d <= 0.0f)
                continue;
            float near = one->way * ty_sqr(1.0f - d / m->cell);
            if (lanes && fabsf(side) > 1e-3f)
                sum = ty_mad(sum, across, side > 0.0f ? near : -near);
            else
                sum = ty_mad(sum, away, near / d);
        }
    }
    sum = ty_mul(sum, 2.0f / m->g->recipe->radius);
    return ty_mul(sum, 1.0f / sqrtf(1.0f + ty_length_sqr(sum)));
}

// --- chance and course ---

// Chance at a place of a plane over some octaves from `wave` radii on: each is much the same over a wave and,
// where there are several, as high as that is long. Octaves are fixed ones, the first and the last with shares that
// follow from the wave: it changes little anywhere with the radius.
float course_chance(const march* m, const tip* t, int which, int octaves, float x, float y)
{
    const ty_roots_recipe* recipe = m->g->recipe;
    float octave = ty_ln(1.1f * recipe->growth.wave * recipe->radius) / ty_ln(2.0f), below = floorf(octave);
    float part = octave - below, wave = ty_exp(ty_ln(2.0f) * below), sum = 0.0f;
    for (int k = 0; k <= octaves; k++, wave *= 2.0f)
    {
        uint32_t seed = (uint32_t)ty_mix64(recipe->seed.value ^ t->key ^ (uint64_t)((int)below + k + 64) << 32);
        float value = ty_value_noise(ty_vec3_make(x / wave, y / wave, 0.5f + 13.0f * (float)which), seed);
        sum += (k == 0 ? 1.0f - part : k == octaves ? part : 1.0f) * value * (octaves > 1 ? wave : 1.0f);
    }
    return sum;
}

// Chance by how far down and out a place is. What a tip meets does not shift it against the host, as it would by the
// way, and all that pass there do alike.
static float place_chance(const march* m, const tip* t, ty_vec3 p, int which, int octaves)
{
    ty_vec3 away = ty_sub(p, m->foot);
    return course_chance(m, t, which, octaves, sqrtf(away.x * away.x + away.z * away.z), away.y);
}

// How far p is off the tip's own course, m: a sheet about its plane, which winds as far as the next root's.
static float off_course(const march* m, const tip* t, ty_vec3 p)
{
    float aside = SLOPE * m->g->recipe->growth.wander * place_chance(m, t, p, 2, 3), most = WIND * m->wide;
    aside /= sqrtf(1.0f + ty_sqr(aside / most));
    return ty_dot(ty_sub(p, m->foot), t->across) - aside;
}

// Horizontally away from the foot of the trunk.
ty_vec3 course_outwards(const march* m, ty_vec3 p)
{
    ty_vec3 away = ty_sub(p, m->foot);
    away.y = 0.0f;
    float length = ty_length(away);
    return length > 1e-9f ? ty_mul(away, 1.0f / length) : (ty_vec3){0.0f, 0.0f, 0.0f};
}

// Back to its own course, the more the farther off it is: what turns two courses of a root apart is undone again.
static ty_vec3 homewards(const march* m, const tip* t)
{
    if (m->g->recipe->growth.keep <= 0.0f || ty_length_sqr(t->across) <= 0.0f)
        return (ty_vec3){0.0f, 0.0f, 0.0f};
    float off = off_course(m, t, t->p) / m->wide, ahead = off_course(m, t, ty_mad(t->p, t->t, t->r)) / m->wide;
    float pull = off / sqrtf(1.0f + off * off) + (ahead - off) * m->wide / t->r;
    return ty_mul(t->across, -m->g->recipe->growth.keep * pull);
}

// What is painted on the host, felt over some radii.
static ty_vec3 painted(const march* m, const tip* t)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    const roots_host* host = m->g->host;
    ty_vec3 sum = {0.0f, 0.0f, 0.0f}, g;
    const float weights[ROOTS_MASKS] = {[ROOTS_AVOID] = -def->avoid, [ROOTS_ATTRACT] = def->attract};
    for (int k = 0; k < ROOTS_MASKS; k++)
    {
        roots_host_mask(host, (roots_mask)k, t->p, &g);
        g = ty_mul(g, 6.0f * t->r);
        sum = ty_mad(sum, g, weights[k] / ty_max(ty_length(g), 1.0f));
    }
    return ty_mul(sum, 1.0f + def->keep); // it prevails over a root's own course
}

// Round obstacles: from as far as it takes to turn, a tip that heads for one goes past it on the side that it leans to,
// or by its own hand where it would meet it head on. Nothing outweighs this where it is as near as it may be.
static ty_vec3 past(const march* m, const tip* t, ty_vec3 n)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    ty_vec3 away, none = {0.0f, 0.0f, 0.0f};
    float over = roots_host_clear(m->g->host, t->p, &away) - def->clear * t->r, reach = 1.5f * def->stiffness * t->r;
    if (over > reach || ty_length_sqr(away) <= 0.0f)
        return none;
    away = ty_normalize(away);
    float near = ty_smoothstep(ty_clamp(1.0f - over / reach, 0.0f, 1.0f)), ahead = ty_max(-ty_dot(t->t, away), 0.0f);
    ty_vec3 side = ty_cross(n, away);
    float width = ty_length(side), lean = ty_dot(t->t, side) + (t->key & 2 ? 0.3f : -0.3f) * width;
    float least = ty_clamp(1.0f - 2.0f * over / (def->clear * t->r), 0.0f, 1.0f);
    ty_vec3 force = ty_mul(away, 4.0f * near * ahead + 2.0f * least);
    return ty_mad(force, side, 4.0f * near * ahead * lean / sqrtf(lean * lean + 0.01f));
}

// Out of the way of obstacles.
void course_clear(const march* m, tip* t)
{
    ty_vec3 g;
    float lack = m->g->recipe->growth.clear * t->r - roots_host_clear(m->g->host, t->p, &g);
    if (lack > 0.0f && ty_length_sqr(g) > 0.0f)
        t->p = ty_mad(t->p, ty_normalize(g), ty_min(lack, 0.5f * t->r));
}

// Down through the air, plumb soon; what hangs from a root first gets clear of the host's side.
static ty_vec3 fall(const march* m, const tip* t)
{
    ty_vec3 n, force = ty_mul(down, 4.0f * m->g->recipe->growth.gravity);
    if (t->kind != ROOTS_AERIAL)
        return force;
    float near = ty_clamp(2.5f - 0.5f * roots_host_value(m->g->host, t->p, &n) / t->r, 0.0f, 1.0f);
    n.y = 0.0f;
    return ty_mad(force, n, 6.0f * m->g->recipe->growth.gravity * near);
}

// What turns a tip, over a radius times its stiffness: across n where it holds on to the host.
ty_vec3 course_force(const march* m, int index, bool holds, ty_vec3 n)
{
    const ty_roots_growth_def* def = &m->g->recipe->growth;
    const tip* t = &m->tips[index];
    ty_vec3 side = ty_cross(holds ? n : t->n, t->t), away = course_outwards(m, t->p);
    side = ty_length(side) > 1e-3f ? ty_normalize(side) : (ty_vec3){0.0f, 0.0f, 0.0f};
    float level = holds ? ty_sqr(ty_max(n.y, 0.0f)) : 0.0f, wander = (holds ? 1.0f : 0.3f) * def->wander;
    ty_vec3 force = holds ? ty_mul(down, def->gravity) : fall(m, t);
    force = ty_mad(force, side, wander * place_chance(m, t, t->p, 0, 1));
    if (!holds)
        force = ty_mad(force, ty_cross(t->t, side), wander * place_chance(m, t, t->p, 1, 1));
    force = ty_mad(force, away, def->gravity * level); // where down says nothing
    float back = ty_max(-ty_dot(t->t, away), 0.0f);    // it comes about by one and the same hand
    force = ty_mad(force, side, (t->key & 1 ? def->gravity : -def->gravity) * level * back);
    if (holds && def->repel != 0.0f)
        force = ty_mad(force, repulsion(m, index, t->p), def->repel);
    force = ty_add(force, ty_add(homewards(m, t), ty_add(painted(m, t), past(m, t, holds ? n : t->n))));
    return holds ? growth_without(force, n) : force;
}
