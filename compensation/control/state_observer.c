/* See state_observer.h. One file, so that a control needs no more than it and its filter. */
#include "state_observer.h"

#include <math.h>
#include <string.h>

#ifdef __FAST_MATH__
#error "state_observer.c marks missing readings by NAN: compile it without -ffast-math"
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#endif

static const double kFlag = 5.0;       /* deviations of the mean innovation */
static const double kOutlier = 6.0;    /* deviations of one innovation; beyond this the reading is ignored */
static const double kMemory = 0.9;     /* factor of the mean innovation from row to row */
static const double kFoundWrong = 2.0; /* times most_apart: more than chance or a passing disagreement */
static const double kChance = 3.0902;  /* deviations of a normal number that one of a thousand is above */
static const double kAgreesFor_s =
    28800.0;                      /* of agreement, before a sensor, or the model, counts as right again: a work shift */
static const double kStale = 5.0; /* intervals without a reading, after which a sensor is silent; as the fail-safe has it */
static const double kForgetStep = 0.8;        /* from row to row, of a longer interval */
static const double kGap = 2.5;               /* intervals between rows, beyond which the drive in between is unknown */
static const double kAmbientJump_K = 3.0;     /* an ambient never changes by more from row to row */
static const double kAmbientJumpIn_s = 600.0; /* for more distant rows, within this time */
enum {
  kReturn = kObserverRowsBack, /* rows by which the filter returns when a sensor is dropped */
  kWarm = kObserverRowsWarm,   /* 1 / (1 - kMemory) */
  kAmbients = kObserverRowsBack + 2
};

#define NUMBERS(type) (sizeof(type) / sizeof(double))

static size_t belief_size(const state_observer* o) {
  const size_t all = (size_t)observer_n_all(&o->machine);
  return all * (all + 1);
}
static size_t history_size(const state_observer* o) {
  return o->keeps_all ? 0 : kReturn * belief_size(o);
}
/* What changes when a sensor is dropped or the ambient is judged again: the belief, the sensors, the ambients, two times. */
static size_t kept_size(const state_observer* o) {
  return belief_size(o) + (size_t)o->n_sensors * NUMBERS(observer_sensor) + 2 * kAmbients + 2;
}

size_t observer_n_remembered(const state_observer* of) {
  return NUMBERS(observer_memory) + (size_t)of->n_sensors * (NUMBERS(observer_sensor) + NUMBERS(observer_reading)) +
         2 * kAmbients + history_size(of) + observer_filter_n_remembered(&of->machine);
}

size_t observer_n_room(const state_observer* of, int n_steps, int n_modes) {
  return kept_size(of) + (size_t)observer_n_all(&of->machine) + observer_filter_n_room(&of->machine, n_steps, n_modes);
}

observer_run observer_run_in(const state_observer* of, double* remembered, double* room, int n_steps, int n_modes) {
  observer_run run;
  double* at = remembered;
  memset(&run, 0, sizeof run);
  run.of = of;
  run.memory = (observer_memory*)(void*)at;
  at += NUMBERS(observer_memory);
  run.sensors = (observer_sensor*)(void*)at;
  at += (size_t)of->n_sensors * NUMBERS(observer_sensor);
  run.readings = (observer_reading*)(void*)at;
  at += (size_t)of->n_sensors * NUMBERS(observer_reading);
  run.ambient_K = at;
  run.is_doubted = at + kAmbients;
  run.history = at + 2 * kAmbients;
  at = run.history + history_size(of);
  run.kept = room;
  run.gradient = room + kept_size(of);
  run.filter.machine = &of->machine;
  run.filter.settings = &of->settings;
  run.filter.factor_mean = of->factor_mean;
  run.filter.factor_covariance = of->factor_covariance;
  run.filter.with_drift = of->with_drift;
  observer_filter_place(&run.filter, at, run.gradient + observer_n_all(&of->machine), n_steps, n_modes);
  return run;
}

void observer_clear_room(const observer_run* run) {
  observer_filter_clear_room(&run->filter);
}

static const double* output_row(const observer_run* run, int output) {
  return run->of->outputs + (size_t)output * (size_t)run->of->machine.n;
}
static double larger(double a, double b) {
  return a < b ? b : a;
}
static double smaller(double a, double b) {
  return b < a ? b : a;
}
static double longest_step_s(const observer_run* run) {
  return kGap * larger(run->of->settings.period_s, run->memory->usual_step_s);
}
/* Deviation of the mean of white innovations of deviation 1. */
static double mean_deviation(void) {
  return sqrt((1.0 - kMemory) / (1.0 + kMemory));
}

static void forget_agreement(observer_agreement* a) {
  a->agreed_s = -1.0;
  a->mean_C = NAN;
  a->low_C = a->high_C = 0.0;
}
static void take_agreement(observer_agreement* a, int agrees, double step_s, double expected_C) {
  a->mean_C = isnan(a->mean_C) ? expected_C : kMemory * a->mean_C + (1.0 - kMemory) * expected_C;
  if (!agrees) {
    a->agreed_s = -1.0;
  } else if (a->agreed_s < 0.0) {
    a->agreed_s = 0.0;
    a->low_C = a->high_C = a->mean_C;
  } else {
    a->agreed_s += step_s;
    a->low_C = smaller(a->low_C, a->mean_C);
    a->high_C = larger(a->high_C, a->mean_C);
  }
}
static int is_long(const observer_agreement* a, double moved_K) {
  return a->agreed_s >= kAgreesFor_s && a->high_C - a->low_C > moved_K;
}

void observer_start(const observer_run* run) {
  const state_observer* const o = run->of;
  int k, i;
  memset(run->memory, 0, (size_t)(run->history - (double*)run->memory) * sizeof(double));
  run->memory->start_ambient_K = o->start_ambient_K;
  run->memory->first_drift_row = -1.0;
  run->memory->last_drift_s = NAN;
  forget_agreement(&run->memory->model);
  for (k = 0; k < o->n_sensors; ++k) {
    const double* const row = output_row(run, o->sensor_output[k]);
    run->sensors[k].is_live = 1.0;
    run->sensors[k].dropped_s = run->sensors[k].last_s = NAN;
    forget_agreement(&run->sensors[k].agreement);
    run->readings[k].last_s = run->readings[k].deviation_K = run->readings[k].innovation_K = NAN;
    for (i = 0; i < o->machine.n; ++i) run->readings[k].sees_state += row[i] != 0.0;
  }
  observer_filter_start(&run->filter, o->start, o->rest_W);
}

/* ---- the ambient ---- */

static double ambient_at(const observer_run* run, long row) {
  return row < 0 ? run->of->start_ambient_K : run->ambient_K[row % kAmbients];
}
static int doubts_at(const observer_run* run, long row) {
  return row >= 0 && run->is_doubted[row % kAmbients] != 0.0;
}
static void set_ambient(const observer_run* run, long row, double ambient_K, int is_doubted) {
  run->ambient_K[row % kAmbients] = ambient_K;
  run->is_doubted[row % kAmbients] = is_doubted;
}

static void take_ambient(const observer_run* run, const observer_rows* rows, long row) {
  const double t_s = rows->time_s(rows->of, row), told_K = rows->ambient_K(rows->of, row, t_s);
  double used_K, most_K;
  int is_doubted;
  if (row == 0) {
    set_ambient(run, row, told_K, 0);
    return;
  }
  used_K = ambient_at(run, row - 1);
  most_K = kAmbientJump_K * larger(1.0, (t_s - rows->time_s(rows->of, row - 1)) / kAmbientJumpIn_s);
  is_doubted = fabs(told_K - used_K) > most_K;
  if (is_doubted && !doubts_at(run, row - 1)) {
    run->memory->doubted_row = (double)row;
    run->memory->doubted_s = t_s;
  }
  set_ambient(run, row, is_doubted ? used_K : told_K, is_doubted);
}

static double ambient_between(const observer_run* run, const observer_rows* rows, long row, double t_s) {
  return doubts_at(run, row) || doubts_at(run, row - 1) ? ambient_at(run, row) : rows->ambient_K(rows->of, row, t_s);
}

void observer_recall_ambient(const observer_run* run, double ambient_K, int is_doubted) {
  if (run->memory->row > 0.0) set_ambient(run, (long)run->memory->row - 1, ambient_K, is_doubted);
}

/* ---- one row ---- */

static double drift_m(const observer_run* run, long row) {
  const state_observer* const o = run->of;
  const double scale = 1.0 + run->filter.mean[run->filter.n_all - 2];
  return scale * observer_filter_unscaled_drift_m(&run->filter, output_row(run, o->drift_output)) +
         o->outputs_ambient[o->drift_output] * (ambient_at(run, row) - run->memory->start_ambient_K);
}

static double expected_C(const observer_run* run, int sensor, long row) {
  const int output = run->of->sensor_output[sensor];
  const double* const h = output_row(run, output);
  double sum = 0.0;
  int i;
  for (i = 0; i < run->of->machine.n; ++i) sum += h[i] * run->filter.mean[i];
  return sum + run->of->outputs_ambient[output] * ambient_at(run, row) + run->of->reference_degC;
}

/* Variance from a reading's white error and the model's own error, which neighbouring readings share. last_s: previous time;
 * NaN: none. */
static double variance_of(const observer_run* run, double white, double model, double t_s, double* last_s) {
  const observer_settings* const s = &run->of->settings;
  const double step_s = isnan(*last_s) ? s->period_s : t_s - *last_s;
  *last_s = t_s;
  return white * white + model * model * larger(1.0, s->model_holds_s / step_s);
}

/* From the row before to this row. */
static int advance(const observer_run* run, const observer_rows* rows, long row) {
  observer_memory* const m = run->memory;
  const double before_s = rows->time_s(rows->of, row - 1), to_s = rows->time_s(rows->of, row), length_s = to_s - before_s;
  const double longest_s = longest_step_s(run);
  const int is_gap = !run->of->with_drift && length_s > longest_s;
  double from_s = before_s, end_s;
  int piece;
  if (is_gap) observer_filter_begin_gap(&run->filter);
  m->usual_step_s = larger(smaller(length_s, longest_s), kForgetStep * m->usual_step_s);
  for (piece = 0; from_s < to_s && rows->piece(rows->of, row, piece, &end_s); ++piece) {
    const double until_s = smaller(to_s, end_s);
    while (from_s < until_s - 1e-9) {
      const double n_left = ceil((until_s - from_s) / run->of->settings.longest_step_s - 1e-9);
      const double h_s = (until_s - from_s) / n_left;
      const double ambient_K = ambient_between(run, rows, row, from_s + 0.5 * h_s);
      int wrong = rows->laws(rows->of, row, piece, from_s, ambient_K, run->filter.power_W, run->filter.coefficient);
      if (wrong) return wrong;
      wrong = observer_filter_step(&run->filter, ambient_K, h_s, is_gap);
      if (wrong) return kObserverNotDecomposed;
      from_s += h_s;
    }
    from_s = larger(from_s, until_s);
  }
  if (is_gap) observer_filter_end_gap(&run->filter);
  return 0;
}

/* What readings have said of the model in rows that were followed. */
typedef struct {
  double squares; /* of normalised innovations */
  int n_readings;
} evidence;

/* temper: factor on the variance of readings, while they are further from the model than trust allows. */
static int take_row(const observer_run* run, const observer_rows* rows, long row, double temper, evidence* seen) {
  const state_observer* const o = run->of;
  observer_memory* const m = run->memory;
  const double t_s = rows->time_s(rows->of, row), step_s = smaller(t_s - m->now_s, longest_step_s(run));
  double drift_um;
  int k;
  if (row > 0) {
    const int wrong = advance(run, rows, row);
    if (wrong) return wrong;
  }
  m->now_s = t_s;
  for (k = 0; k < o->n_sensors; ++k) {
    observer_sensor* const sensor = &run->sensors[k];
    observer_reading* const reading = &run->readings[k];
    const double read_C = rows->reading_C(rows->of, row, k);
    double expected, variance, expected_variance, spread, innovation;
    reading->innovation_K = reading->deviation_K = NAN;
    if (isnan(read_C)) continue;
    reading->last_s = t_s;
    ++seen->n_readings;
    expected = expected_C(run, k, row);
    variance = variance_of(run, o->settings.reading_K, o->settings.model_K, t_s, &sensor->last_s);
    expected_variance = observer_filter_variance(&run->filter, output_row(run, o->sensor_output[k]), o->machine.n);
    spread = reading->spread_K = sqrt(expected_variance + variance);
    reading->deviation_K = read_C - expected;
    innovation = smaller(larger(reading->deviation_K, -kOutlier * spread), kOutlier * spread);
    sensor->mean_innovation = kMemory * sensor->mean_innovation + (1.0 - kMemory) * innovation / spread;
    take_agreement(&sensor->agreement, fabs(sensor->mean_innovation) <= kFlag * mean_deviation(), step_s, expected);
    if (sensor->is_live == 0.0) {
      if (is_long(&sensor->agreement, 2.0 * kFlag * mean_deviation() * spread)) reading->returns = 1.0;
      continue;
    }
    reading->innovation_K = innovation;
    seen->squares += innovation * innovation / (spread * spread);
    if (fabs(innovation) < kOutlier * spread)
      observer_filter_correct(&run->filter, expected_variance, innovation, temper * variance);
  }
  drift_um = o->with_drift ? rows->drift_um(rows->of, row) : NAN;
  if (isfinite(drift_um)) {
    const int zero = run->filter.n_all - 1;
    double variance, expected_variance;
    /* The drift counts from the start of the run; if it is missing there, from the model's drift at the first measured
     * value. */
    if (m->first_drift_row < 0.0 || m->first_drift_row >= (double)row) {
      m->first_drift_row = (double)row;
      m->drift_zero_m = 1e-6 * drift_um - (row > 0 ? drift_m(run, row) : 0.0);
    }
    variance = 1e-12 * variance_of(run, o->settings.drift_um, o->settings.model_um, t_s, &m->last_drift_s);
    observer_filter_drift_gradient(&run->filter, output_row(run, o->drift_output), run->gradient);
    run->gradient[zero] = 1.0;
    expected_variance = observer_filter_variance(&run->filter, run->gradient, run->filter.n_all);
    observer_filter_correct(&run->filter, expected_variance,
                            1e-6 * drift_um - m->drift_zero_m - drift_m(run, row) - run->filter.mean[zero], variance);
  }
  return 0;
}

/* ---- which readings it uses ---- */

int observer_is_silent(const observer_run* run, int sensor) {
  const observer_memory* const m = run->memory;
  const double last_s = isnan(run->readings[sensor].last_s) ? m->start_s : run->readings[sensor].last_s;
  return m->now_s - last_s > kStale * larger(run->of->settings.period_s, m->usual_step_s);
}

static int tells_of_model(const observer_run* run, int sensor) {
  return run->sensors[sensor].is_live != 0.0 && run->readings[sensor].sees_state != 0.0 && !observer_is_silent(run, sensor);
}

static int has_live_sensor(const observer_run* run) {
  int k;
  for (k = 0; k < run->of->n_sensors; ++k) {
    if (tells_of_model(run, k)) return 1;
  }
  return 0;
}

/* Up to a third of the sensors, at least one: more differing sensors show that the model is wrong. None after the model was
 * found wrong, until it has agreed for long, because the sensor that shows its error best would be dropped first. */
static int may_drop(const observer_run* run) {
  const int third = run->of->n_sensors / 3;
  int k, n_dropped = 0;
  if (run->memory->is_model_wrong != 0.0) return 0;
  for (k = 0; k < run->of->n_sensors; ++k) n_dropped += run->sensors[k].is_live == 0.0;
  return (third > 1 ? third : 1) - n_dropped;
}

double observer_apart(const observer_run* run) {
  const double n_in_means = larger(run->memory->row - run->memory->means_from, 1.0);
  /* of the mean of white innovations that started at 0 */
  const double variance = (1.0 - kMemory) / (1.0 + kMemory) * (1.0 - pow(kMemory, 2.0 * n_in_means));
  double sum = 0.0, worst = 0.0, third;
  int k, n = 0;
  for (k = 0; k < run->of->n_sensors; ++k) {
    const double mean = run->sensors[k].mean_innovation, square = mean * mean / variance;
    if (!tells_of_model(run, k)) continue;
    sum += square;
    worst = larger(worst, square);
    ++n;
  }
  if (n == 0) return 0.0;
  if (n > 1 && may_drop(run) > 0) {
    sum -= worst;
    --n;
  }
  third = 2.0 / (9.0 * n); /* Wilson & Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684 */
  return sum / (n * pow(1.0 - third + kChance * sqrt(third), 3.0));
}

double observer_trust(const observer_run* run) {
  double beyond;
  if (run->of->n_sensors == 0) return 1.0;
  if (!has_live_sensor(run)) return 0.0;
  beyond = observer_apart(run) / run->of->settings.most_apart;
  return beyond > 1.0 ? 1.0 / beyond : 1.0;
}

/* The active sensor with the largest mean innovation, if one exceeds the flag; else -1. */
static int worst_suspect(const observer_run* run, long row) {
  double most = kFlag * mean_deviation();
  int worst = -1, k;
  if (row < kWarm) return -1;
  for (k = 0; k < run->of->n_sensors; ++k) {
    const double mean = fabs(run->sensors[k].mean_innovation);
    if (run->sensors[k].is_live == 0.0 || !(mean > most)) continue;
    most = mean;
    worst = k;
  }
  return worst;
}

static void take_back(const observer_run* run, int sensor) {
  run->sensors[sensor].is_live = 1.0;
  run->sensors[sensor].dropped_s = NAN;
  run->sensors[sensor].mean_innovation = 0.0;
}

static void keep(const observer_run* run) {
  const size_t n_belief = belief_size(run->of), n_sensors = (size_t)run->of->n_sensors * NUMBERS(observer_sensor);
  double* at = run->kept;
  memcpy(at, run->filter.mean, n_belief * sizeof *at);
  if (n_sensors > 0) memcpy(at + n_belief, run->sensors, n_sensors * sizeof *at);
  at += n_belief + n_sensors;
  memcpy(at, run->ambient_K, 2 * kAmbients * sizeof *at);
  at[2 * kAmbients] = run->memory->means_from;
  at[2 * kAmbients + 1] = run->memory->last_drift_s;
}
static void restore(const observer_run* run) {
  const size_t n_belief = belief_size(run->of), n_sensors = (size_t)run->of->n_sensors * NUMBERS(observer_sensor);
  const double* at = run->kept;
  memcpy(run->filter.mean, at, n_belief * sizeof *at);
  if (n_sensors > 0) memcpy(run->sensors, at + n_belief, n_sensors * sizeof *at);
  at += n_belief + n_sensors;
  memcpy(run->ambient_K, at, 2 * kAmbients * sizeof *at);
  run->memory->means_from = at[2 * kAmbients];
  run->memory->last_drift_s = at[2 * kAmbients + 1];
}

static long first_kept_row(const observer_run* run, long row) {
  return row - (long)run->memory->n_history + 1;
}

/* From what was believed before the first of the rows kept, as if nothing had been read before it, to this row again. */
static int follow_again(const observer_run* run, const observer_rows* rows, long row, double temper, evidence* seen) {
  const long first = first_kept_row(run, row);
  const size_t n_belief = belief_size(run->of);
  long i;
  int k;
  memcpy(run->filter.mean, run->history + (size_t)(first % kReturn) * n_belief, n_belief * sizeof(double));
  for (k = 0; k < run->of->n_sensors; ++k) {
    run->sensors[k].mean_innovation = 0.0;
    run->sensors[k].last_s = NAN;
  }
  run->memory->means_from = (double)first;
  run->memory->last_drift_s = NAN;
  for (i = first; i <= row; ++i) {
    const int wrong = take_row(run, rows, i, temper, seen);
    if (wrong) return wrong;
  }
  return 0;
}

/* Follows the last rows with the held ambient and with the one that the thermometer has shown since, and keeps what the
 * other sensors contradict less. */
static int settle_ambient(const observer_run* run, const observer_rows* rows, long row) {
  observer_memory* const m = run->memory;
  const long first = first_kept_row(run, row), doubted = (long)m->doubted_row;
  evidence held = {0.0, 0}, shown = {0.0, 0};
  int wrong, k;
  long i;
  keep(run);
  wrong = follow_again(run, rows, row, 1.0, &held);
  if (wrong) return wrong;
  for (i = doubted > first ? doubted : first; i <= row; ++i)
    set_ambient(run, i, rows->ambient_K(rows->of, i, rows->time_s(rows->of, i)), 0);
  wrong = follow_again(run, rows, row, 1.0, &shown);
  if (wrong) return wrong;
  if (shown.squares <= held.squares && shown.n_readings > 0) {
    m->n_history = 0.0;
    m->is_model_wrong = 0.0;
    for (k = 0; k < run->of->n_sensors; ++k) { /* what was judged by the held ambient is judged again */
      if (run->sensors[k].is_live == 0.0 && run->sensors[k].dropped_s >= m->doubted_s) take_back(run, k);
    }
    return 0;
  }
  restore(run);
  m->doubted_row = (double)row; /* asked again after as many rows */
  return 0;
}

/* A sensor that has agreed again for long enough, over temperatures that moved by more than a stuck one could agree with, is
 * used again; so is a model that was found wrong. */
static void use_again(const observer_run* run, long row, double step_s) {
  const int n = run->of->n_sensors;
  double expected = 0.0, widest_K = 0.0;
  int k;
  for (k = 0; k < n; ++k) {
    if (run->readings[k].returns != 0.0) take_back(run, k);
  }
  if (!has_live_sensor(run)) return;
  for (k = 0; k < n; ++k) {
    expected += expected_C(run, k, row) / n;
    widest_K = larger(widest_K, run->readings[k].spread_K);
  }
  take_agreement(&run->memory->model, observer_apart(run) <= run->of->settings.most_apart, step_s, expected);
  if (is_long(&run->memory->model, 2.0 * kFlag * mean_deviation() * widest_K)) run->memory->is_model_wrong = 0.0;
}

/* Follows the last rows without a sensor. If the others then agree with the model, it stays dropped; otherwise the model is
 * wrong. */
static int give_up(const observer_run* run, const observer_rows* rows, long row, int sensor) {
  observer_sensor* const s = &run->sensors[sensor];
  evidence seen = {0.0, 0};
  int wrong;
  keep(run);
  s->is_live = 0.0;
  s->dropped_s = rows->time_s(rows->of, row);
  forget_agreement(&s->agreement);
  wrong = follow_again(run, rows, row, 1.0, &seen);
  if (wrong) return wrong;
  if (observer_apart(run) <= run->of->settings.most_apart) {
    run->memory->n_history = 0.0;
    return 0;
  }
  restore(run);
  run->memory->again_row = (double)(row + kWarm);
  return 0;
}

static void begin(const observer_run* run, const observer_rows* rows) {
  const state_observer* const o = run->of;
  observer_memory* const m = run->memory;
  double* const z = run->filter.start_state;
  int i;
  m->start_s = m->now_s = rows->time_s(rows->of, 0);
  m->start_ambient_K = rows->ambient_K(rows->of, 0, m->start_s);
  for (i = 0; i < o->machine.n; ++i) z[i] = o->start[i] + (m->start_ambient_K - o->start_ambient_K) * o->machine.ones[i];
  memcpy(run->filter.mean, z, (size_t)o->machine.n * sizeof *z);
}

int observer_next(const observer_run* run, const observer_rows* rows) {
  observer_memory* const m = run->memory;
  const observer_settings* const s = &run->of->settings;
  const long row = (long)m->row;
  double before_s, temper;
  evidence seen = {0.0, 0};
  int wrong, k;
  if (row == 0) begin(run, rows);
  if (!run->of->keeps_all) {
    const size_t n_belief = belief_size(run->of);
    memcpy(run->history + (size_t)(row % kReturn) * n_belief, run->filter.mean, n_belief * sizeof(double));
    m->n_history = smaller(m->n_history + 1.0, kReturn);
  }
  take_ambient(run, rows, row);
  temper = run->of->with_drift || row < kWarm ? 1.0 : larger(1.0, observer_apart(run) / s->most_apart);
  before_s = m->now_s;
  for (k = 0; k < run->of->n_sensors; ++k) run->readings[k].returns = 0.0;
  wrong = take_row(run, rows, row, temper, &seen);
  if (wrong) return wrong;
  if (!run->of->keeps_all) {
    if (doubts_at(run, row) && has_live_sensor(run) && (double)row >= m->doubted_row + kReturn && m->n_history == kReturn) {
      wrong = settle_ambient(run, rows, row);
      if (wrong) return wrong;
    }
    use_again(run, row, smaller(m->now_s - before_s, longest_step_s(run)));
    k = worst_suspect(run, row);
    if (k >= 0 && (double)row >= m->again_row && m->n_history > 0.0 && may_drop(run) > 0) {
      wrong = give_up(run, rows, row, k);
      if (wrong) return wrong;
    }
    /* With a single sensor it is unknown whether the sensor or the model is wrong. */
    if (run->of->n_sensors > 1 && row >= kWarm && observer_apart(run) > kFoundWrong * s->most_apart) m->is_model_wrong = 1.0;
  }
  m->row = (double)(row + 1);
  return 0;
}

/* ---- of the last row ---- */

static long last_row(const observer_run* run) {
  return (long)run->memory->row - 1;
}

double observer_drift_um(const observer_run* run) {
  return 1e6 * drift_m(run, last_row(run));
}

double observer_deviation_um(const observer_run* run) {
  double variance;
  observer_filter_drift_gradient(&run->filter, output_row(run, run->of->drift_output), run->gradient);
  variance = observer_filter_variance(&run->filter, run->gradient, run->filter.n_all);
  return variance > 0.0 ? 1e6 * sqrt(variance) : 0.0;
}

double observer_ambient_K(const observer_run* run) {
  return ambient_at(run, last_row(run));
}

int observer_doubts_ambient(const observer_run* run) {
  return doubts_at(run, last_row(run));
}

void observer_outputs(const observer_run* run, double* outputs) {
  const double ambient_K = observer_ambient_K(run);
  int o, i;
  for (o = 0; o < run->of->n_outputs; ++o) {
    const double* const h = output_row(run, o);
    double sum = 0.0;
    for (i = 0; i < run->of->machine.n; ++i) sum += h[i] * run->filter.mean[i];
    outputs[o] = sum + ambient_K * run->of->outputs_ambient[o];
  }
}
