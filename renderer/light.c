// SPDX-License-Identifier: Apache-2.0
// The set of lights: sampled from a point, and met by a ray.
#include "light.h"
#include <tsuya/base/memory.h>
#include <tsuya/shading/walk.h>

static unsigned visible_to(const ty_light_def* light)
{
    const ty_visible_def* def = &light->visible;
    return (def->camera && light->camera_visible ? TY_MASK_CAMERA : 0u) | (def->diffuse ? TY_MASK_DIFFUSE : 0u) |
           (def->glossy ? TY_MASK_GLOSSY : 0u) | (def->transmission ? TY_MASK_TRANSMISSION : 0u);
}

static void light_init(ty_light* light, const ty_light_def* def, const ty_texture* image,
                       const ty_environment_table* table)
{
    switch (light->kind)
    {
    case TY_LIGHT_ENVIRONMENT:
        ty_light_environment_init(light, def, image, table);
        break;
    case TY_LIGHT_RECTANGLE:
        ty_light_rectangle_init(light, def);
        break;
    case TY_LIGHT_DISK:
        ty_light_disk_init(light, def);
        break;
    case TY_LIGHT_CYLINDER:
        ty_light_cylinder_init(light, def);
        break;
    case TY_LIGHT_POINT:
    case TY_LIGHT_SPOT:
        ty_light_spot_init(light, def, image);
        break;
    case TY_LIGHT_DIRECTIONAL:
        ty_light_directional_init(light, ty_sub(def->center, def->target), def->irradiance, def->angle);
        break;
    case TY_LIGHT_SPHERE:
    case TY_LIGHT_SKY: // with its sun
        break;
    }
}

// A sky's sun stands behind it.
static void add_lights(ty_light_set* set, int source, bool grouped)
{
    const ty_scene* scene = set->scene;
    const ty_light_def* def = &scene->lights[source];
    ty_light* light = &set->lights[set->light_count];
    *light = (ty_light){.kind = (ty_light_kind)def->kind,
                        .source = source,
                        .group = grouped ? def->group_index : -1,
                        .visible = visible_to(def),
                        .shadows = def->shadows,
                        .value = def->radiance,
                        .center = def->center,
                        .radius = def->radius};
    set->light_count += 1 + (light->kind == TY_LIGHT_SKY);
    set->restricted |= (light->visible | TY_MASK_CAMERA) != TY_MASK_SEEN;
    light[light->kind == TY_LIGHT_SKY] = *light;
    if (light->kind == TY_LIGHT_SKY)
        ty_light_sky_init(light, light + 1, def);
    else
        light_init(light, def, scene->light_images ? scene->light_images[source] : NULL,
                   scene->light_tables ? scene->light_tables[source] : NULL);
}

// One selection for each set of lights that lights some object.
static void add_selections(ty_light_set* set, float scene_radius)
{
    const ty_scene* scene = set->scene;
    set->selection_count = scene->light_link_count > 0 ? scene->light_link_count : 1;
    set->selections = TY_ALLOC(ty_light_selection, set->selection_count);
    ty_light_selection_init(&set->selections[0], set, NULL, scene_radius);
    bool* lit = TY_ALLOC(bool, set->light_count + set->mesh_count);
    for (int link = 1; link < set->selection_count; ++link)
    {
        const bool* marks = scene->light_links[link];
        for (int i = 0; i < set->light_count; ++i)
            lit[i] = marks[set->lights[i].source];
        for (int i = 0; i < set->mesh_count; ++i)
            lit[set->light_count + i] = marks[scene->light_count + (int)set->meshes[i].object];
        ty_light_selection_init(&set->selections[link], set, lit, scene_radius);
    }
    ty_free(lit);
}

void ty_light_set_init(ty_light_set* set, const ty_scene* scene, bool grouped)
{
    *set = (ty_light_set){.scene = scene, .grouped = grouped};
    set->lights = TY_ALLOC(ty_light, 2 * scene->light_count);
    for (int i = 0; i < scene->light_count; ++i)
        add_lights(set, i, grouped);
    ty_light_meshes_init(set);
    for (int o = 0; o < scene->object_count; ++o)
        set->restricted |=
            set->first_mesh[o] != TY_NONE && ((scene->objects[o].mask & TY_MASK_SEEN) | TY_MASK_CAMERA) != TY_MASK_SEEN;
    ty_bounds bounds = ty_world_bounds(scene->world);
    float radius = 0.5f * ty_length(ty_sub(bounds.high, bounds.low));
    add_selections(set, isfinite(radius) && radius > 0.0f ? radius : 1.0f);
}

void ty_light_set_term(ty_light_set* set)
{
    for (int i = 0; i < set->selection_count; ++i)
        ty_light_selection_term(&set->selections[i]);
    ty_light_meshes_term(set);
    ty_free(set->selections);
    ty_free(set->lights);
    *set = (ty_light_set){0};
}

// --- sampling ---

static bool light_sample(const ty_light* light, ty_vec3 p, ty_vec2 u, ty_light_sample* out)
{
    switch (light->kind)
    {
    case TY_LIGHT_ENVIRONMENT:
        return ty_light_environment_sample(light, u, out);
    case TY_LIGHT_RECTANGLE:
        return ty_light_rectangle_sample(light, p, u, out);
    case TY_LIGHT_DISK:
        return ty_light_disk_sample(light, p, u, out);
    case TY_LIGHT_SPHERE:
        return ty_light_sphere_sample(light, p, u, out);
    case TY_LIGHT_CYLINDER:
        return ty_light_cylinder_sample(light, p, u, out);
    case TY_LIGHT_POINT:
    case TY_LIGHT_SPOT:
        return ty_light_spot_sample(light, p, out);
    case TY_LIGHT_DIRECTIONAL:
        return ty_light_directional_sample(light, u, out);
    case TY_LIGHT_SKY: // smooth: found by the rays
        break;
    }
    return false;
}

// 53 bits of which the upper 24 are u's: the steps of a deep tree use up what one float has.
static double refine(float u, ty_vec2 from)
{
    uint32_t x = (uint32_t)(from.x * 0x1p24f), y = (uint32_t)(from.y * 0x1p24f);
    return (double)u + (double)(ty_mix32(x ^ ty_mix32(y + 0x9e3779b9u)) >> 4) * 0x1p-52;
}

bool ty_light_set_sample(const ty_light_set* set, const ty_light_point* at, float u_choice, ty_vec2 u,
                         ty_light_sample* out)
{
    const ty_light_selection* s = &set->selections[at->link];
    float probability = 1.0f;
    double rest = 0.0;
    int emitter = s->only;
    if (emitter < 0 || emitter >= set->light_count)
        rest = refine(u_choice, u);
    if (emitter < 0)
        emitter = ty_light_select(set, at, rest, &probability, &rest);
    if (emitter < 0)
        return false;
    out->shadows = true;
    out->solid = false;
    out->visible = TY_MASK_SEEN;
    if (emitter >= set->light_count)
    {
        const ty_light_mesh* mesh = &set->meshes[emitter - set->light_count];
        if (!ty_light_mesh_sample(set, mesh, at, rest, u, out))
            return false;
        out->group = ty_light_set_object_group(set, mesh->object);
        out->visible = set->scene->objects[mesh->object].mask & TY_MASK_SEEN;
    }
    else
    {
        const ty_light* light = &set->lights[emitter];
        if (!light_sample(light, at->position, u, out))
            return false;
        out->group = light->group;
        out->shadows = light->shadows;
        out->visible = light->visible;
    }
    out->pdf *= probability;
    return out->pdf > 0.0f;
}

// --- what rays meet ---

// Share of a light that a ray met, where light sampling has a density of its own for the direction; 0 = it has none.
// view_pdf: of the ray's direction, by the kinds of lobes that the light is visible to.
static float balance(const ty_light_set* set, int emitter, const ty_light_view* view, float view_pdf, float pdf)
{
    float other = pdf > 0.0f ? ty_light_select_probability(set, &view->from, emitter) * pdf : 0.0f;
    switch ((ty_light_sampling)set->scene->render.light_sampling)
    {
    case TY_LIGHT_SAMPLING_LIGHT:
        return other > 0.0f ? 0.0f : 1.0f;
    case TY_LIGHT_SAMPLING_BSDF:
        return 1.0f;
    case TY_LIGHT_SAMPLING_MIS:
        break;
    }
    return ty_power_heuristic(view_pdf, other);
}

ty_rgb ty_light_parts_value(const ty_bsdf_parts* parts, unsigned mask, float* pdf)
{
    ty_rgb f = {0};
    *pdf = 0.0f;
    for (int k = 0; k < 3; ++k)
        if (mask & ((unsigned)TY_MASK_DIFFUSE << k))
        {
            f = ty_rgb_add(f, parts->f[k]);
            *pdf += parts->pdf[k];
        }
    return f;
}

static float ratio(float a, float b)
{
    return b > 0.0f ? a / b : 0.0f;
}

// Factor of the light that a ray brings from an emitter visible to a mask of rays, the ray's own kind among them. The
// ray's throughput has all lobes over all their densities: what a restricted light is due is those that see it.
static ty_rgb share(const ty_light_set* set, int emitter, unsigned visible, const ty_light_view* view, float pdf)
{
    if (view->full)
        return ty_rgb_grey(1.0f);
    if (!set->restricted || (visible | TY_MASK_CAMERA) == TY_MASK_SEEN)
        return ty_rgb_grey(balance(set, emitter, view, view->pdf, pdf));
    float seen_pdf, all_pdf;
    ty_rgb seen = ty_light_parts_value(&view->parts, visible, &seen_pdf),
           all = ty_light_parts_value(&view->parts, ~0u, &all_pdf);
    if (!(seen_pdf > 0.0f))
        return (ty_rgb){0};
    float factor = balance(set, emitter, view, seen_pdf, pdf) * ratio(all_pdf, seen_pdf);
    return ty_rgb_scale((ty_rgb){ratio(seen.r, all.r), ratio(seen.g, all.g), ratio(seen.b, all.b)}, factor);
}

static __attribute__((noinline)) bool round_meet(const ty_light* light, const ty_ray* ray, float* t)
{
    switch (light->kind)
    {
    case TY_LIGHT_DISK:
        return ty_light_disk_meet(light, ray, t);
    case TY_LIGHT_CYLINDER:
        return ty_light_cylinder_meet(light, ray, t);
    default:
        return ty_light_sphere_meet(light, ray, t);
    }
}

static float shape_pdf(const ty_light* light, ty_vec3 from, ty_vec3 wi)
{
    switch (light->kind)
    {
    case TY_LIGHT_RECTANGLE:
        return ty_light_rectangle_pdf(light, from, wi);
    case TY_LIGHT_DISK:
        return ty_light_disk_pdf(light, from, wi);
    case TY_LIGHT_CYLINDER:
        return ty_light_cylinder_pdf(light, from, wi);
    default:
        return ty_light_sphere_pdf(light, from);
    }
}

static inline bool meets_shape(const ty_light* light, const ty_ray* ray, float t_max, const ty_light_view* view,
                               float* t)
{
    if (!(light->visible & view->seen))
        return false;
    float limit = light->shadows || view->seen == TY_MASK_CAMERA ? t_max : INFINITY;
    if (light->kind == TY_LIGHT_RECTANGLE)
        return ty_light_rectangle_meet(light, ray, limit, t);
    return round_meet(light, ray, t) && *t >= ray->t_min && *t * TY_LIGHT_REACH < limit;
}

// What a ray takes from a shape that it meets at t. Seldom: kept out of the way of asking.
static __attribute__((noinline)) void add_shape(const ty_light_set* set, int index, const ty_ray* ray, float t,
                                                const ty_light_view* view, const ty_rgb* beta, ty_film_sample* out)
{
    const ty_light* light = &set->lights[index];
    ty_rgb due = ty_rgb_mul(*beta, light->value);
    if (!view->full)
        due = ty_rgb_mul(
            due, share(set, index, light->visible, view, shape_pdf(light, view->from.position, ray->direction)));
    due = ty_rgb_mul(due, ty_flight_transmittance(view->absorption, t));
    ty_film_sample_add(out, light->group, due);
}

// out NULL: only asks.
static inline bool shape_along(const ty_light_set* set, int index, const ty_ray* ray, float t_max,
                               const ty_light_view* view, const ty_rgb* beta, ty_film_sample* out)
{
    float t;
    if (!meets_shape(&set->lights[index], ray, t_max, view, &t))
        return false;
    if (out)
        add_shape(set, index, ray, t, view, beta, out);
    return true;
}

static bool box_met(const ty_light_node* node, const ty_ray* ray, ty_vec3 inverse)
{
    ty_vec3 a = ty_mul3(ty_sub(node->low, ray->origin), inverse), b = ty_mul3(ty_sub(node->high, ray->origin), inverse);
    ty_vec3 low = ty_min3(a, b), high = ty_max3(a, b);
    float enter = ty_max(low.x, ty_max(low.y, low.z)), leave = ty_min(high.x, ty_min(high.y, high.z));
    return enter <= leave * 1.00001f && leave >= 0.0f;
}

static __attribute__((noinline)) bool shapes_by_place(const ty_light_set* set, const ty_light_node* nodes,
                                                      const ty_ray* ray, float t_max, const ty_light_view* view,
                                                      const ty_rgb* beta, ty_film_sample* out)
{
    bool met = false;
    ty_vec3 d = ray->direction; // a zero would make nan of a border at the origin
    ty_vec3 inverse = {1.0f / (d.x != 0.0f ? d.x : 1e-30f), 1.0f / (d.y != 0.0f ? d.y : 1e-30f),
                       1.0f / (d.z != 0.0f ? d.z : 1e-30f)};
    uint32_t stack[64], index = 0;
    int depth = 0;
    for (;;)
    {
        if (box_met(&nodes[index], ray, inverse))
        {
            if (!(nodes[index].child & TY_LIGHT_LEAF))
            {
                stack[depth++] = nodes[index].child;
                ++index;
                continue;
            }
            met |= shape_along(set, (int)(nodes[index].child & ~TY_LIGHT_LEAF), ray, t_max, view, beta, out);
        }
        if (depth == 0)
            return met;
        index = stack[--depth];
    }
}

// No light hides another: every one along the ray counts.
static inline bool shapes_along(const ty_light_set* set, const ty_light_selection* s, const ty_ray* ray, float t_max,
                                const ty_light_view* view, const ty_rgb* beta, ty_film_sample* out)
{
    if (s->shaping)
        return shapes_by_place(set, s->shaping->nodes, ray, t_max, view, beta, out);
    bool met = false;
    for (int i = 0; i < s->shape_count; ++i)
        met |= shape_along(set, s->shapes[i], ray, t_max, view, beta, out);
    return met;
}

static ty_rgb sky_along(const ty_light_set* set, int index, const ty_ray* ray, const ty_light_view* view)
{
    const ty_light* light = &set->lights[index];
    if (!(light->visible & view->seen) || !ty_rgb_is_black(view->absorption)) // the way out of a medium has no end
        return (ty_rgb){0};
    ty_rgb radiance = light->value;
    float pdf = 0.0f;
    if (light->kind == TY_LIGHT_SKY)
        radiance = ty_light_sky_radiance(light, ray->direction);
    else if (light->kind == TY_LIGHT_ENVIRONMENT)
    {
        radiance = ty_light_environment_radiance(light, ray->direction);
        pdf = light->distribution && !view->full ? ty_light_environment_pdf(light, ray->direction) : 0.0f;
    }
    else if (ty_light_directional_covers(light, ray->direction))
        pdf = ty_light_directional_pdf(light);
    else
        return (ty_rgb){0};
    if (!(pdf > 0.0f) && !set->restricted)
        return radiance;
    return ty_rgb_mul(radiance, share(set, index, light->visible, view, pdf));
}

// The lights all around, where nothing within t stands before them.
static __attribute__((noinline)) void add_skies(const ty_light_set* set, const ty_light_selection* s, const ty_ray* ray,
                                                float t, const ty_light_view* view, const ty_rgb* beta,
                                                ty_film_sample* out)
{
    for (int i = 0; i < s->sky_count; ++i)
    {
        const ty_light* sky = &set->lights[s->skies[i]];
        if (t == TY_FLOAT_MAX || (!sky->shadows && view->seen != TY_MASK_CAMERA))
            ty_film_sample_add(out, sky->group, ty_rgb_mul(*beta, sky_along(set, s->skies[i], ray, view)));
    }
}

bool ty_light_set_along(const ty_light_set* set, const ty_ray* ray, float t, const ty_light_view* view,
                        const ty_rgb* beta, ty_film_sample* out)
{
    const ty_light_selection* s = &set->selections[view->from.link];
    bool met = shapes_along(set, s, ray, t, view, beta, out);
    if (t == TY_FLOAT_MAX || s->shadowless_skies)
        add_skies(set, s, ray, t, view, beta, out);
    return met;
}

bool ty_light_set_shines(const ty_light_set* set, const ty_ray* ray, const ty_light_view* view)
{
    const ty_light_selection* s = &set->selections[view->from.link];
    const ty_rgb one = {1.0f, 1.0f, 1.0f};
    for (int i = 0; i < s->sky_count; ++i)
        if (!ty_rgb_is_black(sky_along(set, s->skies[i], ray, view)))
            return true;
    return shapes_along(set, s, ray, TY_FLOAT_MAX, view, &one, NULL);
}

ty_rgb ty_light_set_weight(const ty_light_set* set, const ty_surface_point* met, const ty_light_view* view, ty_vec3 wi)
{
    const ty_scene* scene = set->scene;
    if (view->from.link && !scene->light_links[view->from.link][scene->light_count + (int)met->object])
        return (ty_rgb){0};
    uint32_t first = set->first_mesh[met->object];
    if (view->full || first == TY_NONE)
        return ty_rgb_grey(1.0f);
    int mesh = (int)(first + met->instance);
    return share(set, set->light_count + mesh, scene->objects[met->object].mask, view,
                 ty_light_mesh_pdf(set, &set->meshes[mesh], &view->from, met, wi));
}

int ty_light_set_object_group(const ty_light_set* set, uint32_t object)
{
    return set->grouped ? set->scene->objects[object].light_group : -1;
}
