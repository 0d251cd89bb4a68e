// SPDX-License-Identifier: Apache-2.0
// Building a world: Embree's device, prototypes, objects, and the top level over them.
#include "trace_world.h"
#include <string.h>
#include <tsuya/base/memory.h>

// Splitting triangles pays for small prototypes; above this many it costs more time than it gives.
#define HIGH_QUALITY_TRIANGLES 200000u

ty_world_def ty_world_def_default(void)
{
    return (ty_world_def){TY_TRACE_FAST, NULL};
}

// --- Embree's device ---

static void keep_first_error(void* user, enum RTCError code, const char* text)
{
    ty_world* world = user;
    if (world->embree_error != RTC_ERROR_NONE)
        return;
    world->embree_error = code;
    if (text)
        memcpy(world->embree_text, text, strnlen(text, sizeof world->embree_text - 1));
}

static bool count_memory(void* user, ssize_t bytes, bool post)
{
    (void)post;
    atomic_fetch_add(&((ty_world*)user)->embree_bytes, bytes);
    return true;
}

static ty_status take_error(ty_world* world, const char* doing, ty_error* error)
{
    enum RTCError code = world->embree_error;
    if (code == RTC_ERROR_NONE)
        return TY_OK;
    world->embree_error = RTC_ERROR_NONE;
    ty_status status = code == RTC_ERROR_OUT_OF_MEMORY ? TY_NO_MEMORY : TY_INTERNAL;
    return ty_error_set(error, status, "Embree, %s: %s (error %d)", doing, world->embree_text, (int)code);
}

// What Embree picks by itself on this CPU.
static const char* best_isa(void)
{
#if defined(__x86_64__)
    bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512vl");
    return avx512                             ? "avx512"
           : __builtin_cpu_supports("avx2")   ? "avx2"
           : __builtin_cpu_supports("avx")    ? "avx"
           : __builtin_cpu_supports("sse4.2") ? "sse4.2"
                                              : "sse2";
#else
    return "native";
#endif
}

const char* ty_world_isa(const ty_world* world)
{
    return world->isa;
}

static ty_status create_device(ty_world* world, const char* isa, ty_error* error)
{
    // Embree itself falls back silently from names that it does not know.
    static const char* const known[] = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
    // One building thread: a parallel build may differ from run to run.
    char config[64] = "threads=1,set_affinity=0";
    if (isa)
    {
        size_t i = 0;
        while (i < sizeof known / sizeof known[0] && strcmp(isa, known[i]) != 0)
            i++;
        if (i == sizeof known / sizeof known[0])
            return ty_error_set(error, TY_BAD_INPUT, "isa \"%.32s\" is none of sse2, sse4.2, avx, avx2, avx512", isa);
        strcat(config, ",isa=");
        strcat(config, known[i]);
    }
    world->isa = isa ? ty_string_copy(isa) : ty_string_copy(best_isa());
    world->device = rtcNewDevice(config);
    if (!world->device)
    {
        int code = (int)rtcGetDeviceError(NULL);
        ty_status status = code == RTC_ERROR_OUT_OF_MEMORY ? TY_NO_MEMORY : isa ? TY_BAD_INPUT : TY_INTERNAL;
        return ty_error_set(error, status, "Embree does not start%s%s on this machine: %s (error %d)",
                            isa ? " with isa " : "", isa ? isa : "",
                            status == TY_NO_MEMORY ? "out of memory" : "not supported", code);
    }
    rtcSetDeviceErrorFunction(world->device, keep_first_error, world);
    rtcSetDeviceMemoryMonitorFunction(world->device, count_memory, world);
    world->scene = rtcNewScene(world->device);
    return take_error(world, "scene", error);
}

ty_status ty_world_create(const ty_world_def* def, ty_world** out, ty_error* error)
{
    *out = NULL;
    ty_world* world = TY_ALLOC(ty_world, 1);
    world->path = def->path;
    world->bounds = ty_bounds_empty();
    ty_status status = create_device(world, def->isa, error);
    if (status != TY_OK)
        ty_world_destroy(world);
    else
        *out = world;
    return status;
}

void ty_world_destroy(ty_world* world)
{
    if (!world)
        return;
    if (world->scene)
        rtcReleaseScene(world->scene);
    for (uint32_t i = 0; i < world->prototype_count; i++)
        rtcReleaseScene(world->prototypes[i].scene);
    if (world->device)
        rtcReleaseDevice(world->device);
    ty_free(world->isa);
    ty_free(world->prototypes);
    ty_free(world->objects);
    ty_free(world->to_world);
    ty_free(world->to_local);
    ty_free(world->instance_prototype);
    ty_free(world->instance_object);
    ty_free(world);
}

// --- prototypes ---

static ty_status build_prototype_scene(ty_world* world, const ty_mesh* mesh, RTCScene* out, ty_error* error)
{
    RTCScene scene = rtcNewScene(world->device);
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    bool high = mesh->triangle_count <= HIGH_QUALITY_TRIANGLES;
    rtcSetSceneBuildQuality(scene, high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(scene, TY_EMBREE_FILTER_FLAG);
    // A copy, since Embree reads 16 bytes at the last vertex; the indices are shared.
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(ty_vec3),
                                              mesh->vertex_count);
    if (positions)
    {
        memcpy(positions, mesh->positions, mesh->vertex_count * sizeof(ty_vec3));
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0,
                                   sizeof mesh->triangles[0], mesh->triangle_count);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
    }
    rtcReleaseGeometry(geometry);
    ty_status status = take_error(world, "prototype", error);
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

// Room for one more element behind count; *capacity doubles.
static bool make_room(void** array, uint32_t count, uint32_t* capacity, size_t size)
{
    if (count < *capacity)
        return true;
    uint32_t wanted = *capacity ? 2 * *capacity : 8;
    void* grown = ty_try_grow(*array, *capacity, wanted, size);
    if (!grown)
        return false;
    *array = grown;
    *capacity = wanted;
    return true;
}

ty_status ty_world_add_prototype(ty_world* world, const ty_mesh* mesh, uint32_t* prototype, ty_error* error)
{
    TY_ASSERT(!world->committed);
    for (uint32_t i = 0; i < world->prototype_count; i++)
        if (world->prototypes[i].mesh == mesh)
        {
            *prototype = i;
            return TY_OK;
        }
    if (mesh->triangle_count == 0 || mesh->vertex_count == 0)
        return ty_error_set(error, TY_BAD_INPUT, "a mesh without triangles cannot be traced");
    if (!make_room((void**)&world->prototypes, world->prototype_count, &world->prototype_capacity,
                   sizeof world->prototypes[0]))
        return ty_error_set(error, TY_NO_MEMORY, "no memory for another prototype");
    ty_trace_prototype added = {.mesh = mesh, .bounds = ty_bounds_empty()};
    ty_status status = build_prototype_scene(world, mesh, &added.scene, error);
    if (status != TY_OK)
        return status;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        added.bounds = ty_bounds_add(added.bounds, mesh->positions[i]);
    analyse(mesh, &added.topology);
    *prototype = world->prototype_count;
    world->prototypes[world->prototype_count++] = added;
    return TY_OK;
}

// --- objects ---

static ty_status make_instance_room(ty_world* world, uint32_t count, ty_error* error)
{
    // The last index stays free for TY_NONE.
    if (count >= TY_NONE - world->instance_count)
        return ty_error_set(error, TY_BAD_INPUT, "more than %u instances in all", TY_NONE - 1);
    uint32_t wanted = world->instance_count + count, old = world->instance_capacity;
    if (wanted <= old)
        return TY_OK;
    if (wanted < old + old / 2)
        wanted = old + old / 2;
    ty_affine* to_world = ty_try_grow(world->to_world, old, wanted, sizeof(ty_affine));
    world->to_world = to_world ? to_world : world->to_world;
    ty_affine* to_local = ty_try_grow(world->to_local, old, wanted, sizeof(ty_affine));
    world->to_local = to_local ? to_local : world->to_local;
    uint32_t* prototype = ty_try_grow(world->instance_prototype, old, wanted, sizeof(uint32_t));
    world->instance_prototype = prototype ? prototype : world->instance_prototype;
    uint32_t* object = ty_try_grow(world->instance_object, old, wanted, sizeof(uint32_t));
    world->instance_object = object ? object : world->instance_object;
    if (!to_world || !to_local || !prototype || !object)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %u instances", wanted);
    world->instance_capacity = wanted;
    return TY_OK;
}

// Appends behind instance_count + offset without counting it: a failure half way leaves the world as it was.
static ty_status place_instance(ty_world* world, uint32_t offset, uint32_t prototype, const ty_affine* transform,
                                ty_error* error)
{
    uint32_t i = world->instance_count + offset;
    bool finite = ty_is_finite3(transform->x) && ty_is_finite3(transform->y) && ty_is_finite3(transform->z) &&
                  ty_is_finite3(transform->t);
    if (!finite || !ty_affine_invert(transform, &world->to_local[i]))
        return ty_error_set(error, TY_BAD_INPUT, "object %u, instance %u: its map is singular or not finite",
                            world->object_count, offset);
    world->to_world[i] = *transform;
    world->instance_prototype[i] = prototype;
    world->instance_object[i] = world->object_count;
    return TY_OK;
}

static void append_object(ty_world* world, uint32_t count, bool aggregate, ty_object_flags flags, uint32_t* object)
{
    world->objects[world->object_count] = (ty_trace_object){.world = world,
                                                            .index = world->object_count,
                                                            .first = world->instance_count,
                                                            .count = count,
                                                            .aggregate = aggregate,
                                                            .closed_subsurface = flags.closed_subsurface};
    world->has_subsurface = world->has_subsurface || flags.closed_subsurface;
    world->instance_count += count;
    *object = world->object_count++;
}

static ty_status make_object_room(ty_world* world, uint32_t instances, ty_error* error)
{
    TY_ASSERT(!world->committed);
    if (!make_room((void**)&world->objects, world->object_count, &world->object_capacity, sizeof world->objects[0]))
        return ty_error_set(error, TY_NO_MEMORY, "no memory for another object");
    return make_instance_room(world, instances, error);
}

ty_status ty_world_add_object(ty_world* world, uint32_t prototype, const ty_affine* transform, ty_object_flags flags,
                              uint32_t* object, ty_error* error)
{
    TY_ASSERT(prototype < world->prototype_count);
    ty_status status = make_object_room(world, 1, error);
    if (status == TY_OK)
        status = place_instance(world, 0, prototype, transform, error);
    if (status == TY_OK)
        append_object(world, 1, false, flags, object);
    return status;
}

ty_status ty_world_add_aggregate(ty_world* world, const ty_aggregate* aggregate, const ty_affine* transform,
                                 ty_object_flags flags, uint32_t* object, ty_error* error)
{
    if (aggregate->instance_count == 0 || aggregate->prototype_count <= 0)
        return ty_error_set(error, TY_BAD_INPUT, "an aggregate without instances cannot be traced");
    uint32_t* prototypes = TY_ALLOC(uint32_t, aggregate->prototype_count);
    ty_status status = make_object_room(world, aggregate->instance_count, error);
    for (int i = 0; i < aggregate->prototype_count && status == TY_OK; i++)
        status = ty_world_add_prototype(world, aggregate->prototypes[i], &prototypes[i], error);
    for (uint32_t i = 0; i < aggregate->instance_count && status == TY_OK; i++)
    {
        TY_ASSERT(aggregate->prototype_index[i] < (uint32_t)aggregate->prototype_count);
        ty_affine map = ty_affine_multiply(transform, &aggregate->transforms[i]);
        status = place_instance(world, i, prototypes[aggregate->prototype_index[i]], &map, error);
    }
    if (status == TY_OK)
        append_object(world, aggregate->instance_count, true, flags, object);
    ty_free(prototypes);
    return status;
}

// --- commit ---

static RTCGeometry create_instance_geometry(const ty_world* world, uint32_t instance)
{
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_INSTANCE);
    if (!geometry)
        return NULL;
    rtcSetGeometryInstancedScene(geometry, world->prototypes[world->instance_prototype[instance]].scene);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &world->to_world[instance]);
    rtcCommitGeometry(geometry);
    return geometry;
}

static void attach(ty_world* world, RTCGeometry geometry, uint32_t id)
{
    if (!geometry)
        return;
    rtcAttachGeometryByID(world->scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

// Geometry ids: the object's on the fast path, the instance's (among all) on the reference path.
static void attach_object(ty_world* world, ty_trace_object* object)
{
    if (world->path == TY_TRACE_REFERENCE)
        for (uint32_t i = object->first; i < object->first + object->count; i++)
            attach(world, create_instance_geometry(world, i), i);
    else if (object->aggregate)
        attach(world, ty_trace_create_user_geometry(world, object), object->index);
    else
        attach(world, create_instance_geometry(world, object->first), object->index);
}

static void fit_ellipsoids(ty_world* world)
{
    for (uint32_t i = 0; i < world->instance_count; i++)
    {
        ty_trace_prototype* prototype = &world->prototypes[world->instance_prototype[i]];
        if (world->objects[world->instance_object[i]].aggregate && !prototype->has_ellipsoid)
            ty_trace_fit_ellipsoid(prototype);
    }
}

ty_status ty_world_commit(ty_world* world, ty_error* error)
{
    TY_ASSERT(!world->committed);
    if (world->path == TY_TRACE_FAST)
        fit_ellipsoids(world);
    rtcSetSceneBuildQuality(world->scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(world->scene, TY_EMBREE_FILTER_FLAG);
    for (uint32_t i = 0; i < world->object_count; i++)
        attach_object(world, &world->objects[i]);
    rtcCommitScene(world->scene);
    ty_status status = take_error(world, "top level", error);
    if (status != TY_OK)
        return status;
    for (uint32_t i = 0; i < world->instance_count; i++)
    {
        ty_bounds box = ty_bounds_map(&world->to_world[i], world->prototypes[world->instance_prototype[i]].bounds);
        world->bounds = ty_bounds_union(world->bounds, box);
    }
    world->committed = true;
    return TY_OK;
}

// --- what a hit refers to ---

static uint32_t instance_of(const ty_world* world, uint32_t object, uint32_t instance)
{
    return world->objects[object].first + instance;
}

uint32_t ty_world_prototype(const ty_world* world, uint32_t object, uint32_t instance)
{
    return world->instance_prototype[instance_of(world, object, instance)];
}

const ty_mesh* ty_world_mesh(const ty_world* world, uint32_t object, uint32_t instance)
{
    return world->prototypes[ty_world_prototype(world, object, instance)].mesh;
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

const ty_affine* ty_world_to_world(const ty_world* world, uint32_t object, uint32_t instance)
{
    return &world->to_world[instance_of(world, object, instance)];
}

const ty_affine* ty_world_to_local(const ty_world* world, uint32_t object, uint32_t instance)
{
    return &world->to_local[instance_of(world, object, instance)];
}

ty_bounds ty_world_bounds(const ty_world* world)
{
    return world->bounds;
}

uint64_t ty_world_memory(const ty_world* world)
{
    size_t instance = 2 * sizeof(ty_affine) + 2 * sizeof(uint32_t);
    return (uint64_t)atomic_load(&world->embree_bytes) + (uint64_t)world->instance_capacity * instance +
           world->prototype_capacity * sizeof(ty_trace_prototype) + world->object_capacity * sizeof(ty_trace_object);
}
