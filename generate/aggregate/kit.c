// SPDX-License-Identifier: Apache-2.0
// What all stages of the making of an aggregate share: its pile, new bodies, interruption.
#include "kit.h"
#include <tsuya/base/workers.h>

static ty_status container_check(const kit* k, ty_error* error)
{
    ty_bounds b = ty_container_interior(k->container);
    ty_vec3 size = ty_sub(b.high, b.low);
    float least = 2.0f * ty_container_widest(k->container), most = ty_max(size.x, ty_max(size.y, size.z));
    float width = k->mix.widest, length = k->mix.longest;
    if (least >= 1.5f * width && most >= 1.5f * length)
        return TY_OK;
    return ty_error_set(
        error, TY_BAD_INPUT,
        "container: its inside is %.3g x %.3g x %.3g mm; grains of %.3g x %.3g mm need at least %.3g by "
        "%.3g mm",
        (double)size.x * 1e3, (double)size.y * 1e3, (double)size.z * 1e3, (double)length * 1e3, (double)width * 1e3,
        (double)length * 1.5e3, (double)width * 1.5e3);
}

ty_status kit_pile(kit* k, ty_error* error)
{
    ty_status status = mixture_init(k->recipe, &k->mix, error);
    if (status == TY_OK)
        status = ty_container_create(&k->recipe->container, k->workers, &k->container, error);
    for (int layer = k->recipe->layers.count; layer >= 0 && status == TY_OK; layer--)
    {
        mixture_select(&k->mix, layer); // layer 0 in the end
        status = container_check(k, error);
    }
    if (status != TY_OK)
        return status;
    ty_pile_def def = ty_pile_def_default();
    def.friction = k->recipe->settle.friction;
    def.rolling = k->recipe->settle.rolling;
    def.rate = k->recipe->settle.rate;
    def.bridge = k->mechanics.bridge;
    def.grains = k->mix.grains;
    def.grain_count = k->mix.grain_count;
    def.container = k->container;
    k->pile = ty_pile_create(&def);
    return TY_OK;
}

static ty_quat rotation_draw(const ty_fill_def* fill, float steepest, ty_rng* rng)
{
    ty_quat heading = ty_quat_axis_angle(ty_vec3_make(0.0f, 1.0f, 0.0f), ty_rng_range(rng, 0.0f, 2.0f * TY_PI));
    float sine = ty_rng_range(rng, -1.0f, 1.0f) * ty_sin(steepest); // even over the sphere at a tilt of 90 degrees
    ty_quat tilt = ty_quat_axis_angle(ty_vec3_make(0.0f, 0.0f, 1.0f), 0.5f * TY_PI - ty_acos(sine));
    ty_quat roll = ty_quat_axis_angle(ty_vec3_make(1.0f, 0.0f, 0.0f), ty_rng_range(rng, -1.0f, 1.0f) * fill->roll);
    return ty_quat_multiply(heading, ty_quat_multiply(tilt, roll));
}

ty_body kit_body(kit* k, ty_vec3 position, float steepest)
{
    ty_body body = {.position = position, .rotation = rotation_draw(k->fill, steepest, &k->rng)};
    mixture_draw(&k->mix, &k->rng, &body);
    return body;
}

void kit_stir(kit* k, ty_body* bodies, const bool* held)
{
    float speed = sqrtf(2.0f * 9.81f * k->mix.width);
    for (int i = 0; i < ty_pile_count(k->pile); i++)
    {
        ty_vec3 push;
        push.x = speed * ty_element_bell(&k->rng);
        push.y = speed * ty_element_bell(&k->rng);
        push.z = speed * ty_element_bell(&k->rng);
        if (!held[i])
            bodies[i].velocity = push;
    }
    ty_pile_set_bodies(k->pile, bodies);
}

ty_status kit_interrupted(const char* what, ty_error* error)
{
    return ty_cancel_requested() ? ty_error_set(error, TY_INTERRUPTED, "interrupted while %s", what) : TY_OK;
}

void kit_layer_select(kit* k, int layer)
{
    mixture_select(&k->mix, layer);
    k->layer = layer;
    k->fill = layer > 0 ? &kit_layer_def(k->recipe, layer)->fill : &k->recipe->fill;
}
