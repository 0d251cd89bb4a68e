// SPDX-License-Identifier: Apache-2.0
// The aperture's shape: a disc, or blades with straight to round edges, squeezed by an anamorphic lens.
#include "camera.h"
#include <tsuya/shading/sampling.h>

// The edge of one sector goes from corner to corner. Its distance from the middle is that of the chord, or of the
// circle through the corners, or between them. Straight pieces make the sector a fan of triangles, in which sampling by
// area is exact.
static void set_edge(ty_lens* lens, float curvature)
{
    float half = TY_PI / (float)lens->blades, sum = 0.0f;
    for (int i = 0; i <= TY_LENS_SEGMENTS; ++i)
    {
        float angle = half * (2.0f * (float)i / TY_LENS_SEGMENTS - 1.0f), s, c;
        ty_sincos(angle, &s, &c);
        float distance = ty_lerp(ty_cos(half) / c, 1.0f, curvature);
        lens->edge[i] = (ty_vec2){distance * c, distance * s};
        ty_vec2 a = lens->edge[i > 0 ? i - 1 : 0], b = lens->edge[i];
        sum += a.x * b.y - a.y * b.x;
        lens->share[i] = sum;
    }
    for (int i = 0; i <= TY_LENS_SEGMENTS; ++i)
        lens->share[i] /= sum;
}

void ty_lens_init(ty_lens* lens, const ty_camera_def* def)
{
    *lens = (ty_lens){.blades = def->blades, .inverse_squeeze = def->squeeze > 0.0f ? 1.0f / def->squeeze : 1.0f};
    if (lens->blades < 3)
        return;
    set_edge(lens, def->blade_curvature);
    ty_sincos(def->blade_rotation, &lens->rotation[1], &lens->rotation[0]);
}

static ty_vec2 rotate(ty_vec2 p, float cosine, float sine)
{
    return (ty_vec2){cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
}

// u.x chooses sector, piece and distance, u.y the place along the piece.
static ty_vec2 sample_blades(const ty_lens* lens, ty_vec2 u)
{
    float v = u.x * (float)lens->blades;
    int sector = (int)v < lens->blades ? (int)v : lens->blades - 1, piece = 0;
    v -= (float)sector;
    while (piece + 1 < TY_LENS_SEGMENTS && lens->share[piece + 1] <= v)
        ++piece;
    float low = lens->share[piece], high = lens->share[piece + 1];
    float r = ty_safe_sqrt(ty_clamp((v - low) / (high - low), 0.0f, 1.0f));
    ty_vec2 a = lens->edge[piece], b = lens->edge[piece + 1];
    ty_vec2 p = {r * ty_lerp(a.x, b.x, u.y), r * ty_lerp(a.y, b.y, u.y)};
    float s, c; // a corner of sector 0 lies on the x axis
    ty_sincos(TY_PI * (float)(2 * sector + 1) / (float)lens->blades, &s, &c);
    return rotate(rotate(p, c, s), lens->rotation[0], lens->rotation[1]);
}

ty_vec2 ty_lens_sample(const ty_lens* lens, ty_vec2 u)
{
    ty_vec2 p = lens->blades < 3 ? ty_sample_disc(u) : sample_blades(lens, u);
    return (ty_vec2){p.x * lens->inverse_squeeze, p.y};
}
