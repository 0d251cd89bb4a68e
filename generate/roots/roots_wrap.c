// SPDX-License-Identifier: Apache-2.0
// Shrink-wrap: a curve is lifted far off the host, then drawn tight while the offset it must keep goes to nothing. It
// goes round what lies between its ends instead of through it.
#include "roots_growth.h"
#include <string.h>
#include <tsuya/base/noise.h>

enum
{
    COARSE = 24,  // points while it is drawn tight
    TIGHTEN = 36, // rounds of that
    SMOOTH = 10,  // rounds at full resolution
};

#define MOST_WAY 2.6f  // length against the chord
#define LOW_LIFT 0.1f  // of it, where other parts of the host are near
#define LIFT 0.6f      // of the chord
#define STIFF 4.0f     // points over which it bends while it is drawn tight
#define STIFF_WAY 0.1f // the same at full resolution, of all points

// Points at equal ways along the curve.
static void resample(const ty_vec3* from, int count, ty_vec3* to, int wanted)
{
    float way[WRAP_MOST];
    way[0] = 0.0f;
    for (int i = 1; i < count; i++)
        way[i] = way[i - 1] + ty_length(ty_sub(from[i], from[i - 1]));
    for (int i = 0, j = 0; i < wanted; i++)
    {
        float at = way[count - 1] * (float)i / (float)(wanted - 1);
        while (j + 2 < count && way[j + 1] < at)
            j++;
        float piece = way[j + 1] - way[j];
        to[i] = ty_lerp3(from[j], from[j + 1], piece > 0.0f ? ty_clamp((at - way[j]) / piece, 0.0f, 1.0f) : 0.0f);
    }
    to[0] = from[0];
    to[wanted - 1] = from[count - 1];
}

static void evened(ty_vec3* p, int count)
{
    ty_vec3 even[WRAP_MOST];
    resample(p, count, even, count);
    memcpy(p, even, (size_t)count * sizeof(ty_vec3));
}

static float length_of(const ty_vec3* p, int count)
{
    float sum = 0.0f;
    for (int i = 1; i < count; i++)
        sum += ty_length(ty_sub(p[i], p[i - 1]));
    return sum;
}

// The height at share t of the way: that of both roots at the ends, its own in between.
static float height_at(const wrap_def* def, float t, float length)
{
    float own = (def->flat - def->sink) * def->r, a = growth_height(&def->a), b = growth_height(&def->b);
    float from_a = ty_smoothstep(ty_clamp(t * length / (2.0f * def->a.r), 0.0f, 1.0f));
    float from_b = ty_smoothstep(ty_clamp((1.0f - t) * length / (2.0f * def->b.r), 0.0f, 1.0f));
    return ty_lerp(b, ty_lerp(a, own, from_a), from_b);
}

// Points to their heights; those that are higher stay where it bridges.
static void project(const growth* g, const wrap_def* def, wrap* w, float lift, bool bridges)
{
    float length = length_of(w->p, w->count);
    for (int i = 1; i + 1 < w->count; i++)
    {
        float t = (float)i / (float)(w->count - 1), end = ty_min(1.0f, 4.0f * ty_min(t, 1.0f - t));
        float height = height_at(def, t, length) + lift * end;
        ty_vec3 n;
        if (bridges && roots_host_value(g->host, w->p[i], &n) > height)
        {
            w->n[i] = ty_normalize(n);
            continue;
        }
        w->p[i] = roots_host_project(g->host, growth_out(g->host, w->p[i], height), height, &w->n[i]);
    }
}

// A cubic along both roots at its ends, lifted in its middle.
static void begin(const wrap_def* def, wrap* w, float lift, float chord)
{
    w->count = COARSE;
    for (int i = 0; i < COARSE; i++)
    {
        float t = (float)i / (COARSE - 1), t2 = t * t, t3 = t2 * t;
        ty_vec3 n = ty_lerp3(def->a.n, def->b.n, t);
        n = ty_length(n) > 1e-3f ? ty_normalize(n) : def->a.n;
        ty_vec3 p = ty_lerp3(def->a.p, def->b.p, 3.0f * t2 - 2.0f * t3);
        p = ty_mad(p, def->ta, chord * (t3 - 2.0f * t2 + t));
        p = ty_mad(p, def->tb, chord * (t3 - t2));
        w->p[i] = ty_mad(p, n, lift * 4.0f * t * (1.0f - t));
    }
}

// Its first and last steps are along the roots that it joins.
static void clamp_ends(const wrap_def* def, wrap* w)
{
    int last = w->count - 1;
    w->p[1] = ty_mad(def->a.p, def->ta, ty_length(ty_sub(w->p[1], def->a.p)));
    w->p[last - 1] = ty_mad(def->b.p, def->tb, -ty_length(ty_sub(w->p[last - 1], def->b.p)));
}

// To the sides, by chance that is a function of the way.
static void swing(const wrap_def* def, wrap* w, float length)
{
    ty_vec3 was[WRAP_MOST];
    memcpy(was, w->p, (size_t)w->count * sizeof(ty_vec3));
    for (int i = 1; i + 1 < w->count; i++)
    {
        float t = (float)i / (float)(w->count - 1), wide = 16.0f * ty_sqr(t * (1.0f - t));
        ty_vec3 along = ty_normalize(ty_sub(was[i + 1], was[i - 1])), side = ty_cross(w->n[i], along);
        float x = 2.5f * t, noise = ty_value_noise(ty_vec3_make(x, 0.5f, 0.5f), (uint32_t)def->key);
        noise += 0.4f * ty_value_noise(ty_vec3_make(2.6f * x, 0.5f, 0.5f), (uint32_t)def->key + 1u);
        w->p[i] = ty_mad(w->p[i], side, def->wander * length * wide * noise);
    }
}

// The cosine of the sharpest turn.
static float sharpest(const wrap* w)
{
    float turn = 1.0f;
    for (int i = 1; i + 1 < w->count; i++)
    {
        ty_vec3 a = ty_normalize(ty_sub(w->p[i], w->p[i - 1])), b = ty_normalize(ty_sub(w->p[i + 1], w->p[i]));
        turn = ty_min(turn, ty_dot(a, b));
    }
    return turn;
}

// Between the underside of a host and the floor that it stands on.
static bool is_under(const growth* g, ty_vec3 p, float r, float most)
{
    ty_vec3 n;
    if (!g->host->has_floor || p.y > g->host->floor + 2.0f * r)
        return false;
    return roots_host_value(g->host, p, &n) < most && n.y < -0.3f * ty_length(n);
}

static bool lies_well(const growth* g, const wrap_def* def, const wrap* w)
{
    for (int i = 1; i + 1 < w->count; i++)
    {
        float t = (float)i / (float)(w->count - 1), height = height_at(def, t, w->length);
        float over = roots_host_value(g->host, w->p[i], NULL) - height, most = 0.5f * (def->r + g->host->field.step);
        if (roots_host_clear(g->host, w->p[i], NULL) < g->recipe->growth.clear * def->r)
            return false;
        if (is_under(g, w->p[i], def->r, def->strict ? def->r : 0.0f))
            return false;
        if (over < -most ||
            over > (def->strict ? 3.0f : 9.0f) * most) // in corners it hangs over; it comes to rest later
            return false;
    }
    return true;
}

static void refine(const wrap_def* def, wrap* w)
{
    ty_vec3 fine[WRAP_MOST];
    int wanted = (int)(length_of(w->p, w->count) / (0.5f * def->r)) + 2;
    wanted = wanted < 12 ? 12 : wanted > WRAP_MOST ? WRAP_MOST : wanted;
    resample(w->p, w->count, fine, wanted);
    memcpy(w->p, fine, (size_t)wanted * sizeof(ty_vec3));
    w->count = wanted;
}

static bool tighten(const growth* g, const wrap_def* def, wrap* w, float chord, float lift)
{
    lift *= chord;
    begin(def, w, lift, chord);
    for (int i = 0; i <= TIGHTEN; i++)
    {
        float left = ty_sqr(1.0f - (float)i / TIGHTEN);
        clamp_ends(def, w);
        roots_bend(w->p, w->count, STIFF);
        project(g, def, w, lift * left, false);
        if (i % 4 == 3)
            evened(w->p, w->count);
    }
    return length_of(w->p, w->count) <= MOST_WAY * chord;
}

static float end_dot(const wrap* w, int from, int to, ty_vec3 t)
{
    return ty_dot(ty_normalize(ty_sub(w->p[to], w->p[from])), t);
}

// At full resolution, swung to the sides, its ends along the roots that it joins.
static bool finish(const growth* g, const wrap_def* def, wrap* w, float swung, float longest)
{
    float length = length_of(w->p, w->count);
    bool bridges = !def->strict && swung < 1.0f; // rather than not at all
    refine(def, w);
    project(g, def, w, 0.0f, false);
    if (swung > 0.0f)
        swing(def, w, swung * length);
    float stiff = ty_max(2.0f, STIFF_WAY * (float)w->count);
    for (int i = 0; i < 5 * SMOOTH; i++)
    {
        clamp_ends(def, w);
        roots_bend(w->p, w->count, stiff);
        project(g, def, w, 0.0f, bridges);
        if (i % 4 == 3)
            evened(w->p, w->count);
        w->length = length_of(w->p, w->count);
        if (i >= SMOOTH && sharpest(w) > 0.5f && lies_well(g, def, w))
            break;
    }
    w->length = length_of(w->p, w->count);
    w->n[0] = def->a.n;
    w->n[w->count - 1] = def->b.n;
    bool ends = end_dot(w, 0, 1, def->ta) > 0.6f && end_dot(w, w->count - 2, w->count - 1, def->tb) > 0.6f;
    if (def->strict && (!ends || sharpest(w) < 0.4f))
        return false;
    return w->length <= longest && sharpest(w) > 0.0f && lies_well(g, def, w); // turns are rounded off later
}

// Drawn tight it may set out or arrive against the flow of what it joins; then it is better off to go that way at once.
static bool turned(const wrap* w, wrap_def* def)
{
    int part = w->count / 5, last = w->count - 1;
    bool a = ty_dot(ty_sub(w->p[part], w->p[0]), def->ta) < 0.0f;
    bool b = ty_dot(ty_sub(w->p[last], w->p[last - part]), def->tb) < 0.0f;
    def->ta = a ? ty_neg(def->ta) : def->ta;
    def->tb = b ? ty_neg(def->tb) : def->tb;
    return a || b;
}

wrap_way roots_wrap(const growth* g, const wrap_def* wanted, wrap* w)
{
    wrap_def def = *wanted;
    float chord = ty_length(ty_sub(def.b.p, def.a.p)), height = (def.flat - def.sink) * def.r;
    const float lifts[] = {LIFT, LOW_LIFT, LOW_LIFT}, swings[] = {1.0f, 1.0f, 0.0f};
    for (int i = 0; i < 3; i++)
    {
        bool tight = tighten(g, &def, w, chord, lifts[i]);
        if (turned(w, &def))
            tight = tighten(g, &def, w, chord, lifts[i]);
        if (tight && finish(g, &def, w, swings[i], MOST_WAY * chord))
            return WRAP_TIGHT;
    }
    w->count = roots_geodesic(g->host, def.a.p, def.b.p, height, MOST_WAY * chord, w->p, WRAP_MOST);
    if (w->count < 3)
        return WRAP_NONE;
    for (int i = 0; i < SMOOTH; i++)
    {
        evened(w->p, w->count);
        roots_bend(w->p, w->count, 1.0f);
        project(g, &def, w, 0.0f, false);
    }
    turned(w, &def);
    return finish(g, &def, w, 0.3f, MOST_WAY * chord) ? WRAP_GEODESIC : WRAP_NONE;
}
