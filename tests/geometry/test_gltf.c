// SPDX-License-Identifier: Apache-2.0
// glTF scenes: what the file says is what is in memory, and what it cannot say is refused.
#include "gltf_text.h"
#include <math.h>
#include <stdlib.h>
#include <tsuya/geometry/gltf.h>
#include <tsuya/geometry/mesh_file.h>

static const float corners[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
static const float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
static const uint16_t quad[6] = {0, 1, 2, 0, 2, 3};

// A quad with uv (accessors 0, 1, 2) and more on demand.
static gltf_text quad_text(void)
{
    gltf_text g = {0};
    assert_int_equal(gltf_floats(&g, corners, 4, 3), 0);
    assert_int_equal(gltf_floats(&g, uvs, 4, 2), 1);
    assert_int_equal(gltf_shorts(&g, quad, 6), 2);
    return g;
}

#define QUAD "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2}"
#define MESH "\"meshes\":[{\"name\":\"sheet\",\"primitives\":[" QUAD "]}],"

static ty_gltf_scene* open_text(const gltf_text* g, const char* rest)
{
    ty_gltf_scene* scene = NULL;
    ty_error error = {0};
    gltf_write(g, "test.gltf", rest);
    ty_status status = ty_gltf_scene_open("test.gltf", NULL, NULL, &scene, &error);
    if (status == TY_OK)
        status = ty_gltf_scene_read_meshes(scene, &error);
    if (status != TY_OK)
        fail_msg("%s", error.text);
    return scene;
}

static void near3(ty_vec3 a, float x, float y, float z)
{
    assert_true(ty_length(ty_sub(a, (ty_vec3){x, y, z})) < 1e-5f);
}

// --- what is read ---

static void nodes_compose(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    ty_gltf_scene* s =
        open_text(&g, MESH "\"nodes\":[{\"name\":\"root\",\"translation\":[0,0,5],\"children\":[1,2]},"
                           "{\"name\":\"a\",\"mesh\":0,\"rotation\":[0,0,0.70710678,0.70710678],\"scale\":[2,2,2]},"
                           "{\"name\":\"b\",\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,7,0,0,1]},"
                           "{\"name\":\"elsewhere\",\"mesh\":0}],\"scenes\":[{\"nodes\":[3]},{\"nodes\":[0]}],"
                           "\"scene\":1");
    assert_int_equal(s->object_count, 2); // of the chosen scene
    assert_string_equal(s->objects[0].name, "a");
    near3(ty_map_point(&s->objects[0].to_file, (ty_vec3){1, 0, 0}), 0, 2, 5);
    near3(ty_map_point(&s->objects[1].to_file, (ty_vec3){1, 0, 0}), 8, 0, 5);
    assert_int_equal(s->objects[0].mesh, s->objects[1].mesh); // one prototype
    assert_string_equal(s->mesh_names[0], "sheet");
    const ty_mesh* mesh = s->meshes[0];
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 2);
    assert_true(mesh->normals[0].z > 0.999f);
    assert_true(mesh->uvs[0].y == 0.0f && mesh->uvs[2].y == 1.0f); // from the bottom
    ty_gltf_scene_destroy(s);
}

static void strips_and_fans(void** state)
{
    (void)state;
    gltf_text g = {0};
    static const float strip[15] = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0};
    static const float fan[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
    static const uint16_t joined[7] = {0, 2, 1, 1, 1, 2, 3};
    (void)gltf_floats(&g, strip, 5, 3);
    (void)gltf_floats(&g, fan, 5, 3);
    (void)gltf_shorts(&g, joined, 7);
    ty_gltf_scene* s =
        open_text(&g, "\"meshes\":[{\"primitives\":[{\"mode\":5,\"attributes\":{\"POSITION\":0}}]},{\"primitives\":"
                      "[{\"mode\":6,\"attributes\":{\"POSITION\":1}}]},{\"primitives\":[{\"mode\":5,\"attributes\":{"
                      "\"POSITION\":0},\"indices\":2},{\"mode\":1,\"attributes\":{\"POSITION\":0}}]}],"
                      "\"nodes\":[{\"mesh\":0},{\"mesh\":1},{\"mesh\":2}]");
    assert_int_equal(s->meshes[0]->triangle_count, 3);
    for (int t = 0; t < 3; t++)
        assert_true(s->meshes[0]->normals[s->meshes[0]->triangles[t][0]].z < -0.999f); // one side, all of them
    assert_int_equal(s->meshes[1]->triangle_count, 3);
    for (int t = 0; t < 3; t++)
        assert_true(s->meshes[1]->normals[s->meshes[1]->triangles[t][1]].z > 0.999f);
    assert_int_equal(s->meshes[2]->triangle_count, 2); // without those of no area
    assert_int_equal(s->meshes[2]->vertex_count, 4);   // and what only lines use
    ty_gltf_scene_destroy(s);
}

static void sparse_and_packed_values(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    static const uint16_t which[2] = {1, 2};
    static const float moved[6] = {5, 0, 0, 0, 6, 0};
    static const uint8_t colors[16] = {255, 0, 51, 255, 0, 255, 0, 0, 0, 0, 255, 102, 1, 2, 3, 4};
    static const int16_t positions[16] = {0, 0, 0, 0, 100, 0, 0, 0, 100, 50, 0, 0, 0, 50, 0, 0};
    (void)gltf_shorts(&g, which, 2);
    (void)gltf_floats(&g, moved, 2, 3);
    int color = gltf_add(&g, colors, 16, 4, 5121, "VEC4", ",\"normalized\":true");
    (void)gltf_add(&g, positions, 32, 4, 5122, "VEC3", "");
    char* views = strstr(g.views, "\"byteLength\":32}");
    assert_non_null(views);
    memcpy(strrchr(g.views, '}'), ",\"byteStride\":8}", 17);
    // 7: like 0, but for two; 8: zeros, but for two
    strcat(g.accessors, ",{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":"
                        "2,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":4}}},"
                        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":2,\"indices\":{"
                        "\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":4}}}");
    assert_int_equal(color, 5);
    ty_gltf_scene* s = open_text(
        &g, "\"extensionsUsed\":[\"KHR_mesh_quantization\"],\"extensionsRequired\":[\"KHR_mesh_quantization\"],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":7,\"COLOR_0\":5,\"_AGE\":5},\"indices\":2}]},"
            "{\"primitives\":[{\"attributes\":{\"POSITION\":8},\"indices\":2}]},"
            "{\"primitives\":[{\"attributes\":{\"POSITION\":6},\"indices\":2}]}],"
            "\"nodes\":[{\"mesh\":0},{\"mesh\":1},{\"mesh\":2}]");
    assert_int_equal(s->warning_count, 0);
    near3(s->meshes[0]->positions[1], 5, 0, 0);
    near3(s->meshes[0]->positions[2], 0, 6, 0);
    near3(s->meshes[0]->positions[3], 0, 1, 0);
    near3(s->meshes[1]->positions[1], 5, 0, 0);
    near3(s->meshes[1]->positions[3], 0, 0, 0);
    near3(s->meshes[2]->positions[2], 100, 50, 0);
    const ty_mesh_attribute* c = ty_mesh_find_attribute(s->meshes[0], "color");
    assert_true(c && c->components == 4 && c->space == TY_ATTRIBUTE_LINEAR_SRGB);
    assert_true(c->values[0] == 1.0f && fabsf(c->values[2] - 0.2f) < 1e-6f && fabsf(c->values[11] - 0.4f) < 1e-6f);
    assert_non_null(ty_mesh_find_attribute(s->meshes[0], "age"));
    ty_gltf_scene_destroy(s);
}

static void primitives_become_slots(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    ty_gltf_scene* s = open_text(
        &g, "\"materials\":[{\"name\":\"Paint\"},{},{\"name\":\"Paint\",\"doubleSided\":true}],\"meshes\":[{"
            "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":2},{\"attributes\":{"
            "\"POSITION\":0},\"material\":1,\"mode\":6},{\"attributes\":{\"POSITION\":0},\"indices\":2}]}],\"nodes\":[{"
            "\"mesh\":0}]");
    const ty_mesh* mesh = s->meshes[0];
    assert_int_equal(mesh->triangle_count, 6);
    assert_int_equal(mesh->slot_count, 3);
    assert_string_equal(mesh->slot_names[mesh->slots[0]], "Paint.2");
    assert_string_equal(mesh->slot_names[mesh->slots[2]], "material1");
    assert_string_equal(mesh->slot_names[mesh->slots[5]], TY_GLTF_NO_MATERIAL);
    assert_true(s->materials[2].double_sided && !s->materials[0].double_sided);
    ty_gltf_scene_destroy(s);
}

static void instances_come_back(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    float places[60];
    for (int i = 0; i < 60; i++)
        places[i] = (float)(i * i % 17) + 0.125f * (float)i;
    static const float sizes[60] = {[0] = 1, [1] = 1, [2] = 1};
    float scales[60];
    for (int i = 0; i < 60; i++)
        scales[i] = i < 3 ? sizes[i] : 0.5f + 0.25f * (float)(i % 5);
    (void)gltf_floats(&g, places, 20, 3);
    (void)gltf_floats(&g, scales, 20, 3);
    ty_gltf_scene* s = open_text(
        &g,
        "\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"]," MESH
        "\"nodes\":[{\"mesh\":0,\"translation\":[0,0,9],\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":"
        "{\"TRANSLATION\":3,\"SCALE\":4}}}}]");
    assert_int_equal(s->object_count, 1);
    const ty_aggregate* a = s->objects[0].instances;
    assert_int_equal(a->instance_count, 20);
    assert_ptr_equal(a->prototypes[0], s->meshes[0]);
    for (uint32_t i = 0; i < 20; i++)
    {
        assert_memory_equal(&a->transforms[i].t, &places[3 * i], sizeof(ty_vec3));
        assert_true(a->transforms[i].y.y == scales[3 * i + 1]);
    }
    near3(s->objects[0].to_file.t, 0, 0, 9);
    ty_mesh* merged;
    ty_error error;
    assert_int_equal(ty_gltf_scene_merge(s, &merged, &error), TY_OK);
    assert_int_equal(merged->vertex_count, 80);
    near3(merged->positions[4], places[3], places[4], places[5] + 9.0f);
    ty_mesh_destroy(merged);
    ty_gltf_scene_destroy(s);
}

static void cameras_and_lights_stand_where_nodes_are(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    ty_gltf_scene* s = open_text(
        &g, MESH
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5,\"znear\":0.01,\"aspectRatio\":1.5}},"
        "{\"name\":\"flat\",\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,\"ymag\":1.5,\"zfar\":9,\"znear\":"
        "0.1}}],\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{"
        "\"type\":\"point\",\"intensity\":20,\"color\":[1,0.5,0.25]},{\"type\":\"spot\",\"name\":\"lamp\",\"spot\":{"
        "\"innerConeAngle\":0.2,\"outerConeAngle\":0.4}},{\"type\":\"directional\",\"intensity\":3}]}},"
        "\"nodes\":[{\"camera\":0,\"name\":\"eye\",\"translation\":[0,1,2]},{\"camera\":1},{\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":0}},\"translation\":[3,0,0],\"children\":[3]},{\"extensions\":{\"KHR_"
        "lights_punctual\":{\"light\":1}}},{\"extensions\":{\"KHR_lights_punctual\":{\"light\":2}},\"rotation\":"
        "[-0.70710678,0,0,0.70710678]},{\"mesh\":0}]");
    assert_int_equal(s->camera_count, 2);
    assert_string_equal(s->cameras[0].name, "eye");
    assert_true(s->cameras[0].yfov == 0.5f && s->cameras[0].aspect == 1.5f && !s->cameras[0].is_orthographic);
    near3(s->cameras[0].to_file.t, 0, 1, 2);
    assert_string_equal(s->cameras[1].name, "flat");
    assert_true(s->cameras[1].is_orthographic && s->cameras[1].height == 3.0f);
    assert_int_equal(s->light_count, 3);
    assert_true(s->lights[0].kind == TY_GLTF_POINT && s->lights[0].intensity == 20.0f && s->lights[0].color[2] == .25f);
    near3(s->lights[1].to_file.t, 3, 0, 0);
    assert_true(s->lights[1].inner == 0.2f && s->lights[1].outer == 0.4f);
    assert_string_equal(s->lights[1].name, "lamp");
    near3(ty_map_vector(&s->lights[2].to_file, (ty_vec3){0, 0, -1}), 0, -1, 0);
    ty_gltf_scene_destroy(s);
}

static void materials_are_what_the_file_says(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    ty_gltf_scene* s = open_text(
        &g, MESH
        "\"nodes\":[{\"mesh\":0}],\"images\":[{\"uri\":\"data:image/png;base64,iVBORw0KGgo=\"}],\"samplers\":[{"
        "\"wrapS\":33071,\"wrapT\":33648}],\"textures\":[{\"source\":0,\"sampler\":0}],\"extensionsUsed\":[\"KHR_"
        "texture_transform\",\"KHR_materials_sheen\"],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":"
        "[0.1,0.2,0.3,0.4],\"metallicFactor\":0.5,\"roughnessFactor\":0.25,\"baseColorTexture\":{\"index\":0,"
        "\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.5,0.25],\"rotation\":1.5,\"scale\":[2,3]}}}},"
        "\"emissiveFactor\":[1,0.5,0],\"alphaMode\":\"MASK\",\"alphaCutoff\":0.7,\"normalTexture\":{\"index\":0,"
        "\"scale\":0.8},\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4},\"KHR_materials_"
        "ior\":{\"ior\":1.33},\"KHR_materials_transmission\":{\"transmissionFactor\":0.9},\"KHR_materials_volume\":{"
        "\"thicknessFactor\":1,\"attenuationDistance\":0.01,\"attenuationColor\":[1,0.5,0.2]},\"KHR_materials_"
        "clearcoat\":{\"clearcoatFactor\":0.6,\"clearcoatRoughnessFactor\":0.1}}}]");
    const ty_gltf_material* m = &s->materials[0];
    assert_true(m->base_color[3] == 0.4f && m->metallic == 0.5f && m->roughness == 0.25f);
    assert_true(m->emissive[0] == 4.0f && m->emissive[1] == 2.0f && m->ior == 1.33f && m->transmission == 0.9f);
    assert_true(m->attenuation_distance == 0.01f && m->attenuation_color[1] == 0.5f && m->thickness == 1.0f);
    assert_true(m->clearcoat == 0.6f && m->clearcoat_roughness == 0.1f);
    assert_true(m->alpha == TY_GLTF_MASK && m->alpha_cutoff == 0.7f);
    assert_true(m->base_color_map.image == 0 && m->base_color_map.scale[1] == 3.0f &&
                m->base_color_map.offset[0] == .5f);
    assert_true(m->base_color_map.wrap_u == TY_GLTF_CLAMP && m->base_color_map.wrap_v == TY_GLTF_MIRROR);
    assert_true(m->normal_map.factor == 0.8f && m->emissive_map.image == -1);
    assert_int_equal(s->images[0].size, 8);
    assert_string_equal(s->images[0].extension, "png");
    assert_int_equal(s->warning_count, 1);
    assert_string_equal(s->warnings[0], "the extension KHR_materials_sheen is ignored");
    ty_gltf_scene_destroy(s);
}

static void external_buffers_and_whole_meshes(void** state)
{
    (void)state;
    ty_error error;
    assert_int_equal(ty_folder_create("parts of it", &error), TY_OK);
    assert_int_equal(ty_file_write("parts of it/a.bin", corners, sizeof corners, &error), TY_OK);
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":48,\"uri\":\"parts%20of%20it/a.bin\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
        "\"count\":4,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6}]}],"
        "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"scale\":[-1,1,1]}]}";
    assert_int_equal(ty_file_write("external.gltf", text, strlen(text), &error), TY_OK);
    ty_mesh* mesh;
    assert_int_equal(ty_mesh_read("external.gltf", &mesh, &error), TY_OK);
    assert_int_equal(mesh->triangle_count, 4);
    assert_true(mesh->bounds.low.x == -1.0f && mesh->bounds.high.x == 1.0f);
    for (uint32_t v = 0; v < 8; v++)
        assert_true(mesh->normals[v].z > 0.999f); // mirrored, and the same side out
    ty_mesh_destroy(mesh);
}

// --- what is refused ---

static void refused_text(const char* text, size_t size, const char* says)
{
    ty_gltf_scene* scene = (ty_gltf_scene*)1;
    ty_error error = {0};
    ty_status status = ty_gltf_scene_open_memory("bad.gltf", text, size, NULL, NULL, &scene, &error);
    if (status == TY_OK)
        status = ty_gltf_scene_read_meshes(scene, &error);
    if (status != TY_BAD_FILE || !strstr(error.text, says))
        print_message("expected '%s', got %d '%s'\n", says, status, error.text);
    assert_int_equal(status, TY_BAD_FILE);
    assert_non_null(strstr(error.text, says));
    assert_string_equal(error.file, "bad.gltf");
    ty_gltf_scene_destroy(scene);
}

static void refused(const char* rest, const char* says)
{
    gltf_text g = quad_text();
    char* text = gltf_compose(&g, rest);
    refused_text(text, strlen(text), says);
    ty_free(text);
}

static void faults_are_named(void** state)
{
    (void)state;
#define IMAGE(uri) "\"images\":[{\"uri\":\"" uri "\"}]"
    refused("\"nodes\":[{\"children\":[1]},{\"children\":[0]}]", "nodes[0] is its own ancestor");
    refused("\"nodes\":[{\"children\":[0]}]", "nodes[0] is its own ancestor");
    refused("\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]", "requires the extension KHR_draco");
    refused("\"nodes\":[{\"mesh\":0}]", "nodes[0].mesh");
    refused(MESH "\"nodes\":[],\"scenes\":[{\"nodes\":[4]}]", "scenes[0].nodes[0] is no node");
    refused(MESH "\"nodes\":[],\"scenes\":[{}],\"scene\":2", "\"scene\" is none of the 1 scenes");
    refused("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1}}]}]",
            "POSITION: its accessor has the wrong");
    refused("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":0}]}]",
            "indices is no accessor");
    refused("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1}}]}]", "COLOR_0");
    refused("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":7}]}]", "mode");
    refused("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":6,\"material\":3}]}]", "material");
    refused(IMAGE("gone.png"), "images[0]: no file './gone.png'");
    refused(IMAGE("../gone.png"), "images[0]: '../gone.png' is not below");
    refused(IMAGE("a/%2e%2e/gone.png"), "is not below");
    refused(IMAGE("/etc/passwd"), "is not below");
    refused(IMAGE("https://example.org/a.png"), "is no file and no data");
    refused(IMAGE("data:image/png;base64,iVB*"), "is no base64");
    refused(IMAGE("data:image/png;base64,AAAA"), "neither PNG nor JPEG");
    refused("\"images\":[{\"bufferView\":9}]", "images[0] has no uri and no bufferView");
    refused("\"materials\":[{\"normalTexture\":{\"index\":0}}]", "materials[0].normalTexture.index");
    refused("\"textures\":[{\"source\":4}],\"materials\":[{\"normalTexture\":{\"index\":0}}]", "textures[0].source");
    refused("\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":\"much\"}}]", "a factor is no number");
    refused("\"materials\":[{\"emissiveFactor\":[1,2]}]", "a factor is no number");
    refused("\"materials\":[{\"extensions\":{\"KHR_materials_ior\":{\"ior\":-1}}}]", "one of its extensions");
    refused("\"nodes\":[{\"camera\":0}]", "nodes[0].camera");
    refused("\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":9}}],\"nodes\":[{\"camera\":0}]", "yfov");
    refused("\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]", "none of the 0 lights");
    refused("\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"area\"}]}},\"nodes\":[{\"extensions\":{"
            "\"KHR_lights_punctual\":{\"light\":0}}}]",
            "lights[0].type");
    refused("\"nodes\":[{\"scale\":[1e39,1,1]}]", "nodes[0].scale[0]");
}

static void buffers_are_bounded(void** state)
{
    (void)state;
#define START "{\"asset\":{\"version\":\"2.0\"},\"buffers\":["
    static const char* const cases[][2] = {
        {START "{\"byteLength\":4}]}", "buffers[0] is missing"},
        {START "{\"byteLength\":4,\"uri\":\"data:;base64,AAAA\"}]}", "buffers[0].byteLength"},
        {START "{\"byteLength\":4,\"uri\":\"gone.bin\"}]}", "buffers[0]: no file './gone.bin'"},
        {START "{\"byteLength\":3,\"uri\":\"data:;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":2,"
               "\"byteLength\":2}]}",
         "bufferViews[0]: byteOffset or byteLength"},
        {START "{\"byteLength\":3,\"uri\":\"data:;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":1,\"byteLength\":2}]}",
         "bufferViews[0].buffer"},
        // zeros that no bytes stand for
        {START "{\"byteLength\":3,\"uri\":\"data:;base64,AAAA\"}],\"accessors\":[{\"componentType\":5126,\"count\":"
               "3000000000,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
         ""},
        {START
         "{\"byteLength\":3,\"uri\":\"data:;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":3}],"
         "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":4,\"indices\""
         ":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":0}}}]}",
         "sparse.count"},
        {START
         "{\"byteLength\":3,\"uri\":\"data:;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":3}],"
         "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":3,\"indices\""
         ":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":0}}}]}",
         "do not fit"},
        {"", "empty"},
        {"{", "line 1"},
        {"[]", "not an object"},
        {"{\"asset\":{\"version\":\"1.0\"}}", "glTF 2 is read"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        refused_text(cases[i][0], strlen(cases[i][0]), cases[i][1]);
    // a data URI of 33 MiB
    size_t digits = (size_t)45 << 20;
    char* text = ty_alloc(digits + 200, 1);
    int head = snprintf(text, 200, START "{\"byteLength\":4,\"uri\":\"data:;base64,");
    memset(text + head, 'A', digits);
    strcpy(text + (size_t)head + digits, "\"}]}");
    refused_text(text, strlen(text), "buffers[0]: a data URI of 35389440 bytes; at most 33554432 are read");
    ty_free(text);
}

static void wrong_indices_are_found_in_the_bytes(void** state)
{
    (void)state;
    gltf_text g = quad_text();
    static const uint16_t beyond[3] = {0, 1, 9};
    (void)gltf_shorts(&g, beyond, 3);
    char* text = gltf_compose(&g, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3}]}],"
                                  "\"nodes\":[{\"mesh\":0}]");
    refused_text(text, strlen(text), "index 9 at place 2");
    ty_free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_compose),
        cmocka_unit_test(strips_and_fans),
        cmocka_unit_test(sparse_and_packed_values),
        cmocka_unit_test(primitives_become_slots),
        cmocka_unit_test(instances_come_back),
        cmocka_unit_test(cameras_and_lights_stand_where_nodes_are),
        cmocka_unit_test(materials_are_what_the_file_says),
        cmocka_unit_test(external_buffers_and_whole_meshes),
        cmocka_unit_test(faults_are_named),
        cmocka_unit_test(buffers_are_bounded),
        cmocka_unit_test(wrong_indices_are_found_in_the_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
