// SPDX-License-Identifier: Apache-2.0
// Lights: sampling and density agree, densities integrate to one, and what is sampled is what rays meet.
#include "renderer_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tsuya/base/memory.h>
#include <unistd.h>

static ty_light rectangle_make(float width, float height)
{
    ty_light_def def = {.center = {0.2f, 1.0f, -0.1f}, .target = {0.5f, -1.0f, 0.3f}, .up = {0, 0, 1}};
    def.size[0] = width;
    def.size[1] = height;
    ty_light light = {.kind = TY_LIGHT_RECTANGLE, .value = {3, 2, 1}};
    light.center = def.center;
    ty_light_rectangle_init(&light, &def);
    return light;
}

static ty_ray ray_make(ty_vec3 origin, ty_vec3 direction)
{
    return ty_ray_make(origin, direction, TY_FLOAT_MAX);
}

// Solid angle of the rectangle by brute force over its area.
static double solid_angle_of(const ty_light* light, ty_vec3 p)
{
    enum
    {
        N = 400
    };
    double sum = 0.0;
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
        {
            float x = (2.0f * ((float)i + 0.5f) / N - 1.0f) * light->half_size[0];
            float y = (2.0f * ((float)j + 0.5f) / N - 1.0f) * light->half_size[1];
            ty_vec3 q = ty_mad(ty_mad(light->center, light->frame.t, x), light->frame.b, y), d = ty_sub(q, p);
            double r = (double)ty_length(d);
            sum += -(double)ty_dot(d, light->frame.n) / (r * r * r);
        }
    return sum * (double)light->area / (N * N);
}

static void check_rectangle(const ty_light* light, ty_vec3 p)
{
    enum
    {
        N = 64
    };
    double inverse = 0.0, expected = solid_angle_of(light, p);
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
        {
            ty_vec2 u = {((float)i + 0.5f) / N, ((float)j + 0.5f) / N};
            ty_light_sample s;
            assert_true(ty_light_rectangle_sample(light, p, u, &s));
            assert_true(fabsf(ty_length(s.wi) - 1.0f) < 1e-5f && s.pdf > 0.0f);
            float pdf = ty_light_rectangle_pdf(light, p, s.wi), t;
            if (fabsf(pdf / s.pdf - 1.0f) > 2e-4f)
                fail_msg("pdf %g, of the sample %g", (double)pdf, (double)s.pdf);
            ty_ray ray = ray_make(p, s.wi);
            if (i > 0 && j > 0 && i < N - 1 && j < N - 1) // rounding may carry the rim outside
            {
                assert_true(ty_light_rectangle_meet(light, &ray, INFINITY, &t));
                assert_true(fabsf(t - s.distance) < 1e-4f * s.distance);
                assert_true(ty_light_rectangle_meet(light, &ray, 1.001f * s.distance, &t));
                assert_false(ty_light_rectangle_meet(light, &ray, 0.999f * s.distance, &t));
                ray.t_min = 1.001f * s.distance;
                assert_false(ty_light_rectangle_meet(light, &ray, INFINITY, &t));
            }
            inverse += 1.0 / (double)s.pdf / (N * N);
        }
    if (fabs(inverse / expected - 1.0) > 3e-3)
        fail_msg("mean 1/pdf %g, solid angle %g", inverse, expected);
}

static void test_rectangle_near_and_far(void** state)
{
    (void)state;
    const float sizes[][2] = {{1.0f, 1.0f}, {2.0f, 0.3f}, {0.1f, 0.2f}};
    const ty_vec3 points[] = {{0, 0, 0}, {0.3f, 0.8f, 0.0f}, {2.0f, -3.0f, 1.0f}, {0.4f, 0.0f, 1.5f}, {9, -9, 5}};
    for (int s = 0; s < 3; ++s)
        for (int i = 0; i < 5; ++i)
        {
            ty_light light = rectangle_make(sizes[s][0], sizes[s][1]);
            check_rectangle(&light, points[i]);
        }
}

// Directions by solid angle: the density over a ring of the rectangle is that of its solid angle (first moment).
static void test_near_rectangle_is_uniform_in_solid_angle(void** state)
{
    (void)state;
    enum
    {
        N = 200
    };
    ty_light light = rectangle_make(1.0f, 1.0f);
    ty_vec3 p = ty_mad(light.center, light.frame.n, 0.4f), mean = {0}, expected = {0};
    double total = 0.0;
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
        {
            ty_vec2 u = {((float)i + 0.5f) / N, ((float)j + 0.5f) / N};
            ty_light_sample s;
            assert_true(ty_light_rectangle_sample(&light, p, u, &s));
            mean = ty_mad(mean, s.wi, 1.0f / (N * N));
            ty_vec3 q = ty_mad(ty_mad(light.center, light.frame.t, u.x - 0.5f), light.frame.b, u.y - 0.5f);
            ty_vec3 d = ty_sub(q, p);
            float weight = -ty_dot(d, light.frame.n) / (ty_length_sqr(d) * ty_length(d));
            expected = ty_mad(expected, ty_normalize(d), weight);
            total += (double)weight;
        }
    expected = ty_mul(expected, (float)(1.0 / total));
    assert_true(ty_length(ty_sub(mean, expected)) < 1e-3f);
    // The other side is dark.
    ty_light_sample s;
    ty_vec3 behind = ty_mad(light.center, light.frame.n, -0.4f);
    assert_false(ty_light_rectangle_sample(&light, behind, (ty_vec2){0.5f, 0.5f}, &s));
    ty_ray ray = ray_make(behind, light.frame.n);
    float t;
    assert_false(ty_light_rectangle_meet(&light, &ray, INFINITY, &t));
}

static void test_sphere_outside_and_inside(void** state)
{
    (void)state;
    ty_light light = {.kind = TY_LIGHT_SPHERE, .center = {1, 2, 3}, .radius = 0.5f, .value = {1, 1, 1}};
    const ty_vec3 points[] = {{0, 0, 0}, {1.0f, 2.0f, 3.6f}, {60, -70, 20}, {1.2f, 2.1f, 3.0f}};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 1000; ++k)
        {
            ty_rng rng = ty_rng_make((ty_seed){3}, (uint64_t)i, (uint64_t)k);
            ty_light_sample s;
            float x = ty_rng_float(&rng), y = ty_rng_float(&rng), t;
            assert_true(ty_light_sphere_sample(&light, points[i], (ty_vec2){x * 0.999f, y}, &s));
            assert_true(s.pdf == ty_light_sphere_pdf(&light, points[i]));
            ty_ray ray = ray_make(points[i], s.wi);
            assert_true(ty_light_sphere_meet(&light, &ray, &t));
            assert_true(fabsf(t - s.distance) < 2e-3f * light.radius + 1e-4f * s.distance);
        }
    double d_sqr = 14.0, cos_max = sqrt(1.0 - 0.25 / d_sqr);
    double expected = 1.0 / (2.0 * 3.14159265358979 * (1.0 - cos_max));
    assert_true(fabs((double)ty_light_sphere_pdf(&light, points[0]) / expected - 1.0) < 1e-5);
    assert_true(fabsf(ty_light_sphere_pdf(&light, points[3]) * 4.0f * TY_PI - 1.0f) < 1e-6f);
    // From inside the far wall is met; a ray that begins past the sphere meets nothing.
    ty_ray ray = ray_make((ty_vec3){1, 2, 3}, (ty_vec3){1, 0, 0});
    float t;
    assert_true(ty_light_sphere_meet(&light, &ray, &t) && fabsf(t - 0.5f) < 1e-6f);
}

// --- environment images ---

enum
{
    WIDTH = 64,
    HEIGHT = 32
};

// A dim sky of `sky` with one bright texel; written as a float EXR and read back as raw.
static ty_texture* image_make(float sky, int sun_x, int sun_y, float sun)
{
    char path[] = "/tmp/tsuya_env_XXXXXX.exr";
    int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    int window[4] = {0, 0, WIDTH - 1, HEIGHT - 1};
    ty_exr* exr = ty_exr_create(window, window);
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
    {
        float* pixels = ty_exr_add_channel(exr, names[c], TY_EXR_FLOAT);
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
            pixels[i] = sky;
        pixels[sun_y * WIDTH + sun_x] = sun;
    }
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    ty_color* color;
    assert_int_equal(ty_color_create(NULL, &color, NULL), TY_OK);
    ty_texture_def def = ty_texture_def_default();
    def.path = path;
    def.color_space = "raw";
    ty_texture* texture;
    ty_error error;
    if (ty_texture_create(&def, color, &texture, &error))
        fail_msg("%s", error.text);
    ty_color_destroy(color);
    unlink(path);
    return texture;
}

static ty_environment_table table; // of the last one made

static ty_light environment_make(const ty_texture* image, float rotate)
{
    ty_environment_table_init(&table, image);
    ty_light light = {.kind = TY_LIGHT_ENVIRONMENT, .value = {1, 1, 1}};
    ty_light_def def = {.rotate = rotate};
    ty_light_environment_init(&light, &def, image, &table);
    return light;
}

static void test_environment_orientation(void** state)
{
    (void)state;
    // Texel (48, 16): three quarters across is +x, a little below the horizon.
    ty_texture* image = image_make(0.0f, 48, 16, 10.0f);
    float a = 2.0f * TY_PI * (48.5f / WIDTH - 0.5f), h = TY_PI * 16.5f / HEIGHT;
    ty_vec3 sun = {ty_sin(h) * ty_sin(a), ty_cos(h), -ty_sin(h) * ty_cos(a)};
    assert_true(sun.x > 0.99f);
    ty_light light = environment_make(image, 0.0f);
    assert_true(fabsf(ty_light_environment_radiance(&light, sun).g - 10.0f) < 0.01f);
    assert_true(ty_light_environment_radiance(&light, ty_neg(sun)).g == 0.0f);
    ty_environment_table_term(&table);
    // Turned by 90 degrees about +y, +x goes to -z.
    light = environment_make(image, 0.5f * TY_PI);
    ty_vec3 turned = {sun.z, sun.y, -sun.x};
    assert_true(fabsf(ty_light_environment_radiance(&light, turned).g - 10.0f) < 0.01f);
    ty_environment_table_term(&table);
    ty_texture_destroy(image);
}

// A bright row at one pole is not seen at the other, though the texture repeats.
static void test_rows_do_not_wrap_over_the_poles(void** state)
{
    (void)state;
    for (int bottom = 0; bottom < 2; ++bottom)
    {
        ty_texture* image = image_make(0.0f, 20, bottom ? HEIGHT - 1 : 0, 10.0f);
        ty_light light = environment_make(image, 0.0f);
        for (int i = 0; i < 256; ++i)
        {
            float s, c;
            ty_sincos(2.0f * TY_PI * (float)i / 256.0f, &s, &c);
            ty_vec3 opposite = {1e-3f * s, bottom ? 1.0f : -1.0f, 1e-3f * c};
            assert_true(ty_light_environment_radiance(&light, opposite).g == 0.0f);
        }
        ty_environment_table_term(&table);
        ty_texture_destroy(image);
    }
}

static void test_environment_density(void** state)
{
    (void)state;
    ty_texture* image = image_make(0.2f, 20, 6, 5000.0f);
    ty_light light = environment_make(image, 0.7f);
    assert_non_null(light.distribution);
    enum
    {
        N = 1024
    };
    double integral = 0.0, light_by_quadrature = 0.0, light_by_samples = 0.0;
    for (int j = 0; j < N / 2; ++j)
        for (int i = 0; i < N; ++i)
        {
            float theta = TY_PI * ((float)j + 0.5f) / (N / 2), phi = 2.0f * TY_PI * ((float)i + 0.5f) / N;
            ty_vec3 wi = {ty_sin(theta) * ty_cos(phi), ty_cos(theta), ty_sin(theta) * ty_sin(phi)};
            double area = (double)ty_sin(theta) * 2.0 * 3.14159265 / N * 3.14159265 / (N / 2);
            integral += (double)ty_light_environment_pdf(&light, wi) * area;
            light_by_quadrature += (double)ty_light_environment_radiance(&light, wi).g * area;
        }
    if (fabs(integral - 1.0) > 5e-3)
        fail_msg("the density integrates to %g", integral);
    // An even sky is sampled evenly by solid angle: near the pole (within a row of it) as at the horizon.
    float pole = ty_light_environment_pdf(&light, ty_normalize((ty_vec3){-0.15f, -1.0f, 0.0f}));
    float horizon = ty_light_environment_pdf(&light, ty_normalize((ty_vec3){-1.0f, -0.05f, 0.0f}));
    assert_true(pole / horizon > 0.8f && pole / horizon < 1.25f);
    for (int k = 0; k < 10000; ++k)
    {
        ty_rng rng = ty_rng_make((ty_seed){5}, 0, (uint64_t)k);
        float x = ty_rng_float(&rng), y = ty_rng_float(&rng);
        ty_light_sample s;
        assert_true(ty_light_environment_sample(&light, (ty_vec2){x, y}, &s));
        float pdf = ty_light_environment_pdf(&light, s.wi);
        if (fabsf(pdf / s.pdf - 1.0f) > 5e-3f && fabsf(pdf - s.pdf) > 1e-3f)
            light_by_samples += 1e9; // a sample on a cell's border may round across it, but not ten thousand times
        light_by_samples += (double)s.radiance.g / (double)s.pdf / 10000.0;
    }
    if (fabs(light_by_samples / light_by_quadrature - 1.0) > 0.03)
        fail_msg("light by samples %g, by quadrature %g", light_by_samples, light_by_quadrature);
    assert_true(fabs((double)ty_light_environment_mean(&light) * 4.0 * 3.14159265 / light_by_quadrature - 1.0) < 5e-3);
    ty_environment_table_term(&table);
    ty_texture_destroy(image);
}

static void test_smooth_images_are_left_to_rays(void** state)
{
    (void)state;
    ty_texture* image = image_make(0.5f, 0, 0, 0.6f);
    ty_light light = environment_make(image, 0.0f);
    assert_null(light.distribution);
    ty_texture_destroy(image);
}

static void test_heuristic_never_overflows(void** state)
{
    (void)state;
    assert_true(ty_power_heuristic(1.0f, 1.0f) == 0.5f);
    assert_true(ty_power_heuristic(3.0f, 1.0f) > 0.89999f);
    assert_true(ty_power_heuristic(1e30f, 1e30f) == 0.5f);
    assert_true(ty_power_heuristic(1e30f, 0.0f) == 1.0f);
    assert_true(ty_power_heuristic(0.0f, 1.0f) == 0.0f);
    for (float a = 1e-6f; a < 1e6f; a *= 7.0f)
        assert_true(fabsf(ty_power_heuristic(a, 2.0f) + ty_power_heuristic(2.0f, a) - 1.0f) < 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangle_near_and_far),
        cmocka_unit_test(test_near_rectangle_is_uniform_in_solid_angle),
        cmocka_unit_test(test_sphere_outside_and_inside),
        cmocka_unit_test(test_environment_orientation),
        cmocka_unit_test(test_rows_do_not_wrap_over_the_poles),
        cmocka_unit_test(test_environment_density),
        cmocka_unit_test(test_smooth_images_are_left_to_rays),
        cmocka_unit_test(test_heuristic_never_overflows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
