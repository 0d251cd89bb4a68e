// SPDX-License-Identifier: Apache-2.0
// The elastic solver's bodies and its substep: predict, project each constraint once, take velocities from the motion.
#include "xpbd_state.h"
#include <string.h>

ty_xpbd_def ty_xpbd_def_default(void)
{
    return (ty_xpbd_def){.gravity = {0.0f, -9.81f, 0.0f},
                         .rate = 6000.0f,
                         .friction = 0.5f,
                         .modulus = 3e5f,
                         .density = 1100.0f,
                         .damping = 4e-4f,
                         .push_out = 0.1f,
                         .bridge = ty_bridge_def_default()};
}

ty_xpbd* ty_xpbd_create(const ty_xpbd_def* def)
{
    TY_ASSERT(def->rate > 0.0f && def->modulus > 0.0f);
    ty_xpbd* x = TY_ALLOC(ty_xpbd, 1);
    x->def = *def;
    x->stale = true;
    x->cohesive = (def->bridge.tension > 0.0f && def->bridge.volume > 0.0f) || def->bridge.adhesion > 0.0f;
    x->margin = XPBD_MARGIN;
    x->squeeze = ty_vec3_make(1.0f, 1.0f, 1.0f);
    x->lid = TY_FLOAT_MAX;
    return x;
}

void ty_xpbd_destroy(ty_xpbd* x)
{
    if (!x)
        return;
    void* arrays[] = {x->particles, x->rest,    x->bodies,      x->stretches, x->bends,       x->triangles,
                      x->nears,     x->couples, x->old_couples, x->order,     x->blocks.first};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        ty_free(arrays[i]);
    ty_free(x);
}

// --- bodies ---

static void particles_add(ty_xpbd* x, const ty_soft_body* made, const ty_affine* frame, ty_vec3 velocity, soft* body)
{
    float scale = body->scale, cube = scale * scale * scale;
    list_reserve((void**)&x->particles, &x->particle_capacity, x->particle_count + made->ball_count, sizeof(particle));
    list_reserve((void**)&x->rest, &x->rest_capacity, x->particle_count + made->ball_count, sizeof(ty_vec3));
    for (int i = 0; i < made->ball_count; i++)
    {
        const ty_ball* ball = &made->balls[i];
        float mass = made->masses[i] * cube;
        particle* p = &x->particles[x->particle_count];
        *p = (particle){.x = ty_map_point(frame, ball->center), .v = velocity, .radius = ball->radius * scale};
        p->inverse_mass = mass > 0.0f ? 1.0f / mass : 0.0f;
        x->rest[x->particle_count++] = ty_mul(ball->center, scale);
        if (x->cohesive)
            x->margin = ty_max(x->margin, 1.2f * ty_bridge_end(&x->def.bridge, p->radius));
        body->mass += mass;
        body->fixed = body->fixed || mass <= 0.0f;
        body->rest_center = ty_mad(body->rest_center, ball->center, mass * scale);
    }
    body->rest_center = body->mass > 0.0f ? ty_mul(body->rest_center, 1.0f / body->mass) : body->rest_center;
}

// Compliances of l / (E A), l^3 / (E I) and V / K go with 1 / scale, 1 / scale and the volume.
static void constraints_add(ty_xpbd* x, const ty_soft_body* made, const soft* body)
{
    float scale = body->scale;
    list_reserve((void**)&x->stretches, &x->stretch_capacity, x->stretch_count + made->stretch_count,
                 sizeof(ty_stretch));
    for (int i = 0; i < made->stretch_count; i++)
    {
        ty_stretch s = made->stretches[i];
        s.length *= scale;
        s.compliance /= scale;
        x->stretches[x->stretch_count++] = s;
    }
    list_reserve((void**)&x->bends, &x->bend_capacity, x->bend_count + made->bend_count, sizeof(ty_bend));
    for (int i = 0; i < made->bend_count; i++)
    {
        ty_bend b = made->bends[i];
        b.rest = ty_mul(b.rest, scale);
        b.compliance /= scale;
        x->bends[x->bend_count++] = b;
    }
    list_reserve((void**)&x->triangles, &x->triangle_capacity, x->triangle_count + made->triangle_count,
                 sizeof *x->triangles);
    for (int i = 0; i < made->triangle_count; i++)
        memcpy(x->triangles[x->triangle_count++], made->triangles[i], sizeof *x->triangles);
}

int ty_xpbd_add(ty_xpbd* x, const ty_soft_body* made, ty_vec3 position, ty_quat rotation, float scale, ty_vec3 velocity)
{
    TY_ASSERT(made->ball_count > 0 && made->ball_count <= TY_ELEMENT_MAX_BALLS);
    soft body = {.first = x->particle_count,
                 .count = made->ball_count,
                 .stretch_first = x->stretch_count,
                 .stretch_count = made->stretch_count,
                 .bend_first = x->bend_count,
                 .bend_count = made->bend_count,
                 .triangle_first = x->triangle_count,
                 .triangle_count = made->triangle_count,
                 .match = made->match * scale,
                 .bulk = made->bulk,
                 .scale = scale,
                 .rotation = rotation};
    ty_affine frame = ty_affine_from_trs(position, rotation, ty_vec3_make(scale, scale, scale));
    particles_add(x, made, &frame, velocity, &body);
    constraints_add(x, made, &body);
    list_reserve((void**)&x->bodies, &x->body_capacity, x->body_count + 1, sizeof(soft));
    x->bodies[x->body_count] = body;
    if (made->triangle_count > 0)
        x->bodies[x->body_count].volume = made->swell * ty_xpbd_volume(x, x->body_count);
    xpbd_body_measure(x, &x->bodies[x->body_count]);
    x->stale = true;
    return x->body_count++;
}

void ty_xpbd_push(ty_xpbd* x, int number, ty_vec3 force)
{
    x->particles[number].force = force;
}

int ty_xpbd_body_count(const ty_xpbd* x)
{
    return x->body_count;
}

int ty_xpbd_particle_count(const ty_xpbd* x)
{
    return x->particle_count;
}

int ty_xpbd_first_particle(const ty_xpbd* x, int body)
{
    return x->bodies[body].first;
}

ty_vec3 ty_xpbd_position(const ty_xpbd* x, int number)
{
    return x->particles[number].x;
}

ty_vec3 ty_xpbd_velocity(const ty_xpbd* x, int number)
{
    return x->particles[number].v;
}

void ty_xpbd_squeeze(ty_xpbd* x, ty_vec3 center, ty_vec3 share)
{
    TY_ASSERT(x->def.container);
    ty_bounds b = ty_container_interior(x->def.container);
    ty_vec3 size = ty_sub(b.high, b.low), change = ty_sub(share, x->squeeze);
    x->moved += ty_length(ty_mul3(change, size)); // centre lies within: no wall moves farther
    x->squeeze = share;
    x->squeeze_center = center;
}

void ty_xpbd_lid(ty_xpbd* x, float height)
{
    x->moved += fabsf(height - x->lid);
    x->lid = height;
}

// --- the substep ---

static void bodies_project(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    ty_xpbd* x = context;
    float h = 1.0f / x->def.rate;
    for (int64_t i = begin; i < end; i++)
    {
        soft* body = &x->bodies[i];
        for (particle* p = x->particles + body->first; p < x->particles + body->first + body->count; p++)
        {
            p->shift = ty_vec3_make(0.0f, 0.0f, 0.0f);
            if (p->inverse_mass <= 0.0f)
                continue;
            p->v = ty_mad(ty_mad(p->v, x->def.gravity, h), p->force, h * p->inverse_mass);
            particle_move(p, p->v, h);
        }
        xpbd_body_solve(x, body);
    }
}

static void bodies_finish(void* context, int64_t begin, int64_t end, int worker)
{
    (void)worker;
    ty_xpbd* x = context;
    for (int64_t i = begin; i < end; i++)
    {
        soft* body = &x->bodies[i];
        for (particle* p = x->particles + body->first; p < x->particles + body->first + body->count; p++)
            p->v = ty_mul(p->shift, x->def.rate);
        xpbd_body_measure(x, body);
    }
}

static void for_bodies(ty_xpbd* x, ty_workers* workers, ty_range_fn* fn)
{
    enum
    {
        WORTH_SHARING = 256,
        PIECE = 64,
    };
    bool share = x->body_count >= WORTH_SHARING;
    ty_parallel_for(share ? workers : NULL, x->body_count, share ? PIECE : x->body_count + 1, fn, x);
}

void ty_xpbd_step(ty_xpbd* x, ty_workers* workers)
{
    float fastest = 0.0f, h = 1.0f / x->def.rate;
    for (int i = 0; i < x->body_count; i++)
        fastest = ty_max(fastest, x->bodies[i].fastest);
    fastest += ty_length(x->def.gravity) * h;
    if (x->stale || x->moved + fastest * h > 0.5f * XPBD_MARGIN)
        xpbd_detect(x);
    x->moved += fastest * h;
    for_bodies(x, workers, bodies_project);
    xpbd_contacts_solve(x, workers);
    for_bodies(x, workers, bodies_finish);
}

// --- sums ---

double ty_xpbd_energy(const ty_xpbd* x, bool elastic)
{
    double sum = elastic ? xpbd_contacts_energy(x) : 0.0;
    for (int i = 0; i < x->particle_count; i++)
    {
        const particle* p = &x->particles[i];
        if (p->inverse_mass > 0.0f)
            sum += (0.5 * (double)ty_length_sqr(p->v) - (double)ty_dot(p->x, x->def.gravity)) / (double)p->inverse_mass;
    }
    for (int i = 0; i < x->body_count && elastic; i++)
        sum += xpbd_body_energy(x, &x->bodies[i]);
    return sum;
}

ty_vec3 ty_xpbd_momentum(const ty_xpbd* x)
{
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < x->particle_count; i++)
        if (x->particles[i].inverse_mass > 0.0f)
            sum = ty_mad(sum, x->particles[i].v, 1.0f / x->particles[i].inverse_mass);
    return sum;
}

ty_vec3 ty_xpbd_spin(const ty_xpbd* x)
{
    ty_vec3 sum = {0.0f, 0.0f, 0.0f};
    for (int i = 0; i < x->particle_count; i++)
    {
        const particle* p = &x->particles[i];
        if (p->inverse_mass > 0.0f)
            sum = ty_mad(sum, ty_cross(p->x, p->v), 1.0f / p->inverse_mass);
    }
    return sum;
}

void ty_xpbd_speeds(const ty_xpbd* x, float* rms, float* largest)
{
    double sum = 0.0;
    float most = 0.0f;
    for (int i = 0; i < x->particle_count; i++)
    {
        float square = ty_length_sqr(x->particles[i].v);
        sum += (double)square;
        most = ty_max(most, square);
    }
    *rms = x->particle_count > 0 ? (float)sqrt(sum / x->particle_count) : 0.0f;
    *largest = sqrtf(most);
}
