// SPDX-License-Identifier: Apache-2.0
// Fine roots over what is left of the host: space colonisation (Runions, Lane and Prusinkiewicz 2007) with attractors
// on the surface.
#include "roots_growth.h"
#include <string.h>

enum
{
    TABLE = 1 << 16, // of cells
    ROUNDS = 160,
    MOST_PIECES = 4096, // points of a fine root
};

#define REACH 3.5f // how far a place is felt, of the spacing
#define NEAR 0.9f  // where it counts as covered
#define STEP 0.4f

typedef struct bud
{
    ty_vec3 p, sum;
    int pulls;
    int parent;  // bud, or -1
    int point;   // of the network that it stands for, or -1
    int heir;    // the child that goes on farthest, or -1
    float ahead; // m, from here to the farthest tip
    int next;    // in its cell
} bud;

typedef struct aim
{
    ty_vec3 p;
    int nearest; // bud, -1 = none within reach
    float distance;
    bool covered;
    int next;
} aim;

typedef struct cover
{
    growth* g;
    float spacing, cell;
    bool crowded; // is there a place near?
    aim* aims;
    int aim_count, aim_capacity;
    bud* buds;
    int bud_count, bud_capacity;
    int place_heads[TABLE];
} cover;

static uint32_t cell_hash(int x, int y, int z)
{
    return ty_mix32(ty_mix32(ty_mix32((uint32_t)x) + (uint32_t)y) + (uint32_t)z) % TABLE;
}

static int* place_head(cover* c, ty_vec3 p)
{
    ty_vec3 q = ty_mul(p, 1.0f / c->cell);
    return &c->place_heads[cell_hash((int)floorf(q.x), (int)floorf(q.y), (int)floorf(q.z))];
}

typedef void place_visit(cover* c, aim* one, float distance, int bud_at);

// All places within a cell's size of p.
static void places_near(cover* c, ty_vec3 p, int bud_at, place_visit* visit)
{
    ty_vec3 q = ty_mul(p, 1.0f / c->cell);
    int low[3] = {(int)floorf(q.x) - 1, (int)floorf(q.y) - 1, (int)floorf(q.z) - 1};
    for (int k = 0; k < 27; k++)
    {
        uint32_t h = cell_hash(low[0] + k % 3, low[1] + k / 3 % 3, low[2] + k / 9);
        for (int i = c->place_heads[h]; i >= 0; i = c->aims[i].next)
            visit(c, &c->aims[i], ty_length(ty_sub(c->aims[i].p, p)), bud_at);
    }
}

// --- places to cover ---

static void place_meets(cover* c, aim* one, float distance, int bud_at)
{
    if (distance < NEAR * c->spacing)
        one->covered = true;
    if (distance < c->cell && (one->nearest < 0 || distance < one->distance))
    {
        one->nearest = bud_at;
        one->distance = distance;
    }
}

static void place_crowds(cover* c, aim* one, float distance, int bud_at)
{
    (void)one;
    (void)bud_at;
    if (distance < 0.75f * c->spacing)
        c->crowded = true;
}

static void place_add(cover* c, ty_vec3 p)
{
    c->crowded = false;
    places_near(c, p, 0, place_crowds);
    if (c->crowded)
        return;
    if (c->aim_count == c->aim_capacity)
    {
        int capacity = c->aim_capacity ? 2 * c->aim_capacity : 1024;
        c->aims = ty_grow(c->aims, (size_t)c->aim_capacity, (size_t)capacity, sizeof(aim));
        c->aim_capacity = capacity;
    }
    int* head = place_head(c, p);
    c->aims[c->aim_count] = (aim){.p = p, .nearest = -1, .next = *head};
    *head = c->aim_count++;
}

// Over the host by area, those that roots can hold on to.
static void places_make(cover* c)
{
    const roots_host* host = c->g->host;
    const ty_mesh* mesh = host->mesh;
    float each = 0.25f * ty_sqr(c->spacing), area = 0.0f;
    ty_rng rng = ty_rng_make(c->g->recipe->seed, 0x636f7665, 0);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
    {
        const uint32_t* v = mesh->triangles[t];
        ty_vec3 a = mesh->positions[v[0]], ab = ty_sub(mesh->positions[v[1]], a), ac = ty_sub(mesh->positions[v[2]], a);
        ty_vec3 across = ty_cross(ab, ac);
        float twice = ty_length(across);
        for (area += 0.5f * twice; area > each; area -= each)
        {
            float x = ty_rng_float(&rng), y = ty_rng_float(&rng);
            ty_vec3 p = x + y < 1.0f ? ty_mad(ty_mad(a, ab, x), ac, y) : ty_mad(ty_mad(a, ab, 1.0f - x), ac, 1.0f - y);
            bool holds = across.y > -ty_sin(c->g->recipe->growth.overhang) * twice;
            holds = holds && roots_host_mask(host, ROOTS_AVOID, p, NULL) < 0.5f;
            holds = holds && roots_host_clear(host, p, NULL) > c->g->recipe->growth.clear * c->g->recipe->cover.radius;
            if (holds && !(host->has_floor && p.y < host->floor + 0.5f * c->spacing))
                place_add(c, p);
        }
    }
}

// --- growing ---

static int bud_add(cover* c, ty_vec3 p, int parent, int point)
{
    if (c->bud_count == c->bud_capacity)
    {
        int capacity = c->bud_capacity ? 2 * c->bud_capacity : 4096;
        c->buds = ty_grow(c->buds, (size_t)c->bud_capacity, (size_t)capacity, sizeof(bud));
        c->bud_capacity = capacity;
    }
    c->buds[c->bud_count] = (bud){.p = p, .parent = parent, .point = point, .heir = -1};
    places_near(c, p, c->bud_count, place_meets);
    return c->bud_count++;
}

static bool cover_round(cover* c)
{
    const ty_roots_recipe* recipe = c->g->recipe;
    float height = (recipe->growth.flatten - recipe->growth.sink) * recipe->cover.radius;
    for (int i = 0; i < c->aim_count; i++)
    {
        const aim* one = &c->aims[i];
        if (one->covered || one->nearest < 0)
            continue;
        bud* n = &c->buds[one->nearest];
        n->sum = ty_mad(n->sum, ty_sub(one->p, n->p), 1.0f / one->distance);
        n->pulls++;
    }
    bool grown = false;
    int count = c->bud_count;
    for (int i = 0; i < count; i++)
    {
        bud n = c->buds[i];
        c->buds[i].sum = (ty_vec3){0.0f, 0.0f, 0.0f};
        c->buds[i].pulls = 0;
        if (n.pulls == 0 || ty_length(n.sum) < 1e-3f)
            continue;
        ty_vec3 normal, way = ty_normalize(n.sum);
        if (n.parent >= 0) // it goes on the way it went
            way = ty_normalize(ty_mad(way, ty_normalize(ty_sub(n.p, c->buds[n.parent].p)), 0.6f));
        way = ty_mad(way, (ty_vec3){0.0f, -1.0f, 0.0f}, 0.2f);
        ty_vec3 p = ty_mad(n.p, ty_normalize(way), STEP * c->spacing);
        p = roots_host_project(c->g->host, p, height, &normal);
        if (ty_length(ty_sub(p, n.p)) < 0.3f * STEP * c->spacing)
            continue;
        if (n.heir >= 0 && ty_length(ty_sub(c->buds[n.heir].p, p)) < 0.25f * c->spacing)
            continue; // what it cannot reach pulls to the same place for ever
        c->buds[i].heir = bud_add(c, p, i, -1);
        grown = true;
    }
    return grown;
}

// --- lines ---

static void heirs_find(cover* c)
{
    for (int i = 0; i < c->bud_count; i++)
        c->buds[i].heir = -1;
    for (int i = c->bud_count - 1; i >= 0; i--)
    {
        int parent = c->buds[i].parent;
        float ahead = parent >= 0 ? c->buds[i].ahead + ty_length(ty_sub(c->buds[i].p, c->buds[parent].p)) : 0.0f;
        if (parent >= 0 && (c->buds[parent].heir < 0 || ahead > c->buds[parent].ahead))
        {
            c->buds[parent].ahead = ahead;
            c->buds[parent].heir = i;
        }
    }
}

// A curve through knots, Catmull and Rom 1974.
static ty_vec3 curve_at(const ty_vec3* p, int count, int i, float t)
{
    ty_vec3 a = p[i > 0 ? i - 1 : 0], b = p[i], d = p[i + 1], e = p[i + 2 < count ? i + 2 : i + 1];
    ty_vec3 tb = ty_mul(ty_sub(d, a), 0.5f), td = ty_mul(ty_sub(e, b), 0.5f);
    float t2 = t * t, t3 = t2 * t;
    ty_vec3 sum = ty_mul(b, 2.0f * t3 - 3.0f * t2 + 1.0f);
    sum = ty_mad(sum, tb, t3 - 2.0f * t2 + t);
    sum = ty_mad(sum, d, 3.0f * t2 - 2.0f * t3);
    return ty_mad(sum, td, t3 - t2);
}

static void points_add(cover* c, const ty_vec3* knots, int count, const roots_point* from, roots_line* line)
{
    const ty_roots_recipe* recipe = c->g->recipe;
    roots_network* net = c->g->network;
    float length = 0.0f, s = 0.0f, full = recipe->cover.radius;
    for (int i = 1; i < count; i++)
        length += ty_length(ty_sub(knots[i], knots[i - 1]));
    ty_vec3 last = from->p;
    for (int i = 0; i + 1 < count; i++)
    {
        int pieces = (int)(ty_length(ty_sub(knots[i + 1], knots[i])) / (0.5f * full)) + 1;
        for (int k = i > 0; k <= pieces && line->count < MOST_PIECES; k++)
        {
            roots_point point = {.flat = recipe->growth.flatten, .sink = recipe->growth.sink};
            float left = ty_max(length - s, 0.0f) / length;
            point.r = ty_max(full * (0.45f + 0.55f * sqrtf(left)), recipe->tip);
            point.p = roots_host_project(c->g->host, curve_at(knots, count, i, (float)k / (float)pieces),
                                         growth_height(&point), &point.n);
            if (line->count == 0)
                point.p = from->p;
            s += ty_length(ty_sub(point.p, last));
            last = point.p;
            point.s = from->s + s;
            point.r *= 1.0f + recipe->flare * ty_exp(-s / (2.0f * full));
            point.r = ty_min(point.r, from->r);
            roots_network_add_point(net, &point);
            line->count++;
        }
    }
}

// Where each bud's line and point are, so that what leaves it is tied there.
typedef struct spot
{
    int line, point;
} spot;

static void line_add(cover* c, int first, spot* spots)
{
    roots_network* net = c->g->network;
    int parent = c->buds[first].parent, count = 1;
    for (int i = first; i >= 0; i = c->buds[i].heir)
        count++;
    ty_vec3* knots = TY_ALLOC(ty_vec3, count);
    roots_point from = net->points[spots[parent].point];
    knots[0] = from.p;
    for (int i = first, k = 1; i >= 0; i = c->buds[i].heir)
        knots[k++] = c->buds[i].p;
    for (int round = 0; round < 2; round++)
        for (int i = 1; i + 1 < count; i++)
            knots[i] = ty_lerp3(knots[i], ty_mul(ty_add(knots[i - 1], knots[i + 1]), 0.5f), 0.5f);
    roots_line line = {.first = net->point_count,
                       .kind = ROOTS_FINE,
                       .parent = spots[parent].line,
                       .parent_point = spots[parent].point,
                       .end = -1,
                       .end_point = -1};
    line.key = ty_mix64(net->lines[line.parent].key ^ (uint64_t)(line.parent_point - net->lines[line.parent].first));
    points_add(c, knots, count, &from, &line);
    int own = roots_network_add_line(net, &line), at = line.first;
    for (int i = first, k = 1; i >= 0; i = c->buds[i].heir, k++)
    {
        float nearest = TY_FLOAT_MAX;
        for (int q = at; q < line.first + line.count; q++)
        {
            float d = ty_length(ty_sub(net->points[q].p, knots[k]));
            at = d < nearest ? q : at;
            nearest = ty_min(nearest, d);
        }
        spots[i] = (spot){own, at};
    }
    ty_free(knots);
    net->requested[ROOTS_FINE]++;
    net->grown[ROOTS_FINE]++;
}

static void lines_add(cover* c)
{
    roots_network* net = c->g->network;
    spot* spots = TY_ALLOC(spot, c->bud_count);
    int first = net->line_count;
    heirs_find(c);
    for (int line = 0, i = 0; line < first; line++)
        for (int k = 0; k < net->lines[line].count; k++)
            if (i < c->bud_count && c->buds[i].point == net->lines[line].first + k)
                spots[i++] = (spot){line, net->lines[line].first + k};
    for (int i = 0; i < c->bud_count; i++)
    {
        int parent = c->buds[i].parent;
        bool begins = parent >= 0 && (c->buds[parent].point >= 0 || c->buds[parent].heir != i);
        if (begins && c->buds[i].ahead > 0.7f * c->spacing) // stubs are left out
            line_add(c, i, spots);
    }
    ty_free(spots);
    for (int line = first; line < net->line_count; line++) // one after another: they are tied to one another
        growth_settle_line(c->g, line, true);
}

bool growth_cover(growth* g)
{
    const roots_network* net = g->network;
    float spacing = g->recipe->cover.spacing;
    if (spacing <= 0.0f)
        return true;
    cover* c = TY_ALLOC(cover, 1);
    c->g = g;
    c->spacing = spacing;
    c->cell = REACH * spacing;
    memset(c->place_heads, -1, sizeof c->place_heads);
    places_make(c);
    for (int i = 0; i < net->line_count; i++)
        for (int k = 4; net->lines[i].kind != ROOTS_TRUNK && k < net->lines[i].count - 4; k++)
        {
            int point = net->lines[i].first + k;
            if (net->points[point].sink > 0.0f && net->points[point].r >= g->recipe->cover.radius)
                bud_add(c, net->points[point].p, -1, point);
        }
    for (int round = 0; round < ROUNDS && !ty_cancel_requested() && cover_round(c); round++)
        ;
    if (!ty_cancel_requested())
        lines_add(c);
    ty_free(c->aims);
    ty_free(c->buds);
    ty_free(c);
    return !ty_cancel_requested();
}
