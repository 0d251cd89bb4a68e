// SPDX-License-Identifier: Apache-2.0
// The law of moisture from walks in spheres: lengths of each state, then straight lines in the logarithms.
#include <tsuya/base/memory.h>
#include <tsuya/shading/calibrate.h>

#define RADII TY_CALIBRATION_MOST_RADII

typedef struct fit_job
{
    const ty_calibration_def* def;
    ty_sphere_walk* walks; // [state][RADII]
} fit_job;

static double error_poisson(const ty_sphere_walk* walk, double length, double radius)
{
    return ty_sphere_error_poisson(walk, (double)ty_cdrf_poisson_t((float)(length / radius), 0.0f));
}

static double error_published(const ty_sphere_walk* walk, double length, double radius)
{
    return ty_sphere_error_published(walk, length / radius);
}

typedef double (*length_error)(const ty_sphere_walk*, double length, double radius);

static double sum_of_squares(const fit_job* job, int state, length_error error, double length)
{
    double sum = 0.0;
    for (int r = 0; r < job->def->radius_count; r++)
    {
        double e = error(&job->walks[state * RADII + r], length, (double)job->def->radii[r]);
        sum += e * e;
    }
    return sum;
}

// The length that answers best for all radii: the best of a coarse scan, then golden section around it.
static double fit_length(const fit_job* job, int state, length_error error)
{
    const double ratio = 0.6180339887498949, step = 1.25;
    double free_path = (double)job->def->states[state].mean_free_path, best = free_path, least = INFINITY;
    double length = free_path / 20.0;
    for (int i = 0; i < 32; i++, length *= step)
    {
        double sum = sum_of_squares(job, state, error, length);
        best = sum < least ? length : best;
        least = fmin(sum, least);
    }
    double low = best / step, high = best * step;
    for (int i = 0; i < 32; i++)
    {
        double a = high - ratio * (high - low), b = low + ratio * (high - low);
        if (sum_of_squares(job, state, error, a) < sum_of_squares(job, state, error, b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}

static void fit_row(const fit_job* job, int state, int r, ty_calibration_row* row)
{
    const ty_sphere_walk* walk = &job->walks[state * RADII + r];
    double t = ty_sphere_fit_poisson(walk), sigma = ty_sphere_fit_gaussian(walk);
    *row = (ty_calibration_row){
        .x = job->def->states[state].mean_free_path / job->def->radii[r],
        .albedo = (float)walk->moments[0],
        .mean_scatterings = (float)walk->mean_scatterings,
        .t = (float)t,
        .sigma = (float)sigma,
        .rms_poisson = (float)ty_sphere_error_poisson(walk, t),
        .rms_gaussian = (float)ty_sphere_error_gaussian(walk, sigma),
        .rms_matte = (float)ty_sphere_error_poisson(walk, 0.0),
    };
}

// Normal equations with a little pull towards what is there already, so that what no state tells stays: Gauss–Jordan.
static void solve(int n, double m[4][4], double v[4])
{
    for (int i = 0; i < n; i++)
    {
        double pivot = m[i][i];
        for (int k = 0; k < n; k++)
            m[i][k] /= pivot;
        v[i] /= pivot;
        for (int j = 0; j < n; j++)
        {
            double factor = m[j][i];
            for (int k = 0; k < n && j != i; k++)
                m[j][k] -= factor * m[i][k];
            v[j] -= j != i ? factor * v[i] : 0.0;
        }
    }
}

static void add_equation(int n, const double* row, double value, double m[4][4], double v[4])
{
    for (int i = 0; i < n; i++)
    {
        v[i] += row[i] * value;
        for (int k = 0; k < n; k++)
            m[i][k] += row[i] * row[k];
    }
}

static void begin_equations(int n, const double* prior, double m[4][4], double v[4])
{
    const double pull = 1e-6;
    for (int i = 0; i < n; i++)
    {
        m[i][i] = pull;
        v[i] = pull * prior[i];
    }
}

// The published law knows moisture alone: where there are both, it is that of cooked matter.
static double published_weight(const ty_calibration_def* def, int state)
{
    bool any = false;
    for (int s = 0; s < def->state_count; s++)
        any |= def->states[s].cooked > 0.5f;
    return !any || def->states[state].cooked > 0.5f ? 1.0 : 0.0;
}

static void fit_law(const ty_calibration_def* def, ty_calibration_fit* fit)
{
    ty_moisture_law* law = &fit->law;
    *law = ty_moisture_law_default();
    double lengths[4] = {(double)law->cooked_constant, (double)law->cooked_exponent,
                         (double)ty_ln(1e3f * law->raw_length), (double)ty_ln(1e3f * law->soaked_length)};
    double sigmas[4] = {(double)law->sigma_constant, (double)law->sigma_exponent};
    double m[4][4] = {{0}}, v[4], n[4][4] = {{0}}, u[4];
    begin_equations(4, lengths, m, v);
    begin_equations(2, sigmas, n, u);
    for (int s = 0; s < def->state_count; s++)
    {
        const ty_optical_state* state = &def->states[s];
        double w = (double)state->wet_basis, cooked = (double)state->cooked, log_w = (double)ty_ln((float)w);
        double soaking = fmin(fmax((w - 0.145) / (0.31 - 0.145), 0.0), 1.0);
        const double row[4] = {cooked, cooked * log_w, (1 - cooked) * (1 - soaking), (1 - cooked) * soaking};
        add_equation(4, row, (double)ty_ln(1e3f * fit->mean_free_path[s]), m, v);
        double weight = published_weight(def, s);
        const double published[2] = {weight, weight * log_w};
        add_equation(2, published, weight * (double)ty_ln(1e3f * fit->sigma_0[s]), n, u);
    }
    solve(4, m, v);
    solve(2, n, u);
    law->cooked_constant = (float)v[0];
    law->cooked_exponent = (float)v[1];
    law->raw_length = 1e-3f * ty_exp((float)v[2]);
    law->soaked_length = 1e-3f * ty_exp((float)v[3]);
    law->sigma_constant = (float)u[0];
    law->sigma_exponent = (float)u[1];
}

static void judge_law(const fit_job* job, ty_calibration_fit* fit)
{
    const ty_calibration_def* def = job->def;
    double poisson = 0.0, published = 0.0, weights = 0.0;
    for (int s = 0; s < def->state_count; s++)
    {
        ty_moisture state = {def->states[s].wet_basis, def->states[s].cooked};
        ty_moisture_optics optics = ty_moisture_law_at(&fit->law, state);
        for (int r = 0; r < def->radius_count; r++)
        {
            const ty_sphere_walk* walk = &job->walks[s * RADII + r];
            double a = error_poisson(walk, (double)optics.mean_free_path, (double)def->radii[r]);
            double b = error_published(walk, (double)optics.gaussian_sigma, (double)def->radii[r]);
            fit->rows[s][r].rms_law = (float)a;
            fit->rows[s][r].rms_published = (float)b;
            poisson += a * a;
            published += published_weight(def, s) * b * b;
            weights += published_weight(def, s);
        }
    }
    int count = def->state_count * def->radius_count;
    fit->law.rms = (float)sqrt(poisson / count);
    fit->rms_published = (float)sqrt(published / weights);
}

// 1/t = (1/slope)/x + bend/slope, each row weighted by t^2: least relative error.
static void fit_slope(const ty_calibration_def* def, ty_calibration_fit* fit)
{
    double m[4][4] = {{0}}, v[4] = {0}, sum = 0.0;
    int count = def->state_count * def->radius_count;
    const double prior[2] = {0.75, 0.375};
    begin_equations(2, prior, m, v);
    for (int i = 0; i < count; i++)
    {
        const ty_calibration_row* row = &fit->rows[i / def->radius_count][i % def->radius_count];
        const double equation[2] = {(double)(row->t / row->x), (double)row->t};
        add_equation(2, equation, 1.0, m, v);
    }
    solve(2, m, v);
    fit->slope = (float)(1.0 / v[0]);
    fit->bend = (float)(v[1] / v[0]);
    for (int i = 0; i < count; i++)
    {
        const ty_calibration_row* row = &fit->rows[i / def->radius_count][i % def->radius_count];
        double e = (double)(fit->slope * row->x / ((1.0f + fit->bend * row->x) * row->t)) - 1.0;
        sum += e * e;
    }
    fit->rms_t = (float)sqrt(sum / count);
}

static bool walk_all(const fit_job* job, ty_workers* workers)
{
    const ty_calibration_def* def = job->def;
    bool done = true;
    for (int s = 0; s < def->state_count; s++)
        for (int r = 0; r < def->radius_count && done; r++)
        {
            const ty_optical_state* state = &def->states[s];
            ty_sphere_walk_def walk = {
                .optical_radius = def->radii[r] / state->mean_free_path,
                .albedo = state->albedo,
                .anisotropy = state->anisotropy,
                .ior = state->ior,
                .walk_count = def->walk_count,
                .seed = {ty_rng_make(def->seed, (uint64_t)s, (uint64_t)r).key},
            };
            done = ty_sphere_walk_run(&walk, workers, &job->walks[s * RADII + r]);
        }
    return done;
}

bool ty_calibration_run(const ty_calibration_def* def, ty_workers* workers, ty_calibration_fit* out)
{
    TY_ASSERT(def->state_count > 0 && def->state_count <= TY_CALIBRATION_MOST_STATES);
    TY_ASSERT(def->radius_count > 0 && def->radius_count <= RADII);
    fit_job job = {def, TY_ALLOC(ty_sphere_walk, def->state_count * RADII)};
    bool done = walk_all(&job, workers);
    for (int s = 0; s < def->state_count && done; s++)
    {
        out->mean_free_path[s] = (float)fit_length(&job, s, error_poisson);
        out->sigma_0[s] = (float)fit_length(&job, s, error_published);
        for (int r = 0; r < def->radius_count; r++)
            fit_row(&job, s, r, &out->rows[s][r]);
    }
    if (done)
    {
        fit_law(def, out);
        judge_law(&job, out);
        fit_slope(def, out);
    }
    ty_free(job.walks);
    return done;
}
