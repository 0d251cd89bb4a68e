// SPDX-License-Identifier: Apache-2.0
// Files about the law of moisture: what a calibration writes, and the measured states that it may start from.
#pragma once
#include <tsuya/base/status.h>
#include <tsuya/shading/calibrate.h>

// A file that materials name as `calibration`. Mistakes go to errors with their place; the status is theirs.
TY_CHECKED ty_status ty_calibration_load(const char* path, ty_moisture_law* out, ty_error_list* errors);

// A list `states` of what was measured at some moistures. The caller frees *out with ty_free.
TY_CHECKED ty_status ty_optical_states_load(const char* path, ty_optical_state** out, int* count,
                                            ty_error_list* errors);
const ty_param_table* ty_optical_states_params(void);
