// SPDX-License-Identifier: Apache-2.0
// Pictures of glTF scenes against those of the same scene written by hand.
#include "geometry/gltf_text.h"
#include "whole_program.h"
#include <math.h>
#include <tsuya/image/image.h>

#define VIEW                                                                                                           \
    "tsuya: 1\nfilm: { size: [24, 16], filter: box, filter_width: 1, half: false }\n"                                  \
    "render: { samples: 16, max_depth: 3 }\n"
#define LOOK "camera: { position: [0, 0, 5], look_at: [0, 0, 0], vfov: 40 }\n"
#define SKY "lights: [ { type: environment, radiance: 1 } ]\n"
#define QUAD "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2"

static const float corners[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
static const float uvs[8] = {0, 1, 1, 1, 1, 0, 0, 0};
static const uint16_t quad[6] = {0, 1, 2, 0, 2, 3};

static void write_quad(const char* rest)
{
    gltf_text g = {0};
    (void)gltf_floats(&g, corners, 4, 3);
    (void)gltf_floats(&g, uvs, 4, 2);
    (void)gltf_shorts(&g, quad, 6);
    gltf_write(&g, "quad.gltf", rest);
}

static void assert_same_picture(const char* a, const char* b, float tolerance)
{
    ty_exr *x = render_text(a), *y = render_text(b);
    for (int i = 0; i < 24 * 16; i++)
        for (int c = 0; c < 3; c++)
        {
            const char* channels[] = {"R", "G", "B"};
            float p = pixel(x, channels[c], i % 24, i / 24), q = pixel(y, channels[c], i % 24, i / 24);
            if (!(fabsf(p - q) <= tolerance * (1.0f + fabsf(q))))
                fail_msg("pixel %d, %d %s: %g and %g", i % 24, i / 24, channels[c], (double)p, (double)q);
        }
    ty_exr_destroy(x);
    ty_exr_destroy(y);
}

static const char plane[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n-1 -1 0\n1 -1 0\n"
    "1 1 0\n-1 1 0\n3 0 1 2\n3 0 2 3\n";

static void write_plane(void)
{
    ty_error error;
    assert_int_equal(ty_file_write("plane.ply", plane, strlen(plane), &error), TY_OK);
}

static void nodes_and_factors(void** state)
{
    (void)state;
    write_plane();
    write_quad("\"materials\":[{\"name\":\"Red\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.2,0.1,1],"
               "\"metallicFactor\":0.25,\"roughnessFactor\":0.6}}],\"meshes\":[{\"primitives\":[" QUAD
               ",\"material\":0}]}],\"nodes\":[{\"children\":[1],\"translation\":[0.5,0,0]},{\"mesh\":0,\"rotation\":"
               "[0,0,0.38268343,0.92387953],\"scale\":[0.8,0.5,1]}]");
    assert_same_picture(
        VIEW LOOK SKY "assets: { q: { gltf: quad.gltf } }\nobjects: [ { gltf: q, translate: [0, .25, 0] "
                      "} ]\n",
        VIEW LOOK SKY "assets: { q: { mesh: plane.ply } }\n"
                      "materials: { red: { model: surface, base_color: { color: [0.8, 0.2, 0.1], space: "
                      "lin_rec709 }, base_metalness: 0.25, specular_roughness: 0.6 } }\n"
                      "objects: [ { mesh: q, material: red, rotate: [0, 0, 45], scale: [0.8, 0.5, 1], "
                      "translate: [0.5, .25, 0] } ]\n",
        2e-5f);
}

static void cameras_and_lights(void** state)
{
    (void)state;
    write_plane();
    write_quad(
        "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0}}],\"meshes\":[{\"primitives\":[" QUAD
        ",\"material\":0}]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}],"
        "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":9,\"color\":[1,"
        "0.5,0.25]},{\"type\":\"directional\",\"intensity\":2},{\"type\":\"spot\",\"intensity\":30,\"spot\":{"
        "\"innerConeAngle\":0.1,\"outerConeAngle\":0.3}}]}},\"nodes\":[{\"mesh\":0},{\"camera\":0,"
        "\"translation\":[1,0,4]},{\"translation\":[0,1,2],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}},"
        "{\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}},{\"translation\":[0.5,0,2],\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":2}}}]");
    assert_same_picture(
        VIEW "assets: { q: { gltf: quad.gltf, light_scale: 0.5 } }\n"
             "objects: [ { gltf: q, file_lights: true, file_camera: 0 } ]\n",
        VIEW "assets: { q: { mesh: plane.ply } }\n"
             "camera: { position: [1, 0, 4], look_at: [1, 0, 0], vfov: 45.83662361 }\n"
             "materials: { m: { model: surface, base_color: 1, specular_roughness: 1 } }\n"
             "objects: [ { mesh: q, material: m } ]\nlights:\n"
             "  - { type: point, center: [0, 1, 2], intensity: { color: [4.5, 2.25, 1.125], space: lin_rec709 } }\n"
             "  - { type: directional, center: [0, 0, 0], target: [0, 0, -1], irradiance: 1 }\n"
             "  - { type: spot, center: [0.5, 0, 2], target: [0.5, 0, 0], intensity: 15, cone: 34.37746771, penumbra: "
             "0.666666667 }\n",
        2e-4f);
}

static void orthographic_cameras(void** state)
{
    (void)state;
    write_plane();
    write_quad(
        "\"materials\":[{\"emissiveFactor\":[1,1,1]}],\"meshes\":[{\"primitives\":[" QUAD
        ",\"material\":0}]}],\"cameras\":[{\"name\":\"flat\",\"type\":\"orthographic\",\"orthographic\":{\"xmag\":3,"
        "\"ymag\":2,\"znear\":0.1,\"zfar\":9}}],\"nodes\":[{\"mesh\":0},{\"camera\":0,\"translation\":[0,0,4]}]");
    ty_exr* exr = render_text(VIEW "assets: { q: { gltf: quad.gltf } }\nobjects: [ { gltf: q, file_camera: flat } ]\n");
    // Four metres over sixteen pixels: the square is eight of them wide and high.
    assert_true(pixel(exr, "A", 8, 4) == 1.0f && pixel(exr, "A", 15, 11) == 1.0f);
    assert_true(pixel(exr, "A", 7, 4) == 0.0f && pixel(exr, "A", 8, 3) == 0.0f && pixel(exr, "A", 16, 12) == 0.0f);
    assert_true(fabsf(pixel(exr, "R", 12, 8) - 1.0f) < 1e-4f); // emission of 1
    ty_exr_destroy(exr);
}

static void emission_has_its_strength(void** state)
{
    (void)state;
    write_quad(
        "\"materials\":[{\"emissiveFactor\":[0.5,0.5,0.5],\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1],"
        "\"metallicFactor\":0},\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":8}}}],"
        "\"meshes\":[{\"primitives\":[" QUAD ",\"material\":0}]}],\"nodes\":[{\"mesh\":0}]");
    ty_exr* exr = render_text(VIEW LOOK "assets: { q: { gltf: quad.gltf } }\nobjects: [ { gltf: q } ]\n");
    assert_true(fabsf(pixel(exr, "R", 12, 8) - 4.0f) < 1e-3f);
    ty_exr_destroy(exr);
}

// Transmission, ior and volume go by the names of this program's own surface.
static void glass_is_glass(void** state)
{
    (void)state;
    write_plane();
    write_quad("\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},\"extensions\":{"
               "\"KHR_materials_transmission\":{\"transmissionFactor\":0.75},\"KHR_materials_ior\":{\"ior\":1.33},"
               "\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":0.5,\"attenuationColor\":[0.5,"
               "0.7,0.9]},\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5,\"clearcoatRoughnessFactor\":0.3}}}],"
               "\"meshes\":[{\"primitives\":[" QUAD ",\"material\":0}]}],\"nodes\":[{\"mesh\":0}]");
    assert_same_picture(
        VIEW LOOK SKY "assets: { q: { gltf: quad.gltf } }\nobjects: [ { gltf: q } ]\n",
        VIEW LOOK SKY "assets: { q: { mesh: plane.ply } }\nmaterials: { m: { model: surface, base_color: 1, "
                      "specular_roughness: 0, transmission_weight: 0.75, specular_ior: 1.33, transmission_depth: 0.5, "
                      "transmission_color: { color: [0.5, 0.7, 0.9], space: lin_rec709 }, coat_weight: 0.5, "
                      "coat_roughness: 0.3, coat_ior: 1.5 } }\nobjects: [ { mesh: q, material: m } ]\n",
        2e-5f);
}

// Left half red, right half green; top half twice as bright as the bottom.
static char* image_uri(void)
{
    ty_error error;
    ty_bytes bytes;
    float pixels[8 * 8 * 3];
    for (int i = 0; i < 64; i++)
    {
        float level = i < 32 ? 1.0f : 0.5f;
        pixels[3 * i] = i % 8 < 4 ? level : 0.0f;
        pixels[3 * i + 1] = i % 8 < 4 ? 0.0f : level;
        pixels[3 * i + 2] = 0.0f;
    }
    ty_image image = {.width = 8, .height = 8, .channels = 3, .pixels = pixels};
    assert_int_equal(ty_image_write("marks.png", &image, 8, &error), TY_OK);
    assert_int_equal(ty_file_read("marks.png", 1 << 20, &bytes, &error), TY_OK);
    char* base64 = gltf_base64(bytes.data, bytes.size);
    char* uri = ty_string_format("data:image/png;base64,%s", base64);
    ty_free(base64);
    ty_bytes_term(&bytes);
    return uri;
}

// The albedo at the middle of the four quarters of the square: top left, top right, bottom left, bottom right.
static void quarters(const char* sampler, const char* transform, float red[4], float green[4])
{
    char* uri = image_uri();
    char* rest = ty_string_format(
        "\"images\":[{\"uri\":\"%s\"}],\"samplers\":[{%s}],\"textures\":[{\"source\":0,\"sampler\":0}],\"materials\":[{"
        "\"pbrMetallicRoughness\":{"
        "\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0%s}}}],\"meshes\":[{\"primitives\":[" QUAD
        ",\"material\":0}]}],\"nodes\":[{\"mesh\":0}]",
        uri, sampler, transform);
    write_quad(rest);
    ty_exr* exr = render_text(VIEW SKY "camera: { position: [0, 0, 5], look_at: [0, 0, 0], projection: orthographic, "
                                       "ortho_height: 2 }\nassets: { q: { gltf: quad.gltf } }\n"
                                       "objects: [ { gltf: q } ]\n");
    for (int i = 0; i < 4; i++)
    {
        int x = i % 2 ? 16 : 8, y = i < 2 ? 4 : 12;
        red[i] = pixel(exr, "albedo.R", x, y);
        green[i] = pixel(exr, "albedo.G", x, y);
    }
    ty_exr_destroy(exr);
    ty_free(rest);
    ty_free(uri);
}

static void textures_lie_as_in_the_file(void** state)
{
    (void)state;
    float red[4], green[4];
    quarters("", "", red, green);
    assert_true(red[0] > 1.5f * green[0] && green[1] > 1.5f * red[1]); // red is left, in ACEScg
    assert_true(red[0] > 2.0f * red[2] && green[1] > 2.0f * green[3]); // bright is up
    quarters("", ",\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.5,0]}}", red, green);
    assert_true(green[0] > 1.5f * red[0] && red[1] > 1.5f * green[1]);
    quarters("", ",\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0,0.5]}}", red, green);
    assert_true(red[2] > 2.0f * red[0] && green[3] > 2.0f * green[1]);
    // A quarter turn of the coordinates counter-clockwise is one of the image clockwise: the left comes up.
    quarters("", ",\"extensions\":{\"KHR_texture_transform\":{\"rotation\":1.57079633}}", red, green);
    assert_true(red[0] > 1.5f * green[0] && red[1] > 1.5f * green[1] && green[2] > 1.5f * red[2]);
    quarters("", ",\"extensions\":{\"KHR_texture_transform\":{\"scale\":[0.5,0.5]}}", red, green);
    for (int i = 0; i < 4; i++)
        assert_true(red[i] > 1.5f * green[i] && red[i] > 0.4f); // the red, bright quarter over all
}

// The right half beyond the image to the right, the bottom half below it.
static void textures_go_on_as_in_the_file(void** state)
{
    (void)state;
    static const char moved[] = ",\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.5,0.5]}}";
    float red[4], green[4];
    quarters("\"wrapS\":33071,\"wrapT\":10497", moved, red, green);
    for (int i = 0; i < 4; i++)
        assert_true(green[i] > 1.5f * red[i]); // the last column goes on
    assert_true(green[2] > 2.0f * green[0] && green[3] > 2.0f * green[1]);
    quarters("\"wrapS\":10497,\"wrapT\":33071", moved, red, green);
    assert_true(green[0] > 1.5f * red[0] && red[1] > 1.5f * green[1]);
    assert_true(fabsf(green[2] - green[0]) < 0.02f && fabsf(red[3] - red[1]) < 0.02f); // the last row goes on
}

static void instances_stand_where_they_were_written(void** state)
{
    (void)state;
    gltf_text g = {0};
    float places[9] = {-2, 0, 0, 0, 0.5f, 0, 2, 0, 0};
    (void)gltf_floats(&g, corners, 4, 3);
    (void)gltf_floats(&g, uvs, 4, 2);
    (void)gltf_shorts(&g, quad, 6);
    (void)gltf_floats(&g, places, 3, 3);
    gltf_write(&g, "quad.gltf",
               "\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],\"meshes\":[{\"primitives\":[" QUAD
               "}]}],\"nodes\":[{\"mesh\":0,\"scale\":[0.5,0.5,0.5],\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
               "\"attributes\":{\"TRANSLATION\":3}}}}]");
    write_plane();
    assert_same_picture(VIEW LOOK SKY "assets: { q: { gltf: quad.gltf } }\nobjects: [ { gltf: q } ]\n",
                        VIEW LOOK SKY
                        "assets: { q: { mesh: plane.ply } }\nmaterials: { m: { model: surface, base_color: 1, "
                        "base_metalness: 1, specular_roughness: 1 } }\nobjects:\n"
                        "  - { mesh: q, material: m, scale: 0.5, translate: [-1, 0, 0] }\n"
                        "  - { mesh: q, material: m, scale: 0.5, translate: [0, 0.25, 0] }\n"
                        "  - { mesh: q, material: m, scale: 0.5, translate: [1, 0, 0] }\n",
                        2e-5f);
}

static void materials_can_be_replaced(void** state)
{
    (void)state;
    write_quad("\"materials\":[{\"name\":\"A\",\"emissiveFactor\":[1,1,1]},{\"name\":\"B\"}],\"meshes\":[{"
               "\"primitives\":[" QUAD ",\"material\":0}]}],\"nodes\":[{\"mesh\":0}]");
    ty_exr* exr = render_text(VIEW LOOK "assets: { q: { gltf: quad.gltf } }\n"
                                        "materials: { mine: { model: surface, emission_luminance: 3 } }\n"
                                        "objects: [ { gltf: q, materials: { A: mine } } ]\n");
    assert_true(fabsf(pixel(exr, "R", 12, 8) - 3.0f) < 1e-3f);
    ty_exr_destroy(exr);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_and_factors),
        cmocka_unit_test(cameras_and_lights),
        cmocka_unit_test(orthographic_cameras),
        cmocka_unit_test(emission_has_its_strength),
        cmocka_unit_test(glass_is_glass),
        cmocka_unit_test(textures_lie_as_in_the_file),
        cmocka_unit_test(textures_go_on_as_in_the_file),
        cmocka_unit_test(instances_stand_where_they_were_written),
        cmocka_unit_test(materials_can_be_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
