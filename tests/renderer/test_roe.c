// SPDX-License-Identifier: Apache-2.0
// Eggs of fish: membrane, white and yolk in one another. Colours against Beer and Lambert's law, the way light takes
// against rays traced by Snell's law in double precision.
#include "whole_program.h"
#include <math.h>

static const char* const channels[3] = {"R", "G", "B"};

// Mean of each channel over the picture.
static void render_colour(const char* text, double out[3])
{
    ty_exr* exr = render_text(text);
    int width = ty_exr_width(exr), height = ty_exr_height(exr);
    for (int c = 0; c < 3; c++)
    {
        out[c] = 0.0;
        for (int i = 0; i < width * height; i++)
            out[c] += (double)pixel(exr, channels[c], i % width, i / width) / (width * height);
    }
    ty_exr_destroy(exr);
}

// --- Beer and Lambert: bodies that bend nothing ---

typedef struct tint
{
    double colour[3], depth; // what a depth lets through, m
} tint;

static const tint membrane_tint = {{0.9, 0.7, 0.5}, 0.0005};
static const tint white_tint = {{0.95, 0.6, 0.2}, 0.006};
static const tint yolk_tint = {{0.8, 0.25, 0.04}, 0.002};

static double through(const tint* t, int channel, double way)
{
    return exp(log(t->colour[channel]) * way / t->depth);
}

static int write_material(char* out, size_t size, const char* name, const tint* t, double ior, double roughness,
                          int priority)
{
    return snprintf(out, size,
                    "  %s: { model: surface, transmission_weight: 1, specular_roughness: %.9g, specular_ior: %.9g, "
                    "transmission_color: [%.9g, %.9g, %.9g], transmission_depth: %.9g, priority: %d }\n",
                    name, roughness, ior, t->colour[0], t->colour[1], t->colour[2], t->depth, priority);
}

// What a white sky shows through objects that bend nothing, along -z at height `across`. assets and objects: lines.
static void see_through(const char* assets, const char* objects, const char* priorities, double roughness,
                        double across, double found[3])
{
    char text[4096], materials[1024];
    int p[3];
    assert_int_equal(sscanf(priorities, "%d %d %d", &p[0], &p[1], &p[2]), 3);
    int n = write_material(materials, sizeof materials, "membrane", &membrane_tint, 1.0, roughness, p[0]);
    n += write_material(materials + n, sizeof materials - (size_t)n, "white", &white_tint, 1.0, roughness, p[1]);
    write_material(materials + n, sizeof materials - (size_t)n, "yolk", &yolk_tint, 1.0, roughness, p[2]);
    snprintf(text, sizeof text,
             "tsuya: 1\n"
             "film: { size: [2, 2], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: 64, max_depth: 64, roulette_depth: 64 }\n"
             "camera: { position: [0, %.9g, 0.0125], look_at: [0, %.9g, 0], vfov: 0.01 }\n"
             "assets:\n%smaterials:\n%sobjects:\n%slights: [ { type: environment, radiance: 1 } ]\n",
             across, across, assets, materials, objects);
    render_colour(text, found);
}

static void assert_colour(const char* what, const double found[3], const double expected[3], double tolerance)
{
    print_message("%s: %.6f %.6f %.6f expected %.6f %.6f %.6f\n", what, found[0], found[1], found[2], expected[0],
                  expected[1], expected[2]);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(found[c] - expected[c]) <= tolerance * expected[c] + 1e-7);
}

static void slabs_absorb_by_their_thickness(void** state)
{
    (void)state;
    static const double thickness[] = {0.00005, 0.0005, 0.003, 0.012};
    for (int i = 0; i < 8; i++)
    {
        char assets[256];
        double d = thickness[i / 2], found[3], expected[3];
        snprintf(assets, sizeof assets, "  slab: { shape: box, size: [0.02, 0.02, %.9g] }\n", 0.5 * d);
        see_through(assets, "  - { mesh: slab, material: white }\n", "0 0 0", i % 2 ? 0.4 : 0.0, 0.0, found);
        for (int c = 0; c < 3; c++)
            expected[c] = through(&white_tint, c, d);
        assert_colour(i % 2 ? "rough slab" : "slab", found, expected, 2e-5);
    }
}

// Half a chord at a distance from a ball's middle, 0 beside it.
static double half_chord(double radius, double distance)
{
    return distance < radius ? sqrt(radius * radius - distance * distance) : 0.0;
}

// Membrane, white and yolk along a line at a height over the middle.
static void colour_of_egg(double radius, double white, double yolk, double lift, double height, double out[3])
{
    double a = 2 * half_chord(radius, height), b = 2 * half_chord(white, height);
    double c = 2 * half_chord(yolk, fabs(height - lift));
    for (int k = 0; k < 3; k++)
        out[k] = through(&membrane_tint, k, a - b) * through(&white_tint, k, b - c) * through(&yolk_tint, k, c);
}

// The egg of every size at several heights, its yolk off the middle: each body absorbs where no other is in it. The
// line is known within shift; the mesh is the ball within 2e-5 of its radius.
static void eggs_absorb_by_their_chords(void** state)
{
    (void)state;
    static const double radii[] = {0.0005, 0.0031, 0.01}, heights[] = {0.0, 0.35, 0.93}, shift = 0.3e-6;
    static const char assets[] = "  egg: { shape: sphere, radius: 1, divisions: 512 }\n";
    for (int i = 0; i < 9; i++)
    {
        char objects[512];
        double r = radii[i / 3], white = r - 53e-6, yolk = 0.525 * white, lift = 0.46 * white, y = heights[i % 3] * r;
        snprintf(objects, sizeof objects,
                 "  - { mesh: egg, material: membrane, scale: %.9g }\n"
                 "  - { mesh: egg, material: white, scale: %.9g }\n"
                 "  - { mesh: egg, material: yolk, scale: %.9g, translate: [0, %.9g, 0] }\n",
                 r, white, yolk, lift);
        double found[3], expected[3], lower[3], upper[3];
        see_through(assets, objects, "0 0 0", 0.0, y, found);
        colour_of_egg(r, white, yolk, lift, y, expected);
        colour_of_egg(r, white, yolk, lift, y - shift, lower);
        colour_of_egg(r, white, yolk, lift, y + shift, upper);
        print_message("egg of %.1f mm at %.2f: %.6f %.6f %.6f expected %.6f %.6f %.6f\n", 1e3 * r, heights[i % 3],
                      found[0], found[1], found[2], expected[0], expected[1], expected[2]);
        for (int k = 0; k < 3; k++)
        {
            double close = 1e-4 * (1.0 - log(expected[k])) * expected[k];
            assert_true(fabs(found[k] - expected[k]) <= 0.5 * fabs(upper[k] - lower[k]) + close + 1e-7);
        }
    }
}

// Slabs that reach into one another by 1 mm each: of two priorities the higher is there, of equals the one entered
// last.
static void overlaps_belong_to_one(void** state)
{
    (void)state;
    static const char assets[] = "  slab: { shape: box, size: [0.02, 0.02, 0.0015] }\n";
    static const char objects[] = "  - { mesh: slab, material: membrane, translate: [0, 0, 0.002] }\n"
                                  "  - { mesh: slab, material: white }\n"
                                  "  - { mesh: slab, material: yolk, translate: [0, 0, -0.002] }\n";
    // mm of membrane, white and yolk by the priorities of the three, seen from the membrane's side.
    static const struct
    {
        const char* priorities;
        double way[3];
    } cases[] = {
        {"3 2 1", {3, 2, 2}}, {"1 2 3", {2, 2, 3}}, {"0 0 0", {2, 2, 3}}, {"1 3 1", {2, 3, 2}}, {"3 1 3", {3, 1, 3}},
    };
    for (int i = 0; i < 5; i++)
    {
        double found[3], expected[3];
        see_through(assets, objects, cases[i].priorities, 0.0, 0.0, found);
        for (int c = 0; c < 3; c++)
            expected[c] = through(&membrane_tint, c, 1e-3 * cases[i].way[0]) *
                          through(&white_tint, c, 1e-3 * cases[i].way[1]) *
                          through(&yolk_tint, c, 1e-3 * cases[i].way[2]);
        assert_colour(cases[i].priorities, found, expected, 5e-5);
    }
}

// --- Snell: rays by hand ---

typedef struct point3
{
    double x, y, z;
} point3;

static point3 along(point3 p, point3 d, double t)
{
    return (point3){p.x + t * d.x, p.y + t * d.y, p.z + t * d.z};
}

static double dot(point3 a, point3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static point3 unit(point3 v)
{
    double s = 1.0 / sqrt(dot(v, v));
    return (point3){v.x * s, v.y * s, v.z * s};
}

// A ball that the ray meets, from outside or within, and what lies beyond.
typedef struct meeting
{
    point3 centre;
    double radius;
    bool leaving;
    double ior;         // beyond
    const tint* matter; // beyond, NULL = air
} meeting;

typedef struct hand_ray
{
    point3 origin, direction;
    double weight; // of the boundaries
    double way[3]; // m through membrane, white, yolk
} hand_ray;

// Meets the balls in turn. The ray begins in what has this index and tint.
static void trace_by_hand(hand_ray* ray, double ior, const tint* matter, const meeting* list, int count)
{
    static const tint* const tints[3] = {&membrane_tint, &white_tint, &yolk_tint};
    for (int i = 0; i < count; i++)
    {
        const meeting* m = &list[i];
        point3 o = along(ray->origin, m->centre, -1.0);
        double b = dot(o, ray->direction), discriminant = b * b - dot(o, o) + m->radius * m->radius;
        assert_true(discriminant > 0.0);
        double t = -b + (m->leaving ? 1.0 : -1.0) * sqrt(discriminant);
        assert_true(t > 0.0);
        for (int k = 0; k < 3; k++)
            ray->way[k] += matter == tints[k] ? t : 0.0;
        ray->origin = along(ray->origin, ray->direction, t);
        point3 n = unit(along(ray->origin, m->centre, -1.0));
        if (m->leaving)
            n = (point3){-n.x, -n.y, -n.z};
        double eta = ior / m->ior, c = -dot(ray->direction, n), beyond = sqrt(1.0 - eta * eta * (1.0 - c * c));
        double s = (eta * c - beyond) / (eta * c + beyond), p = (c - eta * beyond) / (c + eta * beyond);
        ray->weight *= 1.0 - 0.5 * (s * s + p * p);
        point3 bent = {eta * ray->direction.x, eta * ray->direction.y, eta * ray->direction.z};
        ray->direction = unit(along(bent, n, eta * c - beyond));
        ior = m->ior;
        matter = m->matter;
    }
}

// Two eggs by their middles; a yolk apart from the middle of each. The second is far away where it is not wanted.
typedef struct eggs
{
    point3 centre[2];
    double radius, white, yolk;
    point3 lift; // of the yolk
    double roughness;
} eggs;

static const double ior_membrane = 1.38, ior_white = 1.34, ior_yolk = 1.46;

static eggs one_egg(void)
{
    return (eggs){.centre = {{0, 0, 0}, {0, 0, -5}},
                  .radius = 0.0031,
                  .white = 0.0031 - 53e-6,
                  .yolk = 0.0016,
                  .lift = {0.0005, 0.0012, -0.0003}};
}

// What the camera at `from` sees of a lamp around `lamp`, a ball of `radius`.
static void see_lamp(const eggs* e, point3 from, point3 direction, point3 lamp, double radius, int samples,
                     double found[3])
{
    char text[4096], materials[1024], objects[2048] = "";
    int n = write_material(materials, sizeof materials, "membrane", &membrane_tint, ior_membrane, e->roughness, 0),
        m = 0;
    n += write_material(materials + n, sizeof materials - (size_t)n, "white", &white_tint, ior_white, e->roughness, 0);
    write_material(materials + n, sizeof materials - (size_t)n, "yolk", &yolk_tint, ior_yolk, e->roughness, 0);
    for (int i = 0; i < 2; i++)
    {
        point3 c = e->centre[i], y = along(c, e->lift, 1.0);
        m += snprintf(objects + m, sizeof objects - (size_t)m,
                      "  - { mesh: egg, material: membrane, scale: %.9g, translate: [%.9g, %.9g, %.9g] }\n"
                      "  - { mesh: egg, material: white, scale: %.9g, translate: [%.9g, %.9g, %.9g] }\n"
                      "  - { mesh: egg, material: yolk, scale: %.9g, translate: [%.9g, %.9g, %.9g] }\n",
                      e->radius, c.x, c.y, c.z, e->white, c.x, c.y, c.z, e->yolk, y.x, y.y, y.z);
    }
    point3 to = along(from, direction, 0.1);
    snprintf(text, sizeof text,
             "tsuya: 1\n"
             "film: { size: [16, 16], filter: box, filter_width: 1, half: false }\n"
             "render: { samples: %d, max_depth: 32, roulette_depth: 32, seed: 5 }\n"
             "camera: { position: [%.9g, %.9g, %.9g], look_at: [%.9g, %.9g, %.9g], vfov: 0.01 }\n"
             "assets: { egg: { shape: sphere, radius: 1, divisions: 256 } }\n"
             "materials:\n%sobjects:\n%s"
             "lights: [ { type: sphere, center: [%.9g, %.9g, %.9g], radius: %.9g, radiance: 1 } ]\n",
             samples, from.x, from.y, from.z, to.x, to.y, to.z, materials, objects, lamp.x, lamp.y, lamp.z, radius);
    render_colour(text, found);
}

// The lamp stands on the ray by hand, near its last boundary and far from it; beside that no light is to be found. At
// a distance d a lamp of radius r shows that ray and path are apart by less than r.
static void assert_path(const char* what, const eggs* e, point3 from, point3 direction, const hand_ray* hand,
                        double spread)
{
    static const double distances[] = {0.004, 0.4};
    double radii[2] = {4e-6 + 0.004 * spread, 0.4 * spread}; // 4 um: the point where it leaves
    point3 side = unit((point3){hand->direction.y, -hand->direction.x, 0.0});
    point3 other = {hand->direction.y * side.z - hand->direction.z * side.y,
                    hand->direction.z * side.x - hand->direction.x * side.z,
                    hand->direction.x * side.y - hand->direction.y * side.x};
    double expected[3], found[3];
    for (int c = 0; c < 3; c++)
        expected[c] = hand->weight * through(&membrane_tint, c, hand->way[0]) * through(&white_tint, c, hand->way[1]) *
                      through(&yolk_tint, c, hand->way[2]);
    for (int i = 0; i < 2; i++)
    {
        point3 lamp = along(hand->origin, hand->direction, distances[i]);
        see_lamp(e, from, direction, lamp, radii[i], 256, found);
        // 65,536 paths, of which some three in a hundred are reflected; rough boundaries send some beyond the lamp.
        assert_colour(what, found, expected, spread > 0.005 ? 0.015 : 0.004);
        for (int c = 1; c < 3; c++) // that share is the same for all channels
            assert_true(fabs(found[c] / found[0] / (expected[c] / expected[0]) - 1.0) < (spread > 0.005 ? 5e-3 : 1e-3));
        for (int k = 0; k < 4; k++)
        {
            double step = (k % 2 ? -2.5 : 2.5) * radii[i];
            see_lamp(e, from, direction, along(lamp, k < 2 ? side : other, step), radii[i], 16, found);
            assert_true(found[0] < 0.01 * expected[0]);
        }
    }
}

// Membrane, white, yolk, white, membrane, air.
static void fill_egg(const eggs* e, point3 centre, meeting list[6])
{
    point3 yolk = along(centre, e->lift, 1.0);
    list[0] = (meeting){centre, e->radius, false, ior_membrane, &membrane_tint};
    list[1] = (meeting){centre, e->white, false, ior_white, &white_tint};
    list[2] = (meeting){yolk, e->yolk, false, ior_yolk, &yolk_tint};
    list[3] = (meeting){yolk, e->yolk, true, ior_white, &white_tint};
    list[4] = (meeting){centre, e->white, true, ior_membrane, &membrane_tint};
    list[5] = (meeting){centre, e->radius, true, 1.0, NULL};
}

static void light_goes_through_an_egg_as_by_hand(void** state)
{
    (void)state;
    static const point3 aims[] = {{0.0004, 0.0009, 0}, {-0.0002, 0.0018, 0.0001}};
    eggs e = one_egg();
    for (int i = 0; i < 2; i++)
    {
        point3 from = {0.002, 0.001, 0.006}, direction = unit(along(aims[i], from, -1.0));
        meeting list[6];
        fill_egg(&e, e.centre[0], list);
        hand_ray hand = {from, direction, 1.0, {0}};
        trace_by_hand(&hand, 1.0, NULL, list, 6);
        print_message("leaves at %.6f %.6f %.6f mm towards %.6f %.6f %.6f, ways %.5f %.5f %.5f mm\n",
                      1e3 * hand.origin.x, 1e3 * hand.origin.y, 1e3 * hand.origin.z, hand.direction.x, hand.direction.y,
                      hand.direction.z, 1e3 * hand.way[0], 1e3 * hand.way[1], 1e3 * hand.way[2]);
        assert_path("egg", &e, from, direction, &hand, 0.001);
    }
}

// The same through boundaries that are a little rough: the light goes the same way within some hundredths.
static void rough_eggs_spread_about_that_way(void** state)
{
    (void)state;
    eggs e = one_egg();
    e.roughness = 0.06;
    point3 from = {0.002, 0.001, 0.006}, direction = unit(along((point3){0.0004, 0.0009, 0}, from, -1.0));
    meeting list[6];
    fill_egg(&e, e.centre[0], list);
    hand_ray hand = {from, direction, 1.0, {0}};
    trace_by_hand(&hand, 1.0, NULL, list, 6);
    assert_path("rough egg", &e, from, direction, &hand, 0.03);
}

static void the_camera_may_be_in_the_yolk(void** state)
{
    (void)state;
    eggs e = one_egg();
    point3 from = {0.0006, 0.0015, 0.0001}, direction = unit((point3){-0.5, -0.7, 0.4});
    meeting list[6];
    fill_egg(&e, e.centre[0], list);
    hand_ray hand = {from, direction, 1.0, {0}};
    trace_by_hand(&hand, ior_yolk, &yolk_tint, list + 3, 3);
    assert_path("from the yolk", &e, from, direction, &hand, 0.001);
}

// Two eggs that touch reach into one another by more than a membrane. Where the ray comes from the first, the second
// begins at its own surface: of equals the one entered last is there; from the other side it is the other way round.
static void touching_eggs_part_at_the_second(void** state)
{
    (void)state;
    eggs e = one_egg();
    e.centre[1] = (point3){0.0001, -0.0002, -0.00611}; // .088 mm
    e.lift = (point3){0, 0.002, 0};                    // out of the way
    e.yolk = 0.0006;
    for (int i = 0; i < 2; i++)
    {
        point3 a = e.centre[i], b = e.centre[1 - i];
        point3 from = {0.0003, -0.0004, i ? -0.012 : 0.006}, direction = unit((point3){0.001, -0.002, i ? 1.0 : -1.0});
        const meeting list[6] = {
            {a, e.radius, false, ior_membrane, &membrane_tint}, {a, e.white, false, ior_white, &white_tint},
            {b, e.radius, false, ior_membrane, &membrane_tint}, {b, e.white, false, ior_white, &white_tint},
            {b, e.white, true, ior_membrane, &membrane_tint},   {b, e.radius, true, 1.0, NULL},
        };
        hand_ray hand = {from, direction, 1.0, {0}};
        trace_by_hand(&hand, 1.0, NULL, list, 6);
        assert_path("two eggs", &e, from, direction, &hand, 0.001);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slabs_absorb_by_their_thickness),  cmocka_unit_test(eggs_absorb_by_their_chords),
        cmocka_unit_test(overlaps_belong_to_one),           cmocka_unit_test(light_goes_through_an_egg_as_by_hand),
        cmocka_unit_test(rough_eggs_spread_about_that_way), cmocka_unit_test(the_camera_may_be_in_the_yolk),
        cmocka_unit_test(touching_eggs_part_at_the_second),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
