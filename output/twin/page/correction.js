// The drift that a correction leaves: by the scenario's regression on its thermometers or, without one, by this model one
// row late and zeroed at the start.

// Whole periods of the encoder that follow a prediction: the pulse injector inserts the next one when half of it is due.
// Rounds halves away from zero, as C's round does; Math.round alone does not.
const rounded = x => Math.sign(x) * Math.round(Math.abs(x));

// @returns {correction, left} per row [um]; `left` is the larger of just before and just after the correction is renewed
function corrected(run, output, correction) {
  const n = run.machine.n_outputs, rows = run.n_done, drift = run.column(output);
  const predicted = new Float64Array(rows), inForce = new Float64Array(rows), left = new Float64Array(rows);
  const formula = correction.formulas.find(f => f.output === output);
  for (let row = 0; row < rows; ++row) {
    if (formula) {
      let sum = formula.intercept;
      formula.inputs.forEach((input, k) => {
        const t = run.outputs[row * n + input], step = correction.resolution_K;
        sum += formula.coefficients[k] * (step > 0 ? step * rounded(t / step) : t);
      });
      predicted[row] = sum;
    } else {
      predicted[row] = drift[Math.max(0, row - 1)];
    }
    const period = correction.period_um;
    inForce[row] = period > 0 ? period * rounded(predicted[row] / period) : predicted[row];
    const after = drift[row] - inForce[row], before = drift[row] - (row > 0 ? inForce[row - 1] : formula ? 0 : drift[0]);
    left[row] = Math.abs(before) > Math.abs(after) ? before : after;
  }
  return {drift, correction: inForce, left};
}
