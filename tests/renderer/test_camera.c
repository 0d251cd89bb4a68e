// SPDX-License-Identifier: Apache-2.0
// Camera and pixel filter: known points land where they must, and the filter has its moments.
#include "renderer_private.h"

static ty_camera_def def_make(void)
{
    return (ty_camera_def){.position = {1.0f, 2.0f, 5.0f},
                           .look_at = {1.0f, 2.0f, 0.0f},
                           .up = {0.0f, 1.0f, 0.0f},
                           .vfov = ty_radians(90.0f),
                           .film_height = 0.024f,
                           .near_clip = 0.01f};
}

static void assert_direction(ty_vec3 d, float x, float y, float z)
{
    ty_vec3 expected = ty_normalize(ty_vec3_make(x, y, z));
    if (ty_length(ty_sub(d, expected)) > 2e-6f)
        fail_msg("direction %g %g %g, expected %g %g %g", (double)d.x, (double)d.y, (double)d.z, (double)expected.x,
                 (double)expected.y, (double)expected.z);
}

static void test_pinhole_rays(void** state)
{
    (void)state;
    ty_camera_def def = def_make();
    ty_camera camera;
    ty_camera_init(&camera, &def, (int[2]){200, 100});
    ty_vec2 lens = {0.3f, 0.7f};
    assert_direction(ty_camera_ray(&camera, 100.0f, 50.0f, lens).direction, 0, 0, -1);
    assert_direction(ty_camera_ray(&camera, 100.0f, 0.0f, lens).direction, 0, 1, -1);    // upper edge: 45 degrees up
    assert_direction(ty_camera_ray(&camera, 200.0f, 100.0f, lens).direction, 2, -1, -1); // lower right corner
    ty_ray ray = ty_camera_ray(&camera, 100.0f, 0.0f, lens);
    assert_true(fabsf(ray.t_min - 0.01f * sqrtf(2.0f)) < 1e-7f);
    assert_int_equal(ray.skip_instance, TY_NONE);
    assert_true(fabsf(ty_camera_depth(&camera, ty_vec3_make(7.0f, -3.0f, 2.0f)) - 3.0f) < 1e-6f);
}

// All rays through one picture point meet in the plane of focus, and spread over the lens.
static void test_thin_lens(void** state)
{
    (void)state;
    ty_camera_def def = def_make();
    def.f_stop = 2.0f;
    def.focus_point = (ty_vec3){4.0f, 4.0f, 3.0f}; // 2 m along the axis
    def.has_focus_point = true;
    ty_camera camera;
    ty_camera_init(&camera, &def, (int[2]){200, 100});
    assert_true(fabsf(camera.focus_distance - 2.0f) < 1e-6f);
    assert_true(fabsf(camera.lens_radius - 0.5f * 0.012f / 2.0f) < 1e-8f); // focal length 12 mm at f/2
    float widest = 0.0f;
    for (int i = 0; i < 256; ++i)
    {
        ty_vec2 lens = {((float)(i % 16) + 0.5f) / 16.0f, ((float)(i / 16) + 0.5f) / 16.0f};
        ty_ray ray = ty_camera_ray(&camera, 150.0f, 25.0f, lens);
        float t = 2.0f / -ray.direction.z;
        ty_vec3 p = ty_mad(ray.origin, ray.direction, t);
        assert_true(ty_length(ty_sub(p, ty_vec3_make(1.0f + 2.0f, 2.0f + 1.0f, 3.0f))) < 1e-5f);
        widest = ty_max(widest, ty_length(ty_sub(ray.origin, def.position)));
    }
    assert_true(widest <= camera.lens_radius * 1.0001f && widest > 0.9f * camera.lens_radius);
    def.has_focus_point = false;
    ty_camera_init(&camera, &def, (int[2]){200, 100});
    assert_true(fabsf(camera.focus_distance - 5.0f) < 1e-6f); // look_at
}

static void transform(const float m[16], ty_vec3 p, float out[4])
{
    for (int c = 0; c < 4; ++c)
        out[c] = p.x * m[c] + p.y * m[4 + c] + p.z * m[8 + c] + m[12 + c];
}

static void test_matrices_agree_with_rays(void** state)
{
    (void)state;
    ty_camera_def def = def_make();
    def.position = (ty_vec3){0.3f, 1.0f, 2.0f};
    def.look_at = (ty_vec3){-1.0f, 0.2f, -0.4f};
    def.vfov = ty_radians(33.0f);
    ty_camera camera;
    ty_camera_init(&camera, &def, (int[2]){320, 200});
    float to_camera[16], to_ndc[16], q[4];
    ty_camera_world_to_camera(&camera, to_camera);
    ty_camera_world_to_ndc(&camera, to_ndc);
    for (int i = 0; i < 20; ++i)
    {
        float x = 16.0f * (float)i, y = 200.0f - 9.0f * (float)i;
        ty_ray ray = ty_camera_ray(&camera, x, y, (ty_vec2){0});
        ty_vec3 p = ty_mad(ray.origin, ray.direction, 1.0f + 0.3f * (float)i);
        transform(to_ndc, p, q);
        assert_true(fabsf(q[0] / q[3] - x / 320.0f) < 2e-5f);
        assert_true(fabsf(q[1] / q[3] - y / 200.0f) < 2e-5f);
        transform(to_camera, p, q);
        assert_true(fabsf(q[2] - ty_camera_depth(&camera, p)) < 1e-5f && q[2] > 0.0f); // the standard: +z ahead
        assert_true((q[0] > 0.0f) == (x > 160.0f) || fabsf(x - 160.0f) < 1.0f);        // right
        assert_true((q[1] > 0.0f) == (y < 100.0f) || fabsf(y - 100.0f) < 1.0f);        // up
        assert_true(fabsf(q[3] - 1.0f) < 1e-6f);
    }
}

// The matrix and the rays say the same of any projection that has one, with the film shifted.
static void check_shifted(int projection)
{
    ty_camera_def def = def_make();
    def.projection = projection;
    def.ortho_height = 0.8f;
    def.look_at = (ty_vec3){0.4f, 1.7f, 0.0f};
    def.shift[0] = 0.25f;
    def.shift[1] = -0.4f;
    ty_camera camera;
    ty_camera_init(&camera, &def, (int[2]){320, 200});
    float to_ndc[16], q[4];
    assert_true(ty_camera_world_to_ndc(&camera, to_ndc));
    for (int i = 0; i < 20; ++i)
    {
        float x = 16.0f * (float)i, y = 200.0f - 9.0f * (float)i;
        ty_ray ray = ty_camera_ray(&camera, x, y, (ty_vec2){0});
        transform(to_ndc, ty_mad(ray.origin, ray.direction, 1.0f + 0.3f * (float)i), q);
        assert_true(fabsf(q[0] / q[3] - x / 320.0f) < 2e-5f);
        assert_true(fabsf(q[1] / q[3] - y / 200.0f) < 2e-5f);
    }
}

static void test_shift(void** state)
{
    (void)state;
    check_shifted(TY_PROJECTION_PERSPECTIVE);
    check_shifted(TY_PROJECTION_ORTHOGRAPHIC);
    ty_camera_def def = def_make();
    ty_camera camera;
    def.shift[0] = 0.5f; // the middle of what was seen is now at the left edge
    ty_camera_init(&camera, &def, (int[2]){200, 100});
    assert_direction(ty_camera_ray(&camera, 0.0f, 50.0f, (ty_vec2){0}).direction, 0, 0, -1);
}

static void test_orthographic(void** state)
{
    (void)state;
    ty_camera_def def = def_make();
    def.projection = TY_PROJECTION_ORTHOGRAPHIC;
    def.ortho_height = 3.0f;
    def.aperture = 0.2f;
    def.far_clip = 7.0f;
    ty_camera camera;
    ty_camera_init(&camera, &def, (int[2]){200, 100});
    camera.lens_radius = 0.0f;
    ty_ray ray = ty_camera_ray(&camera, 200.0f, 0.0f, (ty_vec2){0});
    assert_direction(ray.direction, 0, 0, -1);
    assert_true(ty_length(ty_sub(ray.origin, ty_vec3_make(1.0f + 3.0f, 2.0f + 1.5f, 5.0f))) < 1e-5f);
    assert_true(ray.t_min == 0.01f && ray.t_max == 7.0f);
    camera.lens_radius = 0.1f;
    for (int i = 0; i < 64; ++i) // all rays of a point meet in the plane of focus, that of look_at
    {
        ty_vec2 lens = {((float)(i % 8) + 0.5f) / 8.0f, ((float)(i / 8) + 0.5f) / 8.0f};
        ray = ty_camera_ray(&camera, 200.0f, 0.0f, lens);
        ty_vec3 p = ty_mad(ray.origin, ray.direction, 5.0f / -ray.direction.z);
        assert_true(ty_length(ty_sub(p, ty_vec3_make(4.0f, 3.5f, 0.0f))) < 1e-5f);
    }
}

static void test_all_directions(void** state)
{
    (void)state;
    ty_camera_def def = def_make();
    def.projection = TY_PROJECTION_EQUIRECTANGULAR;
    def.f_stop = 1.0f;
    ty_camera camera;
    ty_vec2 lens = {0.3f, 0.7f};
    float matrix[16];
    ty_camera_init(&camera, &def, (int[2]){400, 200});
    assert_false(ty_camera_world_to_ndc(&camera, matrix));
    assert_direction(ty_camera_ray(&camera, 200.0f, 100.0f, lens).direction, 0, 0, -1);
    assert_direction(ty_camera_ray(&camera, 300.0f, 100.0f, lens).direction, 1, 0, 0);
    assert_direction(ty_camera_ray(&camera, 100.0f, 100.0f, lens).direction, -1, 0, 0);
    assert_direction(ty_camera_ray(&camera, 0.0f, 100.0f, lens).direction, 0, 0, 1);
    assert_direction(ty_camera_ray(&camera, 77.0f, 0.0f, lens).direction, 0, 1, 0);
    assert_direction(ty_camera_ray(&camera, 300.0f, 150.0f, lens).direction, 1, -1, 0);
    assert_direction(ty_camera_ray(&camera, 200.0f, -50.0f, lens).direction, 0, 1, 1); // over the pole
    assert_true(fabsf(ty_camera_depth(&camera, ty_vec3_make(1.0f, 5.0f, 9.0f)) - 5.0f) < 1e-6f);
}

// Points of the aperture are uniform over a regular polygon in the circle: its moments are known.
static void check_blades(int blades, float curvature, float rotation)
{
    ty_camera_def def = def_make();
    def.blades = blades;
    def.blade_curvature = curvature;
    def.blade_rotation = rotation;
    static ty_lens lens;
    ty_lens_init(&lens, &def);
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, rr = 0.0;
    int n = 1 << 18;
    float widest = -1.0f;
    for (int i = 0; i < n; ++i)
    {
        ty_vec2 p =
            ty_lens_sample(&lens, (ty_vec2){((float)i + 0.5f) / (float)n, ty_u32_to_float((uint32_t)i * 0x9e3779b9u)});
        x += (double)p.x / n;
        y += (double)p.y / n;
        xx += (double)(p.x * p.x) / n;
        xy += (double)(p.x * p.y) / n;
        rr += (double)(p.x * p.x + p.y * p.y) / n;
        widest = ty_max(widest, ty_cos(rotation) * p.x + ty_sin(rotation) * p.y); // towards the first corner
        for (int edge = 0; edge < blades && curvature == 0.0f; ++edge)
        {
            float s, c;
            ty_sincos(rotation + TY_PI * (float)(2 * edge + 1) / (float)blades, &s, &c);
            assert_true(c * p.x + s * p.y <= ty_cos(TY_PI / (float)blades) + 1e-5f);
        }
    }
    double straight = (2.0 + (double)ty_cos(2.0f * TY_PI / (float)blades)) / 6.0; // of r^2
    assert_true(fabs(x) < 2e-3 && fabs(y) < 2e-3 && fabs(xy) < 2e-3);
    assert_true(fabs(xx / rr - 0.5) < 3e-3);
    assert_true(widest > 0.95f && widest <= 1.00001f);
    if (curvature == 0.0f && fabs(rr / straight - 1.0) > 3e-3)
        fail_msg("%d blades: mean of r^2 %g, expected %g", blades, rr, straight);
    if (curvature == 1.0f && fabs(rr / 0.5 - 1.0) > 5e-3)
        fail_msg("%d round blades: mean of r^2 %g", blades, rr);
}

static void test_aperture(void** state)
{
    (void)state;
    check_blades(3, 0.0f, 0.0f);
    check_blades(5, 0.0f, 0.4f);
    check_blades(8, 0.0f, -1.0f);
    check_blades(6, 1.0f, 0.2f);
    check_blades(6, 0.5f, 0.2f);
    ty_camera_def def = def_make();
    def.squeeze = 2.0f;
    ty_lens lens;
    ty_lens_init(&lens, &def);
    ty_vec2 wide = {0.0f, 0.0f};
    for (int i = 0; i < 4096; ++i)
    {
        ty_vec2 p =
            ty_lens_sample(&lens, (ty_vec2){((float)(i % 64) + 0.5f) / 64.0f, ((float)(i / 64) + 0.5f) / 64.0f});
        wide.x = ty_max(wide.x, p.x);
        wide.y = ty_max(wide.y, p.y);
    }
    assert_true(wide.x > 0.48f && wide.x <= 0.5f && wide.y > 0.96f && wide.y <= 1.0f);
}

static void test_poses(void** state)
{
    (void)state;
    ty_camera steps[3], at;
    for (int i = 0; i < 3; ++i)
    {
        ty_camera_def def = def_make();
        float s, c;
        ty_sincos(0.2f * (float)i, &s, &c);
        def.position = (ty_vec3){5.0f * s, 0.0f, 5.0f * c};
        def.look_at = (ty_vec3){0};
        def.vfov = ty_radians(30.0f + 10.0f * (float)i);
        ty_camera_init(&steps[i], &def, (int[2]){200, 100});
    }
    for (int i = 0; i < 3; ++i)
    {
        ty_camera_at(steps, 3, 0.5f * (float)i, &at);
        assert_true(ty_length(ty_sub(at.origin, steps[i].origin)) == 0.0f && at.half_height == steps[i].half_height);
        assert_true(ty_length(ty_sub(at.forward, steps[i].forward)) < 1e-6f);
        assert_true(ty_length(ty_sub(at.up, steps[i].up)) < 1e-6f);
    }
    ty_camera_at(steps, 3, 0.25f, &at);
    assert_direction(at.forward, -ty_sin(0.1f), 0, -ty_cos(0.1f));
    assert_true(fabsf(ty_length(at.right) - 1.0f) < 1e-6f && fabsf(ty_dot(at.right, at.forward)) < 1e-6f);
}

typedef struct filter_case
{
    ty_filter_kind kind;
    float width;
    double variance; // pixels^2
} filter_case;

static void test_filter_moments(void** state)
{
    (void)state;
    // Variances: w^2/12; the normal's cut at 3 sigma, sigma = w/6: .97334 sigma^2; Blackman-Harris by its cosine
    // series: (w/2)^2 (1/3 + (2/pi^2) sum (-1)^k a_k / k^2 / a_0).
    const filter_case cases[] = {
        {TY_FILTER_BOX, 1.0f, 1.0 / 12.0},
        {TY_FILTER_BOX, 2.5f, 2.5 * 2.5 / 12.0},
        {TY_FILTER_GAUSSIAN, 3.0f, 0.97334 * 0.25},
        {TY_FILTER_BLACKMAN_HARRIS, 4.0f,
         4.0 * (1.0 / 3.0 +
                2.0 / (3.14159265358979 * 3.14159265358979) * (-0.48829 + 0.14128 / 4.0 - 0.01168 / 9.0) / 0.35875)},
    };
    static ty_pixel_filter filter;
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; ++c)
    {
        ty_pixel_filter_init(&filter, cases[c].kind, cases[c].width);
        double mean = 0.0, square = 0.0;
        int n = 1 << 16;
        for (int i = 0; i < n; ++i)
        {
            float u = ((float)i + 0.5f) / (float)n;
            double x = (double)ty_pixel_filter_sample(&filter, u);
            assert_true(fabs(x) <= 0.5 * (double)cases[c].width);
            assert_true((float)x == -ty_pixel_filter_sample(&filter, 1.0f - u));
            mean += x / n;
            square += x * x / n;
        }
        assert_true(fabs(mean) < 1e-9);
        if (fabs(square / cases[c].variance - 1.0) > 2e-3)
            fail_msg("case %zu: variance %g, expected %g", c, square, cases[c].variance);
        assert_true(fabsf(ty_pixel_filter_sample(&filter, 0.0f)) <= 0.5f * cases[c].width);
        assert_true(ty_pixel_filter_sample(&filter, 0.5f) == 0.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pinhole_rays),
        cmocka_unit_test(test_thin_lens),
        cmocka_unit_test(test_matrices_agree_with_rays),
        cmocka_unit_test(test_shift),
        cmocka_unit_test(test_orthographic),
        cmocka_unit_test(test_all_directions),
        cmocka_unit_test(test_aperture),
        cmocka_unit_test(test_poses),
        cmocka_unit_test(test_filter_moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
