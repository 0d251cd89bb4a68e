// SPDX-License-Identifier: Apache-2.0
// How dense a filling can be: its elements shrink until they find room.
#include "pile_state.h"
#include "start.h"

static void project(ty_pile* pile, const ty_fill_top* top, int sweeps, ty_workers* workers)
{
    pile->lid = top;
    for (int k = 0; k < sweeps && !ty_cancel_requested(); k++)
    {
        if (k % 8 == 0)
        {
            pile_refresh_all(pile, workers);
            pile_detect(pile, PILE_MARGIN, workers);
        }
        pile_project(pile, workers);
    }
    pile->lid = NULL;
    pile_refresh_all(pile, workers);
    pile_detect(pile, PILE_MARGIN, workers);
}

float ty_pile_fit(ty_pile* pile, const ty_fill_top* top, int sweeps, ty_workers* workers)
{
    ty_pile_metrics metrics;
    ty_pile_measure(pile, &metrics, NULL);
    while (metrics.overlap_mean > TY_PILE_PACKED && pile->growth > 0.3f)
    {
        pile->growth *= 0.99f;
        project(pile, top, sweeps, workers);
        ty_pile_measure(pile, &metrics, NULL);
    }
    float size = pile->growth;
    pile->growth = 1.0f;
    pile_refresh_all(pile, workers);
    pile->stale = true;
    return size;
}
