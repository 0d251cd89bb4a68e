// SPDX-License-Identifier: Apache-2.0
// A rice ball's form: an equilateral triangle with round corners, as thick as said, with round edges; it stands on a
// side of the triangle, on y = 0.
#include "container_state.h"

#define ROOT_3 1.7320508f

// Of the triangle that corners are rolled along.
static float inradius(const ty_onigiri_def* def)
{
    return def->side / (2.0f * ROOT_3) - def->corner;
}

// Signed distance to an equilateral triangle about the origin, tip up: to the sides within, to segments without.
static float triangle_distance(float x, float y, float inner)
{
    static const float normals[3][2] = {{0.0f, -1.0f}, {0.5f * ROOT_3, 0.5f}, {-0.5f * ROOT_3, 0.5f}};
    float within = -TY_FLOAT_MAX, square = TY_FLOAT_MAX, half = ROOT_3 * inner;
    for (int i = 0; i < 3; i++)
    {
        float out = normals[i][0] * x + normals[i][1] * y - inner;
        float along = -normals[i][1] * x + normals[i][0] * y, past = ty_max(0.0f, fabsf(along) - half);
        within = ty_max(within, out);
        square = ty_min(square, out * out + past * past);
    }
    return within < 0.0f ? within : sqrtf(square);
}

float onigiri_distance(const ty_onigiri_def* def, ty_vec3 p)
{
    float plane = triangle_distance(p.x, p.y - def->side / (2.0f * ROOT_3), inradius(def)) - def->corner;
    float a = plane + def->edge, b = fabsf(p.z) - 0.5f * def->thickness + def->edge;
    float outside = sqrtf(ty_sqr(ty_max(a, 0.0f)) + ty_sqr(ty_max(b, 0.0f)));
    return ty_min(ty_max(a, b), 0.0f) + outside - def->edge;
}

ty_bounds onigiri_bounds(const ty_onigiri_def* def)
{
    float inner = inradius(def), x = ROOT_3 * inner + def->corner, z = 0.5f * def->thickness;
    return (ty_bounds){{-x, 0.0f, -z}, {x, def->side / (2.0f * ROOT_3) + 2.0f * inner + def->corner, z}};
}

ty_status onigiri_check(const ty_onigiri_def* def, ty_error* error)
{
    float widest = def->side / (2.0f * ROOT_3);
    if (!(def->side > 0.0f) || !(def->thickness > 0.0f))
        return ty_error_set(error, TY_BAD_INPUT, "container.onigiri: side and thickness are above 0");
    if (!(def->corner >= 0.0f && def->corner < widest))
        return ty_error_set(error, TY_BAD_INPUT, "container.onigiri.corner: %.3g mm; with that side it lies in 0..%.3g",
                            (double)def->corner * 1e3, (double)widest * 1e3);
    float most = ty_min(0.5f * def->thickness, widest);
    if (def->edge >= 0.0f && def->edge <= most)
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "container.onigiri.edge: %.3g mm; with that thickness it lies in 0..%.3g",
                        (double)def->edge * 1e3, (double)most * 1e3);
}
