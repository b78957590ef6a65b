// Eigenvectors of a symmetric matrix: Householder's tridiagonal reduction, then implicit QL steps (Bowdler et al., Numer.
// Math. 11 (1968) 293). A generator: it yields after each row, so that no frame waits for it.

// @param a  n x n by rows; its lower triangle is overwritten by the reflections
// @returns {values, vectors}, one vector per row
function* symmetricEigen(n, a) {
  const d = new Float64Array(n), e = new Float64Array(n), v = new Float64Array(n * n);
  yield* reduceToThreeDiagonals(n, a, d, e, v);
  for (let l = 0; l < n; ++l) {
    for (let step = 0; ; ++step) {
      let m = l;
      while (m + 1 < n && Math.abs(e[m]) > Number.EPSILON * (Math.abs(d[m]) + Math.abs(d[m + 1]))) ++m;
      if (m === l) break;
      if (step === 60) throw new Error("the eigenvectors of the conduction matrix did not converge");
      qlStep(n, d, e, v, l, m);
    }
    yield;
  }
  return {values: d, vectors: v};
}

// Reduces A to H ... A ... H with the diagonal d and the off-diagonal e; v: the product of the reflections, its column k
// in row k.
function* reduceToThreeDiagonals(n, a, d, e, v) {
  const w = new Float64Array(n), p = new Float64Array(n), beta = new Float64Array(n);
  for (let k = 0; k + 2 < n; ++k) {
    let norm2 = 0, vp = 0;
    for (let i = k + 1; i < n; ++i) {
      w[i] = a[i * n + k];
      norm2 += w[i] * w[i];
    }
    const alpha = w[k + 1] > 0 ? -Math.sqrt(norm2) : Math.sqrt(norm2), vv = 2 * (norm2 - alpha * w[k + 1]);
    if (vv > 0) {
      w[k + 1] -= alpha;
      beta[k] = 2 / vv;
      for (let i = k + 1; i < n; ++i) {
        let sum = 0;
        for (let j = k + 1; j < n; ++j) sum += a[i * n + j] * w[j];
        p[i] = beta[k] * sum;
        vp += p[i] * w[i];
      }
      for (let i = k + 1; i < n; ++i) p[i] -= 0.5 * beta[k] * vp * w[i];
      for (let i = k + 1; i < n; ++i) {
        const wi = w[i], pi = p[i], row = i * n;
        for (let j = k + 1; j < n; ++j) a[row + j] -= wi * p[j] + pi * w[j];
      }
      for (let i = k + 1; i < n; ++i) a[i * n + k] = w[i];
    }
    d[k] = a[k * n + k];
    e[k] = alpha;
    yield;
  }
  if (n > 1) e[n - 2] = a[(n - 1) * n + n - 2];
  for (let i = Math.max(0, n - 2); i < n; ++i) d[i] = a[i * n + i];
  for (let i = 0; i < n; ++i) v[i * n + i] = 1;
  for (let k = n - 3; k >= 0; --k) {  // backwards: each reflection acts on the block made by the later ones
    if (beta[k] === 0) continue;
    for (let i = k + 1; i < n; ++i) w[i] = a[i * n + k];
    for (let j = k + 1; j < n; ++j) {
      const row = j * n;
      let sum = 0;
      for (let i = k + 1; i < n; ++i) sum += w[i] * v[row + i];
      sum *= beta[k];
      for (let i = k + 1; i < n; ++i) v[row + i] -= sum * w[i];
    }
    yield;
  }
}

function qlStep(n, d, e, v, l, m) {
  let g = (d[l + 1] - d[l]) / (2 * e[l]), r = Math.sqrt(g * g + 1), s = 1, c = 1, p = 0, i = m - 1;
  g = d[m] - d[l] + e[l] / (g < 0 ? g - r : g + r);
  for (; i >= l; --i) {
    const f = s * e[i], b = c * e[i], upper = i * n, lower = (i + 1) * n;
    r = Math.sqrt(f * f + g * g);
    e[i + 1] = r;
    if (r === 0) {
      d[i + 1] -= p;
      e[m] = 0;
      return;
    }
    s = f / r;
    c = g / r;
    g = d[i + 1] - p;
    r = (d[i] - g) * s + 2 * c * b;
    p = s * r;
    d[i + 1] = g + p;
    g = c * r - b;
    for (let k = 0; k < n; ++k) {
      const z = v[lower + k], u = v[upper + k];
      v[lower + k] = s * u + c * z;
      v[upper + k] = c * u - s * z;
    }
  }
  d[l] -= p;
  e[l] = g;
  e[m] = 0;
}
