// SPDX-License-Identifier: Apache-2.0
// Growth: a tip goes on by inertia, gravity and chance, along the host where it can hold on, and leaves branches
// behind. Each root has random numbers of its own, so that one does not change with another.
#include "roots.h"

enum
{
    MOST_STEPS = 4000, // of a root
    MOST_ROOTS = 20000,
};

typedef struct tip
{
    ty_vec3 p, t; // place and direction
    ty_vec3 n;    // away from the host
    ty_vec3 wander;
    float r, s, flat;
    float shown; // the radius follows r over some steps: a branch takes its share without a step in the surface
    float next;  // s of the next branch
    int level;
    int parent, parent_point;
    uint64_t key; // of its random numbers
    int children;
} tip;

typedef struct growth
{
    const ty_roots_recipe* recipe;
    const roots_host* host;
    roots_network* network;
    tip* tips; // to be grown, first come first served
    int tip_count, tip_capacity;
} growth;

static const ty_vec3 down = {0.0f, -1.0f, 0.0f};

static void tip_add(growth* g, tip t)
{
    if (g->tip_count == MOST_ROOTS)
        return;
    if (g->tip_count == g->tip_capacity)
    {
        int capacity = g->tip_capacity ? 2 * g->tip_capacity : 64;
        g->tips = ty_grow(g->tips, (size_t)g->tip_capacity, (size_t)capacity, sizeof(tip));
        g->tip_capacity = capacity;
    }
    g->tips[g->tip_count++] = t;
}

static ty_vec3 random_vector(ty_rng* rng)
{
    float x = ty_rng_range(rng, -1.0f, 1.0f), y = ty_rng_range(rng, -1.0f, 1.0f);
    return ty_vec3_make(x, y, ty_rng_range(rng, -1.0f, 1.0f));
}

static ty_vec3 without(ty_vec3 v, ty_vec3 unit)
{
    return ty_mad(v, unit, -ty_dot(v, unit));
}

static roots_point point_of(const growth* g, const tip* t)
{
    bool lies = t->flat < 0.999f;
    return (roots_point){
        .p = t->p, .n = t->n, .r = t->shown, .flat = t->flat, .sink = lies ? g->recipe->growth.sink : 0.0f, .s = t->s};
}

// --- one step ---

static float tip_distance(const growth* g, const tip* t, ty_vec3* normal)
{
    const ty_roots_growth_def* def = &g->recipe->growth;
    return roots_host_distance(g->host, t->p, (def->hold + 3.0f) * t->r, 2.0f * t->r, normal);
}

static bool tip_holds(const growth* g, const tip* t, ty_vec3* normal)
{
    const ty_roots_growth_def* def = &g->recipe->growth;
    float distance = tip_distance(g, t, normal);
    return distance < (def->hold + t->flat) * t->r && normal->y > -ty_sin(def->overhang);
}

// Moves the centre to its height over the host, by no more than half a step so that it comes down gently.
static void tip_settle(const growth* g, tip* t, float step)
{
    const ty_roots_growth_def* def = &g->recipe->growth;
    ty_vec3 n;
    for (int i = 0; i < 3; i++)
    {
        float wrong = tip_distance(g, t, &n) - (t->flat - def->sink) * t->r;
        t->p = ty_mad(t->p, n, -ty_clamp(wrong, -step, 0.5f * step));
    }
    t->n = ty_normalize(ty_lerp3(t->n, n, 0.5f));
}

static void tip_step(const growth* g, tip* t, float step, ty_rng* rng)
{
    const ty_roots_growth_def* def = &g->recipe->growth;
    ty_vec3 n;
    bool holds = tip_holds(g, t, &n);
    t->wander = ty_mad(ty_mul(t->wander, 0.92f), random_vector(rng), 0.68f); // variance 1 in the long run
    ty_vec3 direction = ty_mad(ty_mul(t->t, def->inertia), down, def->gravity);
    direction = ty_mad(direction, t->wander, holds ? def->wander : 0.3f * def->wander);
    if (holds)
        direction = without(direction, n);
    if (ty_length(direction) > 1e-6f)
        t->t = ty_normalize(direction);
    t->p = ty_mad(t->p, t->t, step);
    t->flat = ty_lerp(t->flat, holds ? def->flatten : 1.0f, 0.15f);
    if (holds)
        tip_settle(g, t, step);
    ty_vec3 upright = without(t->n, t->t);
    t->n = ty_length(upright) > 1e-3f ? ty_normalize(upright) : ty_frame_from_normal(t->t).t;
    t->s += step;
}

// --- branches ---

static void tip_branch(growth* g, tip* t, ty_rng* rng)
{
    const ty_roots_branch_def* def = &g->recipe->branch;
    float r = t->r * ty_rng_range(rng, def->share[0], def->share[1]);
    float side = ty_rng_float(rng) < 0.5f ? -1.0f : 1.0f, angle = def->angle * ty_rng_range(rng, 0.7f, 1.3f);
    float wait = ty_rng_range(rng, 0.4f, 1.6f), child_wait = ty_rng_range(rng, 0.3f, 1.0f);
    t->next = t->s + def->spacing * wait;
    if (t->level >= def->levels || r < 1.2f * g->recipe->tip)
        return;
    tip child = *t;
    child.t = ty_quat_rotate(ty_quat_axis_angle(t->n, side * angle), t->t);
    child.r = r;
    child.shown = ty_min(t->shown, 1.4f * r); // it swells towards its parent
    child.level = t->level + 1;
    child.children = 0;
    child.key = ty_mix64(t->key ^ (0x9e3779b97f4a7c15ull * (uint64_t)(++t->children)));
    child.next = t->s + def->spacing * child_wait;
    tip_add(g, child);
    float rest = ty_pow(t->r, def->exponent) - ty_pow(r, def->exponent);
    t->r = ty_max(ty_pow(ty_max(rest, 0.0f), 1.0f / def->exponent), 0.5f * t->r);
}

// A root that stops at its longest still ends in a tip.
static void end_taper(roots_network* network, int first, float thinnest)
{
    roots_point* points = network->points;
    int last = network->point_count - 1;
    float reach = 12.0f * points[last].r;
    for (int i = first; i <= last; i++)
    {
        float left = ty_clamp((points[last].s - points[i].s) / reach, 0.0f, 1.0f);
        points[i].r = ty_max(ty_min(points[i].r, thinnest), points[i].r * sqrtf(left));
    }
}

static void root_grow(growth* g, int index)
{
    static const roots_kind kinds[] = {ROOTS_MAIN, ROOTS_FIRST, ROOTS_SECOND};
    const ty_roots_recipe* recipe = g->recipe;
    roots_network* network = g->network;
    tip t = g->tips[index];
    ty_rng rng = ty_rng_make(recipe->seed, 0x726f6f74, t.key);
    roots_line line = {.first = network->point_count,
                       .kind = t.level < 3 ? kinds[t.level] : ROOTS_FINE,
                       .parent = t.parent,
                       .parent_point = t.parent_point,
                       .end = -1,
                       .end_point = -1,
                       .key = t.key};
    float begin = t.s;
    roots_point point = point_of(g, &t);
    roots_network_add_point(network, &point);
    for (int i = 0; i < MOST_STEPS && t.r > recipe->tip && t.s < begin + recipe->length; i++)
    {
        float step = ty_max(0.6f * t.r, 1.5f * recipe->tip);
        tip_step(g, &t, step, &rng);
        bool lies = g->host->has_floor && t.p.y < g->host->floor + 2.0f * t.r; // on the floor it thins out sooner
        float thinner = ty_exp(-step * (lies ? 2.5f : 1.0f) / recipe->taper);
        t.r *= thinner;
        t.shown = ty_lerp(t.shown * thinner, t.r, 0.2f);
        point = point_of(g, &t);
        roots_network_add_point(network, &point);
        t.parent = index;
        t.parent_point = network->point_count - 1;
        if (t.s >= t.next)
            tip_branch(g, &t, &rng);
    }
    end_taper(network, line.first, recipe->tip);
    line.count = network->point_count - line.first;
    roots_network_add_line(network, &line);
    network->grown[line.kind]++;
    network->requested[line.kind]++;
}

// --- the trunk ---

static ty_vec3 trunk_foot(const growth* g)
{
    ty_bounds b = g->host->mesh->bounds;
    ty_vec3 foot = ty_mul(ty_add(b.low, b.high), 0.5f);
    foot.y = b.high.y;
    return foot;
}

// The heart of the trunk, from its cut to a little below the host's top: what the main roots run down along.
static void heart_add(growth* g, ty_vec3 foot, ty_vec3 top)
{
    const ty_roots_trunk_def* def = &g->recipe->trunk;
    enum
    {
        PIECES = 8
    };
    roots_line line = {.first = g->network->point_count,
                       .count = PIECES + 1,
                       .kind = ROOTS_TRUNK,
                       .parent = -1,
                       .parent_point = -1,
                       .end = -1,
                       .end_point = -1};
    for (int i = 0; i <= PIECES; i++)
    {
        float along = (float)i / PIECES;
        roots_point point = {.p = ty_lerp3(top, foot, along),
                             .n = {1.0f, 0.0f, 0.0f},
                             .r = 0.8f * def->radius,
                             .flat = 1.0f,
                             .s = along * def->height};
        roots_network_add_point(g->network, &point);
    }
    roots_network_add_line(g->network, &line);
}

static void main_roots_add(growth* g, ty_vec3 top)
{
    const ty_roots_recipe* recipe = g->recipe;
    ty_rng rng = ty_rng_make(recipe->seed, 0x7472756e, 0);
    float turn = ty_rng_range(&rng, 0.0f, 2.0f * TY_PI);
    for (int i = 0; i < recipe->count; i++)
    {
        float jitter = ty_rng_range(&rng, -0.3f, 0.3f), thick = ty_rng_range(&rng, -1.0f, 1.0f);
        float twist = ty_rng_range(&rng, -0.35f, 0.35f), wait = ty_rng_range(&rng, 0.3f, 1.0f);
        float angle = turn + 2.0f * TY_PI * ((float)i + jitter) / (float)recipe->count, sine, cosine;
        ty_sincos(angle, &sine, &cosine);
        ty_vec3 out = {cosine, 0.0f, sine}, around = {-sine, 0.0f, cosine};
        tip t = {.n = out, .r = recipe->radius * (1.0f + recipe->variation * thick), .flat = 1.0f};
        t.p = ty_mad(top, out, ty_max(recipe->trunk.radius - 0.5f * t.r, 0.2f * recipe->trunk.radius));
        t.t = ty_normalize(ty_add(ty_mad(down, out, 0.2f), ty_mul(around, twist)));
        t.shown = t.r;
        t.key = ty_mix64((uint64_t)i + 1);
        t.parent = t.parent_point = -1;
        t.next = recipe->trunk.height + recipe->branch.spacing * wait;
        tip_add(g, t);
    }
}

ty_status roots_grow(const ty_roots_recipe* recipe, const roots_host* host, roots_network* out, ty_error* error)
{
    growth g = {.recipe = recipe, .host = host, .network = out};
    *out = (roots_network){0};
    ty_vec3 foot = trunk_foot(&g), top = ty_add(foot, recipe->trunk.lean);
    top.y += recipe->trunk.height;
    out->top = top.y;
    main_roots_add(&g, top);
    for (int i = 0; i < g.tip_count && !ty_cancel_requested(); i++)
        root_grow(&g, i);
    if (recipe->trunk.height > 0.0f)
        heart_add(&g, ty_mad(foot, down, 0.5f * recipe->trunk.radius), top);
    ty_free(g.tips);
    if (ty_cancel_requested())
        return ty_error_set(error, TY_INTERRUPTED, "interrupted while roots grew");
    if (g.tip_count >= MOST_ROOTS)
        return ty_error_set(error, TY_BAD_INPUT, "branch.spacing: %g m gives more than %d roots",
                            (double)recipe->branch.spacing, MOST_ROOTS);
    return TY_OK;
}
