/* See observer_filter.h. One file: all its functions work on one covariance. Loops add whole rows, so that a compiler may
 * take several columns at once and the sums stay in the same order. */
#include "observer_filter.h"

#include <math.h>
#include <string.h>

#include "symmetric_eigen.h"

static const double kZero = 2.0;    /* possible offset of an indicator's zero, in its deviations */
static const double kStart_K = 0.1; /* uniform uncertainty of the start state */
static const double kWidest = 2.0;  /* least range of a number over its deviation: at either end at random (Popoviciu) */

/* Rows and columns of a product that are summed up at once, in registers. */
#ifdef __AVX__
enum { kTall = 4, kWide = 8 };
#else
enum { kTall = 4, kWide = 4 };
#endif

enum { kNextStep, kNextMode, kFilledSteps, kFilledModes, kNexts };

int observer_n_factors(const observer_machine* machine) {
  return machine->n_sources + machine->n_exchanges;
}
int observer_n_all(const observer_machine* machine) {
  return machine->n + observer_n_factors(machine) + 2;
}

/* A kept step: its length, the coefficients, what the state keeps and what a constant load adds, z+ = decay z + gain f. */
static size_t step_size(const observer_machine* m) {
  return 1 + (size_t)m->n_exchanges + 2 * (size_t)m->n * (size_t)m->n;
}
/* Kept modes: the coefficients, eigenvalues and eigenvectors of K. */
static size_t modes_size(const observer_machine* m) {
  return (size_t)m->n_exchanges + (size_t)m->n * (size_t)(m->n + 1);
}

static double* taken(double** room, size_t n) {
  double* const at = *room;
  *room += n;
  return at;
}

size_t observer_filter_n_remembered(const observer_machine* machine) {
  const size_t all = (size_t)observer_n_all(machine);
  return all * (all + 1) + (size_t)machine->n + 2 * (size_t)machine->n_sources;
}

size_t observer_filter_n_room(const observer_machine* machine, int n_steps, int n_modes) {
  const size_t n = (size_t)machine->n, f = (size_t)observer_n_factors(machine), all = (size_t)observer_n_all(machine);
  return (size_t)n_steps * step_size(machine) + (size_t)n_modes * modes_size(machine) + kNexts + f + 2 * (n + f) * n +
         all * n + 2 * n + all + n * n + 2 * n + 2 * (size_t)machine->n_sources * n + (n + f) * (n + kWide + kTall);
}

void observer_filter_place(observer_filter* filter, double* remembered, double* room, int n_steps, int n_modes) {
  const observer_machine* const m = filter->machine;
  const size_t n = (size_t)m->n, f = (size_t)observer_n_factors(m), all = (size_t)observer_n_all(m);
  filter->n_all = (int)all;
  filter->mean = taken(&remembered, all);
  filter->covariance = taken(&remembered, all * all);
  filter->start_state = taken(&remembered, n);
  filter->least_W = taken(&remembered, (size_t)m->n_sources);
  filter->most_W = taken(&remembered, (size_t)m->n_sources);
  filter->n_steps = n_steps;
  filter->n_modes = n_modes;
  filter->next = taken(&room, kNexts);
  filter->power_W = taken(&room, (size_t)m->n_sources);
  filter->coefficient = taken(&room, (size_t)m->n_exchanges);
  filter->slopes = taken(&room, (n + f) * n);
  filter->transition = taken(&room, (n + f) * n);
  filter->top = taken(&room, all * n);
  filter->load = taken(&room, n);
  filter->state = taken(&room, n);
  filter->vector = taken(&room, all);
  filter->matrix = taken(&room, n * n + 2 * n);
  filter->unseen = taken(&room, (size_t)m->n_sources * n);
  filter->packed = taken(&room, (n + f) * (n + kWide + kTall));
  filter->unseen_before = taken(&room, (size_t)m->n_sources * n);
  filter->modes = taken(&room, (size_t)n_modes * modes_size(m));
  filter->steps = taken(&room, (size_t)n_steps * step_size(m));
}

void observer_filter_clear_room(const observer_filter* filter) {
  memset(filter->next, 0, kNexts * sizeof *filter->next);
}

void observer_filter_start(const observer_filter* filter, const double* state, const double* rest_W) {
  const observer_machine* const m = filter->machine;
  const int n = m->n, all = filter->n_all, f = observer_n_factors(m) + 1;
  double* const p = filter->covariance;
  int i, j;
  memset(filter->mean, 0, (size_t)all * (size_t)(all + 1) * sizeof *p);
  for (i = 0; i < n; ++i) {
    for (j = 0; j < n; ++j) p[i * all + j] = kStart_K * kStart_K * (m->ones[i] * m->ones[j]);
  }
  for (i = 0; i < f; ++i) {
    filter->mean[n + i] = filter->factor_mean[i];
    for (j = 0; j < f; ++j) p[(n + i) * all + n + j] = filter->factor_covariance[i * f + j];
  }
  p[all * all - 1] = pow(kZero * 1e-6 * filter->settings->drift_um, 2.0);
  for (i = 0; i < m->n_sources; ++i) filter->least_W[i] = filter->most_W[i] = rest_W[i];
  observer_filter_begin(filter, state);
}

void observer_filter_begin(const observer_filter* filter, const double* state) {
  memcpy(filter->mean, state, (size_t)filter->machine->n * sizeof *state);
  memcpy(filter->start_state, state, (size_t)filter->machine->n * sizeof *state);
}

/* y += sum_k x_k row_k of a matrix. */
static void add_rows(int n_rows, int n, const double* restrict matrix, int stride, const double* restrict x,
                     double* restrict y) {
  int k = 0, j;
  for (; k + 4 <= n_rows; k += 4) {
    const double *const r0 = matrix + (size_t)k * (size_t)stride, *const r1 = r0 + stride, *const r2 = r1 + stride,
                        *const r3 = r2 + stride;
    const double x0 = x[k], x1 = x[k + 1], x2 = x[k + 2], x3 = x[k + 3];
    for (j = 0; j < n; ++j) y[j] = y[j] + x0 * r0[j] + x1 * r1[j] + x2 * r2[j] + x3 * r3[j];
  }
  for (; k < n_rows; ++k) {
    const double* const row = matrix + (size_t)k * (size_t)stride;
    for (j = 0; j < n; ++j) y[j] += x[k] * row[j];
  }
}

/* The same with all n rows of a square matrix, and slope -= share times the matrix. */
static void add_exchange(int n, const double* restrict matrix, const double* restrict x, double share, double* restrict y,
                         double* restrict slope) {
  int k = 0, j;
  for (; k + 4 <= n; k += 4) {
    const double *const r0 = matrix + k * n, *const r1 = r0 + n, *const r2 = r1 + n, *const r3 = r2 + n;
    double* restrict const s0 = slope + k * n;
    double* restrict const s1 = s0 + n;
    double* restrict const s2 = s1 + n;
    double* restrict const s3 = s2 + n;
    const double x0 = x[k], x1 = x[k + 1], x2 = x[k + 2], x3 = x[k + 3];
    for (j = 0; j < n; ++j) {
      y[j] = y[j] + x0 * r0[j] + x1 * r1[j] + x2 * r2[j] + x3 * r3[j];
      s0[j] -= share * r0[j];
      s1[j] -= share * r1[j];
      s2[j] -= share * r2[j];
      s3[j] -= share * r3[j];
    }
  }
  for (; k < n; ++k) {
    for (j = 0; j < n; ++j) {
      y[j] += x[k] * matrix[k * n + j];
      slope[k * n + j] -= share * matrix[k * n + j];
    }
  }
}

/* kTall rows of kWide sums over k of a_k b_k, each in the order of k. */
static void add_block(int n_inner, const double* restrict a, const double* restrict b, double* restrict sum) {
  double s0[kWide] = {0.0}, s1[kWide] = {0.0}, s2[kWide] = {0.0}, s3[kWide] = {0.0};
  int k, q;
  for (k = 0; k < n_inner; ++k, a += kTall, b += kWide) {
    for (q = 0; q < kWide; ++q) s0[q] += a[0] * b[q];
    for (q = 0; q < kWide; ++q) s1[q] += a[1] * b[q];
    for (q = 0; q < kWide; ++q) s2[q] += a[2] * b[q];
    for (q = 0; q < kWide; ++q) s3[q] += a[3] * b[q];
  }
  for (q = 0; q < kWide; ++q) {
    sum[q] = s0[q];
    sum[kWide + q] = s1[q];
    sum[2 * kWide + q] = s2[q];
    sum[3 * kWide + q] = s3[q];
  }
}

/* C += A B, C n_rows x n, element i, k of A at i * a_row + k * a_inner. upper: of C only what is right of its diagonal, and
 * some more. packed: room for n_inner (n + kWide + kTall) numbers. */
static void add_product(int n_rows, int n_inner, int n, const double* a, int a_row, int a_inner, const double* b, int b_row,
                        double* c, int c_row, int upper, double* packed) {
  double *const packed_a = packed, *const packed_b = packed + n_inner * kTall, sum[kTall * kWide];
  int i, j, k, p, q;
  for (j = 0; j < n; j += kWide) {
    double* to = packed_b + n_inner * j;
    const int width = n - j < kWide ? n - j : kWide;
    for (k = 0; k < n_inner; ++k, to += kWide) {
      for (q = 0; q < kWide; ++q) to[q] = q < width ? b[k * b_row + j + q] : 0.0;
    }
  }
  for (i = 0; i < n_rows; i += kTall) {
    const int height = n_rows - i < kTall ? n_rows - i : kTall;
    for (k = 0; k < n_inner; ++k) {
      for (p = 0; p < kTall; ++p) packed_a[k * kTall + p] = p < height ? a[(i + p) * a_row + k * a_inner] : 0.0;
    }
    for (j = upper ? i / kWide * kWide : 0; j < n; j += kWide) {
      const int width = n - j < kWide ? n - j : kWide;
      add_block(n_inner, packed_a, packed_b + n_inner * j, sum);
      for (p = 0; p < height; ++p) {
        for (q = 0; q < width; ++q) c[(i + p) * c_row + j + q] += sum[p * kWide + q];
      }
    }
  }
}

/* What is right of the diagonal, to the left of it. */
static void mirror(int n, double* matrix, int stride) {
  int i, j;
  for (i = 0; i < n; ++i) {
    for (j = 0; j < i; ++j) matrix[i * stride + j] = matrix[j * stride + i];
  }
}

/* The eigenvalues of K with the coefficients of now, then its eigenvectors as rows; null where the decomposition fails. */
static const double* modes_of(const observer_filter* filter) {
  const observer_machine* const m = filter->machine;
  const size_t n = (size_t)m->n, n_key = (size_t)m->n_exchanges;
  const int n_filled = (int)filter->next[kFilledModes];
  int k;
  size_t i;
  double* at = filter->modes;
  for (k = 0; k < n_filled; ++k, at += modes_size(m)) {
    if (memcmp(at, filter->coefficient, n_key * sizeof *at) == 0) return at + n_key;
  }
  k = (int)filter->next[kNextMode];
  at = filter->modes + (size_t)k * modes_size(m);
  memcpy(filter->matrix, m->conduction, n * n * sizeof *at);
  for (k = 0; k < m->n_exchanges; ++k) {
    const double *const g = m->exchanges + (size_t)k * n * n, c = filter->coefficient[k];
    for (i = 0; i < n * n; ++i) filter->matrix[i] += c * g[i];
  }
  memcpy(at, filter->coefficient, n_key * sizeof *at);
  if (symmetric_eigen(m->n, filter->matrix, at + n_key, at + n_key + n, filter->matrix + n * n) != 0) {
    observer_filter_clear_room(filter);
    return 0;
  }
  k = (int)filter->next[kNextMode] + 1;
  if (k > n_filled) filter->next[kFilledModes] = k;
  filter->next[kNextMode] = k % filter->n_modes;
  return at + n_key;
}

/* decay, then gain, of the coefficients of now over h; null where the decomposition fails. */
static const double* step_of(const observer_filter* filter, double h_s) {
  const observer_machine* const m = filter->machine;
  const int n = m->n, n_filled = (int)filter->next[kFilledSteps];
  const size_t n_coefficients = (size_t)m->n_exchanges, size = (size_t)n * (size_t)n;
  const double* modes;
  double *at = filter->steps, *decay, *gain;
  int i, j, k;
  for (k = 0; k < n_filled; ++k, at += step_size(m)) {
    if (at[0] == h_s && memcmp(at + 1, filter->coefficient, n_coefficients * sizeof *at) == 0)
      return at + 1 + n_coefficients;
  }
  modes = modes_of(filter);
  if (!modes) return 0;
  k = (int)filter->next[kNextStep];
  at = filter->steps + (size_t)k * step_size(m);
  if (k + 1 > n_filled) filter->next[kFilledSteps] = k + 1;
  filter->next[kNextStep] = (k + 1) % filter->n_steps;
  at[0] = h_s;
  memcpy(at + 1, filter->coefficient, n_coefficients * sizeof *at);
  decay = at + 1 + n_coefficients;
  gain = decay + size;
  memset(decay, 0, 2 * size * sizeof *decay);
  for (k = 0; k < n; ++k) {
    const double* restrict const v = modes + n + k * n;
    const double x = modes[k] * h_s, kept = exp(-x), added = fabs(x) > 1e-8 ? -h_s * expm1(-x) / x : h_s;
    for (i = 0; i < n; ++i) {
      const double d = kept * v[i], g = added * v[i];
      double* restrict const to_decay = decay + i * n;
      double* restrict const to_gain = gain + i * n;
      for (j = i; j < n; ++j) {
        to_decay[j] += d * v[j];
        to_gain[j] += g * v[j];
      }
    }
  }
  mirror(n, decay, n);
  mirror(n, gain, n);
  return decay;
}

/* Factors change at random. While the drift is measured this is a random walk; later they also return to what was learned,
 * so that none comes to be less certain than it was before learning: an Ornstein-Uhlenbeck process with the variance
 * factor². */
static void forget_factors(const observer_filter* filter, double h_s) {
  const observer_settings* const s = filter->settings;
  const int n = filter->machine->n, f = observer_n_factors(filter->machine), all = filter->n_all;
  const double walk = s->factor_walk * s->factor_walk * h_s / 3600.0, most = s->factor * s->factor;
  double *const p = filter->covariance, *const factor = filter->mean + n;
  int i, j;
  if (!filter->with_drift && walk < most) {
    const double kept = sqrt(1.0 - walk / most);
    for (i = 0; i < f; ++i) factor[i] = filter->factor_mean[i] + kept * (factor[i] - filter->factor_mean[i]);
    for (i = n; i < n + f; ++i) {
      for (j = 0; j < all; ++j) p[i * all + j] *= kept;
    }
    for (i = 0; i < all; ++i) {
      for (j = n; j < n + f; ++j) p[i * all + j] *= kept;
    }
  }
  for (i = n; i < n + f; ++i) p[i * all + i] += walk;
}

int observer_filter_step(const observer_filter* filter, double ambient_K, double h_s, int is_gap) {
  const observer_machine* const m = filter->machine;
  const int n = m->n, f = observer_n_factors(m), all = filter->n_all;
  const size_t row = (size_t)n * sizeof(double);
  double *const z = filter->mean, *const factor = filter->mean + n, *const p = filter->covariance;
  double *const slope = filter->slopes, *const by_factor =
                                            filter->slopes + n * n; /* n rows, then a row a factor: its heat */
  const double *const decay = step_of(filter, h_s), *gain;
  int i, j, e, s;
  if (!decay) return 1;
  gain = decay + n * n;
  memset(filter->load, 0, row);
  for (s = 0; s < m->n_sources; ++s) {
    const double *const b = m->loads + s * n, power_W = filter->power_W[s];
    for (i = 0; i < n; ++i) {
      by_factor[s * n + i] = power_W * b[i];
      filter->load[i] += by_factor[s * n + i];
    }
  }
  memset(slope, 0, (size_t)n * row); /* over z, of the heat of the exchanges' factors */
  for (e = 0; e < m->n_exchanges; ++e) {
    const double *const g = m->exchanges + (size_t)e * (size_t)n * (size_t)n, c = filter->coefficient[e];
    const double *const to_ambient = m->to_ambient + e * n, *const offset = m->offsets + e * n;
    double* restrict const heat = by_factor + (m->n_sources + e) * n;
    memset(filter->state, 0, row);
    add_exchange(n, g, z, factor[m->n_sources + e] * c, filter->state, slope);
    for (i = 0; i < n; ++i) {
      const double outside = ambient_K * to_ambient[i] + offset[i];
      filter->load[i] += c * outside;
      heat[i] = c * (outside - filter->state[i]);
    }
  }
  /* The transition F = [decay + gain slope, gain by_factor], transposed; decay, gain and slope are symmetric. */
  memcpy(filter->transition, decay, (size_t)n * row);
  memset(filter->transition + n * n, 0, (size_t)f * row);
  add_product(n + f, n, n, filter->slopes, n, 1, gain, n, filter->transition, n, 0, filter->packed);
  add_rows(f, n, by_factor, n, factor, filter->load);
  memset(filter->state, 0, row);
  add_rows(n, n, decay, n, z, filter->state);
  add_rows(n, n, gain, n, filter->load, filter->state);
  memcpy(z, filter->state, row);
  /* The new state over all old variables, (F P)', then F P F'. */
  memset(filter->top, 0, (size_t)all * row);
  add_product(all, n + f, n, p, all, 1, filter->transition, n, filter->top, n, 0, filter->packed);
  for (i = n; i < all; ++i) {
    memcpy(p + i * all, filter->top + i * n, row);
    for (j = 0; j < n; ++j) p[j * all + i] = filter->top[i * n + j];
  }
  for (i = 0; i < n; ++i) memset(p + i * all, 0, row);
  add_product(n, n + f, n, filter->top, 1, n, filter->transition, n, p, all, 1, filter->packed);
  mirror(n, p, all);
  forget_factors(filter, h_s);
  for (s = 0; s < m->n_sources; ++s) {
    filter->least_W[s] = fmin(filter->least_W[s], filter->power_W[s]);
    filter->most_W[s] = fmax(filter->most_W[s], filter->power_W[s]);
  }
  if (!is_gap) return 0;
  memcpy(filter->unseen_before, filter->unseen, (size_t)m->n_sources * row);
  memset(filter->unseen, 0, (size_t)m->n_sources * row);
  for (s = 0; s < m->n_sources; ++s) { /* between the extremes of rest and of this run */
    const double range = (filter->most_W[s] - filter->least_W[s]) / kWidest;
    for (i = 0; i < n; ++i) filter->state[i] = range * m->loads[s * n + i];
    add_rows(n, n, decay, n, filter->unseen_before + s * n, filter->unseen + s * n);
    add_rows(n, n, gain, n, filter->state, filter->unseen + s * n);
  }
  return 0;
}

void observer_filter_begin_gap(const observer_filter* filter) {
  memset(filter->unseen, 0, (size_t)filter->machine->n_sources * (size_t)filter->machine->n * sizeof *filter->unseen);
}

void observer_filter_end_gap(const observer_filter* filter) {
  const int n = filter->machine->n;
  add_product(n, filter->machine->n_sources, n, filter->unseen, 1, n, filter->unseen, n, filter->covariance, filter->n_all,
              1, filter->packed);
  mirror(n, filter->covariance, filter->n_all);
}

double observer_filter_variance(const observer_filter* filter, const double* gradient, int length) {
  double total = 0.0;
  int i;
  memset(filter->vector, 0, (size_t)filter->n_all * sizeof *filter->vector);
  add_rows(length, filter->n_all, filter->covariance, filter->n_all, gradient, filter->vector);
  for (i = 0; i < length; ++i) total += gradient[i] * filter->vector[i];
  return total;
}

void observer_filter_correct(const observer_filter* filter, double expected_variance, double innovation, double variance) {
  const int all = filter->n_all;
  const double total = expected_variance + variance, root = sqrt(total), share = innovation / total;
  double* restrict const ph = filter->vector;
  int i, j;
  for (i = 0; i < all; ++i) filter->mean[i] += ph[i] * share;
  for (i = 0; i < all; ++i) ph[i] /= root;
  for (i = 0; i < all; ++i) { /* stays symmetric to the last bit */
    double* restrict const row = filter->covariance + i * all;
    const double x = ph[i];
    for (j = 0; j < all; ++j) row[j] -= x * ph[j];
  }
}

double observer_filter_unscaled_drift_m(const observer_filter* filter, const double* output) {
  double sum = 0.0;
  int i;
  for (i = 0; i < filter->machine->n; ++i) sum += output[i] * (filter->mean[i] - filter->start_state[i]);
  return sum;
}

void observer_filter_drift_gradient(const observer_filter* filter, const double* output, double* gradient) {
  const int n = filter->machine->n, scale = filter->n_all - 2;
  int i;
  memset(gradient, 0, (size_t)filter->n_all * sizeof *gradient);
  for (i = 0; i < n; ++i) gradient[i] = (1.0 + filter->mean[scale]) * output[i];
  gradient[scale] = observer_filter_unscaled_drift_m(filter, output);
}
