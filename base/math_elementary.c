// SPDX-License-Identifier: Apache-2.0
// sin, exp and their like from + - * / alone, in double, so that every CPU and library gives the same bits.
// The polynomials are Chebyshev fits made with 30 digits; the error named is the largest on the interval.
#include <string.h>
#include <tsuya/base/math.h>

static const double pi = 3.14159265358979323846;

static double double_from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof(value));
    return value;
}

// --- sine and cosine ---

// sin(r) for |r| <= pi/4, relative error 4.4e-12.
static double sine_kernel(double r)
{
    double s = r * r;
    return r * (0.99999999999567308 +
                s * (-0.16666666631591165 +
                     s * (0.0083333287824588803 + s * (-0.000198392022122311 + s * 2.7173456841089953e-6))));
}

// cos(r) for |r| <= pi/4, error 4.8e-11.
static double cosine_kernel(double r)
{
    double s = r * r;
    return 0.99999999995248942 +
           s * (-0.49999999614857608 +
                s * (0.041666616692532826 + s * (-0.0013886617999647076 + s * 2.4379831251175366e-5)));
}

// x = quadrant * pi/2 + *r with |*r| <= pi/4 (Cody and Waite 1980): the high part has 33 bits, so that its product with
// a quadrant below 2^20 is exact.
static int quadrant_of(float x, double* r)
{
    const double high = 0x1.921fb544p+0, low = 0x1.0b4611a626331p-34;
    double d = x;
    if (fabs(d) > 1e6)
        d = fmod(d, 2.0 * pi); // exact, hence also the same everywhere; of use for no more than staying in [-1, 1]
    double n = floor(d * (2.0 / pi) + 0.5);
    *r = (d - n * high) - n * low;
    return (int)n & 3;
}

void ty_sincos(float x, float* sine, float* cosine)
{
    if (!isfinite(x))
    {
        *sine = *cosine = NAN;
        return;
    }
    double r;
    int quadrant = quadrant_of(x, &r);
    double s = sine_kernel(r), c = cosine_kernel(r);
    double swapped_s = quadrant & 1 ? c : s, swapped_c = quadrant & 1 ? s : c;
    *sine = (float)(quadrant & 2 ? -swapped_s : swapped_s);
    *cosine = (float)((quadrant + 1) & 2 ? -swapped_c : swapped_c);
}

float ty_sin(float x)
{
    float sine, cosine;
    ty_sincos(x, &sine, &cosine);
    return sine;
}

float ty_cos(float x)
{
    float sine, cosine;
    ty_sincos(x, &sine, &cosine);
    return cosine;
}

// --- exponential, logarithm, power ---

// exp(x) for |x| <= 700, relative error 4.3e-11: x = n ln 2 + r with |r| <= ln(2)/2.
static double exp_kernel(double x)
{
    const double high = 0x1.62e42fefa2p-1, low = 0x1.9ef35793c7673p-41;
    double n = floor(x * 0x1.71547652b82fep+0 + 0.5);
    double r = (x - n * high) - n * low;
    double p = 0.00019907569310848289;
    p = p * r + 0.0013948578326459796;
    p = p * r + 0.008333283538708527;
    p = p * r + 0.041666218319291947;
    p = p * r + 0.16666666786308586;
    p = p * r + 0.50000001077291653;
    p = p * r + 0.99999999999550904;
    p = p * r + 0.99999999995956175;
    return p * double_from_bits((uint64_t)((int64_t)n + 1023) << 52);
}

// The float of exp(x), with overflow at FLT_MAX and everything below the normal numbers at 0 (as with flush-to-zero).
static float exp_saturated(double x)
{
    if (x >= 88.722839)
        return TY_FLOAT_MAX;
    if (x <= -87.336544)
        return 0.0f;
    return isnan(x) ? NAN : (float)exp_kernel(x);
}

float ty_exp(float x)
{
    return exp_saturated(x);
}

// log(x) for a normal double x > 0: x = 2^n m with m in [sqrt(1/2), sqrt(2)), log m = 2 artanh((m-1)/(m+1)).
static double log_kernel(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof(bits));
    // Subtracting the bits of sqrt(1/2) makes the exponent field turn over there.
    const uint64_t sqrt_half = 0x3fe6a09e667f3bcdull;
    int64_t n = (int64_t)(bits - sqrt_half) >> 52;
    double m = double_from_bits(bits - ((uint64_t)n << 52));
    double t = (m - 1.0) / (m + 1.0), s = t * t;
    double p = 0.19608095639753053; // relative error 2.7e-14
    p = p * s + 0.2217424991007749;
    p = p * s + 0.28572166145875725;
    p = p * s + 0.39999994891832383;
    p = p * s + 0.66666666679579252;
    p = p * s + 1.9999999999999472;
    return (double)n * 0.69314718055994530942 + t * p;
}

float ty_ln(float x)
{
    if (x <= 0.0f)
        return -TY_FLOAT_MAX;
    return x <= TY_FLOAT_MAX ? (float)log_kernel(x) : x;
}

float ty_pow(float x, float y)
{
    if (y == 0.0f || x == 1.0f)
        return 1.0f;
    if (x <= 0.0f)
        return y > 0.0f ? 0.0f : TY_FLOAT_MAX;
    if (x > TY_FLOAT_MAX)
        return y > 0.0f ? TY_FLOAT_MAX : 0.0f;
    return exp_saturated((double)y * log_kernel(x));
}

// --- inverse functions ---

// The angle of (x, y), both >= 0 and not both 0, 0..pi/2, relative error 3e-11.
static double angle_kernel(double y, double x)
{
    const double tan_pi_8 = 0.41421356237309504880;
    double small = y < x ? y : x, large = y < x ? x : y, base = 0.0, t;
    if (small > tan_pi_8 * large)
    {
        base = 0.25 * pi; // atan(a) = pi/4 + atan((a - 1) / (a + 1))
        t = (small - large) / (small + large);
    }
    else
        t = small / large;
    double s = t * t, p = 0.047073481419680202;
    p = p * s - 0.08456192886940496;
    p = p * s + 0.1104048922721824;
    p = p * s - 0.14281588772654124;
    p = p * s + 0.19999883856551303;
    p = p * s - 0.33333332097609386;
    p = p * s + 0.99999999997839878;
    double angle = base + t * p;
    return y < x ? angle : 0.5 * pi - angle;
}

float ty_atan2(float y, float x)
{
    if (isnan(x) || isnan(y))
        return NAN;
    double ay = fabs((double)y), ax = fabs((double)x);
    if (isinf(y) || isinf(x)) // the directions of the limits: (inf, inf) lies at pi/4
    {
        ay = isinf(y) ? 1.0 : 0.0;
        ax = isinf(x) ? 1.0 : 0.0;
    }
    double angle = ax == 0.0 && ay == 0.0 ? 0.0 : angle_kernel(ay, ax);
    return copysignf((float)(signbit(x) ? pi - angle : angle), y);
}

float ty_acos(float x)
{
    if (isnan(x))
        return x;
    double c = ty_clamp(x, -1.0f, 1.0f);
    double angle = angle_kernel(sqrt((1.0 - c) * (1.0 + c)), fabs(c));
    return (float)(c < 0.0 ? pi - angle : angle);
}

// --- error function ---

static double polynomial(const double* coefficients, int count, double x)
{
    double p = coefficients[0];
    for (int i = 1; i < count; i++)
        p = p * x + coefficients[i];
    return p;
}

float ty_erf(float x)
{
    // erf(x)/x in x^2 on [0, 1], error 3.4e-11; erf in x - 1.5 on [1, 2], 2.9e-10; erf in x - 3 on [2, 4], 9.2e-10.
    static const double near[] = {-9.6670445714869964e-6, 0.00011265959025606609, -0.00084840804055351063,
                                  0.0052210318078580228,  -0.026865430727670243,  0.11283782495236845,
                                  -0.3761263846802871,    1.1283791670615434};
    static const double middle[] = {0.0015553907845944761, -0.0024021882670341764, -0.0047095939351845238,
                                    0.019333558749802504,  -0.01486926067382483,   -0.044599468498182592,
                                    0.13875209686532508,   -0.17839541546606564,   0.11893028875994793,
                                    0.96610514638412437};
    static const double far[] = {-9.6209028347094792e-6,  2.2144843209466167e-5,  1.2318377594487275e-5,
                                 -0.00014119153307073672, 0.00039145763593306041, -0.00073494031914975218,
                                 0.0010163322020633269,   -0.0010450971172969439, 0.00078911936610532091,
                                 -0.00041770036069830809, 0.00013925279087845417, 0.99997790868945964};
    double a = fabs((double)x), y;
    if (isnan(x))
        return x;
    if (a < 1.0)
        y = a * polynomial(near, 8, a * a);
    else if (a < 2.0)
        y = polynomial(middle, 10, a - 1.5);
    else
        y = a < 4.0 ? polynomial(far, 12, a - 3.0) : 1.0;
    return copysignf((float)y, x);
}
