// Fields on the machine's surface as sums of the states' fields, which are stored as 16-bit numbers.

const decodeBytes = text => {
  const bytes = atob(text), out = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; ++i) out[i] = bytes.charCodeAt(i);
  return out.buffer;
};
const doubles = text => new Float64Array(decodeBytes(text));

// y = A x, with A by rows.
function product(rows, columns, a, x, y) {
  for (let i = 0; i < rows; ++i) {
    let sum = 0;
    const row = i * columns;
    for (let j = 0; j < columns; ++j) sum += a[row + j] * x[j];
    y[i] = sum;
  }
  return y;
}

class SurfaceFields {
  // @param surface  {n_nodes, temperature, displacement}: each {scale, value} of all states
  constructor(surface) {
    this.n = surface.n_nodes;
    const modes = part => ({scale: doubles(part.scale), value: new Int16Array(decodeBytes(part.value))});
    this.temperature = modes(surface.temperature);
    this.displacement = modes(surface.displacement);
    this.isStill = this.displacement.value.length === 0;
    this.temperature_K = new Float32Array(this.n);   // over the reference
    this.displaced_m = new Float32Array(3 * this.n);
    this.next = 0;  // next node of the running sum
    this.state = null;
  }

  // Starts a sum for a state; each node keeps its old value until its turn.
  begin(state) {
    this.state = Float64Array.from(state);
    this.next = 0;
  }

  // Continues for some milliseconds. @returns whether the fields are complete
  work(budget_ms) {
    const until = performance.now() + budget_ms;
    while (this.next < this.n) {
      this.sum(this.next, Math.min(this.n, this.next + 1024));
      if (performance.now() > until) break;
    }
    return this.next === this.n;
  }

  sum(from, to) {
    const {n, state} = this;
    const add = (part, out, a, b, width) => {
      out.fill(0, a, b);
      for (let k = 0; k < state.length; ++k) {
        const factor = state[k] * part.scale[k], value = part.value, first = k * n * width;
        for (let i = a; i < b; ++i) out[i] += factor * value[first + i];
      }
    };
    add(this.temperature, this.temperature_K, from, to, 1);
    if (!this.isStill) add(this.displacement, this.displaced_m, 3 * from, 3 * to, 3);
    this.next = to;
  }

  whole(state) {
    this.begin(state);
    this.sum(0, this.n);
  }
}
