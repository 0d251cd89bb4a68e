// SPDX-License-Identifier: Apache-2.0
// Centre lines of roots as text that other programs read and people edit: written.
#include "roots_output.h"
#include <tsuya/base/sink.h>

static void put_header(const roots_network* net, int edges, ty_sink* out)
{
    static const char* const numbers[] = {"x", "y", "z", "nx", "ny", "nz", "radius", "flat", "sink", "along", "birth"};
    ty_sink_format(out, "ply\nformat ascii 1.0\ncomment centre lines of roots, tsuya: metres, y up\n");
    ty_sink_format(out, "comment kinds: 0 trunk, 1 main, 2 aerial, 3 first, 4 second, 5 fine\n");
    if (net->top < TY_FLOAT_MAX) // there is a trunk
    {
        ty_sink_format(out, "comment top ");
        ty_sink_float(out, net->top);
        ty_sink_format(out, "\n");
    }
    ty_sink_format(out, "element vertex %d\n", net->point_count);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        ty_sink_format(out, "property float %s\n", numbers[i]);
    ty_sink_format(out, "property int line\nelement edge %d\nproperty int vertex1\nproperty int vertex2\n", edges);
    ty_sink_format(out, "element line %d\nproperty int kind\nproperty int parent\nproperty int end\n", net->line_count);
    ty_sink_format(out, "property uint key_low\nproperty uint key_high\nend_header\n");
}

static void put_point(const roots_point* p, int line, ty_sink* out)
{
    const float values[] = {p->p.x, p->p.y, p->p.z, p->n.x, p->n.y, p->n.z, p->r, p->flat, p->sink, p->s, p->birth};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
    {
        ty_sink_float(out, values[i]);
        ty_sink_put(out, " ", 1);
    }
    ty_sink_format(out, "%d\n", line);
}

static void put_all(const roots_network* net, ty_sink* out)
{
    int edges = 0, number = 0;
    for (int l = 0; l < net->line_count; l++)
        edges += net->lines[l].count - 1;
    put_header(net, edges, out);
    for (int l = 0; l < net->line_count; l++)
        for (int i = 0; i < net->lines[l].count; i++)
            put_point(&net->points[net->lines[l].first + i], l, out);
    for (int l = 0; l < net->line_count; l++, number++)
        for (int i = 0; i + 1 < net->lines[l].count; i++, number++)
            ty_sink_format(out, "%d %d\n", number, number + 1);
    for (int l = 0; l < net->line_count; l++)
    {
        const roots_line* line = &net->lines[l];
        ty_sink_format(out, "%d %d %d %u %u\n", (int)line->kind, line->parent, line->end, (uint32_t)line->key,
                       (uint32_t)(line->key >> 32));
    }
}

char* roots_curves_text(const roots_network* network)
{
    ty_sink out = {0};
    put_all(network, &out);
    ty_sink_put(&out, "", 1);
    return (char*)out.bytes;
}
