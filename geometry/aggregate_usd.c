// SPDX-License-Identifier: Apache-2.0
// Aggregates as USD text: one PointInstancer, its prototypes as Mesh prims beneath it.
#include "aggregate_write.h"
#include "glb_build.h"
#include "placement.h"
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/sink.h>
#include <tsuya/geometry/aggregate_export.h>

// --- values ---

typedef void put_fn(ty_sink* text, const void* context, size_t index);

// `type name = [...]`, and what stands behind it.
static void put_array(ty_sink* text, const char* indent, const char* declaration, size_t count, put_fn* put,
                      const void* context, const char* behind)
{
    ty_sink_format(text, "%s%s = [", indent, declaration);
    for (size_t i = 0; i < count; i++)
    {
        if (i > 0)
            ty_sink_put(text, ", ", 2);
        put(text, context, i);
    }
    ty_sink_format(text, "]%s\n", behind);
}

static void put_vec3(ty_sink* text, const void* context, size_t index)
{
    ty_sink_vector(text, &((const ty_vec3*)context)[index].x, 3);
}

static void put_vec2(ty_sink* text, const void* context, size_t index)
{
    ty_sink_vector(text, &((const ty_vec2*)context)[index].x, 2);
}

static void put_number(ty_sink* text, const void* context, size_t index)
{
    ty_sink_float(text, ((const float*)context)[index]);
}

static void put_whole(ty_sink* text, const void* context, size_t index)
{
    ty_sink_format(text, "%u", ((const uint32_t*)context)[index]);
}

static void put_three(ty_sink* text, const void* context, size_t index)
{
    (void)context;
    (void)index;
    ty_sink_put(text, "3", 1);
}

// A string in triple quotes: a recipe has lines of its own.
static void put_string(ty_sink* text, const char* string)
{
    ty_sink_put(text, "\"\"\"", 3);
    for (; *string; string++)
    {
        if (*string == '"' || *string == '\\')
            ty_sink_put(text, "\\", 1);
        ty_sink_put(text, string, 1);
    }
    ty_sink_put(text, "\"\"\"", 3);
}

// A prim's name: letters, digits and underscores, no digit first.
static void identifier(const char* name, char out[64])
{
    size_t n = 0;
    if (*name >= '0' && *name <= '9')
        out[n++] = '_';
    for (; *name && n < 63; name++)
    {
        bool plain = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z') || (*name >= '0' && *name <= '9');
        out[n++] = plain ? *name : '_';
    }
    out[n] = '\0';
}

// --- prototypes ---

static bool has_material(const ty_mesh* mesh)
{
    return mesh->slot_count == 1 && mesh->slot_names[0][0];
}

static void put_extent(ty_sink* text, const char* indent, ty_bounds box)
{
    const ty_vec3 corners[2] = {box.low, box.high};
    put_array(text, indent, "float3[] extent", 2, put_vec3, corners, "");
}

static void put_mesh(ty_sink* text, const ty_mesh* mesh, int index)
{
    static const char indent[] = "            ",
                      vertex[] = " (\n                interpolation = \"vertex\"\n            )";
    const char* binding =
        has_material(mesh) ? " (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )" : "";
    ty_bounds box = ty_bounds_empty();
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        box = ty_bounds_add(box, mesh->positions[i]);
    ty_sink_format(text, "        def Mesh \"prototype_%d\"%s\n        {\n", index, binding);
    put_extent(text, indent, box);
    put_array(text, indent, "int[] faceVertexCounts", mesh->triangle_count, put_three, NULL, "");
    put_array(text, indent, "int[] faceVertexIndices", 3 * (size_t)mesh->triangle_count, put_whole, mesh->triangles,
              "");
    if (has_material(mesh))
    {
        char name[64];
        identifier(mesh->slot_names[0], name);
        ty_sink_format(text, "%srel material:binding = </Aggregate/Materials/%s>\n", indent, name);
    }
    put_array(text, indent, "normal3f[] normals", mesh->vertex_count, put_vec3, mesh->normals, vertex);
    put_array(text, indent, "point3f[] points", mesh->vertex_count, put_vec3, mesh->positions, "");
    if (mesh->uvs)
        put_array(text, indent, "texCoord2f[] primvars:st", mesh->vertex_count, put_vec2, mesh->uvs, vertex);
    for (int k = 0; k < mesh->attribute_count; k++)
    {
        char declaration[80] = "float[] primvars:";
        if (mesh->attributes[k].components == 1)
            put_array(text, indent, strcat(declaration, mesh->attributes[k].name), mesh->vertex_count, put_number,
                      mesh->attributes[k].values, vertex);
    }
    ty_sink_format(text, "%suniform token subdivisionScheme = \"none\"\n        }\n\n", indent);
}

static void put_prototypes(ty_sink* text, const ty_aggregate* a)
{
    ty_sink_format(text, "\n    def Scope \"Prototypes\"\n    {\n");
    for (int p = 0; p < a->prototype_count; p++)
        put_mesh(text, a->prototypes[p], p);
    ty_sink_format(text, "    }\n");
}

static void put_materials(ty_sink* text, const ty_aggregate* a)
{
    bool begun = false;
    for (int p = 0; p < a->prototype_count; p++)
    {
        bool again = !has_material(a->prototypes[p]);
        for (int k = 0; k < p && !again; k++)
            again = has_material(a->prototypes[k]) &&
                    strcmp(a->prototypes[k]->slot_names[0], a->prototypes[p]->slot_names[0]) == 0;
        if (again)
            continue;
        char name[64];
        identifier(a->prototypes[p]->slot_names[0], name);
        if (!begun)
            ty_sink_format(text, "\n    def Scope \"Materials\"\n    {\n");
        begun = true;
        ty_sink_format(text, "        def Material \"%s\"\n        {\n        }\n\n", name);
    }
    if (begun)
        ty_sink_format(text, "    }\n");
}

// --- instances ---

// USD writes the real part first.
static void put_rotation(ty_sink* text, const void* context, size_t index)
{
    ty_quat q = ((const ty_placement*)context)[index].rotation;
    ty_sink_vector(text, (const float[4]){q.w, q.x, q.y, q.z}, 4);
}

static void put_position(ty_sink* text, const void* context, size_t index)
{
    ty_sink_vector(text, &((const ty_placement*)context)[index].translation.x, 3);
}

static void put_scale(ty_sink* text, const void* context, size_t index)
{
    ty_sink_vector(text, &((const ty_placement*)context)[index].scale.x, 3);
}

// USD counts in degrees here.
static void put_degrees(ty_sink* text, const void* context, size_t index)
{
    ty_vec3 w = ty_mul(((const ty_vec3*)context)[index], 180.0f / TY_PI);
    ty_sink_vector(text, &w.x, 3);
}

// Of what is written, so that the same comes out of a file read back.
static ty_bounds instance_bounds(const ty_aggregate* a, const ty_placement* placements)
{
    ty_bounds all = ty_bounds_empty();
    for (uint32_t i = 0; i < a->instance_count; i++)
    {
        ty_bounds b = a->prototypes[a->prototype_index[i]]->bounds;
        ty_affine m = ty_placement_compose(&placements[i]);
        for (int k = 0; k < 8; k++)
        {
            ty_vec3 p = {k & 1 ? b.high.x : b.low.x, k & 2 ? b.high.y : b.low.y, k & 4 ? b.high.z : b.low.z};
            all = ty_bounds_add(all, ty_map_point(&m, p));
        }
    }
    return all;
}

static void put_instances(ty_sink* text, const ty_aggregate* a, const ty_placement* placements)
{
    static const char indent[] = "    ", vertex[] = " (\n        interpolation = \"vertex\"\n    )";
    size_t n = a->instance_count;
    if (a->spins)
        put_array(text, indent, "vector3f[] angularVelocities", n, put_degrees, a->spins, "");
    put_extent(text, indent, instance_bounds(a, placements));
    put_array(text, indent, "int64[] ids", n, put_whole, a->ids, "");
    put_array(text, indent, "quath[] orientations", n, put_rotation, placements, "");
    // The same without the rounding to half floats, which turns a grain by up to .05 degrees.
    put_array(text, indent, "quatf[] orientationsf", n, put_rotation, placements, "");
    put_array(text, indent, "point3f[] positions", n, put_position, placements, "");
    for (int k = 0; k < a->attribute_count; k++)
    {
        char declaration[80] = "float[] primvars:";
        const ty_instance_attribute* attribute = ty_aggregate_attribute_by_name(a, k);
        put_array(text, indent, strcat(declaration, attribute->name), n, put_number, attribute->values, vertex);
    }
    put_array(text, indent, "int[] protoIndices", n, put_whole, a->prototype_index, "");
    ty_sink_format(text, "%srel prototypes = [", indent);
    for (int p = 0; p < a->prototype_count; p++)
        ty_sink_format(text, "%s</Aggregate/Prototypes/prototype_%d>", p > 0 ? ", " : "", p);
    ty_sink_format(text, "]\n");
    put_array(text, indent, "float3[] scales", n, put_scale, placements, "");
    if (a->velocities)
        put_array(text, indent, "vector3f[] velocities", n, put_vec3, a->velocities, "");
}

static void put_head(ty_sink* text, const ty_aggregate* a)
{
    json_t* read = a->metrics ? json_loads(a->metrics, JSON_REJECT_DUPLICATES, NULL) : NULL;
    char* metrics = json_is_object(read) ? ty_json_text(read) : NULL; // as a GLB has them
    const char* const own[3][2] = {{"hash", a->hash}, {"metrics", metrics}, {"recipe", a->recipe}};
    ty_sink_format(text,
                   "#usda 1.0\n(\n    defaultPrim = \"Aggregate\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
                   "def PointInstancer \"Aggregate\" (\n    customData = {\n        dictionary tsuya = {\n");
    for (int i = 0; i < 3; i++)
        if (own[i][1])
        {
            ty_sink_format(text, "            string %s = ", own[i][0]);
            put_string(text, own[i][1]);
            ty_sink_put(text, "\n", 1);
        }
    ty_sink_format(text, "        }\n    }\n)\n{\n");
    json_decref(read);
    ty_free(metrics);
}

ty_status ty_aggregate_write_usd(const char* path, const ty_aggregate* a, ty_error* error)
{
    ty_status status = ty_aggregate_check_content(a, path, error);
    if (status != TY_OK)
        return status;
    ty_placement* placements;
    status = ty_aggregate_split(a, path, "USD's instancer", &placements, error);
    if (status != TY_OK)
        return status;
    ty_sink text = {0};
    put_head(&text, a);
    put_instances(&text, a, placements);
    put_materials(&text, a);
    put_prototypes(&text, a);
    ty_sink_format(&text, "}\n");
    status = ty_file_write(path, text.bytes, text.size, error);
    ty_sink_term(&text);
    ty_free(placements);
    return status;
}
