// SPDX-License-Identifier: Apache-2.0
// A colour map for errors: even steps of lightness, so that twice the value looks twice as far.
#include <tsuya/base/math.h>
#include <tsuya/image/metrics.h>

static float encode_srgb(float linear)
{
    float v = ty_clamp(linear, 0.0f, 1.0f);
    return v <= 0.0031308f ? 12.92f * v : 1.055f * ty_pow(v, 1.0f / 2.4f) - 0.055f;
}

// OKLab to linear sRGB (Ottosson 2020).
static ty_rgb oklab_to_rgb(float lightness, float a, float b)
{
    float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    l *= l * l;
    m *= m * m;
    s *= s * s;
    return (ty_rgb){4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
                    -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
                    -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
}

void ty_heat_color(float s, float out[3])
{
    s = ty_clamp(s, 0.0f, 1.0f);
    float hue = ty_radians(-75.0f + 175.0f * s); // violet over red to yellow
    float chroma = 0.82f * s * (1.0f - s) * (1.0f - 0.25f * s);
    ty_rgb rgb = oklab_to_rgb(0.08f + 0.90f * s, chroma * ty_cos(hue), chroma * ty_sin(hue));
    out[0] = encode_srgb(rgb.r);
    out[1] = encode_srgb(rgb.g);
    out[2] = encode_srgb(rgb.b);
}
