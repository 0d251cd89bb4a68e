// SPDX-License-Identifier: Apache-2.0
// From the importer's model to an aggregate.
#include "aggregate_gather.h"
#include "glb.h"
#include "gltf_mesh.h"
#include "placement.h"
#include <string.h>

typedef struct gatherer
{
    const char* name;
    const ty_gltf* gltf;
    ty_error* error;
    ty_aggregate* aggregate;
    ty_affine* node_maps; // to the file's space
    uint8_t* taken;       // by instance: its place is filled
    float* floats;        // scratch, 4 per instance of a node
    uint32_t* integers;   // scratch, one per instance of a node
    uint32_t next;        // place of the next instance without _ORDER
    bool is_single;       // one node's instances, in the node's space
} gatherer;

#define FAIL(g, ...) ty_error_set_at((g)->error, TY_BAD_FILE, (g)->name, 0, 0, __VA_ARGS__)

static ty_status no_memory(const gatherer* g)
{
    return ty_error_set_at(g->error, TY_NO_MEMORY, g->name, 0, 0, "no memory for what the file holds");
}

// --- nodes ---

static ty_affine local_map(const ty_gltf_node* n)
{
    const float* m = n->matrix;
    if (n->has_matrix)
        return (ty_affine){{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    ty_placement p = {{n->translation[0], n->translation[1], n->translation[2]},
                      {n->rotation[0], n->rotation[1], n->rotation[2], n->rotation[3]},
                      {n->scale[0], n->scale[1], n->scale[2]}};
    return ty_placement_compose(&p);
}

static bool is_identity(const ty_affine* m)
{
    ty_affine identity = ty_affine_identity();
    return memcmp(m, &identity, sizeof identity) == 0;
}

// The identity is left out, so that files of our own keep every bit, signs of zeros included.
static ty_affine concatenate(const ty_affine* outer, const ty_affine* inner)
{
    return is_identity(outer) ? *inner : ty_affine_multiply(outer, inner);
}

// Maps of all nodes to the file's space: up the parents to one that is known, then back down the same path.
static ty_status map_nodes(gatherer* g)
{
    int count = ty_gltf_node_count(g->gltf);
    int* path = TY_TRY_ALLOC(int, count);
    bool* known = TY_TRY_ALLOC(bool, count);
    g->node_maps = TY_TRY_ALLOC(ty_affine, count);
    ty_status status = path && known && g->node_maps ? TY_OK : no_memory(g);
    for (int i = 0; i < count && status == TY_OK; i++)
    {
        int length = 0;
        for (int at = i; at >= 0 && !known[at] && length < count; at = ty_gltf_get_node(g->gltf, at).parent)
            path[length++] = at;
        while (length-- > 0)
        {
            ty_gltf_node node = ty_gltf_get_node(g->gltf, path[length]);
            ty_affine own = local_map(&node);
            g->node_maps[path[length]] = node.parent < 0 ? own : concatenate(&g->node_maps[node.parent], &own);
            known[path[length]] = true;
        }
    }
    ty_free(path);
    ty_free(known);
    return status;
}

static uint32_t instances_of(const ty_gltf* gltf, int node)
{
    ty_gltf_node n = ty_gltf_get_node(gltf, node);
    if (n.mesh < 0 || !n.instanced)
        return n.mesh >= 0;
    const char* semantic = ty_gltf_instance_semantic(gltf, node, 0);
    return semantic ? ty_gltf_accessor_count(gltf, ty_gltf_instance_accessor(gltf, node, semantic)) : 0;
}

// --- instances ---

// Elements of a node's attribute; the given value for all when it is absent.
static ty_status read_column(const gatherer* g, int node, const char* semantic, int width, uint32_t count,
                             const float* absent)
{
    int accessor = ty_gltf_instance_accessor(g->gltf, node, semantic);
    if (accessor < 0)
    {
        for (size_t i = 0; i < count; i++)
            memcpy(g->floats + i * (size_t)width, absent, (size_t)width * sizeof(float));
        return TY_OK;
    }
    if (ty_gltf_accessor_width(g->gltf, accessor) != width || ty_gltf_accessor_count(g->gltf, accessor) != count ||
        !ty_gltf_read_floats(g->gltf, accessor, g->floats))
        return FAIL(g, "nodes[%d].%s cannot be read", node, semantic);
    return TY_OK;
}

// The places of a node's instances among all.
static ty_status read_places(gatherer* g, int node, uint32_t count, uint32_t* places)
{
    int accessor = g->is_single ? -1 : ty_gltf_instance_accessor(g->gltf, node, "_ORDER"); // among those of all nodes
    if (accessor >= 0 &&
        (ty_gltf_accessor_count(g->gltf, accessor) != count || !ty_gltf_read_integers(g->gltf, accessor, places)))
        return FAIL(g, "nodes[%d]._ORDER cannot be read", node);
    for (uint32_t i = 0; i < count; i++)
    {
        if (accessor < 0)
            places[i] = g->next++;
        if (places[i] >= g->aggregate->instance_count || g->taken[places[i]])
            return FAIL(g, "nodes[%d], instance %u: place %u is taken or beyond the %u instances", node, i, places[i],
                        g->aggregate->instance_count);
        g->taken[places[i]] = 1;
    }
    return TY_OK;
}

static ty_status read_placements(const gatherer* g, int node, uint32_t count, const uint32_t* places)
{
    const float zero[3] = {0, 0, 0}, one[3] = {1, 1, 1}, straight[4] = {0, 0, 0, 1};
    ty_placement* placements = TY_TRY_ALLOC(ty_placement, count);
    if (!placements)
        return no_memory(g);
    ty_status status = read_column(g, node, "TRANSLATION", 3, count, zero);
    for (uint32_t i = 0; i < count && status == TY_OK; i++)
        placements[i].translation = ((const ty_vec3*)g->floats)[i];
    if (status == TY_OK)
        status = read_column(g, node, "ROTATION", 4, count, straight);
    for (uint32_t i = 0; i < count && status == TY_OK; i++)
        placements[i].rotation = ((const ty_quat*)g->floats)[i];
    if (status == TY_OK)
        status = read_column(g, node, "SCALE", 3, count, one);
    for (uint32_t i = 0; i < count && status == TY_OK; i++)
    {
        placements[i].scale = ((const ty_vec3*)g->floats)[i];
        g->aggregate->transforms[places[i]] = ty_placement_compose(&placements[i]);
    }
    ty_free(placements);
    return status;
}

// _MATRIX0.. are the columns themselves, bit for bit, where a node has all three.
static ty_status read_matrices(const gatherer* g, int node, uint32_t count, const uint32_t* places)
{
    static const char* const names[3] = {"_MATRIX0", "_MATRIX1", "_MATRIX2"};
    for (int k = 0; k < 3; k++)
        if (ty_gltf_instance_accessor(g->gltf, node, names[k]) < 0)
            return TY_OK;
    for (int k = 0; k < 3; k++)
    {
        const float none[3] = {0, 0, 0};
        ty_status status = read_column(g, node, names[k], 3, count, none);
        if (status != TY_OK)
            return status;
        for (uint32_t i = 0; i < count; i++)
        {
            ty_affine* m = &g->aggregate->transforms[places[i]];
            *(k == 0 ? &m->x : k == 1 ? &m->y : &m->z) = ((const ty_vec3*)g->floats)[i];
        }
    }
    return TY_OK;
}

// m of a node applied to a velocity; to a spin, which a mirror turns round and a size leaves as it is, by its
// cofactors.
static ty_vec3 map_spin(const ty_affine* m, ty_vec3 w)
{
    ty_vec3 c = ty_mul(ty_cross(m->y, m->z), w.x);
    c = ty_add(ty_mad(c, ty_cross(m->z, m->x), w.y), ty_mul(ty_cross(m->x, m->y), w.z));
    float size = ty_pow(fabsf(ty_affine_determinant(m)), 2.0f / 3.0f);
    return size > 0.0f ? ty_mul(c, 1.0f / size) : c;
}

// _VELOCITY or _SPIN where a node has it as vectors.
static ty_status read_motion(const gatherer* g, int node, uint32_t count, const uint32_t* places, bool spin)
{
    const char* semantic = spin ? "_SPIN" : "_VELOCITY";
    const float none[3] = {0};
    int accessor = ty_gltf_instance_accessor(g->gltf, node, semantic);
    if (accessor < 0 || ty_gltf_accessor_width(g->gltf, accessor) != 3)
        return TY_OK;
    ty_status status = read_column(g, node, semantic, 3, count, none);
    if (status != TY_OK)
        return status;
    const ty_affine* map = g->is_single ? NULL : &g->node_maps[node];
    ty_vec3* out = spin ? ty_aggregate_add_spins(g->aggregate) : ty_aggregate_add_velocities(g->aggregate);
    for (uint32_t i = 0; i < count; i++)
    {
        ty_vec3 v = ((const ty_vec3*)g->floats)[i];
        if (map && !is_identity(map))
            v = spin ? map_spin(map, v) : ty_map_vector(map, v);
        out[places[i]] = v;
    }
    return TY_OK;
}

static ty_status read_scalars(const gatherer* g, int node, uint32_t count, const uint32_t* places)
{
    static const char* const own[] = {"id", "order", "matrix0", "matrix1", "matrix2", "velocity", "spin"};
    const char* semantic;
    for (int k = 0; (semantic = ty_gltf_instance_semantic(g->gltf, node, k)) != NULL; k++)
    {
        char name[32];
        bool other = ty_gltf_plain_name(semantic, name);
        for (size_t i = 0; i < sizeof own / sizeof own[0]; i++)
            other = other && strcmp(name, own[i]) != 0;
        if (!other || ty_gltf_accessor_width(g->gltf, ty_gltf_instance_accessor(g->gltf, node, semantic)) != 1)
            continue;
        if (g->aggregate->attribute_count >= TY_GLTF_ATTRIBUTES_MAX && !ty_aggregate_find_attribute(g->aggregate, name))
            return FAIL(g, "more than %d instance attributes", TY_GLTF_ATTRIBUTES_MAX);
        const float none[1] = {0};
        ty_status status = read_column(g, node, semantic, 1, count, none);
        if (status != TY_OK)
            return status;
        float* values = ty_aggregate_add_attribute(g->aggregate, name);
        for (uint32_t i = 0; i < count; i++)
            values[places[i]] = g->floats[i];
    }
    int accessor = ty_gltf_instance_accessor(g->gltf, node, "_ID");
    if (accessor < 0)
        return TY_OK;
    if (ty_gltf_accessor_count(g->gltf, accessor) != count || !ty_gltf_read_integers(g->gltf, accessor, g->integers))
        return FAIL(g, "nodes[%d]._ID holds what is no whole number", node);
    for (uint32_t i = 0; i < count; i++)
        g->aggregate->ids[places[i]] = g->integers[i];
    return TY_OK;
}

static ty_status read_node(gatherer* g, int node)
{
    ty_gltf_node n = ty_gltf_get_node(g->gltf, node);
    uint32_t count = instances_of(g->gltf, node);
    if (count == 0)
        return TY_OK;
    g->floats = ty_try_alloc(count, 4 * sizeof(float));
    g->integers = TY_TRY_ALLOC(uint32_t, count);
    uint32_t* places = TY_TRY_ALLOC(uint32_t, count);
    ty_status status = g->floats && g->integers && places ? read_places(g, node, count, places) : no_memory(g);
    if (status == TY_OK)
        status = read_placements(g, node, count, places);
    if (status == TY_OK)
        status = read_matrices(g, node, count, places);
    if (status == TY_OK)
        status = read_motion(g, node, count, places, false);
    if (status == TY_OK)
        status = read_motion(g, node, count, places, true);
    if (status == TY_OK)
        status = read_scalars(g, node, count, places);
    for (uint32_t i = 0; i < count && status == TY_OK; i++)
    {
        g->aggregate->prototype_index[places[i]] = g->is_single ? 0 : (uint32_t)n.mesh;
        ty_affine* m = &g->aggregate->transforms[places[i]];
        if (!g->is_single)
            *m = concatenate(&g->node_maps[node], m);
    }
    ty_free(g->floats);
    ty_free(g->integers);
    ty_free(places);
    return status;
}

static ty_status gather(gatherer* g)
{
    uint64_t total = 0;
    int nodes = ty_gltf_node_count(g->gltf), meshes = ty_gltf_mesh_count(g->gltf);
    for (int i = 0; i < nodes; i++)
        total += instances_of(g->gltf, i);
    if (total == 0 || total >= UINT32_MAX)
        return FAIL(g, "no instances");
    g->aggregate = ty_aggregate_create((uint32_t)total, meshes);
    g->taken = TY_TRY_ALLOC(uint8_t, total);
    if (!g->aggregate || !g->taken)
        return no_memory(g);
    const ty_gltf_mesh_job job = {.name = g->name, .gltf = g->gltf, .keeps_vertices = true, .error = g->error};
    ty_status status = map_nodes(g);
    for (int i = 0; i < meshes && status == TY_OK; i++)
        status = ty_gltf_gather_mesh(&job, i, &g->aggregate->prototypes[i]);
    for (int i = 0; i < nodes && status == TY_OK; i++)
        status = read_node(g, i);
    return status;
}

ty_status ty_aggregate_gather(const char* name, const ty_gltf* gltf, ty_aggregate** out, ty_error* error)
{
    gatherer g = {.name = name, .gltf = gltf, .error = error};
    ty_status status = gather(&g);
    ty_free(g.node_maps);
    ty_free(g.taken);
    if (status != TY_OK)
        ty_aggregate_destroy(g.aggregate);
    *out = status == TY_OK ? g.aggregate : NULL;
    return status;
}

ty_status ty_aggregate_gather_node(const char* name, const ty_gltf* gltf, int node, ty_aggregate** out, ty_error* error)
{
    uint32_t count = instances_of(gltf, node);
    gatherer g = {.name = name, .gltf = gltf, .error = error, .is_single = true};
    g.aggregate = ty_aggregate_create(count, 0);
    g.taken = TY_TRY_ALLOC(uint8_t, count);
    ty_status status = g.aggregate && g.taken ? read_node(&g, node) : no_memory(&g);
    ty_free(g.taken);
    if (status != TY_OK)
        ty_aggregate_destroy(g.aggregate);
    *out = status == TY_OK ? g.aggregate : NULL;
    return status;
}
