/* The reduced machine: exact over each step of co-simulation where no law follows temperatures, its slopes and the
 * distances of its thermostats for model exchange. */
#include <math.h>
#include <string.h>

#include "formula.h"
#include "live.h"
#include "model.h"
#include "switches.h"
#include "symmetric_eigen.h"
#include "thermal.h"

enum { kLeastSlots = 8, kBeside = 2 }; /* of decompositions kept; ambient and its rate, behind the drive among the inputs */

const int model_kind_is_observer = 0;

static const double kFirstStep_s = 1.0; /* where laws follow temperatures; then as the error allows */

/* K in its eigenvectors, for one set of coefficients; what each mode keeps over the step met last. */
typedef struct {
  int is_filled;
  double *coefficient, *lambda, *vectors; /* vectors by rows */
  double step_s;
  double *kept, *of_constant, *of_slope;
} slot;

typedef struct {
  int n_slots, next_slot;
  slot* slots;
  /* Of the drive and the switches met last. */
  int has_drive, has_matrix, in_modes; /* in_modes: index of the slot whose modes the loads are in, plus 1 */
  const char* wrong;                   /* with it; 0: nothing */
  double *drive, *coefficient, *power, *constant, *per_ambient, *matrix;
  double *mode_constant, *mode_per_ambient, *is_on, *probes_in_modes;
  /* Room for a while. */
  double *modes, *eigen_work, *matrix_work, *slope, *along, *d_drive, *was_on;
  live_room* live; /* null: no law follows temperatures */
} machine;

static int n_slots(void) {
  return thermal.n_known + kLeastSlots;
}

static size_t n_doubles(void) {
  const size_t n = (size_t)thermal.n, slots = (size_t)n_slots(), thermostats = (size_t)thermal.n_thermostats;
  return slots * ((size_t)thermal.n_exchanges + n + n * n + 3 * n) + (size_t)thermal.n_drive + (size_t)thermal.n_exchanges +
         (size_t)thermal.n_sources + 2 * n + n * n + 2 * n + n + 2 * n + n * n + (size_t)thermal.n_exchanges +
         (size_t)thermal.n_sources + n + (size_t)thermal.n_drive + thermostats * (n + 2);
}

/* After the states, where laws follow temperatures, the length of a step that fits; then which thermostats are on. */
static int first_is_on(void) {
  return kInputs + model_n_inputs() + thermal.n + (thermal.n_live > 0 ? 1 : 0);
}
size_t model_n_saved(void) {
  return (size_t)first_is_on() + (size_t)thermal.n_thermostats;
}
size_t model_scratch_size(void) {
  return sizeof(machine) + (size_t)n_slots() * sizeof(slot) + n_doubles() * sizeof(double) +
         (thermal.n_live > 0 ? live_room_size() : 0);
}
int model_n_inputs(void) {
  return thermal.n_drive + kBeside;
}
int model_n_outputs(void) {
  return thermal.n_outputs;
}
int model_n_states(void) {
  return thermal.n;
}
int model_n_switches(void) {
  return thermal.n_thermostats;
}
double* model_states(double* saved) {
  return saved + kInputs + model_n_inputs();
}

static double ambient_K(const double* saved, double time_s) {
  const double* const ambient = saved + kInputs + thermal.n_drive;
  if (saved[kAmbientFromInput] == 0.0) return ambient_by_scenario_K(time_s);
  return ambient[0] - thermal.reference_degC + ambient[1] * (time_s - saved[kAmbientSetAt]);
}

/* The decomposition of these coefficients. Returns null where it fails. */
static slot* slot_of(machine* m, const double* coefficient) {
  const size_t bytes = (size_t)thermal.n_exchanges * sizeof *coefficient;
  slot* s;
  int k;
  for (k = 0; k < m->n_slots; ++k) {
    s = &m->slots[k];
    if (s->is_filled && (bytes == 0 || memcmp(s->coefficient, coefficient, bytes) == 0)) return s;
  }
  s = &m->slots[m->next_slot];
  if (m->in_modes == m->next_slot + 1) m->in_modes = 0;
  m->next_slot = (m->next_slot + 1) % m->n_slots;
  s->is_filled = 0;
  s->step_s = -1.0;
  if (m->live) live_forget(m->live);
  if (bytes > 0) memcpy(s->coefficient, coefficient, bytes);
  thermal_matrix(coefficient, m->matrix_work);
  if (symmetric_eigen(thermal.n, m->matrix_work, s->lambda, s->vectors, m->eigen_work) != 0) return 0;
  for (k = 0; k < thermal.n; ++k) {
    if (s->lambda[k] < 0.0) s->lambda[k] = 0.0; /* by rounding */
  }
  s->is_filled = 1;
  return s;
}

static void coefficients_of(const double* drive, double* coefficient) {
  int e;
  for (e = 0; e < thermal.n_exchanges; ++e) coefficient[e] = law_value(&thermal.coefficients[e], drive);
  for (e = 0; e < thermal.n_formulas; ++e) {
    const drive_formula* const f = &thermal.formulas[e];
    if (f->exchange >= 0) coefficient[f->exchange] = formula_value(f->n_steps, f->steps, drive, 0, 0);
  }
}

/* Whether a source is off by its thermostat. */
static int is_off(const double* saved, int source) {
  const int thermostat = (int)thermal.switched_by[source] - 1;
  return thermostat >= 0 && saved[first_is_on() + thermostat] == 0.0;
}

static void take_drive(machine* m, const double* saved) {
  const double *const drive = saved + kInputs, *const is_on = saved + first_is_on();
  const size_t bytes = (size_t)thermal.n_drive * sizeof *drive, on_bytes = (size_t)thermal.n_thermostats * sizeof *is_on;
  int s;
  if (m->has_drive && memcmp(m->drive, drive, bytes) == 0 && memcmp(m->is_on, is_on, on_bytes) == 0) return;
  memcpy(m->drive, drive, bytes);
  memcpy(m->is_on, is_on, on_bytes);
  m->wrong = model_check_drive(drive, 0);
  coefficients_of(drive, m->coefficient);
  for (s = 0; s < thermal.n_sources; ++s) m->power[s] = law_value(&thermal.powers[s], drive);
  for (s = 0; s < thermal.n_formulas; ++s) {
    const drive_formula* const f = &thermal.formulas[s];
    if (f->source >= 0) m->power[f->source] = formula_value(f->n_steps, f->steps, drive, 0, 0);
  }
  for (s = 0; s < thermal.n_sources; ++s) {
    if (is_off(saved, s)) m->power[s] = 0.0;
  }
  thermal_loads(m->coefficient, m->power, m->constant, m->per_ambient);
  m->has_drive = 1;
  m->has_matrix = 0;
  m->in_modes = 0;
}

static double* take(double** room, size_t n) {
  double* const at = *room;
  *room += n;
  return at;
}

int model_prepare(void* scratch) {
  machine* const m = scratch;
  const size_t n = (size_t)thermal.n;
  double* room;
  int k;
  memset(m, 0, sizeof *m);
  m->n_slots = n_slots();
  m->slots = (slot*)(m + 1);
  room = (double*)(m->slots + m->n_slots);
  for (k = 0; k < m->n_slots; ++k) {
    slot* const s = &m->slots[k];
    s->is_filled = 0;
    s->coefficient = take(&room, (size_t)thermal.n_exchanges);
    s->lambda = take(&room, n);
    s->vectors = take(&room, n * n);
    s->kept = take(&room, n);
    s->of_constant = take(&room, n);
    s->of_slope = take(&room, n);
  }
  m->drive = take(&room, (size_t)thermal.n_drive);
  m->coefficient = take(&room, (size_t)thermal.n_exchanges);
  m->power = take(&room, (size_t)thermal.n_sources);
  m->constant = take(&room, n);
  m->per_ambient = take(&room, n);
  m->matrix = take(&room, n * n);
  m->mode_constant = take(&room, n);
  m->mode_per_ambient = take(&room, n);
  m->modes = take(&room, n);
  m->eigen_work = take(&room, 2 * n);
  m->matrix_work = take(&room, n * n);
  m->slope = take(&room, (size_t)thermal.n_exchanges + (size_t)thermal.n_sources);
  m->along = take(&room, n);
  m->d_drive = take(&room, (size_t)thermal.n_drive);
  m->is_on = take(&room, (size_t)thermal.n_thermostats);
  m->was_on = take(&room, (size_t)thermal.n_thermostats);
  m->probes_in_modes = take(&room, (size_t)thermal.n_thermostats * n);
  if (thermal.n_live > 0) m->live = live_prepare(room);
  for (k = 0; k < thermal.n_known; ++k) {
    coefficients_of(thermal.known_drive + (size_t)k * (size_t)thermal.n_drive, m->coefficient);
    if (!slot_of(m, m->coefficient)) return 1;
  }
  return 0;
}

void model_reset(double* saved, void* scratch) {
  int k;
  memset(saved, 0, model_n_saved() * sizeof *saved);
  for (k = 0; k < thermal.n_drive; ++k) saved[kInputs + k] = fmin(fmax(0.0, thermal.least_drive[k]), thermal.most_drive[k]);
  saved[kInputs + thermal.n_drive] = thermal.start_ambient_K + thermal.reference_degC;
  model_touched(scratch);
}

void model_touched(void* scratch) {
  (void)scratch; /* the scratch looks at the inputs by itself */
}

const char* model_check_input(int input, double value) {
  if (!(fabs(value) <= HUGE_VAL) || fabs(value) == HUGE_VAL) return "an input is no finite number";
  if (input < thermal.n_drive && !(value >= thermal.least_drive[input] - 1e-12 * fabs(thermal.least_drive[input]) &&
                                   value <= thermal.most_drive[input] + 1e-12 * fabs(thermal.most_drive[input])))
    return "an input is outside its min and max, between which the model was reduced";
  return 0;
}

const char* model_check_drive(const double* inputs, const double* before) {
  int k;
  if (before && memcmp(inputs, before, (size_t)thermal.n_drive * sizeof *inputs) == 0) return 0;
  for (k = 0; k < thermal.n_formulas; ++k) {
    const drive_formula* const f = &thermal.formulas[k];
    const double value = formula_value(f->n_steps, f->steps, inputs, 0, 0);
    if (!(fabs(value) < HUGE_VAL)) return "a law has no value at this drive";
    if (f->exchange >= 0 && value < 0.0) return "a film or a conductance is below 0 at this drive";
  }
  return 0;
}

const char* model_before_input(double* saved, int input, double value) {
  const char* const wrong = model_check_input(input, value);
  if (!wrong && input == thermal.n_drive) saved[kAmbientSetAt] = saved[kTime];
  return wrong;
}

/* How an output's cubics change with its state `state` (the ambient: n), at the place x; or along x, per mm. */
static double along_weight(const output_along* a, double x, int state, int is_slope) {
  const double* c;
  double t;
  int k = 0;
  while (k + 1 < a->n_pieces && x >= a->ends[k + 1]) ++k;
  c = a->cubics + (size_t)k * 4 * ((size_t)thermal.n + 1) + (size_t)state;
  t = x - a->ends[k];
  {
    const size_t row = (size_t)thermal.n + 1;
    return is_slope ? c[row] + t * (2.0 * c[2 * row] + t * 3.0 * c[3 * row])
                    : c[0] + t * (c[row] + t * (c[2 * row] + t * c[3 * row]));
  }
}

static double along_sum(const output_along* a, const double* saved, double ambient, int is_slope) {
  const double *const z = saved + kInputs + model_n_inputs(), x = saved[kInputs + a->variable];
  double sum = ambient * along_weight(a, x, thermal.n, is_slope);
  int i;
  for (i = 0; i < thermal.n; ++i) sum += z[i] * along_weight(a, x, i, is_slope);
  return sum;
}

/* The last states from those before them, the ambient and places (thermal.n_first); so far they are 0. */
static void start_last_states(double* saved) {
  double* const z = model_states(saved);
  const double ambient = ambient_K(saved, saved[kTime]);
  int k, j;
  for (k = 0; k < thermal.n_first; ++k) {
    const int row = thermal.n_outputs + k;
    double value;
    multiply(1, thermal.n, thermal.outputs + (size_t)row * (size_t)thermal.n, z, &value);
    value += thermal.outputs_ambient[row] * ambient;
    for (j = thermal.n_along; j < thermal.n_along + thermal.n_along_first; ++j) {
      if (thermal.along[j].output == row) value += along_sum(&thermal.along[j], saved, ambient, 0);
    }
    z[thermal.n - thermal.n_first + k] = value;
  }
}

void model_start(double* saved, void* scratch) {
  double* const z = model_states(saved);
  double warmer_K = saved[kStartWarmer];
  int i;
  (void)scratch;
  saved[kAmbientSetAt] = saved[kTime];
  if (thermal.start_follows_ambient && saved[kAmbientFromInput] != 0.0)
    warmer_K += ambient_K(saved, saved[kTime]) - thermal.start_ambient_K;
  for (i = 0; i < thermal.n; ++i) z[i] = thermal.start[i] + warmer_K * thermal.ones[i];
  start_last_states(saved);
  if (thermal.n_live > 0) z[thermal.n] = kFirstStep_s;
  for (i = 0; i < thermal.n_thermostats; ++i)
    saved[first_is_on() + i] =
        beyond_switch_K(i, 0.0, thermostat_probe_K(i, z, ambient_K(saved, saved[kTime]))) > 0.0 ? 1.0 : 0.0;
}

/* The drive and the switches as they are, and the decomposition in whose modes the loads then are. Returns null where it
 * fails, or where the drive has no value in a law (m->wrong). */
static slot* ready(machine* m, const double* saved) {
  const int n = thermal.n;
  slot* s;
  int k;
  take_drive(m, saved);
  s = m->wrong ? 0 : slot_of(m, m->coefficient);
  if (!s || m->in_modes == (int)(s - m->slots) + 1) return s;
  multiply(n, n, s->vectors, m->constant, m->mode_constant);
  multiply(n, n, s->vectors, m->per_ambient, m->mode_per_ambient);
  for (k = 0; k < thermal.n_thermostats; ++k)
    multiply(n, n, s->vectors, thermal.thermostats + (size_t)k * (size_t)(kProbeWeights + n) + kProbeWeights,
             m->probes_in_modes + (size_t)k * (size_t)n);
  m->in_modes = (int)(s - m->slots) + 1;
  return s;
}

/* The modes of a linear machine to *piece_s, or to where a thermostat switches: then *piece_s is how long that took.
 * Returns its index, or -1. */
static int advance(machine* m, slot* s, const double* is_on, double ambient, double slope, double* piece_s) {
  const int n = thermal.n;
  double *const load = m->eigen_work, *const rising = m->eigen_work + n;
  const mode_course course = {s->lambda, m->modes, load, rising, 0, m->probes_in_modes, is_on, ambient, slope};
  int which, i;
  for (i = 0; i < n; ++i) {
    load[i] = m->mode_constant[i] + ambient * m->mode_per_ambient[i];
    rising[i] = slope * m->mode_per_ambient[i];
  }
  which = first_switch(&course, *piece_s, piece_s);
  if (!(fabs(*piece_s - s->step_s) <= 1e-12 * *piece_s)) {
    for (i = 0; i < n; ++i) {
      double of_power[3];
      load_integrals(*piece_s, s->lambda[i], of_power);
      s->kept[i] = exp(-s->lambda[i] * *piece_s);
      s->of_constant[i] = of_power[0];
      s->of_slope[i] = of_power[1];
    }
    s->step_s = *piece_s;
  }
  for (i = 0; i < n; ++i) m->modes[i] = s->kept[i] * m->modes[i] + s->of_constant[i] * load[i] + s->of_slope[i] * rising[i];
  return which;
}

const char* model_step(double* saved, void* scratch, double h_s) {
  machine* const m = scratch;
  const int n = thermal.n;
  const double end_s = saved[kTime] + h_s;
  const size_t bytes = (size_t)n * sizeof *saved, on_bytes = (size_t)thermal.n_thermostats * sizeof *saved;
  double *const z = model_states(saved), *const is_on = saved + first_is_on();
  double t_s = saved[kTime];
  slot* s = ready(m, saved);
  if (!s) return m->wrong ? m->wrong : "the decomposition of the conduction matrix did not converge";
  if (m->live) { /* live_advance() stops within the step where a law has no value */
    memcpy(m->along, z, bytes);
    memcpy(m->was_on, is_on, on_bytes);
  } else {
    multiply(n, n, s->vectors, z, m->modes);
  }
  while (t_s < end_s) {
    const double knot_s = saved[kAmbientFromInput] == 0.0 ? next_ambient_knot_s(t_s) : HUGE_VAL;
    const double until_s = knot_s < end_s ? knot_s : end_s, ambient = ambient_K(saved, t_s);
    double piece_s = until_s - t_s;
    const double slope = (ambient_K(saved, until_s) - ambient) / piece_s;
    int which;
    if (m->live) {
      const live_system system = {m->drive,         m->coefficient,      s->lambda,          s->vectors,
                                  m->mode_constant, m->mode_per_ambient, m->probes_in_modes, is_on};
      const char* const wrong = live_advance(m->live, &system, &piece_s, ambient, slope, z, z + n, &which);
      if (wrong) {
        memcpy(z, m->along, bytes);
        memcpy(is_on, m->was_on, on_bytes);
        return wrong;
      }
    } else {
      which = advance(m, s, is_on, ambient, slope, &piece_s);
    }
    t_s = which < 0 ? until_s : t_s + piece_s;
    if (which < 0) continue;
    is_on[which] = 1.0 - is_on[which];
    s = ready(m, saved); /* the same: switches change no coefficient */
  }
  if (!m->live) {
    memset(z, 0, bytes);
    add_transposed(n, n, s->vectors, m->modes, z);
  }
  saved[kTime] = end_s;
  return 0;
}

static double beyond_K(const double* saved, int which) {
  const double *const z = saved + kInputs + model_n_inputs(), ambient = ambient_K(saved, saved[kTime]);
  return beyond_switch_K(which, saved[first_is_on() + which], thermostat_probe_K(which, z, ambient));
}

void model_switches(const double* saved, double* is_on, double* indicators) {
  int k;
  for (k = 0; k < thermal.n_thermostats; ++k) {
    is_on[k] = saved[first_is_on() + k];
    indicators[k] = is_on[k] != 0.0 ? -beyond_K(saved, k) : beyond_K(saved, k);
  }
}

const char* model_event(double* saved, void* scratch) {
  int k;
  (void)scratch;
  for (k = 0; k < thermal.n_thermostats; ++k) {
    if (beyond_K(saved, k) >= -kSwitchReached_K) saved[first_is_on() + k] = 1.0 - saved[first_is_on() + k];
  }
  return 0;
}

double model_next_event_s(const double* saved) {
  return saved[kAmbientFromInput] == 0.0 ? next_ambient_knot_s(saved[kTime]) : HUGE_VAL;
}

void model_outputs(const double* saved, void* scratch, double* outputs) {
  const double ambient = ambient_K(saved, saved[kTime]);
  int o;
  (void)scratch;
  multiply(thermal.n_outputs, thermal.n, thermal.outputs, saved + kInputs + model_n_inputs(), outputs);
  for (o = 0; o < thermal.n_along; ++o) outputs[thermal.along[o].output] += along_sum(&thermal.along[o], saved, ambient, 0);
  for (o = 0; o < thermal.n_outputs; ++o)
    outputs[o] = thermal.output_factor[o] * (outputs[o] + thermal.outputs_ambient[o] * ambient) + thermal.output_offset[o];
  for (o = 0; o < thermal.n_direct; ++o) {
    const int output = (int)thermal.direct_output[o];
    outputs[output] += thermal.output_factor[output] * law_value(&thermal.direct[o], saved + kInputs);
  }
}

static const double* matrix_of(machine* m, const double* saved) {
  take_drive(m, saved);
  if (!m->has_matrix) thermal_matrix(m->coefficient, m->matrix);
  m->has_matrix = 1;
  return m->matrix;
}

void model_derivatives(const double* saved, void* scratch, double* derivatives) {
  machine* const m = scratch;
  const double ambient = ambient_K(saved, saved[kTime]);
  int i;
  multiply(thermal.n, thermal.n, matrix_of(m, saved), saved + kInputs + model_n_inputs(), derivatives);
  for (i = 0; i < thermal.n; ++i) derivatives[i] = m->constant[i] + ambient * m->per_ambient[i] - derivatives[i];
  if (m->wrong || (m->live && live_add_rate(m->live, m->drive, m->coefficient, saved + kInputs + model_n_inputs(), ambient,
                                            derivatives))) {
    for (i = 0; i < thermal.n; ++i) derivatives[i] = NAN;
  }
}

/* derivatives += how the laws that follow temperatures change along one state (< 0: none), the ambient, one variable of
 * the drive (< 0: none). */
static void add_live(machine* m, const double* saved, int state, double seed, double d_ambient_K, int which,
                     double* derivatives) {
  if (!m->live) return;
  memset(m->along, 0, (size_t)thermal.n * sizeof *m->along);
  if (state >= 0) m->along[state] = seed;
  live_add_slope(m->live, m->drive, m->coefficient, saved + kInputs + model_n_inputs(), ambient_K(saved, saved[kTime]),
                 m->along, d_ambient_K, which, seed, derivatives);
}

/* outputs += what places of axes give where one state (or the ambient: n) changes by seed. */
static void add_along(const double* saved, int state, double seed, double* outputs) {
  int k;
  for (k = 0; k < thermal.n_along; ++k) {
    const output_along* const a = &thermal.along[k];
    outputs[a->output] += seed * thermal.output_factor[a->output] * along_weight(a, saved[kInputs + a->variable], state, 0);
  }
}

static void add_ambient(double seed_K, const machine* m, double* outputs, double* derivatives) {
  int i;
  for (i = 0; i < thermal.n_outputs; ++i) outputs[i] += seed_K * thermal.output_factor[i] * thermal.outputs_ambient[i];
  for (i = 0; i < thermal.n; ++i) derivatives[i] += seed_K * m->per_ambient[i];
}

void model_add_sensitivity(const double* saved, void* scratch, int known_is_state, int known, double seed, double* outputs,
                           double* derivatives) {
  machine* const m = scratch;
  const double *const k = matrix_of(m, saved), *const z = saved + kInputs + model_n_inputs();
  const int n = thermal.n, is_ambient_input = saved[kAmbientFromInput] != 0.0;
  int i, j, e, s;
  if (known_is_state) {
    for (i = 0; i < thermal.n_outputs; ++i) outputs[i] += seed * thermal.output_factor[i] * thermal.outputs[i * n + known];
    add_along(saved, known, seed, outputs);
    for (i = 0; i < n; ++i) derivatives[i] -= seed * k[i * n + known];
    add_live(m, saved, known, seed, 0.0, -1, derivatives);
  } else if (known >= thermal.n_drive) {
    const double seed_K = known == thermal.n_drive ? seed : seed * (saved[kTime] - saved[kAmbientSetAt]);
    if (!is_ambient_input) return;
    add_along(saved, n, seed_K, outputs);
    add_ambient(seed_K, m, outputs, derivatives);
    add_live(m, saved, -1, 0.0, seed_K, -1, derivatives);
  } else {
    const double* const drive = saved + kInputs;
    const double ambient = ambient_K(saved, saved[kTime]);
    memset(m->d_drive, 0, (size_t)thermal.n_drive * sizeof *m->d_drive);
    m->d_drive[known] = seed;
    for (i = 0; i < thermal.n_along; ++i) {
      const output_along* const a = &thermal.along[i];
      if (a->variable == known)
        outputs[a->output] += seed * thermal.output_factor[a->output] * along_sum(a, saved, ambient, 1);
    }
    for (i = 0; i < thermal.n_direct; ++i) {
      const int output = (int)thermal.direct_output[i];
      outputs[output] += seed * thermal.output_factor[output] * law_slope(&thermal.direct[i], drive, known);
    }
    for (s = 0; s < thermal.n_sources; ++s) m->slope[s] = seed * law_slope(&thermal.powers[s], drive, known);
    for (s = 0; s < thermal.n_formulas; ++s) {
      const drive_formula* const f = &thermal.formulas[s];
      if (f->source >= 0) (void)formula_value(f->n_steps, f->steps, drive, m->d_drive, &m->slope[f->source]);
    }
    for (s = 0; s < thermal.n_sources; ++s) {
      if (is_off(saved, s)) m->slope[s] = 0.0;
    }
    add_transposed(thermal.n_sources, n, thermal.loads, m->slope, derivatives);
    for (e = 0; e < thermal.n_exchanges; ++e) {
      double slope = seed * law_slope(&thermal.coefficients[e], drive, known);
      const double* const g = thermal.exchanges + (size_t)e * (size_t)n * (size_t)n;
      for (s = 0; s < thermal.n_formulas; ++s) {
        const drive_formula* const f = &thermal.formulas[s];
        if (f->exchange == e) (void)formula_value(f->n_steps, f->steps, drive, m->d_drive, &slope);
      }
      if (slope == 0.0) continue;
      for (i = 0; i < n; ++i) {
        double sum = ambient * thermal.to_ambient[e * n + i] + thermal.offsets[e * n + i];
        for (j = 0; j < n; ++j) sum -= g[i * n + j] * z[j];
        derivatives[i] += slope * sum;
      }
    }
    add_live(m, saved, -1, seed, 0.0, known, derivatives);
  }
}
