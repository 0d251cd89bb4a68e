// SPDX-License-Identifier: Apache-2.0
// Cameras and motion in whole pictures, against what geometry says: coverage along a path, sizes, brightness of blurs.
#include "whole_program.h"
#include <tsuya/geometry/aggregate.h>
#include <tsuya/geometry/mesh_file.h>
#include <tsuya/geometry/shape.h>

#define HEAD                                                                                                           \
    "tsuya: 1\n"                                                                                                       \
    "film: { size: [%d, %d], filter: box, filter_width: 1, half: false }\n"                                            \
    "render: { samples: %d, max_depth: 1, seed: 3%s }\n"

// A plate of width .25 that goes from x = -.25 to .25 while the shutter is open, or a camera that goes the other way.
#define PLATE                                                                                                          \
    "assets: { plate: { shape: box, size: [0.125, 1, 0.005] } }\n"                                                     \
    "materials: { m: { model: surface, emission_luminance: 1, base_color: 0, specular_weight: 0 } }\n"                 \
    "objects: [ { mesh: plate, material: m, translate: %s } ]\n"                                                       \
    "camera: { projection: orthographic, ortho_height: 0.125, position: %s, look_at: %s, shutter: %s }\n"              \
    "lights: [ { type: point, center: [0, 9, 0] } ]\nframe: 1\n"

static ty_exr* render_plate(const char* translate, const char* position, const char* look_at, const char* shutter)
{
    char text[4096];
    snprintf(text, sizeof text, HEAD PLATE, 64, 8, 256, "", translate, position, look_at, shutter);
    return render_text(text);
}

// Share of the time at which |x - c(t)| < width / 2, c from -way / 2 to way / 2.
static double coverage(double x, double width, double way)
{
    double low = fmax((x - 0.5 * width) / way + 0.5, 0.0), high = fmin((x + 0.5 * width) / way + 0.5, 1.0);
    return high > low ? high - low : 0.0;
}

static void check_coverage(const ty_exr* exr, double way)
{
    for (int x = 0; x < 64; ++x)
    {
        double mean = 0.0, expected = 0.0;
        for (int y = 0; y < 8; ++y)
            mean += (double)pixel(exr, "A", x, y) / 8.0;
        for (int i = 0; i < 16; ++i)
            expected += coverage((x + (i + 0.5) / 16.0 - 32.0) / 64.0, 0.25, way) / 16.0;
        if (fabs(mean - expected) > 0.012)
            fail_msg("column %d: alpha %g, expected %g", x, mean, expected);
    }
}

static void alpha_lies_along_the_path(void** state)
{
    (void)state;
    const char* still[] = {"[0, 0, 0]", "[0, 0, 1]"};
    ty_exr* exr = render_plate("{ keys: { 0: [-0.5, 0, 0], 2: [0.5, 0, 0] } }", still[1], still[0], "1");
    check_coverage(exr, 0.5);
    ty_exr_destroy(exr);
    exr = render_plate("{ keys: { 0: [-0.5, 0, 0], 2: [0.5, 0, 0] } }", still[1], still[0], "0.5");
    check_coverage(exr, 0.25);
    ty_exr_destroy(exr);
    exr = render_plate("[0, 0, 0]", "{ keys: { 0: [-0.5, 0, 1], 2: [0.5, 0, 1] } }",
                       "{ keys: { 0: [-0.5, 0, 0], 2: [0.5, 0, 0] } }", "1");
    check_coverage(exr, 0.5);
    ty_exr_destroy(exr);
}

static void assert_same_picture(const ty_exr* a, const ty_exr* b)
{
    size_t size = (size_t)ty_exr_width(a) * (size_t)ty_exr_height(a) * sizeof(float);
    assert_int_equal(a->channel_count, b->channel_count);
    for (int i = 0; i < a->channel_count; ++i)
        assert_memory_equal(a->channels[i].pixels, b->channels[i].pixels, size);
}

// The same plate as the one instance of a file, which says how fast it is; NULL = the file says nothing.
static ty_exr* render_instance(const ty_vec3* velocity, const char* shutter, const char* options)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_BOX;
    def.size = (ty_vec3){0.125f, 1.0f, 0.005f};
    ty_aggregate* a = ty_aggregate_create(1, 1);
    ty_error error;
    assert_int_equal(ty_shape_create(&def, &a->prototypes[0], &error), TY_OK);
    if (velocity)
    {
        ty_aggregate_add_velocities(a)[0] = *velocity;
        (void)ty_aggregate_add_spins(a);
    }
    assert_int_equal(ty_aggregate_write("plate.glb", a, &error), TY_OK);
    ty_aggregate_destroy(a);
    char text[4096];
    snprintf(text, sizeof text,
             HEAD "timeline: { fps: 24 }\nassets: { plate: { aggregate: plate.glb%s } }\n"
                  "materials: { m: { model: surface, emission_luminance: 1, base_color: 0, specular_weight: 0 } }\n"
                  "objects: [ { aggregate: plate, material: m } ]\n"
                  "camera: { projection: orthographic, ortho_height: 0.125, position: [0, 0, 1], look_at: [0, 0, 0], "
                  "shutter: %s }\nlights: [ { type: point, center: [0, 9, 0] } ]\nframe: 1\n",
             64, 8, 256, "", options, shutter);
    ty_exr* exr = render_text(text);
    remove("plate.glb");
    return exr;
}

static void instances_smear_by_their_velocities(void** state)
{
    (void)state;
    ty_vec3 velocity = {12, 0, 0}, none = {0, 0, 0};
    ty_exr* exr = render_instance(&velocity, "1", "");
    check_coverage(exr, 0.5);
    ty_exr_destroy(exr);
    exr = render_instance(&velocity, "1", ", velocity_scale: 0.5");
    check_coverage(exr, 0.25);
    ty_exr_destroy(exr);
    ty_exr *without = render_instance(NULL, "1", ""), *still = render_instance(&none, "1", ""),
           *unscaled = render_instance(&velocity, "1", ", velocity_scale: 0"),
           *closed = render_instance(&velocity, "0", "");
    assert_same_picture(without, still);
    assert_same_picture(without, unscaled);
    assert_same_picture(without, closed);
    ty_exr_destroy(without);
    ty_exr_destroy(still);
    ty_exr_destroy(unscaled);
    ty_exr_destroy(closed);
}

// The same plate as a file a frame: file k stands at x = place of k.
static void write_plates(const float* places, int count)
{
    ty_shape_def def = ty_shape_def_default();
    def.kind = TY_SHAPE_BOX;
    def.size = (ty_vec3){0.125f, 1.0f, 0.005f};
    ty_mesh* plate;
    ty_error error;
    assert_int_equal(ty_shape_create(&def, &plate, &error), TY_OK);
    for (int k = 0; k < count; ++k)
    {
        ty_mesh* moved = ty_mesh_copy(plate);
        ty_affine map = ty_affine_identity();
        map.t.x = places[k];
        ty_mesh_transform(moved, &map);
        char name[32];
        snprintf(name, sizeof name, "plate.%04d.ply", k);
        assert_int_equal(ty_ply_write(name, moved, &error), TY_OK);
        ty_mesh_destroy(moved);
    }
    ty_mesh_destroy(plate);
}

// At frame 1 of the scene, which shows file 1.
static ty_exr* render_plates(const char* options, const char* camera, const char* translate)
{
    char text[4096];
    snprintf(text, sizeof text,
             HEAD "timeline: { fps: 24, start: 0, end: 1 }\nassets: { plate: { mesh: 'plate.####.ply', fps: 24%s } }\n"
                  "materials: { m: { model: surface, base_color: 0, specular_weight: 0 } }\n"
                  "objects: [ { mesh: plate, material: m, translate: %s } ]\n"
                  "camera: { projection: orthographic, ortho_height: 0.125, position: [0, 0, 1], look_at: [0, 0, 0], "
                  "%s }\nlights: [ { type: point, center: [0, 9, 0] } ]\nframe: 1\n",
             64, 8, 256, "", options, translate, camera);
    return render_text(text);
}

// Files a frame apart are a straight path: what the shutter sees of it is the box-filtered plate, and the plate as an
// object of the same motion.
static void files_smear_from_one_to_the_next(void** state)
{
    (void)state;
    static const float straight[] = {-0.5f, 0.0f, 0.5f};
    static const char none[] = "[0, 0, 0]";
    write_plates(straight, 3);
    ty_exr* exr = render_plates("", "shutter: 1", none);
    check_coverage(exr, 0.5);
    ty_exr_destroy(exr);
    exr = render_plates("", "shutter: 0.5", none);
    check_coverage(exr, 0.25);
    ty_exr_destroy(exr);
    exr = render_plates("", "shutter: 1, shutter_position: start", "[-0.25, 0, 0]");
    check_coverage(exr, 0.5);
    ty_exr_destroy(exr);
    // the film stops in the middle of the open shutter, and the plate with it: half of the time it stands there
    exr = render_plates(", last_frame: 1, first_frame: 0", "shutter: 1", none);
    for (int x = 0; x < 64; ++x)
    {
        double way = 0.0, at = (x + 0.5 - 32.0) / 64.0;
        for (int i = 0; i < 16; ++i)
            way += coverage(at + (i - 7.5) / 1024.0 + 0.125, 0.25, 0.25) / 16.0;
        double stands = fabs(at) < 0.12 ? 1.0 : fabs(at) > 0.13 ? 0.0 : 0.5, expected = 0.5 * (way + stands);
        if (fabs((double)pixel(exr, "A", x, 4) - expected) > 0.06)
            fail_msg("column %d: alpha %g, expected %g", x, (double)pixel(exr, "A", x, 4), expected);
    }
    ty_exr_destroy(exr);
    // with an object that goes back as fast nothing is blurred
    exr = render_plates("", "shutter: 1", "{ keys: { 0: [0.5, 0, 0], 2: [-0.5, 0, 0] } }");
    for (int x = 0; x < 64; ++x)
        if (x != 23 && x != 24 && x != 39 && x != 40)
            assert_true(pixel(exr, "A", x, 4) == (x > 23 && x < 40 ? 1.0f : 0.0f));
    ty_exr_destroy(exr);
}

// Where files turn back within the shutter both ways are seen: the plate is at 0 when it opens and when it closes, at
// .25 between.
static void files_within_the_shutter_count(void** state)
{
    (void)state;
    static const float bent[] = {0.0f, 0.25f, 0.0f};
    write_plates(bent, 3);
    ty_exr* exr = render_plates("", "shutter: 2", "[-0.125, 0, 0]");
    check_coverage(exr, 0.25);
    ty_exr_destroy(exr);
}

static void files_keep_their_bits_where_nothing_blurs(void** state)
{
    (void)state;
    static const float straight[] = {-0.5f, 0.0f, 0.5f}, still[] = {0.0f, 0.0f, 0.0f};
    static const char none[] = "[0, 0, 0]";
    write_plates(straight, 3);
    ty_exr* closed = render_plates("", "shutter: 0", none);
    ty_exr* held = render_plates(", interpolate: none", "shutter: 1", none);
    assert_same_picture(closed, held);
    ty_exr_destroy(held);
    write_plates(still, 3);
    ty_exr* rests = render_plates("", "shutter: 1", none);
    assert_same_picture(closed, rests);
    ty_exr_destroy(rests);
    ty_exr_destroy(closed);
    for (int k = 0; k < 3; ++k)
    {
        char name[32];
        snprintf(name, sizeof name, "plate.%04d.ply", k);
        remove(name);
    }
}

// Both move together: nothing is blurred.
static void what_goes_along_is_sharp(void** state)
{
    (void)state;
    ty_exr* exr =
        render_plate("{ keys: { 0: [-0.5, 0, 0], 2: [0.5, 0, 0] } }", "{ keys: { 0: [-0.5, 0, 1], 2: [0.5, 0, 1] } }",
                     "{ keys: { 0: [-0.5, 0, 0], 2: [0.5, 0, 0] } }", "1");
    for (int x = 0; x < 64; ++x)
        if (x != 23 && x != 24 && x != 39 && x != 40)
            assert_true(pixel(exr, "A", x, 4) == (x > 23 && x < 40 ? 1.0f : 0.0f));
    assert_true(fabsf(pixel(exr, "Z", 32, 4) - 0.995f) < 1e-5f);
    ty_exr_destroy(exr);
}

// An open shutter alone changes no bit, nor does a key that never moves.
static void stillness_costs_no_bit(void** state)
{
    (void)state;
    ty_exr* closed = render_plate("[0, 0, 0]", "[0, 0, 1]", "[0, 0, 0]", "0");
    ty_exr* open = render_plate("[0, 0, 0]", "[0, 0, 1]", "[0, 0, 0]", "1");
    ty_exr* keyed =
        render_plate("{ keys: { 1: [0, 0, 0], 9: [0, 0, 0] } }", "{ keys: { 3: [0, 0, 1] } }", "[0, 0, 0]", "1");
    assert_same_picture(closed, open);
    assert_same_picture(closed, keyed);
    ty_exr_destroy(closed);
    ty_exr_destroy(open);
    ty_exr_destroy(keyed);
}

// A plate turning by 90 degrees about its end sweeps a quarter of a disc: steps over the shutter follow the circle.
static void turning_follows_the_circle(void** state)
{
    (void)state;
    char text[4096];
    snprintf(text, sizeof text,
             HEAD "assets: { plate: { shape: box, size: [0.01, 0.2, 0.005] } }\n"
                  "materials: { m: { model: surface } }\n"
                  "objects: [ { mesh: plate, material: m, translate: [0.5, 0, 0] } ]\n"
                  "turntable: { turn: objects, axis: [0, 0, 1], about: [0, 0, 0], angle: { keys: { 0: 0, 2: 360 } } }\n"
                  "camera: { projection: orthographic, ortho_height: 1.6, shutter: 0.5, shutter_position: start }\n"
                  "lights: [ { type: point, center: [0, 9, 0] } ]\nframe: 0\n",
             64, 64, 64, "");
    ty_exr* exr = render_text(text);
    double area = 0.0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
        {
            double px = (x + 0.5) / 40.0 - 0.8, py = 0.8 - (y + 0.5) / 40.0, r = sqrt(px * px + py * py);
            float alpha = pixel(exr, "A", x, y);
            area += (double)alpha / 1600.0;
            // the plate's middle is at .5, its ends within .54: nothing beyond the ring, inside the quarter something
            if (r > 0.575 || r < 0.45)
                assert_true(alpha == 0.0f);
            if (fabs(r - 0.5) < 0.02 && px > 0.22 && py > 0.22)
                assert_true(alpha > 0.0f);
        }
    if (fabs(area / (0.02 * 0.4) - 1.0) > 0.02) // the plate's own area, whatever its way
        fail_msg("area %g, expected %g", area, 0.02 * 0.4);
    ty_exr_destroy(exr);
}

static double sum_of(const ty_exr* exr, const char* channel)
{
    double sum = 0.0;
    for (int y = 0; y < ty_exr_height(exr); ++y)
        for (int x = 0; x < ty_exr_width(exr); ++x)
            sum += (double)pixel(exr, channel, x, y);
    return sum;
}

static void an_orthographic_ball_has_its_size(void** state)
{
    (void)state;
    char text[2048];
    snprintf(text, sizeof text,
             HEAD
             "assets: { ball: { shape: sphere, radius: 0.3, divisions: 192 } }\nmaterials: { m: { model: surface } }\n"
             "objects: [ { mesh: ball, material: m, translate: [0.2, 0.1, -5] } ]\n"
             "camera: { projection: orthographic, ortho_height: 1 }\n"
             "lights: [ { type: point, center: [0, 9, 0] } ]\n",
             96, 64, 64, "");
    ty_exr* exr = render_text(text);
    double area = sum_of(exr, "A") / (64.0 * 64.0), expected = 3.14159265 * 0.09;
    if (fabs(area / expected - 1.0) > 3e-3)
        fail_msg("area %g, expected %g", area, expected);
    ty_exr_destroy(exr);
}

// Light out of focus is spread, not lost: the same in sum for every shape of the aperture.
static void blurs_keep_their_light(void** state)
{
    (void)state;
    static const char* const lenses[] = {"f_stop: 0",
                                         "f_stop: 1.4",
                                         "f_stop: 1.4, blades: 5",
                                         "f_stop: 1.4, blades: 6, blade_curvature: 0.5, blade_rotation: 20",
                                         "aperture: 40, blades: 3",
                                         "f_stop: 1.4, squeeze: 2"};
    double sharp = 0.0, peak = 0.0;
    for (int i = 0; i < 6; ++i)
    {
        char text[2048];
        snprintf(text, sizeof text,
                 HEAD "assets: { ball: { shape: sphere, radius: 0.06, divisions: 48 } }\n"
                      "materials: { m: { model: surface, emission_luminance: 100 } }\n"
                      "objects: [ { mesh: ball, material: m } ]\n"
                      "camera: { position: [0, 0, 2], vfov: 20, focus_distance: 0.3, film_height: 24, %s }\n",
                 48, 48, 256, "", lenses[i]);
        ty_exr* exr = render_text(text);
        double sum = sum_of(exr, "R");
        if (i == 0)
        {
            sharp = sum;
            peak = (double)pixel(exr, "R", 24, 24);
        }
        else if (!((double)pixel(exr, "R", 24, 24) < 0.8 * peak))
            fail_msg("%s: %g, sharp %g", lenses[i], (double)pixel(exr, "R", 24, 24), peak);

        if (fabs(sum / sharp - 1.0) > 0.02)
            fail_msg("%s: %g, sharp %g", lenses[i], sum, sharp);
        ty_exr_destroy(exr);
    }
}

// A picture of all directions is an environment: taken of one, it is that one again.
static void all_directions_are_an_environment(void** state)
{
    (void)state;
    ty_error error = {0};
    ty_exr* sky = ty_exr_create((int[4]){0, 0, 63, 31}, (int[4]){0, 0, 63, 31});
    for (int c = 0; c < 3; ++c)
    {
        float* plane = ty_exr_add_channel(sky, (const char*[]){"R", "G", "B"}[c], TY_EXR_FLOAT);
        for (int i = 0; i < 64 * 32; ++i)
        {
            float s, co;
            ty_sincos(2.0f * TY_PI * ((float)(i % 64) + 0.5f) / 64.0f, &s, &co);
            plane[i] = 1.0f + 0.5f * s + 0.25f * co + 0.01f * (float)(i / 64);
        }
    }
    assert_int_equal(ty_exr_write("all_round.exr", sky, &error), TY_OK);
    char text[2048];
    snprintf(text, sizeof text,
             HEAD "camera: { projection: equirectangular, look_at: [0, 0, -1], position: [0, 0, 0] }\n"
                  "lights: [ { type: environment, image: all_round.exr, color_space: raw } ]\n",
             64, 32, 64, "");
    ty_exr* exr = render_text(text);
    assert_int_equal(ty_exr_find_attribute(exr, "envmap")->type, TY_EXR_ENVMAP);
    assert_null(ty_exr_find_attribute(exr, "worldToNDC"));
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
        {
            float expected = pixel(sky, "R", x, y), value = pixel(exr, "R", x, y);
            if (fabsf(value - expected) > 0.01f)
                fail_msg("pixel %d, %d: %g, expected %g", x, y, (double)value, (double)expected);
        }
    ty_exr_destroy(exr);
    ty_exr_destroy(sky);
    remove("all_round.exr");
}

// A film of some pixels of the scene, by some workers.
static ty_exr* render_window(const ty_scene* scene, const int crop[4], int worker_count)
{
    ty_error error = {0};
    ty_workers* workers;
    ty_film* film;
    ty_exr* exr;
    ty_render_stats stats;
    int samples = scene->render.samples;
    ty_film_setup setup = {
        .size = {scene->film.size[0], scene->film.size[1]}, .sample_end = samples, .aovs = TY_AOV_ALL};
    memcpy(setup.crop, crop, sizeof setup.crop);
    assert_int_equal(ty_workers_create(worker_count, &workers, &error), TY_OK);
    assert_int_equal(ty_film_create(&setup, &film, &error), TY_OK);
    ty_render_options render = {.sample_end = samples};
    assert_int_equal(ty_render(scene, &render, workers, film, &stats, &error), TY_OK);
    ty_film_write write = {.scene = scene, .sample_end = samples};
    assert_int_equal(ty_film_to_exr(film, &write, &exr, &error), TY_OK);
    ty_film_destroy(film);
    ty_workers_destroy(workers);
    return exr;
}

// Everything in motion: a window has the pixels of the whole, whoever renders it; the frame after the loop is the
// first.
static void windows_and_loops_keep_every_bit(void** state)
{
    (void)state;
    char text[4096];
    snprintf(text, sizeof text,
             HEAD
             "assets: { ball: { shape: sphere, radius: 0.1, divisions: 24 }, plate: { shape: box, size: [1, 0.01, 1] } "
             "}\nmaterials: { m: { model: surface } }\nobjects:\n"
             "  - { mesh: ball, material: m, translate: { keys: { 1: [0, 0.1, 0], 3: [0.2, 0.1, 0], 5: [0, 0.1, 0] }, "
             "after: loop } }\n  - { mesh: plate, material: m }\n"
             "turntable: { angle: { keys: { 1: 0, 5: 360 }, after: loop } }\n"
             "camera: { position: [0, 0.5, 1], shutter: 0.7, f_stop: 2, blades: 5 }\n"
             "lights: [ { type: environment, radiance: 0.5 } ]\n",
             40, 30, 16, "");
    ty_error error;
    ty_error_list errors = {0};
    ty_scene* scene;
    ty_scene_options options = {0};
    assert_int_equal(ty_file_write("moving.yaml", text, strlen(text), &error), TY_OK);
    assert_int_equal(ty_scene_load("moving.yaml", &options, &scene, &errors), TY_OK);
    assert_true(scene->moves);
    ty_exr *whole = render_window(scene, (int[4]){0, 0, 39, 29}, 3),
           *part = render_window(scene, (int[4]){7, 9, 30, 20}, 1);
    for (int i = 0; i < part->channel_count; ++i)
        for (int y = 0; y < 12; ++y)
            assert_memory_equal((const float*)part->channels[i].pixels + y * 24,
                                (const float*)whole->channels[i].pixels + (y + 9) * 40 + 7, 24 * sizeof(float));
    assert_int_equal(ty_scene_set_frame(scene, 2, &errors), TY_OK);
    ty_exr* second = render_window(scene, (int[4]){0, 0, 39, 29}, 1);
    assert_memory_not_equal(second->channels[0].pixels, whole->channels[0].pixels, 40 * 30 * sizeof(float));
    assert_int_equal(ty_scene_set_frame(scene, 5, &errors), TY_OK);
    ty_exr* again = render_window(scene, (int[4]){0, 0, 39, 29}, 2);
    assert_same_picture(whole, again);
    ty_exr_destroy(whole);
    ty_exr_destroy(part);
    ty_exr_destroy(second);
    ty_exr_destroy(again);
    ty_scene_destroy(scene);
    remove("moving.yaml");
}

static void pictures_tell_their_time(void** state)
{
    (void)state;
    char text[2048];
    snprintf(text, sizeof text, HEAD "timeline: { fps: 23.976 }\nframe: 7\nlights: [ { type: environment } ]\n", 4, 4,
             4, "");
    ty_exr* exr = render_text(text);
    const ty_exr_attribute* rate = ty_exr_find_attribute(exr, "framesPerSecond");
    assert_int_equal(rate->integer[0], 24000);
    assert_int_equal(rate->integer[1], 1001);
    assert_true(ty_exr_find_attribute(exr, "tsuya/frame")->value[0] == 7.0f);
    ty_exr_destroy(exr);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alpha_lies_along_the_path),
        cmocka_unit_test(instances_smear_by_their_velocities),
        cmocka_unit_test(files_smear_from_one_to_the_next),
        cmocka_unit_test(files_within_the_shutter_count),
        cmocka_unit_test(files_keep_their_bits_where_nothing_blurs),
        cmocka_unit_test(what_goes_along_is_sharp),
        cmocka_unit_test(stillness_costs_no_bit),
        cmocka_unit_test(turning_follows_the_circle),
        cmocka_unit_test(an_orthographic_ball_has_its_size),
        cmocka_unit_test(blurs_keep_their_light),
        cmocka_unit_test(all_directions_are_an_environment),
        cmocka_unit_test(windows_and_loops_keep_every_bit),
        cmocka_unit_test(pictures_tell_their_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
