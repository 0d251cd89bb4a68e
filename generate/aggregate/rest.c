// SPDX-License-Identifier: Apache-2.0
// When a pile is at rest, who sleeps until then, and a settling that is held and goes on.
#include "pile_state.h"

#define CALM_RMS 0.3e-3f  // m/s
#define CALM_MAX 1.7e-3f  // m/s
#define CALM_AFTER 0.09f  // s
#define SLEEP_AFTER 0.12f // s since the start

static int lost_remove(ty_pile* pile)
{
    bool* gone = TY_ALLOC(bool, pile->count);
    int lost = 0;
    for (int i = 0; i < pile->count && pile->def.container; i++)
    {
        gone[i] = ty_container_lost(pile->def.container, pile_in_wall(pile, 0, pile->bodies[i].position));
        lost += gone[i];
    }
    if (lost > 0)
        ty_pile_remove(pile, gone);
    ty_free(gone);
    return lost;
}

static int sleepers_count(const ty_pile* pile)
{
    int count = 0;
    for (int i = 0; i < pile->count; i++)
        count += pile->motions[i].asleep;
    return count;
}

// Those who slept are noted, for a settling that goes on.
static void all_wake(ty_pile* pile)
{
    for (int i = 0; i < pile->count; i++)
    {
        bool asleep = pile->motions[i].asleep;
        if (asleep)
            pile_body_wake(pile, i);
        pile->motions[i].slept = asleep;
    }
}

bool ty_pile_speeds_are_calm(float rms, float largest)
{
    return rms < CALM_RMS && largest < CALM_MAX;
}

bool ty_pile_is_calm(const ty_pile* pile)
{
    float rms, largest;
    ty_pile_speeds(pile, &rms, &largest);
    return ty_pile_speeds_are_calm(rms, largest) && pile->time > CALM_AFTER;
}

// One check: counts calm ones in a row. While few bodies move the others may sleep; when all do, or none moves for
// long, everybody wakes and the count begins again: rest is found with all of them awake.
static void rest_check(ty_pile* pile, int* calm)
{
    bool is_calm = ty_pile_is_calm(pile);
    int sleepers = sleepers_count(pile);
    *calm = is_calm ? *calm + 1 : 0;
    if (sleepers > 0 && (sleepers == pile->count || *calm >= TY_PILE_CALM_CHECKS))
    {
        all_wake(pile);
        pile->may_sleep = false;
        *calm = 0;
    }
    else if (!is_calm)
        pile->may_sleep = pile->time > SLEEP_AFTER;
}

// From the substep after `settled` on, with so many calm checks in a row.
static ty_pile_end settle(ty_pile* pile, int settled, int calm, float max_seconds, ty_workers* workers, int* lost)
{
    int interval = (int)(TY_PILE_CHECK_TIME * pile->def.rate + 0.5f), steps = (int)(max_seconds * pile->def.rate);
    int out = 0, k = settled + 1;
    ty_pile_end end = TY_PILE_TIME;
    pile->pause.held = false;
    for (; k <= steps && end == TY_PILE_TIME; k++)
    {
        pile_substep(pile, workers);
        if (k % interval == 0)
        {
            out = lost_remove(pile);
            rest_check(pile, &calm);
            end = out > 0 ? TY_PILE_LOST : calm >= TY_PILE_CALM_CHECKS ? TY_PILE_REST : end;
        }
        if (end == TY_PILE_TIME && ty_cancel_requested())
            end = TY_PILE_CANCELED;
    }
    if (end != TY_PILE_LOST) // else one goes on with those asleep that are
    {
        pile->pause = (pile_pause){true, end == TY_PILE_REST, pile->may_sleep, k - 1, calm};
        pile->may_sleep = false;
        all_wake(pile);
    }
    if (lost)
        *lost = out;
    return end;
}

ty_pile_end ty_pile_settle(ty_pile* pile, float max_seconds, ty_workers* workers, int* lost)
{
    return settle(pile, 0, 0, max_seconds, workers, lost);
}

ty_pile_end ty_pile_settle_on(ty_pile* pile, float max_seconds, ty_workers* workers, int* lost)
{
    pile_pause pause = pile->pause;
    if (lost)
        *lost = 0;
    if (!pause.held)
        return ty_pile_settle(pile, max_seconds, workers, lost);
    if (pause.rested)
        return TY_PILE_REST;
    for (int i = 0; i < pile->count; i++)
        if (pile->motions[i].slept)
            pile_body_sleep(&pile->motions[i]);
    pile->may_sleep = pause.may_sleep;
    return settle(pile, pause.settled, pause.calm, max_seconds, workers, lost);
}
