// SPDX-License-Identifier: Apache-2.0
// Turned shapes with a formula: cylinder, torus, disc and dome.
#include "shape_build.h"

static ty_profile profile_make(double radius, int divisions)
{
    return (ty_profile){.spacing = 2.0 * M_PI * radius / divisions, .limit = divisions};
}

void ty_shape_build_cylinder(ty_shape_build* build, const ty_shape_def* def)
{
    double r = (double)def->radius, h = 0.5 * (double)def->height, e = (double)def->rounding;
    ty_profile profile = profile_make(r, def->divisions);
    ty_profile_line(&profile, 0.0, -h, r - e, -h, true);
    if (e > 0.0)
        ty_profile_arc(&profile, r - e, -h + e, e, -0.5 * M_PI, 0.0, 1);
    ty_profile_line(&profile, r, -h + e, r, h - e, false);
    if (e > 0.0)
        ty_profile_arc(&profile, r - e, h - e, e, 0.0, 0.5 * M_PI, 1);
    ty_profile_line(&profile, r - e, h, 0.0, h, true);
    ty_shape_turn(build, &profile, def->divisions, TY_TURNED_PROPORTIONAL);
    ty_profile_term(&profile);
}

void ty_shape_build_torus(ty_shape_build* build, const ty_shape_def* def)
{
    double r = (double)def->radius, tube = (double)def->tube;
    ty_profile profile = profile_make(r, def->divisions);
    ty_profile_arc(&profile, r, 0.0, tube, -M_PI, M_PI, 1);
    // The ends meet in the same bits, so that they weld.
    if (!profile.failed)
        profile.points[profile.count - 1] = profile.points[0];
    ty_shape_turn(build, &profile, def->divisions, TY_TURNED_EVEN);
    ty_profile_term(&profile);
}

void ty_shape_build_disc(ty_shape_build* build, const ty_shape_def* def)
{
    ty_profile profile = profile_make((double)def->radius, def->divisions);
    ty_profile_line(&profile, (double)def->radius, 0.0, 0.0, 0.0, true);
    ty_shape_turn(build, &profile, def->divisions, TY_TURNED_PROPORTIONAL);
    ty_profile_term(&profile);
    float scale = 0.5f / def->radius;
    for (size_t i = 0; i < build->vertex_count; i++)
    {
        ty_shape_vertex* v = &build->vertices[i];
        v->uv = (ty_vec2){ty_clamp(0.5f + scale * v->position.x, 0.0f, 1.0f),
                          ty_clamp(0.5f - scale * v->position.z, 0.0f, 1.0f)};
    }
}

// context: the def; t is the parameter angle of the ellipse.
static ty_profile_point dome_point(const void* context, double t)
{
    const ty_shape_def* def = context;
    double a = (double)def->radius, b = (double)def->height, c = cos(t), s = sin(t);
    double speed = hypot(a * s, b * c);
    return (ty_profile_point){
        .r = a * c, .y = b * s, .nr = b * c / speed, .ny = a * s / speed, .curvature = a * b / (speed * speed * speed)};
}

void ty_shape_build_dome(ty_shape_build* build, const ty_shape_def* def)
{
    ty_profile profile = profile_make((double)def->radius, def->divisions);
    ty_profile_line(&profile, 0.0, 0.0, (double)def->radius, 0.0, true);
    ty_profile_curve(&profile, dome_point, def, 0.0, 0.5 * M_PI);
    ty_shape_turn(build, &profile, def->divisions, TY_TURNED_PROPORTIONAL);
    ty_profile_term(&profile);
}
