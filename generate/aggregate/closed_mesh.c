// SPDX-License-Identifier: Apache-2.0
// Mesh files that enclose a volume, and what is wrong with those that do not.
#include "closed_mesh.h"
#include <tsuya/geometry/mesh_file.h>

static ty_status not_closed(const char* place, const char* path, const ty_mesh_topology* topology, ty_error* error)
{
    if (topology->boundary_edges == 0 && topology->volume < 0.0)
        return ty_error_set(error, TY_BAD_INPUT, "%s.mesh: %s faces inwards (its volume is %.3g cm^3): turn it over",
                            place, path, topology->volume * 1e6);
    return ty_error_set(error, TY_BAD_INPUT,
                        "%s.mesh: %s is not a closed outward surface (%u open edges, %u with more than two faces)",
                        place, path, topology->boundary_edges, topology->nonmanifold_edges);
}

ty_status closed_mesh_read(const char* place, const char* with, const char* path, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    if (!path || !path[0])
        return ty_error_set(error, TY_BAD_INPUT, "%s.mesh: a path is needed with %s", place, with);
    ty_status status = ty_mesh_read(path, out, error);
    if (status != TY_OK)
        return status;
    ty_mesh_topology topology;
    ty_mesh_analyse(*out, &topology);
    if (topology.closed)
        return TY_OK;
    ty_mesh_destroy(*out);
    *out = NULL;
    return not_closed(place, path, &topology, error);
}
