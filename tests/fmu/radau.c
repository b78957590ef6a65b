/* Hairer & Wanner, Solving Ordinary Differential Equations II, ch. IV.5 and IV.8: Radau IIA with three stages by
 * simplified Newton steps. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "importer.h"

double monotonic_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int factorise(size_t n, double* a, size_t* pivot) {
  size_t i, j, k;
  for (k = 0; k < n; ++k) {
    size_t p = k;
    for (i = k + 1; i < n; ++i) {
      if (fabs(a[i * n + k]) > fabs(a[p * n + k])) p = i;
    }
    pivot[k] = p;
    if (a[p * n + k] == 0.0) return 1;
    for (j = 0; j < n; ++j) {
      const double x = a[k * n + j];
      a[k * n + j] = a[p * n + j];
      a[p * n + j] = x;
    }
    for (i = k + 1; i < n; ++i) {
      const double x = a[i * n + k] /= a[k * n + k];
      for (j = k + 1; j < n; ++j) a[i * n + j] -= x * a[k * n + j];
    }
  }
  return 0;
}

static void solve(size_t n, const double* a, const size_t* pivot, double* b) {
  size_t i, j, k;
  for (k = 0; k < n; ++k) {
    const double x = b[k];
    b[k] = b[pivot[k]];
    b[pivot[k]] = x;
  }
  for (i = 1; i < n; ++i) {
    for (j = 0; j < i; ++j) b[i] -= a[i * n + j] * b[j];
  }
  for (i = n; i-- > 0;) {
    for (j = i + 1; j < n; ++j) b[i] -= a[i * n + j] * b[j];
    b[i] /= a[i * n + i];
  }
}

int integrate_radau(const integrand* f, size_t n, double from_s, double to_s, int is_smooth, double* z) {
  const double q = sqrt(6.0);
  const double c[3] = {(4.0 - q) / 10.0, (4.0 + q) / 10.0, 1.0};
  const double a[3][3] = {{(88.0 - 7.0 * q) / 360.0, (296.0 - 169.0 * q) / 1800.0, (-2.0 + 3.0 * q) / 225.0},
                          {(296.0 + 169.0 * q) / 1800.0, (88.0 + 7.0 * q) / 360.0, (-2.0 - 3.0 * q) / 225.0},
                          {(16.0 - q) / 36.0, (16.0 + q) / 36.0, 1.0 / 9.0}};
  /* Lengths of steps, each for as many steps; the last until the end. */
  const double lengths_s[] = {0.02, 0.2, 2.0};
  const int counts[] = {100, 100, 1000000};
  const size_t wide = 3 * n;
  double *const jacobian = malloc(n * n * sizeof *jacobian), *const matrix = malloc(wide * wide * sizeof *matrix),
                *const k = malloc(wide * sizeof *k), *const off = malloc((wide + n) * sizeof *off),
                *const stage = off + wide;
  size_t* const pivot = malloc(wide * sizeof *pivot);
  double t_s = from_s;
  int level, failed = 0;
  size_t i, j;
  for (j = 0; j < n && !failed; ++j) failed = f->column(f->of, j, k) || (memcpy(jacobian + j * n, k, n * sizeof *k), 0);
  for (level = is_smooth ? 2 : 0; level < 3 && t_s < to_s && !failed; ++level) {
    const double until_s = fmin(to_s, t_s + counts[level] * lengths_s[level]);
    const int n_steps = (int)ceil((until_s - t_s) / lengths_s[level] - 1e-9);
    const double h_s = (until_s - t_s) / n_steps, begin_s = t_s;
    int step, r, s;
    for (r = 0; r < 3; ++r) {
      for (s = 0; s < 3; ++s) {
        for (i = 0; i < n; ++i) {
          for (j = 0; j < n; ++j)
            matrix[((size_t)r * n + i) * wide + (size_t)s * n + j] =
                (r == s && i == j) - h_s * a[r][s] * jacobian[j * n + i];
        }
      }
    }
    failed = factorise(wide, matrix, pivot);
    for (step = 0; step < n_steps && !failed; ++step) {
      double change = HUGE_VAL;
      int iteration;
      t_s = begin_s + step * h_s;
      memset(k, 0, wide * sizeof *k);
      for (iteration = 0; iteration < 20 && h_s * change > 1e-9 && !failed; ++iteration) {
        for (r = 0; r < 3 && !failed; ++r) {
          memcpy(stage, z, n * sizeof *stage);
          for (s = 0; s < 3; ++s) {
            for (i = 0; i < n; ++i) stage[i] += h_s * a[r][s] * k[(size_t)s * n + i];
          }
          failed = f->slopes(f->of, t_s + c[r] * h_s, stage, off + (size_t)r * n);
        }
        for (i = 0; i < wide; ++i) off[i] -= k[i];
        solve(wide, matrix, pivot, off);
        change = 0.0;
        for (i = 0; i < wide; ++i) {
          k[i] += off[i];
          change = fmax(change, fabs(off[i]));
        }
      }
      for (i = 0; i < n; ++i) z[i] += h_s * (a[2][0] * k[i] + a[2][1] * k[n + i] + a[2][2] * k[2 * n + i]);
    }
    t_s = until_s;
  }
  free(jacobian);
  free(matrix);
  free(k);
  free(off);
  free(pivot);
  return failed;
}
