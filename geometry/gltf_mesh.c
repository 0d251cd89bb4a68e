// SPDX-License-Identifier: Apache-2.0
// From the importer's model to a mesh: primitives one after another, each with the vertices that it uses.
#include "gltf_mesh.h"
#include "glb.h"
#include <stdlib.h>
#include <string.h>

// A primitive of triangles within the mesh that is being made.
typedef struct part
{
    int primitive;
    int slot;                 // material, or the count of materials for none
    uint32_t first, count;    // vertices in the mesh
    uint32_t* which;          // [count] in the file, ascending; NULL = all
    uint32_t (*triangles)[3]; // of vertices in the file, then in the mesh
    uint32_t triangle_count;
} part;

typedef struct maker
{
    const ty_gltf_mesh_job* job;
    int mesh;
    part* parts;
    int part_count;
    ty_mesh* out;
} maker;

#define FAIL(m, ...) ty_error_set_at((m)->job->error, TY_BAD_FILE, (m)->job->name, 0, 0, __VA_ARGS__)

static ty_status no_memory(const maker* m)
{
    return ty_error_set_at(m->job->error, TY_NO_MEMORY, m->job->name, 0, 0, "no memory for what the file holds");
}

bool ty_gltf_plain_name(const char* semantic, char name[32])
{
    size_t length = strlen(semantic);
    if (semantic[0] != '_' || length < 2 || length > 32)
        return false;
    for (size_t i = 1; i <= length; i++)
        name[i - 1] = (char)(semantic[i] >= 'A' && semantic[i] <= 'Z' ? semantic[i] - 'A' + 'a' : semantic[i]);
    return true;
}

static int accessor_of(const maker* m, const part* p, const char* semantic)
{
    return ty_gltf_vertex_accessor(m->job->gltf, m->mesh, p->primitive, semantic);
}

static uint32_t vertices_of(const maker* m, const part* p)
{
    return ty_gltf_accessor_count(m->job->gltf, accessor_of(m, p, "POSITION"));
}

// --- triangles ---

// Corners to triangles; those of strips and fans that join two runs have no area and go.
static void add_triangles(part* p, const uint32_t* corners, uint32_t count, int mode)
{
    if (mode == TY_GLTF_TRIANGLES)
    {
        memcpy(p->triangles, corners, (size_t)(count / 3) * sizeof p->triangles[0]);
        p->triangle_count = count / 3;
        return;
    }
    for (uint32_t i = 0; i + 2 < count; i++)
    {
        bool turned = mode == TY_GLTF_STRIP && i % 2;
        uint32_t a = mode == TY_GLTF_FAN ? corners[0] : corners[i], b = corners[i + 1], c = corners[i + 2];
        if (a == b || b == c || c == a)
            continue;
        uint32_t* t = p->triangles[p->triangle_count++];
        t[0] = turned ? b : a;
        t[1] = turned ? a : b;
        t[2] = c;
    }
}

static ty_status read_corners(const maker* m, part* p, uint32_t* corners, uint32_t count, int mode)
{
    uint32_t vertices = vertices_of(m, p);
    int indices = accessor_of(m, p, NULL);
    if (indices < 0)
        for (uint32_t i = 0; i < count; i++)
            corners[i] = i;
    else if (!ty_gltf_read_integers(m->job->gltf, indices, corners))
        return FAIL(m, "meshes[%d].primitives[%d].indices cannot be read", m->mesh, p->primitive);
    for (uint32_t i = 0; i < count; i++)
        if (corners[i] >= vertices)
            return FAIL(m, "meshes[%d].primitives[%d]: index %u at place %u, but only %u vertices", m->mesh,
                        p->primitive, corners[i], i, vertices);
    add_triangles(p, corners, count, mode);
    return TY_OK;
}

static ty_status read_triangles(const maker* m, part* p, int mode)
{
    int indices = accessor_of(m, p, NULL);
    uint32_t count = indices < 0 ? vertices_of(m, p) : ty_gltf_accessor_count(m->job->gltf, indices);
    if (count < 3 || (mode == TY_GLTF_TRIANGLES && count % 3))
        return FAIL(m, "meshes[%d].primitives[%d] holds no triangles", m->mesh, p->primitive);
    uint32_t* corners = TY_TRY_ALLOC(uint32_t, count);
    p->triangles = ty_try_alloc(mode == TY_GLTF_TRIANGLES ? count / 3 : count - 2, sizeof p->triangles[0]);
    ty_status status = corners && p->triangles ? read_corners(m, p, corners, count, mode) : no_memory(m);
    ty_free(corners);
    return status;
}

// --- vertices that are used ---

static int ascending(const void* a, const void* b)
{
    uint32_t x = *(const uint32_t*)a, y = *(const uint32_t*)b;
    return x < y ? -1 : x > y;
}

static uint32_t drop_repeated(uint32_t* sorted, size_t count)
{
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (i == 0 || sorted[i] != sorted[i - 1])
            sorted[kept++] = sorted[i];
    return kept;
}

// Triangles named by place among the vertices used. Many primitives may share a large accessor: the cost is that of the
// triangles.
static ty_status take_used(const maker* m, part* p)
{
    size_t corners = 3 * (size_t)p->triangle_count;
    uint32_t* of = (uint32_t*)p->triangles;
    p->count = vertices_of(m, p);
    if (m->job->keeps_vertices || corners == 0)
        return TY_OK;
    p->which = TY_TRY_ALLOC(uint32_t, corners);
    if (!p->which)
        return no_memory(m);
    memcpy(p->which, of, corners * sizeof(uint32_t));
    qsort(p->which, corners, sizeof(uint32_t), ascending);
    p->count = drop_repeated(p->which, corners);
    for (size_t i = 0; i < corners; i++)
    {
        const uint32_t* found = bsearch(&of[i], p->which, p->count, sizeof(uint32_t), ascending);
        TY_ASSERT(found);
        of[i] = (uint32_t)(found - p->which);
    }
    return TY_OK;
}

// --- channels ---

// The values of a semantic into out + first vertex of each part, `width` floats each; a channel of fewer components
// leaves the others as they are. Parts without it are left out.
static ty_status read_channel(const maker* m, const char* semantic, int width, float* out)
{
    for (int i = 0; i < m->part_count; i++)
    {
        const part* p = &m->parts[i];
        int accessor = accessor_of(m, p, semantic), own = ty_gltf_accessor_width(m->job->gltf, accessor);
        if (accessor < 0 || own > width)
            continue;
        float* values = ty_try_alloc(p->count, (size_t)own * sizeof(float));
        if (!values)
            return no_memory(m);
        bool good = ty_gltf_read_elements(m->job->gltf, accessor, p->which, p->count, values);
        for (size_t v = 0; good && v < p->count; v++)
            memcpy(out + (p->first + v) * (size_t)width, values + v * (size_t)own, (size_t)own * sizeof(float));
        ty_free(values);
        if (!good)
            return FAIL(m, "meshes[%d].primitives[%d].%s cannot be read", m->mesh, p->primitive, semantic);
    }
    return TY_OK;
}

// How many parts have a semantic of that width (0 = any).
static int parts_with(const maker* m, const char* semantic, int width)
{
    int count = 0;
    for (int i = 0; i < m->part_count; i++)
    {
        int accessor = accessor_of(m, &m->parts[i], semantic);
        count += accessor >= 0 && (!width || ty_gltf_accessor_width(m->job->gltf, accessor) == width);
    }
    return count;
}

// An array of a semantic that every part has; NULL otherwise.
static ty_status read_common(const maker* m, const char* semantic, int width, float** out)
{
    *out = NULL;
    if (parts_with(m, semantic, width) < m->part_count)
        return TY_OK;
    *out = ty_try_alloc(m->out->vertex_count, (size_t)width * sizeof(float));
    return *out ? read_channel(m, semantic, width, *out) : no_memory(m);
}

// The set that a part's material asks for, where it is there.
static const char* uv_semantic(const maker* m, const part* p)
{
    bool second = m->job->uv_sets && m->job->uv_sets[p->slot] == 1 && accessor_of(m, p, "TEXCOORD_1") >= 0;
    return second ? "TEXCOORD_1" : "TEXCOORD_0";
}

static ty_status read_uvs(const maker* m)
{
    int some = parts_with(m, "TEXCOORD_0", 2) + parts_with(m, "TEXCOORD_1", 2);
    if (some == 0 || (m->job->keeps_vertices && parts_with(m, "TEXCOORD_0", 2) < m->part_count))
        return TY_OK;
    m->out->uvs = TY_TRY_ALLOC(ty_vec2, m->out->vertex_count);
    if (!m->out->uvs)
        return no_memory(m);
    ty_status status = TY_OK;
    for (int i = 0; i < m->part_count && status == TY_OK; i++)
    {
        maker one = *m;
        one.parts = &m->parts[i];
        one.part_count = 1;
        status = read_channel(&one, uv_semantic(m, &m->parts[i]), 2, &m->out->uvs[0].x);
    }
    for (uint32_t v = 0; v < m->out->vertex_count; v++) // images begin at the top
        m->out->uvs[v].y = 1.0f - m->out->uvs[v].y;
    return status;
}

// White where a part has no colours.
static ty_status read_colors(const maker* m)
{
    int fours = parts_with(m, "COLOR_0", 4), width = fours ? 4 : 3;
    if (fours + parts_with(m, "COLOR_0", 3) == 0 || m->job->keeps_vertices)
        return TY_OK;
    float* values = ty_mesh_add_attribute(m->out, "color", width);
    m->out->attributes[m->out->attribute_count - 1].space = TY_ATTRIBUTE_LINEAR_SRGB;
    for (size_t i = 0; i < (size_t)m->out->vertex_count * (size_t)width; i++)
        values[i] = 1.0f;
    return read_channel(m, "COLOR_0", width, values);
}

static ty_status read_curvature(const maker* m)
{
    float *both = NULL, *direction = NULL;
    uint32_t n = m->out->vertex_count;
    ty_status status = read_common(m, "_CURVATURE", 2, &both);
    if (status == TY_OK)
        status = read_common(m, "_DIRECTION", 3, &direction);
    if (status == TY_OK && both)
    {
        m->out->curvature_1 = TY_ALLOC(float, n);
        m->out->curvature_2 = TY_ALLOC(float, n);
        for (uint32_t i = 0; i < n; i++)
        {
            m->out->curvature_1[i] = both[2 * (size_t)i];
            m->out->curvature_2[i] = both[2 * (size_t)i + 1];
        }
    }
    m->out->direction_1 = (ty_vec3*)direction;
    ty_free(both);
    return status;
}

// Attributes of the first part that the others have too.
static ty_status read_attributes(const maker* m)
{
    const char* semantic;
    int first = m->parts[0].primitive;
    for (int i = 0; (semantic = ty_gltf_vertex_semantic(m->job->gltf, m->mesh, first, i)) != NULL; i++)
    {
        char name[32];
        int width = ty_gltf_accessor_width(m->job->gltf, accessor_of(m, &m->parts[0], semantic));
        if (!ty_gltf_plain_name(semantic, name) || strcmp(name, "curvature") == 0 || strcmp(name, "direction") == 0)
            continue;
        if (ty_mesh_find_attribute(m->out, name)) // COLOR_0 and _COLOR, _A and _a
            continue;
        if (m->out->attribute_count >= TY_GLTF_ATTRIBUTES_MAX)
            return FAIL(m, "meshes[%d] has more than %d attributes", m->mesh, TY_GLTF_ATTRIBUTES_MAX);
        float* values;
        ty_status status = read_common(m, semantic, width, &values);
        if (status == TY_OK && values)
            memcpy(ty_mesh_add_attribute(m->out, name, width), values,
                   (size_t)m->out->vertex_count * (size_t)width * sizeof(float));
        ty_free(values);
        if (status != TY_OK)
            return status;
    }
    return TY_OK;
}

static ty_status read_slots(const maker* m)
{
    if (!m->job->slot_names)
        return TY_OK;
    m->out->slots = TY_TRY_ALLOC(uint16_t, m->out->triangle_count);
    if (!m->out->slots)
        return no_memory(m);
    uint32_t t = 0;
    for (int i = 0; i < m->part_count; i++)
    {
        int slot = ty_mesh_add_slot(m->out, m->job->slot_names[m->parts[i].slot]);
        if (slot < 0)
            return FAIL(m, "meshes[%d] has more than %d materials", m->mesh, TY_MESH_MAX_SLOTS);
        for (uint32_t k = 0; k < m->parts[i].triangle_count; k++)
            m->out->slots[t++] = (uint16_t)slot;
    }
    return TY_OK;
}

// --- all together ---

static ty_status read_parts(maker* m)
{
    int count = ty_gltf_primitive_count(m->job->gltf, m->mesh);
    m->parts = TY_TRY_ALLOC(part, count);
    ty_status status = m->parts ? TY_OK : no_memory(m);
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        ty_gltf_primitive primitive = ty_gltf_get_primitive(m->job->gltf, m->mesh, i);
        if (primitive.mode < TY_GLTF_TRIANGLES)
            continue;
        part* p = &m->parts[m->part_count++];
        bool named = primitive.material >= 0 && primitive.material < m->job->material_count;
        p->primitive = i;
        p->slot = named ? primitive.material : m->job->material_count;
        status = read_triangles(m, p, primitive.mode);
        if (status == TY_OK)
            status = take_used(m, p);
    }
    return status;
}

static ty_status make_mesh(maker* m)
{
    uint64_t vertices = 0, triangles = 0;
    for (int i = 0; i < m->part_count; i++)
    {
        m->parts[i].first = (uint32_t)vertices;
        vertices += m->parts[i].count;
        triangles += m->parts[i].triangle_count;
        if (vertices >= UINT32_MAX || triangles >= UINT32_MAX / 3)
            return no_memory(m);
    }
    if (triangles == 0)
        return FAIL(m, "meshes[%d] holds no triangles", m->mesh);
    m->out = ty_mesh_create((uint32_t)vertices, (uint32_t)triangles);
    if (!m->out)
        return no_memory(m);
    size_t next = 0;
    for (int i = 0; i < m->part_count; i++)
    {
        for (size_t t = 0; t < m->parts[i].triangle_count; t++)
            for (int k = 0; k < 3; k++)
                m->out->triangles[next + t][k] = m->parts[i].first + m->parts[i].triangles[t][k];
        next += m->parts[i].triangle_count;
    }
    return TY_OK;
}

static ty_status fill_mesh(const maker* m)
{
    float* normals;
    ty_status status = read_channel(m, "POSITION", 3, &m->out->positions[0].x);
    if (status != TY_OK)
        return status;
    ty_free(m->out->normals);
    m->out->normals = NULL;
    status = read_common(m, "NORMAL", 3, &normals);
    m->out->normals = (ty_vec3*)normals;
    if (status == TY_OK)
        status = read_uvs(m);
    if (status == TY_OK)
        status = read_curvature(m);
    if (status == TY_OK)
        status = read_colors(m);
    if (status == TY_OK)
        status = read_attributes(m);
    return status == TY_OK ? read_slots(m) : status;
}

ty_status ty_gltf_gather_mesh(const ty_gltf_mesh_job* job, int index, ty_mesh** out)
{
    maker m = {.job = job, .mesh = index};
    ty_status status = read_parts(&m);
    if (status == TY_OK)
        status = make_mesh(&m);
    if (status == TY_OK)
        status = fill_mesh(&m);
    for (int i = 0; i < m.part_count; i++)
    {
        ty_free(m.parts[i].which);
        ty_free(m.parts[i].triangles);
    }
    ty_free(m.parts);
    *out = m.out; // what was made of it, on failure too: the caller destroys it
    return status;
}
