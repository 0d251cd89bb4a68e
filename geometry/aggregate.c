// SPDX-License-Identifier: Apache-2.0
// Aggregates in memory.
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/geometry/aggregate.h>

ty_aggregate* ty_aggregate_create(uint32_t instance_count, int prototype_count)
{
    ty_aggregate* aggregate = TY_TRY_ALLOC(ty_aggregate, 1);
    if (!aggregate)
        return NULL;
    aggregate->instance_count = instance_count;
    aggregate->prototypes = TY_TRY_ALLOC(ty_mesh*, prototype_count);
    aggregate->transforms = TY_TRY_ALLOC(ty_affine, instance_count);
    aggregate->prototype_index = TY_TRY_ALLOC(uint32_t, instance_count);
    aggregate->ids = TY_TRY_ALLOC(uint32_t, instance_count);
    if (!aggregate->prototypes || !aggregate->transforms || !aggregate->prototype_index || !aggregate->ids)
    {
        ty_aggregate_destroy(aggregate);
        return NULL;
    }
    aggregate->prototype_count = prototype_count;
    for (uint32_t i = 0; i < instance_count; i++)
    {
        aggregate->transforms[i] = ty_affine_identity();
        aggregate->ids[i] = i;
    }
    return aggregate;
}

void ty_aggregate_destroy(ty_aggregate* aggregate)
{
    if (!aggregate)
        return;
    for (int i = 0; i < aggregate->prototype_count && !aggregate->borrows_prototypes; i++)
        ty_mesh_destroy(aggregate->prototypes[i]);
    for (int i = 0; i < aggregate->attribute_count; i++)
        ty_free(aggregate->attributes[i].values);
    ty_free(aggregate->prototypes);
    ty_free(aggregate->transforms);
    ty_free(aggregate->prototype_index);
    ty_free(aggregate->ids);
    ty_free(aggregate->velocities);
    ty_free(aggregate->spins);
    ty_free(aggregate->attributes);
    ty_free(aggregate->recipe);
    ty_free(aggregate->hash);
    ty_free(aggregate->metrics);
    ty_bytes_term(&aggregate->state);
    ty_free(aggregate);
}

ty_vec3* ty_aggregate_add_velocities(ty_aggregate* aggregate)
{
    if (!aggregate->velocities)
        aggregate->velocities = TY_ALLOC(ty_vec3, aggregate->instance_count);
    return aggregate->velocities;
}

ty_vec3* ty_aggregate_add_spins(ty_aggregate* aggregate)
{
    if (!aggregate->spins)
        aggregate->spins = TY_ALLOC(ty_vec3, aggregate->instance_count);
    return aggregate->spins;
}

const ty_instance_attribute* ty_aggregate_find_attribute(const ty_aggregate* aggregate, const char* name)
{
    for (int i = 0; i < aggregate->attribute_count; i++)
        if (strcmp(aggregate->attributes[i].name, name) == 0)
            return &aggregate->attributes[i];
    return NULL;
}

float* ty_aggregate_add_attribute(ty_aggregate* aggregate, const char* name)
{
    const ty_instance_attribute* present = ty_aggregate_find_attribute(aggregate, name);
    if (present)
        return present->values;
    int count = aggregate->attribute_count;
    TY_ASSERT(strlen(name) < sizeof aggregate->attributes[0].name);
    aggregate->attributes =
        ty_grow(aggregate->attributes, (size_t)count, (size_t)count + 1, sizeof aggregate->attributes[0]);
    ty_instance_attribute* added = &aggregate->attributes[count];
    *added = (ty_instance_attribute){.values = TY_ALLOC(float, aggregate->instance_count)};
    strcpy(added->name, name);
    aggregate->attribute_count = count + 1;
    return added->values;
}
