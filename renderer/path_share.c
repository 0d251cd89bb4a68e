// SPDX-License-Identifier: Apache-2.0
// Paths of neighbouring pixels that are shared (Bekaert, Sbert and Halton 2002, "Accelerating path tracing by re-using
// paths"): where a path goes on from the surface that the camera sees, its neighbours can go on as well, if they see
// the place. All pixels of the block count as having sampled it, each with its own density (balance heuristic), so that
// nothing is counted twice and no weight exceeds one.
#include "path.h"

// What the camera sees at a pixel and how its path goes on.
typedef struct way
{
    bool takes;           // it can go on by the ways of others
    bool gives;           // what it found is of use to others
    bool far;             // it left the scene
    ty_bsdf x;            // where it begins, while `takes` or `gives`
    ty_vec3 wi;           // from there
    ty_vec3 y, n;         // the place it leads to, and the normal on its side
    ty_vec3 end;          // off that surface
    ty_film_sample light; // from there, of all later vertices, times scale
    float scale;
} way;

// One pixel's way to where another's leads.
typedef struct tie
{
    ty_ray ray;
    float distance;
    float pdf;     // of the direction
    float density; // of the place: per area, or per solid angle where it is far. 0 = it cannot be reached
} tie;

bool ty_path_can_share(const ty_integrator* in)
{
    const ty_render_def* def = &in->scene->render;
    return !in->scene->moves && !in->has_transparent && !in->has_media && !in->lights.restricted &&
           in->scene->light_link_count <= 1 && def->indirect_clamp == 0.0f && def->roulette_depth > 1 &&
           def->max_depth > 0;
}

// The light of a surface that is not looked at from elsewhere stays with its own pixel.
static bool is_common(const ty_bsdf* bsdf)
{
    return bsdf->kind == TY_BSDF_MATTE && !bsdf->bent && ty_rgb_is_black(bsdf->emission);
}

static void keep(const ty_integrator* in, const ty_sampler* sampler, ty_path* p, ty_bsdf* y, ty_counters* counters,
                 ty_film_sample* out)
{
    float t = ty_length(ty_sub(y->point.position, p->ray.origin));
    (void)ty_light_set_along(&in->lights, &p->ray, t, &p->view, &p->beta, out);
    ty_path_follow(in, sampler, p, y, counters, out);
}

// What comes from beyond the first way. Lights along that are left to the ties.
static void find_light(const ty_integrator* in, const ty_sampler* sampler, ty_path* p, way* w, ty_counters* counters,
                       ty_film_sample* out)
{
    ty_bsdf y;
    p->bounce = 1;
    p->view.done = true;
    counters->path_rays++;
    ty_film_sample_begin(&w->light, in->group_count);
    w->scale = ty_rgb_max(p->beta);
    w->far = !ty_path_find_surface(in, sampler, p, &y, counters, out);
    w->gives = w->far || is_common(&y);
    if (!w->gives)
        keep(in, sampler, p, &y, counters, out);
    if (!w->gives || w->far)
        return;
    w->y = y.point.position;
    w->n = ty_dot(w->wi, y.point.ng) > 0.0f ? ty_neg(y.point.ng) : y.point.ng;
    w->end = ty_offset_origin(&y.point, w->n);
    p->beta = ty_rgb_grey(w->scale); // the colour is that of whoever takes it
    ty_path_follow(in, sampler, p, &y, counters, &w->light);
}

static void begin_way(const ty_integrator* in, const ty_sampler* sampler, const ty_ray* ray, way* w,
                      ty_counters* counters, ty_film_sample* out)
{
    ty_path p;
    w->takes = w->gives = false;
    ty_path_begin(in, ray, &p);
    if (!ty_path_find_surface(in, sampler, &p, &w->x, counters, out))
        return;
    if (!is_common(&w->x))
    {
        ty_path_follow(in, sampler, &p, &w->x, counters, out);
        return;
    }
    ty_integrator_record(in, &w->x, out);
    float u[8];
    ty_sampler_8d(sampler, ty_group_scatter(0), u);
    p.view.from = ty_path_light_point(in, &w->x);
    ty_path_direct_light(in, &p, &w->x, &p.view.from, u + 4, &p.beta, out, counters);
    ty_bsdf_sample sample;
    w->takes =
        ty_bsdf_sample_wi(&w->x, u[2], (ty_vec2){u[0], u[1]}, &sample) && ty_path_go_on(in, &w->x, &sample, u[3], &p);
    w->wi = sample.wi;
    if (w->takes)
        find_light(in, sampler, &p, w, counters, out);
}

static void tie_to(const ty_integrator* in, const way* from, const way* to, ty_counters* counters, tie* t)
{
    t->density = 0.0f;
    t->distance = TY_FLOAT_MAX;
    ty_vec3 wi = to->wi;
    float density = 1.0f;
    if (!to->far)
    {
        ty_vec3 d = ty_sub(to->y, from->x.point.position);
        float distance_sqr = ty_length_sqr(d);
        t->distance = sqrtf(distance_sqr);
        wi = ty_mul(d, 1.0f / t->distance);
        density = -ty_dot(wi, to->n) / distance_sqr;
    }
    (void)ty_bsdf_eval(&from->x, wi, &t->pdf);
    density *= t->pdf;
    if (!(density > 0.0f && density < TY_FLOAT_MAX))
        return;
    ty_bsdf_spawn(&from->x, wi, 0.0f, &t->ray);
    t->ray.mask = TY_MASK_DIFFUSE;
    t->density = density;
    if (from == to)
        return;
    if (!to->far)
    {
        ty_vec3 d = ty_sub(to->end, t->ray.origin);
        t->ray.t_max = ty_length(d);
        t->ray.direction = ty_mul(d, 1.0f / t->ray.t_max);
    }
    counters->shadow_rays++;
    if (ty_world_occluded(in->scene->world, &t->ray))
        t->density = 0.0f;
}

// Light from where another's way leads, times beta.
static void take(const ty_integrator* in, const way* from, const way* to, const tie* t, float share,
                 ty_film_sample* out)
{
    ty_rgb beta = ty_rgb_scale(from->x.color, share), rest = ty_rgb_scale(beta, 1.0f / to->scale);
    ty_light_view view = {.from = ty_path_light_point(in, &from->x), .pdf = t->pdf, .seen = TY_MASK_DIFFUSE};
    (void)ty_light_set_along(&in->lights, &t->ray, t->distance, &view, &beta, out);
    out->radiance = ty_rgb_add(out->radiance, ty_rgb_mul(rest, to->light.radiance));
    for (uint32_t g = 0; g < in->group_count; ++g)
        out->group[g] = ty_rgb_add(out->group[g], ty_rgb_mul(rest, to->light.group[g]));
}

void ty_path_sample_block(const ty_integrator* in, const ty_sampler samplers[], const ty_ray rays[], int count,
                          ty_counters* counters, ty_film_sample out[])
{
    way ways[TY_PATH_BLOCK];
    for (int i = 0; i < count; ++i)
        begin_way(in, &samplers[i], &rays[i], &ways[i], counters, &out[i]);
    for (int j = 0; j < count; ++j)
    {
        tie ties[TY_PATH_BLOCK];
        float sum = 0.0f;
        if (!ways[j].gives)
            continue;
        for (int i = 0; i < count; ++i)
        {
            ties[i].density = 0.0f;
            if (ways[i].takes)
                tie_to(in, &ways[i], &ways[j], counters, &ties[i]);
            sum += ties[i].density;
        }
        for (int i = 0; i < count; ++i)
            if (ties[i].density > 0.0f)
                take(in, &ways[i], &ways[j], &ties[i], ties[i].density / sum, &out[i]);
    }
}
