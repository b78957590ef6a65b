/* The state observer: the reduced machine and factors on its heat flows, corrected by thermometers at each sample (extended Kalman filter).
 * The same steps as compensation/predictors/observer.cpp of Driftwright, which says what they are, as long as readings agree; without the
 * learning, and without what it does while they do not: trust, tempered readings, sensors and ambients that are judged again.
 *
 * A sample is taken every period_s from the start on, by the readings that are set then: at events in model exchange, at the beginning of
 * the step that holds it in co-simulation. Outputs stay as they are until the next one. */
#include <math.h>
#include <string.h>

#include "model.h"
#include "symmetric_eigen.h"
#include "thermal.h"

const int model_kind_is_observer = 1;

/* As in observer.cpp. */
static const double kFlag = 5.0, kOutlier = 6.0, kMemory = 0.9, kZero = 2.0, kAmbientJump_K = 3.0, kAmbientJumpIn_s = 600.0,
                    kStart_K = 0.1;
enum { kRowsBack = 30, kRowsKept = kRowsBack + 2, kWarmRows = 10, kMostPieces = 32, kSteps = 12 };

/* Of a row: when, the ambient as told and believed, whether it is doubted, how many pieces; then readings, then pieces: length and drive. */
enum { kRowTime, kRowTold, kRowBelieved, kRowDoubted, kRowPieces, kRowHead };

static int n_factors(void) {
  return thermal.n_sources + thermal.n_exchanges;
}
static int n_all(void) {
  return thermal.n + n_factors() + 2;
}
static int piece_size(void) {
  return 1 + thermal.n_drive;
}
static size_t row_size(void) {
  return (size_t)(kRowHead + observer.n_sensors + kMostPieces * piece_size());
}
static size_t belief_size(void) {
  return (size_t)n_all() * (size_t)(n_all() + 1);
}
static double* take(double** room, size_t n) {
  double* const at = *room;
  *room += n;
  return at;
}

/* Where what is saved stands. */
typedef struct {
  double* n_rows;    /* samples taken */
  double* start_s;   /* time of the first */
  double* piece_s;   /* since when the drive is as it is */
  double* n_pieces;  /* since the last sample */
  double* n_history; /* beliefs kept, of the last rows */
  double* start_ambient_K;
  double *pieces, *start_state, *is_live, *mean_innovation, *last_s, *rows, *history, *mean, *covariance;
} view;

static view view_of(double* saved) {
  double* room = saved + kInputs + model_n_inputs();
  view v;
  v.n_rows = take(&room, 1);
  v.start_s = take(&room, 1);
  v.piece_s = take(&room, 1);
  v.n_pieces = take(&room, 1);
  v.n_history = take(&room, 1);
  v.start_ambient_K = take(&room, 1);
  v.pieces = take(&room, (size_t)(kMostPieces * piece_size()));
  v.start_state = take(&room, (size_t)thermal.n);
  v.is_live = take(&room, (size_t)observer.n_sensors);
  v.mean_innovation = take(&room, (size_t)observer.n_sensors);
  v.last_s = take(&room, (size_t)observer.n_sensors);
  v.rows = take(&room, kRowsKept * row_size());
  v.history = take(&room, kRowsBack * belief_size());
  v.mean = take(&room, (size_t)n_all());
  v.covariance = take(&room, (size_t)n_all() * (size_t)n_all());
  return v;
}

/* What a step of one drive and length does: z+ = decay z + gain f. */
typedef struct {
  int is_filled;
  double* key; /* coefficients, powers, length */
  double *decay, *gain;
} one_step;

typedef struct {
  int next_step;
  one_step steps[kSteps];
  double *key, *slope, *transition, *top, *by_factor, *load, *vector, *outside, *state, *eigen_values, *eigen_vectors,
      *eigen_work, *matrix;
} workshop;

static size_t key_size(void) {
  return (size_t)n_factors() + 1;
}
static size_t n_work(void) {
  const size_t n = (size_t)thermal.n, f = (size_t)n_factors(), all = (size_t)n_all();
  return kSteps * (key_size() + 2 * n * n) + key_size() + n * n + n * (n + f) + n * all + n * f + n + all + n + n + n +
         n * n + 2 * n + n * n;
}

size_t model_n_saved(void) {
  return (size_t)kInputs + (size_t)model_n_inputs() + 6 + (size_t)(kMostPieces * piece_size()) + (size_t)thermal.n +
         3 * (size_t)observer.n_sensors + kRowsKept * row_size() + (kRowsBack + 1) * belief_size();
}
size_t model_scratch_size(void) {
  return sizeof(workshop) + n_work() * sizeof(double);
}
int model_n_inputs(void) {
  return thermal.n_drive + 1 + observer.n_sensors;
}
int model_n_outputs(void) {
  return 2 + thermal.n_outputs + observer.n_sensors + 1;
}
int model_n_states(void) {
  return 0;
}
double* model_states(double* saved) {
  return saved;
}

int model_prepare(void* scratch) {
  workshop* const w = scratch;
  const size_t n = (size_t)thermal.n, f = (size_t)n_factors(), all = (size_t)n_all();
  double* room = (double*)(void*)(w + 1);
  int k;
  memset(w, 0, sizeof *w);
  for (k = 0; k < kSteps; ++k) {
    w->steps[k].key = take(&room, key_size());
    w->steps[k].decay = take(&room, n * n);
    w->steps[k].gain = take(&room, n * n);
  }
  w->key = take(&room, key_size());
  w->slope = take(&room, n * n);
  w->transition = take(&room, n * (n + f));
  w->top = take(&room, n * all);
  w->by_factor = take(&room, n * f);
  w->load = take(&room, n);
  w->vector = take(&room, all);
  w->outside = take(&room, n);
  w->state = take(&room, n);
  w->eigen_values = take(&room, n);
  w->eigen_vectors = take(&room, n * n);
  w->eigen_work = take(&room, 2 * n);
  w->matrix = take(&room, n * n);
  return 0;
}

void model_reset(double* saved, void* scratch) {
  int k;
  memset(saved, 0, model_n_saved() * sizeof *saved);
  for (k = 0; k <= observer.n_sensors; ++k)
    saved[kInputs + thermal.n_drive + k] = thermal.start_ambient_K + thermal.reference_degC;
  model_touched(scratch);
}

void model_touched(void* scratch) {
  (void)scratch; /* steps are found by what they are made of */
}

/* The drive has been as it is since piece_s: that becomes a piece. Returns 0 where there is no room for it. */
static int close_piece(double* saved, double until_s) {
  const view v = view_of(saved);
  const int n = (int)*v.n_pieces;
  double* piece;
  if (!(until_s > *v.piece_s)) return 1;
  if (n == kMostPieces) return 0;
  piece = v.pieces + n * piece_size();
  piece[0] = until_s - *v.piece_s;
  memcpy(piece + 1, saved + kInputs, (size_t)thermal.n_drive * sizeof *piece);
  *v.n_pieces = n + 1;
  *v.piece_s = until_s;
  return 1;
}

const char* model_before_input(double* saved, int input, double value) {
  const int is_reading = input > thermal.n_drive;
  if (!is_reading && !(fabs(value) < 1e300)) return "an input is no finite number";
  if (input < thermal.n_drive) {
    if (!(value >= 0.0 && value <= thermal.most_drive[input] * (1.0 + 1e-12)))
      return "an input is outside its min and max, between which the model was reduced";
    if (*view_of(saved).n_rows > 0.0 && saved[kInputs + input] != value && !close_piece(saved, saved[kTime]))
      return "the drive changes more than 32 times between two samples";
  }
  return 0;
}

void model_start(double* saved, void* scratch) {
  const view v = view_of(saved);
  const int n = thermal.n, all = n_all(), f = n_factors() + 1;
  int i, j;
  (void)scratch;
  memset(v.n_rows, 0, (model_n_saved() - (size_t)(v.n_rows - saved)) * sizeof *saved);
  *v.start_s = *v.piece_s = saved[kTime];
  for (i = 0; i < observer.n_sensors; ++i) {
    v.is_live[i] = 1.0;
    v.last_s[i] = -1.0;
  }
  for (i = 0; i < n; ++i) {
    for (j = 0; j < n; ++j) v.covariance[i * all + j] = kStart_K * kStart_K * thermal.ones[i] * thermal.ones[j];
  }
  for (i = 0; i < f; ++i) {
    v.mean[n + i] = observer.factor_mean[i];
    for (j = 0; j < f; ++j) v.covariance[(n + i) * all + n + j] = observer.factor_covariance[i * f + j];
  }
  v.covariance[(all - 1) * all + all - 1] = pow(kZero * 1e-6 * observer.drift_um, 2.0);
}

static double* row_at(const view* v, int row) {
  return v->rows + (size_t)(row % kRowsKept) * row_size();
}

/* The step of these coefficients and powers over h, or null where its decomposition fails. */
static const one_step* step_of(workshop* w, const double* drive, double h_s) {
  const int n = thermal.n;
  one_step* s;
  double *const coefficient = w->key, *const power = w->key + thermal.n_exchanges;
  int i, j, k;
  for (k = 0; k < thermal.n_exchanges; ++k) coefficient[k] = law_value(&thermal.coefficients[k], drive);
  for (k = 0; k < thermal.n_sources; ++k) power[k] = law_value(&thermal.powers[k], drive);
  w->key[key_size() - 1] = h_s;
  for (k = 0; k < kSteps; ++k) {
    s = &w->steps[k];
    if (s->is_filled && memcmp(s->key, w->key, key_size() * sizeof *s->key) == 0) return s;
  }
  s = &w->steps[w->next_step];
  w->next_step = (w->next_step + 1) % kSteps;
  s->is_filled = 0;
  thermal_matrix(coefficient, w->matrix);
  if (symmetric_eigen(n, w->matrix, w->eigen_values, w->eigen_vectors, w->eigen_work) != 0) return 0;
  memcpy(s->key, w->key, key_size() * sizeof *s->key);
  memset(s->decay, 0, (size_t)n * (size_t)n * sizeof *s->decay);
  memset(s->gain, 0, (size_t)n * (size_t)n * sizeof *s->gain);
  for (k = 0; k < n; ++k) {
    const double* const vector = w->eigen_vectors + k * n;
    double kept, of_constant, of_slope;
    decay_of(w->eigen_values[k] > 0.0 ? w->eigen_values[k] * h_s : 0.0, &kept, &of_constant, &of_slope);
    for (i = 0; i < n; ++i) {
      const double d = kept * vector[i], g = h_s * of_constant * vector[i];
      double *const decay = s->decay + i * n, *const gain = s->gain + i * n;
      for (j = 0; j < n; ++j) {
        decay[j] += d * vector[j];
        gain[j] += g * vector[j];
      }
    }
  }
  s->is_filled = 1;
  return s;
}

/* c += a b, with a n x m in rows of `stride`. */
static void add_product(int n, int m, int columns, const double* a, int stride, const double* b, int b_stride, double* c,
                        int c_stride) {
  int i, j, k;
  for (i = 0; i < n; ++i) {
    double* const row = c + i * c_stride;
    for (k = 0; k < m; ++k) {
      const double x = a[i * stride + k];
      const double* const other = b + k * b_stride;
      if (x == 0.0) continue;
      for (j = 0; j < columns; ++j) row[j] += x * other[j];
    }
  }
}

/* Factors change at random and return to what was learned. */
static void forget_factors(const view* v, double h_s) {
  const int n = thermal.n, f = n_factors(), all = n_all();
  const double walk = observer.factor_walk * observer.factor_walk * h_s / 3600.0, most = observer.factor * observer.factor;
  double *const p = v->covariance, *const factor = v->mean + n;
  int i, j;
  if (walk < most) {
    const double kept = sqrt(1.0 - walk / most);
    for (i = 0; i < f; ++i) {
      factor[i] = observer.factor_mean[i] + kept * (factor[i] - observer.factor_mean[i]);
      for (j = 0; j < all; ++j) {
        p[(n + i) * all + j] *= kept;
        p[j * all + n + i] *= kept;
      }
    }
  }
  for (i = 0; i < f; ++i) p[(n + i) * all + n + i] += walk;
}

/* Mean and covariance over h with this drive and ambient. */
static int step(const view* v, workshop* w, const double* drive, double ambient_K, double h_s) {
  const int n = thermal.n, f = n_factors(), all = n_all(), width = n + f;
  const one_step* const now = step_of(w, drive, h_s);
  const double *coefficient, *power;
  double *const p = v->covariance, *const factor = v->mean + n;
  int i, j, e, s;
  if (!now) return 0;
  coefficient = now->key;
  power = now->key + thermal.n_exchanges;
  memset(w->slope, 0, (size_t)n * (size_t)n * sizeof(double));
  memset(w->load, 0, (size_t)n * sizeof(double));
  for (s = 0; s < thermal.n_sources; ++s) {
    for (i = 0; i < n; ++i) {
      const double heat = power[s] * thermal.loads[s * n + i];
      w->by_factor[i * f + s] = heat;
      w->load[i] += heat;
    }
  }
  for (e = 0; e < thermal.n_exchanges; ++e) {
    const double* const g = thermal.exchanges + (size_t)e * (size_t)n * (size_t)n;
    const double c = coefficient[e], believed = factor[thermal.n_sources + e] * c;
    multiply(n, n, g, v->mean, w->outside);
    for (i = 0; i < n; ++i) {
      const double outside = ambient_K * thermal.to_ambient[e * n + i] + thermal.offsets[e * n + i];
      w->load[i] += c * outside;
      w->by_factor[i * f + thermal.n_sources + e] = c * (outside - w->outside[i]);
    }
    if (believed != 0.0) {
      for (i = 0; i < n * n; ++i) w->slope[i] -= believed * g[i];
    }
  }
  /* transition = [decay + gain slope, gain by_factor] */
  for (i = 0; i < n; ++i) {
    memcpy(w->transition + i * width, now->decay + i * n, (size_t)n * sizeof(double));
    memset(w->transition + i * width + n, 0, (size_t)f * sizeof(double));
  }
  add_product(n, n, n, now->gain, n, w->slope, n, w->transition, width);
  add_product(n, n, f, now->gain, n, w->by_factor, f, w->transition + n, width);
  for (i = 0; i < n; ++i) {
    for (j = 0; j < f; ++j) w->load[i] += w->by_factor[i * f + j] * factor[j];
  }
  multiply(n, n, now->decay, v->mean, w->state);
  multiply(n, n, now->gain, w->load, w->outside);
  for (i = 0; i < n; ++i) v->mean[i] = w->state[i] + w->outside[i];
  memset(w->top, 0, (size_t)n * (size_t)all * sizeof(double));
  add_product(n, width, all, w->transition, width, p, all, w->top, all);
  for (i = 0; i < n; ++i) {
    for (j = n; j < all; ++j) p[i * all + j] = p[j * all + i] = w->top[i * all + j];
  }
  for (i = 0; i < n; ++i) {
    for (j = 0; j < n; ++j) {
      const double *const a = w->top + i * all, *const b = w->transition + j * width;
      double sum = 0.0;
      int k;
      for (k = 0; k < width; ++k) sum += a[k] * b[k];
      p[i * all + j] = sum;
    }
  }
  forget_factors(v, h_s);
  return 1;
}

/* From the row before to row i. */
static int advance(const view* v, workshop* w, int i) {
  const double *const before = row_at(v, i - 1), *const row = row_at(v, i);
  const double* piece = row + kRowHead + observer.n_sensors;
  const int is_doubted = row[kRowDoubted] != 0.0 || before[kRowDoubted] != 0.0;
  double from_s = before[kRowTime];
  int k;
  for (k = 0; k < (int)row[kRowPieces]; ++k, piece += piece_size()) {
    const double until_s = from_s + piece[0];
    while (from_s < until_s - 1e-9) {
      const double n_left = ceil((until_s - from_s) / observer.longest_step_s - 1e-9), h_s = (until_s - from_s) / n_left;
      const double share = (from_s + 0.5 * h_s - before[kRowTime]) / (row[kRowTime] - before[kRowTime]);
      const double ambient = is_doubted ? row[kRowBelieved] : before[kRowTold] + (row[kRowTold] - before[kRowTold]) * share;
      if (!step(v, w, piece + 1, ambient, h_s)) return 0;
      from_s += h_s;
    }
    from_s = until_s;
  }
  return 1;
}

/* Takes one reading: expectation row . mean, of `length` numbers. */
static void correct(const view* v, workshop* w, const double* gradient, int length, double innovation, double variance) {
  const int all = n_all();
  double total = variance;
  int i, j;
  for (i = 0; i < all; ++i) {
    double sum = 0.0;
    for (j = 0; j < length; ++j) sum += v->covariance[i * all + j] * gradient[j];
    w->vector[i] = sum;
  }
  for (j = 0; j < length; ++j) total += gradient[j] * w->vector[j];
  for (i = 0; i < all; ++i) {
    const double x = w->vector[i] / total;
    v->mean[i] += x * innovation;
    for (j = 0; j < all; ++j) v->covariance[i * all + j] -= x * w->vector[j];
  }
}

static double spread2(const view* v, const double* gradient, int length) {
  const int all = n_all();
  double total = 0.0;
  int i, j;
  for (i = 0; i < length; ++i) {
    double sum = 0.0;
    for (j = 0; j < length; ++j) sum += v->covariance[i * all + j] * gradient[j];
    total += gradient[i] * sum;
  }
  return total;
}

static int take_row(const view* v, workshop* w, int i) {
  const double* const row = row_at(v, i);
  const double t_s = row[kRowTime];
  int k, j;
  if (i > 0 && !advance(v, w, i)) return 0;
  for (k = 0; k < observer.n_sensors; ++k) {
    const double read = row[kRowHead + k];
    const int output = observer.sensor_output[k];
    const double* const gradient = thermal.outputs + (size_t)output * (size_t)thermal.n;
    double expected, variance, innovation, spread, since_s;
    if (v->is_live[k] == 0.0 || read != read) continue;
    expected = thermal.outputs_ambient[output] * row[kRowBelieved] + thermal.reference_degC;
    for (j = 0; j < thermal.n; ++j) expected += gradient[j] * v->mean[j];
    since_s = v->last_s[k] < *v->start_s ? observer.period_s : t_s - v->last_s[k];
    v->last_s[k] = t_s;
    variance = observer.reading_K * observer.reading_K;
    variance +=
        observer.model_K * observer.model_K * (observer.model_holds_s > since_s ? observer.model_holds_s / since_s : 1.0);
    spread = sqrt(spread2(v, gradient, thermal.n) + variance);
    innovation = fmin(fmax(read - expected, -kOutlier * spread), kOutlier * spread);
    v->mean_innovation[k] = kMemory * v->mean_innovation[k] + (1.0 - kMemory) * innovation / spread;
    if (fabs(innovation) < kOutlier * spread) correct(v, w, gradient, thermal.n, innovation, variance);
  }
  return 1;
}

static int worst_suspect(const view* v, int row) {
  double most = kFlag * sqrt((1.0 - kMemory) / (1.0 + kMemory));
  int worst = -1, k;
  if (row < kWarmRows) return -1;
  for (k = 0; k < observer.n_sensors; ++k) {
    if (v->is_live[k] != 0.0 && fabs(v->mean_innovation[k]) > most) {
      most = fabs(v->mean_innovation[k]);
      worst = k;
    }
  }
  return worst;
}

static void forget_readings(const view* v) {
  int k;
  for (k = 0; k < observer.n_sensors; ++k) {
    v->mean_innovation[k] = 0.0;
    v->last_s[k] = *v->start_s - 1.0;
  }
}

/* The sample at a time. Returns 0, or what is wrong. */
static const char* sample(double* saved, void* scratch, double t_s) {
  static const char* const kFails = "the decomposition of the conduction matrix did not converge";
  const view v = view_of(saved);
  workshop* const w = scratch;
  const int i = (int)*v.n_rows;
  double* const row = row_at(&v, i);
  const double told_K = saved[kInputs + thermal.n_drive] - thermal.reference_degC;
  int k, suspect;
  if (i > 0 && !close_piece(saved, t_s)) return "the drive changes more than 32 times between two samples";
  row[kRowTime] = t_s;
  row[kRowTold] = row[kRowBelieved] = told_K;
  row[kRowDoubted] = 0.0;
  row[kRowPieces] = *v.n_pieces;
  memcpy(row + kRowHead, saved + kInputs + thermal.n_drive + 1, (size_t)observer.n_sensors * sizeof *row);
  memcpy(row + kRowHead + observer.n_sensors, v.pieces, (size_t)(kMostPieces * piece_size()) * sizeof *row);
  *v.n_pieces = 0.0;
  *v.piece_s = t_s;
  if (i == 0) {
    forget_readings(&v);
    *v.start_ambient_K = told_K;
    for (k = 0; k < thermal.n; ++k)
      v.start_state[k] = v.mean[k] = thermal.start[k] + (told_K - thermal.start_ambient_K) * thermal.ones[k];
  } else {
    const double* const before = row_at(&v, i - 1);
    const double longer = (t_s - before[kRowTime]) / kAmbientJumpIn_s,
                 most_K = kAmbientJump_K * (longer > 1.0 ? longer : 1.0);
    if (fabs(told_K - before[kRowBelieved]) > most_K) {
      row[kRowDoubted] = 1.0;
      row[kRowBelieved] = before[kRowBelieved];
    }
  }
  memcpy(v.history + (size_t)(i % kRowsBack) * belief_size(), v.mean, belief_size() * sizeof *row);
  if (*v.n_history < kRowsBack) *v.n_history += 1.0;
  if (!take_row(&v, w, i)) return kFails;
  suspect = worst_suspect(&v, i);
  if (suspect >= 0) { /* back to before its innovations began to grow, and on without it */
    const int first = i - (int)*v.n_history + 1;
    v.is_live[suspect] = 0.0;
    memcpy(v.mean, v.history + (size_t)(first % kRowsBack) * belief_size(), belief_size() * sizeof *row);
    forget_readings(&v);
    for (k = first; k <= i; ++k) {
      if (!take_row(&v, w, k)) return kFails;
    }
    *v.n_history = 0.0;
  }
  *v.n_rows = i + 1;
  return 0;
}

double model_next_event_s(const double* saved) {
  const double* const of_rows = saved + kInputs + model_n_inputs(); /* n_rows, then start_s */
  return of_rows[1] + of_rows[0] * observer.period_s;
}

static double tiny_s(double t_s) {
  return 1e-9 * (fabs(t_s) + observer.period_s);
}

const char* model_event(double* saved, void* scratch) {
  const double next_s = model_next_event_s(saved);
  return saved[kTime] >= next_s - tiny_s(next_s) ? sample(saved, scratch, next_s) : 0;
}

const char* model_step(double* saved, void* scratch, double h_s) {
  const double end_s = saved[kTime] + h_s;
  for (;;) {
    const double next_s = model_next_event_s(saved);
    const char* wrong;
    if (next_s >= end_s - tiny_s(end_s)) break;
    wrong = sample(saved, scratch, next_s);
    if (wrong) return wrong;
  }
  saved[kTime] = end_s;
  return 0;
}

void model_outputs(const double* saved, void* scratch, double* outputs) {
  /* The view only points; nothing is written through it. */
  const view v = view_of((double*)saved);
  workshop* const w = scratch;
  const int n = thermal.n, all = n_all(), rows = (int)*v.n_rows;
  const double* const l = thermal.outputs + (size_t)observer.drift_output * (size_t)n;
  const double* const z = rows > 0 ? v.mean : thermal.start;
  const double ambient = rows > 0 ? row_at(&v, rows - 1)[kRowBelieved] : thermal.start_ambient_K;
  const double scale = 1.0 + v.mean[all - 2];
  double unscaled = 0.0, variance;
  int i, j;
  for (i = 0; i < n; ++i) unscaled += rows > 0 ? l[i] * (z[i] - v.start_state[i]) : 0.0;
  outputs[0] =
      rows > 0 ? 1e6 * (scale * unscaled + thermal.outputs_ambient[observer.drift_output] * (ambient - *v.start_ambient_K))
               : 0.0;
  for (i = 0; i < all; ++i) w->vector[i] = 0.0;
  for (i = 0; i < n; ++i) w->vector[i] = scale * l[i];
  w->vector[all - 2] = unscaled;
  variance = 0.0;
  for (i = 0; i < all; ++i) {
    double sum = 0.0;
    if (w->vector[i] == 0.0) continue;
    for (j = 0; j < all; ++j) sum += v.covariance[i * all + j] * w->vector[j];
    variance += w->vector[i] * sum;
  }
  outputs[1] = rows > 0 && variance > 0.0 ? 1e6 * sqrt(variance) : 0.0;
  outputs += 2;
  multiply(thermal.n_outputs, n, thermal.outputs, z, outputs);
  for (i = 0; i < thermal.n_outputs; ++i)
    outputs[i] = thermal.output_factor[i] * (outputs[i] + thermal.outputs_ambient[i] * ambient) + thermal.output_offset[i];
  outputs += thermal.n_outputs;
  for (i = 0; i < observer.n_sensors; ++i) outputs[i] = v.is_live[i] == 0.0 ? 1.0 : 0.0;
  outputs[observer.n_sensors] = rows > 0 ? row_at(&v, rows - 1)[kRowDoubted] : 0.0;
}

void model_derivatives(const double* saved, void* scratch, double* derivatives) {
  (void)saved;
  (void)scratch;
  (void)derivatives;
}

void model_add_sensitivity(const double* saved, void* scratch, int known_is_state, int known, double seed, double* outputs,
                           double* derivatives) {
  (void)saved;
  (void)scratch;
  (void)known_is_state;
  (void)known;
  (void)seed;
  (void)outputs;
  (void)derivatives;
}
