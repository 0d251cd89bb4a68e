// SPDX-License-Identifier: Apache-2.0
// What the writers of aggregates share.
#pragma once
#include "placement.h"
#include <tsuya/geometry/aggregate.h>

// Instances, prototypes and attributes that a file can hold: else TY_BAD_INPUT that names the first that it cannot.
TY_CHECKED ty_status ty_aggregate_check_content(const ty_aggregate* aggregate, const char* path, ty_error* error);

// The placement of each instance, freed by the caller, for a file that holds no shear: of those that are sheared the
// nearest, with a warning that names the holder.
TY_CHECKED ty_status ty_aggregate_split(const ty_aggregate* aggregate, const char* path, const char* holder,
                                        ty_placement** out, ty_error* error);

// The attribute that is the k-th by name: the order of a GLB, so that every file of one aggregate has it.
const ty_instance_attribute* ty_aggregate_attribute_by_name(const ty_aggregate* aggregate, int k);
