#include "live.h"

#include <math.h>
#include <string.h>

#include "formula.h"
#include "switches.h"
#include "thermal.h"

enum { kNodes = 3, kMostIterations = 12 };

/* Where in a step N is looked at: middle and end make the parabola, three quarters test it. */
static const double kAt[kNodes] = {0.5, 1.0, 0.75};
/* Of a step: K of a temperature, 2 um of a displacement, 20 urad of a tilt (thermal.nominal). */
static const double kTolerance = 1e-6, kShareIterated = 0.1;
/* Shorter steps are not tried. Where a law jumps, this one is taken as it is: it errs by at most the jump for so long. */
static const double kShortest_s = 1e-3;

struct live_room {
  double *x, *dx; /* of a formula */
  double* out;    /* of an exchange: its heat per coefficient */
  double *modes, *rate, *z[kNodes], *last[2];
  double* load[1 + kNodes]; /* N at the beginning and at kAt */
  double *error, *error_z;
  /* What a mode keeps up to kAt, and what it has there of N at the beginning, the middle and the end; of a constant load
   * at the end. Of the system and step met last. */
  double *kept[kNodes], *of[kNodes][3], *of_constant;
  const double* lambda;
  double step_s;
};

static int most_probes(void) {
  int most = 0, k;
  for (k = 0; k < thermal.n_live; ++k) most = thermal.live[k].n_probes > most ? thermal.live[k].n_probes : most;
  return most;
}

static size_t n_doubles(void) {
  const size_t n = (size_t)thermal.n, names = (size_t)(thermal.n_drive + most_probes());
  return 2 * names + n * (3 + kNodes + 2 + 1 + kNodes + 2 + kNodes + 3 * kNodes + 1);
}

size_t live_room_size(void) {
  return sizeof(live_room) + n_doubles() * sizeof(double);
}

static double* take(double** room, size_t n) {
  double* const at = *room;
  *room += n;
  return at;
}

live_room* live_prepare(void* bytes) {
  live_room* const r = bytes;
  const size_t n = (size_t)thermal.n, names = (size_t)(thermal.n_drive + most_probes());
  double* free_room = (double*)(void*)(r + 1);
  int i, j;
  r->x = take(&free_room, names);
  r->dx = take(&free_room, names);
  r->out = take(&free_room, n);
  r->modes = take(&free_room, n);
  r->rate = take(&free_room, n);
  for (i = 0; i < kNodes; ++i) r->z[i] = take(&free_room, n);
  for (i = 0; i < 2; ++i) r->last[i] = take(&free_room, n);
  for (i = 0; i < 1 + kNodes; ++i) r->load[i] = take(&free_room, n);
  r->error = take(&free_room, n);
  r->error_z = take(&free_room, n);
  for (i = 0; i < kNodes; ++i) {
    r->kept[i] = take(&free_room, n);
    for (j = 0; j < 3; ++j) r->of[i][j] = take(&free_room, n);
  }
  r->of_constant = take(&free_room, n);
  r->lambda = 0;
  r->step_s = -1.0;
  return r;
}

/* The drive and the temperatures of a law's probes. */
static void look(const live_law* law, const double* drive, const double* z, double ambient_K, double* x) {
  int p;
  memcpy(x, drive, (size_t)thermal.n_drive * sizeof *x);
  multiply(law->n_probes, thermal.n, law->weights, z, x + thermal.n_drive);
  for (p = 0; p < law->n_probes; ++p) x[thermal.n_drive + p] += law->ambient_share[p] * ambient_K + law->offset_K[p];
}

/* out = G z of an exchange. G is symmetric, and its rows added up are its columns: faster than sums over each row. */
static void exchanged(int exchange, const double* z, double* out) {
  const size_t n = (size_t)thermal.n;
  memset(out, 0, n * sizeof *out);
  add_transposed(thermal.n, thermal.n, thermal.exchanges + (size_t)exchange * n * n, z, out);
}

/* y = V x, with four sums side by side. */
static void to_modes(const double* vectors, const double* x, double* y) {
  const int n = thermal.n;
  int i, j;
  for (i = 0; i < n; ++i) {
    const double* const row = vectors + (size_t)i * (size_t)n;
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
    for (j = 0; j + 3 < n; j += 4) {
      a += row[j] * x[j];
      b += row[j + 1] * x[j + 1];
      c += row[j + 2] * x[j + 2];
      d += row[j + 3] * x[j + 3];
    }
    for (; j < n; ++j) a += row[j] * x[j];
    y[i] = (a + b) + (c + d);
  }
}

/* out = G z - ambient g - o of an exchange. */
static void heat_out(int exchange, const double* z, double ambient_K, double* out) {
  const int n = thermal.n;
  const double *const g = thermal.to_ambient + (size_t)exchange * (size_t)n, *const o = thermal.offsets +
                                                                                        (size_t)exchange * (size_t)n;
  int i;
  exchanged(exchange, z, out);
  for (i = 0; i < n; ++i) out[i] -= ambient_K * g[i] + o[i];
}

int live_add_rate(live_room* r, const double* drive, const double* coefficient, const double* z, double ambient_K,
                  double* rate) {
  const int n = thermal.n;
  int k, i;
  for (k = 0; k < thermal.n_live; ++k) {
    const live_law* const law = &thermal.live[k];
    double value;
    look(law, drive, z, ambient_K, r->x);
    value = formula_value(law->n_steps, law->steps, r->x, 0, 0);
    if (!(fabs(value) < HUGE_VAL) || (law->exchange >= 0 && value < 0.0)) return 1;
    if (law->source >= 0) {
      const double* const load = thermal.loads + (size_t)law->source * (size_t)n;
      for (i = 0; i < n; ++i) rate[i] += value * load[i];
    } else {
      const double beyond = value - coefficient[law->exchange];
      heat_out(law->exchange, z, ambient_K, r->out);
      for (i = 0; i < n; ++i) rate[i] -= beyond * r->out[i];
    }
  }
  return 0;
}

void live_add_slope(live_room* r, const double* drive, const double* coefficient, const double* z, double ambient_K,
                    const double* dz, double d_ambient_K, int which, double seed, double* rate) {
  const int n = thermal.n;
  int k, i, p;
  for (k = 0; k < thermal.n_live; ++k) {
    const live_law* const law = &thermal.live[k];
    double value, slope;
    look(law, drive, z, ambient_K, r->x);
    memset(r->dx, 0, (size_t)thermal.n_drive * sizeof *r->dx);
    if (which >= 0) r->dx[which] = seed;
    multiply(law->n_probes, n, law->weights, dz, r->dx + thermal.n_drive);
    for (p = 0; p < law->n_probes; ++p) r->dx[thermal.n_drive + p] += law->ambient_share[p] * d_ambient_K;
    value = formula_value(law->n_steps, law->steps, r->x, r->dx, &slope);
    if (law->source >= 0) {
      const double* const load = thermal.loads + (size_t)law->source * (size_t)n;
      for (i = 0; i < n; ++i) rate[i] += slope * load[i];
    } else {
      const double* const g = thermal.to_ambient + (size_t)law->exchange * (size_t)n;
      const double beyond = value - coefficient[law->exchange];
      if (which >= 0) slope -= seed * law_slope(&thermal.coefficients[law->exchange], drive, which);
      heat_out(law->exchange, z, ambient_K, r->out);
      for (i = 0; i < n; ++i) rate[i] -= slope * r->out[i];
      exchanged(law->exchange, dz, r->out);
      for (i = 0; i < n; ++i) rate[i] -= beyond * (r->out[i] - d_ambient_K * g[i]);
    }
  }
}

static void take_step_length(live_room* r, const live_system* s, double h_s) {
  int i, c;
  if (r->lambda == s->lambda && r->step_s == h_s) return;
  for (i = 0; i < thermal.n; ++i) {
    const double x = s->lambda[i] * h_s;
    for (c = 0; c < kNodes; ++c) {
      double t[3];
      load_integrals(kAt[c], x, t);
      r->kept[c][i] = exp(-kAt[c] * x);
      r->of[c][0][i] =
          h_s * (t[0] - 3.0 * t[1] + 2.0 * t[2]); /* the parabolas that are 1 at the beginning, the middle, the end */
      r->of[c][1][i] = h_s * (4.0 * t[1] - 4.0 * t[2]);
      r->of[c][2][i] = h_s * (2.0 * t[2] - t[1]);
      if (c == 1) r->of_constant[i] = h_s * t[0];
    }
  }
  r->lambda = s->lambda;
  r->step_s = h_s;
}

/* N of each mode. Returns 0, or 1 where a law has no value. */
static int load_at(live_room* r, const live_system* s, const double* z, double ambient_K, double* load) {
  const int n = thermal.n;
  int i;
  memset(r->rate, 0, (size_t)n * sizeof *r->rate);
  if (live_add_rate(r, s->drive, s->coefficient, z, ambient_K, r->rate)) return 1;
  to_modes(s->vectors, r->rate, load);
  for (i = 0; i < n; ++i) load[i] += s->constant_W[i] + ambient_K * s->per_ambient_W_K[i];
  return 0;
}

/* The state at kAt[c], by N as it is known. */
static void state_at(live_room* r, const live_system* s, int c) {
  const int n = thermal.n;
  int i;
  for (i = 0; i < n; ++i)
    r->error[i] = r->kept[c][i] * r->modes[i] + r->of[c][0][i] * r->load[0][i] + r->of[c][1][i] * r->load[1][i] +
                  r->of[c][2][i] * r->load[2][i];
  memset(r->z[c], 0, (size_t)n * sizeof *r->z[c]);
  add_transposed(n, n, s->vectors, r->error, r->z[c]);
}

/* The most that outputs can differ by where states differ by d or, without e, by d - e: in K, 2 um, 20 urad. */
static double size_of(const double* d, const double* e) {
  double sum = 0.0;
  int i;
  for (i = 0; i < thermal.n; ++i) sum += fabs(e ? d[i] - e[i] : d[i]) / thermal.nominal[i];
  return sum;
}

/* One step from r->modes with N at its beginning in r->load[0]; z[1] is the state at its end. Returns the estimated error
 * over the allowed one, or a negative number where N was not found. */
static double try_step(live_room* r, const live_system* s, double h_s, double ambient_K, double ambient_K_s) {
  const int n = thermal.n;
  const size_t bytes = (size_t)n * sizeof(double);
  int is_found = 0, j, c, i;
  take_step_length(r, s, h_s);
  memcpy(r->load[1], r->load[0], bytes);
  memcpy(r->load[2], r->load[0], bytes);
  for (j = 0; j < kMostIterations && !is_found; ++j) {
    double change = 0.0;
    for (c = 0; c < 2; ++c) {
      if (j > 0) memcpy(r->last[c], r->z[c], bytes);
      state_at(r, s, c);
      if (j > 0) change = fmax(change, size_of(r->z[c], r->last[c]));
    }
    if (!(change < HUGE_VAL)) return -1.0;
    for (c = 0; c < 2; ++c) {
      if (load_at(r, s, r->z[c], ambient_K + kAt[c] * h_s * ambient_K_s, r->load[1 + c])) return -1.0;
    }
    is_found = j > 0 && change <= kShareIterated * kTolerance;
  }
  if (!is_found && h_s > kShortest_s) return -1.0;
  state_at(r, s, 1);
  state_at(r, s, 2);
  if (load_at(r, s, r->z[2], ambient_K + kAt[2] * h_s * ambient_K_s, r->load[3])) return -1.0;
  /* If N leaves the parabola by C t (t - 1/2) (t - 1), that is -3/64 C at three quarters, the magnitude's integral is C /
   * 32. */
  for (i = 0; i < n; ++i)
    r->error[i] = 2.0 / 3.0 * r->of_constant[i] *
                  (r->load[3][i] + 0.125 * r->load[0][i] - 0.75 * r->load[1][i] - 0.375 * r->load[2][i]);
  memset(r->error_z, 0, bytes);
  add_transposed(n, n, s->vectors, r->error, r->error_z);
  {
    const double error = size_of(r->error_z, 0) / kTolerance;
    return error < HUGE_VAL ? error : -1.0;
  }
}

void live_forget(live_room* r) {
  r->lambda = 0;
}

/* Whether a thermostat switches within the step that was tried last, and then when: its modes are put into r->rate. N is the
 * parabola through its values. */
static int switched_within(live_room* r, const live_system* s, double h_s, double ambient_K, double ambient_K_s,
                           double* at_s) {
  double *const b = r->error, *const c = r->load[3];
  const mode_course course = {s->lambda, r->modes, r->load[0], b, c, s->probes_in_modes, s->is_on, ambient_K, ambient_K_s};
  int i, which;
  if (thermal.n_thermostats == 0) return -1;
  for (i = 0; i < thermal.n; ++i) {
    b[i] = (4.0 * r->load[1][i] - 3.0 * r->load[0][i] - r->load[2][i]) / h_s;
    c[i] = 2.0 * (r->load[0][i] - 2.0 * r->load[1][i] + r->load[2][i]) / (h_s * h_s);
  }
  which = first_switch(&course, h_s, at_s);
  if (which >= 0) modes_at(&course, *at_s, r->rate);
  return which;
}

const char* live_advance(live_room* r, const live_system* s, double* piece_s, double ambient_K, double ambient_K_s,
                         double* z, double* length_s, int* which) {
  const size_t n = (size_t)thermal.n;
  double t_s = 0.0, at_s = 0.0;
  *which = -1;
  to_modes(s->vectors, z, r->modes);
  if (load_at(r, s, z, ambient_K, r->load[0])) return "a law has no value at the temperatures of the machine";
  while (t_s < *piece_s * (1.0 - 1e-12)) {
    const double left_s = *piece_s - t_s, h_s = left_s / ceil(left_s / *length_s * (1.0 - 1e-9));
    const double error = try_step(r, s, h_s, ambient_K + t_s * ambient_K_s, ambient_K_s);
    const double fits_s = h_s * (error < 0.0 ? 0.25 : fmin(4.0, fmax(0.2, 0.9 * pow(fmax(error, 1e-12), -0.25))));
    if (!(error >= 0.0 && error <= 1.0) && h_s > kShortest_s) {
      *length_s = fmax(fits_s, kShortest_s);
      continue;
    }
    if (error < 0.0) return "a law has no value at the temperatures that the machine gets to";
    if (fits_s > *length_s || h_s > 0.999 * *length_s)
      *length_s = fmax(fits_s, kShortest_s); /* not if the end made it short */
    *which = switched_within(r, s, h_s, ambient_K + t_s * ambient_K_s, ambient_K_s, &at_s);
    if (*which >= 0) {
      *piece_s = t_s + at_s;
      memset(z, 0, n * sizeof *z);
      add_transposed(thermal.n, thermal.n, s->vectors, r->rate, z);
      return 0;
    }
    t_s += h_s;
    memcpy(z, r->z[1], n * sizeof *z);
    to_modes(s->vectors, z, r->modes);
    if (load_at(r, s, z, ambient_K + t_s * ambient_K_s, r->load[0]))
      return "a law has no value at the temperatures of the machine";
  }
  return 0;
}
