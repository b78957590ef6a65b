// Tabulated laws of the page's data: the heat of a source [W] or the conductance of an exchange, over drive and
// temperatures.

// A sum over the variables of the drive: in each piece a polynomial of log x in Chebyshev form, 0 at rest, plus `rest`.
// @param law    {rest, terms: [{variable, log_x, c}]}
function driveLaw(law, drive) {
  let value = law.rest;
  for (const term of law.terms) {
    const x = drive[term.variable];
    if (!(x > 0)) continue;
    const ends = term.log_x, degree = term.c.length / (ends.length - 1) - 1, logX = Math.log(x);
    let low = 0, high = ends.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (logX < ends[middle]) high = middle;
      else low = middle;
    }
    const s = Math.min(1, Math.max(-1, 2 * (logX - ends[low]) / (ends[low + 1] - ends[low]) - 1));
    const first = low * (degree + 1);
    let b0 = 0, b1 = 0;
    for (let j = degree; j > 0; --j) {  // Clenshaw's sum
      const b2 = b1;
      b1 = b0;
      b0 = 2 * s * b1 - b2 + term.c[first + j];
    }
    value += s * b0 - b1 + term.c[first];
  }
  return value;
}

// A law of temperatures under one drive: numbers over one or two axes, linear between nodes. An axis is the temperature
// of a probe, or (minus >= 0) its difference to another probe.
// @param tables  [{axes: [{probe, minus, nodes}], at: [law over the drive for each pair of nodes]}]
function tablesUnder(tables, drive) {
  return tables.map(t => ({axes: t.axes, values: Float64Array.from(t.at, law => driveLaw(law, drive))}));
}

// The piece of an axis that contains x, and the position in it; the end of the axis for x beyond it.
function placeOn(nodes, x) {
  let low = 0, high = nodes.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x < nodes[middle]) high = middle;
    else low = middle;
  }
  return [low, Math.min(1, Math.max(0, (x - nodes[low]) / (nodes[low + 1] - nodes[low])))];
}

// The law at given temperatures: each table adds its difference from the value at usual temperatures.
// @param probe_K  absolute temperatures of all probes
function valueOfTables(usual, tables, probe_K) {
  let value = usual * (1 - tables.length);
  for (const {axes, values} of tables) {
    const x = axis => probe_K[axis.probe] - (axis.minus >= 0 ? probe_K[axis.minus] : 0);
    const [i, u] = placeOn(axes[0].nodes, x(axes[0]));
    if (axes.length === 1) {
      value += (1 - u) * values[i] + u * values[i + 1];
    } else {
      const [j, w] = placeOn(axes[1].nodes, x(axes[1])), n = axes[1].nodes.length, at = i * n + j;
      value += (1 - u) * ((1 - w) * values[at] + w * values[at + 1]) + u * ((1 - w) * values[at + n] + w * values[at + n + 1]);
    }
  }
  return value;
}
