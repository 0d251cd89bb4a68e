// SPDX-License-Identifier: Apache-2.0
// Mixtures: kinds by ratio, drawn body by body.
#include "mixture.h"
#include "roe.h"
#include <stdio.h>
#include <string.h>

enum
{
    MAX_KINDS = 16,
};

static ty_status shares_set(mixture* m, const ty_element_def* defs, bool is_list, ty_error* error)
{
    double sum = 0.0;
    for (int i = 0; i < m->kind_count; i++)
        sum += is_list ? (double)defs[i].ratio : 1.0;
    if (!(sum > 0.0))
        return ty_error_set(error, TY_BAD_INPUT, "elements: the ratios sum to %g; at least one is above 0", sum);
    for (int i = 0; i < m->kind_count; i++)
        m->kinds[i].share = is_list ? (float)((double)defs[i].ratio / sum) : 1.0f;
    return TY_OK;
}

static ty_status kinds_complete(mixture* m, const ty_element_def* defs, bool is_list, ty_error* error)
{
    for (int i = 0; i < m->kind_count; i++)
    {
        char name[32] = "element";
        mixture_kind* kind = &m->kinds[i];
        if (is_list)
            (void)snprintf(name, sizeof name, "elements[%d]", i);
        kind->def = defs[i];
        ty_status status = ty_element_complete(&kind->def, name, error);
        if (status != TY_OK)
            return status;
        kind->first = m->grain_count;
        kind->count = kind->def.variants;
        m->grain_count += kind->count;
        m->width += kind->share * kind->def.width;
        m->length += kind->share * kind->def.length;
        m->thickness += kind->share * kind->def.thickness;
        m->widest = ty_max(m->widest, kind->def.width);
        m->longest = ty_max(m->longest, kind->def.length);
        m->variation = ty_max(m->variation, kind->def.variation);
    }
    return TY_OK;
}

static ty_status grains_make(mixture* m, ty_seed seed, ty_error* error)
{
    m->grains = TY_TRY_ALLOC(ty_element, m->grain_count);
    m->kind_of = TY_TRY_ALLOC(int, m->grain_count);
    if (!m->grains || !m->kind_of)
        return ty_error_set(error, TY_NO_MEMORY, "no memory for %d elements", m->grain_count);
    for (int i = 0; i < m->kind_count; i++)
        for (int v = 0; v < m->kinds[i].count; v++)
        {
            mixture_kind* kind = &m->kinds[i];
            ty_element* grain = &m->grains[kind->first + v];
            ty_seed own = {seed.value + (uint64_t)i};
            ty_status status = ty_element_init(&kind->def, own, v, grain, error);
            if (status != TY_OK)
                return status;
            m->kind_of[kind->first + v] = i;
            m->volume += kind->share * (grain->volume / (float)kind->count);
        }
    return TY_OK;
}

ty_status mixture_init(const ty_aggregate_recipe* recipe, mixture* out, ty_error* error)
{
    bool is_list = recipe->elements.count > 0;
    const ty_element_def* defs = is_list ? recipe->elements.items : &recipe->element;
    *out = (mixture){.kind_count = is_list ? recipe->elements.count : 1};
    if (out->kind_count > MAX_KINDS)
        return ty_error_set(error, TY_BAD_INPUT, "elements: %d kinds; at most %d mix", out->kind_count, MAX_KINDS);
    out->kinds = TY_ALLOC(mixture_kind, out->kind_count);
    ty_status status = shares_set(out, defs, is_list, error);
    if (status == TY_OK)
        status = kinds_complete(out, defs, is_list, error);
    if (status == TY_OK)
        status = grains_make(out, recipe->seed, error);
    if (status != TY_OK)
        mixture_term(out);
    return status;
}

bool mixture_holds_roe(const ty_aggregate_recipe* recipe)
{
    const ty_element_def* defs = recipe->elements.items;
    bool holds = recipe->elements.count == 0 && recipe->element.kind == TY_ELEMENT_ROE;
    for (int i = 0; i < recipe->elements.count; i++)
        holds |= defs[i].kind == TY_ELEMENT_ROE;
    return holds;
}

void mixture_term(mixture* m)
{
    for (int i = 0; m->grains && i < m->grain_count; i++)
        ty_element_term(&m->grains[i]);
    ty_free(m->kinds);
    ty_free(m->grains);
    ty_free(m->kind_of);
    *m = (mixture){0};
}

static const mixture_kind* kind_draw(const mixture* m, ty_rng* rng)
{
    const mixture_kind* kind = m->kinds;
    float left = m->kind_count > 1 ? ty_rng_float(rng) : 0.0f;
    for (int i = 0; i < m->kind_count; left -= m->kinds[i++].share)
        if (m->kinds[i].share > 0.0f)
        {
            kind = &m->kinds[i];
            if (left < kind->share)
                break;
        }
    return kind;
}

void mixture_draw(const mixture* m, ty_rng* rng, ty_body* body)
{
    const mixture_kind* kind = kind_draw(m, rng);
    bool rice = kind->def.kind == TY_ELEMENT_RICE; // meshes of grains differ in size already
    float spread = rice ? 0.3f : 1.0f, most = rice ? 0.1f : 0.3f;
    body->scale = 1.0f + ty_clamp(spread * kind->def.variation * ty_element_bell(rng), -most, most);
    body->grain = (uint32_t)kind->first + ty_rng_u32(rng) % (uint32_t)kind->count;
}

// --- writing ---

static bool is_roe(const mixture* m, uint32_t grain)
{
    return m->kinds[m->kind_of[grain]].def.kind == TY_ELEMENT_ROE;
}

// Materials of a mixture are given by slot: a mesh that names none has one of its kind's name.
static void slot_name(const mixture* m, const mixture_kind* kind, ty_mesh* mesh)
{
    if (m->kind_count > 1 && mesh->slot_count == 0)
        (void)ty_mesh_add_slot(mesh, ty_element_kind_name(&kind->def));
}

// The grains' meshes, then white and yolk of each kind of roe; further[kind] is the first of those.
static void prototypes_write(mixture* m, int* further, ty_aggregate* out)
{
    int next = m->grain_count;
    for (int i = 0; i < m->kind_count; i++)
    {
        const mixture_kind* kind = &m->kinds[i];
        further[i] = next;
        if (kind->def.kind == TY_ELEMENT_ROE)
        {
            ty_roe_prototypes(m->grains[kind->first].mesh, &out->prototypes[next]);
            next += TY_ROE_BODIES - 1;
        }
        for (int v = kind->first; v < kind->first + kind->count; v++)
        {
            slot_name(m, kind, m->grains[v].mesh);
            out->prototypes[v] = m->grains[v].mesh;
            m->grains[v].mesh = NULL; // now the aggregate's
        }
    }
}

static void body_write(const mixture* m, const int* further, ty_seed seed, const ty_body* b, uint32_t i,
                       const uint32_t at[TY_ROE_BODIES], ty_aggregate* out, uint32_t* owners)
{
    int kind = m->kind_of[b->grain], parts = 1;
    ty_affine maps[TY_ROE_BODIES];
    if (is_roe(m, b->grain))
    {
        ty_roe_place(&m->kinds[kind].def, seed, b, i, maps);
        parts = TY_ROE_BODIES;
    }
    else
        maps[0] = ty_affine_from_trs(b->position, b->rotation, ty_vec3_make(b->scale, b->scale, b->scale));
    for (int k = 0; k < parts; k++)
    {
        out->transforms[at[k]] = maps[k];
        out->prototype_index[at[k]] = k == 0 ? b->grain : (uint32_t)(further[kind] + k - 1);
        out->ids[at[k]] = at[k];
        owners[at[k]] = i;
    }
}

ty_aggregate* mixture_write(mixture* m, ty_seed seed, const ty_body* bodies, const ty_affine* frames, uint32_t count,
                            uint32_t** owners)
{
    uint32_t eggs = 0, egg = 0;
    int prototypes = m->grain_count, further[MAX_KINDS];
    for (uint32_t i = 0; i < count; i++)
        eggs += is_roe(m, bodies[i].grain);
    for (int i = 0; i < m->kind_count; i++)
        prototypes += m->kinds[i].def.kind == TY_ELEMENT_ROE ? TY_ROE_BODIES - 1 : 0;
    uint32_t all = count + (TY_ROE_BODIES - 1) * eggs;
    ty_aggregate* out = ty_aggregate_create(all, prototypes);
    *owners = TY_TRY_ALLOC(uint32_t, all);
    if (!out || !*owners)
    {
        ty_aggregate_destroy(out);
        ty_free(*owners);
        *owners = NULL;
        return NULL;
    }
    prototypes_write(m, further, out);
    for (uint32_t i = 0; i < count; i++)
    {
        const uint32_t at[TY_ROE_BODIES] = {i, count + egg, count + eggs + egg};
        body_write(m, further, seed, &bodies[i], i, at, out, *owners);
        if (frames && !is_roe(m, bodies[i].grain))
            out->transforms[i] = frames[i];
        egg += is_roe(m, bodies[i].grain);
    }
    return out;
}
