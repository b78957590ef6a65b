// Curves over time on a canvas. The mark of the present time is an element beside it, so that nothing is redrawn while
// time runs.

const LEAST_SPAN = 0.02;  // least span of an axis: smaller differences are drawn level
const MARGIN = {left: 60, right: 14, top: 10, bottom: 24};
const CURVES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f", "#8a5fbf"];
const styleOf = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Round steps for an axis: 1, 2 or 5 times a power of ten.
function ticks(low, high, most) {
  const rough = (high - low) / most, decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map(s => s * decade).find(s => s >= rough);
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) list.push(k * step);
  return {list, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}

class Chart {
  // @param along  unit of time, and its number of seconds
  constructor(canvas, unit, along = {unit: "min", unit_s: 60}) {
    Object.assign(this, {canvas, unit, along, begin_s: 0, end_s: 1, low: 0, high: 1});
    this.mark = canvas.parentElement.querySelector("i");
  }

  x(time_s) {
    return MARGIN.left + (this.canvas.clientWidth - MARGIN.left - MARGIN.right) * (time_s - this.begin_s) / (this.end_s - this.begin_s);
  }
  y(value) {
    return this.canvas.clientHeight - MARGIN.bottom -
        (this.canvas.clientHeight - MARGIN.top - MARGIN.bottom) * (value - this.low) / (this.high - this.low);
  }
  timeAt(x) {
    return this.begin_s + (x - MARGIN.left) / (this.canvas.clientWidth - MARGIN.left - MARGIN.right) * (this.end_s - this.begin_s);
  }
  valueAt(y) {
    return this.low + (this.canvas.clientHeight - MARGIN.bottom - y) / (this.canvas.clientHeight - MARGIN.top - MARGIN.bottom) *
        (this.high - this.low);
  }
  markAt(time_s) { this.mark.style.transform = `translateX(${this.x(time_s)}px)`; }

  // @param curves  [{time_s, values, colour, isStepped, width, strip}]; strip: {time_s, low, high}, drawn under all curves
  // @param range   [low, high], or null: the range of the curves
  // NaN leaves a gap.
  draw(curves, end_s, range = null, band = null, begin_s = 0) {
    const {canvas} = this, dense = window.devicePixelRatio || 1, pen = canvas.getContext("2d");
    canvas.width = Math.round(canvas.clientWidth * dense);
    canvas.height = Math.round(canvas.clientHeight * dense);
    pen.scale(dense, dense);
    Object.assign(this, {begin_s, end_s});
    [this.low, this.high] = range ?? this.reach(curves, band);
    this.drawAxes(pen);
    if (band) {
      pen.fillStyle = styleOf("--band");
      pen.globalAlpha = 0.12;
      pen.fillRect(this.x(begin_s), this.y(band), this.x(end_s) - this.x(begin_s), this.y(-band) - this.y(band));
      pen.globalAlpha = 1;
    }
    pen.globalAlpha = 0.18;
    for (const {strip, colour} of curves) {
      if (!strip) continue;
      pen.fillStyle = colour;
      pen.beginPath();
      for (let i = 0; i < strip.high.length; ++i) pen.lineTo(this.x(strip.time_s[i]), this.y(strip.high[i]));
      for (let i = strip.low.length - 1; i >= 0; --i) pen.lineTo(this.x(strip.time_s[i]), this.y(strip.low[i]));
      pen.fill();
    }
    pen.globalAlpha = 1;
    for (const curve of curves) {
      pen.lineWidth = curve.width ?? 2;
      pen.strokeStyle = curve.colour;
      pen.beginPath();
      for (let i = 0; i < curve.values.length; ++i) {
        if (Number.isNaN(curve.values[i])) continue;
        if (i > 0 && Number.isNaN(curve.values[i - 1])) pen.moveTo(this.x(curve.time_s[i]), this.y(curve.values[i]));
        if (curve.isStepped && i > 0) pen.lineTo(this.x(curve.time_s[i]), this.y(curve.values[i - 1]));
        pen.lineTo(this.x(curve.time_s[i]), this.y(curve.values[i]));
      }
      pen.stroke();
    }
  }

  reach(curves, band) {
    let low = band ? -1.1 * band : Infinity, high = band ? 1.1 * band : -Infinity;
    for (const {values, strip} of curves) for (const list of [values, ...(strip ? [strip.low, strip.high] : [])]) for (const v of list) {
      if (v < low) low = v;
      if (v > high) high = v;
    }
    if (!(high - low > LEAST_SPAN)) [low, high] = [Number.isFinite(low) ? low - 1 : 0, Number.isFinite(high) ? high + 1 : 1];
    const air = 0.05 * (high - low);
    return [low - air, high + air];
  }

  drawAxes(pen) {
    pen.font = "12px system-ui, sans-serif";
    pen.strokeStyle = styleOf("--line");
    pen.fillStyle = styleOf("--soft");
    pen.lineWidth = 1;
    const bottom = this.canvas.clientHeight - MARGIN.bottom;
    pen.textAlign = "right";
    const up = ticks(this.low, this.high, 5);
    for (const v of up.list) {
      pen.beginPath();
      pen.moveTo(MARGIN.left, this.y(v));
      pen.lineTo(this.canvas.clientWidth - MARGIN.right, this.y(v));
      pen.stroke();
      pen.fillText(v.toFixed(up.decimals), MARGIN.left - 6, this.y(v) + 4);
    }
    pen.save();
    pen.translate(11, 0.5 * (MARGIN.top + bottom));
    pen.rotate(-0.5 * Math.PI);
    pen.textAlign = "center";
    pen.fillText(this.unit, 0, 0);
    pen.restore();
    pen.textAlign = "center";
    const {unit, unit_s} = this.along, along = ticks(this.begin_s / unit_s, this.end_s / unit_s, Math.max(3, this.canvas.clientWidth / 90));
    for (const t of along.list) pen.fillText(t.toFixed(along.decimals), this.x(unit_s * t), bottom + 16);
    pen.textAlign = "right";
    pen.fillText(unit, MARGIN.left - 8, bottom + 16);
  }
}
