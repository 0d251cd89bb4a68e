// SPDX-License-Identifier: Apache-2.0
// How wide the kernels are: spread against x = curvature * transport mean free path and what a scattering event
// absorbs, from random walks in spheres (a million each: diffuse entry, isotropic scattering, matched index), by the
// least area-weighted square error of the response to one directional light.
#include "kernel_table.h"
#include <string.h>
#include <tsuya/base/memory.h>
#include <tsuya/shading/cdrf.h>
#include <tsuya/shading/material.h>

#define NODE_COUNT 14
#define LOSS_COUNT 13 // the last is no loss at all

static const float node_x[NODE_COUNT] = {0.016666667f, 0.03125f,    0.041666667f, 0.0625f,     0.083333333f,
                                         0.125f,       0.16666667f, 0.25f,        0.33333333f, 0.5f,
                                         0.66666667f,  1.0f,        2.0f,         4.0f};
static const float node_loss[LOSS_COUNT] = {0.5f,   0.3f,   0.2f,   0.1f,    0.05f,   0.02f, 0.01f,
                                            0.005f, 0.002f, 0.001f, 0.0003f, 0.0001f, 0.0f};

// t of the Poisson kernel.
static const float node_t[NODE_COUNT][LOSS_COUNT] = {
    {0.0003738f, 0.0005301f, 0.0006885f, 0.001049f, 0.001555f, 0.002539f, 0.003617f, 0.005111f, 0.008011f, 0.011f,
     0.01648f, 0.0197f, 0.02193f},
    {0.001328f, 0.001837f, 0.002354f, 0.003523f, 0.005167f, 0.0084f, 0.01202f, 0.01696f, 0.02501f, 0.03071f, 0.03703f,
     0.03942f, 0.04075f},
    {0.002362f, 0.003241f, 0.004131f, 0.006143f, 0.00898f, 0.0146f, 0.02084f, 0.02872f, 0.0393f, 0.04537f, 0.05108f,
     0.05301f, 0.05403f},
    {0.005375f, 0.007201f, 0.009095f, 0.01346f, 0.01974f, 0.0321f, 0.04424f, 0.05642f, 0.06854f, 0.074f, 0.07842f,
     0.07979f, 0.08049f},
    {0.009698f, 0.01279f, 0.01606f, 0.02369f, 0.03461f, 0.05447f, 0.07081f, 0.08445f, 0.09591f, 0.1005f, 0.104f,
     0.1051f, 0.1056f},
    {0.02297f, 0.02939f, 0.03651f, 0.05315f, 0.0753f, 0.1071f, 0.1265f, 0.1395f, 0.1488f, 0.1522f, 0.1547f, 0.1554f,
     0.1558f},
    {0.0433f, 0.05386f, 0.066f, 0.09311f, 0.1245f, 0.161f, 0.1795f, 0.1906f, 0.198f, 0.2006f, 0.2025f, 0.203f, 0.2033f},
    {0.1066f, 0.1251f, 0.1467f, 0.1888f, 0.2273f, 0.2621f, 0.2767f, 0.2848f, 0.2899f, 0.2916f, 0.2929f, 0.2932f,
     0.2934f},
    {0.1951f, 0.2167f, 0.2428f, 0.2886f, 0.3249f, 0.3539f, 0.3652f, 0.3712f, 0.3749f, 0.3762f, 0.3771f, 0.3773f,
     0.3775f},
    {0.4001f, 0.4119f, 0.4337f, 0.4702f, 0.4962f, 0.5152f, 0.5221f, 0.5257f, 0.528f, 0.5287f, 0.5292f, 0.5294f,
     0.5295f},
    {0.5964f, 0.591f, 0.6031f, 0.6266f, 0.6434f, 0.6555f, 0.6598f, 0.6621f, 0.6635f, 0.6639f, 0.6643f, 0.6644f,
     0.6644f},
    {0.9259f, 0.888f, 0.882f, 0.884f, 0.8881f, 0.8916f, 0.893f, 0.8937f, 0.8941f, 0.8943f, 0.8944f, 0.8944f, 0.8944f},
    {1.556f, 1.468f, 1.435f, 1.407f, 1.395f, 1.388f, 1.386f, 1.385f, 1.385f, 1.384f, 1.384f, 1.384f, 1.384f},
    {2.22f, 2.103f, 2.053f, 2.008f, 1.987f, 1.975f, 1.971f, 1.969f, 1.968f, 1.968f, 1.967f, 1.967f, 1.967f},
};

// sigma of the normalised Gaussian.
static const float node_sigma[NODE_COUNT][LOSS_COUNT] = {
    {0.01947f, 0.02076f, 0.02203f, 0.02481f, 0.02846f, 0.03483f, 0.04101f, 0.04859f, 0.06121f, 0.07249f, 0.09068f,
     0.1004f, 0.1069f},
    {0.02685f, 0.03057f, 0.03414f, 0.04156f, 0.05072f, 0.06585f, 0.08f, 0.09666f, 0.12f, 0.1349f, 0.1502f, 0.1557f,
     0.1587f},
    {0.03406f, 0.03983f, 0.04523f, 0.05607f, 0.06911f, 0.0904f, 0.1101f, 0.1317f, 0.1574f, 0.1709f, 0.1829f, 0.1869f,
     0.189f},
    {0.05197f, 0.06135f, 0.07003f, 0.08739f, 0.1084f, 0.1425f, 0.1708f, 0.1962f, 0.2194f, 0.2293f, 0.2371f, 0.2395f,
     0.2407f},
    {0.07244f, 0.08503f, 0.0969f, 0.1209f, 0.1499f, 0.1938f, 0.2251f, 0.249f, 0.268f, 0.2753f, 0.2809f, 0.2825f,
     0.2834f},
    {0.1188f, 0.1371f, 0.1553f, 0.1925f, 0.2348f, 0.2875f, 0.3166f, 0.3352f, 0.348f, 0.3527f, 0.356f, 0.357f, 0.3575f},
    {0.1713f, 0.1944f, 0.2185f, 0.2661f, 0.3147f, 0.3656f, 0.3897f, 0.4038f, 0.4131f, 0.4164f, 0.4187f, 0.4193f,
     0.4197f},
    {0.2884f, 0.3164f, 0.3472f, 0.4028f, 0.4501f, 0.4907f, 0.5073f, 0.5164f, 0.5221f, 0.5241f, 0.5255f, 0.5259f,
     0.5261f},
    {0.4114f, 0.438f, 0.469f, 0.5213f, 0.5613f, 0.5926f, 0.6046f, 0.611f, 0.615f, 0.6163f, 0.6173f, 0.6175f, 0.6177f},
    {0.6422f, 0.6544f, 0.6771f, 0.7149f, 0.7417f, 0.7611f, 0.7683f, 0.772f, 0.7743f, 0.775f, 0.7756f, 0.7757f, 0.7758f},
    {0.8442f, 0.8388f, 0.8512f, 0.8752f, 0.8924f, 0.9046f, 0.9091f, 0.9114f, 0.9128f, 0.9132f, 0.9136f, 0.9137f,
     0.9137f},
    {1.166f, 1.132f, 1.127f, 1.129f, 1.133f, 1.136f, 1.137f, 1.138f, 1.138f, 1.138f, 1.138f, 1.139f, 1.139f},
    {1.63f, 1.576f, 1.555f, 1.537f, 1.529f, 1.525f, 1.524f, 1.523f, 1.523f, 1.523f, 1.522f, 1.522f, 1.522f},
    {1.995f, 1.937f, 1.912f, 1.888f, 1.877f, 1.871f, 1.869f, 1.868f, 1.867f, 1.867f, 1.867f, 1.867f, 1.867f},
};

// Logarithm of the value in row x of a table, linear in the logarithm of the loss; below the least node in the loss
// itself, as diffusion has it.
static float along_loss(const float row[LOSS_COUNT], float loss)
{
    int i = 0;
    while (i < LOSS_COUNT - 2 && loss < node_loss[i + 1])
        i++;
    float share = i == LOSS_COUNT - 2 ? 1.0f - loss / node_loss[i]
                                      : ty_ln(loss / node_loss[i]) / ty_ln(node_loss[i + 1] / node_loss[i]);
    return ty_lerp(ty_ln(row[i]), ty_ln(row[i + 1]), ty_clamp(share, 0.0f, 1.0f));
}

static float interpolate(const float table[NODE_COUNT][LOSS_COUNT], float x, float loss)
{
    int i = 0;
    while (i < NODE_COUNT - 2 && x > node_x[i + 1])
        i++;
    float share = ty_ln(x / node_x[i]) / ty_ln(node_x[i + 1] / node_x[i]);
    return ty_exp(ty_lerp(along_loss(table[i], loss), along_loss(table[i + 1], loss), share));
}

float ty_cdrf_poisson_t(float x, float loss)
{
    // Below the table the depth is a fixed share of the mean free path, as on a plane; 4/3 of it without loss.
    if (x < node_x[0])
        return ty_max(x, 0.0f) / node_x[0] * ty_exp(along_loss(node_t[0], loss));
    return interpolate(node_t, x, loss);
}

float ty_cdrf_gaussian_sigma(float x, float loss)
{
    return x > 0.0f ? interpolate(node_sigma, x, loss) : 0.0f;
}

// Index-matched albedo of a half space whose boundary reflects the share `internal` back in, then the albedo of single
// scattering that gives it: the inversion of Hyperion's walk for isotropic scattering (Chiang, Kutz & Burley 2016 in
// the form that holds up to white).
float ty_cdrf_loss(float color, float internal)
{
    float c = ty_clamp(color, 0.0f, 1.0f), a = c / (1.0f - internal + internal * c);
    float s = 4.09712f + 4.20863f * a - sqrtf(9.59217f + a * (41.6808f + 17.7126f * a));
    return ty_clamp(s * s, 0.0f, 1.0f);
}

// --- the tables resampled so that the bits of x and the loss say where to look ---

#define BITS 2 // log2 of the nodes between two powers of two
#define X_LOW (-10)
#define X_HIGH 5
#define X_COUNT (((X_HIGH - X_LOW) << BITS) + 1)
#define L_LOW (-14)
#define L_COUNT (((-1 - L_LOW) << BITS) + 2) // from none, then 2^-14 .. 1/2

struct ty_spread_table
{
    float values[L_COUNT][X_COUNT];
};

static float node_at(int low, int i)
{
    uint32_t bits = (uint32_t)(((low + 127) << BITS) + i) << (23 - BITS);
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

ty_spread_table* ty_spread_table_create(int kernel)
{
    ty_spread_table* table = TY_ALLOC(ty_spread_table, 1);
    for (int j = 0; j < L_COUNT; j++)
        for (int i = 0; i < X_COUNT; i++)
        {
            float x = node_at(X_LOW, i), loss = j == 0 ? 0.0f : node_at(L_LOW, j - 1);
            if (kernel == TY_CDRF_POISSON)
                table->values[j][i] = 1.0f - ty_exp(-ty_cdrf_poisson_t(x, loss));
            else
                table->values[j][i] = ty_cdrf_gaussian_sigma(x, loss);
        }
    return table;
}

void ty_spread_table_destroy(ty_spread_table* table)
{
    ty_free(table);
}

// The cell of v, and where in it. v is at least the lowest node.
static inline int cell_of(float v, int low, float* share)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    *share = (float)(bits & ((1u << (23 - BITS)) - 1u)) * (1.0f / (float)(1u << (23 - BITS)));
    return (int)(bits >> (23 - BITS)) - ((low + 127) << BITS);
}

float ty_spread_table_at(const ty_spread_table* table, float x, float loss)
{
    const float least = 1.0f / (float)(1 << -X_LOW), most = (float)(1 << X_HIGH) * 0.999999f;
    float fx, fl = loss * (float)(1 << -L_LOW), scale = x < least ? ty_max(x, 0.0f) / least : 1.0f;
    int i = cell_of(ty_clamp(x, least, most), X_LOW, &fx), j = 0;
    if (fl > 1.0f)
        j = 1 + cell_of(ty_min(loss, 0.4999999f), L_LOW, &fl);
    const float *a = &table->values[j][i], *b = &table->values[j + 1][i];
    float low = ty_lerp(a[0], a[1], fx);
    return scale * (fl > 0.0f ? ty_lerp(low, ty_lerp(b[0], b[1], fx), fl) : low);
}
