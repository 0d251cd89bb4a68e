// SPDX-License-Identifier: Apache-2.0
// What a file tells of its aggregate, and how far a pile at rest moves when one goes on to watch it.
#include "kit.h"
#include "start.h"
#include <string.h>

// Farthest move of a ball of the body, m.
static float body_drift(const ty_element* grain, const ty_body* from, const ty_body* to)
{
    float farthest = 0.0f;
    for (int k = 0; k < grain->ball_count; k++)
    {
        ty_vec3 arm = ty_mul(grain->balls[k].center, from->scale);
        ty_vec3 turned = ty_sub(ty_quat_rotate(to->rotation, arm), ty_quat_rotate(from->rotation, arm));
        farthest = ty_max(farthest, ty_length(ty_add(turned, ty_sub(to->position, from->position))));
    }
    return farthest;
}

ty_body* kit_polish(kit* k, ty_pile_metrics* before, ty_pile_metrics* after, bool* held)
{
    int count = ty_pile_count(k->pile);
    ty_body* moving = TY_ALLOC(ty_body, count);
    memcpy(moving, ty_pile_bodies(k->pile), (size_t)count * sizeof *moving);
    ty_pile_measure(k->pile, before, NULL);
    ty_pile_polish(k->pile, k->recipe->settle.polish, k->workers);
    ty_pile_measure(k->pile, after, held);
    after->speed_rms = before->speed_rms;
    after->speed_max = before->speed_max;
    return moving;
}

void kit_watch(kit* k, const ty_body* rest)
{
    int count = ty_pile_count(k->pile), steps = (int)(k->recipe->settle.watch * k->recipe->settle.rate);
    if (steps < 1 || count < 1)
        return;
    ty_body* shown = TY_ALLOC(ty_body, count);
    memcpy(shown, ty_pile_bodies(k->pile), (size_t)count * sizeof *shown);
    ty_pile_set_bodies(k->pile, rest);
    for (int i = 0; i < steps && !ty_cancel_requested(); i++)
        ty_pile_step(k->pile, k->workers);
    double sum = 0.0;
    for (int i = 0; i < count; i++)
    {
        const ty_element* grain = &k->mix.grains[rest[i].grain];
        float drift = body_drift(grain, &rest[i], &ty_pile_bodies(k->pile)[i]) / k->mix.width;
        sum += (double)drift;
        k->drift_max = ty_max(k->drift_max, drift);
    }
    k->drift_mean = (float)(sum / count);
    ty_pile_set_bodies(k->pile, shown);
    ty_free(shown);
}

static char* drift_write(const kit* k)
{
    if (k->recipe->settle.watch <= 0.0f)
        return ty_string_format("%s", "");
    return ty_string_format("\"watched_s\": %g, \"drift_mean_percent\": %.5f, \"drift_max_percent\": %.4f, ",
                            (double)k->recipe->settle.watch, (double)k->drift_mean * 100.0,
                            (double)k->drift_max * 100.0);
}

static char* mould_write(const kit* k)
{
    if (!k->ground)
        return ty_string_format("%s", "");
    return ty_string_format("\"released_height_mm\": %.3f, \"height_mm\": %.3f, ", (double)k->released * 1e3,
                            (double)k->stood * 1e3);
}

static char* mechanics_write(const kit* k)
{
    const ty_mechanics* m = &k->mechanics;
    char* state = m->given ? ty_string_format("\"wet_basis\": %.4f, \"cooked\": %.4f, \"swelling\": %.4f, ",
                                              (double)m->state.wet_basis, (double)m->state.cooked, (double)m->swelling)
                           : ty_string_format("%s", "");
    char* text = ty_string_format("%s\"modulus_kPa\": %.4g, \"cohesion_N_m\": %.4g, \"adhesion_J_m2\": %.4g, ", state,
                                  (double)m->modulus * 1e-3, (double)m->bridge.tension, (double)m->bridge.adhesion);
    ty_free(state);
    return text;
}

char* kit_metrics(const kit* k, const ty_pile_metrics* m)
{
    static const char* const starts[] = {"inflate", "thesis", "lattice", "pour"};
    float repeat = ty_pile_repeat(ty_pile_bodies(k->pile), ty_pile_count(k->pile), k->mix.width);
    const ty_pile_metrics* settled = k->settled.count > 0 ? &k->settled : m;
    char *drift = drift_write(k), *mould = mould_write(k), *mechanics = mechanics_write(k);
    char* text = ty_string_format(
        "{\"count\": %d, \"phi\": %.4f, \"phi_balls\": %.4f, \"contacts\": %.3f, \"loaded\": %.3f, \"neighbours\": "
        "%.3f, "
        "\"floating\": %d, \"overlap_max_percent\": %.4f, \"overlap_mean_percent\": %.5f, "
        "\"settled_overlap_max_percent\": %.4f, \"settled_overlap_mean_percent\": %.5f, "
        "\"speed_rms_mm_s\": %.4f, \"speed_max_mm_s\": %.4f, %s%s%s\"rest\": %s, \"substeps\": %d, \"lost\": %d, "
        "\"replaced\": %d, \"level_mm\": %.3f, \"crown_mm\": %.3f, \"start\": \"%s\", \"removed\": %d, "
        "\"start_overlap_max_percent\": %.4f, \"start_overlap_mean_percent\": %.5f, \"start_repeat_percent\": %.3f, "
        "\"repeat_percent\": %.3f}",
        m->count, (double)m->phi, (double)m->phi_balls, (double)settled->contacts, (double)settled->loaded,
        (double)m->neighbours, m->floating, (double)m->overlap_max * 100.0, (double)m->overlap_mean * 100.0,
        (double)settled->overlap_max * 100.0, (double)settled->overlap_mean * 100.0, (double)m->speed_rms * 1e3,
        (double)m->speed_max * 1e3, drift, mould, mechanics, k->rest ? "true" : "false", m->substeps, k->lost,
        k->replaced, (double)k->top.level * 1e3, (double)k->top.crown * 1e3, starts[k->recipe->fill.start], k->removed,
        (double)k->start.overlap_max * 100.0, (double)k->start.overlap_mean * 100.0, (double)k->start_repeat * 100.0,
        (double)repeat * 100.0);
    ty_free(drift);
    ty_free(mould);
    ty_free(mechanics);
    return text;
}
