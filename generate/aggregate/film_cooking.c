// SPDX-License-Identifier: Apache-2.0
// Rice that is soaked, cooked and left to stand in the frames of a film: grains grow and shrink in the settling pile.
#include "film.h"

#define FASTEST 0.05f // of a length, growth in a second of the pile

// All minutes pass between the first frame and the last.
static float minute_at(const film* f, double moment)
{
    const ty_animate_def* a = &f->k->recipe->animate;
    double whole = (double)a->soak + (double)a->cook + (double)a->stand;
    double share = a->frames > 1 ? moment / (a->frames - 1) : 0.0;
    return (float)(whole * (share < 1.0 ? share : 1.0));
}

static float wet_basis_of(const film* f, float minute, int body)
{
    return cooking_wet_basis(f->k->cooking, minute, f->rice.moisture[body], f->rice.exposed[body]);
}

// Off the fire water holds the grains together; in it nothing does.
static void film_stand(film* f, float minute)
{
    kit* k = f->k;
    if (minute <= k->cooking->soak + k->cooking->cook)
        return;
    if (!f->rice.stands)
    {
        ty_pile_depth(k->pile, f->rice.exposed);
        for (int i = 0; i < ty_pile_count(k->pile); i++)
            f->rice.exposed[i] = ty_exp(-f->rice.exposed[i] / k->mix.length);
        ty_bridge_def bridge = ty_bridge_of_state(cooking_state(k->cooking, minute));
        ty_pile_set_bridge(k->pile, &bridge);
    }
    f->rice.stands = true;
}

// Rice is as large as its water makes it.
void film_cook(film* f)
{
    kit* k = f->k;
    float minute = minute_at(f, f->moment);
    film_stand(f, minute);
    const ty_body* bodies = ty_pile_bodies(k->pile);
    for (int i = 0; i < ty_pile_count(k->pile); i++)
    {
        bool rice = k->mix.kinds[k->mix.kind_of[bodies[i].grain]].def.kind == TY_ELEMENT_RICE;
        float swelling = rice ? ty_moisture_swelling(wet_basis_of(f, minute, i)) / f->rice.raw : 1.0f;
        f->rice.grown[i] = f->rice.sizes[i] * swelling;
    }
    ty_pile_resize(k->pile, f->rice.grown);
}

// By as much as the driest rice changes, which is what lies at the surface.
static float change_of(const film* f, int frame)
{
    float from = cooking_wet_basis(f->k->cooking, minute_at(f, frame - 2), 0.0f, 1.0f);
    float to = cooking_wet_basis(f->k->cooking, minute_at(f, frame - 1), 0.0f, 1.0f);
    return fabsf(ty_moisture_swelling(to) / ty_moisture_swelling(from) - 1.0f);
}

// Minutes pass in a second of film, so that a pile has all the time it needs.
int64_t film_rice_steps(const film* f, int frame, int64_t least)
{
    int64_t needed = (int64_t)(change_of(f, frame) / FASTEST * f->k->recipe->settle.rate);
    return needed > least ? needed : least;
}

void film_rice_show(film* f)
{
    kit* k = f->k;
    float minute = minute_at(f, f->moment);
    ty_moisture state = cooking_state(k->cooking, minute);
    float* wet_basis = ty_aggregate_add_attribute(f->first, "wet_basis");
    float* cooked = ty_aggregate_add_attribute(f->first, "cooked");
    float* pores = ty_aggregate_add_attribute(f->first, "pore_area");
    float area = 1e12f * cooking_pore_area(k->cooking, minute); // um^2
    for (uint32_t i = 0; i < f->first->instance_count; i++)
    {
        wet_basis[i] = wet_basis_of(f, minute, (int)k->owners[i]);
        cooked[i] = state.cooked;
        pores[i] = area;
    }
    k->mechanics.state = state; // for the metrics
    k->mechanics.swelling = ty_moisture_swelling(state.wet_basis);
}

void film_rice_init(film* f)
{
    int count = ty_pile_count(f->k->pile);
    f->rice.sizes = TY_ALLOC(float, count);
    f->rice.grown = TY_ALLOC(float, count);
    f->rice.exposed = TY_ALLOC(float, count);
    f->rice.moisture = ty_aggregate_find_attribute(f->first, "moisture")->values;
    f->rice.raw = f->k->mechanics.swelling;
    for (int i = 0; i < count; i++)
        f->rice.sizes[i] = ty_pile_bodies(f->k->pile)[i].scale;
    film_cook(f); // chance makes some wetter than others from the start: that settles before the first frame
    for (int i = (int)(0.2f * f->k->recipe->settle.rate); i > 0 && !ty_cancel_requested(); i--)
        ty_pile_step(f->k->pile, f->k->workers);
}

void film_rice_term(film* f)
{
    ty_free(f->rice.sizes);
    ty_free(f->rice.grown);
    ty_free(f->rice.exposed);
}
