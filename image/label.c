// SPDX-License-Identifier: Apache-2.0
// Letters as strokes: a table of lines and curves, drawn by the distance to the nearest.
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <tsuya/base/math.h>
#include <tsuya/image/label.h>

// From ' ' on. A point is a digit, x from the left, and a letter, y: a = top of capitals, c = top of small letters, g =
// baseline, i = end of descenders. Points in a row are a line; after ~ they are the control points of a quadratic
// B-spline that begins at the first and ends at the last, or is closed when they are the same. One point is a dot.
static const char* const glyphs[] = {
    "",
    "0a0e 0g",
    "0a0b 1a1b",
    "1a0g 3a2g 0c3c 0e3e",
    "~4b4a0a0d4d4g0g0f 2a2g", //  !"#$
    "~1a1b0b0a1a ~4f4g3g3f4f 4a0g",
    "~4d4g0g0d2d2a0a0b1d 1d4g",
    "0a0b",
    "~1a0b0g1h", // %&'(
    "~0a1b1g0h",
    "1a1e 0b2d 2b0d",
    "2b2f 0d4d",
    "1g0h",
    "0d2d",
    "0g",
    "3a0g", // )*+,-./
    "~3a3g0g0a3a",
    "0b1a1g",
    "~0b0a3a3c2d 2d0g3g",
    "~0b0a3a3d1d ~1d3d3g0g0f", // 0123
    "2a0e3e 2a2g",
    "3a0a0c ~0c3c3g0g0f",
    "~3b3a0a0e ~3c3g0g0c3c",
    "0a3a1g", // 4567
    "~3a3d0d0a3a ~3d3g0g0d3d",
    "~0f0g3g3c ~0a0e3e3a0a",
    "0d 0g",
    "1d 1g0h", // 89:;
    "3b0d3f",
    "0c3c 0e3e",
    "0b3d0f",
    "~0b0a3a3c1e 1g",
    "~4g0g0a4a4e2e2c4c", // <=>?@
    "0g2a4g 1e3e",
    "2a0a0g2g 0d2d ~2a4a4d2d ~2d4d4g2g",
    "~4b4a0a0g4g4f", // ABC
    "2a0a0g2g ~2a4a4g2g",
    "3a0a0g3g 0d3d",
    "3a0a0g 0d3d",
    "~4b4a0a0g4g4d 4d2d", // DEFG
    "0a0g 4a4g 0d4d",
    "0a2a 1a1g 0g2g",
    "3a3e ~3e3g0g0e",
    "0a0g 4a0e 1d4g", // HIJK
    "0a0g3g",
    "0g0a2d4a4g",
    "0g0a4g4a",
    "~4a4g0g0a4a",
    "2a0a0g 0d2d ~2a4a4d2d", // LMNOP
    "~4a4g0g0a4a 2e4g",
    "2a0a0g 0d2d ~2a4a4d2d 2d4g",
    "~4b4a0a0d4d4g0g0f", // QRS
    "0a4a 2a2g",
    "0a0d 4a4d ~0d0g4g4d",
    "0a2g4a",
    "0a1g2c3g4a",
    "0a4g 4a0g", // TUVWX
    "0a2d4a 2d2g",
    "0a4a0g4g",
    "1a0a0h1h",
    "0a3g",
    "0a1a1h0h",
    "0c1a2c",
    "0h4h", // YZ[\]^_
    "0a1b",
    "~3c3g0g0c3c 3c3g",
    "0a0g ~3c3g0g0c3c",
    "~3d3c0c0g3g3f", // `abc
    "3a3g ~3c3g0g0c3c",
    "0e3e ~3e3c0c0g3g3f",
    "~2a1a1b 1b1g 0c2c", // def
    "~3c3g0g0c3c 3c3g ~3g3i0i0h",
    "0a0g ~0e0c3c3e 3e3g",
    "0c0g 0a", // ghi
    "1c1g ~1g1i0i 1a",
    "0a0g 3c0e 1d3g",
    "0a0g", // jkl
    "0c0g ~0e0c2c2e 2e2g ~2e2c4c4e 4e4g",
    "0c0g ~0e0c3c3e 3e3g",
    "~3c3g0g0c3c", // mno
    "0c0i ~3c3g0g0c3c",
    "3c3i ~3c3g0g0c3c",
    "0c0g ~0e0c2c",
    "~3d3c0c0e3e3g0g0f", // pqrs
    "1b1e ~1e1g2g 0c2c",
    "0c0e ~0e0g3g3e 3c3g",
    "0c2g4c",
    "0c1g2d3g4c",
    "0c3g 3c0g", // tuvwx
    "0c2g 4c2g1i",
    "0c3c0g3g",
    "~2a1a1d0d ~0d1d1h2h",
    "0a0h",
    "~0a1a1d2d ~2d1d1h0h", // yz{|}
    "~0d1c2e3d",           // ~
};
static const char box[] = "0a3a3g0g0a";

#define UNITS 6.0f     // of a capital's height
#define GAP 1.9f       // between letters, units
#define BLANK 1.6f     // how wide a blank is, units
#define HALF_WIDTH .4f // of a stroke, units
enum
{
    CURVE_STEPS = 8,
    MOST_POINTS = 16,
};

static const char* glyph_of(unsigned char c)
{
    return c < ' ' || c > '~' ? box : glyphs[c - ' '];
}

// Bytes that go on with a character of UTF-8 show nothing.
static bool is_continued(unsigned char c)
{
    return (c & 0xc0u) == 0x80u;
}

static float advance(unsigned char c)
{
    int right = -1;
    for (const char* g = glyph_of(c); *g; g++)
    {
        right = *g >= '0' && *g <= '9' && *g - '0' > right ? *g - '0' : right;
    }
    return (right < 0 ? BLANK : (float)right) + GAP;
}

float ty_label_width(const char* text, float size)
{
    float units = 0.0f;
    for (; *text; text++)
    {
        units += is_continued((unsigned char)*text) ? 0.0f : advance((unsigned char)*text);
    }
    return units > 0.0f ? (units - GAP + 2.0f * HALF_WIDTH) * size / UNITS : 0.0f;
}

void ty_label_fit(const char* text, float size, float width, char* out, size_t capacity)
{
    snprintf(out, capacity, "%s", text);
    for (size_t length = strlen(out); ty_label_width(out, size) > width && length > 0; length--)
    {
        snprintf(out, capacity, "%.*s..", (int)(length - 1), text);
    }
}

typedef struct point
{
    float x, y;
} point;

// Where a glyph is drawn: its origin and scale, and the pixels that it may touch.
typedef struct pen
{
    point origin;
    float unit;
    point from[MOST_POINTS * CURVE_STEPS * 4], to[MOST_POINTS * CURVE_STEPS * 4];
    int count;
} pen;

static void add_line(pen* p, point a, point b)
{
    if (p->count < (int)(sizeof p->from / sizeof p->from[0]))
    {
        p->from[p->count] = (point){p->origin.x + a.x * p->unit, p->origin.y + a.y * p->unit};
        p->to[p->count++] = (point){p->origin.x + b.x * p->unit, p->origin.y + b.y * p->unit};
    }
}

static point middle(point a, point b)
{
    return (point){0.5f * (a.x + b.x), 0.5f * (a.y + b.y)};
}

static void add_arc(pen* p, point a, point control, point b)
{
    point before = a;
    for (int i = 1; i <= CURVE_STEPS; i++)
    {
        float t = (float)i / CURVE_STEPS, s = 1.0f - t;
        point now = {s * s * a.x + 2.0f * s * t * control.x + t * t * b.x,
                     s * s * a.y + 2.0f * s * t * control.y + t * t * b.y};
        add_line(p, before, now);
        before = now;
    }
}

static void add_curve(pen* p, const point* points, int count)
{
    const point *first = &points[0], *last = &points[count - 1];
    if (first->x == last->x && first->y == last->y)
    {
        for (int i = 1; i < count; i++)
        {
            const point* next = i + 1 < count ? &points[i + 1] : &points[1];
            add_arc(p, middle(points[i - 1], points[i]), points[i], middle(points[i], *next));
        }
        return;
    }
    for (int i = 1; i + 1 < count; i++)
    {
        add_arc(p, i == 1 ? points[0] : middle(points[i - 1], points[i]), points[i],
                i + 2 == count ? points[i + 1] : middle(points[i], points[i + 1]));
    }
}

static void add_glyph(pen* p, const char* glyph)
{
    while (*glyph)
    {
        bool curve = *glyph == '~';
        point points[MOST_POINTS];
        int count = 0;
        for (glyph += curve; *glyph && *glyph != ' '; glyph += 2)
        {
            points[count++] = (point){(float)(glyph[0] - '0'), (float)(glyph[1] - 'g')};
        }
        glyph += *glyph == ' ';
        if (curve)
        {
            add_curve(p, points, count);
            continue;
        }
        for (int i = 0; i < count; i++)
        {
            if (i > 0 || count == 1)
            {
                add_line(p, points[i > 0 ? i - 1 : 0], points[i]);
            }
        }
    }
}

static float distance_sqr(point q, point a, point b)
{
    float dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    float t = length > 0.0f ? ty_clamp(((q.x - a.x) * dx + (q.y - a.y) * dy) / length, 0.0f, 1.0f) : 0.0f;
    float x = q.x - a.x - t * dx, y = q.y - a.y - t * dy;
    return x * x + y * y;
}

static void fill(ty_image* image, const pen* p, float width_units, const float* color)
{
    float half = ty_max(HALF_WIDTH * p->unit, 0.5f), reach = half + 1.0f;
    int x0 = (int)floorf(p->origin.x - reach), x1 = (int)ceilf(p->origin.x + width_units * p->unit + reach);
    int y0 = (int)floorf(p->origin.y - UNITS * p->unit - reach), y1 = (int)ceilf(p->origin.y + 2.0f * p->unit + reach);
    for (int y = y0 > 0 ? y0 : 0; y <= y1 && y < image->height; y++)
    {
        for (int x = x0 > 0 ? x0 : 0; x <= x1 && x < image->width; x++)
        {
            float nearest = reach * reach;
            for (int i = 0; i < p->count; i++)
            {
                nearest =
                    ty_min(nearest, distance_sqr((point){(float)x + 0.5f, (float)y + 0.5f}, p->from[i], p->to[i]));
            }
            float cover = ty_clamp(half + 0.5f - sqrtf(nearest), 0.0f, 1.0f);
            float* pixel = &image->pixels[((int64_t)y * image->width + x) * image->channels];
            for (int c = 0; c < image->channels && cover > 0.0f; c++)
            {
                pixel[c] += cover * (color[c] - pixel[c]);
            }
        }
    }
}

void ty_label_draw(ty_image* image, float x, float y, const char* text, float size, const float* color)
{
    pen p = {.origin = {x + HALF_WIDTH * size / UNITS, y}, .unit = size / UNITS};
    for (; *text; text++)
    {
        unsigned char c = (unsigned char)*text;
        if (is_continued(c))
        {
            continue;
        }
        p.count = 0;
        add_glyph(&p, glyph_of(c));
        fill(image, &p, advance(c) - GAP, color);
        p.origin.x += advance(c) * p.unit;
    }
}
