// SPDX-License-Identifier: Apache-2.0
// The state of an aggregate in the making: written where time runs out, and gone on from. Bytes of a checked head, what
// the making itself remembers, and the pile.
#include "kit.h"
#include <stddef.h>
#include <string.h>
#include <tsuya/base/hash.h>

static const char magic[8] = "tsuyaAG1";

typedef struct saved_kit
{
    char magic[8];
    ty_hash checksum; // of all behind it
    ty_hash build;    // of the program
    ty_hash recipe;
    ty_rng rng;
    double spread;
    int32_t layer, round, count, lost, replaced, removed;
    int32_t wanted[MIXTURE_KINDS];
    float top[4], start_repeat;
    uint32_t top_turned;
    ty_pile_metrics start;
} saved_kit;

enum
{
    CHECKED_FROM = offsetof(saved_kit, build),
};

// --- what it is of ---

static ty_hash build_hash(void)
{
    const size_t sizes[2] = {sizeof(saved_kit), sizeof(ty_pile_metrics)};
    ty_hasher* hasher = ty_hasher_create();
    ty_hasher_add_string(hasher, TSUYA_VERSION);
    ty_hasher_add_string(hasher, AGGREGATE_BUILD_ID);
    ty_hasher_add(hasher, sizes, sizeof sizes);
    return ty_hasher_end(hasher);
}

static void elements_add(const mixture* m, ty_hasher* hasher)
{
    for (int i = 0; i < m->grain_count; i++)
    {
        const ty_element* e = &m->grains[i];
        ty_hasher_add(hasher, e->mesh->positions, e->mesh->vertex_count * sizeof(ty_vec3));
        ty_hasher_add(hasher, e->mesh->triangles, e->mesh->triangle_count * sizeof e->mesh->triangles[0]);
        ty_hasher_add(hasher, e->balls, (size_t)e->ball_count * sizeof e->balls[0]);
        ty_hasher_add(hasher, &e->volume, sizeof e->volume);
        ty_hasher_add(hasher, e->inverse_inertia, sizeof e->inverse_inertia);
    }
}

// Its walls, felt at points all over it: a mesh may be another one under the same name.
static void container_add(const ty_container* container, ty_hasher* hasher)
{
    enum
    {
        POINTS = 512,
    };
    ty_bounds box = ty_container_interior(container);
    ty_rng rng = ty_rng_make((ty_seed){0x77616c6c}, 0, 0);
    for (int i = 0; i < POINTS; i++)
    {
        ty_vec3 p, n;
        p.x = ty_rng_range(&rng, box.low.x, box.high.x);
        p.y = ty_rng_range(&rng, box.low.y, box.high.y);
        p.z = ty_rng_range(&rng, box.low.z, box.high.z);
        for (int w = 0; w < ty_container_wall_count(container); w++)
        {
            float distance = ty_container_wall(container, w, p, &n);
            ty_hasher_add(hasher, &distance, sizeof distance);
        }
    }
}

static ty_hash recipe_hash(const kit* k)
{
    static const char* const free_rows[] = {"settle.max_seconds", "settle.state", "settle.watch", "container.cut",
                                            NULL};
    ty_hasher* hasher = ty_hasher_create();
    ty_params_add_to_hash(&ty_aggregate_recipe_table, k->recipe, free_rows, hasher);
    elements_add(&k->mix, hasher);
    container_add(k->container, hasher);
    return ty_hasher_end(hasher);
}

static bool same_hash(ty_hash a, ty_hash b)
{
    return a.low == b.low && a.high == b.high;
}

// --- keeping ---

static void kit_put(const kit* k, saved_kit* s)
{
    memcpy(s->magic, magic, sizeof magic);
    s->build = build_hash();
    s->recipe = recipe_hash(k);
    s->rng = k->rng;
    s->spread = k->spread;
    s->layer = k->layer, s->round = k->round, s->count = k->count;
    s->lost = k->lost, s->replaced = k->replaced, s->removed = k->removed;
    for (int i = 0; i < MIXTURE_KINDS; i++)
        s->wanted[i] = k->wanted[i];
    s->top[0] = k->top.level, s->top[1] = k->top.crown;
    s->top[2] = k->top.radius_x, s->top[3] = k->top.radius_z;
    s->top_turned = k->top.turned;
    s->start = k->start;
    s->start_repeat = k->start_repeat;
}

// The first state at which time ran out is the one that more time would change; before that, the latest at rest, or the
// fill.
ty_status kit_keep(kit* k, bool out_of_time, ty_error* error)
{
    if (!k->recipe->settle.state || k->out_of_time)
        return TY_OK;
    ty_bytes pile;
    ty_status status = ty_pile_save(k->pile, &pile, error);
    if (status != TY_OK)
        return status;
    ty_bytes_term(&k->state);
    size_t size = sizeof(saved_kit) + pile.size;
    k->state = (ty_bytes){TY_TRY_ALLOC(uint8_t, size + 1), size};
    if (k->state.data)
    {
        saved_kit s;
        memset(&s, 0, sizeof s); // gaps too: the bytes are hashed
        kit_put(k, &s);
        memcpy(k->state.data + sizeof s, pile.data, pile.size);
        memcpy(k->state.data, &s, sizeof s);
        s.checksum = ty_hash_bytes(k->state.data + CHECKED_FROM, size - CHECKED_FROM);
        memcpy(k->state.data, &s, sizeof s);
        k->out_of_time = out_of_time;
    }
    else
        status = ty_error_set(error, TY_NO_MEMORY, "no memory for the state of %d grains", k->count);
    ty_bytes_term(&pile);
    return status;
}

// --- going on ---

static ty_status head_check(const kit* k, const saved_kit* s, const uint8_t* bytes, size_t size, ty_error* error)
{
    if (memcmp(s->magic, magic, sizeof magic) != 0 || !same_hash(s->build, build_hash()))
        return ty_error_set(error, TY_BAD_FILE,
                            "the state to go on from is of another version of tsuya (this is %s, %s)", TSUYA_VERSION,
                            AGGREGATE_BUILD_ID);
    if (!same_hash(s->checksum, ty_hash_bytes(bytes + CHECKED_FROM, size - CHECKED_FROM)))
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is damaged: the checksum does not fit");
    if (!same_hash(s->recipe, recipe_hash(k)))
        return ty_error_set(
            error, TY_BAD_INPUT,
            "the state to go on from is of another recipe: only settle.max_seconds, settle.watch and container.cut "
            "may differ from the one in the file (tsuya info --recipe)");
    bool good = s->layer >= 0 && s->layer <= k->recipe->layers.count && s->count >= 1 && s->count <= TY_FILL_MOST;
    good = good && s->round >= 0 && s->round < 1000 && s->lost >= 0 && s->replaced >= 0 && isfinite(s->spread);
    for (int i = 0; i < MIXTURE_KINDS; i++)
        good = good && s->wanted[i] >= 0 && s->wanted[i] <= TY_FILL_MOST;
    for (int i = 0; i < 4; i++)
        good = good && isfinite(s->top[i]);
    return good ? TY_OK : ty_error_set(error, TY_BAD_FILE, "the state to go on from is damaged");
}

static void kit_take(kit* k, const saved_kit* s)
{
    k->rng = s->rng;
    k->spread = s->spread;
    k->layer = s->layer, k->round = s->round, k->count = s->count;
    k->lost = s->lost, k->replaced = s->replaced, k->removed = s->removed;
    for (int i = 0; i < MIXTURE_KINDS; i++)
        k->wanted[i] = s->wanted[i];
    k->top = (ty_fill_top){s->top[0], s->top[1], s->top[2], s->top[3], s->top_turned};
    k->start = s->start;
    k->start_repeat = s->start_repeat;
    k->resumed = true;
}

ty_status kit_resume(kit* k, const void* state, size_t size, ty_error* error)
{
    saved_kit s;
    if (size < sizeof s)
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is cut off: %zu bytes", size);
    memcpy(&s, state, sizeof s);
    ty_status status = head_check(k, &s, state, size, error);
    if (status == TY_OK)
        status = ty_pile_restore(k->pile, (const uint8_t*)state + sizeof s, size - sizeof s, k->workers, error);
    if (status != TY_OK)
        return status;
    if (ty_pile_count(k->pile) != s.count)
        return ty_error_set(error, TY_BAD_FILE, "the state to go on from is damaged: %d bodies for %d",
                            ty_pile_count(k->pile), s.count);
    kit_take(k, &s);
    kit_layer_select(k, s.layer);
    return TY_OK;
}
