// SPDX-License-Identifier: Apache-2.0
// What the solid of any element weighs and how far it reaches.
#include "element_kinds.h"
#include <string.h>

float ty_element_bell(ty_rng* rng)
{
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        sum += ty_rng_float(rng);
    return (sum - 2.0f) * 1.73205081f;
}

void ty_element_term(ty_element* element)
{
    ty_mesh_destroy(element->mesh);
    memset(element, 0, sizeof *element);
}

// Volume, centre of mass and inertia per unit mass of the solid, by signed tetrahedra from the origin (Tonon 2004).
static void mass_properties(const ty_mesh* mesh, double* volume, double center[3], double inertia[6])
{
    double v6 = 0.0, first[3] = {0}, second[3][3] = {{0}};
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        double p[3][3], sum[3];
        for (int e = 0; e < 3; e++)
        {
            ty_vec3 q = mesh->positions[mesh->triangles[t][e]];
            p[e][0] = (double)q.x, p[e][1] = (double)q.y, p[e][2] = (double)q.z;
        }
        double d = p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
                   p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
                   p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
        v6 += d;
        for (int i = 0; i < 3; i++)
        {
            sum[i] = p[0][i] + p[1][i] + p[2][i];
            first[i] += d * sum[i] / 4.0;
        }
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                second[i][j] +=
                    d * (sum[i] * sum[j] + p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j]) / 20.0;
    }
    *volume = v6 / 6.0;
    double m[3][3];
    for (int i = 0; i < 3; i++)
        center[i] = first[i] / v6;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] = second[i][j] / v6 - center[i] * center[j];
    inertia[0] = m[1][1] + m[2][2], inertia[1] = m[2][2] + m[0][0], inertia[2] = m[0][0] + m[1][1];
    inertia[3] = -m[0][1], inertia[4] = -m[0][2], inertia[5] = -m[1][2];
}

static void symmetric_inverse(const double s[6], float out[6])
{
    double xx = s[1] * s[2] - s[5] * s[5], xy = s[4] * s[5] - s[3] * s[2], xz = s[3] * s[5] - s[4] * s[1];
    double d = s[0] * xx + s[3] * xy + s[4] * xz;
    out[0] = (float)(xx / d), out[3] = (float)(xy / d), out[4] = (float)(xz / d);
    out[1] = (float)((s[0] * s[2] - s[4] * s[4]) / d);
    out[2] = (float)((s[0] * s[1] - s[3] * s[3]) / d);
    out[5] = (float)((s[3] * s[4] - s[0] * s[5]) / d);
}

ty_vec3 ty_element_weigh(ty_element* element)
{
    ty_mesh* mesh = element->mesh;
    double volume, center[3], inertia[6];
    mass_properties(mesh, &volume, center, inertia);
    ty_vec3 shift = {(float)center[0], (float)center[1], (float)center[2]};
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i] = ty_sub(mesh->positions[i], shift);
    element->volume = (float)volume;
    symmetric_inverse(inertia, element->inverse_inertia);
    return shift;
}

void ty_element_enclose(ty_element* element)
{
    const ty_mesh* mesh = element->mesh;
    element->radius = 0.0f;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        element->radius = ty_max(element->radius, ty_length(mesh->positions[i]));
    for (int i = 0; i < element->ball_count; i++)
        element->radius = ty_max(element->radius, ty_length(element->balls[i].center) + element->balls[i].radius);
}
