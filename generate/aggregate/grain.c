// SPDX-License-Identifier: Apache-2.0
// The rice grain: a box grid wrapped around a blunt ellipsoid and bent, tapered, ridged and dented into a cooked grain.
#include "balls.h"
#include "element_kinds.h"
#include <string.h>

// What makes one variant differ from the next.
typedef struct shape
{
    float a, b, c; // m, half sizes
    float taper;   // of the section, over half the length
    float bend;    // m, sagitta of the axis
    float twist;   // rad over half the length
    float notch;   // m
    float ridge[2];
    ty_vec2 ridge_phase[2]; // (cos, sin)
    ty_vec3 lump_center[3]; // m
    float lump[3];          // m
} shape;

// A point of |x/a|^3 + (y/b)^2 + (z/c)^2 = 1 towards the unit vector u: a round section, blunt but rounded ends.
static ty_vec3 blunt_ellipsoid(const shape* s, ty_vec3 u)
{
    float x = ty_min(fabsf(u.x), 1.0f);
    float k = sqrtf((1.0f + x + x * x) / (1.0f + x)); // sqrt((1 - x^3) / (1 - x^2))
    return ty_vec3_make(s->a * u.x, s->b * u.y * k, s->c * u.z * k);
}

static shape shape_draw(const ty_element_def* def, ty_seed seed, int variant)
{
    ty_rng rng = ty_rng_make(seed, 0x6772616e, (uint64_t)variant);
    float bell[3];
    for (int i = 0; i < 3; i++)
        bell[i] = ty_clamp(ty_element_bell(&rng), -2.0f, 2.0f) * def->variation;
    shape s = {.a = 0.5f * def->length * (1.0f + bell[0]), .b = 0.5f * def->width * (1.0f + 0.8f * bell[1])};
    s.c = 0.5f * def->thickness * (1.0f + 0.4f * bell[1] + 0.7f * bell[2]);
    s.c = ty_min(s.c, s.b);
    s.taper = 0.06f + 0.03f * ty_element_bell(&rng);
    s.bend = s.a * (0.05f + 0.045f * ty_element_bell(&rng));
    s.twist = 0.08f * ty_element_bell(&rng);
    s.notch = 2.0f * s.b * def->notch * (1.0f + 0.2f * ty_element_bell(&rng));
    for (int i = 0; i < 2; i++)
    {
        s.ridge[i] = s.b * (i ? 0.014f : 0.026f);
        ty_sincos(ty_rng_range(&rng, 0.0f, 2.0f * TY_PI), &s.ridge_phase[i].y, &s.ridge_phase[i].x);
    }
    for (int i = 0; i < 3; i++)
    {
        float x = ty_rng_range(&rng, -0.9f, 0.9f), y = ty_element_bell(&rng), z = ty_element_bell(&rng);
        s.lump_center[i] = blunt_ellipsoid(&s, ty_normalize(ty_vec3_make(x, y, z)));
        s.lump[i] = s.b * 0.04f * ty_element_bell(&rng);
    }
    return s;
}

// Real part of (y + iz)^order times the conjugate of phase: cos(order * angle - phase) |.|^order.
static float ridge_wave(float y, float z, int order, ty_vec2 phase)
{
    float re = 1.0f, im = 0.0f;
    for (int i = 0; i < order; i++)
    {
        float t = re * y - im * z;
        im = re * z + im * y;
        re = t;
    }
    return re * phase.x + im * phase.y;
}

// u is a unit vector; the germ sits at +x, +y.
static ty_vec3 shape_point(const shape* s, ty_vec3 u, float notch)
{
    ty_vec3 p = blunt_ellipsoid(s, u);
    float rho = sqrtf(u.y * u.y + u.z * u.z), radial = 0.0f;
    if (rho > 0.0f)
    {
        float fade = ty_sqr(rho * rho), y = u.y / rho, z = u.z / rho;
        radial = fade * (s->ridge[0] * ridge_wave(y, z, 4, s->ridge_phase[0]) +
                         s->ridge[1] * ridge_wave(y, z, 6, s->ridge_phase[1]));
    }
    for (int i = 0; i < 3; i++)
        radial += s->lump[i] * ty_exp(-ty_length_sqr(ty_sub(p, s->lump_center[i])) / (2.0f * s->b * s->b));
    ty_vec3 germ = blunt_ellipsoid(s, ty_vec3_make(0.82f, 0.5723635f, 0.0f));
    float width = 0.44f * s->b, dent = notch * ty_exp(-ty_length_sqr(ty_sub(p, germ)) / (2.0f * width * width));
    p = ty_mad(p, u, radial);
    p = ty_mad(p, ty_normalize(ty_vec3_make(germ.x / ty_sqr(s->a), germ.y / ty_sqr(s->b), 0.0f)), -dent);
    float x = p.x / s->a, section = 1.0f - s->taper * x, sine, cosine;
    ty_sincos(s->twist * x, &sine, &cosine);
    float y = p.y * section, z = p.z * section;
    return ty_vec3_make(p.x, cosine * y - sine * z + s->bend * (x * x - 0.33f), sine * y + cosine * z);
}

// --- the box grid: surface points of an nx * n * n lattice, numbered without gaps ---

typedef struct lattice
{
    int nx, n;
    int32_t* index; // [(nx+1)(n+1)(n+1)], -1 inside
    uint32_t count;
} lattice;

static bool on_surface(const lattice* g, int i, int j, int k)
{
    return i == 0 || j == 0 || k == 0 || i == g->nx || j == g->n || k == g->n;
}

static int32_t* lattice_at(const lattice* g, int i, int j, int k)
{
    return &g->index[((size_t)i * (size_t)(g->n + 1) + (size_t)j) * (size_t)(g->n + 1) + (size_t)k];
}

static void lattice_number(lattice* g)
{
    for (int i = 0; i <= g->nx; i++)
        for (int j = 0; j <= g->n; j++)
            for (int k = 0; k <= g->n; k++)
                *lattice_at(g, i, j, k) = on_surface(g, i, j, k) ? (int32_t)g->count++ : -1;
}

// The unit vector of a box point in [-1,1]^3: the cube mapped so that areas stay even (Nowell 2005).
static ty_vec3 cube_to_sphere(ty_vec3 c)
{
    float x = c.x * c.x, y = c.y * c.y, z = c.z * c.z;
    return ty_normalize(ty_vec3_make(c.x * ty_safe_sqrt(1.0f - 0.5f * (y + z) + y * z / 3.0f),
                                     c.y * ty_safe_sqrt(1.0f - 0.5f * (z + x) + z * x / 3.0f),
                                     c.z * ty_safe_sqrt(1.0f - 0.5f * (x + y) + x * y / 3.0f)));
}

static void lattice_directions(const lattice* g, ty_vec3* u)
{
    for (int i = 0; i <= g->nx; i++)
        for (int j = 0; j <= g->n; j++)
            for (int k = 0; k <= g->n; k++)
            {
                int32_t v = *lattice_at(g, i, j, k);
                if (v < 0)
                    continue;
                ty_vec3 c = {2.0f * (float)i / (float)g->nx - 1.0f, 2.0f * (float)j / (float)g->n - 1.0f,
                             2.0f * (float)k / (float)g->n - 1.0f};
                u[v] = cube_to_sphere(c);
            }
}

// Mean of the lattice neighbours on the ellipsoid of the grain's sizes, as a direction again.
static ty_vec3 neighbour_mean(const lattice* g, const shape* s, const ty_vec3* u, const int at[3])
{
    const int size[3] = {g->nx, g->n, g->n};
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int axis = 0; axis < 3; axis++)
        for (int step = -1; step <= 1; step += 2)
        {
            int to[3] = {at[0], at[1], at[2]};
            to[axis] += step;
            if (to[axis] < 0 || to[axis] > size[axis])
                continue;
            int32_t v = *lattice_at(g, to[0], to[1], to[2]);
            if (v >= 0)
                sum = ty_add(sum, ty_mul3(u[v], ty_vec3_make(s->a, s->b, s->c)));
        }
    return ty_normalize(ty_vec3_make(sum.x / s->a, sum.y / s->b, sum.z / s->c));
}

// Evens out the triangles: every direction moves to the mean of its neighbours (Jacobi, so that the order is no
// matter).
static void lattice_relax(const lattice* g, const shape* s, ty_vec3* u, ty_vec3* scratch)
{
    for (int round = 0; round < 24; round++)
    {
        for (int i = 0; i <= g->nx; i++)
            for (int j = 0; j <= g->n; j++)
                for (int k = 0; k <= g->n; k++)
                {
                    int32_t v = *lattice_at(g, i, j, k);
                    if (v >= 0)
                        scratch[v] = neighbour_mean(g, s, u, (int[3]){i, j, k});
                }
        memcpy(u, scratch, g->count * sizeof *u);
    }
}

static void lattice_triangles(const lattice* g, ty_mesh* mesh)
{
    uint32_t count = 0;
    int size[3] = {g->nx, g->n, g->n};
    for (int axis = 0; axis < 3; axis++)
    {
        int b = (axis + 1) % 3, c = (axis + 2) % 3;
        for (int side = 0; side < 2; side++)
            for (int s = 0; s < size[b]; s++)
                for (int t = 0; t < size[c]; t++)
                {
                    static const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                    uint32_t q[4];
                    for (int e = 0; e < 4; e++)
                    {
                        const int* w = corner[side ? e : 3 - e];
                        int at[3];
                        at[axis] = side ? size[axis] : 0;
                        at[b] = s + w[0];
                        at[c] = t + w[1];
                        q[e] = (uint32_t)*lattice_at(g, at[0], at[1], at[2]);
                    }
                    ty_mesh_set_quad(mesh, count, q);
                    count += 2;
                }
    }
    TY_ASSERT(count == mesh->triangle_count);
}

// Balls for the surface without its dent, where the mesh has a dent that balls need not follow.
static ty_status smooth_fit(ty_element* grain, ty_vec3* smooth, float tolerance, ty_error* error)
{
    ty_vec3* dented = grain->mesh->positions;
    grain->mesh->positions = smooth;
    ty_mesh_compute_bounds(grain->mesh);
    ty_status status = ty_element_fit(grain, tolerance, error);
    grain->mesh->positions = dented;
    return status;
}

// smooth holds the surface without its dent, which the balls are fitted to.
static ty_status grain_finish(ty_element* grain, const shape* s, ty_vec3* smooth, float tolerance, ty_error* error)
{
    ty_status status = TY_OK;
    ty_vec3 shift = ty_element_weigh(grain);
    for (uint32_t i = 0; i < grain->mesh->vertex_count; i++)
        smooth[i] = ty_sub(smooth[i], shift);
    grain->width = 2.0f * s->b;
    if (tolerance > 0.0f)
        status = smooth_fit(grain, smooth, tolerance, error);
    else
        ty_balls_fit(smooth, grain->mesh->vertex_count, ty_vec3_make(s->a, s->b, s->c), s->bend, grain);
    ty_element_enclose(grain);
    ty_mesh_compute_bounds(grain->mesh);
    ty_mesh_compute_welds(grain->mesh);
    ty_mesh_compute_normals(grain->mesh, TY_PI);
    ty_mesh_compute_curvature(grain->mesh, 2);
    return status;
}

static ty_status lattice_create(const ty_element_def* def, int divisions, lattice* g, ty_mesh** mesh, ty_error* error)
{
    *g = (lattice){.n = divisions, .nx = (int)((float)divisions * def->length / def->width + 0.5f)};
    g->index = TY_TRY_ALLOC(int32_t, (size_t)(g->nx + 1) * (size_t)(g->n + 1) * (size_t)(g->n + 1));
    *mesh = NULL;
    if (g->index)
    {
        lattice_number(g);
        *mesh = ty_mesh_create(g->count, (uint32_t)(4 * (2 * g->nx * g->n + g->n * g->n)));
    }
    if (*mesh)
        return TY_OK;
    ty_free(g->index);
    g->index = NULL;
    return ty_error_set(error, TY_NO_MEMORY, "no memory for a grain of %d divisions", divisions);
}

ty_status ty_rice_surface(const ty_element_def* def, ty_seed seed, int variant, int divisions, bool dented,
                          ty_mesh** out, float* width, ty_error* error)
{
    shape s = shape_draw(def, seed, variant);
    lattice g;
    ty_status status = lattice_create(def, divisions, &g, out, error);
    if (status != TY_OK)
        return status;
    lattice_directions(&g, (*out)->positions);
    lattice_relax(&g, &s, (*out)->positions, (*out)->normals);
    for (uint32_t i = 0; i < g.count; i++)
        (*out)->positions[i] = shape_point(&s, (*out)->positions[i], dented ? s.notch : 0.0f);
    lattice_triangles(&g, *out);
    ty_free(g.index);
    *width = 2.0f * s.b;
    return TY_OK;
}

ty_status ty_rice_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out, ty_error* error)
{
    memset(out, 0, sizeof *out);
    shape s = shape_draw(def, seed, variant);
    lattice g;
    ty_status status = lattice_create(def, def->divisions, &g, &out->mesh, error);
    if (status != TY_OK)
        return status;
    ty_vec3* smooth = TY_TRY_ALLOC(ty_vec3, g.count);
    if (smooth)
    {
        ty_vec3* u = out->mesh->positions;
        lattice_directions(&g, u);
        lattice_relax(&g, &s, u, smooth);
        for (uint32_t i = 0; i < g.count; i++)
        {
            smooth[i] = shape_point(&s, u[i], 0.0f);
            u[i] = shape_point(&s, u[i], s.notch);
        }
        lattice_triangles(&g, out->mesh);
        status = grain_finish(out, &s, smooth, def->fit, error);
    }
    else
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for a grain of %d divisions", def->divisions);
    if (status != TY_OK)
        ty_element_term(out);
    ty_free(smooth);
    ty_free(g.index);
    return status;
}
