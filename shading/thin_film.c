// SPDX-License-Identifier: Apache-2.0
// Interference in a thin film, as its Fourier series (Belcour & Barla 2017, "A practical extension to microfacet theory
// for the modeling of varying iridescence"), with the bands of ACEScg themselves in place of Gaussians fitted to them.
#include "thin_film.h"
#include "fresnel.h"
#include <tsuya/base/memory.h>

enum
{
    NODES_PER_MICROMETRE = 64,
    PATH_MOST = 12, // micrometres: beyond, no band tells one path from another
    NODES = NODES_PER_MICROMETRE * PATH_MOST + 3,
    WAVES = 471, // a nanometre apart
    ORDERS = 64
};

struct ty_thin_film_bands
{
    ty_rgb value[NODES]; // at (i - 1) / NODES_PER_MICROMETRE
};

static float lobe(float wavelength, float centre, float below, float above)
{
    float t = (wavelength - centre) / (wavelength < centre ? below : above);
    return ty_exp(-0.5f * t * t);
}

// Colour matching functions of 1931 (Wyman, Sloan & Shirley 2013, "Simple analytic approximations to the CIE XYZ color
// matching functions"), in the primaries of ACEScg. nm.
static ty_rgb sensitivity(float w)
{
    float x = 1.056f * lobe(w, 599.8f, 37.9f, 31.0f) + 0.362f * lobe(w, 442.0f, 16.0f, 26.7f) -
              0.065f * lobe(w, 501.1f, 20.4f, 26.2f);
    float y = 0.821f * lobe(w, 568.8f, 46.9f, 40.5f) + 0.286f * lobe(w, 530.9f, 16.3f, 31.1f);
    float z = 1.217f * lobe(w, 437.0f, 11.8f, 36.0f) + 0.681f * lobe(w, 459.0f, 26.0f, 13.8f);
    return ty_rgb_make(1.6410234f * x - 0.3248033f * y - 0.2364247f * z,
                       -0.6636629f * x + 1.6153316f * y + 0.0167563f * z,
                       0.0117219f * x - 0.0082844f * y + 0.9883949f * z);
}

ty_thin_film_bands* ty_thin_film_bands_create(void)
{
    ty_thin_film_bands* bands = TY_ALLOC(ty_thin_film_bands, 1);
    ty_rgb sum = {0};
    for (int k = 0; k < WAVES; k++)
    {
        float w = 360.0f + (float)k;
        ty_rgb part = sensitivity(w);
        sum = ty_rgb_add(sum, part);
        for (int i = 0; i < NODES; i++)
        {
            float sine, cosine, turns = (float)(i - 1) * (1000.0f / NODES_PER_MICROMETRE) / w;
            ty_sincos(2.0f * TY_PI * (turns - floorf(turns)), &sine, &cosine);
            bands->value[i] = ty_rgb_add(bands->value[i], ty_rgb_scale(part, cosine));
        }
    }
    for (int i = 0; i < NODES; i++)
        bands->value[i] = ty_rgb_make(bands->value[i].r / sum.r, bands->value[i].g / sum.g, bands->value[i].b / sum.b);
    return bands;
}

void ty_thin_film_bands_destroy(ty_thin_film_bands* bands)
{
    ty_free(bands);
}

// A cubic through four nodes (Catmull & Rom 1974).
ty_rgb ty_thin_film_bands_at(const ty_thin_film_bands* bands, float path)
{
    float s = path * NODES_PER_MICROMETRE;
    if (!(s < NODES_PER_MICROMETRE * PATH_MOST))
        return ty_rgb_grey(0.0f);
    int i = (int)s;
    float t = s - (float)i, t2 = t * t, t3 = t2 * t;
    const ty_rgb* v = bands->value + i;
    const float w[4] = {0.5f * (2.0f * t2 - t - t3), 0.5f * (2.0f - 5.0f * t2 + 3.0f * t3),
                        0.5f * (t + 4.0f * t2 - 3.0f * t3), 0.5f * (t3 - t2)};
    return ty_rgb_make(w[0] * v[0].r + w[1] * v[1].r + w[2] * v[2].r + w[3] * v[3].r,
                       w[0] * v[0].g + w[1] * v[1].g + w[2] * v[2].g + w[3] * v[3].g,
                       w[0] * v[0].b + w[1] * v[1].b + w[2] * v[2].b + w[3] * v[3].b);
}

ty_thin_film ty_thin_film_make(const ty_thin_film_bands* bands, float weight, float thickness, float ior, float outside,
                               float cover, float base)
{
    return (ty_thin_film){.bands = bands,
                          .weight = weight,
                          .path = 2.0f * ior * thickness,
                          .bend = outside / ior,
                          .index = ior / (outside * cover),
                          .turned = ty_max(base, 1.0f / base) < cover};
}

// Amplitudes at a boundary of index n without absorption: across, and in, the plane of incidence.
typedef struct amplitudes
{
    float s, p;
} amplitudes;

static amplitudes boundary(float c, float n)
{
    float ct = ty_safe_sqrt(1.0f - (1.0f - c * c) / (n * n));
    return (amplitudes){(c - n * ct) / (c + n * ct), (n * c - ct) / (n * c + ct)};
}

// That of the film's outer side; what is thinner than the coat reflects as what is denser by as much, turned.
static amplitudes outer_side(const ty_thin_film* film, float c)
{
    amplitudes a = boundary(c, ty_max(film->index, 1.0f / film->index));
    return film->index < 1.0f ? (amplitudes){-a.s, -a.p} : a;
}

// What two boundaries pass on, if the film between them delays waves by the phase p: (1 - a^2)(1 - b^2) / |1 + a b
// e^ip|^2 = (1 - a^2)(1 - b^2) / (1 - q^2) (1 + 2 sum q^m cos mp), q = -a b. b is what makes the reflection z where the
// film has no thickness: so that a film of none, or of the index of what is outside, is as if it were not there.
static void passes(float a, float z, float* scale, float* ratio)
{
    float b = (z - a) / ty_max(1.0f - a * z, 1e-6f), q = ty_clamp(-a * b, -0.9999f, 0.9999f);
    *scale = (1.0f - a * a) * (1.0f - b * b) / (1.0f - q * q);
    *ratio = q;
}

// Mean of both polarisations by channels, z being what each reflects without the film.
static ty_rgb interfere(const ty_thin_film* film, float c, const amplitudes z[3])
{
    enum
    {
        TERMS = 6
    };
    float path = film->path * ty_safe_sqrt(1.0f - (1.0f - c * c) * film->bend * film->bend);
    float scale[TERMS], ratio[TERMS], power[TERMS], sum[TERMS] = {0}, through[3], most = 1.0f;
    amplitudes a = outer_side(film, c);
    for (int i = 0; i < TERMS; i++)
    {
        passes(i & 1 ? a.p : a.s, i & 1 ? z[i / 2].p : z[i / 2].s, &scale[i], &ratio[i]);
        power[i] = 1.0f;
    }
    for (int m = 1; m <= ORDERS && (float)m * path < PATH_MOST && most > 1e-4f; m++)
    {
        ty_rgb wave = ty_thin_film_bands_at(film->bands, (float)m * path);
        const float cosine[3] = {wave.r, wave.g, wave.b};
        most = 0.0f;
        for (int i = 0; i < TERMS; i++)
        {
            power[i] *= ratio[i];
            sum[i] += power[i] * cosine[i / 2];
            most = ty_max(most, fabsf(power[i]));
        }
    }
    for (int k = 0; k < 3; k++)
        through[k] = ty_clamp(
            0.5f * (scale[2 * k] * (1.0f + 2.0f * sum[2 * k]) + scale[2 * k + 1] * (1.0f + 2.0f * sum[2 * k + 1])),
            0.0f, 1.0f);
    return ty_rgb_make(1.0f - through[0], 1.0f - through[1], 1.0f - through[2]);
}

static const float least_cosine = 1e-4f;

ty_rgb ty_thin_film_over_dielectric(const ty_thin_film* film, float cosine, float shine)
{
    float c = ty_clamp(fabsf(cosine), least_cosine, 1.0f);
    amplitudes z = boundary(c, shine);
    if (film->turned)
        z = (amplitudes){-z.s, -z.p};
    ty_rgb filmed = interfere(film, c, (const amplitudes[3]){z, z, z});
    return ty_rgb_lerp(ty_rgb_grey(ty_fresnel(c, shine)), filmed, film->weight);
}

// A metal turns waves by half a wavelength: what its colour does not say is left out.
ty_rgb ty_thin_film_over_metal(const ty_thin_film* film, float cosine, ty_rgb bare)
{
    float c = ty_clamp(fabsf(cosine), least_cosine, 1.0f);
    const float r = ty_safe_sqrt(bare.r), g = ty_safe_sqrt(bare.g), b = ty_safe_sqrt(bare.b);
    ty_rgb filmed = interfere(film, c, (const amplitudes[3]){{-r, r}, {-g, g}, {-b, b}});
    return ty_rgb_lerp(bare, filmed, film->weight);
}
