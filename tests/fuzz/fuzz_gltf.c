// SPDX-License-Identifier: Apache-2.0
// Any bytes as a glTF scene, text or container: all that is checked and read before the importer runs. No file is
// opened.
#include <tsuya/geometry/gltf.h>

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

static bool find_nothing(void* context, const char* uri, char path[4096], ty_error* error)
{
    (void)context;
    (void)path;
    (void)ty_error_set(error, TY_BAD_FILE, "'%.100s' is not to be had", uri);
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    ty_error error;
    ty_gltf_scene* scene = NULL;
    ty_status status = ty_gltf_scene_open_memory("fuzz.gltf", bytes, size, find_nothing, NULL, &scene, &error);
    TY_ASSERT(status == TY_OK || status == TY_BAD_FILE);
    TY_ASSERT((scene != NULL) == (status == TY_OK));
    ty_gltf_scene_destroy(scene);
    return 0;
}
