// SPDX-License-Identifier: Apache-2.0
// Motion within the shutter: maps at even steps, refined until they are linear between.
#include "trace_world.h"
#include <tsuya/base/memory.h>

// Between two maps turned by this angle a linear blend shrinks by 1 - cos(2 degrees), .06 %.
#define MAX_TURN 0.0698f
#define MAX_STEPS 129 // Embree's own limit

// A rotation and a symmetric stretch: m = sign rotation stretch (polar decomposition).
typedef struct polar
{
    ty_quat rotation;
    ty_vec3 stretch[3]; // columns
    float sign;
} polar;

static ty_affine negated(const ty_affine* m)
{
    return (ty_affine){ty_neg(m->x), ty_neg(m->y), ty_neg(m->z), m->t};
}

// N. J. Higham 1986, "Computing the polar decomposition": averaging with the inverse transpose converges to the
// rotation, quadratically near it.
static polar decompose(const ty_affine* m)
{
    polar p = {.sign = ty_affine_determinant(m) < 0.0f ? -1.0f : 1.0f};
    ty_affine q = p.sign < 0.0f ? negated(m) : *m, first = q, inverse;
    q.t = (ty_vec3){0};
    for (int i = 0; i < 24 && ty_affine_invert(&q, &inverse); i++)
    {
        ty_affine transposed = {{inverse.x.x, inverse.y.x, inverse.z.x},
                                {inverse.x.y, inverse.y.y, inverse.z.y},
                                {inverse.x.z, inverse.y.z, inverse.z.z},
                                {0, 0, 0}};
        q.x = ty_lerp3(q.x, transposed.x, 0.5f);
        q.y = ty_lerp3(q.y, transposed.y, 0.5f);
        q.z = ty_lerp3(q.z, transposed.z, 0.5f);
    }
    p.rotation = ty_quat_from_columns(q.x, q.y, q.z);
    ty_quat back = {-p.rotation.x, -p.rotation.y, -p.rotation.z, p.rotation.w};
    p.stretch[0] = ty_quat_rotate(back, first.x);
    p.stretch[1] = ty_quat_rotate(back, first.y);
    p.stretch[2] = ty_quat_rotate(back, first.z);
    return p;
}

static float quat_dot(ty_quat a, ty_quat b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

static float turn_between(ty_quat a, ty_quat b)
{
    return 2.0f * ty_acos(ty_min(fabsf(quat_dot(a, b)), 1.0f));
}

// K. Shoemake 1985, "Animating rotation with quaternion curves"; the shorter way round.
static ty_quat slerp(ty_quat a, ty_quat b, float s)
{
    float cosine = quat_dot(a, b), side = cosine < 0.0f ? -1.0f : 1.0f, angle = ty_acos(ty_min(fabsf(cosine), 1.0f));
    float wa = 1.0f - s, wb = s * side;
    if (angle > 1e-3f)
    {
        float scale = 1.0f / ty_sin(angle);
        wa = ty_sin((1.0f - s) * angle) * scale;
        wb = ty_sin(s * angle) * scale * side;
    }
    return ty_quat_normalize(
        (ty_quat){a.x * wa + b.x * wb, a.y * wa + b.y * wb, a.z * wa + b.z * wb, a.w * wa + b.w * wb});
}

static ty_affine blend(const polar* a, const polar* b, ty_vec3 ta, ty_vec3 tb, float s)
{
    ty_quat rotation = slerp(a->rotation, b->rotation, s);
    ty_affine m = {ty_quat_rotate(rotation, ty_lerp3(a->stretch[0], b->stretch[0], s)),
                   ty_quat_rotate(rotation, ty_lerp3(a->stretch[1], b->stretch[1], s)),
                   ty_quat_rotate(rotation, ty_lerp3(a->stretch[2], b->stretch[2], s)), ty_lerp3(ta, tb, s)};
    return a->sign < 0.0f ? negated(&m) : m;
}

static ty_status check(ty_motion motion, ty_error* error)
{
    TY_ASSERT(motion.step_count >= 1);
    if (motion.step_count > TY_MOTION_MAX_STEPS)
        return ty_error_set(error, TY_BAD_INPUT, "%d motion steps (at most %d)", motion.step_count,
                            TY_MOTION_MAX_STEPS);
    bool mirrored = ty_affine_determinant(&motion.steps[0]) < 0.0f;
    for (int i = 0; i < motion.step_count; i++)
    {
        const ty_affine* m = &motion.steps[i];
        ty_affine inverse;
        bool finite = ty_is_finite3(m->x) && ty_is_finite3(m->y) && ty_is_finite3(m->z) && ty_is_finite3(m->t);
        if (!finite || !ty_affine_invert(m, &inverse))
            return ty_error_set(error, TY_BAD_INPUT, "the map of step %d is singular or not finite", i);
        if ((ty_affine_determinant(m) < 0.0f) != mirrored)
            return ty_error_set(error, TY_BAD_INPUT, "the map turns inside out between steps %d and %d", i - 1, i);
    }
    return TY_OK;
}

ty_status ty_trace_refine_motion(ty_motion motion, ty_affine** out, int* count, ty_error* error)
{
    ty_status status = check(motion, error);
    if (status != TY_OK)
        return status;
    polar parts[TY_MOTION_MAX_STEPS];
    float turn = 0.0f;
    for (int i = 0; i < motion.step_count && motion.step_count > 1; i++)
    {
        parts[i] = decompose(&motion.steps[i]);
        if (i > 0)
            turn = ty_max(turn, turn_between(parts[i - 1].rotation, parts[i].rotation));
    }
    int intervals = motion.step_count - 1, split = 1 + (int)(turn / MAX_TURN);
    if (intervals > 0 && split > (MAX_STEPS - 1) / intervals)
        split = (MAX_STEPS - 1) / intervals;
    *count = intervals * split + 1;
    *out = TY_ALLOC(ty_affine, *count);
    for (int i = 0; i < *count; i++)
    {
        int k = i / split, rest = i % split;
        (*out)[i] = rest == 0 ? motion.steps[k]
                              : blend(&parts[k], &parts[k + 1], motion.steps[k].t, motion.steps[k + 1].t,
                                      (float)rest / (float)split);
    }
    return TY_OK;
}

ty_affine ty_trace_map_at(const ty_affine* steps, int count, float time)
{
    if (count == 1)
        return steps[0];
    float x = ty_clamp(time, 0.0f, 1.0f) * (float)(count - 1);
    int k = (int)x;
    k = k > count - 2 ? count - 2 : k;
    float s = x - (float)k;
    const ty_affine *a = &steps[k], *b = &steps[k + 1];
    return (ty_affine){ty_lerp3(a->x, b->x, s), ty_lerp3(a->y, b->y, s), ty_lerp3(a->z, b->z, s),
                       ty_lerp3(a->t, b->t, s)};
}
