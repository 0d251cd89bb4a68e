// SPDX-License-Identifier: Apache-2.0
// White bodies in a constant environment of radiance 1, through the whole program: whatever keeps energy shows 1.
#include "picture.h"
#include "report.h"
#include <math.h>
#include <stdio.h>
#include <tsuya/shading/cdrf.h>

typedef struct furnace_case
{
    const char* name;
    const char* shape; // of radius 1 cm
    const char* material;
    double expected;
} furnace_case;

#define SPHERE "{ shape: sphere, radius: 0.01, divisions: 96 }"
#define ELLIPSOID "{ shape: ellipsoid, size: [0.0125, 0.007, 0.005], divisions: 96 }"
#define TORUS "{ shape: torus, radius: 0.0075, tube: 0.003, divisions: 96 }"
#define CUBE "{ shape: box, size: [0.006, 0.006, 0.006], rounding: 0.0015, divisions: 96 }"
#define CDRF "{ model: cdrf, color: 1, mean_free_path: 3, "
#define WALK "{ model: walk, color: 1, "
#define BARE "specular_weight: 0, "
#define METAL "{ model: surface, base_metalness: 1, base_color: 1, specular_color: 1, "
#define GLASS "{ model: surface, transmission_weight: 1, specular_ior: 1.5, "

#define MIST "transmission_depth: 0.01, transmission_scatter: 0.9, "
#define BODY "{ model: surface, subsurface_weight: 1, subsurface_color: 1, subsurface_radius: 3, "

static const furnace_case cases[] = {
    {"diffuse", SPHERE, "{ model: surface, base_color: 1, specular_weight: 0 }", 1},
    {"depth, sphere", SPHERE, CDRF BARE "evaluate: depth }", 1},
    {"depth, ellipsoid", ELLIPSOID, CDRF BARE "evaluate: depth }", 1},
    {"depth, torus", TORUS, CDRF BARE "evaluate: depth }", 1},
    {"depth, rounded cube", CUBE, CDRF BARE "evaluate: depth }", 1},
    {"depth under a coat", SPHERE, CDRF "specular_roughness: 0.3, evaluate: depth }", 1},
    {"depth under a mirror coat", ELLIPSOID, CDRF "specular_roughness: 0, evaluate: depth }", 1},
    {"probe, sphere", SPHERE, CDRF BARE "evaluate: probe }", 1},
    {"probe, torus", TORUS, CDRF BARE "evaluate: probe }", 1},
    {"local poisson, sphere", SPHERE, CDRF BARE "evaluate: local }", 1},
    {"local gaussian, sphere", SPHERE, CDRF BARE "evaluate: local, kernel: gaussian }", 1},
    {"walk, sphere", SPHERE, WALK BARE "mean_free_path: 3 }", 1},
    {"walk, torus", TORUS, WALK BARE "mean_free_path: 1 }", 1},
    {"walk under a coat", ELLIPSOID, WALK "specular_roughness: 0.3, mean_free_path: 2 }", 1},
    {"walk, Henyey-Greenstein .8", ELLIPSOID, WALK BARE "mean_free_path: 2, anisotropy: 0.8 }", 1},
    {"walk, sphere R/l 4, albedo .98: A_sph", SPHERE, WALK BARE "scattering: 0.392, absorption: 0.008 }", 0.905},
    {"walk, sphere R/l 4, albedo .9: A_sph", SPHERE, WALK BARE "scattering: 0.36, absorption: 0.04 }", 0.659},
    {"dielectric over diffuse", SPHERE, "{ model: surface, base_color: 1, specular_roughness: 0.3 }", 1},
    {"the same, smooth", SPHERE, "{ model: surface, base_color: 1, specular_roughness: 0 }", 1},
    {"coat over diffuse", SPHERE, "{ model: surface, base_color: 1, coat_weight: 1, coat_roughness: 0.2 }", 1},
    {"metal, roughness .2", SPHERE, METAL "specular_roughness: 0.2 }", 1},
    {"metal, roughness .9", SPHERE, METAL "specular_roughness: 0.9 }", 1},
    {"metal, anisotropic", SPHERE, METAL "specular_roughness: 0.5, specular_roughness_anisotropy: 0.8 }", 1},
    {"glass, smooth", SPHERE, GLASS "specular_roughness: 0 }", 1},
    {"glass, roughness .5", SPHERE, GLASS "specular_roughness: 0.5 }", 1},
    {"depth by channel", TORUS, CDRF BARE "mean_free_path_scale: [1, 0.5, 0.1] }", 1},
    {"probe gaussian, ellipsoid", ELLIPSOID, CDRF BARE "evaluate: probe, kernel: gaussian }", 1},
    {"walk, smooth dielectric", SPHERE, WALK "specular_roughness: 0, mean_free_path: 3, boundary: dielectric }", 1},
    {"walk, rough dielectric", SPHERE, WALK "specular_roughness: 0.4, mean_free_path: 3, boundary: dielectric }", 1},
    {"clear mist", SPHERE, GLASS MIST "specular_roughness: 0 }", 1},
    {"clear mist, frosted", SPHERE, GLASS MIST "specular_roughness: 0.4 }", 1},
    {"rough diffuse", SPHERE, "{ model: surface, base_color: 1, base_diffuse_roughness: 1, specular_weight: 0 }", 1},
    {"fuzz over diffuse", SPHERE, "{ model: surface, base_color: 1, specular_weight: 0, fuzz_weight: 1 }", 1},
    {"fuzz over coat over diffuse", SPHERE, "{ model: surface, base_color: 1, coat_weight: 1, fuzz_weight: 1 }", 1},
    {"surface's body, depth", ELLIPSOID, BODY "subsurface_evaluate: depth }", 1},
    {"surface's body, walk, coated", ELLIPSOID, BODY "subsurface_evaluate: walk, coat_weight: 1 }", 1},
    {"sheet, glossy", SPHERE, "{ model: surface, thin_walled: true, transmission_weight: 1, specular_roughness: 0.4 }",
     1},
    {"sheet, subsurface", SPHERE,
     "{ model: surface, thin_walled: true, subsurface_weight: 1, subsurface_color: 1, specular_weight: 0 }", 1},
};

static const char* const scene_text = "tsuya: 1\n"
                                      "film: { size: [%d, %d] }\n"
                                      "camera: { position: [0.01, 0.03, 0.08], look_at: [0, 0, 0], vfov: 16 }\n"
                                      "render: { samples: %d, max_depth: 256, roulette_depth: 256 }\n"
                                      "assets:\n  body: %s\n"
                                      "materials:\n  white: %s\n"
                                      "objects:\n  - { mesh: body, material: white }\n"
                                      "lights:\n  - { type: environment, radiance: 1 }\n";

typedef struct mean_error
{
    double mean, error;
} mean_error;

// Over the pixels that the body fills.
static mean_error over_body(const ty_exr* exr)
{
    const float *g = picture_channel(exr, "G"), *alpha = picture_channel(exr, "A"),
                *variance = picture_channel(exr, "variance.Y");
    double sum = 0.0, noise = 0.0;
    int count = 0;
    for (int i = 0; i < ty_exr_width(exr) * ty_exr_height(exr); i++)
        if (alpha[i] > 0.999f)
        {
            sum += (double)g[i];
            noise += (double)variance[i];
            count++;
        }
    return (mean_error){sum / fmax(count, 1), sqrt(noise) / fmax(count, 1)};
}

static void run_case(const furnace_case* c, const bench_options* options, ty_workers* workers)
{
    char text[2000];
    double seconds;
    int size = options->quick ? 20 : 48, samples = options->quick ? 32 : 256;
    snprintf(text, sizeof text, scene_text, size, size, samples, c->shape, c->material);
    picture_def def = {.path = "furnace", .text = text, .samples = samples, .seed = 3, .workers = workers};
    ty_exr* exr = picture_render(&def, &seconds);
    mean_error m = over_body(exr);
    ty_exr_destroy(exr);
    report_near(c->name, m.mean, c->expected, (c->expected == 1.0 ? 0.003 : 0.005) + (options->quick ? m.error : 0.0));
}

// The mean free path, in mm, at which the law gives a sphere of 10 mm this sigma.
static double path_of_sigma(double sigma)
{
    float low = 0.01f, high = 3.0f;
    for (int i = 0; i < 60; i++)
    {
        float middle = 0.5f * (low + high);
        if ((double)ty_cdrf_gaussian_sigma(middle, 0) < sigma)
            low = middle;
        else
            high = middle;
    }
    return 10.0 * (double)low;
}

void bench_furnace(const bench_options* options)
{
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(options->threads, &workers, &error) != TY_OK)
        workers = NULL;
    report_title("Furnace: white bodies in an environment of radiance 1, rendered", "  (its noise is below .001)");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        run_case(&cases[i], options, workers);
    char material[300];
    snprintf(material, sizeof material,
             "{ model: cdrf, color: 1, specular_weight: 0, mean_free_path: %.6f, evaluate: local, kernel: "
             "gaussian_published }",
             path_of_sigma(0.5));
    furnace_case published = {"control: published, sigma .5, gains I / pi", SPHERE, material,
                              (double)ty_cdrf_gaussian_integral(0.5f) / (double)TY_PI};
    run_case(&published, options, workers);
    report_near("I(.5) / pi", published.expected, 1.103, 0.0005);
    ty_workers_destroy(workers);
}
