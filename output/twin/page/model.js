// The machine's small system in time, dz/dt = -K z + f:
//
//     K = K0 + sum c_e G_e,   f = sum P_s b_s + sum c_e (ambient g_e + o_e)
//
// In the eigenvectors of K the solution over a stretch with constant drive and linear ambient is a sum of exponentials,
// exact for any step. Laws of temperatures are held at their value at the start of the stretch; their change enters by
// the exponential Runge-Kutta method of second order (Cox & Matthews, J. Comput. Phys. 176 (2002) 430, ETD2RK), with
// steps by its error. Thermostats switch where their probe passes the limit.

// e^-x, (1 - e^-x) / x and (1 - (1 - e^-x) / x) / x, x >= 0
function decayOf(x) {
  if (x < 1e-2) {  // avoids differences of nearly equal numbers
    return [Math.exp(-x), 1 - x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6)))),
            0.5 - x / 6 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6 * (1 - x / 7))))];
  }
  const ofConstant = -Math.expm1(-x) / x;
  return [Math.exp(-x), ofConstant, (1 - ofConstant) / x];
}

// y += A'x or y = A x of a matrix by rows
function addTransposed(rows, columns, a, x, y) {
  for (let i = 0; i < rows; ++i) {
    const xi = x[i], row = i * columns;
    if (xi !== 0) for (let j = 0; j < columns; ++j) y[j] += a[row + j] * xi;
  }
}
// The ambient over the reference temperature [K], linear between knots and constant outside of them.
function ambientAt(ambient, time_s) {
  const t = ambient.time_s, v = ambient.value_K;
  if (!(time_s > t[0])) return v[0];
  for (let k = 1; k < t.length; ++k) {
    if (time_s < t[k]) return v[k - 1] + (v[k] - v[k - 1]) * ((time_s - t[k - 1]) / (t[k] - t[k - 1]));
  }
  return v[v.length - 1];
}

class Machine {
  static MOST_KEPT = 240;  // most decompositions that are stored
  static FIRST_STEP_S = 5;
  static HELD_FROM = 0.6;    // lowest and highest ratio of held to present coefficients of temperature
  static HELD_TO = 1.7;
  static TYPICAL_K = 4;
  static ERROR_K = 1e-3;   // error of a step's first guess, at the outputs; 2 um count as 1 K

  // @param m  the system, as in the page's data
  constructor(m) {
    Object.assign(this, m);
    this.kept = new Map();
    this.isLive = law => law.tables.length > 0;
    const all = [...this.powers, ...this.coefficients];
    this.follows = all.some(choices => choices.laws.some(this.isLive)) || this.thermostats.length > 0;
    this.probe_K = new Float64Array(this.n_probes);
  }

  nextEvent(time_s) {
    let next = Infinity;
    for (const t of [...this.ambient.time_s, ...this.change_times_s]) if (t > time_s + 1e-9 && t < next) next = t;
    return next;
  }

  // The law of a source or exchange at a time.
  lawAt(choices, time_s) {
    let stretch = 0;
    while (stretch < this.change_times_s.length && this.change_times_s[stretch] <= time_s + 1e-9) ++stretch;
    return choices.laws[choices.of_stretch[stretch]];
  }

  probes(z, ambient_K) {
    product(this.n_probes, this.n, this.probe_weights, z, this.probe_K);
    for (let p = 0; p < this.n_probes; ++p)
      this.probe_K[p] += this.reference_K + this.probe_ambient[p] * ambient_K + this.probe_offset_K[p];
    return this.probe_K;
  }

  outputs(z, ambient_K, into) {
    product(this.n_outputs, this.n, this.output_state, z, into);
    for (let o = 0; o < this.n_outputs; ++o) {
      const {factor, offset} = this.outputs_told[o];
      into[o] = factor * (into[o] + this.output_ambient[o] * ambient_K) + offset;
    }
    return into;
  }

  // K of a set of coefficients, in its eigenvectors; a generator, since this may take longer than a frame.
  * decomposition(c) {
    const key = c.join();
    const known = this.kept.get(key);
    if (known) return known;
    const n = this.n, k = Float64Array.from(this.conduction);
    c.forEach((ce, e) => {
      if (ce !== 0) for (let i = 0, g = e * n * n; i < n * n; ++i) k[i] += ce * this.exchanges[g + i];
    });
    const {values, vectors} = yield* symmetricEigen(n, k);
    const d = {lambda: values.map(x => Math.max(0, x)), vectors, step_s: -1, kept: new Float64Array(n),
               ofConstant: new Float64Array(n), ofSlope: new Float64Array(n)};
    if (this.kept.size >= Machine.MOST_KEPT) this.kept.delete(this.kept.keys().next().value);
    this.kept.set(key, d);
    return d;
  }

  // A law under a drive; tables of temperature are stored for the last drive.
  under(choices, drive, time_s) {
    const law = this.lawAt(choices, time_s), key = drive.join();
    if (law.key !== key) {
      Object.assign(law, {key, rest: driveLaw(law.drive, drive), live: tablesUnder(law.tables, drive)});
      const warm_K = new Float64Array(this.n_probes).fill(this.reference_K);
      for (const {axes} of law.live) warm_K[axes[0].probe] += Machine.TYPICAL_K;
      law.typical = valueOfTables(law.rest, law.live, warm_K);
    }
    return {rest: law.rest, tables: law.live, thermostat: law.thermostat, typical: law.typical};
  }

  // All that is constant from a state on while the drive stays: laws, decomposition, loads in the eigenvectors.
  // Coefficients that depend on temperatures are held at one value (now.held) while it is close enough, since a
  // decomposition costs more than their change. The value is at least half of the typical one: then the remainder damps
  // less than the held part, however steep free convection begins.
  * stretch(drive, time_s, now) {
    const n = this.n, {z, isOn} = now;
    const powers = this.powers.map(choices => this.under(choices, drive, time_s));
    const coefficients = this.coefficients.map(choices => this.under(choices, drive, time_s));
    const ambient_K = ambientAt(this.ambient, time_s), probe_K = this.probes(z, ambient_K);
    const value = law => (law.thermostat >= 0 && !isOn[law.thermostat]) ? 0 : valueOfTables(law.rest, law.tables, probe_K);
    const c = now.held = coefficients.map((law, e) => {
      if (law.tables.length === 0) return Math.max(0, value(law));
      const is = Math.max(value(law), 0.5 * law.typical), was = now.held?.[e];
      return is > Machine.HELD_FROM * was && is < Machine.HELD_TO * was ? was : is;
    });
    const p = powers.map(value);
    const d = yield* this.decomposition(c);
    const constant = new Float64Array(n), perAmbient = new Float64Array(n);
    addTransposed(this.n_sources, n, this.loads, p, constant);
    addTransposed(this.n_exchanges, n, this.offsets, c, constant);
    addTransposed(this.n_exchanges, n, this.to_ambient, c, perAmbient);
    const inModes = x => product(n, n, d.vectors, x, new Float64Array(n));
    return {d, c, p, value, constant: inModes(constant), perAmbient: inModes(perAmbient),
            livePowers: powers.map((law, s) => [law, s]).filter(([law]) => law.tables.length > 0),
            liveCoefficients: coefficients.map((law, e) => [law, e]).filter(([law]) => law.tables.length > 0)};
  }

  // What laws of temperature add to the slopes beyond their held values, in the eigenvectors.
  beyond(stretch, modes, ambient_K, z, into) {
    const n = this.n;
    z.fill(0);
    addTransposed(n, n, stretch.d.vectors, modes, z);
    this.probes(z, ambient_K);
    const heat = new Float64Array(n);
    for (const [law, s] of stretch.livePowers) {
      const more = stretch.value(law) - stretch.p[s];
      for (let i = 0; i < n; ++i) heat[i] += more * this.loads[s * n + i];
    }
    for (const [law, e] of stretch.liveCoefficients) {
      const more = stretch.value(law) - stretch.c[e], g = e * n * n;
      for (let i = 0; i < n; ++i) {
        let sum = ambient_K * this.to_ambient[e * n + i] + this.offsets[e * n + i];
        for (let j = 0; j < n; ++j) sum -= this.exchanges[g + i * n + j] * z[j];
        heat[i] += more * sum;
      }
    }
    return product(n, n, stretch.d.vectors, heat, into);
  }

  // The modes of the linear system alone after a step with linear ambient.
  linearStep(stretch, modes, time_s, h_s, into) {
    const d = stretch.d, ambient = ambientAt(this.ambient, time_s), slope = (ambientAt(this.ambient, time_s + h_s) - ambient) / h_s;
    if (Math.abs(h_s - d.step_s) > 1e-12 * h_s) {
      for (let i = 0; i < this.n; ++i) [d.kept[i], d.ofConstant[i], d.ofSlope[i]] = decayOf(d.lambda[i] * h_s);
      d.step_s = h_s;
    }
    for (let i = 0; i < this.n; ++i)
      into[i] = d.kept[i] * modes[i] + h_s * d.ofConstant[i] * (stretch.constant[i] + ambient * stretch.perAmbient[i]) +
          h_s * h_s * d.ofSlope[i] * slope * stretch.perAmbient[i];
    return into;
  }

  distanceToSwitch(k, z, ambient_K, isOn) {
    const t = this.thermostats[k];
    return this.probes(z, ambient_K)[t.probe] - (isOn[k] ? t.off_below_K : t.on_above_K);
  }

  // From time_s to end_s under one drive.
  // @param now  {z, isOn, step_s}: the state, which thermostats are on, and the next step to try; changed in place
  * advance(now, drive, time_s, end_s) {
    const n = this.n, {z, isOn} = now;
    while (time_s < end_s - 1e-9) {
      const until_s = Math.min(end_s, this.nextEvent(time_s));
      const stretch = yield* this.stretch(drive, time_s, now);
      let modes = product(n, n, stretch.d.vectors, z, new Float64Array(n));
      if (!this.follows) {
        modes = this.linearStep(stretch, modes, time_s, until_s - time_s, new Float64Array(n));
        time_s = until_s;
      } else {
        time_s = yield* this.followingSteps(stretch, modes, now, time_s, until_s);
      }
      z.fill(0);
      addTransposed(n, n, stretch.d.vectors, modes, z);
    }
  }

  // Steps until until_s, or until a thermostat switches. @returns the time reached; the modes change in place
  * followingSteps(stretch, modes, now, time_s, until_s) {
    const n = this.n, {z, isOn} = now, guess = new Float64Array(n), before = new Float64Array(n), after = new Float64Array(n), d = stretch.d;
    const room = new Float64Array(n), told = new Float64Array(this.n_outputs);
    let h_s = now.step_s, tries = 0;
    const step = h => {
      this.beyond(stretch, modes, ambientAt(this.ambient, time_s), z, before);
      this.linearStep(stretch, modes, time_s, h, guess);
      for (let i = 0; i < n; ++i) guess[i] += h * d.ofConstant[i] * before[i];
      this.beyond(stretch, guess, ambientAt(this.ambient, time_s + h), z, after);
      for (let i = 0; i < n; ++i) room[i] = h * d.ofSlope[i] * (after[i] - before[i]);
      z.fill(0);
      addTransposed(n, n, d.vectors, room, z);
      product(this.n_outputs, n, this.output_state, z, told);
      let error_K = 0;
      for (let o = 0; o < this.n_outputs; ++o)
        error_K = Math.max(error_K, Math.abs(told[o]) / (this.outputs_told[o].factor === 1 ? 1 : 2e-6));
      for (let i = 0; i < n; ++i) guess[i] += room[i];
      return error_K;
    };
    const distanceAfter = (k, h) => {
      z.fill(0);
      addTransposed(n, n, d.vectors, guess, z);
      return this.distanceToSwitch(k, z, ambientAt(this.ambient, time_s + h), isOn);
    };
    const passes = (k, h) => (isOn[k] ? -1 : 1) * distanceAfter(k, h) > 0;
    while (time_s < until_s - 1e-9) {
      h_s = Math.min(h_s, until_s - time_s);
      const error_K = step(h_s);
      if (error_K > Machine.ERROR_K && h_s > 0.05 && ++tries < 40) {
        h_s *= Math.max(0.2, 0.9 * Math.sqrt(Machine.ERROR_K / error_K));
        continue;
      }
      tries = 0;
      const passed = this.thermostats.findIndex((t, k) => passes(k, h_s));
      if (passed >= 0) {  // halve the step to find where it switches
        let low = 0, high = h_s;
        while (high - low > 1e-3) {
          const middle = 0.5 * (low + high);
          step(middle);
          if (passes(passed, middle)) high = middle;
          else low = middle;
        }
        step(high);
        modes.set(guess);
        isOn[passed] ^= 1;
        now.step_s = Machine.FIRST_STEP_S;
        return time_s + high;
      }
      modes.set(guess);
      time_s += h_s;
      now.step_s = h_s = Math.min(120, h_s * Math.min(3, 0.9 * Math.sqrt(Machine.ERROR_K / Math.max(error_K, 1e-9))));
      yield;
    }
    return until_s;
  }

  thermostatsAt(z, ambient_K) {
    const isOn = new Uint8Array(this.thermostats.length);
    for (let k = 0; k < isOn.length; ++k) isOn[k] = this.distanceToSwitch(k, z, ambient_K, isOn) > 0 ? 1 : 0;
    return isOn;
  }
}
