// SPDX-License-Identifier: Apache-2.0
// A host and the net of centre lines that has grown on it.
#pragma once
#include "base/cmocka_all.h"
#include "roots.h"

static inline roots_host host_of(const ty_roots_recipe* recipe)
{
    roots_host host;
    ty_error error = {0};
    if (roots_host_init(recipe, NULL, NULL, &host, &error) != TY_OK)
        fail_msg("%s", error.text);
    return host;
}

typedef struct grown
{
    roots_host host;
    roots_network net;
} grown;

static inline void grow(const ty_roots_recipe* recipe, ty_workers* workers, grown* out)
{
    ty_error error = {0};
    ty_status status = roots_host_init(recipe, NULL, workers, &out->host, &error);
    if (status == TY_OK)
        status = roots_grow(recipe, &out->host, workers, &out->net, &error);
    if (status != TY_OK)
        fail_msg("%s", error.text);
}

static inline void drop(grown* g)
{
    roots_network_term(&g->net);
    roots_host_term(&g->host);
}
