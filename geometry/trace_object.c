// SPDX-License-Identifier: Apache-2.0
// Objects of a world: adding and clearing them, and what their instances refer to.
#include "trace_world.h"
#include <string.h>
#include <tsuya/base/memory.h>

static void free_object(ty_trace_object* object)
{
    ty_trace_wide_destroy(object->wide);
    ty_free(object->drifts);
    ty_free(object->drifting);
    ty_free(object->reaches);
    ty_free(object->prototypes);
    ty_free(object->steps);
}

void ty_trace_free_objects(ty_world* world)
{
    for (uint32_t i = 0; i < world->object_count; i++)
        free_object(&world->objects[i]);
    world->object_count = 0;
    world->instance_count = 0;
}

void ty_world_clear_objects(ty_world* world)
{
    if (world->scene)
        rtcReleaseScene(world->scene);
    world->scene = NULL;
    ty_trace_wide_destroy(world->wide);
    world->wide = NULL;
    world->has_rest = false;
    ty_trace_free_objects(world);
    world->filters_rest = false;
    world->bounds = ty_bounds_empty();
}

// --- adding ---

static ty_status append(ty_world* world, ty_trace_object* added, ty_motion motion, ty_object_flags flags,
                        uint32_t* object, ty_error* error)
{
    TY_ASSERT(!world->scene);
    // The last index stays free for TY_NONE.
    if (added->count >= TY_NONE - world->instance_count)
        return ty_error_set(error, TY_BAD_INPUT, "more than %u instances in all", TY_NONE - 1);
    if (!ty_trace_make_room((void**)&world->objects, world->object_count, &world->object_capacity,
                            sizeof world->objects[0]))
        return ty_error_set(error, TY_NO_MEMORY, "no memory for another object");
    ty_status status = ty_trace_refine_motion(motion, &added->steps, &added->step_count, error);
    if (status != TY_OK)
        return status;
    status = ty_trace_find_drift(added, motion, error);
    if (status != TY_OK)
        return status;
    ty_affine identity = ty_affine_identity();
    added->is_identity =
        !added->drifts && added->step_count == 1 && memcmp(&added->steps[0], &identity, sizeof identity) == 0;
    added->index = world->object_count;
    added->first = world->instance_count;
    added->one_sided = flags.one_sided;
    added->mask = flags.mask;
    world->instance_count += added->count;
    world->objects[world->object_count] = *added;
    *object = world->object_count++;
    return TY_OK;
}

ty_status ty_world_add_object(ty_world* world, uint32_t prototype, ty_motion motion, ty_object_flags flags,
                              uint32_t* object, ty_error* error)
{
    TY_ASSERT(prototype < world->prototype_count && world->prototypes[prototype].mesh);
    ty_trace_object added = {.count = 1, .prototypes = TY_ALLOC(uint32_t, 1)};
    added.prototypes[0] = prototype;
    ty_status status = append(world, &added, motion, flags, object, error);
    if (status != TY_OK)
        free_object(&added);
    return status;
}

static ty_status check_instances(const ty_world* world, const ty_aggregate* aggregate, const ty_affine* outer,
                                 ty_error* error)
{
    for (uint32_t i = 0; i < aggregate->instance_count; i++)
    {
        ty_affine m = ty_affine_multiply(outer, &aggregate->transforms[i]), inverse;
        TY_ASSERT(aggregate->prototype_index[i] < (uint32_t)aggregate->prototype_count);
        bool finite = ty_is_finite3(m.x) && ty_is_finite3(m.y) && ty_is_finite3(m.z) && ty_is_finite3(m.t);
        if (!finite || !ty_affine_invert(&m, &inverse))
            return ty_error_set(error, TY_BAD_INPUT, "object %u, instance %u: its map is singular or not finite",
                                world->object_count, i);
    }
    return TY_OK;
}

ty_status ty_world_add_aggregate(ty_world* world, const ty_aggregate* aggregate, ty_motion motion,
                                 ty_object_flags flags, uint32_t* object, ty_error* error)
{
    if (aggregate->instance_count == 0 || aggregate->prototype_count <= 0)
        return ty_error_set(error, TY_BAD_INPUT, "an aggregate without instances cannot be traced");
    ty_status status = check_instances(world, aggregate, &motion.steps[0], error);
    if (status != TY_OK)
        return status;
    ty_trace_object added = {.count = aggregate->instance_count,
                             .aggregate = aggregate,
                             .prototypes = TY_ALLOC(uint32_t, aggregate->prototype_count)};
    for (int i = 0; i < aggregate->prototype_count && status == TY_OK; i++)
        status = ty_world_add_prototype(world, aggregate->prototypes[i], &added.prototypes[i], error);
    if (status == TY_OK)
        status = append(world, &added, motion, flags, object, error);
    if (status != TY_OK)
        free_object(&added);
    return status;
}

// --- what an instance refers to ---

ty_affine ty_trace_inner_map(const ty_trace_object* object, uint32_t instance)
{
    return object->aggregate ? object->aggregate->transforms[instance] : ty_affine_identity();
}

const ty_trace_object* ty_trace_object_of(const ty_world* world, uint32_t instance)
{
    uint32_t low = 0, high = world->object_count;
    while (high - low > 1)
    {
        uint32_t middle = low + (high - low) / 2;
        if (world->objects[middle].first <= instance)
            low = middle;
        else
            high = middle;
    }
    return &world->objects[low];
}

uint32_t ty_world_prototype(const ty_world* world, uint32_t object, uint32_t instance)
{
    return ty_trace_prototype_of(&world->objects[object], instance);
}

const ty_mesh* ty_world_mesh(const ty_world* world, uint32_t object, uint32_t instance)
{
    return world->prototypes[ty_world_prototype(world, object, instance)].mesh;
}

ty_affine ty_trace_made_map(const ty_trace_object* object, uint32_t instance, float time)
{
    ty_affine map = ty_trace_map_at(object->steps, object->step_count, time);
    if (!object->aggregate)
        return map;
    if (!object->drifts || !object->drifts[instance])
        return ty_affine_multiply(&map, &object->aggregate->transforms[instance]);
    ty_affine inner = ty_trace_drifted(object, instance, time);
    return ty_affine_multiply(&map, &inner);
}

ty_affine ty_world_to_world(const ty_world* world, uint32_t object, uint32_t instance, float time)
{
    ty_affine scratch;
    return *ty_trace_to_world(&world->objects[object], instance, time, &scratch);
}

ty_affine ty_world_to_local(const ty_world* world, uint32_t object, uint32_t instance, float time)
{
    ty_affine map = ty_world_to_world(world, object, instance, time), inverse;
    return ty_affine_invert(&map, &inverse) ? inverse : ty_affine_identity();
}

bool ty_world_is_moving(const ty_world* world, uint32_t object)
{
    const ty_trace_object* o = &world->objects[object];
    return o->step_count > 1 || o->drifts || (!o->aggregate && world->prototypes[o->prototypes[0]].moving);
}
