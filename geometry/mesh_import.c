// SPDX-License-Identifier: Apache-2.0
// The door to assimp. The child imports and sends plain arrays; the parent trusts none of them.
#include "mesh_import.h"
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <string.h>
#include <strings.h>
#include <tsuya/base/file.h>

static const float CREASE = 0.7f; // radians, where the file has no normals

enum
{
    NAME_SIZE = 128
};

// What the child sends, followed by positions, normals (if any), uvs (if any), colours (if any), triangles, slots of
// triangles (uint16_t) and names of slots (NAME_SIZE bytes each).
typedef struct message
{
    uint64_t vertex_count, triangle_count;
    uint32_t has_normals, has_uvs, has_colors, only_triangles, slot_count;
} message;

bool mesh_import_knows(const char* extension)
{
    static const char* const known[] = {"obj", "stl", "fbx", "dae", "off"};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
    {
        if (strcasecmp(extension, known[i]) == 0)
        {
            return true;
        }
    }
    return false;
}

// A pipe with a buffer: vertices are many and small.
typedef struct sender
{
    int fd;
    ty_error* error;
    ty_status status; // the first failure
    size_t used;
    uint8_t buffer[65536];
} sender;

static void flush(sender* to)
{
    if (to->status == TY_OK)
    {
        to->status = ty_child_write(to->fd, to->buffer, to->used, to->error);
    }
    to->used = 0;
}

static void send_bytes(sender* to, const void* bytes, size_t size)
{
    if (to->used + size > sizeof to->buffer)
    {
        flush(to);
    }
    memcpy(to->buffer + to->used, bytes, size);
    to->used += size;
}

static message measure(const struct aiScene* scene)
{
    message total = {.has_normals = 1, .has_uvs = 1, .only_triangles = 1};
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
    {
        const struct aiMesh* mesh = scene->mMeshes[i];
        total.vertex_count += mesh->mNumVertices;
        total.triangle_count += mesh->mNumFaces;
        for (unsigned f = 0; f < mesh->mNumFaces; f++)
        {
            total.only_triangles &= mesh->mFaces[f].mNumIndices == 3;
        }
        total.has_normals &= mesh->mNormals != NULL;
        total.has_uvs &= mesh->mTextureCoords[0] != NULL;
        total.has_colors |= mesh->mColors[0] != NULL;
    }
    total.slot_count = scene->mNumMaterials;
    return total;
}

// One kind of array of all meshes, one mesh after another.
static void send_vectors(sender* to, const struct aiScene* scene, int kind)
{
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
    {
        const struct aiMesh* mesh = scene->mMeshes[i];
        const struct aiVector3D* source = kind == 0   ? mesh->mVertices
                                          : kind == 1 ? mesh->mNormals
                                                      : mesh->mTextureCoords[0];
        for (unsigned v = 0; v < mesh->mNumVertices; v++)
        {
            float values[3] = {source[v].x, source[v].y, source[v].z};
            send_bytes(to, values, kind == 2 ? 8 : 12);
        }
    }
}

// Where a mesh has none, white.
static void send_colors(sender* to, const struct aiScene* scene)
{
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
    {
        const struct aiColor4D* colors = scene->mMeshes[i]->mColors[0];
        for (unsigned v = 0; v < scene->mMeshes[i]->mNumVertices; v++)
        {
            float values[4] = {1.0f, 1.0f, 1.0f, 1.0f};
            if (colors)
            {
                memcpy(values, &colors[v], sizeof values);
            }
            send_bytes(to, values, sizeof values);
        }
    }
}

static void send_slots(sender* to, const struct aiScene* scene)
{
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
    {
        uint16_t slot = (uint16_t)scene->mMeshes[i]->mMaterialIndex;
        for (unsigned f = 0; f < scene->mMeshes[i]->mNumFaces; f++)
        {
            send_bytes(to, &slot, sizeof slot);
        }
    }
    for (unsigned i = 0; i < scene->mNumMaterials; i++)
    {
        char name[NAME_SIZE] = {0};
        struct aiString text;
        if (aiGetMaterialString(scene->mMaterials[i], AI_MATKEY_NAME, &text) == AI_SUCCESS)
        {
            memcpy(name, text.data, text.length < NAME_SIZE ? text.length : NAME_SIZE - 1);
        }
        send_bytes(to, name, sizeof name);
    }
}

static void send_triangles(sender* to, const struct aiScene* scene)
{
    uint32_t base = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
    {
        const struct aiMesh* mesh = scene->mMeshes[i];
        for (unsigned f = 0; f < mesh->mNumFaces; f++)
        {
            const struct aiFace* face = &mesh->mFaces[f];
            uint32_t corners[3] = {base + face->mIndices[0], base + face->mIndices[1], base + face->mIndices[2]};
            send_bytes(to, corners, sizeof corners);
        }
        base += mesh->mNumVertices;
    }
}

static ty_status import_in_child(const void* context, int fd, ty_error* error)
{
    struct aiPropertyStore* properties = aiCreatePropertyStore();
    aiSetImportPropertyInteger(properties, "PP_SBP_REMOVE", aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices |
                     aiProcess_SortByPType;
    const struct aiScene* scene = aiImportFileExWithProperties(context, steps, NULL, properties);
    if (!scene || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) || scene->mNumMeshes == 0)
    {
        const char* reason = aiGetErrorString();
        return ty_error_set(error, TY_BAD_FILE, "%s", scene || !reason[0] ? "there is no mesh in it" : reason);
    }
    message total = measure(scene);
    if (!total.only_triangles)
    {
        return ty_error_set(error, TY_BAD_FILE, "a face could not be made of triangles");
    }
    if (total.slot_count > TY_MESH_MAX_SLOTS)
    {
        return ty_error_set(error, TY_BAD_FILE, "%u materials, more than %d", total.slot_count, TY_MESH_MAX_SLOTS);
    }
    static sender to; // the child has one, and its buffer is large
    to = (sender){.fd = fd, .error = error};
    send_bytes(&to, &total, sizeof total);
    send_vectors(&to, scene, 0);
    if (total.has_normals)
    {
        send_vectors(&to, scene, 1);
    }
    if (total.has_uvs)
    {
        send_vectors(&to, scene, 2);
    }
    if (total.has_colors)
    {
        send_colors(&to, scene);
    }
    send_triangles(&to, scene);
    send_slots(&to, scene);
    flush(&to);
    return to.status;
}

static const uint8_t* take(const uint8_t* from, void* to, size_t size)
{
    memcpy(to, from, size);
    return from + size;
}

// The slots that triangles use, in the order of the file. from has slot_count names behind the slots of all triangles.
static ty_status take_slots(const char* path, const uint8_t* from, const message* total, ty_mesh* mesh, ty_error* error)
{
    uint16_t* slots = mesh->slots = TY_ALLOC(uint16_t, total->triangle_count);
    from = take(from, slots, 2 * total->triangle_count);
    bool used[TY_MESH_MAX_SLOTS] = {false};
    for (uint64_t t = 0; t < total->triangle_count; t++)
    {
        if (slots[t] >= total->slot_count)
        {
            return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "the importer sent inconsistent materials");
        }
        used[slots[t]] = true;
    }
    uint16_t numbers[TY_MESH_MAX_SLOTS] = {0};
    for (uint32_t i = 0; i < total->slot_count; i++)
    {
        char name[NAME_SIZE];
        from = take(from, name, sizeof name);
        name[NAME_SIZE - 1] = 0;
        numbers[i] = used[i] ? (uint16_t)ty_mesh_add_slot(mesh, name) : 0;
    }
    for (uint64_t t = 0; t < total->triangle_count; t++)
    {
        slots[t] = numbers[slots[t]];
    }
    if (mesh->slot_count == 1)
    {
        ty_free(mesh->slots);
        mesh->slots = NULL;
    }
    return TY_OK;
}

static ty_status take_mesh(const char* path, const uint8_t* from, const message* total, ty_mesh* mesh, ty_error* error)
{
    from = take(from, mesh->positions, 12 * total->vertex_count);
    if (total->has_normals)
    {
        from = take(from, mesh->normals, 12 * total->vertex_count);
    }
    if (total->has_uvs)
    {
        mesh->uvs = TY_ALLOC(ty_vec2, total->vertex_count);
        from = take(from, mesh->uvs, 8 * total->vertex_count);
    }
    if (total->has_colors)
    {
        from = take(from, ty_mesh_add_attribute(mesh, "color", 4), 16 * total->vertex_count);
        mesh->attributes[0].space = TY_ATTRIBUTE_SRGB;
    }
    from = take(from, mesh->triangles, 12 * total->triangle_count);
    ty_status status = take_slots(path, from, total, mesh, error);
    return status == TY_OK ? ty_mesh_validate(mesh, path, error) : status;
}

static ty_status receive(const char* path, const ty_bytes* bytes, ty_mesh** out, ty_error* error)
{
    message total;
    if (bytes->size < sizeof total)
    {
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "the importer sent nothing");
    }
    const uint8_t* from = take(bytes->data, &total, sizeof total);
    uint64_t each = 12u + (total.has_normals ? 12u : 0u) + (total.has_uvs ? 8u : 0u) + (total.has_colors ? 16u : 0u);
    bool plausible = total.vertex_count <= 0xfffffffeu && total.triangle_count <= 0xfffffffeu &&
                     total.slot_count <= TY_MESH_MAX_SLOTS &&
                     sizeof total + total.vertex_count * each + total.triangle_count * 14u +
                             (uint64_t)total.slot_count * NAME_SIZE ==
                         bytes->size;
    if (!plausible)
    {
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "the importer sent inconsistent counts");
    }
    ty_mesh* mesh = ty_mesh_create((uint32_t)total.vertex_count, (uint32_t)total.triangle_count);
    if (!mesh)
    {
        return ty_error_set_at(error, TY_NO_MEMORY, path, 0, 0, "no memory for its mesh");
    }
    ty_status status = take_mesh(path, from, &total, mesh, error);
    if (status != TY_OK)
    {
        ty_mesh_destroy(mesh);
        return status;
    }
    ty_mesh_compute_welds(mesh);
    if (!total.has_normals)
    {
        ty_mesh_compute_normals(mesh, CREASE);
    }
    ty_mesh_compute_bounds(mesh);
    *out = mesh;
    return TY_OK;
}

ty_status mesh_import(const char* path, ty_mesh** out, ty_error* error)
{
    *out = NULL;
    ty_child_def def = {.memory_bytes = 0, .seconds = 60, .max_output = 0};
    ty_bytes bytes = {0};
    ty_status status = ty_child_run(&def, import_in_child, path, &bytes, error);
    if (status != TY_OK)
    {
        char reason[sizeof error->text];
        memcpy(reason, error->text, sizeof reason);
        return ty_error_set_at(error, status, path, 0, 0, "%.900s", reason);
    }
    status = receive(path, &bytes, out, error);
    ty_bytes_term(&bytes);
    return status;
}
