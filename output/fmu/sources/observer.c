/* The state observer (state_observer.h) as a unit: a sample is taken every period_s from the start on, by the readings that
 * are set then: at events in model exchange, at the beginning of the step that holds it in co-simulation. Outputs stay as
 * they are until the next one. */
#include <math.h>
#include <string.h>

#include "model.h"
#include "probe_feedback.h"
#include "state_observer.h"
#include "thermal.h"

const int model_kind_is_observer = 1;

enum { kRowsKept = kObserverRowsBack + 2, kMostPieces = 32, kSteps = 12, kModes = 12 };

/* The inputs of a probing stand last: what it has measured, and the strobe that turns on when it is there. */
static int probe_inputs(void) {
  return observer.takes_probings ? 2 : 0;
}
static int probe_input(void) {
  return thermal.n_drive + 1 + observer.n_sensors;
}
enum { kProbeOutputs = 6, kProbeDoubles = (sizeof(probe_state) + sizeof(double) - 1) / sizeof(double) };

/* Of a row: when, the ambient as told, how many pieces; then readings, then pieces: length and drive. */
enum { kRowTime, kRowTold, kRowPieces, kRowHead };

static int piece_size(void) {
  return 1 + thermal.n_drive;
}
static size_t row_size(void) {
  return (size_t)(kRowHead + observer.n_sensors + kMostPieces * piece_size());
}
static double* take(double** room, size_t n) {
  double* const at = *room;
  *room += n;
  return at;
}

/* The scratch: the observer, then the powers of its sources at rest and its room. */
typedef struct {
  state_observer of;
  double numbers[1];
} workshop;

/* Where what is saved stands. */
typedef struct {
  double* n_rows;   /* samples taken */
  double* start_s;  /* time of the first */
  double* piece_s;  /* since when the drive is as it is */
  double* n_pieces; /* since the last sample */
  double *pieces, *rows;
  double* is_probed;    /* 1: the strobe has turned on since the last sample */
  probe_state* probing; /* in doubles, as all that is saved */
  double* remembered;   /* of state_observer.c */
} view;

static view view_of(double* saved) {
  double* room = saved + kInputs + model_n_inputs();
  view v;
  v.n_rows = take(&room, 1);
  v.start_s = take(&room, 1);
  v.piece_s = take(&room, 1);
  v.n_pieces = take(&room, 1);
  v.pieces = take(&room, (size_t)(kMostPieces * piece_size()));
  v.rows = take(&room, kRowsKept * row_size());
  v.is_probed = take(&room, 1);
  v.probing = (probe_state*)(void*)take(&room, kProbeDoubles);
  v.remembered = room;
  return v;
}

static observer_run run_of(const view* v, workshop* w) {
  return observer_run_in(&w->of, v->remembered, w->numbers + thermal.n_sources, kSteps, kModes);
}

static void describe(state_observer* o, const double* rest_W) {
  memset(o, 0, sizeof *o);
  o->machine.n = thermal.n;
  o->machine.n_sources = thermal.n_sources;
  o->machine.n_exchanges = thermal.n_exchanges;
  o->machine.conduction = thermal.conduction;
  o->machine.loads = thermal.loads;
  o->machine.exchanges = thermal.exchanges;
  o->machine.to_ambient = thermal.to_ambient;
  o->machine.offsets = thermal.offsets;
  o->machine.ones = thermal.ones;
  o->settings = observer.settings;
  o->n_outputs = thermal.n_outputs;
  o->outputs = thermal.outputs;
  o->outputs_ambient = thermal.outputs_ambient;
  o->reference_degC = thermal.reference_degC;
  o->start = thermal.start;
  o->start_ambient_K = thermal.start_ambient_K;
  o->n_sensors = observer.n_sensors;
  o->sensor_output = observer.sensor_output;
  o->drift_output = observer.drift_output;
  o->factor_mean = observer.factor_mean;
  o->factor_covariance = observer.factor_covariance;
  o->rest_W = rest_W;
}

size_t model_n_saved(void) {
  state_observer o;
  describe(&o, 0);
  return (size_t)kInputs + (size_t)model_n_inputs() + 5 + kProbeDoubles + (size_t)(kMostPieces * piece_size()) +
         kRowsKept * row_size() + observer_n_remembered(&o);
}
size_t model_scratch_size(void) {
  state_observer o;
  describe(&o, 0);
  return sizeof(workshop) + ((size_t)thermal.n_sources + observer_n_room(&o, kSteps, kModes)) * sizeof(double);
}
int model_n_inputs(void) {
  return probe_input() + probe_inputs();
}
int model_n_outputs(void) {
  return 2 + thermal.n_outputs + observer.n_sensors + 2 + (observer.takes_probings ? kProbeOutputs : 0);
}
int model_n_switches(void) {
  return 0;
}
int model_n_states(void) {
  return 0;
}
double* model_states(double* saved) {
  return saved;
}

int model_prepare(void* scratch) {
  workshop* const w = scratch;
  view nothing;
  observer_run run;
  int k;
  memset(&nothing, 0, sizeof nothing);
  describe(&w->of, w->numbers);
  for (k = 0; k < thermal.n_sources; ++k) w->numbers[k] = thermal.powers[k].at_rest;
  nothing.remembered = w->numbers; /* only the room is looked at */
  run = run_of(&nothing, w);
  observer_clear_room(&run);
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

/* Two neighbours of n pieces become one, at the mean of their drives: those at which a curved law errs least by it. That is
 * half its second derivative times the difference squared times the product of the lengths over their sum. */
static void merge_pieces(double* pieces, int n) {
  const int size = piece_size();
  double least = HUGE_VAL, *first = pieces;
  const double* second;
  int i, k;
  for (i = 0; i + 1 < n; ++i) {
    const double *const a = pieces + i * size, *const b = a + size;
    double apart = 0.0;
    for (k = 0; k < thermal.n_drive; ++k) {
      const double share = (b[1 + k] - a[1 + k]) / thermal.most_drive[k];
      apart += share * share;
    }
    apart *= a[0] * b[0] / (a[0] + b[0]);
    if (apart < least) {
      least = apart;
      first = pieces + i * size;
    }
  }
  second = first + size;
  for (k = 1; k <= thermal.n_drive; ++k) first[k] += (second[k] - first[k]) * (second[0] / (first[0] + second[0]));
  first[0] += second[0];
  memmove(first + size, second + size, (size_t)(pieces + n * size - (second + size)) * sizeof *pieces);
}

/* The drive has been as it is since piece_s: that becomes a piece. */
static void close_piece(double* saved, double until_s) {
  const view v = view_of(saved);
  double* piece;
  if (!(until_s > *v.piece_s)) return;
  if (*v.n_pieces == kMostPieces) {
    merge_pieces(v.pieces, kMostPieces);
    *v.n_pieces = kMostPieces - 1;
  }
  piece = v.pieces + (int)*v.n_pieces * piece_size();
  piece[0] = until_s - *v.piece_s;
  memcpy(piece + 1, saved + kInputs, (size_t)thermal.n_drive * sizeof *piece);
  *v.n_pieces += 1.0;
  *v.piece_s = until_s;
}

static int is_strobe(int input) {
  return input == probe_input() + 1;
}

const char* model_check_input(int input, double value) {
  const int is_reading = input > thermal.n_drive && !is_strobe(input);
  if (!is_reading && !(fabs(value) < 1e300)) return "an input is no finite number";
  if (input < thermal.n_drive && !(value >= 0.0 && value <= thermal.most_drive[input] * (1.0 + 1e-12)))
    return "an input is outside its min and max, between which the model was reduced";
  return 0;
}

const char* model_check_drive(const double* inputs, const double* before) {
  (void)inputs, (void)before; /* tables of an observer have values in the whole range */
  return 0;
}

const char* model_before_input(double* saved, int input, double value) {
  const char* const wrong = model_check_input(input, value);
  if (wrong) return wrong;
  if (input<thermal.n_drive&& * view_of(saved).n_rows> 0.0 && saved[kInputs + input] != value)
    close_piece(saved, saved[kTime]);
  if (is_strobe(input) && value > 0.5 && !(saved[kInputs + input] > 0.5)) *view_of(saved).is_probed = 1.0;
  return 0;
}

void model_start(double* saved, void* scratch) {
  const view v = view_of(saved);
  const observer_run run = run_of(&v, scratch);
  memset(v.n_rows, 0, (model_n_saved() - (size_t)(v.n_rows - saved)) * sizeof *saved);
  *v.start_s = *v.piece_s = saved[kTime];
  observer_start(&run);
}

/* The rows, as the observer asks for them; `of` is the view. */
static const double* row_at(const void* of, long row) {
  return ((const view*)of)->rows + (size_t)(row % kRowsKept) * row_size();
}
static const double* piece_at(const void* of, long row, int piece) {
  return row_at(of, row) + kRowHead + observer.n_sensors + piece * piece_size();
}
static double time_s(void* of, long row) {
  return row_at(of, row)[kRowTime];
}
static double ambient_K(void* of, long row, double t_s) {
  const double *const now = row_at(of, row), *before;
  if (row == 0 || t_s >= now[kRowTime]) return now[kRowTold];
  before = row_at(of, row - 1);
  return before[kRowTold] +
         (now[kRowTold] - before[kRowTold]) * ((t_s - before[kRowTime]) / (now[kRowTime] - before[kRowTime]));
}
static double reading_C(void* of, long row, int sensor) {
  return row_at(of, row)[kRowHead + sensor];
}
static int piece(void* of, long row, int number, double* until_s) {
  int k;
  if (number >= (int)row_at(of, row)[kRowPieces]) return 0;
  *until_s = row_at(of, row - 1)[kRowTime];
  for (k = 0; k <= number; ++k) *until_s += piece_at(of, row, k)[0];
  return 1;
}
static int laws(void* of, long row, int number, double from_s, double outside_K, double* power_W, double* coefficient) {
  const double* const drive = piece_at(of, row, number) + 1;
  int k;
  (void)from_s, (void)outside_K;
  for (k = 0; k < thermal.n_sources; ++k) power_W[k] = law_value(&thermal.powers[k], drive);
  for (k = 0; k < thermal.n_exchanges; ++k) coefficient[k] = law_value(&thermal.coefficients[k], drive);
  return 0;
}

/* What the observer would have the axis corrected by, without probings. */
static double trusted_um(const observer_run* run) {
  return observer_trust(run) * observer_drift_um(run);
}

/* The sample at a time. Returns 0, or what is wrong. */
static const char* sample(double* saved, void* scratch, double t_s) {
  view v = view_of(saved);
  const observer_run run = run_of(&v, scratch);
  const int i = (int)*v.n_rows;
  double* const row = v.rows + (size_t)(i % kRowsKept) * row_size();
  observer_rows rows;
  rows.of = &v;
  rows.time_s = time_s;
  rows.ambient_K = ambient_K;
  rows.reading_C = reading_C;
  rows.drift_um = 0;
  rows.piece = piece;
  rows.laws = laws;
  if (i > 0) close_piece(saved, t_s);
  row[kRowTime] = t_s;
  row[kRowTold] = saved[kInputs + thermal.n_drive] - thermal.reference_degC;
  row[kRowPieces] = *v.n_pieces;
  memcpy(row + kRowHead, saved + kInputs + thermal.n_drive + 1, (size_t)observer.n_sensors * sizeof *row);
  memcpy(row + kRowHead + observer.n_sensors, v.pieces, (size_t)(kMostPieces * piece_size()) * sizeof *row);
  *v.n_pieces = 0.0;
  *v.piece_s = t_s;
  if (observer_next(&run, &rows) != 0) return "the decomposition of the conduction matrix did not converge";
  *v.n_rows = i + 1;
  if (!observer.takes_probings) return 0;
  probe_row(&observer.probing, v.probing, trusted_um(&run), 0.0, i > 0 ? t_s - row_at(&v, i - 1)[kRowTime] : 0.0);
  if (*v.is_probed > 0.0) (void)probe_drift(&observer.probing, v.probing, saved[kInputs + probe_input()]);
  *v.is_probed = 0.0;
  return 0;
}

double model_next_event_s(const double* saved) {
  const double* const of_rows = saved + kInputs + model_n_inputs(); /* n_rows, then start_s */
  return of_rows[1] + of_rows[0] * observer.settings.period_s;
}

static double tiny_s(double t_s) {
  return 1e-9 * (fabs(t_s) + observer.settings.period_s);
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
  const observer_run run = run_of(&v, scratch);
  int i;
  outputs[0] = observer_drift_um(&run);
  outputs[1] = *v.n_rows > 0.0 ? observer_deviation_um(&run) : 0.0;
  outputs += 2;
  observer_outputs(&run, outputs);
  for (i = 0; i < thermal.n_outputs; ++i) outputs[i] = thermal.output_factor[i] * outputs[i] + thermal.output_offset[i];
  outputs += thermal.n_outputs;
  for (i = 0; i < observer.n_sensors; ++i) outputs[i] = run.sensors[i].is_live == 0.0 ? 1.0 : 0.0;
  outputs[observer.n_sensors] = observer_doubts_ambient(&run) ? 1.0 : 0.0;
  outputs[observer.n_sensors + 1] = observer_trust(&run);
  if (!observer.takes_probings) return;
  outputs += observer.n_sensors + 2;
  outputs[1] = probe_expected_um(&observer.probing, v.probing, 0.0);
  outputs[0] = (*v.n_rows > 0.0 ? trusted_um(&run) : 0.0) + outputs[1];
  outputs[2] = probe_deviation_um(&observer.probing, v.probing, 0.0);
  outputs[3] = v.probing->verdict;
  outputs[4] = v.probing->off_um;
  outputs[5] = v.probing->n_refused;
}

void model_switches(const double* saved, double* is_on, double* indicators) {
  (void)saved, (void)is_on, (void)indicators;
}

void model_derivatives(const double* saved, void* scratch, double* derivatives) {
  (void)saved, (void)scratch, (void)derivatives;
}

void model_add_sensitivity(const double* saved, void* scratch, int known_is_state, int known, double seed, double* outputs,
                           double* derivatives) {
  (void)saved, (void)scratch, (void)known_is_state, (void)known, (void)seed, (void)outputs, (void)derivatives;
}
