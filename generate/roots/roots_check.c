// SPDX-License-Identifier: Apache-2.0
// What numbers of a recipe for roots must be to one another.
#include "roots.h"

static ty_status share_check(const char* name, const float share[2], ty_error* error)
{
    if (share[0] <= share[1])
        return TY_OK;
    return ty_error_set(error, TY_BAD_INPUT, "%s.share: [%g, %g]; the first is at most the second", name,
                        (double)share[0], (double)share[1]);
}

static ty_status ramp_check(const char* name, const ty_param_list* ramp, ty_error* error)
{
    const ty_vec2* p = ramp->items;
    for (int i = 0; i < ramp->count; i++)
    {
        if (!(p[i].x <= 1.0f))
            return ty_error_set(error, TY_BAD_INPUT, "%s[%d]: [%g, %g]; the first number lies in 0..1", name, i,
                                (double)p[i].x, (double)p[i].y);
        if (i > 0 && !(p[i].x > p[i - 1].x))
            return ty_error_set(error, TY_BAD_INPUT, "%s[%d]: [%g, %g]; first numbers rise, this is after %g", name, i,
                                (double)p[i].x, (double)p[i].y, (double)p[i - 1].x);
    }
    return TY_OK;
}

ty_status roots_recipe_check(const ty_roots_recipe* r, ty_error* error)
{
    if (!(r->tip <= r->radius))
        return ty_error_set(error, TY_BAD_INPUT, "tip: %g mm; it is at most the radius, %g mm", (double)r->tip * 1e3,
                            (double)r->radius * 1e3);
    if (r->tubes.divisions % 2 != 0)
        return ty_error_set(error, TY_BAD_INPUT, "tubes.divisions: %d; an even number 4..128", r->tubes.divisions);
    if (!(r->detail <= r->tip))
        return ty_error_set(error, TY_BAD_INPUT, "detail: %g mm; it is at most the tip, %g mm", (double)r->detail * 1e3,
                            (double)r->tip * 1e3);
    ty_status status = ramp_check("radius_by_length", &r->radius_by_length, error);
    if (status == TY_OK)
        status = ramp_check("first.density_by_height", &r->first.density_by_height, error);
    if (status == TY_OK)
        status = ramp_check("second.density_by_height", &r->second.density_by_height, error);
    if (status == TY_OK)
        status = share_check("first", r->first.share, error);
    if (status == TY_OK)
        status = share_check("second", r->second.share, error);
    return status == TY_OK ? share_check("aerial", r->aerial.share, error) : status;
}
