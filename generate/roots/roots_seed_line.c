// SPDX-License-Identifier: Apache-2.0
// What all steps of the thesis' method use: balls against the host, curves, lines of the network.
#include "roots_seed.h"

bool seed_meets(const seed_run* run, ty_vec3 p)
{
    const roots_host* host = run->g->host;
    float about = roots_host_value(host, p, NULL), near = 2.0f * host->field.step;
    if (fabsf(about - run->r) > near)
        return about < run->r;
    ty_vec3 n;
    return roots_host_exact(host, p, run->r + 2.0f * near, &n) < run->r;
}

ty_vec3 seed_bezier(const ty_vec3* c, float t)
{
    ty_vec3 a = ty_lerp3(c[0], c[1], t), b = ty_lerp3(c[1], c[2], t), d = ty_lerp3(c[2], c[3], t);
    return ty_lerp3(ty_lerp3(a, b, t), ty_lerp3(b, d, t), t);
}

int seed_add_line(const seed_run* run, roots_line line, const ty_vec3* places, int count, float s)
{
    roots_network* net = run->g->network;
    line.first = net->point_count;
    line.count = count;
    for (int i = 0; i < count; i++)
    {
        ty_vec3 n, t = ty_sub(places[i + 1 < count ? i + 1 : i], places[i > 0 ? i - 1 : i]);
        roots_host_value(run->g->host, places[i], &n);
        t = ty_length_sqr(t) > 0.0f ? ty_normalize(t) : (ty_vec3){0.0f, -1.0f, 0.0f};
        n = growth_without(n, t);
        n = ty_length_sqr(n) > 1e-6f ? ty_normalize(n) : ty_frame_from_normal(t).t;
        s += i > 0 ? ty_length(ty_sub(places[i], places[i - 1])) : 0.0f;
        const roots_point point = {.p = places[i], .n = n, .r = run->r, .flat = 1.0f, .s = s};
        roots_network_add_point(net, &point);
    }
    net->grown[line.kind] += line.kind == ROOTS_MAIN || line.end >= 0;
    return roots_network_add_line(net, &line);
}
