// SPDX-License-Identifier: Apache-2.0
// PLY points as an aggregate.
#pragma once
#include <tsuya/geometry/aggregate.h>

// x y z place an instance each; orient (x y z w: orient[0].., orient0.., orient_0.., orient_x.. or rot_0..) turns it;
// pscale (or scale, or scale_x scale_y scale_z) sizes it; vx vy vz and wx wy wz (or v[0].., v_x..) move it; id names
// it; other scalars become attributes.
TY_CHECKED ty_status ty_points_read_memory(const char* name, const void* bytes, size_t size, const ty_mesh* prototype,
                                           ty_aggregate** out, ty_error* error);
