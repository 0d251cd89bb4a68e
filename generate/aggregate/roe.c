// SPDX-License-Identifier: Apache-2.0
// Roe: eggs of a mean size packed as balls, each a membrane with white in it and a yolk that floats in the white.
#include "roe.h"
#include <string.h>

// Sizes are our estimates of ripe eggs, the lipid share of salmon as published for a model of its eggs.
static const ty_roe_def presets[] = {
    [TY_ROE_IKURA] = {.diameter = 6.2e-3f, .membrane = 53e-6f, .yolk = 0.145f},
    [TY_ROE_TOBIKO] = {.diameter = 1.6e-3f, .membrane = 20e-6f, .yolk = 0.05f},
    [TY_ROE_TARAKO] = {.diameter = 1.0e-3f, .membrane = 15e-6f, .yolk = 0.05f},
    [TY_ROE_KAZUNOKO] = {.diameter = 1.4e-3f, .membrane = 30e-6f, .yolk = 0.1f},
};

ty_status ty_roe_complete(ty_element_def* def, ty_error* error)
{
    ty_roe_def* roe = &def->roe;
    const ty_roe_def* preset = &presets[roe->preset];
    if (roe->diameter == 0.0f)
        roe->diameter = preset->diameter;
    if (roe->membrane == 0.0f)
        roe->membrane = preset->membrane * roe->diameter / preset->diameter;
    if (roe->yolk == 0.0f)
        roe->yolk = preset->yolk;
    const double mm = 1e3;
    double diameter = (double)roe->diameter * mm, membrane = (double)roe->membrane * mm;
    if (!(diameter >= 0.2 && diameter <= 50.0))
        return ty_error_set(error, TY_BAD_INPUT,
                            "element.roe.diameter: %g mm; it lies in 0.2..50, or is 0 (the preset's)", diameter);
    if (!(membrane >= 0.001 * diameter && membrane <= 0.1 * diameter))
        return ty_error_set(error, TY_BAD_INPUT,
                            "element.roe.membrane: %g mm; with a diameter of %g mm it lies in %g..%g, or is 0 (the "
                            "preset's)",
                            membrane, diameter, 0.001 * diameter, 0.1 * diameter);
    def->length = def->width = def->thickness = roe->diameter;
    def->variants = 1;
    return TY_OK;
}

ty_status ty_roe_init(const ty_element_def* def, ty_element* out, ty_error* error)
{
    memset(out, 0, sizeof *out);
    ty_shape_def shape = ty_shape_def_default();
    shape.kind = TY_SHAPE_SPHERE;
    shape.radius = 0.5f * def->roe.diameter;
    shape.divisions = 128;
    ty_status status = ty_shape_create(&shape, &out->mesh, error);
    if (status != TY_OK)
        return status;
    (void)ty_mesh_add_slot(out->mesh, "membrane");
    float r = shape.radius;
    out->radius = out->capsule = r;
    out->width = 2.0f * r;
    out->volume = 4.0f / 3.0f * TY_PI * r * r * r;
    for (int i = 0; i < 3; i++)
        out->inverse_inertia[i] = 2.5f / (r * r); // a solid ball's
    out->ball_count = 1;
    out->balls[0].radius = r;
    return TY_OK;
}

static ty_mesh* body_mesh(const ty_mesh* membrane, const char* slot)
{
    ty_mesh* mesh = ty_mesh_copy(membrane);
    ty_free(mesh->slot_names[0]);
    mesh->slot_names[0] = ty_string_copy(slot);
    return mesh;
}

// From an upright egg to where it lies: turned about the vertical, leaning, a little lower than it is wide.
static ty_affine egg_frame(const ty_element_def* def, const ty_body* body, ty_rng* rng)
{
    float turn = ty_rng_range(rng, 0.0f, 2.0f * TY_PI), sine, cosine;
    ty_sincos(ty_rng_range(rng, 0.0f, 2.0f * TY_PI), &sine, &cosine);
    float lean = def->roe.lean * sqrtf(ty_rng_float(rng)); // about even over the cap
    ty_quat upright = ty_quat_axis_angle(ty_vec3_make(0.0f, 1.0f, 0.0f), turn);
    ty_quat leaning = ty_quat_axis_angle(ty_vec3_make(cosine, 0.0f, sine), lean);
    float flat = ty_clamp(0.2f * def->variation * ty_element_bell(rng), -0.03f, 0.03f);
    float size = body->scale * (1.0f + def->roe.press);
    ty_vec3 scale = {size * (1.0f + 0.5f * flat), size * (1.0f - flat), size * (1.0f + 0.5f * flat)};
    return ty_affine_from_trs(body->position, ty_quat_multiply(leaning, upright), scale);
}

void ty_roe_prototypes(const ty_mesh* membrane, ty_mesh* out[2])
{
    out[0] = body_mesh(membrane, "white");
    out[1] = body_mesh(membrane, "yolk");
}

// --- where the three bodies are ---

// So far from the membrane does a floating yolk stay, of the white's radius: the two meshes do not cut one another.
#define HAIR 0.006f

typedef struct egg
{
    ty_affine frame; // the membrane's
    float size;      // of an egg of mean size
    float white;     // radius against the membrane's, which has one thickness whatever the size of the egg
    float yolk;      // radius against the white's: the lipid's ball, r_i L^(1/3)
    float room;      // m, between the middles of the egg and of a yolk that floats
} egg;

static egg egg_of(const ty_element_def* def, ty_seed seed, const ty_body* body, uint32_t index)
{
    ty_rng rng = ty_rng_make(seed, 0x726f65, index);
    float r = 0.5f * def->roe.diameter;
    egg e = {.frame = egg_frame(def, body, &rng),
             .size = body->scale * (1.0f + def->roe.press),
             .white = 1.0f - def->roe.membrane / (r * body->scale),
             .yolk = ty_exp(ty_ln(def->roe.yolk) / 3.0f)};
    e.room = e.white * (1.0f - e.yolk - HAIR) * r * e.size;
    return e;
}

static ty_affine shrunk(const ty_affine* frame, float share, ty_vec3 shift)
{
    return (ty_affine){ty_mul(frame->x, share), ty_mul(frame->y, share), ty_mul(frame->z, share),
                       ty_add(frame->t, shift)};
}

// From a ball into the egg's shape: along each of its axes as much as that is longer.
static ty_vec3 shaped(const egg* e, ty_vec3 at)
{
    const ty_vec3 axes[] = {e->frame.x, e->frame.y, e->frame.z};
    ty_vec3 sum = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        sum = ty_mad(sum, axes[i], ty_dot(at, axes[i]) / (ty_length(axes[i]) * e->size));
    return sum;
}

void ty_roe_place(const ty_element_def* def, ty_seed seed, const ty_body* body, uint32_t index, const ty_yolk* yolk,
                  ty_affine out[TY_ROE_BODIES])
{
    egg e = egg_of(def, seed, body, index);
    out[0] = e.frame;
    out[1] = shrunk(&e.frame, e.white, (ty_vec3){0, 0, 0});
    ty_vec3 shift = yolk ? shaped(&e, yolk->at) : ty_mul(e.frame.y, e.room / e.size);
    out[2] = shrunk(&e.frame, e.white * e.yolk, shift);
}

// --- how a yolk floats ---

// Stokes' drag of a ball in the middle of a spherical vessel, against that without walls; share of the radii (J. Happel
// & H. Brenner 1983, "Low Reynolds number hydrodynamics", section 4-22).
static float confined(float share)
{
    float cube = share * share * share, fifth = cube * share * share;
    return (1.0f - fifth) / (1.0f - 2.25f * share + 2.5f * cube - 2.25f * fifth + cube * cube);
}

// In the egg's frame of reference both gravity and its own acceleration pull the denser liquid past the yolk:
// (m + m'/2) dw/dt = (m' - m) (dU/dt - g) - D w, with the liquid's mass m' in place of the yolk, half of which goes
// along with it. The white does not turn with its egg.
void ty_roe_float(const ty_element_def* def, ty_seed seed, const ty_body* body, uint32_t index, ty_vec3 gained,
                  float gravity, float seconds, ty_yolk* yolk)
{
    const float white_density = 1050.0f;
    egg e = egg_of(def, seed, body, index);
    float radius = e.yolk * e.white * 0.5f * def->roe.diameter * e.size,
          volume = 4.0f / 3.0f * TY_PI * ty_sqr(radius) * radius;
    float inertia = volume * (1.5f * white_density - def->roe.buoyancy);
    float drag = 6.0f * TY_PI * def->roe.viscosity * radius * confined(e.yolk);
    ty_vec3 up = ty_normalize(e.frame.y); // by lean off the vertical: yolks hang on their germs
    ty_vec3 pull = ty_mad(gained, up, gravity * seconds);
    yolk->speed = ty_mul(ty_mad(yolk->speed, pull, volume * def->roe.buoyancy / inertia),
                         1.0f / (1.0f + seconds * drag / inertia));
    yolk->at = ty_mad(yolk->at, yolk->speed, seconds);
    float off = ty_length(yolk->at);
    if (off <= e.room)
        return;
    ty_vec3 out = ty_mul(yolk->at, 1.0f / off);
    yolk->at = ty_mul(out, e.room);
    yolk->speed = ty_mad(yolk->speed, out, -ty_max(ty_dot(yolk->speed, out), 0.0f));
}
