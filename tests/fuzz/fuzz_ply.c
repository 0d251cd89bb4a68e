// SPDX-License-Identifier: Apache-2.0
// Any bytes as a PLY mesh.
#include <tsuya/geometry/mesh_file.h>

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    ty_mesh* mesh;
    ty_error error;
    if (ty_ply_read_memory("fuzz.ply", bytes, size, &mesh, &error) == TY_OK)
    {
        ty_mesh_destroy(mesh);
    }
    return 0;
}
