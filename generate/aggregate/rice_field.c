// SPDX-License-Identifier: Apache-2.0
// A grain of rice as a solid on a grid (Gan 2023, section 3.1.1): a base grain with balls on its surface, less the
// balls of its pores, smoothed, swollen, and made a mesh at the resolution of the render.
#include "element_kinds.h"
#include <string.h>
#include <tsuya/geometry/voxels.h>

enum
{
    SMOOTH = 12, // divisions of the surface that balls are fitted to
    RELAX = 3,   // rounds, of the net
    SOAK = 60,   // min, where it is not said
};

#define SMALLEST 0.1f // of the mean radius of balls

ty_grain_def ty_grain_def_default(void)
{
    return (ty_grain_def){.voxels = 40,
                          .swelling = 0.0f,
                          .unevenness = 0.15f,
                          .bumps = 60,
                          .bump_radius = 0.45e-3f,
                          .bump_height = 0.02e-3f,
                          .pores = 30,
                          .pore_radius = 0.07e-3f,
                          .open = 0.3f,
                          .smoothing = 0.1e-3f,
                          .soak = -1.0f,
                          .cut = 0.0f};
}

float ty_rice_swelling(int cultivar)
{
    return cultivar == TY_CULTIVAR_INDICA ? 1.2f : 1.5f;
}

// --- soaking ---

ty_rice_pores ty_rice_pores_after(float seconds, float half_thickness)
{
    static const float times[] = {0.0f, 1200.0f, 3600.0f, 7200.0f};
    static const float areas[] = {0.02e-12f, 0.06e-12f, 1.31e-12f, 4.72e-12f};
    const float depths[] = {ty_min(0.1e-3f, half_thickness), ty_min(0.2e-3f, half_thickness),
                            ty_min(0.2e-3f, half_thickness), half_thickness};
    float t = ty_clamp(seconds, 0.0f, times[3]);
    int i = t < times[1] ? 0 : t < times[2] ? 1 : 2;
    float share = (t - times[i]) / (times[i + 1] - times[i]);
    float log_area = ty_lerp(ty_ln(areas[i] * 1e12f), ty_ln(areas[i + 1] * 1e12f), share);
    return (ty_rice_pores){ty_exp(log_area) * 1e-12f, ty_lerp(depths[i], depths[i + 1], share)};
}

// --- making ---

typedef struct making
{
    const ty_grain_def* def;
    ty_rng rng;
    ty_mesh* base; // with the dent
    ty_voxels skin, solid;
    float half; // m, half the thickness of this grain
    float size; // of the grain against its base, by its own swelling
    ty_rice_pores soaked;
} making;

// Radii spread by a quarter about the mean.
static float radius_draw(making* m, float mean)
{
    return mean * ty_max(SMALLEST, 1.0f + 0.25f * ty_element_bell(&m->rng));
}

// A point of the base's surface and the direction out of the solid there. Its triangles are of nearly one size.
static ty_vec3 surface_draw(making* m, ty_vec3* normal)
{
    const uint32_t* c = m->base->triangles[ty_rng_u32(&m->rng) % m->base->triangle_count];
    ty_vec3 a = m->base->positions[c[0]], u = ty_sub(m->base->positions[c[1]], a);
    ty_vec3 v = ty_sub(m->base->positions[c[2]], a);
    *normal = ty_normalize(ty_cross(u, v));
    return ty_mad(ty_mad(a, u, 1.0f / 3.0f), v, 1.0f / 3.0f);
}

static void bumps_add(making* m)
{
    for (int i = 0; i < m->def->bumps; i++)
    {
        ty_vec3 n, p = surface_draw(m, &n);
        float r = radius_draw(m, m->def->bump_radius), rise = m->def->bump_height * ty_rng_float(&m->rng);
        ty_voxels_add_ball(&m->solid, ty_mad(p, n, rise - r), r, 6.0f * m->solid.step);
    }
}

// Those that open at the surface have their centre just under it; the others lie anywhere in the porous layer.
static void pores_take(making* m)
{
    for (int i = 0; i < m->def->pores; i++)
    {
        ty_vec3 n, p = surface_draw(m, &n);
        float r = radius_draw(m, m->def->pore_radius), under = 0.4f * r;
        if ((float)i + 0.5f >= m->def->open * (float)m->def->pores)
            under = 1.6f * r + ty_rng_float(&m->rng) * ty_max(m->soaked.depth - 1.6f * r, 0.0f);
        ty_voxels_take_ball(&m->solid, ty_mad(p, n, -under), r, 6.0f * m->solid.step);
    }
}

static void grain_cut(making* m)
{
    ty_vec3 low = m->base->bounds.low, high = m->base->bounds.high;
    if (m->def->cut > 0.0f)
        ty_voxels_cut(&m->solid, ty_vec3_make(1.0f, 0.0f, 0.0f), ty_lerp(high.x, low.x, m->def->cut));
}

static ty_status voxels_copy(const ty_voxels* from, ty_voxels* to, ty_error* error)
{
    size_t count = (size_t)from->size[0] * (size_t)from->size[1] * (size_t)from->size[2];
    *to = *from;
    to->values = TY_TRY_ALLOC(float, count);
    if (!to->values)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for a grain of %zu voxels", count);
    memcpy(to->values, from->values, count * sizeof(float));
    return TY_OK;
}

// The raw grain has the sizes of the cooked one less what the mean one swells by; each swells by its own.
static float swelling_draw(making* m, const ty_element_def* def)
{
    float cooked = ty_rice_swelling(def->cultivar), mean = m->def->swelling > 0.0f ? m->def->swelling : cooked;
    float own = 1.0f + (mean - 1.0f) * ty_max(0.0f, 1.0f + m->def->unevenness * ty_element_bell(&m->rng));
    return ty_pow(ty_min(own, 1.5f) / cooked, 1.0f / 3.0f);
}

static ty_status solid_make(making* m, const ty_element_def* def, ty_error* error)
{
    float step = def->width / (float)m->def->voxels;
    m->size = swelling_draw(m, def);
    ty_status status = ty_voxels_from_mesh(m->base, step, 4.0f * step + m->def->bump_height, &m->skin, error);
    if (status == TY_OK)
        status = voxels_copy(&m->skin, &m->solid, error);
    if (status != TY_OK)
        return status;
    bumps_add(m);
    pores_take(m);
    grain_cut(m);
    ty_voxels_scale(&m->solid, m->size);
    ty_voxels_scale(&m->skin, m->size);
    m->half *= m->size;
    m->soaked.depth *= m->size;
    return ty_voxels_smooth(&m->solid, 0.25f * ty_sqr(m->def->smoothing), error);
}

// How deep each vertex lies under the grain's own skin, and how far soaking has opened the tissue there: pores end
// over a quarter of the layer's depth, and their size counts by its root.
static void attributes_write(const making* m, ty_mesh* mesh)
{
    float* depth = ty_mesh_add_attribute(mesh, "depth", 1);
    float* pores = ty_mesh_add_attribute(mesh, "pores", 1);
    float open = sqrtf(m->soaked.area / 4.72e-12f);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
    {
        float under = ty_max(0.0f, -ty_voxels_value(&m->skin, mesh->positions[i]));
        float end = (m->soaked.depth - under) / (0.25f * m->soaked.depth);
        depth[i] = ty_min(under / m->half, 1.0f);
        pores[i] = open * ty_clamp(m->soaked.depth >= 0.99f * m->half ? 1.0f : end, 0.0f, 1.0f);
    }
}

// A whole grain's balls are those of its smooth surface, without dent and pores, raised by half of what bumps add; a
// cut one has those of what is left.
static ty_status balls_make(const making* m, const ty_element_def* def, ty_seed seed, int variant, ty_vec3 shift,
                            ty_element* out, ty_error* error)
{
    if (m->def->cut > 0.0f)
        return ty_element_fit(out, def->fit, error);
    ty_mesh *smooth, *mesh = out->mesh;
    ty_status status = ty_rice_surface(def, seed, variant, SMOOTH, false, &smooth, &out->width, error);
    if (status != TY_OK)
        return status;
    float bump = 0.5f * m->def->bump_height * m->size, tolerance = def->fit - bump / out->width;
    out->width *= m->size;
    ty_mesh_compute_welds(smooth);
    ty_mesh_compute_normals(smooth, TY_PI);
    for (uint32_t i = 0; i < smooth->vertex_count; i++)
    {
        ty_vec3 p = ty_sub(ty_mul(smooth->positions[i], m->size), shift);
        smooth->positions[i] = ty_mad(p, smooth->normals[i], bump);
    }
    ty_mesh_compute_bounds(smooth);
    out->mesh = smooth;
    status = ty_element_fit(out, ty_max(tolerance, 0.01f), error);
    out->mesh = mesh;
    ty_mesh_destroy(smooth);
    return status;
}

static ty_status grain_make(making* m, const ty_element_def* def, ty_seed seed, int variant, ty_element* out,
                            ty_error* error)
{
    float width;
    ty_status status = ty_rice_surface(def, seed, variant, (2 * m->def->voxels + 2) / 3, true, &m->base, &width, error);
    if (status != TY_OK)
        return status;
    ty_mesh_compute_bounds(m->base);
    m->half = 0.5f * (m->base->bounds.high.z - m->base->bounds.low.z);
    m->soaked = ty_rice_pores_after(60.0f * (m->def->soak < 0.0f ? SOAK : m->def->soak), m->half);
    status = solid_make(m, def, error);
    if (status != TY_OK)
        return status;
    ty_voxel_net_def net = {def->width / (float)def->divisions, RELAX, m->def->cut > 0.0f};
    status = ty_voxels_net(&m->solid, &net, &out->mesh, error);
    if (status != TY_OK)
        return status;
    attributes_write(m, out->mesh);
    ty_vec3 shift = ty_element_weigh(out);
    ty_mesh_compute_bounds(out->mesh);
    status = balls_make(m, def, seed, variant, shift, out, error);
    if (status == TY_OK)
        ty_element_enclose(out);
    return status;
}

ty_status ty_rice_field_init(const ty_element_def* def, ty_seed seed, int variant, ty_element* out, ty_error* error)
{
    making m = {.def = &def->grain, .rng = ty_rng_make(seed, 0x6669656c64, (uint64_t)variant)};
    memset(out, 0, sizeof *out);
    ty_status status = grain_make(&m, def, seed, variant, out, error);
    ty_mesh_destroy(m.base);
    ty_voxels_term(&m.skin);
    ty_voxels_term(&m.solid);
    if (status != TY_OK)
        ty_element_term(out);
    return status;
}
