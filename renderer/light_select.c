// SPDX-License-Identifier: Apache-2.0
// Choosing one of the lights that light an object.
#include "light.h"
#include <string.h>
#include <tsuya/base/memory.h>

enum
{
    FEW = 4,       // up to so many, choosing by power costs less than looking where they are
    LINEAR = 16,   // up to so many, counting up costs less than bisecting
    FEW_SHAPES = 8 // up to so many, a ray is tried against each
};

// Least share of those with a place and of those without where there are both: the tree's bound can be far off.
#define LEAST_SHARE 0.1f

// Probabilities: three quarters by power, one quarter evenly, so that a near weak light is not starved by a far strong
// one.
static void fill_table(ty_light_selection* s)
{
    double total = 0.0, sum = 0.0;
    for (int i = 0; i < s->chosen_count; ++i)
        total += (double)s->probability[s->chosen[i]];
    for (int i = 0; i < s->chosen_count; ++i)
    {
        float* p = &s->probability[s->chosen[i]];
        *p = (float)(0.75 * (double)*p / total + 0.25 / s->chosen_count);
        sum += (double)*p;
        s->cumulative[i] = (float)sum;
    }
}

static void add_to_table(ty_light_selection* s, int emitter, float weight)
{
    s->probability[emitter] = isfinite(weight) ? weight : TY_FLOAT_MAX;
    s->chosen[s->chosen_count++] = emitter;
}

static int count_lit(const ty_light_set* set, const bool* lit, float scene_radius)
{
    int count = 0, emitters = set->light_count + set->mesh_count;
    for (int i = 0; i < emitters; ++i)
        count += (!lit || lit[i]) && ty_light_power(set, i, scene_radius) > 0.0f;
    return count;
}

// What rays can meet of the list of lights.
static void list_met(ty_light_selection* s, const ty_light_set* set, const bool* lit)
{
    s->shapes = TY_ALLOC(int, set->light_count);
    s->skies = TY_ALLOC(int, set->light_count);
    ty_light_node* leaves = TY_ALLOC(ty_light_node, set->light_count);
    for (int i = 0; i < set->light_count; ++i)
    {
        const ty_light* light = &set->lights[i];
        if (lit && !lit[i])
            continue;
        if (ty_light_is_shape(light))
        {
            (void)ty_light_leaf(set, i, &leaves[s->shape_count]);
            leaves[s->shape_count].child = (uint32_t)i;
            s->shapes[s->shape_count++] = i;
        }
        else if (light->kind == TY_LIGHT_ENVIRONMENT || light->kind == TY_LIGHT_SKY ||
                 (light->kind == TY_LIGHT_DIRECTIONAL && light->one_minus_cos > 0.0f))
        {
            s->skies[s->sky_count++] = i;
            s->shadowless_skies = s->shadowless_skies || !light->shadows;
        }
    }
    if (s->shape_count > FEW_SHAPES)
        s->shaping = ty_light_tree_create(leaves, s->shape_count, set->light_count);
    ty_free(leaves);
}

void ty_light_selection_init(ty_light_selection* s, const ty_light_set* set, const bool* lit, float scene_radius)
{
    int emitters = set->light_count + set->mesh_count, leaf_count = 0;
    int lit_count = count_lit(set, lit, scene_radius);
    bool few = lit_count <= FEW || set->scene->render.light_choice == TY_LIGHT_CHOICE_POWER;
    *s = (ty_light_selection){.probability = TY_ALLOC(float, emitters)};
    s->chosen = TY_ALLOC(int, few ? lit_count : set->light_count);
    s->cumulative = TY_ALLOC(float, few ? lit_count : set->light_count);
    list_met(s, set, lit);
    ty_light_node* leaves = TY_ALLOC(ty_light_node, emitters);
    for (int i = 0; i < emitters; ++i)
    {
        float power = ty_light_power(set, i, scene_radius);
        if ((lit && !lit[i]) || !(power > 0.0f))
            continue;
        if (few)
            add_to_table(s, i, power);
        else if (ty_light_leaf(set, i, &leaves[leaf_count]))
            leaves[leaf_count++].child = (uint32_t)i;
        else
        {
            add_to_table(s, i, ty_light_irradiance(&set->lights[i]));
            s->endless += s->probability[i];
        }
    }
    fill_table(s);
    s->tree = ty_light_tree_create(leaves, leaf_count, emitters);
    s->only = s->chosen_count == 1 && !s->tree ? s->chosen[0] : -1;
    ty_free(leaves);
}

void ty_light_selection_term(ty_light_selection* s)
{
    ty_free(s->chosen);
    ty_free(s->cumulative);
    ty_free(s->probability);
    ty_free(s->shapes);
    ty_free(s->skies);
    ty_light_tree_destroy(s->tree);
    ty_light_tree_destroy(s->shaping);
}

// The first of 0 .. last whose cumulative value is above u; last if there is none.
static int bisect(const float* cumulative, int last, double u)
{
    int low = 0, high = last;
    while (low < high)
    {
        int middle = (low + high) / 2;
        if (u >= (double)cumulative[middle])
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static int choose_of_table(const ty_light_selection* s, double u, float* probability, double* rest)
{
    int i = 0, last = s->chosen_count - 1;
    if (last < LINEAR)
        while (i < last && u >= (double)s->cumulative[i])
            ++i;
    else
        i = bisect(s->cumulative, last, u);
    double before = i ? (double)s->cumulative[i - 1] : 0.0, width = (double)s->cumulative[i] - before;
    *rest = width > 0.0 ? (u - before) / width : 0.5;
    *rest = *rest < 0.0 ? 0.0 : *rest < 1.0 ? *rest : (double)TY_ONE_MINUS_EPSILON;
    *probability = s->probability[s->chosen[i]];
    return s->chosen[i];
}

// Probability of choosing among those without a place.
static float endless_share(const ty_light_selection* s, const ty_light_point* at)
{
    if (s->chosen_count == 0)
        return 0.0f;
    if (!s->tree)
        return 1.0f;
    float near = ty_light_node_importance(&s->tree->nodes[0], at->position, at->normal);
    return ty_clamp(s->endless / (s->endless + near), LEAST_SHARE, 1.0f - LEAST_SHARE);
}

int ty_light_select(const ty_light_set* set, const ty_light_point* at, double u, float* probability, double* rest)
{
    const ty_light_selection* s = &set->selections[at->link];
    float share = endless_share(s, at);
    *rest = u;
    if (u < (double)share)
    {
        int emitter = choose_of_table(s, u / (double)share, probability, rest);
        *probability *= share;
        return emitter;
    }
    if (!s->tree)
        return -1;
    *rest = (u - (double)share) / (1.0 - (double)share);
    int emitter = ty_light_tree_sample(s->tree, at->position, at->normal, rest, probability);
    *probability *= 1.0f - share;
    return emitter;
}

float ty_light_select_probability(const ty_light_set* set, const ty_light_point* at, int emitter)
{
    const ty_light_selection* s = &set->selections[at->link];
    if (emitter == s->only)
        return 1.0f;
    float share = endless_share(s, at);
    if (s->probability[emitter] > 0.0f)
        return share * s->probability[emitter];
    return s->tree ? (1.0f - share) * ty_light_tree_probability(s->tree, at->position, at->normal, emitter) : 0.0f;
}
