// SPDX-License-Identifier: Apache-2.0
// A world: Embree's device, and the top level over its objects.
#include "trace_world.h"
#include <string.h>
#include <tsuya/base/cpu.h>
#include <tsuya/base/memory.h>

// Up to this many plain objects at rest, the largest, are left to Embree: a bowl about a heap would be in every ray's
// way through the wide level, where what is near comes first.
#define LARGE_OBJECTS 64
// Up to this many triangles of theirs in all, Embree gets the meshes instead of instances, and has their trees twice.
#define MESH_TRIANGLES 200000u

ty_world_def ty_world_def_default(void)
{
    return (ty_world_def){.path = TY_TRACE_FAST};
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

ty_status ty_trace_take_error(ty_world* world, const char* doing, ty_error* error)
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
    return ty_cpu_has_avx512()                ? "avx512"
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
    // Ours are quicker in halves of eight than by registers of sixteen, and the bits are the same.
    world->use_avx512 = isa && strcmp(isa, "avx512") == 0;
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
    if (!rtcGetDeviceProperty(world->device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) ||
        !rtcGetDeviceProperty(world->device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
        return ty_error_set(error, TY_INTERNAL, "this Embree is built without ray masks or filters");
    return ty_trace_take_error(world, "start", error);
}

ty_status ty_world_create(const ty_world_def* def, ty_world** out, ty_error* error)
{
    *out = NULL;
    ty_world* world = TY_ALLOC(ty_world, 1);
    world->path = def->path;
    world->workers = def->workers;
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
    ty_world_clear_objects(world);
    for (uint32_t i = 0; i < world->prototype_count; i++)
        if (world->prototypes[i].mesh)
            ty_world_remove_prototype(world, i);
    if (world->device)
        rtcReleaseDevice(world->device);
    ty_free(world->isa);
    ty_free(world->prototypes);
    ty_free(world->objects);
    ty_free(world);
}

bool ty_trace_make_room(void** array, uint32_t count, uint32_t* capacity, size_t size)
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

// --- commit ---

// Embree interpolates the maps between its steps linearly, as ty_trace_map_at does.
static RTCGeometry create_instance_geometry(const ty_world* world, const ty_trace_object* object, uint32_t instance)
{
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_INSTANCE);
    if (!geometry)
        return NULL;
    const ty_trace_prototype* prototype = &world->prototypes[ty_trace_prototype_of(object, instance)];
    bool drifts = object->drifts && object->drifts[instance];
    int count = drifts ? ty_trace_drift_steps(object, instance) : object->step_count;
    rtcSetGeometryInstancedScene(geometry, object->aggregate ? prototype->scene : ty_trace_scene_of(prototype));
    rtcSetGeometryTimeStepCount(geometry, (unsigned)count);
    for (int i = 0; i < count; i++)
    {
        ty_affine map = ty_trace_made_map(object, instance, count > 1 ? (float)i / (float)(count - 1) : 0.0f);
        rtcSetGeometryTransform(geometry, (unsigned)i, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &map);
    }
    return geometry;
}

// The mesh itself, for what stands where its mesh has it: no ray has to be carried over.
static RTCGeometry create_mesh_geometry(const ty_world* world, const ty_trace_object* object)
{
    const ty_trace_prototype* prototype = &world->prototypes[object->prototypes[0]];
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!geometry)
        return NULL;
    const ty_mesh* mesh = prototype->mesh;
    const void* positions = rtcGetGeometryBufferData(rtcGetGeometry(prototype->scene, 0), RTC_BUFFER_TYPE_VERTEX, 0);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions, 0, sizeof(ty_vec3),
                               mesh->vertex_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0,
                               sizeof mesh->triangles[0], mesh->triangle_count);
    return geometry;
}

static void attach(ty_world* world, const ty_trace_object* object, RTCGeometry geometry, uint32_t id)
{
    if (!geometry)
        return;
    rtcSetGeometryMask(geometry, object->mask);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(world->scene, geometry, id);
    rtcReleaseGeometry(geometry);
    world->has_rest = true;
    world->filters_rest = world->filters_rest || object->one_sided;
}

// Geometry ids: the instance's among all.
static void attach_reference(ty_world* world)
{
    for (uint32_t k = 0; k < world->object_count; k++)
        for (uint32_t i = 0; i < world->objects[k].count; i++)
        {
            const ty_trace_object* object = &world->objects[k];
            attach(world, object, create_instance_geometry(world, object, i), object->first + i);
        }
}

static float box_area(const ty_trace_object* object)
{
    ty_bounds box = ty_trace_step_bounds(object, 0);
    ty_vec3 d = ty_sub(box.high, box.low);
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

static bool keeps_no_form(const ty_world* world, const ty_trace_object* object)
{
    return !object->aggregate && world->prototypes[object->prototypes[0]].moving;
}

// What the plain objects at rest must be larger than to be Embree's: all of them are when they are few.
static float largest_of_the_small(const ty_world* world)
{
    float largest[LARGE_OBJECTS + 1] = {0}; // descending
    for (uint32_t i = 0; i < world->object_count; i++)
    {
        const ty_trace_object* object = &world->objects[i];
        if (object->aggregate || object->step_count > 1 || keeps_no_form(world, object))
            continue;
        float area = box_area(object);
        for (int k = 0; k <= LARGE_OBJECTS; k++)
            if (area > largest[k])
            {
                float pushed = largest[k];
                largest[k] = area;
                area = pushed;
            }
    }
    return largest[LARGE_OBJECTS];
}

// As Embree gets a plain object at rest.
static RTCGeometry create_plain_geometry(const ty_world* world, const ty_trace_object* object, uint32_t* mesh_triangles)
{
    uint32_t triangles = world->prototypes[object->prototypes[0]].mesh->triangle_count;
    if (!object->is_identity || triangles > MESH_TRIANGLES - *mesh_triangles)
        return create_instance_geometry(world, object, 0);
    *mesh_triangles += triangles;
    return create_mesh_geometry(world, object);
}

// Embree gets what moves and the largest plain objects, by the object's number as geometry id; the wide level all
// else.
static ty_status attach_fast(ty_world* world, ty_error* error)
{
    float small = largest_of_the_small(world);
    uint32_t* wide = TY_TRY_ALLOC(uint32_t, world->object_count);
    if (!wide)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %u objects", world->object_count);
    uint32_t count = 0, mesh_triangles = 0;
    ty_status status = TY_OK;
    for (uint32_t i = 0; i < world->object_count && status == TY_OK; i++)
    {
        ty_trace_object* object = &world->objects[i];
        bool moves = object->step_count > 1;
        if (object->drifts)
            attach(world, object, ty_trace_create_drifting_geometry(world, object), i);
        else if (moves && object->aggregate)
            status = ty_trace_wide_create(world, &i, 1, &object->wide, error);
        if (moves && !object->drifts)
            attach(world, object, ty_trace_create_moving_geometry(world, object), i);
        else if (keeps_no_form(world, object))
            attach(world, object, create_instance_geometry(world, object, 0), i);
        else if (!object->aggregate && box_area(object) > small)
            attach(world, object, create_plain_geometry(world, object, &mesh_triangles), i);
        else if (!moves)
            wide[count++] = i;
    }
    if (status == TY_OK)
        status = ty_trace_wide_create(world, wide, count, &world->wide, error);
    ty_free(wide);
    return status;
}

static void find_some_horizons(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    ty_trace_prototype* const* prototypes = context;
    for (int64_t i = begin; i < end; i++)
        ty_trace_find_horizons(prototypes[i]);
}

// Worth its time where many instances share the prototypes. A cancelled search leaves some out: rays are traced that
// need not be.
static void find_horizons(ty_world* world)
{
    ty_trace_prototype** wanted = TY_ALLOC(ty_trace_prototype*, world->prototype_count);
    bool* listed = TY_ALLOC(bool, world->prototype_count);
    int64_t count = 0;
    for (uint32_t i = 0; i < world->object_count; i++)
    {
        const ty_aggregate* aggregate = world->objects[i].aggregate;
        if (!aggregate || aggregate->instance_count < 16u * (uint32_t)aggregate->prototype_count)
            continue;
        for (int k = 0; k < aggregate->prototype_count; k++)
        {
            uint32_t prototype = world->objects[i].prototypes[k];
            if (!listed[prototype])
                wanted[count++] = &world->prototypes[prototype];
            listed[prototype] = true;
        }
    }
    ty_parallel_for(world->workers, count, 1, find_some_horizons, wanted);
    ty_free(listed);
    ty_free(wanted);
}

static ty_bounds object_bounds(const ty_trace_object* object)
{
    ty_bounds box = ty_bounds_empty();
    for (int k = 0; k < object->step_count; k++)
        box = ty_bounds_union(box, ty_trace_step_bounds(object, k));
    for (uint32_t i = 0; i < object->drift_count; i++)
        for (int k = 0; k < object->drift_steps; k++)
            box = ty_bounds_union(box, ty_trace_drift_bounds(object, object->drifting[i], k));
    return box;
}

ty_status ty_world_commit(ty_world* world, ty_error* error)
{
    TY_ASSERT(!world->scene);
    world->scene = rtcNewScene(world->device);
    rtcSetSceneBuildQuality(world->scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(world->scene, TY_EMBREE_FILTER_FLAG);
    ty_status status = TY_OK;
    for (uint32_t i = 0; i < world->object_count; i++)
        world->objects[i].world = world;
    if (world->path == TY_TRACE_REFERENCE)
        attach_reference(world);
    else
    {
        find_horizons(world);
        world->workers = NULL;
        status = attach_fast(world, error);
    }
    rtcCommitScene(world->scene);
    for (uint32_t i = 0; i < world->object_count; i++)
        world->bounds = ty_bounds_union(world->bounds, object_bounds(&world->objects[i]));
    return status == TY_OK ? ty_trace_take_error(world, "top level", error) : status;
}

ty_bounds ty_world_bounds(const ty_world* world)
{
    return world->bounds;
}

static uint64_t object_memory(const ty_trace_object* object)
{
    uint64_t drift =
        object->drifts ? object->count * sizeof(bool) + object->drift_count * (sizeof(uint32_t) + sizeof(float)) : 0;
    return sizeof *object + (uint64_t)object->step_count * sizeof(ty_affine) + ty_trace_wide_memory(object->wide) +
           drift;
}

uint64_t ty_world_memory(const ty_world* world)
{
    uint64_t bytes = (uint64_t)atomic_load(&world->embree_bytes) + ty_trace_wide_memory(world->wide) +
                     world->prototype_capacity * sizeof(ty_trace_prototype);
    for (uint32_t i = 0; i < world->object_count; i++)
        bytes += object_memory(&world->objects[i]);
    return bytes;
}
