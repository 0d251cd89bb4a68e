// SPDX-License-Identifier: Apache-2.0
// Anisotropic lookups: probes along the longer axis of the footprint's ellipse, each trilinear. The library's own
// lookups use functions of the C library whose bits differ by CPU; only its tiles are used.
#include "mip_lookup.h"
#include "texel_wrap.h"
#include <tsuya/image/half.h>

enum
{
    MAX_PROBES = 16,
};

// The tile that a lookup is at.
typedef struct reader
{
    ty_mip_cache* cache;
    const ty_oiio_tile_file* file;
    const ty_wrap* wrap;    // along u and v
    const uint16_t* texels; // NULL = none yet, or it cannot be read
    int level, column, row; // of the tile; level -1 = none yet
} reader;

static void note_failure(ty_mip_cache* cache)
{
    atomic_fetch_add_explicit(&cache->failures, 1, memory_order_relaxed);
    if (!atomic_flag_test_and_set(&cache->has_reason))
        ty_oiio_tiles_get_error(cache->tiles, cache->reason, sizeof cache->reason);
}

static void turn_to(reader* r, int level, int column, int row)
{
    if (r->level == level && r->column == column && r->row == row)
        return;
    r->texels = ty_oiio_tile_take(r->cache->tiles, r->file, level, column, row);
    r->level = level;
    r->column = column;
    r->row = row;
    if (!r->texels)
        note_failure(r->cache);
}

// The tile must be the right one.
static void add_texel(const reader* r, int x, int y, float weight, float sum[4])
{
    if (!r->texels)
        return;
    int offset = ((y & (TY_TILE_SIZE - 1)) << TY_TILE_BITS) + (x & (TY_TILE_SIZE - 1));
    const uint16_t* texel = r->texels + offset * r->file->channels;
    for (int c = 0; c < r->file->channels; c++)
        sum[c] += weight * ty_half_to_float(texel[c]);
}

static void add_bilinear(reader* r, int level, ty_vec2 uv, float weight, float sum[4])
{
    int x[2], y[2], width = r->file->width >> level, height = r->file->height >> level;
    float s = ty_wrap_taps(uv.x, width > 1 ? width : 1, r->wrap[0], x);
    float t = ty_wrap_taps(1.0f - uv.y, height > 1 ? height : 1, r->wrap[1], y);
    const float wx[2] = {1.0f - s, s}, wy[2] = {1.0f - t, t};
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++)
        {
            turn_to(r, level, x[i] >> TY_TILE_BITS, y[j] >> TY_TILE_BITS);
            add_texel(r, x[i], y[j], weight * wx[i] * wy[j], sum);
        }
}

// Level in which a texel is as wide as the footprint (texels of level 0), between whole levels linear in the width.
static float level_of(float width)
{
    int exponent = 0;
    float mantissa = frexpf(width, &exponent); // 0.5..1
    return (float)(exponent - 1) + 2.0f * mantissa - 1.0f;
}

static void add_trilinear(reader* r, float level, ty_vec2 uv, float weight, float sum[4])
{
    int last = r->file->level_count - 1;
    if (!(level > 0.0f) || level >= (float)last)
    {
        add_bilinear(r, level > 0.0f ? last : 0, uv, weight, sum);
        return;
    }
    int base = (int)level;
    float blend = level - (float)base;
    add_bilinear(r, base, uv, weight * (1.0f - blend), sum);
    if (blend > 0.0f)
        add_bilinear(r, base + 1, uv, weight * blend, sum);
}

// The ellipse that du and dv (in texels) span: the unit direction of its longer axis, and both diameters.
typedef struct ellipse
{
    ty_vec2 direction;
    float major, minor;
} ellipse;

static ellipse ellipse_of(ty_vec2 du, ty_vec2 dv)
{
    // Eigenvalues and -vectors of the symmetric matrix M M^T, M having the columns du and dv.
    float a = du.x * du.x + dv.x * dv.x, b = du.x * du.y + dv.x * dv.y, c = du.y * du.y + dv.y * dv.y;
    float half_difference = 0.5f * (a - c), mean = 0.5f * (a + c);
    float root = sqrtf(half_difference * half_difference + b * b);
    ty_vec2 v = half_difference >= 0.0f ? (ty_vec2){half_difference + root, b} : (ty_vec2){b, root - half_difference};
    float length = sqrtf(v.x * v.x + v.y * v.y);
    ellipse e = {{1.0f, 0.0f}, sqrtf(mean + root), ty_safe_sqrt(mean - root)};
    if (length > 0.0f)
        e.direction = (ty_vec2){v.x / length, v.y / length};
    return e;
}

// Beyond that the whole image is one texel anyway; what is no number is no footprint.
static float bounded(float x, float limit)
{
    return x == x ? ty_clamp(x, -limit, limit) : 0.0f;
}

static void add_filtered(reader* r, ty_vec2 uv, ty_vec2 du, ty_vec2 dv, float weight, float sum[4])
{
    float w = (float)r->file->width, h = (float)r->file->height, limit = 4.0f * ty_max(w, h);
    ellipse e = ellipse_of((ty_vec2){bounded(du.x * w, limit), bounded(du.y * h, limit)},
                           (ty_vec2){bounded(dv.x * w, limit), bounded(dv.y * h, limit)});
    if (!(e.major > 1.0f))
    {
        add_bilinear(r, 0, uv, weight, sum);
        return;
    }
    // Probes need not lie closer than a texel of level 0.
    float narrow = ty_max(e.minor, 1.0f);
    int count = (int)ceilf(e.major / narrow - 0.01f);
    if (count > MAX_PROBES)
    {
        count = MAX_PROBES;
        narrow = e.major / (float)MAX_PROBES;
    }
    float level = level_of(narrow), step = e.major / (float)count;
    ty_vec2 along = {e.direction.x * step / w, e.direction.y * step / h};
    for (int i = 0; i < count; i++)
    {
        float position = (float)i - 0.5f * (float)(count - 1);
        add_trilinear(r, level, (ty_vec2){uv.x + along.x * position, uv.y + along.y * position}, weight / (float)count,
                      sum);
    }
}

void ty_mip_image_add(ty_mip_cache* cache, const ty_mip_image* image, const ty_wrap wrap[2], ty_vec2 uv, ty_vec2 du,
                      ty_vec2 dv, float weight, float sum[4])
{
    reader r = {.cache = cache, .file = &image->file, .wrap = wrap, .level = -1};
    add_filtered(&r, uv, du, dv, weight, sum);
}
