// SPDX-License-Identifier: Apache-2.0
// How well a network has come about, by the same measures for both methods: what failed, kinks, and how deep centre
// lines lie in the host.
#include "roots_output.h"

enum
{
    PIECES = 4, // of a segment, looked at for its depth
};

typedef struct verdict
{
    int branches, failed, broken, kinked; // first and second
    float deepest;                        // m under its height over the host, of the radius
    double length, held;                  // m, all and within two radii of host or floor
} verdict;

#define KINK 100.0f // degrees, within a line
#define NEAR 2.0f   // radii over the host that count as held

static float bend_of(const roots_point* p)
{
    ty_vec3 u = ty_sub(p[-1].p, p->p), v = ty_sub(p[1].p, p->p);
    return ty_atan2(ty_length(ty_cross(u, v)), ty_dot(u, v)) * (180.0f * TY_INV_PI);
}

static bool kinks(const roots_network* net, const roots_line* line)
{
    for (int i = line->first + 1; i + 1 < line->first + line->count; i++)
        if (bend_of(&net->points[i]) < KINK)
            return true;
    return false;
}

// It ends farther than its radius from what it should have grown into.
static bool breaks(const roots_network* net, const roots_line* line)
{
    const roots_point* last = &net->points[line->first + line->count - 1];
    return line->end < 0 || ty_length(ty_sub(last->p, net->points[line->end_point].p)) > last->r;
}

// A quarter of a segment: how deep its middle lies, and whether it is held.
static void piece_measure(const roots_host* host, const roots_point* a, const roots_point* b, float t, verdict* out)
{
    ty_vec3 n, p = ty_lerp3(a->p, b->p, t);
    float r = ty_lerp(a->r, b->r, t), about = roots_host_value(host, p, NULL);
    float rest = ty_lerp((a->flat - a->sink) * a->r, (b->flat - b->sink) * b->r, t);
    float height =
        about < rest + host->field.step ? roots_host_exact(host, p, fabsf(about) + 2.0f * host->field.step, &n) : about;
    double length = (double)ty_length(ty_sub(b->p, a->p)) / PIECES;
    out->deepest = ty_max(out->deepest, (rest - height) / r);
    out->length += length;
    out->held += height < NEAR * r ? length : 0.0;
}

static verdict judge(const roots_network* net, const roots_host* host)
{
    verdict v = {.branches = net->requested[ROOTS_FIRST] + net->requested[ROOTS_SECOND]};
    v.failed = v.branches - net->grown[ROOTS_FIRST] - net->grown[ROOTS_SECOND];
    for (int l = 0; l < net->line_count; l++)
    {
        const roots_line* line = &net->lines[l];
        bool branch = line->kind == ROOTS_FIRST || line->kind == ROOTS_SECOND;
        if (line->kind == ROOTS_TRUNK) // stands in the host
            continue;
        v.broken += branch && breaks(net, line);
        v.kinked += branch && kinks(net, line);
        for (int i = line->first; i + 1 < line->first + line->count; i++)
            for (int k = 0; k < PIECES; k++)
                piece_measure(host, &net->points[i], &net->points[i + 1], ((float)k + 0.5f) / PIECES, &v);
    }
    return v;
}

static void put_verdict(const char* name, const roots_network* net, const roots_host* host, ty_sink* out)
{
    verdict v = judge(net, host);
    ty_sink_format(out,
                   "\"%s\": {\"branches\": %d, \"failed\": %d, \"no_angle\": %d, \"restarts\": %d, \"points\": %d, "
                   "\"no_partner\": %d, \"stuck\": %d, \"broken\": %d, \"kinked\": %d, \"deepest\": %.3f, "
                   "\"held\": %.4f}",
                   name, v.branches, v.failed, net->failed[ROOTS_NO_ANGLE], net->failed[ROOTS_RESTARTS],
                   net->failed[ROOTS_POINTS], net->failed[ROOTS_NO_PARTNER], net->stuck, v.broken, v.kinked,
                   (double)v.deepest, v.length > 0.0 ? v.held / v.length : 0.0);
}

void roots_compare(const roots_result* result, ty_workers* workers, ty_sink* out)
{
    bool thesis = result->recipe->method == TY_ROOTS_SEED;
    ty_sink_format(out, ",\n \"methods\": {");
    put_verdict(thesis ? "seed" : "wrap", result->network, result->host, out);
    if (thesis && !result->recipe->curves)
    {
        ty_roots_recipe recipe = *result->recipe;
        roots_network net;
        ty_error error;
        recipe.method = TY_ROOTS_WRAP;
        if (roots_grow(&recipe, result->host, workers, &net, &error) == TY_OK)
        {
            ty_sink_format(out, ",\n  ");
            put_verdict("wrap", &net, result->host, out);
        }
        roots_network_term(&net);
    }
    ty_sink_format(out, "}");
}
