// SPDX-License-Identifier: Apache-2.0
// Planes and axes in time: X = A + R(theta) (P - A), a circle, or a closed curve through keys.
#include "loop_motion.h"
#include <string.h>

enum
{
    MOVE = 0, // where the values of a key stand
    ROTATE = 3,
    SCALE = 7,
    AXIS_MOVE = 9,
    AXIS_ROTATE = 12,
    VALUES = 16,
    LOOKS = 33 // a side of the lattice on which a frame is looked for in the volume
};

// --- the angle ---

void ty_loop_turn(int64_t i, int64_t n, float easing, double* sine, double* cosine)
{
    i = (i % n + n) % n;
    double sign = 2 * i > n ? -1.0 : 1.0;
    if (2 * i > n)
        i = n - i;
    bool obtuse = 4 * i > n;
    int64_t k = obtuse ? n - 2 * i : 2 * i; // of 2 n: at most a quarter
    *sine = 0.0;
    *cosine = obtuse ? -1.0 : 1.0;
    if (k == 0)
        return;
    *sine = sign;
    *cosine = 0.0;
    if (2 * k == n)
        return;
    float t = (float)((double)k / (double)n); // of half a turn
    float angle = TY_PI * t - 0.5f * easing * ty_sin(2.0f * TY_PI * t), s, c;
    ty_sincos(angle, &s, &c);
    *sine = sign * (double)s;
    *cosine = obtuse ? -(double)c : (double)c;
}

// --- keys ---

static void key_values(const ty_loop_key* key, double out[VALUES])
{
    const ty_quat q = ty_quat_euler(key->rotate), a = ty_quat_euler(key->axis_rotate);
    const float values[VALUES] = {
        key->move.x,      key->move.y,      key->move.z,      q.x, q.y, q.z, q.w, key->scale[0], key->scale[1],
        key->axis_move.x, key->axis_move.y, key->axis_move.z, a.x, a.y, a.z, a.w};
    for (int k = 0; k < VALUES; k++)
        out[k] = (double)values[k];
}

// Of q and -q, which are one rotation, the one nearer to the other key's.
static void align(const double* with, double* q)
{
    double dot = 0.0;
    for (int k = 0; k < 4; k++)
        dot += with[k] * q[k];
    for (int k = 0; k < 4 && dot < 0.0; k++)
        q[k] = -q[k];
}

// Key k of the closed curve, k of any size; its time goes on beyond 1.
static double key_at(const ty_param_list* keys, int k, double out[VALUES])
{
    int n = keys->count, turn = (k + 2 * n) / n - 2;
    const ty_loop_key* key = (const ty_loop_key*)keys->items + (k - turn * n);
    key_values(key, out);
    return (double)key->at + turn;
}

// Cubics with the slopes of the chords over two neighbours (Catmull & Rom 1974), closed.
static void keys_blend(const ty_param_list* keys, double t, double out[VALUES])
{
    double p[4][VALUES], at[4];
    int k = keys->count - 1;
    while (k >= 0 && (double)((const ty_loop_key*)keys->items)[k].at > t)
        k--;
    for (int i = 0; i < 4; i++)
        at[i] = key_at(keys, k - 1 + i, p[i]);
    for (int i = 1; i < 4; i++)
    {
        align(p[i - 1] + ROTATE, p[i] + ROTATE);
        align(p[i - 1] + AXIS_ROTATE, p[i] + AXIS_ROTATE);
    }
    double length = at[2] - at[1], x = (t - at[1]) / length, y = 1.0 - x;
    for (int i = 0; i < VALUES; i++)
    {
        double m1 = (p[2][i] - p[0][i]) / (at[2] - at[0]) * length, m2 = (p[3][i] - p[1][i]) / (at[3] - at[1]) * length;
        out[i] =
            (1.0 + 2.0 * x) * y * y * p[1][i] + x * y * y * m1 + x * x * (3.0 - 2.0 * x) * p[2][i] - x * x * y * m2;
    }
}

// --- places ---

typedef struct frame
{
    double center[3], across[3], down[3]; // of the rectangle, voxels from the volume's middle, y up; of its sides
    double point[3], direction[3];
} frame;

static void rotate(const double q[4], const double v[3], double out[3])
{
    double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], t[3], c[3];
    for (int k = 0; k < 3; k++)
        t[k] = 2.0 * (q[(k + 1) % 3] * v[(k + 2) % 3] - q[(k + 2) % 3] * v[(k + 1) % 3]) / n;
    for (int k = 0; k < 3; k++)
        c[k] = q[(k + 1) % 3] * t[(k + 2) % 3] - q[(k + 2) % 3] * t[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        out[k] = v[k] + q[3] * t[k] + c[k];
}

// Right angles of the recipe are exact.
static double snapped(double x)
{
    double whole = x < -0.5 ? -1.0 : x > 0.5 ? 1.0 : 0.0;
    return fabs(x - whole) < 1e-6 ? whole : x;
}

static frame frame_at(const ty_loop_recipe* recipe, double half, double t)
{
    double keyed[VALUES] = {[ROTATE + 3] = 1.0, [SCALE] = 1.0, [SCALE + 1] = 1.0, [AXIS_ROTATE + 3] = 1.0};
    if (recipe->motion.keys.count > 0)
        keys_blend(&recipe->motion.keys, t, keyed);
    const ty_loop_plane* plane = &recipe->plane;
    const ty_loop_axis* axis = &recipe->axis;
    const ty_quat lie = ty_quat_euler(plane->rotate);
    const double q[4] = {(double)lie.x, (double)lie.y, (double)lie.z, (double)lie.w};
    const double unit[2][3] = {{1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};
    const float center[3] = {plane->center.x, plane->center.y, plane->center.z};
    const float point[3] = {axis->point.x, axis->point.y, axis->point.z};
    const double direction[3] = {(double)axis->direction.x, (double)axis->direction.y, (double)axis->direction.z};
    frame f;
    double sides[2][3];
    for (int i = 0; i < 2; i++)
    {
        double side[3], scale = keyed[SCALE + i] > 1e-3 ? keyed[SCALE + i] : 1e-3;
        rotate(q, unit[i], side);
        rotate(keyed + ROTATE, side, sides[i]);
        for (int k = 0; k < 3; k++)
            sides[i][k] = snapped(sides[i][k]) * (double)plane->size[i] * scale * half;
    }
    memcpy(f.across, sides[0], sizeof f.across);
    memcpy(f.down, sides[1], sizeof f.down);
    for (int k = 0; k < 3; k++)
    {
        f.center[k] = ((double)center[k] + keyed[MOVE + k]) * half;
        f.point[k] = ((double)point[k] + keyed[AXIS_MOVE + k]) * half;
    }
    rotate(keyed + AXIS_ROTATE, direction, f.direction);
    double length =
        sqrt(f.direction[0] * f.direction[0] + f.direction[1] * f.direction[1] + f.direction[2] * f.direction[2]);
    for (int k = 0; k < 3; k++)
        f.direction[k] = length > 0.0 ? f.direction[k] / length : 0.0;
    return f;
}

// Rodrigues' turn of v about the unit vector a.
static void turn(const double a[3], double s, double c, double v[3])
{
    double along = (a[0] * v[0] + a[1] * v[1] + a[2] * v[2]) * (1.0 - c), cross[3];
    for (int k = 0; k < 3; k++)
        cross[k] = a[(k + 1) % 3] * v[(k + 2) % 3] - a[(k + 2) % 3] * v[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        v[k] = v[k] * c + cross[k] * s + a[k] * along;
}

static frame frame_moved(const ty_loop_recipe* recipe, const int size[3], int64_t i, int64_t n)
{
    const ty_loop_motion* motion = &recipe->motion;
    double half = 0.5 * size[0], s, c;
    frame f = frame_at(recipe, half, (double)((i % n + n) % n) / (double)n);
    ty_loop_turn(i % n * motion->turns, n, motion->easing, &s, &c);
    if (motion->kind == TY_LOOP_TURN)
    {
        for (int k = 0; k < 3; k++)
            f.center[k] -= f.point[k];
        turn(f.direction, s, c, f.center);
        turn(f.direction, s, c, f.across);
        turn(f.direction, s, c, f.down);
        for (int k = 0; k < 3; k++)
            f.center[k] += f.point[k];
    }
    else if (motion->kind == TY_LOOP_ORBIT)
    {
        f.center[0] += (double)motion->radius * half * c;
        f.center[2] += (double)motion->radius * half * s;
    }
    return f;
}

ty_loop_grid ty_loop_motion_grid(const ty_loop_recipe* recipe, const int size[3], int64_t i, int64_t n)
{
    const frame f = frame_moved(recipe, size, i, n);
    const double w = recipe->size[0], h = recipe->size[1];
    float origin[3], across[3], down[3];
    for (int k = 0; k < 3; k++)
    {
        double sign = k == 1 ? -1.0 : 1.0; // indices go down where y goes up
        double a = sign * f.across[k] / w, b = sign * f.down[k] / h;
        double middle = 0.5 * (size[k] - 1) + sign * f.center[k];
        origin[k] = (float)(middle - 0.5 * (w - 1.0) * a - 0.5 * (h - 1.0) * b);
        across[k] = (float)a;
        down[k] = (float)b;
    }
    return (ty_loop_grid){
        {origin[0], origin[1], origin[2]}, {across[0], across[1], across[2]}, {down[0], down[1], down[2]}};
}

double ty_loop_motion_step(const ty_loop_recipe* recipe, const int size[3], int64_t i, int64_t n)
{
    const frame a = frame_moved(recipe, size, i, n), b = frame_moved(recipe, size, i + 1, n);
    double most = 0.0;
    for (int corner = 0; corner < 4; corner++)
    {
        double sum = 0.0, x = corner & 1 ? 0.5 : -0.5, y = corner & 2 ? 0.5 : -0.5;
        for (int k = 0; k < 3; k++)
        {
            double d = b.center[k] - a.center[k] + x * (b.across[k] - a.across[k]) + y * (b.down[k] - a.down[k]);
            sum += d * d;
        }
        most = sum > most ? sum : most;
    }
    return sqrt(most);
}

// --- mistakes ---

static ty_status keys_check(const ty_param_list* keys, ty_error* error)
{
    const ty_loop_key* all = keys->items;
    for (int i = 1; i < keys->count; i++)
        if (!(all[i].at > all[i - 1].at))
            return ty_error_set(error, TY_BAD_INPUT,
                                "motion.keys[%d].at: %g; above that of the key before, %g, and "
                                "below 1",
                                i, (double)all[i].at, (double)all[i - 1].at);
    return TY_OK;
}

static ty_status orbit_check(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_error* error)
{
    if (!volume->wrap[0] || !volume->wrap[1])
        return ty_error_set(error, TY_BAD_INPUT,
                            "motion.kind: an orbit needs a volume that wraps in x and y; a reaction does, others say "
                            "so with wraps: true, and none is twisted or turned");
    const ty_vec3 r = recipe->plane.rotate;
    if (r.x != 0.0f || r.y != 0.0f || r.z != 0.0f)
        return ty_error_set(error, TY_BAD_INPUT, "plane.rotate: a turned rectangle does not tile; 0, 0, 0 in an orbit");
    return TY_OK;
}

double ty_loop_motion_outside(const ty_loop_recipe* recipe, const ty_loop_volume* volume, int i)
{
    const ty_loop_grid grid = ty_loop_motion_grid(recipe, volume->size, i, recipe->frames);
    int outside = 0;
    for (int y = 0; y < LOOKS; y++)
        for (int x = 0; x < LOOKS; x++)
        {
            ty_vec3 p = ty_mad(ty_mad(grid.origin, grid.down, (float)y * (float)(recipe->size[1] - 1) / (LOOKS - 1)),
                               grid.across, (float)x * (float)(recipe->size[0] - 1) / (LOOKS - 1));
            const float at[3] = {p.x, p.y, p.z};
            bool inside = true;
            for (int k = 0; k < 3; k++)
                inside &= volume->wrap[k] || (at[k] >= -0.5f && at[k] <= (float)volume->size[k] - 0.5f);
            outside += !inside;
        }
    return (double)outside / (LOOKS * LOOKS);
}

ty_status ty_loop_motion_check(const ty_loop_recipe* recipe, const ty_loop_volume* volume, ty_error* error)
{
    const ty_vec3 a = recipe->axis.direction;
    if (recipe->motion.kind == TY_LOOP_TURN && !(ty_max(fabsf(a.x), ty_max(fabsf(a.y), fabsf(a.z))) > 1e-20f))
        return ty_error_set(error, TY_BAD_INPUT, "axis.direction: [%g, %g, %g]; any length but zero", (double)a.x,
                            (double)a.y, (double)a.z);
    ty_status status = keys_check(&recipe->motion.keys, error);
    if (status == TY_OK && recipe->motion.kind == TY_LOOP_ORBIT)
        status = orbit_check(recipe, volume, error);
    double half = 0.5 * volume->size[0];
    for (int i = 0; i < recipe->frames && status == TY_OK; i++)
        if (ty_loop_motion_outside(recipe, volume, i) == 1.0)
            status = ty_error_set(error, TY_BAD_INPUT,
                                  "plane: at frame %d it lies outside the volume, which reaches to x %g, y %g, z %g "
                                  "both ways",
                                  i + 1, 1.0, 0.5 * volume->size[1] / half, 0.5 * volume->size[2] / half);
    return status;
}
