// SPDX-License-Identifier: Apache-2.0
// Path tracing: light sampling at each surface, weighted against the surface's own sampling; roulette from a depth on.
#include "path.h"
#include <tsuya/shading/walk.h>

// The square root keeps more of the dim paths than the throughput itself: less noise for its rays. Scales beta and
// makes *u uniform again. False = the path ends.
static bool survives(const ty_render_def* def, ty_path* p, float* u)
{
    if (p->bounce + 1 < def->roulette_depth)
        return !ty_rgb_is_black(p->beta);
    float probability = sqrtf(ty_rgb_max(p->beta));
    if (!(probability < 1.0f))
        return true;
    if (*u >= probability)
        return false;
    p->beta = ty_rgb_scale(p->beta, 1.0f / probability);
    *u = ty_min(*u / probability, TY_ONE_MINUS_EPSILON);
    return true;
}

// The way on after a sampled direction; the view is from where light was gathered. False = the path ends.
static bool go_on(const ty_integrator* in, const ty_bsdf* bsdf, const ty_bsdf_sample* sample, float u, ty_path* p)
{
    p->beta = ty_rgb_mul(p->beta, sample->weight);
    if (!survives(&in->scene->render, p, &u))
        return false;
    p->indirect = p->soft;
    p->soft = p->soft || !sample->delta;
    p->diffused = p->diffused || sample->kind == TY_MASK_DIFFUSE;
    p->entered = 0.0f;
    if (p->at_boundary && sample->transmitted)
        ty_media_cross(&p->media, &p->body, p->entering);
    ty_bsdf_spawn(bsdf, sample->wi, u, &p->ray);
    if (in->has_media)
        ty_path_keep_way(&bsdf->point, p);
    ty_cone_scatter(in, bsdf, sample, &p->cone);
    p->ray.mask = sample->kind;
    ty_path_turn(in, bsdf, sample, &p->view);
    return true;
}

// Light at a surface and the next ray from it. u: direction 2, lobe, roulette and start; light's surface 2, choice,
// start of the shadow ray. False = the path ends.
static bool scatter(const ty_integrator* in, const ty_bsdf* bsdf, const float u[8], ty_path* p, ty_film_sample* out,
                    ty_counters* counters)
{
    p->view.from = ty_path_light_point(in, bsdf);
    ty_path_direct_light(in, p, bsdf, &p->view.from, u + 4, &p->beta, out, counters);
    ty_bsdf_sample sample;
    return ty_bsdf_sample_wi(bsdf, u[2], (ty_vec2){u[0], u[1]}, &sample) && go_on(in, bsdf, &sample, u[3], p);
}

// Of a bsdf that was open.
static void count_interior(const ty_bsdf* bsdf, ty_counters* counters)
{
    if (bsdf->kind != TY_BSDF_CDRF_EXIT && bsdf->kind != TY_BSDF_MATTE)
        return;
    counters->interior_rays += bsdf->flights > 0 ? bsdf->flights : 1;
    counters->walks_lost += bsdf->walk_end == TY_WALK_LOST;
    counters->walks_cut += bsdf->walk_end == TY_WALK_CUT;
}

// A translucent body under a coat, seen by the camera: light comes by both, and the way on is one of them. Choosing
// between them for the light as well would double the noise.
static bool scatter_both(const ty_integrator* in, const ty_sampler* sampler, ty_bsdf* body, ty_path* p,
                         ty_film_sample* out, ty_counters* counters)
{
    float c[8], pair[4], u[8], chance = ty_bsdf_coat_chance(body);
    ty_bsdf coat = *body;
    ty_bsdf_take_coat(&coat);
    ty_sampler_8d(sampler, TY_GROUP_COAT, c);
    ty_bsdf_sample glint;
    bool shines = ty_bsdf_sample_wi(&coat, c[2], (ty_vec2){c[0], c[1]}, &glint);
    ty_light_point outside = ty_path_light_point(in, &coat);
    ty_path_direct_light(in, p, &coat, &outside, c + 4, &p->beta, out, counters);
    if (shines)
        ty_path_light_along(in, p, &coat, &outside, &glint, c[3], out, counters);

    ty_rgb weight;
    ty_rng extra = ty_sampler_extra(sampler, p->bounce);
    ty_sampler_4d(sampler, ty_group_interior(p->bounce), pair);
    ty_sampler_8d(sampler, ty_group_scatter(p->bounce), u);
    const float inside[3] = {pair[0], pair[1], pair[3]}; // the direction gets the group's best pair
    bool lit = ty_bsdf_take_interior(body, &in->scene->shading, inside, &extra, &weight);
    count_interior(body, counters);
    ty_rgb beta = ty_rgb_mul(p->beta, weight);
    p->view.from = ty_path_light_point(in, body);
    if (lit)
        ty_path_direct_light(in, p, body, &p->view.from, u + 4, &beta, out, counters);

    if (pair[2] < chance)
    {
        p->beta = ty_rgb_scale(p->beta, 1.0f / chance);
        p->view.from = outside;
        bool goes = shines && go_on(in, &coat, &glint, u[3], p);
        p->view.done = true;
        return goes;
    }
    p->beta = ty_rgb_scale(beta, 1.0f / (1.0f - chance));
    ty_bsdf_sample sample;
    return lit && ty_bsdf_sample_wi(body, u[2], (ty_vec2){u[0], u[1]}, &sample) && go_on(in, body, &sample, u[3], p);
}

// Whether light comes by a coat, or the rest of a surface, and by the body beneath at once. What is clear besides goes
// three ways, of which one is chosen.
static bool is_lit_twice(const ty_bsdf* bsdf)
{
    bool clear = bsdf->kind == TY_BSDF_SUBSURFACE && bsdf->transmission_weight > 0.0f;
    return !clear && ty_bsdf_coat_chance(bsdf) > 0.0f;
}

// Without a world light leaves bodies where it enters.
static const ty_shading_context* interior_context(const ty_integrator* in, const ty_path* p)
{
    static const ty_shading_context nowhere = {0};
    return p->diffused && !in->scene->render.indirect_subsurface ? &nowhere : &in->scene->shading;
}

// The next vertex of a path. False = the path ends.
static bool advance(const ty_integrator* in, const ty_sampler* sampler, ty_bsdf* bsdf, ty_path* p, ty_film_sample* out,
                    ty_counters* counters)
{
    if (p->bounce == 0 && is_lit_twice(bsdf))
        return scatter_both(in, sampler, bsdf, p, out, counters);
    if (ty_bsdf_is_open(bsdf))
    {
        float pair[4];
        ty_rgb weight = {1.0f, 1.0f, 1.0f};
        ty_rng extra = ty_sampler_extra(sampler, p->bounce);
        ty_sampler_4d(sampler, ty_group_interior(p->bounce), pair);
        const float interior[4] = {pair[2], pair[0], pair[1], pair[3]};
        bool lit = ty_bsdf_resolve(bsdf, interior_context(in, p), interior, &extra, &weight);
        count_interior(bsdf, counters);
        if (!lit)
            return false;
        p->beta = ty_rgb_mul(p->beta, weight);
    }
    float u[8];
    ty_sampler_8d(sampler, ty_group_scatter(p->bounce), u);
    return scatter(in, bsdf, u, p, out, counters);
}

// Whether the ray goes straight through, by chance in proportion. Weighs beta for what happened.
static bool goes_through(const ty_integrator* in, const ty_sampler* sampler, const ty_material* material,
                         const ty_surface_point* point, ty_path* p)
{
    float u[4];
    ty_transparency t = ty_material_transparency(material, &in->scene->shading, point, ty_neg(p->ray.direction));
    float chance = ty_min(ty_rgb_max(t.through), 1.0f);
    ty_sampler_4d(sampler, ty_group_pass(p->bounce, p->passed), u);
    bool through = u[p->passed % 4] < chance;
    if (through)
    {
        p->beta = ty_rgb_mul(p->beta, ty_rgb_scale(t.through, 1.0f / chance));
        ty_path_leave(in->scene, material, point, p->ray.direction, &p->media);
    }
    else
        p->beta = ty_rgb_scale(p->beta, t.opacity / (1.0f - chance));
    return through;
}

static ty_rgb extinction_in(const ty_media* media)
{
    const ty_medium* top = ty_media_top(media);
    return top ? top->matter.extinction : ty_rgb_grey(0.0f);
}

// Whether the surface of a clear body is a boundary here; sets what lies on both sides.
static bool meets_boundary(const ty_integrator* in, const ty_material* material, const ty_surface_point* point,
                           ty_path* p, float* outside)
{
    p->body = ty_medium_make(material, &in->scene->shading, point);
    p->entering = ty_dot(p->ray.direction, point->ng) < 0.0f;
    p->at_boundary = ty_media_is_boundary(&p->media, &p->body, p->entering, outside);
    if (p->body.alone && p->entering && ty_media_holds(&p->media, &p->body))
        return false; // rounding put the ray outside of what it is in
    ty_media beyond = p->media;
    ty_media_cross(&beyond, &p->body, p->entering);
    if (!p->at_boundary)
    {
        p->media = beyond;
        // No shadow ray comes through here, so that what is met beyond is met by this ray alone.
        p->view.full = true;
        p->view.done = false;
        return false;
    }
    p->absorption[1] = extinction_in(&beyond);
    return true;
}

// Beer's law over the way to the surface, and the media on both sides of it.
static void arrive(const ty_integrator* in, float distance, ty_path* p)
{
    p->at_boundary = false;
    if (!in->has_media)
        return;
    p->absorption[0] = p->absorption[1] = p->view.absorption;
    distance = ty_max(distance + p->lead, 0.0f);
    const ty_medium* top = ty_media_top(&p->media);
    if (top && !ty_rgb_is_black(top->matter.albedo))
        ty_flight_pass(&top->matter, distance, &p->beta);
    else
        p->beta = ty_rgb_mul(p->beta, ty_flight_transmittance(p->absorption[0], distance));
}

// Lights along the ray up to t.
static void meet_lights(const ty_integrator* in, float t, const ty_path* p, ty_film_sample* out)
{
    if (p->indirect && in->scene->render.indirect_clamp > 0.0f)
    {
        ty_film_sample limited;
        ty_film_sample_begin(&limited, in->group_count);
        (void)ty_light_set_along(&in->lights, &p->ray, t, &p->view, &p->beta, &limited);
        ty_path_add_limited(in, &limited, out);
    }
    else if (ty_light_set_along(&in->lights, &p->ray, t, &p->view, &p->beta, out) && p->bounce == 0)
        out->covered = true;
}

static bool trace(const ty_integrator* in, const ty_path* p, ty_hit* hit, ty_film_sample* out)
{
    bool found = ty_world_intersect(in->scene->world, &p->ray, hit);
    if (!p->view.done)
        meet_lights(in, found ? hit->t : TY_FLOAT_MAX, p, out);
    return found;
}

// The next surface, past all scatterings before it. False = the path leaves the scene, or ends.
static bool trace_media(const ty_integrator* in, ty_path* p, ty_hit* hit, ty_counters* counters, ty_film_sample* out)
{
    for (;;)
    {
        const ty_medium* top = ty_media_top(&p->media);
        p->view.absorption = extinction_in(&p->media);
        bool found;
        if (top && top->alone)
        {
            found = ty_path_meet_own(in->scene->world, top, &p->ray, hit);
            if (!found) // through a hole of the mesh: on outside
            {
                counters->walks_lost++;
                ty_media_cross(&p->media, top, false);
                continue;
            }
        }
        else
            found = trace(in, p, hit, out);
        if (!found || !top || ty_rgb_is_black(top->matter.albedo))
            return found;
        switch (ty_path_scatter(&top->matter, hit->t, p, counters))
        {
        case TY_PATH_PASSED:
            return true;
        case TY_PATH_ENDED:
            return false;
        case TY_PATH_SCATTERED:
            break;
        }
    }
}

// The surface where the path scatters next, past all it goes straight through. False = it left the scene.
static bool find_surface(const ty_integrator* in, const ty_sampler* sampler, ty_path* p, ty_bsdf* bsdf,
                         ty_counters* counters, ty_film_sample* out)
{
    const ty_scene* scene = in->scene;
    for (; p->passed < TY_PATH_MAX_PASSED; ++p->passed)
    {
        ty_hit hit;
        ty_surface_point* point = &bsdf->point; // where the bsdf is prepared: copies of what was just written are slow
        float outside = 1.0f;
        bool found = in->has_media ? trace_media(in, p, &hit, counters, out) : trace(in, p, &hit, out);
        if (!found)
            return false;
        ty_world_surface(scene->world, &hit, point);
        ty_cone_arrive(&p->cone, p->ray.direction, hit.t, point);
        const ty_material* material = ty_scene_material(scene, hit.object, hit.instance, hit.triangle);
        unsigned traits = ty_material_traits(material);
        arrive(in, hit.t, p);
        if (((traits & TY_TRAIT_TRANSPARENT) && goes_through(in, sampler, material, point, p)) ||
            ((traits & TY_TRAIT_MEDIUM) && !meets_boundary(in, material, point, p, &outside)))
        {
            ty_path_pass(point, hit.t, &p->ray);
            if (in->has_media)
                ty_path_keep_way(point, p);
            counters->path_rays++;
            continue;
        }
        ty_material_prepare_within(material, &scene->shading, point, ty_neg(p->ray.direction), outside, bsdf);
        if (p->bounce == 0 && bsdf->kind == TY_BSDF_CDRF)
            bsdf->way = hit.t;
        out->covered = true;
        counters->path_vertices++;
        return true;
    }
    return false;
}

static void begin(const ty_integrator* in, const ty_sampler* sampler, const ty_ray* ray, ty_path* p)
{
    p->ray = *ray;
    p->cone = ty_cone_begin(in, ray);
    p->beta = ty_rgb_grey(1.0f);
    p->view.from.link = 0;
    p->view.full = true;
    p->view.done = false;
    p->view.seen = TY_MASK_CAMERA;
    p->view.absorption = ty_rgb_grey(0.0f);
    p->bounce = p->passed = 0;
    p->soft = p->indirect = p->diffused = p->at_boundary = false;
    p->absorption[0] = p->absorption[1] = ty_rgb_grey(0.0f);
    p->media.count = 0;
    if (in->media.count > 0)
        p->media = in->media;
    if (in->has_media)
    {
        p->rng = ty_sampler_extra(sampler, -1); // no surface has that number
        p->scatterings = 0;
        p->entered = p->lead = 0.0f;
    }
}

static void add_emission(const ty_integrator* in, const ty_bsdf* bsdf, const ty_path* p, ty_film_sample* out)
{
    ty_rgb weight = ty_light_set_weight(&in->lights, &bsdf->point, &p->view, p->ray.direction);
    ty_path_add(in, p->indirect, ty_light_set_object_group(&in->lights, bsdf->point.object),
                ty_rgb_mul(ty_rgb_mul(p->beta, bsdf->emission), weight), out);
}

void ty_path_sample(const ty_integrator* in, const ty_sampler* sampler, const ty_ray* ray, ty_counters* counters,
                    ty_film_sample* out)
{
    ty_path p;
    ty_bsdf bsdf;
    begin(in, sampler, ray, &p);
    for (; find_surface(in, sampler, &p, &bsdf, counters, out); p.bounce++)
    {
        if (!ty_rgb_is_black(bsdf.emission))
            add_emission(in, &bsdf, &p, out);
        if (p.bounce == 0)
            ty_integrator_record(in, &bsdf, out);
        if (p.bounce == in->scene->render.max_depth || !advance(in, sampler, &bsdf, &p, out, counters))
            return;
        counters->path_rays++;
    }
}
