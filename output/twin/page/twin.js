// The twin without a page: the machine from the data, the running plan, and the present time.

function machineOf(m) {
  const laws = list => list.map(choices => ({
    of_stretch: choices.of_stretch,
    laws: choices.laws.map(law => ({
      drive: lawOf(law.drive), thermostat: choices.thermostat,
      tables: law.tables.map(t => ({axes: t.axes.map(a => ({...a, probe: choices.probes[a.probe],
                                                            minus: a.minus < 0 ? -1 : choices.probes[a.minus],
                                                            nodes: doubles(a.nodes)})),
                                    at: t.at.map(lawOf)})),
    }))}));
  const numbers = Object.fromEntries(Object.entries(m.numbers).map(([name, text]) => [name, doubles(text)]));
  return new Machine({...m, ...numbers, powers: laws(m.powers), coefficients: laws(m.coefficients),
                      ambient: {time_s: doubles(m.ambient.time_s), value_K: doubles(m.ambient.value_K)}});
}
// A law of the drive; a plain number if it is constant.
const lawOf = law => typeof law === "number" ? {rest: law, terms: []} :
    {rest: law.rest, terms: law.terms.map(t => ({variable: t.variable, log_x: doubles(t.log_x), c: doubles(t.c)}))};

class Twin {
  static MOST_ROWS = 3000;  // of a displayed run

  constructor(data) {
    this.data = data;
    this.machine = machineOf(data.machine);
    this.cyclograms = data.cyclograms.map(c => ({name: c.name, plan: c.sections.map(s => ({duration_s: s[0], drive: Float64Array.from(s.slice(1))}))}));
    this.time_s = 0;
    this.state = new Float64Array(this.machine.n);
    this.told = new Float64Array(this.machine.n_outputs);
    this.take(this.cyclogram(data.first));
  }

  cyclogram(name) { return this.cyclograms.find(c => c.name === name).plan; }

  // The rows that `driftwright predict` would give for a plan.
  rowsOf(plan) { return new Run(this.machine, plan, this.data.interval_s).finish(); }

  // Runs another plan; rows before from_s are those of the previous plan.
  take(plan, from_s = 0) {
    const interval_s = this.data.interval_s, rows = planDuration(plan) / interval_s;
    const shown_s = interval_s * Math.max(1, Math.ceil(rows / Twin.MOST_ROWS));
    this.run = new Run(this.machine, plan, shown_s, from_s > 0 ? this.run : null, from_s);
    this.working = this.run.work();
    this.time_s = Math.min(this.time_s, this.run.end_s);
  }

  // Continues the run for some milliseconds. @returns whether it advanced
  work(budget_ms) {
    if (this.run.isDone) return false;
    const until = performance.now() + budget_ms;
    while (!this.run.isDone && performance.now() < until) this.working.next();
    return true;
  }

  // Sets one variable of the drive from now on.
  setDrive(variable, value) { this.take(changedFrom(this.run.plan, this.time_s, variable, value), this.time_s); }

  // Advances time, and computes rows that are missing. @returns outputs()
  step(dt_s) {
    this.time_s = Math.min(this.run.end_s, this.time_s + dt_s);
    while (!this.isKnown()) this.working.next();
    return this.outputs();
  }
  isKnown() { return this.run.isDone || (this.run.n_done > 0 && this.run.time_s[this.run.n_done - 1] >= this.time_s); }

  // The present readings of the instruments, by name, in their units.
  outputs() {
    this.run.outputsAt(this.time_s, this.told);
    return Object.fromEntries(this.machine.outputs_told.map((o, i) => [o.name, this.told[i]]));
  }
  stateNow() { return this.run.stateAt(this.time_s, this.state); }
  ambientNow_K() { return ambientAt(this.machine.ambient, this.time_s); }

  // The 95 % band of an output from what is known of the machine's numbers; null without one, and for another plan than the
  // cyclogram that it was computed for.
  strip(output) {
    const {check, drive} = this.data, band = check.band;
    if (!band) return null;
    const plan = this.cyclogram(check.cyclogram), now = this.run.plan;
    const isSame = now.length === plan.length && now.every((section, i) => section.duration_s === plan[i].duration_s &&
        drive.every((_, d) => section.drive[d] === plan[i].drive[d]));
    if (!isSame) return null;
    this.limits ??= {time_s: doubles(band.time_s), low: doubles(band.low), high: doubles(band.high)};
    const {time_s, low, high} = this.limits, n = this.machine.outputs_told.length;
    const column = list => Float64Array.from(time_s, (_, row) => list[row * n + output]);
    return {time_s, low: column(low), high: column(high)};
  }

  // Compares the page with `driftwright predict`: the largest differences over the embedded rows.
  check() {
    const {check} = this.data, values = doubles(check.values);
    const run = this.rowsOf(this.cyclogram(check.cyclogram));
    return largestDifference(run, {n_rows: run.time_s.length, values});
  }
}
