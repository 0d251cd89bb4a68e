// SPDX-License-Identifier: Apache-2.0
// Prototypes of a world: the tree of a mesh, built once and shared by all that stands for it.
#include "trace_world.h"
#include <string.h>
#include <tsuya/base/memory.h>

// Splitting triangles pays for small prototypes; above this many it costs more time than it gives.
#define HIGH_QUALITY_TRIANGLES 200000u

// A copy, since Embree reads 16 bytes at the last vertex. False when it has no memory.
static bool copy_vertices(RTCGeometry geometry, int step, const ty_vec3* positions, uint32_t count)
{
    void* out = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, (unsigned)step, RTC_FORMAT_FLOAT3,
                                        sizeof(ty_vec3), count);
    if (out)
        memcpy(out, positions, count * sizeof(ty_vec3));
    return out != NULL;
}

// steps: as the mesh stands while the shutter is open; else as it stands at the frame's own moment.
static ty_status build_prototype_scene(ty_world* world, const ty_mesh* mesh, bool steps, RTCScene* out, ty_error* error)
{
    RTCScene scene = rtcNewScene(world->device);
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    bool high = mesh->triangle_count <= HIGH_QUALITY_TRIANGLES, copied = true;
    rtcSetSceneBuildQuality(scene, high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(scene, TY_EMBREE_FILTER_FLAG);
    if (steps)
        rtcSetGeometryTimeStepCount(geometry, (unsigned)mesh->step_count);
    for (int i = 0; i < (steps ? mesh->step_count : 1) && copied; i++)
        copied =
            copy_vertices(geometry, i, steps ? mesh->step_positions + (size_t)i * mesh->vertex_count : mesh->positions,
                          mesh->vertex_count);
    if (copied)
    {
        // the indices are shared
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0,
                                   sizeof mesh->triangles[0], mesh->triangle_count);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
    }
    rtcReleaseGeometry(geometry);
    ty_status status = ty_trace_take_error(world, "prototype", error);
    if (status != TY_OK)
        rtcReleaseScene(scene);
    else
        *out = scene;
    return status;
}

static void analyse(const ty_mesh* mesh, ty_mesh_topology* topology)
{
    if (mesh->welds)
    {
        ty_mesh_analyse(mesh, topology);
        return;
    }
    ty_mesh* welded = ty_mesh_copy(mesh);
    ty_mesh_compute_welds(welded);
    ty_mesh_analyse(welded, topology);
    ty_mesh_destroy(welded);
}

static uint32_t free_slot(const ty_world* world)
{
    uint32_t i = 0;
    while (i < world->prototype_count && world->prototypes[i].mesh)
        i++;
    return i;
}

ty_status ty_world_add_prototype(ty_world* world, const ty_mesh* mesh, uint32_t* prototype, ty_error* error)
{
    TY_ASSERT(!world->scene);
    for (uint32_t i = 0; i < world->prototype_count; i++)
        if (world->prototypes[i].mesh == mesh)
        {
            *prototype = i;
            return TY_OK;
        }
    if (mesh->triangle_count == 0 || mesh->vertex_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "a mesh without triangles cannot be traced");
    if (!ty_trace_make_room((void**)&world->prototypes, world->prototype_count, &world->prototype_capacity,
                            sizeof world->prototypes[0]))
        return ty_error_set(error, TY_NO_MEMORY, "no memory for another prototype");
    ty_trace_prototype added = {.mesh = mesh,
                                .bounds = ty_bounds_empty(),
                                .to_sphere = ty_affine_identity(),
                                .from_sphere = ty_affine_identity()};
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        added.bounds = ty_bounds_add(added.bounds, mesh->positions[i]);
    for (size_t i = 0; i < (size_t)mesh->step_count * mesh->vertex_count; i++)
        added.bounds = ty_bounds_add(added.bounds, mesh->step_positions[i]);
    ty_status status = build_prototype_scene(world, mesh, false, &added.scene, error);
    if (status == TY_OK && mesh->step_count > 0)
    {
        status = build_prototype_scene(world, mesh, true, &added.moving, error);
        if (status != TY_OK)
            rtcReleaseScene(added.scene);
    }
    if (status != TY_OK)
        return status;
    analyse(mesh, &added.topology);
    added.topology.convex = added.topology.convex && !added.moving; // at other moments it may not be
    *prototype = free_slot(world);
    world->prototypes[*prototype] = added;
    if (*prototype == world->prototype_count)
        world->prototype_count++;
    return TY_OK;
}

static bool is_used(const ty_world* world, uint32_t prototype)
{
    for (uint32_t i = 0; i < world->object_count; i++)
    {
        const ty_trace_object* object = &world->objects[i];
        int count = object->aggregate ? object->aggregate->prototype_count : 1;
        for (int k = 0; k < count; k++)
            if (object->prototypes[k] == prototype)
                return true;
    }
    return false;
}

void ty_world_remove_prototype(ty_world* world, uint32_t prototype)
{
    TY_ASSERT(prototype < world->prototype_count && !is_used(world, prototype));
    rtcReleaseScene(world->prototypes[prototype].scene);
    if (world->prototypes[prototype].moving)
        rtcReleaseScene(world->prototypes[prototype].moving);
    ty_free(world->prototypes[prototype].horizons);
    world->prototypes[prototype] = (ty_trace_prototype){0};
    while (world->prototype_count > 0 && !world->prototypes[world->prototype_count - 1].mesh)
        world->prototype_count--;
}

const ty_mesh_topology* ty_world_topology(const ty_world* world, uint32_t prototype)
{
    return &world->prototypes[prototype].topology;
}

uint32_t ty_world_prototype_count(const ty_world* world)
{
    return world->prototype_count;
}

const ty_mesh* ty_world_prototype_mesh(const ty_world* world, uint32_t prototype)
{
    return world->prototypes[prototype].mesh;
}
