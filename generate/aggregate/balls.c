// SPDX-License-Identifier: Apache-2.0
// Ball fitting: points go to the ball whose surface they are nearest to, each ball is fitted to its points, and again.
#include "balls.h"

enum
{
    FIT_ROUNDS = 60,
    RICE_BALLS = 10, // two rows, so that an elliptical section is met
};

static int nearest_ball(const ty_ball* balls, int count, ty_vec3 p, float* distance)
{
    int best = 0;
    *distance = TY_FLOAT_MAX;
    for (int i = 0; i < count; i++)
    {
        float d = ty_length(ty_sub(p, balls[i].center)) - balls[i].radius;
        if (d < *distance)
        {
            *distance = d;
            best = i;
        }
    }
    return best;
}

// Normal equations of sum (|p - c| - r)^2 for the step in (c, r); the last column is the right-hand side.
typedef struct normal_equations
{
    double a[4][5];
    double weight;
    int count; // of points
} normal_equations;

static void equations_add(normal_equations* eq, const ty_ball* ball, ty_vec3 p, float distance, double weight)
{
    ty_vec3 u = ty_normalize(ty_sub(p, ball->center));
    double j[5] = {(double)u.x, (double)u.y, (double)u.z, 1.0, (double)distance};
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 5; c++)
            eq->a[r][c] += weight * j[r] * j[c];
    eq->weight += weight;
    eq->count++;
}

// Gaussian elimination; the damped matrix is positive definite, so no pivoting is needed.
static void equations_solve(normal_equations* eq, double x[4])
{
    for (int i = 0; i < 4; i++)
        eq->a[i][i] += 0.02 * eq->weight;
    for (int i = 0; i < 4; i++)
        for (int r = i + 1; r < 4; r++)
        {
            double f = eq->a[r][i] / eq->a[i][i];
            for (int c = i; c < 5; c++)
                eq->a[r][c] -= f * eq->a[i][c];
        }
    for (int i = 3; i >= 0; i--)
    {
        x[i] = eq->a[i][4];
        for (int c = i + 1; c < 4; c++)
            x[i] -= eq->a[i][c] * x[c];
        x[i] /= eq->a[i][i];
    }
}

// stress: how much more a point weighs whose distance is that of the goal; 0 = all weigh the same.
static void fit_round(const ty_vec3* points, uint32_t count, ty_ball* balls, int ball_count, float goal, double stress)
{
    normal_equations eq[TY_ELEMENT_MAX_BALLS] = {0};
    for (uint32_t i = 0; i < count; i++)
    {
        float distance;
        int b = nearest_ball(balls, ball_count, points[i], &distance);
        double weight = stress > 0.0 ? 1.0 + stress * (double)ty_sqr(distance / goal) : 1.0;
        equations_add(&eq[b], &balls[b], points[i], distance, weight);
    }
    for (int b = 0; b < ball_count; b++)
        if (eq[b].count >= 4)
        {
            double x[4];
            equations_solve(&eq[b], x);
            ty_vec3 step = {(float)x[0], (float)x[1], (float)x[2]};
            balls[b].center = ty_add(balls[b].center, step);
            balls[b].radius += (float)x[3];
        }
}

// Rows at +-offset across the width, staggered along the bent axis, and one ball in each end.
static void balls_start(ty_vec3 half, float bend, ty_ball* balls)
{
    const int n = RICE_BALLS;
    float r = 0.5f * (half.y + half.z), inner = half.x - 0.92f * half.z;
    for (int i = 0; i < n; i++)
    {
        float s = 2.0f * (float)i / (float)(n - 1) - 1.0f, x = s * inner;
        float side = i == 0 || i == n - 1 ? 0.0f : i & 1 ? 1.0f : -1.0f;
        float section = ty_safe_sqrt(1.0f - ty_sqr(0.75f * x / half.x));
        balls[i].center = ty_vec3_make(x, side * (half.y - half.z) + bend * (ty_sqr(x / half.x) - 0.33f), 0.0f);
        balls[i].radius = r * section;
    }
}

float ty_balls_capsule(const ty_ball* balls, int count)
{
    ty_vec3 from = balls[0].center, axis = ty_sub(balls[count - 1].center, from);
    float radius = 0.0f;
    for (int i = 0; i < count; i++)
    {
        ty_vec3 d = ty_sub(balls[i].center, from);
        float s = ty_clamp(ty_dot(d, axis) / ty_max(ty_length_sqr(axis), 1e-12f), 0.0f, 1.0f);
        radius = ty_max(radius, ty_length(ty_mad(d, axis, -s)) + balls[i].radius);
    }
    return radius;
}

void ty_balls_refine(const ty_vec3* points, uint32_t count, int rounds, float goal, ty_element* element)
{
    const double stress = goal > 0.0f ? 30.0 : 0.0;
    for (int i = 0; i < rounds; i++)
        fit_round(points, count, element->balls, element->ball_count, goal, stress);
    double sum = 0.0;
    element->fit_max = 0.0f;
    for (uint32_t i = 0; i < count; i++)
    {
        float d;
        nearest_ball(element->balls, element->ball_count, points[i], &d);
        sum += (double)d * (double)d;
        element->fit_max = ty_max(element->fit_max, fabsf(d));
    }
    element->fit_rms = (float)sqrt(sum / (double)count);
}

void ty_balls_fit(const ty_vec3* points, uint32_t count, ty_vec3 half_size, float bend, ty_element* grain)
{
    grain->ball_count = RICE_BALLS;
    balls_start(half_size, bend, grain->balls);
    ty_balls_refine(points, count, FIT_ROUNDS, 0.0f, grain);
    for (int i = 0; i < RICE_BALLS; i++) // a hair's breadth between surfaces looks better than a cut
        grain->balls[i].radius += 0.25f * grain->fit_rms;
    grain->capsule = ty_balls_capsule(grain->balls, RICE_BALLS);
}
