// A plan of sections, run on the machine: rows of outputs and states, from the start to the end.

const planDuration = plan => plan.reduce((sum, section) => sum + section.duration_s, 0);

// The drive at a time; after the end that of the last section.
function driveAt(plan, time_s) {
  let start = 0;
  for (const section of plan) {
    start += section.duration_s;
    if (time_s < start - 1e-9) return section.drive;
  }
  return plan[plan.length - 1].drive;
}

class Run {
  // @param before, from_s  a run whose rows up to that time are taken over
  constructor(machine, plan, interval_s, before = null, from_s = 0) {
    this.machine = machine;
    this.plan = plan;
    this.end_s = planDuration(plan);
    const times = [];
    for (let i = 0; i * interval_s < this.end_s - 1e-6; ++i) times.push(i * interval_s);
    times.push(this.end_s);
    this.time_s = Float64Array.from(times);
    const n = times.length;
    this.outputs = new Float64Array(n * machine.n_outputs);
    this.states = new Float64Array(n * machine.n);
    this.switches = new Uint8Array(n * machine.thermostats.length);
    this.n_done = 0;
    if (before) this.take(before, from_s);
  }

  take(before, from_s) {
    const {n, n_outputs, thermostats} = this.machine, k = thermostats.length;
    let rows = 0;
    while (rows < Math.min(before.n_done, this.time_s.length) && before.time_s[rows] === this.time_s[rows] &&
           this.time_s[rows] <= from_s) ++rows;
    this.outputs.set(before.outputs.subarray(0, rows * n_outputs));
    this.states.set(before.states.subarray(0, rows * n));
    this.switches.set(before.switches.subarray(0, rows * k));
    this.n_done = rows;
  }

  get isDone() { return this.n_done === this.time_s.length; }

  // Computes row by row; yields within a row that takes long.
  * work() {
    const m = this.machine, n = m.n, k = m.thermostats.length, ambient = t => ambientAt(m.ambient, t);
    const now = {z: new Float64Array(n), isOn: null, step_s: 0};
    if (this.n_done === 0) {
      now.z.set(m.start);
      now.isOn = m.thermostatsAt(now.z, ambient(0));
      this.keep(0, now);
    } else {
      const last = this.n_done - 1;
      now.z.set(this.states.subarray(last * n, last * n + n));
      now.isOn = this.switches.slice(last * k, last * k + k);
    }
    let section_before = null;
    while (!this.isDone) {
      const from_s = this.time_s[this.n_done - 1], until_s = this.time_s[this.n_done];
      let start = 0;
      for (const section of this.plan) {
        const end = start + section.duration_s, a = Math.max(start, from_s), b = Math.min(end, until_s);
        if (b > a + 1e-9) {
          if (section !== section_before) now.step_s = Machine.FIRST_STEP_S;
          section_before = section;
          yield* m.advance(now, section.drive, a, b);
        }
        start = end;
      }
      this.keep(this.n_done, now);
      yield;
    }
  }

  keep(row, {z, isOn}) {
    const m = this.machine;
    this.states.set(z, row * m.n);
    this.switches.set(isOn, row * m.thermostats.length);
    m.outputs(z, ambientAt(m.ambient, this.time_s[row]), this.outputs.subarray(row * m.n_outputs, (row + 1) * m.n_outputs));
    this.n_done = row + 1;
  }

  finish() {
    for (const _ of this.work());
    return this;
  }

  // The rows around a time, and its position between them; only among finished rows.
  place(time_s) {
    const last = this.n_done - 1;
    if (last <= 0) return [0, 0, 0];
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time_s < this.time_s[middle]) high = middle;
      else low = middle;
    }
    return [low, high, Math.min(1, Math.max(0, (time_s - this.time_s[low]) / (this.time_s[high] - this.time_s[low])))];
  }

  // Linear interpolation between rows; its error is far too small to see.
  between(values, width, time_s, into) {
    const [low, high, share] = this.place(time_s);
    for (let i = 0; i < width; ++i)
      into[i] = (1 - share) * values[low * width + i] + share * values[high * width + i];
    return into;
  }
  stateAt(time_s, into) { return this.between(this.states, this.machine.n, time_s, into); }
  outputsAt(time_s, into) { return this.between(this.outputs, this.machine.n_outputs, time_s, into); }
  column(output) {
    return Float64Array.from({length: this.n_done}, (_, row) => this.outputs[row * this.machine.n_outputs + output]);
  }
}

// The largest differences between runs of the page and the embedded rows, in K and in um (1 urad counts as 1 um).
function largestDifference(run, check) {
  const largest = {K: 0, um: 0}, n = run.machine.n_outputs;
  run.machine.outputs_told.forEach((output, o) => {
    const kind = output.unit === "degC" ? "K" : "um";
    for (let row = 0; row < check.n_rows; ++row)
      largest[kind] = Math.max(largest[kind], Math.abs(run.outputs[row * n + o] - check.values[row * n + o]));
  });
  return largest;
}
