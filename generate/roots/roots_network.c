// SPDX-License-Identifier: Apache-2.0
// The network of centre lines: its storage, directions along it.
#include "roots_growth.h"

void roots_network_add_point(roots_network* network, const roots_point* point)
{
    if (network->point_count == network->point_capacity)
    {
        int capacity = network->point_capacity ? 2 * network->point_capacity : 4096;
        network->points = ty_grow(network->points, (size_t)network->point_capacity, (size_t)capacity, sizeof *point);
        network->point_capacity = capacity;
    }
    network->points[network->point_count++] = *point;
}

int roots_network_add_line(roots_network* network, const roots_line* line)
{
    if (network->line_count == network->line_capacity)
    {
        int capacity = network->line_capacity ? 2 * network->line_capacity : 256;
        network->lines = ty_grow(network->lines, (size_t)network->line_capacity, (size_t)capacity, sizeof *line);
        network->line_capacity = capacity;
    }
    network->lines[network->line_count] = *line;
    return network->line_count++;
}

void roots_network_term(roots_network* network)
{
    ty_free(network->points);
    ty_free(network->lines);
    *network = (roots_network){0};
}

ty_vec3 growth_tangent(const roots_network* network, const roots_line* line, int point)
{
    int before = point > line->first ? point - 1 : point, last = line->first + line->count - 1;
    int after = point < last ? point + 1 : point;
    return ty_normalize(ty_sub(network->points[after].p, network->points[before].p));
}
