// SPDX-License-Identifier: Apache-2.0
// A fill's frames on every kind of parameter, through the whole program: a picture with the texture is the picture with
// the number that the texture holds at that time, by uv and along three axes.
#include "whole_program.h"
#include <math.h>
#include <tsuya/image/image.h>

// Three frames; the channel `mark` is 0, 1 and 2 all over.
static const char skin[] =
    "{ fill: { kind: fill, cells: [8, 8], scale: 1, start: plain, marks: [{ preset: plain }, { preset: "
    "plain }, { preset: plain }], run: { frames: 3, steps: 1 }, events: [{ at: 2, op: mark, mark: "
    "1, shape: all }, { at: 3, op: mark, mark: 2, shape: all }] }, loop: true, interpolate: linear }";

static ty_exr* ball(const char* material, double frame)
{
    char text[4096];
    snprintf(text, sizeof text,
             "tsuya: 1\n"
             "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: 16, max_depth: 4, seed: 5 }\n"
             "timeline: { start: 1, end: 3, fps: 24 }\n"
             "frame: %g\n"
             "camera: { position: [0, 0.06, 0.2], look_at: [0, 0, 0], vfov: 14 }\n"
             "assets:\n"
             "  skin: %s\n"
             "  ball: { shape: sphere, radius: 0.02 }\n"
             "  floor: { shape: plane, size: [0.2, 0, 0.2] }\n"
             "materials:\n"
             "  m: { %s }\n"
             "  grey: { model: surface, base_color: 0.4 }\n"
             "objects:\n"
             "  - { mesh: ball, material: m }\n"
             "  - { mesh: floor, material: grey, translate: [0, -0.02, 0] }\n"
             "lights:\n"
             "  - { type: environment, radiance: 0.4 }\n"
             "  - { type: rectangle, center: [-0.2, 0.3, 0.2], target: [0, 0, 0], size: [0.1, 0.1], radiance: 30 }\n",
             frame, skin, material);
    return render_text(text);
}

// Mean of the absolute difference, over the mean of b.
static double distance(const ty_exr* a, const ty_exr* b)
{
    static const char* const names[] = {"R", "G", "B"};
    double sum = 0.0, whole = 0.0;
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 256; i++)
        {
            double there = (double)pixel(b, names[c], i % 16, i / 16);
            sum += fabs((double)pixel(a, names[c], i % 16, i / 16) - there);
            whole += there;
        }
    return sum / whole;
}

typedef struct parameter
{
    const char* text;     // of the material, %s where the input goes
    double low, per_mark; // the numbers that it goes through
} parameter;

static const parameter parameters[] = {
    {"model: surface, base_color: %s", 0.1, 0.3},
    {"model: surface, base_color: 0.5, specular_roughness: %s", 0.1, 0.3},
    {"model: surface, base_color: 0.5, base_metalness: %s", 0.0, 0.5},
    {"model: surface, base_color: 0.5, emission_luminance: %s", 0.0, 1.0},
    {"model: surface, base_color: 0.5, opacity: %s", 0.2, 0.4},
    {"model: surface, base_color: 0.3, coat_weight: %s", 0.0, 0.5},
    {"model: surface, base_color: 0.3, subsurface_weight: %s, subsurface_radius: 0.004", 0.0, 0.5},
    {"model: surface, base_color: 0.5, transmission_weight: %s", 0.0, 0.5},
    {"model: cdrf, color: 0.7, moisture: %s", 0.2, 0.2},
    {"model: cdrf, color: %s, moisture: 0.5", 0.3, 0.25},
};

static ty_exr* with_input(const parameter* p, const char* input, double frame)
{
    char material[1024];
    int length = (int)(strstr(p->text, "%s") - p->text);
    snprintf(material, sizeof material, "%.*s%s%s", length, p->text, input, p->text + length + 2);
    return ball(material, frame);
}

static void every_parameter_follows(void** state)
{
    (void)state;
    static const char* const mappings[] = {"", ", mapping: triplanar, size: 0.01"};
    static const double moments[3][2] = {{1, 0}, {2.5, 1.5}, {3, 2}}; // frame, and its mark
    for (size_t i = 0; i < sizeof parameters / sizeof *parameters; i++)
    {
        const parameter* p = &parameters[i];
        ty_exr* constant[3];
        char input[256];
        for (int k = 0; k < 3; k++)
        {
            snprintf(input, sizeof input, "%.9g", p->low + p->per_mark * moments[k][1]);
            constant[k] = with_input(p, input, 1.0);
        }
        double seen = distance(constant[0], constant[2]), worst = 0.0;
        for (int k = 0; k < 6; k++)
        {
            snprintf(input, sizeof input, "{ texture: skin, channel: mark, scale: %.9g, offset: %.9g%s }", p->per_mark,
                     p->low, mappings[k % 2]);
            ty_exr* found = with_input(p, input, moments[k / 2][0]);
            worst = fmax(worst, distance(found, constant[k / 2]));
            ty_exr_destroy(found);
        }
        print_message("%-90s changes %.4f, differs %.1e\n", p->text, seen, worst);
        assert_true(seen > 0.02);
        assert_true(worst < 3e-3);
        for (int k = 0; k < 3; k++)
            ty_exr_destroy(constant[k]);
    }
}

// Half of the field is a hole, on the right, then above: distance grows by one a cell away from its edge. The middle of
// the plane lies a quarter of the field from both edges.
static void bump_follows(void** state)
{
    (void)state;
    static const double expected[3][3] = {{1, 1, 0}, {1.5, 0.5, 0.5}, {2, 0, 1}}; // frame, slopes along +x and -z
    for (int i = 0; i < 3; i++)
    {
        char text[2048];
        snprintf(
            text, sizeof text,
            "tsuya: 1\n"
            "film: { size: [8, 8], filter: box, filter_width: 1, half: false }\n"
            "render: { samples: 16, max_depth: 2, seed: 5 }\n"
            "timeline: { start: 1, end: 2, fps: 24 }\n"
            "frame: %g\n"
            "camera: { position: [0, 1, 0.0001], look_at: [0, 0, 0], vfov: 1 }\n"
            "assets:\n"
            "  floor: { shape: plane, size: [0.2, 0, 0.2] }\n"
            "  skin: { fill: { kind: fill, cells: [64, 64], scale: 1, tile: none, start: plain, preset: plain, run: { "
            "frames: 2, steps: 1 }, events: [{ at: 1, op: hole, shape: rectangle, center: [56, 32], size: [16, 64] }, "
            "{ at: 2, op: fill, shape: all }, { at: 2, op: hole, shape: rectangle, center: [32, 8], size: [64, 16] }] "
            "}, hold: true, interpolate: linear }\n"
            "materials: { m: { model: surface, bump: { texture: skin, channel: distance, scale: 0.001 } } }\n"
            "objects: [ { mesh: floor, material: m } ]\n"
            "lights: [ { type: environment, radiance: 1 } ]\n",
            expected[i][0]);
        ty_exr* exr = render_text(text);
        double y = (double)pixel(exr, "N.Y", 4, 4), slope = 0.001 / (0.4 / 64);
        double x = -(double)pixel(exr, "N.X", 4, 4) / y / slope, z = (double)pixel(exr, "N.Z", 4, 4) / y / slope;
        print_message("frame %.1f: slopes %.3f %.3f\n", expected[i][0], x, z);
        assert_true(fabs(x - expected[i][1]) < 0.02 && fabs(z - expected[i][2]) < 0.02);
        ty_exr_destroy(exr);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_parameter_follows),
        cmocka_unit_test(bump_follows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
