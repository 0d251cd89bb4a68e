// SPDX-License-Identifier: Apache-2.0
// How much of one plane is in another: local means, and what two have in common.
#pragma once
#include <math.h>

// The mean of 3 x 3 cells, `passes` times over; the border's cells count for those beyond it.
static inline void local_means(double* plane, int w, int h, int passes, double* scratch)
{
    for (int pass = 0; pass < passes; pass++)
    {
        for (int i = 0; i < w * h; i++)
            scratch[i] = (plane[i % w ? i - 1 : i] + plane[i] + plane[i % w + 1 < w ? i + 1 : i]) / 3.0;
        for (int i = 0; i < w * h; i++)
            plane[i] = (scratch[i >= w ? i - w : i] + scratch[i] + scratch[i + w < w * h ? i + w : i]) / 3.0;
    }
}

// Pearson's, -1 to 1; 0 where one of them is the same everywhere.
static inline double correlation(const double* a, const double* b, int n)
{
    double ma = 0.0, mb = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
    for (int i = 0; i < n; i++)
    {
        ma += a[i] / n;
        mb += b[i] / n;
    }
    for (int i = 0; i < n; i++)
    {
        aa += (a[i] - ma) * (a[i] - ma);
        bb += (b[i] - mb) * (b[i] - mb);
        ab += (a[i] - ma) * (b[i] - mb);
    }
    return ab / sqrt(aa * bb + 1e-30);
}
