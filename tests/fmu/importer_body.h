/* How a unit is driven, in either version of the standard. Included once in each importer, after its type `unit`, fail(),
 * CALL() and event_info, and after what the versions call differently: get(), set(), set_rate(), step(), sensitivity(),
 * derivatives(), rewind_state(), handle_events() and completed_step(). These return 0, or 1 after fail(). */

static int set_inputs(unit* u, size_t row) {
  const importer_run* const run = u->run;
  if (set(u, run->inputs, run->n_inputs, run->input_rows + row * run->n_inputs)) return 1;
  if (run->is_co_simulation && run->ambient_input >= 0 && row + 1 < run->n_rows) {
    const size_t i = (size_t)run->ambient_input;
    const double rate = (run->input_rows[(row + 1) * run->n_inputs + i] - run->input_rows[row * run->n_inputs + i]) /
                        (run->time_s[row + 1] - run->time_s[row]);
    return set_rate(u, run->inputs[i], rate);
  }
  return 0;
}

static int tell(unit* u, size_t row) {
  return get(u, u->run->outputs, u->run->n_outputs, u->run->output_rows + row * u->run->n_outputs);
}

static int steps(unit* u, double from_s, double to_s) {
  const int n = (int)ceil((to_s - from_s) / u->run->step_s - 1e-9);
  int k;
  for (k = 0; k < n; ++k) {
    const double t_s = k == 0 ? from_s : from_s + k * u->run->step_s,
                 end_s = k + 1 == n ? to_s : from_s + (k + 1) * u->run->step_s;
    if (step(u, t_s, end_s)) return 1;
  }
  return 0;
}

static int co_simulate(unit* u) {
  const importer_run* const run = u->run;
  size_t row;
  if (!run->tells_behind_step && tell(u, 0)) return 1;
  for (row = 0; row + 1 < run->n_rows; ++row) {
    if (row > 0 && row == run->rewind_at_row && rewind_state(u, run->time_s[row])) return 1;
    if (set_inputs(u, row) || steps(u, run->time_s[row], run->time_s[row + 1])) return 1;
    if (tell(u, run->tells_behind_step ? row : row + 1)) return 1;
  }
  return 0;
}

static int slopes(void* of, double t_s, const double* z, double* dz) {
  unit* const u = of;
  CALL(SetTime, t_s);
  CALL(SetContinuousStates, z, u->run->n_states);
  return derivatives(u, dz, u->run->n_states);
}
static int column(void* of, size_t state, double* derivatives_of) {
  unit* const u = of;
  return sensitivity(u, u->run->derivatives, u->run->n_states, u->run->states[state], derivatives_of);
}

/* Directional derivatives of slopes and outputs against differences, along states and along all inputs. */
static int check_jacobian(unit* u) {
  importer_run* const run = u->run;
  const size_t n = run->n_states, n_all = n + run->n_outputs;
  double* const z = malloc((n + 4 * n_all) * sizeof *z);
  double *const low = z + n, *const high = low + n_all, *const told = high + n_all;
  unsigned* const unknowns = malloc(n_all * sizeof *unknowns);
  double most = 0.0, gap = 0.0;
  size_t k, i;
  memcpy(unknowns, run->derivatives, n * sizeof *unknowns);
  memcpy(unknowns + n, run->outputs, run->n_outputs * sizeof *unknowns);
  CALL(GetContinuousStates, z, n);
  for (k = 0; k < n + run->n_inputs; ++k) {
    const int is_state = k < n;
    const unsigned known = is_state ? run->states[k] : run->inputs[k - n];
    double value = 0.0, half = 1e-3;
    if (sensitivity(u, unknowns, n_all, known, told)) return 1;
    if (is_state) {
      value = z[k];
      z[k] = value - half;
      CALL(SetContinuousStates, z, n);
    } else {
      if (get(u, &known, 1, &value)) return 1;
      half = 1e-4 * fabs(value);
      value -= half;
      if (set(u, &known, 1, &value)) return 1;
      value += half;
    }
    if (get(u, unknowns, n_all, low)) return 1;
    if (is_state) {
      z[k] = value + half;
      CALL(SetContinuousStates, z, n);
    } else {
      value += half;
      if (set(u, &known, 1, &value)) return 1;
      value -= half;
    }
    if (get(u, unknowns, n_all, high)) return 1;
    if (is_state) {
      z[k] = value;
      CALL(SetContinuousStates, z, n);
    } else {
      if (set(u, &known, 1, &value)) return 1;
    }
    most = gap = 0.0;
    for (i = 0; i < n_all; ++i) {
      if (half == 0.0) continue;
      most = fmax(most, fabs(told[i]));
      gap = fmax(gap, fabs(told[i] - (high[i] - low[i]) / (2.0 * half)));
    }
    if (most > 0.0) run->jacobian_gap = fmax(run->jacobian_gap, gap / most);
    if (most == 0.0 && gap > 0.0) run->jacobian_gap = HUGE_VAL;
  }
  free(z);
  free(unknowns);
  return 0;
}

enum { kMostIndicators = 4 };

/* Where in a piece z is after span_s, and whether an event indicator has another sign there. */
static int look(unit* u, const integrand* f, const double* from, double t_s, double span_s, int is_smooth,
                const double* before, double* z, int* has_changed) {
  const size_t n = u->run->n_states, n_indicators = u->run->n_indicators;
  double now[kMostIndicators];
  size_t i;
  memcpy(z, from, n * sizeof *z);
  if (n > 0 && integrate_radau(f, n, t_s, t_s + span_s, is_smooth, z)) return fail(u, "the integrator");
  CALL(SetTime, t_s + span_s);
  CALL(SetContinuousStates, z, n);
  if (n_indicators > 0) CALL(GetEventIndicators, now, n_indicators);
  *has_changed = 0;
  for (i = 0; i < n_indicators; ++i) *has_changed |= (now[i] > 0.0) != (before[i] > 0.0);
  return 0;
}

/* Integrates z from t_s to *until_s, or to just after where an event indicator changes its sign: then *is_switch. With
 * indicators it looks at them every 10 s. */
static int integrate(unit* u, const integrand* f, double t_s, double* until_s, double* z, double* from, int* is_switch) {
  const size_t n = u->run->n_states, n_indicators = u->run->n_indicators;
  double before[kMostIndicators];
  int is_smooth = 0;
  if (n_indicators > kMostIndicators) return fail(u, "more event indicators than this importer takes");
  if (n_indicators > 0) CALL(GetEventIndicators, before, n_indicators);
  for (*is_switch = 0; t_s < *until_s && !*is_switch;) {
    const double end_s = n_indicators > 0 ? fmin(*until_s, t_s + 10.0) : *until_s;
    double low = 0.0, high = end_s - t_s;
    memcpy(from, z, n * sizeof *z);
    if (look(u, f, from, t_s, high, is_smooth, before, z, is_switch)) return 1;
    if (*is_switch) {
      while (high - low > 1e-7) {
        const double middle = 0.5 * (low + high);
        int is_earlier;
        if (look(u, f, from, t_s, middle, is_smooth, before, z, &is_earlier)) return 1;
        *(is_earlier ? &high : &low) = middle;
      }
      if (look(u, f, from, t_s, high, is_smooth, before, z, is_switch)) return 1;
      *until_s = t_s + high;
    }
    t_s = end_s;
    is_smooth = 1;
  }
  return 0;
}

static int exchange(unit* u) {
  importer_run* const run = u->run;
  const integrand f = {u, slopes, column};
  event_info info;
  double *const z = malloc((run->n_states + 1) * sizeof *z), *const nominal = malloc((run->n_states + 1) * sizeof *nominal),
                *const from = malloc((run->n_states + 1) * sizeof *from);
  size_t row, i;
  memset(&info, 0, sizeof info);
  for (row = 0; row < run->n_rows; ++row) {
    double t_s = run->time_s[row];
    if (row > 0) CALL(EnterEventMode);
    if (set_inputs(u, row) || handle_events(u, &info)) return 1;
    CALL(GetNominalsOfContinuousStates, nominal, run->n_states);
    for (i = 0; i < run->n_states; ++i) {
      if (!(nominal[i] > 0.0)) return fail(u, "a nominal is not above 0");
    }
    if (tell(u, row)) return 1;
    if (row == 2 && run->n_states > 0 && check_jacobian(u)) return 1;
    while (row + 1 < run->n_rows && t_s < run->time_s[row + 1]) {
      const int is_event = info.nextEventTimeDefined && info.nextEventTime < run->time_s[row + 1];
      double until_s = is_event ? info.nextEventTime : run->time_s[row + 1];
      int is_switch;
      CALL(GetContinuousStates, z, run->n_states);
      if (integrate(u, &f, t_s, &until_s, z, from, &is_switch)) return 1;
      t_s = until_s;
      if (completed_step(u)) return 1;
      run->n_switches += is_switch;
      if (is_event || is_switch) {
        CALL(EnterEventMode);
        if (handle_events(u, &info)) return 1;
      }
    }
  }
  free(z);
  free(nominal);
  free(from);
  return 0;
}

/* The rows of the run by a unit that is initialized, with their time and memory; then its end. */
static int run_rows(unit* u) {
  importer_run* const run = u->run;
  const size_t before = mallinfo2().uordblks;
  const double began_s = monotonic_s();
  const int failed = run->is_co_simulation ? co_simulate(u) : exchange(u);
  run->seconds = monotonic_s() - began_s;
  run->allocated = (long long)mallinfo2().uordblks - (long long)before;
  if (failed) return 1;
  CALL(Terminate);
  u->FreeInstance(u->c);
  return 0;
}

/* Loads the binary and runs `go` on it. */
static int import(importer_run* run, int (*go)(unit* u, void* library)) {
  unit u;
  void* const library = dlopen(run->library, RTLD_NOW | RTLD_LOCAL);
  int failed;
  memset(&u, 0, sizeof u);
  u.run = run;
  run->wrong[0] = '\0';
  run->n_events = run->n_switches = 0;
  run->jacobian_gap = 0.0;
  if (!library) {
    snprintf(run->wrong, sizeof run->wrong, "%s", dlerror());
    return 1;
  }
  failed = go(&u, library);
  dlclose(library);
  return failed;
}
