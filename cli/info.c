// SPDX-License-Identifier: Apache-2.0
// `tsuya info`: what a file holds: pictures (with the scene that made them), aggregates, glTF scenes, meshes, images.
#include "cli.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/log.h>
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/gltf.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/image/image.h>

static json_t* window_json(const int w[4])
{
    return json_pack("[i, i, i, i]", w[0], w[1], w[2], w[3]);
}

static json_t* attribute_json(const ty_exr_attribute* attribute)
{
    static const int value_counts[] = {0, 1, 0, 16, 8, 0, 0};
    switch (attribute->type)
    {
    case TY_EXR_STRING:
        return ty_json_from_text(attribute->text);
    case TY_EXR_INT1:
        return json_integer(attribute->integer[0]);
    case TY_EXR_RATIONAL:
        return json_pack("[i, i]", attribute->integer[0], attribute->integer[1]);
    case TY_EXR_FLOAT1:
        return json_real(attribute->value[0]);
    case TY_EXR_ENVMAP:
        return json_string(attribute->integer[0] == 0 ? "latlong" : "cube");
    case TY_EXR_MATRIX44:
    case TY_EXR_CHROMATICITIES:
        break;
    }
    json_t* array = json_array();
    for (int i = 0; i < value_counts[attribute->type]; i++)
    {
        json_array_append_new(array, json_real(attribute->value[i]));
    }
    return array;
}

static json_t* exr_json(const ty_exr* exr)
{
    static const char* const type_names[] = {"uint", "half", "float"};
    json_t* channels = json_object();
    for (int i = 0; i < exr->channel_count; i++)
    {
        json_object_set_new(channels, exr->channels[i].name, json_string(type_names[exr->channels[i].type]));
    }
    json_t* attributes = json_object();
    for (int i = 0; i < exr->attribute_count; i++)
    {
        if (strcmp(exr->attributes[i].name, "tsuya/recipe") != 0)
        {
            json_object_set_new(attributes, exr->attributes[i].name, attribute_json(&exr->attributes[i]));
        }
    }
    return json_pack("{s:s, s:o, s:o, s:o, s:o}", "type", "exr", "data_window", window_json(exr->data_window),
                     "display_window", window_json(exr->display_window), "channels", channels, "attributes",
                     attributes);
}

static ty_status info_exr(const char* path, bool recipe, json_t** out, ty_error* error)
{
    ty_exr* exr;
    ty_status status = ty_exr_read(path, &exr, error);
    if (status != TY_OK)
    {
        return status;
    }
    const ty_exr_attribute* text = ty_exr_find_attribute(exr, "tsuya/recipe");
    if (!recipe)
    {
        *out = exr_json(exr);
    }
    else if (text && text->text)
    {
        fputs(text->text, stdout);
    }
    else
    {
        status = ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "holds no recipe: it was not made by tsuya render");
    }
    ty_exr_destroy(exr);
    return status;
}

static ty_status print_recipe(const char* path, const char* recipe, ty_error* error)
{
    if (!recipe)
    {
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0, "holds no recipe");
    }
    fputs(recipe, stdout);
    return TY_OK;
}

static ty_status info_aggregate(const char* path, bool recipe, json_t** out, ty_error* error)
{
    ty_aggregate* aggregate;
    ty_status status = ty_aggregate_read(path, NULL, &aggregate, error);
    if (status != TY_OK)
    {
        return status;
    }
    if (recipe)
    {
        status = print_recipe(path, aggregate->recipe, error);
        ty_aggregate_destroy(aggregate);
        return status;
    }
    json_t* attributes = json_array();
    for (int i = 0; i < aggregate->attribute_count; i++)
    {
        json_array_append_new(attributes, ty_json_from_text(aggregate->attributes[i].name));
    }
    if (aggregate->velocities)
    {
        json_array_append_new(attributes, json_string("velocity"));
    }
    if (aggregate->spins)
    {
        json_array_append_new(attributes, json_string("spin"));
    }
    ty_error none;
    ty_bytes state;
    if (ty_aggregate_read_state(path, &state, &none) != TY_OK)
        state = (ty_bytes){0};
    json_t* metrics = aggregate->metrics ? json_loads(aggregate->metrics, 0, NULL) : NULL;
    *out = json_pack("{s:s, s:i, s:i, s:o, s:o, s:s?, s:o}", "type", "aggregate", "instances",
                     (int)aggregate->instance_count, "prototypes", aggregate->prototype_count, "attributes", attributes,
                     "state", state.size > 0 ? json_integer((json_int_t)state.size) : json_null(), "hash",
                     aggregate->hash, "metrics", metrics ? metrics : json_null());
    ty_bytes_term(&state);
    ty_aggregate_destroy(aggregate);
    return TY_OK;
}

static json_t* bounds_json(ty_bounds b)
{
    return json_pack("{s:[f, f, f], s:[f, f, f]}", "low", (double)b.low.x, (double)b.low.y, (double)b.low.z, "high",
                     (double)b.high.x, (double)b.high.y, (double)b.high.z);
}

static json_t* gltf_meshes_json(const ty_gltf_scene* scene)
{
    json_t* meshes = json_array();
    for (int i = 0; i < scene->mesh_count; i++)
    {
        const ty_mesh* mesh = scene->meshes[i];
        if (!mesh)
        {
            continue;
        }
        json_t* attributes = json_array();
        for (int k = 0; k < mesh->attribute_count; k++)
        {
            json_array_append_new(attributes, ty_json_from_text(mesh->attributes[k].name));
        }
        json_t* slots = json_array();
        for (int k = 0; k < mesh->slot_count; k++)
        {
            json_array_append_new(slots, ty_json_from_text(mesh->slot_names[k]));
        }
        json_array_append_new(meshes,
                              json_pack("{s:s, s:i, s:i, s:b, s:o, s:o}", "name", scene->mesh_names[i], "vertices",
                                        (int)mesh->vertex_count, "triangles", (int)mesh->triangle_count, "uv",
                                        mesh->uvs != NULL, "attributes", attributes, "materials", slots));
    }
    return meshes;
}

static json_t* gltf_json(const ty_gltf_scene* scene)
{
    static const char* const kinds[] = {"point", "spot", "directional"};
    json_t *objects = json_array(), *materials = json_array(), *cameras = json_array(), *lights = json_array();
    json_t* warnings = json_array();
    for (int i = 0; i < scene->object_count; i++)
    {
        const ty_gltf_object* o = &scene->objects[i];
        json_array_append_new(objects, json_pack("{s:s, s:s, s:i}", "name", o->name, "mesh", scene->mesh_names[o->mesh],
                                                 "instances", o->instances ? (int)o->instances->instance_count : 1));
    }
    for (int i = 0; i < scene->material_count; i++)
    {
        json_array_append_new(materials, json_string(scene->materials[i].name));
    }
    for (int i = 0; i < scene->camera_count; i++)
    {
        json_array_append_new(cameras, json_string(scene->cameras[i].name));
    }
    for (int i = 0; i < scene->light_count; i++)
    {
        const ty_gltf_light* l = &scene->lights[i];
        json_array_append_new(lights, json_pack("{s:s, s:s, s:f}", "name", l->name, "type", kinds[l->kind], "intensity",
                                                (double)l->intensity));
    }
    for (int i = 0; i < scene->warning_count; i++)
    {
        json_array_append_new(warnings, ty_json_from_text(scene->warnings[i]));
    }
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:i, s:o, s:o}", "type", "gltf", "meshes", gltf_meshes_json(scene),
                     "objects", objects, "materials", materials, "cameras", cameras, "lights", lights, "images",
                     scene->image_count, "bounds", bounds_json(scene->bounds), "left_out", warnings);
}

static ty_status info_gltf(const char* path, bool recipe, json_t** out, ty_error* error)
{
    ty_gltf_scene* scene;
    ty_status status = ty_gltf_scene_open(path, NULL, NULL, &scene, error);
    if (status != TY_OK)
    {
        return status;
    }
    bool is_aggregate = scene->is_aggregate;
    if (is_aggregate || recipe)
    {
        ty_gltf_scene_destroy(scene);
        return info_aggregate(path, recipe, out, error);
    }
    status = ty_gltf_scene_read_meshes(scene, error);
    if (status == TY_OK)
    {
        *out = gltf_json(scene);
    }
    ty_gltf_scene_destroy(scene);
    return status;
}

static ty_status info_mesh(const char* path, bool recipe, json_t** out, ty_error* error)
{
    ty_mesh* mesh;
    ty_status status = ty_mesh_read(path, &mesh, error);
    if (status != TY_OK)
    {
        return status;
    }
    if (recipe)
    {
        status = print_recipe(path, mesh->recipe, error);
        ty_mesh_destroy(mesh);
        return status;
    }
    ty_mesh_topology topology;
    ty_mesh_analyse(mesh, &topology);
    json_t* attributes = json_array();
    for (int i = 0; i < mesh->attribute_count; i++)
    {
        json_array_append_new(attributes, ty_json_from_text(mesh->attributes[i].name));
    }
    ty_vec3 low = mesh->bounds.low, high = mesh->bounds.high;
    *out = json_pack("{s:s, s:i, s:i, s:i, s:i, s:b, s:b, s:f, s:f, s:[f, f, f], s:[f, f, f], s:o, s:s?}", "type",
                     "mesh", "vertices", (int)mesh->vertex_count, "triangles", (int)mesh->triangle_count, "components",
                     (int)topology.components, "boundary_edges", (int)topology.boundary_edges, "closed",
                     topology.closed, "convex", topology.convex, "area", topology.area, "volume", topology.volume,
                     "low", (double)low.x, (double)low.y, (double)low.z, "high", (double)high.x, (double)high.y,
                     (double)high.z, "attributes", attributes, "hash", mesh->hash);
    ty_mesh_destroy(mesh);
    return TY_OK;
}

static ty_status info_image(const char* path, json_t** out, ty_error* error)
{
    ty_image image;
    ty_status status = ty_image_read(path, &image, error);
    if (status == TY_OK)
    {
        *out = json_pack("{s:s, s:i, s:i, s:i, s:b, s:o}", "type", "image", "width", image.width, "height",
                         image.height, "channels", image.channels, "float", image.is_float, "color_space",
                         ty_json_from_text(image.color_space));
        ty_image_term(&image);
    }
    return status;
}

static bool is_one_of(const char* extension, const char* const* list)
{
    for (; *list; list++)
    {
        if (strcmp(extension, *list) == 0)
        {
            return true;
        }
    }
    return false;
}

static ty_status read_info(const char* path, bool recipe, json_t** out, ty_error* error)
{
    static const char* const meshes[] = {"ply", "obj", "stl", "fbx", "dae", "off", NULL};
    const char* extension = ty_path_extension(path);
    if (strcmp(extension, "glb") == 0 || strcmp(extension, "gltf") == 0)
    {
        return info_gltf(path, recipe, out, error);
    }
    if (strcmp(extension, "exr") == 0)
    {
        ty_status status = info_exr(path, recipe, out, error);
        if (status == TY_OK || recipe)
        {
            return status;
        }
        return info_image(path, out, error); // tiled, multi-part, DWA
    }
    if (is_one_of(extension, meshes))
    {
        return info_mesh(path, recipe, out, error);
    }
    if (recipe)
    {
        return ty_error_set_at(error, TY_BAD_FILE, path, 0, 0,
                               "only pictures (.exr), aggregates (.glb) and meshes (.ply) hold one");
    }
    return info_image(path, out, error);
}

// "key: value" lines, nested keys indented; metrics in words.
static void print_text(const json_t* value, int indent)
{
    const char* key;
    json_t* item;
    json_object_foreach((json_t*)value, key, item)
    {
        printf("%*s%s:", indent, "", key);
        if (json_is_object(item))
        {
            printf("\n");
            if (strcmp(key, "metrics") == 0)
            {
                ty_info_print_metrics(item, indent + 2);
            }
            else
            {
                print_text(item, indent + 2);
            }
            continue;
        }
        char* text = json_dumps(item, JSON_ENCODE_ANY | JSON_REAL_PRECISION(7));
        printf(" %s\n", text);
        free(text); // jansson's own allocation
    }
}

static ty_status run(const ty_arguments* arguments)
{
    ty_error error = {0};
    json_t* value = NULL;
    ty_status status = read_info(arguments->positional[0], ty_argument_has(arguments, "recipe"), &value, &error);
    if (status != TY_OK)
    {
        ty_log_error(&error);
        return status;
    }
    if (value && ty_argument_has(arguments, "json"))
    {
        return ty_json_print(value);
    }
    if (value)
    {
        print_text(value, 0);
        json_decref(value);
    }
    return ty_output_finish();
}

static const ty_option options[] = {
    {"recipe", 0, NULL, "print the scene or recipe that made it; render and pack accept that text"},
    {"json", 0, NULL, "as JSON"},
};

const ty_command ty_command_info = {
    "info",
    "FILE",
    "tell what a picture, aggregate, mesh or image holds",
    "tsuya info out/rice_bowl.exr --recipe > again.yaml",
    1,
    1,
    options,
    TY_PARAM_COUNT(options),
    run,
};
