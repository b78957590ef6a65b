#include "symmetric_eigen.h"

#include <float.h>
#include <math.h>

static const int kMostSteps = 60; /* per eigenvalue; two or three are usual */

/* Row r of the lower triangle holds the vector that reflected column r - 1; A becomes H ... A ... H with the diagonal d and
 * e beside it. rotated: the product of the reflections, transposed: its row k is column k. */
static void reduce_to_three_diagonals(int n, double* a, double* d, double* e, double* rotated) {
  int i, j, k;
  for (k = 0; k + 2 < n; ++k) {
    double* const v = e + k + 1; /* rows k+1 .. n-1 of the reflecting vector, in the part of e that is still free */
    double norm2 = 0.0, alpha, vv, beta, vp = 0.0;
    for (i = k + 1; i < n; ++i) {
      v[i - k - 1] = a[i * n + k];
      norm2 += v[i - k - 1] * v[i - k - 1];
    }
    alpha = v[0] > 0.0 ? -sqrt(norm2) : sqrt(norm2);
    vv = 2.0 * (norm2 - alpha * v[0]);
    if (vv > 0.0) {
      v[0] -= alpha;
      beta = 2.0 / vv;
      /* p = beta A v goes into row k of the upper triangle, which nobody reads again. */
      for (i = k + 1; i < n; ++i) {
        double sum = 0.0;
        for (j = k + 1; j < n; ++j) sum += a[i * n + j] * v[j - k - 1];
        a[k * n + i] = beta * sum;
        vp += a[k * n + i] * v[i - k - 1];
      }
      for (i = k + 1; i < n; ++i) a[k * n + i] -= 0.5 * beta * vp * v[i - k - 1];
      for (i = k + 1; i < n; ++i) {
        const double vi = v[i - k - 1], wi = a[k * n + i];
        double* const row = a + i * n;
        const double* const w = a + k * n;
        for (j = k + 1; j < n; ++j) row[j] -= vi * w[j] + wi * v[j - k - 1];
      }
      for (i = k + 1; i < n; ++i) a[i * n + k] = v[i - k - 1];
      a[k * n + k + 1] = beta;
    } else {
      a[k * n + k + 1] = 0.0;
    }
    d[k] = a[k * n + k];
    e[k] = alpha;
  }
  if (n > 1) e[n - 2] = a[(n - 1) * n + n - 2];
  for (i = n > 2 ? n - 2 : 0; i < n; ++i) d[i] = a[i * n + i];
  e[n - 1] = 0.0;
  for (i = 0; i < n; ++i) {
    for (j = 0; j < n; ++j) rotated[i * n + j] = i == j ? 1.0 : 0.0;
  }
  /* Q = H_0 H_1 ...: from the last reflection on, each acts on the block that those behind it have made. */
  for (k = n - 3; k >= 0; --k) {
    const double beta = a[k * n + k + 1];
    if (beta == 0.0) continue;
    for (j = k + 1; j < n; ++j) { /* column j of Q is row j here */
      double* const row = rotated + j * n;
      double sum = 0.0;
      for (i = k + 1; i < n; ++i) sum += a[i * n + k] * row[i];
      for (i = k + 1; i < n; ++i) row[i] -= beta * sum * a[i * n + k];
    }
  }
}

int symmetric_eigen(int n, double* matrix, double* values, double* vectors, double* work) {
  double *const d = values, *const e = work;
  int l, m, i, k;
  reduce_to_three_diagonals(n, matrix, d, e, vectors);
  for (l = 0; l < n; ++l) {
    int step = 0;
    for (;;) {
      double g, r, s = 1.0, c = 1.0, p = 0.0;
      for (m = l; m + 1 < n; ++m) {
        if (fabs(e[m]) <= DBL_EPSILON * (fabs(d[m]) + fabs(d[m + 1]))) break;
      }
      if (m == l) break;
      if (step++ == kMostSteps) return 1;
      g = (d[l + 1] - d[l]) / (2.0 * e[l]);
      r = sqrt(g * g + 1.0);
      g = d[m] - d[l] + e[l] / (g < 0.0 ? g - r : g + r);
      for (i = m - 1; i >= l; --i) {
        double *const upper = vectors + i * n, *const lower = vectors + (i + 1) * n;
        const double f = s * e[i], b = c * e[i];
        r = sqrt(f * f + g * g);
        e[i + 1] = r;
        if (r == 0.0) {
          d[i + 1] -= p;
          e[m] = 0.0;
          break;
        }
        s = f / r;
        c = g / r;
        g = d[i + 1] - p;
        r = (d[i] - g) * s + 2.0 * c * b;
        p = s * r;
        d[i + 1] = g + p;
        g = c * r - b;
        for (k = 0; k < n; ++k) {
          const double z = lower[k];
          lower[k] = s * upper[k] + c * z;
          upper[k] = c * upper[k] - s * z;
        }
      }
      if (r == 0.0 && i >= l) continue;
      d[l] -= p;
      e[l] = g;
      e[m] = 0.0;
    }
  }
  return 0;
}
