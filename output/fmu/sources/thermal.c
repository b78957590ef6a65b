#include "thermal.h"

#include <math.h>
#include <string.h>

void multiply(int rows, int columns, const double* matrix, const double* x, double* y) {
  int i, j;
  for (i = 0; i < rows; ++i) {
    const double* const row = matrix + (size_t)i * (size_t)columns;
    double sum = 0.0;
    for (j = 0; j < columns; ++j) sum += row[j] * x[j];
    y[i] = sum;
  }
}

void add_transposed(int rows, int columns, const double* matrix, const double* x, double* y) {
  int i, j;
  for (i = 0; i < rows; ++i) {
    const double* const row = matrix + (size_t)i * (size_t)columns;
    for (j = 0; j < columns; ++j) y[j] += row[j] * x[i];
  }
}

/* The piece that holds log x, and where in it, from -1 to 1. */
static const double* piece_at(const law_term* t, double log_x, double* s, double* half_width) {
  int low = 0, high = t->n_pieces;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (log_x < t->log_x[middle])
      high = middle;
    else
      low = middle;
  }
  *half_width = 0.5 * (t->log_x[low + 1] - t->log_x[low]);
  *s = (log_x - t->log_x[low]) / *half_width - 1.0;
  if (*s < -1.0) *s = -1.0;
  if (*s > 1.0) *s = 1.0;
  return t->coefficients + (size_t)low * (size_t)(t->degree + 1);
}

double law_value(const drive_law* law, const double* drive) {
  double value = law->at_rest;
  int k, j;
  for (k = 0; k < law->n_terms; ++k) {
    const law_term* const t = &law->terms[k];
    const double x = drive[t->variable];
    const double* c;
    double s, half, b0 = 0.0, b1 = 0.0, b2;
    if (!(x > 0.0)) continue;
    c = piece_at(t, log(x), &s, &half);
    for (j = t->degree; j > 0; --j) { /* Clenshaw's sum */
      b2 = b1;
      b1 = b0;
      b0 = 2.0 * s * b1 - b2 + c[j];
    }
    value += s * b0 - b1 + c[0];
  }
  return value;
}

double law_slope(const drive_law* law, const double* drive, int variable) {
  double slope = 0.0;
  int k, j;
  for (k = 0; k < law->n_terms; ++k) {
    const law_term* const t = &law->terms[k];
    const double x = drive[t->variable];
    const double* c;
    double s, half, u0 = 1.0, u1, u2 = 0.0, sum = 0.0; /* U_{j-1}(s): T_j' = j U_{j-1} */
    if (t->variable != variable || !(x > 0.0)) continue;
    c = piece_at(t, log(x), &s, &half);
    u1 = 0.0;
    for (j = 1; j <= t->degree; ++j) {
      sum += j * c[j] * u0;
      u2 = u1;
      u1 = u0;
      u0 = 2.0 * s * u1 - u2;
    }
    slope += sum / (half * x);
  }
  return slope;
}

void load_integrals(double t_s, double lambda, double* of_power) {
  const double y = t_s * lambda;
  int k, j;
  if (y < 1.0) { /* t_s^{k+1} sum over j of (-y)^j k! / (k + 1 + j)! */
    double head = t_s;
    for (k = 0; k < 3; ++k) {
      double term = head / (k + 1), sum = 0.0;
      for (j = 0; j < 20; ++j) {
        sum += term;
        term *= -y / (k + 2 + j);
      }
      of_power[k] = sum;
      head *= t_s;
    }
    return;
  }
  of_power[0] = -expm1(-y) / lambda;
  of_power[1] = (t_s - of_power[0]) / lambda;
  of_power[2] = (t_s * t_s - 2.0 * of_power[1]) / lambda;
}

double ambient_by_scenario_K(double time_s) {
  const double *const t = thermal.ambient_time_s, *const ambient = thermal.ambient_K;
  int k;
  if (time_s <= t[0]) return ambient[0];
  for (k = 1; k < thermal.n_ambient; ++k) {
    if (time_s < t[k]) return ambient[k - 1] + (ambient[k] - ambient[k - 1]) * ((time_s - t[k - 1]) / (t[k] - t[k - 1]));
  }
  return ambient[thermal.n_ambient - 1];
}

double next_ambient_knot_s(double time_s) {
  int k;
  for (k = 0; k < thermal.n_ambient; ++k) {
    if (thermal.ambient_time_s[k] > time_s + 1e-9 * fabs(time_s)) return thermal.ambient_time_s[k];
  }
  return HUGE_VAL;
}

void thermal_matrix(const double* coefficient, double* matrix) {
  const size_t size = (size_t)thermal.n * (size_t)thermal.n;
  size_t i;
  int e;
  memcpy(matrix, thermal.conduction, size * sizeof *matrix);
  for (e = 0; e < thermal.n_exchanges; ++e) {
    const double* const g = thermal.exchanges + (size_t)e * size;
    if (coefficient[e] == 0.0) continue;
    for (i = 0; i < size; ++i) matrix[i] += coefficient[e] * g[i];
  }
}

void thermal_loads(const double* coefficient, const double* power_W, double* constant_W, double* per_ambient_W_K) {
  const size_t bytes = (size_t)thermal.n * sizeof *constant_W;
  memcpy(constant_W, thermal.constant_load, bytes);
  memcpy(per_ambient_W_K, thermal.ambient_load, bytes);
  add_transposed(thermal.n_sources, thermal.n, thermal.loads, power_W, constant_W);
  add_transposed(thermal.n_exchanges, thermal.n, thermal.offsets, coefficient, constant_W);
  add_transposed(thermal.n_exchanges, thermal.n, thermal.to_ambient, coefficient, per_ambient_W_K);
}
