// SPDX-License-Identifier: Apache-2.0
// Mixtures: kinds by ratio, drawn body by body.
#include "mixture.h"
#include <stdio.h>
#include <string.h>

// The elements of layer 0, which is the recipe's own, or of a later one.
typedef struct choice
{
    const ty_element_def* defs;
    int count, layer;
    bool is_list;
    char place[32]; // in the recipe, before "element"
} choice;

static choice choice_of(const ty_aggregate_recipe* recipe, int layer)
{
    choice c = {.layer = layer};
    const ty_element_def* one = &recipe->element;
    ty_param_list list = recipe->elements;
    if (layer > 0)
    {
        const ty_layer_def* def = (const ty_layer_def*)recipe->layers.items + (layer - 1);
        one = &def->element;
        list = def->elements;
        (void)snprintf(c.place, sizeof c.place, "layers[%d].", layer - 1);
    }
    c.is_list = list.count > 0;
    c.defs = c.is_list ? list.items : one;
    c.count = c.is_list ? list.count : 1;
    return c;
}

static ty_status shares_set(mixture_kind* kinds, const choice* c, ty_error* error)
{
    double sum = 0.0;
    for (int i = 0; i < c->count; i++)
        sum += c->is_list ? (double)c->defs[i].ratio : 1.0;
    if (!(sum > 0.0))
        return ty_error_set(error, TY_BAD_INPUT, "%selements: the ratios sum to %g; at least one is above 0", c->place,
                            sum);
    for (int i = 0; i < c->count; i++)
        kinds[i].share = c->is_list ? (float)((double)c->defs[i].ratio / sum) : 1.0f;
    return TY_OK;
}

static void sizes_swell(ty_element_def* def, float swelling)
{
    def->length *= swelling;
    def->width *= swelling;
    def->thickness *= swelling;
}

static ty_status kinds_complete(mixture* m, const choice* c, const ty_wetness_def* wet, float swelling, ty_error* error)
{
    mixture_kind* kinds = m->kinds + m->kind_count;
    ty_status status = shares_set(kinds, c, error);
    for (int i = 0; i < c->count && status == TY_OK; i++)
    {
        char name[64];
        (void)snprintf(name, sizeof name, c->is_list ? "%selements[%d]" : "%selement", c->place, i);
        kinds[i].def = c->defs[i];
        kinds[i].layer = c->layer;
        if (kinds[i].def.grain.soak < 0.0f && wet->soak > 0.0f)
            kinds[i].def.grain.soak = wet->soak;
        status = ty_element_complete(&kinds[i].def, name, error);
        if (kinds[i].def.kind == TY_ELEMENT_RICE)
            sizes_swell(&kinds[i].def, swelling);
        kinds[i].first = m->grain_count;
        kinds[i].count = kinds[i].def.variants;
        m->grain_count += kinds[i].count;
        m->kind_count++;
    }
    return status;
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
        }
    return TY_OK;
}

void mixture_select(mixture* m, int layer)
{
    m->volume = m->width = m->length = m->thickness = m->widest = m->longest = m->variation = 0.0f;
    for (m->first = 0; m->kinds[m->first].layer < layer; m->first++)
        ;
    for (m->end = m->first; m->end < m->kind_count && m->kinds[m->end].layer == layer; m->end++)
    {
        const mixture_kind* kind = &m->kinds[m->end];
        m->width += kind->share * kind->def.width;
        m->length += kind->share * kind->def.length;
        m->thickness += kind->share * kind->def.thickness;
        m->widest = ty_max(m->widest, kind->def.width);
        m->longest = ty_max(m->longest, kind->def.length);
        m->variation = ty_max(m->variation, kind->def.variation);
        for (int v = kind->first; v < kind->first + kind->count; v++)
            m->volume += kind->share * (m->grains[v].volume / (float)kind->count);
    }
}

ty_status mixture_init(const ty_aggregate_recipe* recipe, mixture* out, ty_error* error)
{
    *out = (mixture){0};
    int64_t kinds = 0;
    for (int layer = 0; layer <= recipe->layers.count; layer++)
        kinds += choice_of(recipe, layer).count;
    if (kinds > MIXTURE_KINDS)
        return ty_error_set(error, TY_BAD_INPUT, "%s: %lld kinds; at most %d mix",
                            recipe->layers.count > 0 ? "layers" : "elements", (long long)kinds, MIXTURE_KINDS);
    out->kinds = TY_ALLOC(mixture_kind, (int)kinds);
    float swelling = ty_mechanics_of(recipe).swelling;
    ty_status status = TY_OK;
    for (int layer = 0; layer <= recipe->layers.count && status == TY_OK; layer++)
    {
        choice c = choice_of(recipe, layer);
        status = kinds_complete(out, &c, &recipe->moisture, swelling, error);
    }
    if (status == TY_OK)
        status = grains_make(out, recipe->seed, error);
    if (status == TY_OK)
        mixture_select(out, 0);
    else
        mixture_term(out);
    return status;
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
    const mixture_kind* kind = &m->kinds[m->first];
    float left = m->end - m->first > 1 ? ty_rng_float(rng) : 0.0f;
    for (int i = m->first; i < m->end; left -= m->kinds[i++].share)
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

bool mixture_is_roe(const mixture* m, uint32_t grain)
{
    return m->kinds[m->kind_of[grain]].def.kind == TY_ELEMENT_ROE;
}

// Materials of a mixture are given by slot: a mesh that names none has the recipe's, or one of its kind's name.
static void slot_name(const mixture* m, const mixture_kind* kind, ty_mesh* mesh)
{
    const char* name = kind->def.slot ? kind->def.slot : ty_element_kind_name(&kind->def);
    if ((m->kind_count > 1 || kind->def.slot) && mesh->slot_count == 0)
        (void)ty_mesh_add_slot(mesh, name);
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

// Its instances, one or an egg's three.
static int body_maps(const mixture* m, ty_seed seed, const ty_body* b, uint32_t i, const ty_yolk* yolk,
                     ty_affine maps[TY_ROE_BODIES])
{
    if (mixture_is_roe(m, b->grain))
    {
        ty_roe_place(&m->kinds[m->kind_of[b->grain]].def, seed, b, i, yolk, maps);
        return TY_ROE_BODIES;
    }
    maps[0] = ty_affine_from_trs(b->position, b->rotation, ty_vec3_make(b->scale, b->scale, b->scale));
    return 1;
}

static uint32_t count_eggs(const mixture* m, const ty_body* bodies, uint32_t count)
{
    uint32_t eggs = 0;
    for (uint32_t i = 0; i < count; i++)
        eggs += mixture_is_roe(m, bodies[i].grain);
    return eggs;
}

// Where all instances are, each body's own first, then whites, then yolks; owners[instance] is its body.
static void bodies_place(const mixture* m, ty_seed seed, const ty_body* bodies, const ty_affine* frames,
                         const ty_yolk* yolks, uint32_t count, uint32_t* owners, ty_aggregate* out)
{
    uint32_t eggs = count_eggs(m, bodies, count), egg = 0;
    for (uint32_t i = 0; i < count; i++)
    {
        const uint32_t at[TY_ROE_BODIES] = {i, count + egg, count + eggs + egg};
        ty_affine maps[TY_ROE_BODIES];
        int parts = body_maps(m, seed, &bodies[i], i, yolks ? &yolks[i] : NULL, maps);
        for (int k = 0; k < parts; k++)
        {
            out->transforms[at[k]] = maps[k];
            owners[at[k]] = i;
        }
        if (frames && parts == 1)
            out->transforms[i] = frames[i];
        egg += parts > 1;
    }
}

// Which of its body's instances one is.
static int part_of(uint32_t instance, uint32_t count, const ty_aggregate* a)
{
    uint32_t eggs = (a->instance_count - count) / (TY_ROE_BODIES - 1);
    return instance < count ? 0 : 1 + (int)((instance - count) / eggs);
}

ty_aggregate* mixture_write(mixture* m, ty_seed seed, const ty_body* bodies, const ty_affine* frames, uint32_t count,
                            uint32_t** owners)
{
    int prototypes = m->grain_count, further[MIXTURE_KINDS];
    for (int i = 0; i < m->kind_count; i++)
        prototypes += m->kinds[i].def.kind == TY_ELEMENT_ROE ? TY_ROE_BODIES - 1 : 0;
    uint32_t all = count + (TY_ROE_BODIES - 1) * count_eggs(m, bodies, count);
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
    bodies_place(m, seed, bodies, frames, NULL, count, *owners, out);
    for (uint32_t i = 0; i < all; i++)
    {
        uint32_t grain = bodies[(*owners)[i]].grain;
        int part = part_of(i, count, out);
        out->prototype_index[i] = part == 0 ? grain : (uint32_t)(further[m->kind_of[grain]] + part - 1);
        out->ids[i] = i;
    }
    return out;
}

// The shells of eggs are shown upright, whatever way they have rolled.
void mixture_move(const mixture* m, ty_seed seed, const ty_body* bodies, const ty_affine* frames, const ty_yolk* yolks,
                  uint32_t count, uint32_t* owners, ty_aggregate* out)
{
    ty_vec3 *velocities = ty_aggregate_add_velocities(out), *spins = ty_aggregate_add_spins(out);
    bodies_place(m, seed, bodies, frames, yolks, count, owners, out);
    for (uint32_t i = 0; i < out->instance_count; i++)
    {
        const ty_body* b = &bodies[owners[i]];
        bool yolk = part_of(i, count, out) == TY_ROE_BODIES - 1;
        velocities[i] = yolk ? ty_add(b->velocity, yolks[owners[i]].speed) : b->velocity;
        spins[i] = mixture_is_roe(m, b->grain) ? (ty_vec3){0, 0, 0} : b->spin;
    }
}
