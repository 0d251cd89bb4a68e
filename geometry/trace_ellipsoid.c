// SPDX-License-Identifier: Apache-2.0
// A tight ellipsoid about a mesh: Khachiyan's algorithm on the mesh's extreme vertices.
#include "trace_world.h"
#include "triangle.h"

#define DIRECTIONS 256
#define MAX_POINTS (DIRECTIONS + 6)
#define ENOUGH_VERTICES 50000u // of larger meshes every n-th is looked at; all are enclosed in the end

typedef struct fit
{
    double points[MAX_POINTS][3];
    double weight[MAX_POINTS];
    int count;
    double center[3];
    double l[3][3]; // lower Cholesky factor of the weighted covariance
} fit;

// Extreme vertices along directions spread by a Fibonacci spiral: a small set with nearly the mesh's own hull.
static void gather_extremes(const ty_mesh* mesh, fit* f)
{
    const uint32_t stride = 1 + mesh->vertex_count / ENOUGH_VERTICES;
    for (int i = 0; i < DIRECTIONS; i++)
    {
        double z = 1.0 - (2.0 * i + 1.0) / DIRECTIONS, phi = i * 2.399963229728653;
        double r = sqrt(1.0 - z * z);
        ty_vec3 direction = {(float)(r * cos(phi)), (float)(r * sin(phi)), (float)z};
        uint32_t best = 0;
        float reach = ty_dot(mesh->positions[0], direction);
        for (uint32_t k = 1; k < mesh->vertex_count; k += stride)
        {
            float s = ty_dot(mesh->positions[k], direction);
            if (s > reach)
            {
                reach = s;
                best = k;
            }
        }
        f->points[i][0] = mesh->positions[best].x;
        f->points[i][1] = mesh->positions[best].y;
        f->points[i][2] = mesh->positions[best].z;
    }
    f->count = DIRECTIONS;
}

// Six points close to the centre give a flat mesh's ellipsoid a thickness.
static void add_thickness(ty_bounds bounds, fit* f)
{
    ty_vec3 center = ty_mul(ty_add(bounds.low, bounds.high), 0.5f);
    double thickness = 1e-3 * (double)ty_length(ty_sub(bounds.high, bounds.low));
    for (int i = 0; i < 6; i++)
    {
        double* p = f->points[f->count++];
        p[0] = center.x;
        p[1] = center.y;
        p[2] = center.z;
        p[i >> 1] += i & 1 ? -thickness : thickness;
    }
}

static void factor_covariance(fit* f)
{
    double c[3][3] = {{0}};
    for (int k = 0; k < 3; k++)
    {
        f->center[k] = 0.0;
        for (int i = 0; i < f->count; i++)
            f->center[k] += f->weight[i] * f->points[i][k];
    }
    for (int i = 0; i < f->count; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b <= a; b++)
                c[a][b] += f->weight[i] * (f->points[i][a] - f->center[a]) * (f->points[i][b] - f->center[b]);
    f->l[0][0] = sqrt(c[0][0]);
    f->l[1][0] = c[1][0] / f->l[0][0];
    f->l[2][0] = c[2][0] / f->l[0][0];
    f->l[1][1] = sqrt(fmax(c[1][1] - f->l[1][0] * f->l[1][0], 1e-12 * c[1][1]));
    f->l[2][1] = (c[2][1] - f->l[2][0] * f->l[1][0]) / f->l[1][1];
    f->l[2][2] = sqrt(fmax(c[2][2] - f->l[2][0] * f->l[2][0] - f->l[2][1] * f->l[2][1], 1e-12 * c[2][2]));
}

// Squared length of L^-1 (p - center).
static double distance_sqr(const fit* f, const double p[3])
{
    double x = (p[0] - f->center[0]) / f->l[0][0];
    double y = (p[1] - f->center[1] - f->l[1][0] * x) / f->l[1][1];
    double z = (p[2] - f->center[2] - f->l[2][0] * x - f->l[2][1] * y) / f->l[2][2];
    return x * x + y * y + z * z;
}

// L. G. Khachiyan 1996, "Rounding of polytopes in the real number model of computation": weight moves towards the
// farthest point until all lie within (1 + tolerance) of the dimension.
static void round_polytope(fit* f)
{
    const double dimension = 3.0, tolerance = 0.01;
    for (int i = 0; i < f->count; i++)
        f->weight[i] = 1.0 / f->count;
    for (int iteration = 0; iteration < 500; iteration++)
    {
        factor_covariance(f);
        int farthest = 0;
        double most = 0.0;
        for (int i = 0; i < f->count; i++)
        {
            double d = distance_sqr(f, f->points[i]);
            if (d > most)
            {
                most = d;
                farthest = i;
            }
        }
        if (most <= dimension * (1.0 + tolerance))
            return;
        // In the lifted form of the paper kappa = most + 1 and the dimension is one more.
        double step = (most - dimension) / ((dimension + 1.0) * most);
        for (int i = 0; i < f->count; i++)
            f->weight[i] *= 1.0 - step;
        f->weight[farthest] += step;
    }
    factor_covariance(f);
}

void ty_trace_fit_ellipsoid(ty_trace_prototype* prototype)
{
    const ty_mesh* mesh = prototype->mesh;
    fit f;
    gather_extremes(mesh, &f);
    add_thickness(prototype->bounds, &f);
    round_polytope(&f);
    double most = 0.0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        ty_vec3 v = mesh->positions[i];
        most = fmax(most, distance_sqr(&f, (double[3]){v.x, v.y, v.z}));
    }
    // A little larger than exact, so that rounding in the ray's map cannot cut the surface.
    double r = sqrt(most) * 1.0001;
    ty_affine m = {{(float)(f.l[0][0] * r), (float)(f.l[1][0] * r), (float)(f.l[2][0] * r)},
                   {0.0f, (float)(f.l[1][1] * r), (float)(f.l[2][1] * r)},
                   {0.0f, 0.0f, (float)(f.l[2][2] * r)},
                   {(float)f.center[0], (float)f.center[1], (float)f.center[2]}};
    // What has no extent at all gets a ball.
    if (!ty_affine_invert(&m, &prototype->to_sphere))
    {
        m = (ty_affine){{1e-3f, 0, 0}, {0, 1e-3f, 0}, {0, 0, 1e-3f}, prototype->bounds.low};
        prototype->to_sphere = (ty_affine){{1e3f, 0, 0}, {0, 1e3f, 0}, {0, 0, 1e3f}, ty_mul(m.t, -1e3f)};
    }
    prototype->from_sphere = m;
    prototype->has_ellipsoid = true;
}

void ty_trace_fit_inner(const ty_world* world, uint32_t prototype)
{
    ty_trace_prototype* p = &world->prototypes[prototype];
    if (!ty_world_inside(world, prototype, p->from_sphere.t))
        return;
    float nearest_sqr = 1.0f;
    for (uint32_t i = 0; i < p->mesh->triangle_count; i++)
    {
        ty_vec3 corner[3], zero = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            corner[k] = ty_map_point(&p->to_sphere, p->mesh->positions[p->mesh->triangles[i][k]]);
        ty_vec2 w = ty_triangle_closest(zero, corner[0], corner[1], corner[2]);
        ty_vec3 at = ty_triangle_at(corner[0], corner[1], corner[2], w);
        nearest_sqr = ty_min(nearest_sqr, ty_length_sqr(at));
    }
    // Smaller by what rounds in the test of a ray that comes from far away.
    float radius = 0.999f * sqrtf(nearest_sqr) - 1e-3f;
    p->inner_radius_sqr = radius > 0.0f ? radius * radius : 0.0f;
}
