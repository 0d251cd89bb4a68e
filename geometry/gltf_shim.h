// SPDX-License-Identifier: Apache-2.0
// The glTF importer (tinygltf, C++) behind C calls. For use in a child process, after ty_gltf_check.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C"
{
#endif

    typedef struct ty_gltf ty_gltf; // opaque

    // Images are not decoded and no file is opened. NULL with a message on failure; out_of_memory tells that one from
    // others.
    ty_gltf* ty_gltf_load(const void* bytes, size_t size, char* message, size_t message_size, bool* out_of_memory);
    void ty_gltf_destroy(ty_gltf* gltf); // NULL is allowed

    // Accessors are named by index; -1 = there is none. Semantic NULL = the triangle indices.
    int ty_gltf_mesh_count(const ty_gltf* gltf);
    int ty_gltf_primitive_count(const ty_gltf* gltf, int mesh);
    typedef struct ty_gltf_primitive
    {
        int mode;     // 4 = triangles, 5 = a strip, 6 = a fan, below: points and lines
        int material; // -1 = none
    } ty_gltf_primitive;

    ty_gltf_primitive ty_gltf_get_primitive(const ty_gltf* gltf, int mesh, int primitive);
    int ty_gltf_vertex_accessor(const ty_gltf* gltf, int mesh, int primitive, const char* semantic);
    // The i-th semantic in alphabetical order; NULL beyond the last. Borrowed.
    const char* ty_gltf_vertex_semantic(const ty_gltf* gltf, int mesh, int primitive, int i);

    typedef struct ty_gltf_node
    {
        int mesh;   // -1 = none
        int parent; // -1 = none
        bool instanced;
        bool has_matrix;
        float matrix[16]; // to the parent, column-major, when has_matrix; else from:
        float translation[3], rotation[4], scale[3];
    } ty_gltf_node;

    int ty_gltf_node_count(const ty_gltf* gltf);
    ty_gltf_node ty_gltf_get_node(const ty_gltf* gltf, int node);
    int ty_gltf_instance_accessor(const ty_gltf* gltf, int node, const char* semantic);
    const char* ty_gltf_instance_semantic(const ty_gltf* gltf, int node, int i); // as ty_gltf_vertex_semantic

    uint32_t ty_gltf_accessor_count(const ty_gltf* gltf, int accessor); // elements; 0 for -1
    int ty_gltf_accessor_width(const ty_gltf* gltf, int accessor);      // components of an element
    // All elements, tightly packed, normalised integers brought to [-1, 1]. False when they reach beyond the file's
    // bytes.
    bool ty_gltf_read_floats(const ty_gltf* gltf, int accessor, float* out);
    // The same of count elements named by which (NULL = the first count).
    bool ty_gltf_read_elements(const ty_gltf* gltf, int accessor, const uint32_t* which, uint32_t count, float* out);
    // Scalars only. False as above, and when a float is not a whole number of 0..2^24.
    bool ty_gltf_read_integers(const ty_gltf* gltf, int accessor, uint32_t* out);

#ifdef __cplusplus
}
#endif
