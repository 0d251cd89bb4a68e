// SPDX-License-Identifier: Apache-2.0
// Textures as inputs: transforms of uv, channels, the ray's footprint, and three projections without a seam.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "geometry/trace_meshes.h"
#include "image/image_folder.h"
#include <tsuya/image/exr.h>
#include <tsuya/shading/material.h>

enum
{
    SIDE = 64
};

// A scaled and turned sphere (object 0), a large triangle with uv in the plane y = 0 (object 1), the sphere upright and
// three times as large (2).
typedef struct stage
{
    ty_mesh *sphere, *floor;
    ty_world* world;
    ty_color* color;
    ty_mip_cache* cache;
    ty_mip_texture* textures[2]; // waves, checker
    ty_shading_context context;
} stage;

static float waves(int x, int y, int channel)
{
    float s = ty_sin(2.0f * TY_PI * ((float)x + 0.5f) / SIDE), c = ty_cos(2.0f * TY_PI * ((float)y + 0.5f) / SIDE);
    const float values[4] = {0.5f + 0.4f * s, 0.5f + 0.4f * c, 0.5f + 0.2f * s * c, 0.25f};
    return values[channel];
}

static float checker(int x, int y, int channel)
{
    (void)channel;
    return (float)((x + y) & 1);
}

static ty_mip_texture* open_texture(stage* s, const char* name, float (*value)(int, int, int))
{
    static const char* const names[] = {"R", "G", "B", "A"};
    const int window[4] = {0, 0, SIDE - 1, SIDE - 1};
    ty_exr* exr = ty_exr_create(window, window);
    for (int c = 0; c < 4; c++)
    {
        float* pixels = ty_exr_add_channel(exr, names[c], TY_EXR_FLOAT);
        for (int i = 0; i < SIDE * SIDE; i++)
            pixels[i] = value(i % SIDE, i / SIDE, c);
    }
    const char* path = in_folder(name);
    assert_int_equal(ty_exr_write(path, exr, NULL), TY_OK);
    ty_exr_destroy(exr);
    ty_mip_texture_def def = ty_mip_texture_def_default();
    def.path = path;
    def.color_space = "raw";
    ty_mip_texture* texture = NULL;
    assert_int_equal(ty_mip_texture_create(s->cache, &def, &texture, NULL), TY_OK);
    assert_int_equal(ty_mip_texture_set_time(texture, 0.0, NULL), TY_OK);
    return texture;
}

static ty_mesh* make_floor(void)
{
    ty_mesh* mesh = ty_mesh_create(3, 1);
    const ty_vec3 corners[3] = {{-2.0f, 0.0f, 2.0f}, {6.0f, 0.0f, 2.0f}, {-2.0f, 0.0f, -6.0f}};
    mesh->uvs = TY_ALLOC(ty_vec2, 3);
    for (uint32_t i = 0; i < 3; i++)
    {
        mesh->positions[i] = corners[i];
        mesh->normals[i] = ty_vec3_make(0.0f, 1.0f, 0.0f);
        mesh->uvs[i] = (ty_vec2){0.5f * corners[i].x, -0.5f * corners[i].z}; // a repetition is 2 m
        mesh->triangles[0][i] = i;
    }
    ty_mesh_compute_bounds(mesh);
    ty_mesh_compute_welds(mesh);
    return mesh;
}

static void add_object(stage* s, const ty_mesh* mesh, const ty_affine* map)
{
    const ty_object_flags flags = {.mask = TY_MASK_OPAQUE};
    uint32_t prototype, object;
    assert_int_equal(ty_world_add_prototype(s->world, mesh, &prototype, NULL), TY_OK);
    assert_int_equal(ty_world_add_object(s->world, prototype, ty_motion_at_rest(map), flags, &object, NULL), TY_OK);
}

static int setup(void** state)
{
    stage* s = TY_ALLOC(stage, 1);
    *state = s;
    if (folder_setup(state) != 0 || ty_color_create(NULL, &s->color, NULL) != TY_OK)
        return -1;
    const ty_mip_cache_def cache = {test_folder, TY_MIP_CACHE_BYTES};
    if (ty_mip_cache_create(&cache, s->color, &s->cache, NULL) != TY_OK)
        return -1;
    s->textures[0] = open_texture(s, "waves.exr", waves);
    s->textures[1] = open_texture(s, "checker.exr", checker);
    const ty_world_def def = ty_world_def_default();
    assert_int_equal(ty_world_create(&def, &s->world, NULL), TY_OK);
    s->sphere = make_sphere(96, 64);
    s->floor = make_floor();
    ty_affine turned =
        ty_affine_from_trs((ty_vec3){0.3f, 5.0f, 0.1f}, ty_quat_axis_angle((ty_vec3){0.6f, 0.0f, 0.8f}, 1.1f),
                           (ty_vec3){2.0f, 2.0f, 2.0f});
    ty_affine plain = ty_affine_identity();
    ty_affine large =
        ty_affine_from_trs((ty_vec3){0.0f, -10.0f, 0.0f}, ty_quat_identity(), (ty_vec3){3.0f, 3.0f, 3.0f});
    add_object(s, s->sphere, &turned);
    add_object(s, s->floor, &plain);
    add_object(s, s->sphere, &large);
    assert_int_equal(ty_world_commit(s->world, NULL), TY_OK);
    s->context.world = s->world;
    s->context.textures = (const ty_mip_texture* const*)s->textures;
    return 0;
}

static int teardown(void** state)
{
    stage* s = *state;
    ty_world_destroy(s->world);
    ty_mesh_destroy(s->sphere);
    ty_mesh_destroy(s->floor);
    ty_mip_texture_destroy(s->textures[0]);
    ty_mip_texture_destroy(s->textures[1]);
    ty_mip_cache_destroy(s->cache);
    ty_color_destroy(s->color);
    ty_free(s);
    return folder_teardown(state);
}

static void assert_close(float value, float expected, float tolerance)
{
    if (!(fabsf(value - expected) <= tolerance))
        fail_msg("%.7g, expected %.7g +- %g", (double)value, (double)expected, (double)tolerance);
}

static ty_surface_point on_floor(const stage* s, float x, float z)
{
    ty_ray ray = ty_ray_make((ty_vec3){x, 1.0f, z}, (ty_vec3){0.0f, -1.0f, 0.0f}, TY_FLOAT_MAX);
    ty_hit hit;
    ty_surface_point point;
    assert_true(ty_world_intersect(s->world, &ray, &hit));
    assert_int_equal(hit.object, 1);
    ty_world_surface(s->world, &hit, &point);
    return point;
}

static ty_input textured(int texture)
{
    ty_input input = ty_input_scalar(1.0f);
    input.texture_index = texture;
    return input;
}

static void uv_are_placed_and_channels_chosen(void** state)
{
    const stage* s = *state;
    ty_surface_point p = on_floor(s, 0.3f, 0.5f);
    ty_vec2 uv = {0.15f, -0.25f};
    ty_input input = textured(0);
    assert_close(ty_input_float(&input, &s->context, &p), 0.5f + 0.4f * ty_sin(2.0f * TY_PI * uv.x), 2e-3f);
    ty_input_place_uv(&input, (ty_vec2){2.0f, 3.0f}, TY_PI / 2.0f, (ty_vec2){0.1f, 0.2f});
    ty_vec2 placed = {0.1f - 3.0f * uv.y, 0.2f + 2.0f * uv.x};
    float r = 0.5f + 0.4f * ty_sin(2.0f * TY_PI * placed.x), g = 0.5f + 0.4f * ty_cos(2.0f * TY_PI * (1.0f - placed.y));
    ty_rgb color = ty_input_color(&input, &s->context, &p);
    assert_close(color.r, r, 4e-3f);
    assert_close(color.g, g, 4e-3f);
    const float expected[6] = {color.r, color.r, color.g, color.b, 0.25f, ty_luminance(color)};
    for (int channel = TY_CHANNEL_ALL; channel <= TY_CHANNEL_LUMINANCE; channel++)
    {
        input.channel = channel;
        assert_close(ty_input_float(&input, &s->context, &p), expected[channel], 1e-6f);
        if (channel != TY_CHANNEL_ALL)
            assert_close(ty_input_color(&input, &s->context, &p).b, expected[channel], 1e-6f);
    }
    input.value = ty_rgb_grey(3.0f);
    input.scale = 2.0f;
    input.offset = 0.5f;
    input.channel = TY_CHANNEL_A;
    assert_close(ty_input_float(&input, &s->context, &p), 3.0f * (0.5f + 2.0f * 0.25f), 1e-6f);
}

// Texels are 2 / 64 m: a cone of .5 m averages the checker, one of a tenth of a texel does not.
static void footprints_are_averaged(void** state)
{
    const stage* s = *state;
    ty_surface_point p = on_floor(s, 2.5f / 32.0f, 0.5f / 32.0f);
    ty_input input = textured(1);
    float at_point = ty_input_float(&input, &s->context, &p);
    assert_close(fabsf(at_point - 0.5f), 0.5f, 1e-2f);
    ty_vec3 down = ty_normalize((ty_vec3){0.3f, -1.0f, 0.2f});
    ty_surface_set_footprint(&p, down, 0.1f / 32.0f);
    assert_close(ty_input_float(&input, &s->context, &p), at_point, 1e-6f);
    ty_surface_set_footprint(&p, down, 0.5f);
    assert_close(ty_input_float(&input, &s->context, &p), 0.5f, 5e-3f);
    input.mapping = TY_MAPPING_TRIPLANAR;
    input.size = 2.0f;
    assert_close(ty_input_float(&input, &s->context, &p), 0.5f, 5e-3f);
    ty_surface_set_footprint(&p, down, 0.0f);
    assert_close(fabsf(ty_input_float(&input, &s->context, &p) - 0.5f), 0.5f, 1e-2f);
}

static void triplanar_repeats_in_metres(void** state)
{
    const stage* s = *state;
    ty_input input = textured(0);
    input.mapping = TY_MAPPING_TRIPLANAR;
    input.size = 0.4f;
    ty_surface_point p = on_floor(s, 0.13f, 0.21f);
    ty_rgb here = ty_input_color(&input, &s->context, &p);
    assert_close(here.r, 0.5f + 0.4f * ty_sin(2.0f * TY_PI * 0.13f / 0.4f), 3e-3f);
    p = on_floor(s, 0.13f + 0.8f, 0.21f - 0.4f);
    assert_close(ty_input_color(&input, &s->context, &p).r, here.r, 2e-4f);
    assert_close(ty_input_color(&input, &s->context, &p).g, here.g, 2e-4f);
    p = on_floor(s, 0.13f + 0.2f, 0.21f);
    assert_true(fabsf(ty_input_color(&input, &s->context, &p).r - here.r) > 0.1f);
}

// The sphere's point towards a direction, with the smooth normal of a true sphere.
static ty_surface_point on_sphere(const stage* s, ty_vec3 d)
{
    const ty_vec3 center = {0.3f, 5.0f, 0.1f};
    ty_ray ray = ty_ray_make(ty_mad(center, d, 4.0f), ty_neg(d), TY_FLOAT_MAX);
    ty_hit hit;
    ty_surface_point point;
    assert_true(ty_world_intersect(s->world, &ray, &hit));
    ty_world_surface(s->world, &hit, &point);
    point.position = ty_mad(center, d, 2.0f);
    point.ns = d;
    return point;
}

// Along great circles in small steps the value never jumps, whatever the blend; 2 mm of a sphere of 2 m.
static void triplanar_has_no_seam(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){5}, 0, 0);
    for (int circle = 0; circle < 12; circle++)
    {
        ty_input input = textured(0);
        input.mapping = TY_MAPPING_TRIPLANAR;
        input.size = 1.5f;
        input.blend = circle % 3 == 0 ? 1.0f : circle % 3 == 1 ? 0.3f : 0.1f;
        ty_frame frame = ty_frame_from_normal(random_direction(&rng));
        float last = 0.0f, least = 1.0f, most = 0.0f;
        for (int i = 0; i <= 6300; i++)
        {
            float sine, cosine;
            ty_sincos(1e-3f * (float)i, &sine, &cosine);
            ty_surface_point p = on_sphere(s, ty_normalize(ty_mad(ty_mul(frame.t, cosine), frame.b, sine)));
            float value = ty_input_float(&input, &s->context, &p);
            if (i > 0)
                assert_close(value, last, 0.02f);
            last = value;
            least = ty_min(least, value);
            most = ty_max(most, value);
        }
        assert_true(most - least > 0.4f); // and it is the texture that is seen
    }
}

// From each of the four sides the texture runs to the right, and as long as the scene says on an object of any size.
static void triplanar_is_not_mirrored(void** state)
{
    const stage* s = *state;
    static const ty_vec3 sides[4] = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
    const ty_vec3 center = {0.0f, -10.0f, 0.0f}, up = {0.0f, 1.0f, 0.0f};
    ty_input input = textured(0);
    input.mapping = TY_MAPPING_TRIPLANAR;
    input.size = 2.0f;
    for (int i = 0; i < 4; i++)
    {
        ty_vec3 right = ty_cross(up, sides[i]);
        ty_vec3 d = ty_normalize(ty_mad(ty_mad(sides[i], right, 0.1f), up, 0.05f));
        ty_ray ray = ty_ray_make(ty_mad(center, d, 5.0f), ty_neg(d), TY_FLOAT_MAX);
        ty_hit hit;
        ty_surface_point p;
        assert_true(ty_world_intersect(s->world, &ray, &hit));
        ty_world_surface(s->world, &hit, &p);
        float u = ty_dot(ty_sub(p.position, center), right) / 2.0f;
        assert_close(ty_input_float(&input, &s->context, &p), 0.5f + 0.4f * ty_sin(2.0f * TY_PI * u), 3e-3f);
    }
}

// What lies from above is the same at any height and slope; in the world's space wherever the object stands.
static void planar_falls_from_above(void** state)
{
    const stage* s = *state;
    ty_rng rng = ty_rng_make((ty_seed){8}, 0, 0);
    ty_input input = textured(0);
    input.mapping = TY_MAPPING_PLANAR;
    input.size = 1.5f;
    input.uv_t.y = 0.25f; // the waves upwards are then odd: away from the viewer is up
    const ty_quat back = ty_quat_axis_angle((ty_vec3){0.6f, 0.0f, 0.8f}, -1.1f);
    for (int i = 0; i < 200; i++)
    {
        ty_surface_point p = on_sphere(s, random_direction(&rng));
        ty_vec3 own = ty_quat_rotate(back, ty_sub(p.position, (ty_vec3){0.3f, 5.0f, 0.1f}));
        for (int space = TY_SPACE_OBJECT; space <= TY_SPACE_WORLD; space++)
        {
            ty_vec3 d = space == TY_SPACE_OBJECT ? own : p.position;
            input.space = space;
            ty_rgb found = ty_input_color(&input, &s->context, &p);
            assert_close(found.r, 0.5f + 0.4f * ty_sin(2.0f * TY_PI * d.x / 1.5f), 3e-3f);
            assert_close(found.g, 0.5f + 0.4f * ty_sin(2.0f * TY_PI * d.z / 1.5f), 3e-3f);
        }
    }
}

// In the world's space a sphere that stands elsewhere is cut out of the same pattern.
static void triplanar_may_be_the_worlds(void** state)
{
    const stage* s = *state;
    ty_input input = textured(0);
    input.mapping = TY_MAPPING_TRIPLANAR;
    input.space = TY_SPACE_WORLD;
    input.size = 1.5f;
    for (float x = -1.0f; x <= 1.0f; x += 0.25f)
    {
        ty_surface_point p = on_sphere(s, ty_normalize((ty_vec3){0.02f * x, 1.0f, 0.01f})); // its top: seen from above
        assert_close(ty_input_float(&input, &s->context, &p), 0.5f + 0.4f * ty_sin(2.0f * TY_PI * p.position.x / 1.5f),
                     3e-3f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(uv_are_placed_and_channels_chosen, setup, teardown),
        cmocka_unit_test_setup_teardown(footprints_are_averaged, setup, teardown),
        cmocka_unit_test_setup_teardown(triplanar_repeats_in_metres, setup, teardown),
        cmocka_unit_test_setup_teardown(triplanar_has_no_seam, setup, teardown),
        cmocka_unit_test_setup_teardown(triplanar_is_not_mirrored, setup, teardown),
        cmocka_unit_test_setup_teardown(planar_falls_from_above, setup, teardown),
        cmocka_unit_test_setup_teardown(triplanar_may_be_the_worlds, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
