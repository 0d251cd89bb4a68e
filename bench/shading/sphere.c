// SPDX-License-Identifier: Apache-2.0
// The sphere, where a walk is exactly a convolution: its harmonics against the kernels, and the materials on a mesh.
#include "report.h"
#include "subject.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/workers.h>

#define PI 3.14159265358979323846
#define DEGREES 80
#define ANGLES 60
#define ALPHAS 5
#define RADII 11
#define BLOCK 2000 // walks

static const double alphas[ALPHAS] = {0.9, 0.98, 0.995, 0.999, 1.0};
// Radius over mean free path.
static const double radii[RADII] = {60, 20, 12, 8, 6, 4, 3, 2, 1.5, 1, 0.5};

// What the laws of docs/shading.md say, by albedo and radius.
static const double sigma_table[ALPHAS][RADII] = {
    {.022, .069, .121, .192, .266, .404, .521, .713, .877, 1.125, 1.539},
    {.034, .111, .194, .287, .365, .491, .593, .760, .906, 1.132, 1.527},
    {.048, .159, .249, .335, .403, .517, .611, .771, .913, 1.134, 1.525},
    {.072, .196, .275, .352, .416, .525, .616, .774, .915, 1.135, 1.525},
    {.106, .210, .283, .357, .419, .527, .618, .775, .915, 1.135, 1.525},
};
static const double t_table[ALPHAS][RADII] = {
    {.001, .009, .024, .053, .093, .190, .289, .469, .628, .880, 1.409},
    {.003, .021, .055, .107, .161, .263, .354, .514, .657, .887, 1.391},
    {.005, .039, .084, .139, .190, .285, .371, .525, .664, .889, 1.388},
    {.011, .057, .100, .152, .200, .292, .376, .528, .665, .890, 1.387},
    {.022, .064, .105, .155, .203, .294, .377, .528, .666, .890, 1.387},
};
static const double albedo_table[ALPHAS][RADII] = {
    {.489, .510, .534, .567, .598, .659, .710, .782, .827, .878, .936},
    {.739, .772, .805, .842, .869, .905, .926, .949, .961, .974, .987},
    {.869, .906, .932, .951, .962, .974, .980, .987, .990, .993, .997},
    {.950, .976, .985, .990, .992, .995, .996, .997, .998, .999, .999},
    {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1},
};

// RMS of the best fits by radius, those of in_profiles, white.
#define PROFILES 6
static const double fit_expected[PROFILES][5] = {
    {.027, .015, .0095, .0095, .0006}, {.059, .030, .0152, .0152, .0019}, {.100, .048, .0202, .0199, .0035},
    {.152, .066, .0255, .0240, .0064}, {.207, .072, .0241, .0216, .0084}, {.253, .070, .0156, .0144, .0081},
};

typedef enum kernel
{
    LAMBERT,
    PUBLISHED, // wrapped Gaussian as published
    GAUSSIAN,  // the same, normalised
    SPHERICAL, // Gaussian on the sphere
    POISSON,
    KERNELS
} kernel;
static const char* const kernel_names[KERNELS] = {"lambert", "published", "gaussian", "spherical", "poisson"};

static double cosines[ANGLES], weights[ANGLES]; // of the middles of equal steps in angle; their shares of the sphere
static double step_cosines[2 * ANGLES];
static double legendre[DEGREES + 1][ANGLES];
static double lambert[DEGREES + 1]; // of max(cos, 0) in Legendre polynomials

static void legendre_at(double x, double out[DEGREES + 1])
{
    out[0] = 1.0;
    out[1] = x;
    for (int l = 2; l <= DEGREES; l++)
        out[l] = ((2 * l - 1) * x * out[l - 1] - (l - 1) * out[l - 2]) / l;
}

static void make_tables(void)
{
    double p[DEGREES + 1], total = 0.0;
    for (int i = 0; i < 2 * ANGLES; i++)
        step_cosines[i] = cos(i * PI / ANGLES);
    for (int i = 0; i < ANGLES; i++)
    {
        double angle = (i + 0.5) * PI / ANGLES;
        cosines[i] = cos(angle);
        total += weights[i] = sin(angle);
        legendre_at(cosines[i], p);
        for (int l = 0; l <= DEGREES; l++)
            legendre[l][i] = p[l];
    }
    for (int i = 0; i < ANGLES; i++)
        weights[i] /= total;
    double moment = 0.125; // integral of x P_l over 0..1, for l = 2
    lambert[0] = 0.25;
    lambert[1] = 0.5;
    for (int l = 2; l <= DEGREES; l += 2)
    {
        lambert[l] = (l + 0.5) * moment;
        moment *= -(l - 1.0) / (l + 4.0);
    }
}

// --- walks ---

typedef struct moments
{
    double value[ALPHAS][DEGREES + 1]; // mean of alpha^n P_l(cosine between entry and exit)
    double scatterings, scatterings_sqr;
} moments;

typedef struct walk_job
{
    double radius;
    moments* blocks;
} walk_job;

static void run_blocks(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    walk_job* job = context;
    for (int64_t block = begin; block < end; block++)
    {
        ty_rng rng = ty_rng_make((ty_seed){31}, (uint64_t)(job->radius * 16), (uint64_t)block);
        moments* m = &job->blocks[block];
        for (int i = 0; i < BLOCK; i++)
        {
            vec pole = {0, 0, 1}, exit;
            double p[DEGREES + 1];
            int n = implicit_walk(&implicit_shapes[0], pole, pole, 1.0 / job->radius, &rng, &exit);
            legendre_at(fmin(fmax(exit.z, -1), 1), p);
            m->scatterings += n;
            m->scatterings_sqr += (double)n * n;
            for (int a = 0; a < ALPHAS; a++)
            {
                double w = pow(alphas[a], n);
                for (int l = 0; l <= DEGREES; l++)
                    m->value[a][l] += w * p[l];
            }
        }
    }
}

static moments walks(double radius, int blocks, ty_workers* workers)
{
    walk_job job = {radius, TY_ALLOC(moments, blocks)};
    moments sum = {0};
    ty_parallel_for(workers, blocks, 1, run_blocks, &job);
    for (int b = 0; b < blocks; b++)
    {
        sum.scatterings += job.blocks[b].scatterings / blocks / BLOCK;
        sum.scatterings_sqr += job.blocks[b].scatterings_sqr / blocks / BLOCK;
        for (int i = 0; i < ALPHAS * (DEGREES + 1); i++)
            (&sum.value[0][0])[i] += (&job.blocks[b].value[0][0])[i] / blocks / BLOCK;
    }
    ty_free(job.blocks);
    return sum;
}

// Response to one light under the harmonics k_l, with total flux that of Lambert.
static void profile(const double k[DEGREES + 1], double out[ANGLES])
{
    memset(out, 0, ANGLES * sizeof *out);
    for (int l = 0; l <= DEGREES; l++)
        for (int i = 0; i < ANGLES; i++)
            out[i] += lambert[l] * k[l] / k[0] * legendre[l][i];
}

// --- kernels and their fits ---

static void kernel_profile(kernel which, double spread, double out[ANGLES])
{
    double k[DEGREES + 1];
    for (int l = 0; l <= DEGREES; l++)
        k[l] = which == POISSON ? exp(-l * spread) : exp(-0.5 * l * (l + 1) * spread * spread);
    if (which == POISSON || which == SPHERICAL)
        profile(k, out);
    for (int i = 0; i < ANGLES && which == LAMBERT; i++)
        out[i] = fmax(cosines[i], 0);
    if (which != PUBLISHED && which != GAUSSIAN)
        return;
    double integral = 4.0; // the wrapped Gaussian's Fourier series and its integral over the sphere
    for (int i = 0; i < ANGLES; i++)
        out[i] = 1 / PI + 0.5 * exp(-0.5 * spread * spread) * cosines[i];
    for (int n = 1; n <= 200; n++)
    {
        double d = 4.0 * n * n - 1, e = exp(-2.0 * n * n * spread * spread) * (n % 2 ? 1 : -1);
        if (fabs(e) < 1e-12)
            break;
        integral -= 8 * e / (d * d);
        for (int i = 0; i < ANGLES; i++)
            out[i] += 2 / PI * e / d * step_cosines[n * (2 * i + 1) % (2 * ANGLES)];
    }
    for (int i = 0; i < ANGLES && which == GAUSSIAN; i++)
        out[i] *= PI / integral;
}

static double rms(const double a[ANGLES], const double b[ANGLES])
{
    double sum = 0.0;
    for (int i = 0; i < ANGLES; i++)
        sum += weights[i] * (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

static double misfit(kernel which, double log_spread, const double truth[ANGLES])
{
    double model[ANGLES];
    kernel_profile(which, exp(log_spread), model);
    return rms(model, truth);
}

// Golden section over the logarithm of the spread.
static double fit(kernel which, const double truth[ANGLES], double* error)
{
    const double g = 0.6180339887498949;
    double low = log(5e-4), high = log(4.0), c = high - g * (high - low), d = low + g * (high - low);
    double fc = misfit(which, c, truth), fd = misfit(which, d, truth);
    for (int i = 0; i < 40; i++)
    {
        if (fc < fd)
        {
            high = d;
            d = c;
            fd = fc;
            fc = misfit(which, c = high - g * (high - low), truth);
        }
        else
        {
            low = c;
            c = d;
            fc = fd;
            fd = misfit(which, d = low + g * (high - low), truth);
        }
    }
    *error = fmin(fc, fd);
    return exp(0.5 * (low + high));
}

// --- materials on a mesh ---

static void material_profile(const subject* s, ty_material* material, int samples, double out[ANGLES])
{
    vec pole = {0.48, 0.6, 0.64}, side = {0.8, 0, -0.6}, lights[ANGLES]; // somewhere, and a tangent
    for (int i = 0; i < ANGLES; i++)
    {
        double sine = sqrt(1 - cosines[i] * cosines[i]);
        lights[i] = (vec){pole.x * cosines[i] + side.x * sine, pole.y * cosines[i] + side.y * sine,
                          pole.z * cosines[i] + side.z * sine};
    }
    ty_surface_point p = subject_point(s, pole, pole);
    ty_rng rng = ty_rng_make((ty_seed){32}, 0, 0);
    memset(out, 0, ANGLES * sizeof *out);
    for (int k = 0; k < samples; k++)
    {
        ty_bsdf b;
        ty_rgb weight;
        float u[4];
        roberts_sequence(k, (const double[4]){0.1, 0.4, 0.7, 0.2}, u);
        if (subject_leave(s, material, &p, u, &rng, &b, &weight))
            subject_light(s, &b, (double)weight.g, &rng, lights, ANGLES, out);
    }
    for (int i = 0; i < ANGLES; i++)
        out[i] /= samples;
    ty_material_destroy(material);
}

typedef enum program
{
    LOCAL_PUBLISHED,
    LOCAL_GAUSSIAN,
    LOCAL_POISSON,
    DEPTH,
    PROBE,
    PROGRAMS
} program;
static const char* const program_names[PROGRAMS] = {"local_published", "local_gaussian", "local_poisson", "depth",
                                                    "probe"};

static void program_profiles(const subject* s, double path, bool quick, double out[PROGRAMS][ANGLES])
{
    int samples = quick ? 8000 : 60000;
    material_profile(s, subject_cdrf(TY_CDRF_LOCAL, TY_CDRF_GAUSSIAN_PUBLISHED, path), 1, out[LOCAL_PUBLISHED]);
    material_profile(s, subject_cdrf(TY_CDRF_LOCAL, TY_CDRF_GAUSSIAN, path), 1, out[LOCAL_GAUSSIAN]);
    material_profile(s, subject_cdrf(TY_CDRF_LOCAL, TY_CDRF_POISSON, path), 1, out[LOCAL_POISSON]);
    material_profile(s, subject_cdrf(TY_CDRF_DEPTH, TY_CDRF_POISSON, path), samples, out[DEPTH]);
    material_profile(s, subject_cdrf(TY_CDRF_PROBE, TY_CDRF_POISSON, path), samples, out[PROBE]);
}

// --- the rows ---

static FILE* open_table(const bench_options* options, const char* name, const char* columns)
{
    if (!options->folder)
        return NULL;
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.tsv", options->folder, name);
    FILE* file = fopen(path, "w");
    if (file)
        fprintf(file, "%s\n", columns);
    return file;
}

// Place in the table of RMS; negative = not there.
static int profile_of(double radius)
{
    static const double profiles[PROFILES] = {20, 8, 4, 2, 1, 0.5};
    for (int i = 0; i < PROFILES; i++)
        if (radius == profiles[i])
            return i;
    return -1;
}

static bool in_profiles(double radius)
{
    return profile_of(radius) >= 0;
}

typedef struct sphere_run
{
    const bench_options* options;
    subject ball;
    moments walked[RADII];
    FILE *errors, *curves;
} sphere_run;

static int walk_blocks_of(const bench_options* options)
{
    return options->quick ? 20 : 200;
}

static void report_walks(const sphere_run* run)
{
    report_title("The walk in a sphere: scatterings of a white one (4R/3l), albedo of the whole sphere",
                 "  (independent of the renderer: bench/shading/implicit.c)");
    for (int r = 0; r < RADII; r++)
    {
        char name[80];
        double expected = 4.0 / 3.0 * radii[r];
        if (run->walked[r].scatterings == 0.0)
            continue;
        snprintf(name, sizeof name, "scatterings, R/l %g", radii[r]);
        double n = run->walked[r].scatterings, variance = run->walked[r].scatterings_sqr - n * n;
        double noise = run->options->quick ? 3.0 * sqrt(variance / (walk_blocks_of(run->options) * BLOCK)) : 0.0;
        report_near(name, n, expected, 0.02 * expected + noise);
        for (int a = 0; a < ALPHAS - 1; a++)
        {
            snprintf(name, sizeof name, "A_sph, R/l %g, alpha %g", radii[r], alphas[a]);
            report_near(name, run->walked[r].value[a][0], albedo_table[a][r], 0.005);
        }
    }
}

static void report_fits(const sphere_run* run)
{
    report_title("Best fits of one kernel parameter against the tables of the laws", NULL);
    for (int a = ALPHAS - 1; a >= 0; a--)
        for (int r = 0; r < RADII; r++)
        {
            double truth[ANGLES], error;
            char name[80];
            if (run->walked[r].scatterings == 0.0)
                continue;
            profile(run->walked[r].value[a], truth);
            // Half of the table's last digit, and the noise of the walks at the small end.
            double sigma = sigma_table[a][r], t = t_table[a][r], slack = run->options->quick ? 2e-3 : 1e-3;
            snprintf(name, sizeof name, "sigma, R/l %g, alpha %g", radii[r], alphas[a]);
            report_near(name, fit(GAUSSIAN, truth, &error), sigma, 0.03 * sigma + slack);
            snprintf(name, sizeof name, "t, R/l %g, alpha %g", radii[r], alphas[a]);
            report_near(name, fit(POISSON, truth, &error), t, 0.03 * t + slack);
        }
}

static void report_limits(const sphere_run* run, int r, const double error[KERNELS],
                          const double program_error[PROGRAMS])
{
    char name[80];
    const double* expected = fit_expected[profile_of(radii[r])];
    const double slack = run->options->quick ? 0.002 : 0.001; // noise of walks and exits
    for (int k = 0; k < KERNELS; k++)
    {
        snprintf(name, sizeof name, "R/l %g: %s, best fit", radii[r], kernel_names[k]);
        report_near(name, error[k], expected[k], slack + 0.01 * expected[k]);
    }
    snprintf(name, sizeof name, "R/l %g: local, gaussian", radii[r]);
    report_most(name, program_error[LOCAL_GAUSSIAN], expected[GAUSSIAN], 0.028);
    snprintf(name, sizeof name, "R/l %g: local, poisson", radii[r]);
    report_most(name, program_error[LOCAL_POISSON], expected[POISSON], 0.010 + slack);
    snprintf(name, sizeof name, "R/l %g: depth", radii[r]);
    report_most(name, program_error[DEPTH], expected[POISSON], 0.010 + slack);
    snprintf(name, sizeof name, "R/l %g: local, published", radii[r]);
    report_near(name, program_error[LOCAL_PUBLISHED], expected[PUBLISHED], 0.006);
}

// RMS over the sphere under one light: best fits, and the program's materials under its own laws.
static void report_radius(const sphere_run* run, int r)
{
    double truth[ANGLES], best[KERNELS][ANGLES], ours[PROGRAMS][ANGLES], error[KERNELS], program_error[PROGRAMS];
    profile(run->walked[r].value[ALPHAS - 1], truth);
    for (int k = LAMBERT; k < KERNELS; k++)
        kernel_profile((kernel)k, k == LAMBERT ? 0 : fit((kernel)k, truth, &error[k]), best[k]);
    error[LAMBERT] = rms(best[LAMBERT], truth);
    program_profiles(&run->ball, 1.0 / radii[r], run->options->quick, ours);
    printf("  %5g   ", radii[r]);
    for (int k = 0; k < KERNELS; k++)
        printf(" %9.4f", error[k]);
    printf("   |");
    for (int k = 0; k < PROGRAMS; k++)
        printf(" %9.4f", program_error[k] = rms(ours[k], truth));
    printf("\n");
    if (run->errors)
    {
        fprintf(run->errors, "%g", radii[r]);
        for (int k = 0; k < KERNELS; k++)
            fprintf(run->errors, "\t%.5f", error[k]);
        for (int k = 0; k < PROGRAMS; k++)
            fprintf(run->errors, "\t%.5f", program_error[k]);
        fprintf(run->errors, "\n");
    }
    for (int i = 0; i < ANGLES && run->curves; i++)
    {
        fprintf(run->curves, "%g\t%.1f\t%.5f", radii[r], (i + 0.5) * 180 / ANGLES, truth[i]);
        for (int k = 0; k < KERNELS; k++)
            fprintf(run->curves, "\t%.5f", best[k][i]);
        for (int k = 0; k < PROGRAMS; k++)
            fprintf(run->curves, "\t%.5f", ours[k][i]);
        fprintf(run->curves, "\n");
    }
    if (in_profiles(radii[r]))
        report_limits(run, r, error, program_error);
}

static double at_degrees(const double p[ANGLES], double degrees)
{
    double x = degrees * ANGLES / 180 - 0.5;
    int i = (int)fmin(fmax(floor(x), 0), ANGLES - 2);
    return p[i] + (p[i + 1] - p[i]) * fmin(x - i, 1.0);
}

static void report_terminator(const sphere_run* run)
{
    double truth[ANGLES], gaussian[ANGLES], poisson[ANGLES], ours[PROGRAMS][ANGLES], error;
    int r = 5; // R/l = 4
    profile(run->walked[r].value[ALPHAS - 1], truth);
    kernel_profile(GAUSSIAN, fit(GAUSSIAN, truth, &error), gaussian);
    kernel_profile(POISSON, fit(POISSON, truth, &error), poisson);
    program_profiles(&run->ball, 1.0 / radii[r], run->options->quick, ours);
    report_title("Terminator at R/l = 4: E at 90, 120 and 180 degrees from the light", NULL);
    printf("  %-24s %8s %8s %8s\n", "", "90", "120", "180");
    const double* rows[] = {truth,       gaussian,   poisson, ours[LOCAL_GAUSSIAN], ours[LOCAL_POISSON],
                            ours[DEPTH], ours[PROBE]};
    const char* names[] = {"walk", "gaussian", "poisson", "local, gaussian", "local, poisson", "depth", "probe"};
    for (int i = 0; i < 7; i++)
        printf("  %-24s %8.4f %8.4f %8.4f\n", names[i], at_degrees(rows[i], 90), at_degrees(rows[i], 120),
               at_degrees(rows[i], 180));
    report_near("walk, 90", at_degrees(truth, 90), 0.139, 0.004);
    report_near("walk, 180", at_degrees(truth, 180), 0.0316, 0.003);
    report_near("local, gaussian, 120, less the walk's", at_degrees(ours[LOCAL_GAUSSIAN], 120) - at_degrees(truth, 120),
                -0.019, 0.004);
    report_near("depth, 120, less the walk's", at_degrees(ours[DEPTH], 120) - at_degrees(truth, 120), -0.004, 0.003);
    report_near("local, gaussian, 90", at_degrees(ours[LOCAL_GAUSSIAN], 90), 0.172, 0.004);
    report_near("local, gaussian, 180", at_degrees(ours[LOCAL_GAUSSIAN], 180), 0.0004, 0.0005);
    report_near("local, poisson, 90", at_degrees(ours[LOCAL_POISSON], 90), 0.148, 0.004);
    report_near("local, poisson, 180", at_degrees(ours[LOCAL_POISSON], 180), 0.0284, 0.002);
    report_near("depth, 90", at_degrees(ours[DEPTH], 90), 0.148, 0.006);
    report_near("depth, 180", at_degrees(ours[DEPTH], 180), 0.0284, 0.003);
}

void bench_sphere(const bench_options* options)
{
    sphere_run run = {.options = options};
    ty_workers* workers;
    ty_error error;
    if (ty_workers_create(options->threads, &workers, &error) != TY_OK)
        workers = NULL;
    make_tables();
    subject_init(&run.ball, &implicit_shapes[0], 192);
    for (int r = 0; r < RADII; r++)
        if (!options->quick || in_profiles(radii[r]))
            run.walked[r] = walks(radii[r], walk_blocks_of(options), workers);
    ty_workers_destroy(workers);
    report_walks(&run);
    report_fits(&run);
    char columns[256] = "radius";
    for (int k = 0; k < KERNELS; k++)
        strcat(strcat(columns, "\t"), kernel_names[k]);
    for (int k = 0; k < PROGRAMS; k++)
        strcat(strcat(columns, "\t"), program_names[k]);
    run.errors = open_table(options, "sphere_errors", columns);
    char curves[300] = "radius\tangle\twalk";
    run.curves = open_table(options, "sphere_profiles", strcat(curves, columns + 6));
    report_title(
        "A sphere under one light, white: RMS against the walk (a lit Lambert point facing the light is 1)",
        "    R/l    best fit:  lambert published  gaussian spherical   poisson   |   in the program, its own laws");
    for (int r = 0; r < RADII; r++)
        if (run.walked[r].scatterings > 0.0)
            report_radius(&run, r);
    if (run.errors)
        fclose(run.errors);
    if (run.curves)
        fclose(run.curves);
    report_terminator(&run);
    subject_term(&run.ball);
}
