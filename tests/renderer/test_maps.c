// SPDX-License-Identifier: Apache-2.0
// Normal and bump maps, cut-outs and stretched highlights through the whole program, from files.
#include "whole_program.h"
#include <math.h>
#include <tsuya/image/image.h>

// An image of size x size, one function of (u, v) a channel; v = 0 is the bottom row.
static void write_map(const char* path, int size, float (*value)(int channel, float u, float v))
{
    ty_error error;
    ty_image image = {.width = size, .height = size, .channels = 3, .pixels = TY_ALLOC(float, 3 * size * size)};
    for (int i = 0; i < size * size; i++)
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] =
                value(c, ((float)(i % size) + 0.5f) / (float)size, 1.0f - ((float)(i / size) + 0.5f) / (float)size);
    assert_int_equal(ty_image_write(path, &image, 16, &error), TY_OK);
    ty_image_term(&image);
}

static float tilted_normal(int channel, float u, float v)
{
    // (.6, .3, ..) in tangent space: towards +u and +v.
    static const float n[3] = {0.6f, 0.3f, 0.741620f};
    (void)u;
    (void)v;
    return 0.5f + 0.5f * n[channel];
}

static float ramp(int channel, float u, float v)
{
    (void)channel;
    return 0.1f + 0.6f * u + 0.2f * v;
}

static float checker(int channel, float u, float v)
{
    (void)channel;
    return (u < 0.5f) != (v < 0.5f) ? 1.0f : 0.0f;
}

static ty_exr* plane(const char* material, const char* light)
{
    char text[2048];
    snprintf(text, sizeof text,
             "tsuya: 1\n"
             "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: 64, max_depth: 3, seed: 5 }\n"
             "camera: { position: [0, 1, 0.0001], look_at: [0, 0, 0], vfov: 10 }\n"
             "assets: { floor: { shape: plane, size: [0.2, 0, 0.2] } }\n"
             "materials: { m: { model: surface, base_color: 1, specular_weight: 0, %s } }\n"
             "objects: [ { mesh: floor, material: m } ]\n"
             "lights: [ %s ]\n",
             material, light);
    return render_text(text);
}

static const char sky[] = "{ type: environment, radiance: 1 }";

static ty_vec3 normal_in_the_middle(const char* material)
{
    ty_exr* exr = plane(material, sky);
    ty_vec3 n = {pixel(exr, "N.X", 8, 8), pixel(exr, "N.Y", 8, 8), pixel(exr, "N.Z", 8, 8)};
    ty_exr_destroy(exr);
    print_message("%-90s %.4f %.4f %.4f\n", material, (double)n.x, (double)n.y, (double)n.z);
    return n;
}

static void check_normal(ty_vec3 n, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    assert_true(fabs((double)n.x - x / length) < 2e-3 && fabs((double)n.y - y / length) < 2e-3 &&
                fabs((double)n.z - z / length) < 2e-3);
}

// u of the plane runs along +x, v along -z.
static void normals_follow_their_map(void** state)
{
    (void)state;
    write_map("normal.png", 16, tilted_normal);
    check_normal(normal_in_the_middle("normal: { texture: normal.png }"), 0.6, 0.741620, -0.3);
    check_normal(normal_in_the_middle("normal: { texture: normal.png }, normal_strength: 0.5"), 0.3, 0.741620, -0.15);
    check_normal(normal_in_the_middle("normal: { texture: normal.png, value: [1, -1, 1] }"), 0.6, 0.741620, 0.3);
    remove("normal.png");
}

// A slope of .6 m over .4 m at 50 mm a unit.
static void bump_is_a_height_in_metres(void** state)
{
    (void)state;
    write_map("ramp.png", 64, ramp);
    double u = 0.6 * 0.05 / 0.4, v = 0.2 * 0.05 / 0.4;
    check_normal(normal_in_the_middle("bump: { texture: ramp.png, scale: 0.05 }"), -u, 1, v);
    check_normal(normal_in_the_middle("bump: { texture: ramp.png, scale: -0.1 }"), 2 * u, 1, -2 * v);
    // A Lambert surface that is bent stays white under a white sky.
    ty_exr* exr = plane("bump: { texture: ramp.png, scale: 2 }", sky);
    mean_error found = mean_over(exr, 4, 4, 11, 11);
    assert_true(fabs(found.mean - 1.0) < 1e-4);
    ty_exr_destroy(exr);
    // Light from behind does not come through, however the normal leans to it.
    exr = plane("bump: { texture: ramp.png, scale: 2 }",
                "{ type: directional, center: [-3, -0.2, 0], target: [0, 0, 0], irradiance: 5 }");
    assert_true(mean_over(exr, 0, 0, 15, 15).mean == 0.0);
    ty_exr_destroy(exr);
    remove("ramp.png");
}

static void cutouts_have_alpha(void** state)
{
    (void)state;
    write_map("checker.png", 64, checker);
    ty_exr* exr = plane("opacity: { texture: checker.png }",
                        "{ type: directional, center: [0, 1, 0], target: [0, 0, 0], irradiance: 3.14159265 }");
    // Top left of the picture is +v (-z) and -u.
    for (int i = 0; i < 4; i++)
    {
        int x = i % 2 ? 12 : 3, y = i / 2 ? 12 : 3;
        float expected = (x < 8) != (y < 8) ? 0.0f : 1.0f;
        assert_true(pixel(exr, "A", x, y) == expected);
        assert_true(fabsf(pixel(exr, "R", x, y) - expected) < 1e-3f);
    }
    ty_exr_destroy(exr);
    remove("checker.png");
}

// The stripe of a brushed disc is along the direction in which it is rough: here along x, or turned, along z.
static double stripe(const char* rotation)
{
    char material[256];
    snprintf(material, sizeof material,
             "base_metalness: 1, specular_weight: 1, specular_roughness: 0.35, specular_roughness_anisotropy: 0.9, "
             "specular_rotation: %s",
             rotation);
    char text[2048];
    snprintf(text, sizeof text,
             "tsuya: 1\n"
             "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: 64, max_depth: 2, seed: 5 }\n"
             "camera: { position: [0, 1, 0.0001], look_at: [0, 0, 0], vfov: 30 }\n"
             "assets: { floor: { shape: plane, size: [2, 0, 2] } }\n"
             "materials: { m: { model: surface, base_color: 0.9, %s } }\n"
             "objects: [ { mesh: floor, material: m } ]\n"
             "lights: [ { type: point, center: [0, 1, 0], intensity: 1 } ]\n",
             material);
    ty_exr* exr = render_text(text);
    double along_x = (double)pixel(exr, "R", 1, 8) + (double)pixel(exr, "R", 14, 8);
    double along_z = (double)pixel(exr, "R", 8, 1) + (double)pixel(exr, "R", 8, 14);
    ty_exr_destroy(exr);
    return along_x / along_z;
}

static void highlights_stretch_along_u(void** state)
{
    (void)state;
    double plain = stripe("0"), turned = stripe("90");
    print_message("stripe along x over along z: %.2f, turned %.2f\n", plain, turned);
    assert_true(plain > 3.0 && turned < 1.0 / 3.0);
    assert_true(fabs(plain * turned - 1.0) < 0.05);
}

static void clamping_takes_only_indirect_light(void** state)
{
    (void)state;
    static const char scene[] =
        "tsuya: 1\n"
        "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
        "render: { samples: 128, max_depth: 8, seed: 5, indirect_clamp: %s }\n"
        "camera: { position: [0, 1, 0.3], look_at: [0, 0, 0], vfov: 30 }\n"
        "assets: { floor: { shape: plane, size: [2, 0, 2] }, ball: { shape: sphere, radius: 0.1 } }\n"
        "materials:\n"
        "  m: { model: surface, base_color: 0.8 }\n"
        "  g: { model: surface, transmission_weight: 1, specular_roughness: 0 }\n"
        "objects: [ { mesh: floor, material: m }, { mesh: ball, material: %s, translate: [0, 0.15, 0] } ]\n"
        "lights: [ { type: sphere, center: [0.4, 0.9, 0], radius: 0.12, radiance: 25 } ]\n";
    double sum[4], peak[4];
    for (int i = 0; i < 4; i++)
    {
        char text[2048];
        snprintf(text, sizeof text, scene, i & 1 ? "0.2" : "0", i & 2 ? "g" : "m");
        ty_exr* exr = render_text(text);
        sum[i] = peak[i] = 0;
        for (int k = 0; k < 256; k++)
        {
            sum[i] += (double)pixel(exr, "R", k % 16, k / 16);
            peak[i] = fmax(peak[i], (double)pixel(exr, "R", k % 16, k / 16));
        }
        ty_exr_destroy(exr);
    }
    print_message("without glass %.3f, limited %.3f; with glass %.3f, limited %.3f\n", sum[0], sum[1], sum[2], sum[3]);
    assert_true(sum[1] > 0.99 * sum[0] && sum[1] < sum[0]); // direct light is left alone
    assert_true(sum[3] < 0.985 * sum[2]);                   // the caustic is not
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_follow_their_map),
        cmocka_unit_test(bump_is_a_height_in_metres),
        cmocka_unit_test(cutouts_have_alpha),
        cmocka_unit_test(highlights_stretch_along_u),
        cmocka_unit_test(clamping_takes_only_indirect_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
