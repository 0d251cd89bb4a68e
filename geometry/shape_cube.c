// SPDX-License-Identifier: Apache-2.0
// Shapes on the lattice of a cube: the ball (an equal-angle cube sphere, without poles) and the box with round edges.
// Both are the sum of a box and a ball: one lattice whose middle lines are doubled and drawn apart by the box.
#include "shape_build.h"

typedef struct cube_lattice
{
    int steps;      // from the middle of a face of the ball to its edge; 0 for a box with sharp edges
    double* slopes; // [steps + 1] tangent of the direction, 0..1
    double offset[3];
    double radius;
    bool box; // uv of a box: each face 0..1; else of a sphere
} cube_lattice;

// Index 0..2 steps + 1 along an axis: the side it is on and its slope.
static double lattice_slope(const cube_lattice* lattice, int i, double* sign)
{
    int n = lattice->steps;
    *sign = i <= n ? -1.0 : 1.0;
    return i <= n ? -lattice->slopes[n - i] : lattice->slopes[i - n - 1];
}

// Where a direction has a zero component the ball adds nothing along that axis: such a vertex lies on the border of a
// flat or cylindrical part and gets that part's curvature.
static void box_curvature(ty_shape_vertex* vertex, const double d[3], double radius)
{
    ty_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int zeros = (d[0] == 0.0) + (d[1] == 0.0) + (d[2] == 0.0);
    int axis = d[0] == 0.0 ? 0 : d[1] == 0.0 ? 1 : 2;
    ty_frame frame = ty_frame_from_normal(vertex->normal);
    double k = zeros < 2 ? 1.0 / radius : 0.0;
    if (zeros == 1)
        ty_shape_set_curvature(vertex, k, 0.0, ty_cross(vertex->normal, axes[axis]), axes[axis]);
    else
        ty_shape_set_curvature(vertex, k, k, frame.t, frame.b);
}

// u runs from -z by -x, +z and +x back to -z, v from the bottom up; a pole takes the middle of its octant.
static ty_vec2 sphere_uv(const double d[3], const double sign[3])
{
    bool pole = d[0] == 0.0 && d[2] == 0.0;
    // 0 on the z axis and a quarter on the x axis, laid into the octant that the signs name.
    double turn = pole ? 0.125 : atan2(fabs(d[0]), fabs(d[2])) / (2.0 * M_PI);
    double u = sign[2] < 0.0 ? turn : 0.5 - turn;
    double v = acos(fmin(fmax(-d[1], -1.0), 1.0)) / M_PI;
    return (ty_vec2){(float)(sign[0] > 0.0 ? 1.0 - u : u), (float)v};
}

static uint32_t add_lattice_vertex(ty_shape_build* build, const cube_lattice* lattice, int axis, double side, int i,
                                   int j)
{
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    double d[3], sign[3], position[3];
    d[axis] = sign[axis] = side;
    d[a] = lattice_slope(lattice, i, &sign[a]);
    d[b] = lattice_slope(lattice, j, &sign[b]);
    // The order of the sum is the same on both faces that share an edge, and so are the bits.
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++)
    {
        d[k] /= length;
        position[k] = sign[k] * lattice->offset[k] + lattice->radius * d[k];
    }
    ty_shape_vertex vertex = {.position = {(float)position[0], (float)position[1], (float)position[2]},
                              .normal = {(float)d[0], (float)d[1], (float)d[2]}};
    if (lattice->box)
    {
        box_curvature(&vertex, d, lattice->radius);
        double ra = lattice->offset[a] + lattice->radius, rb = lattice->offset[b] + lattice->radius;
        double u = 0.5 + 0.5 * side * position[a] / ra, v = 0.5 + 0.5 * position[b] / rb;
        vertex.uv = (ty_vec2){(float)u, (float)v};
    }
    else
    {
        ty_frame frame = ty_frame_from_normal(vertex.normal);
        ty_shape_set_curvature(&vertex, 1.0 / lattice->radius, 1.0 / lattice->radius, frame.t, frame.b);
        vertex.uv = sphere_uv(d, sign);
    }
    return ty_shape_add_vertex(build, &vertex);
}

static void add_face(ty_shape_build* build, const cube_lattice* lattice, int axis, double side)
{
    int a = (axis + 1) % 3, b = (axis + 2) % 3, n = lattice->steps, row = 2 * n + 2;
    uint32_t first = 0;
    for (int j = 0; j < row; j++)
        for (int i = 0; i < row; i++)
        {
            uint32_t index = add_lattice_vertex(build, lattice, axis, side, i, j);
            first = i == 0 && j == 0 ? index : first;
        }
    for (int j = 0; j + 1 < row; j++)
        for (int i = 0; i + 1 < row; i++)
        {
            // The doubled middle lines coincide where the box is flat.
            if ((i == n && lattice->offset[a] == 0.0) || (j == n && lattice->offset[b] == 0.0))
                continue;
            uint32_t p = first + (uint32_t)(j * row + i), q = p + 1, r = q + (uint32_t)row, s = p + (uint32_t)row;
            if (side > 0.0)
                ty_shape_add_quad(build, p, q, r, s);
            else
                ty_shape_add_quad(build, p, s, r, q);
        }
}

static void build_lattice(ty_shape_build* build, cube_lattice* lattice)
{
    int n = lattice->steps;
    lattice->slopes = TY_ALLOC(double, n + 1);
    for (int i = 1; i < n; i++)
        lattice->slopes[i] = tan(0.25 * M_PI * i / n);
    if (n > 0)
        lattice->slopes[n] = 1.0; // exactly, so that edges and corners agree between faces
    for (int axis = 0; axis < 3; axis++)
    {
        add_face(build, lattice, axis, -1.0);
        add_face(build, lattice, axis, 1.0);
    }
    ty_free(lattice->slopes);
}

void ty_shape_build_ball(ty_shape_build* build, int divisions)
{
    cube_lattice lattice = {.steps = (divisions + 7) / 8, .radius = 1.0};
    build_lattice(build, &lattice);
}

void ty_shape_build_box(ty_shape_build* build, const ty_shape_def* def)
{
    double radius = (double)def->rounding;
    cube_lattice lattice = {.steps = radius > 0.0 ? (def->divisions + 7) / 8 : 0, .radius = radius, .box = true};
    lattice.offset[0] = (double)def->size.x - radius;
    lattice.offset[1] = (double)def->size.y - radius;
    lattice.offset[2] = (double)def->size.z - radius;
    build_lattice(build, &lattice);
}
