// Cyclograms that the user changes: by drawing, by a slider from now on, or as text.

const BINS = 60;     // of a drawing
const DRAWN_STEPS = 50;  // of the drive's largest value

const copyOf = plan => plan.map(s => ({duration_s: s.duration_s, drive: Float64Array.from(s.drive)}));

// Joins neighbouring sections with the same drive.
function merged(plan) {
  const list = [];
  for (const section of plan) {
    const last = list[list.length - 1];
    if (!(section.duration_s > 1e-9)) continue;
    if (last && last.drive.every((v, i) => v === section.drive[i])) last.duration_s += section.duration_s;
    else list.push({duration_s: section.duration_s, drive: Float64Array.from(section.drive)});
  }
  return list;
}

// The plan with one variable of the drive at another value, from a time to the plan's end.
function changedFrom(plan, time_s, variable, value) {
  const list = [];
  let start = 0;
  for (const section of copyOf(plan)) {
    const before = Math.min(section.duration_s, Math.max(0, time_s - start)), drive = Float64Array.from(section.drive);
    start += section.duration_s;
    drive[variable] = value;
    list.push({duration_s: before, drive: section.drive}, {duration_s: section.duration_s - before, drive});
  }
  return merged(list);
}

// The plan in bins of equal length, each with the drive at its middle.
function binned(plan) {
  const end = planDuration(plan), width = end / BINS;
  return Array.from({length: BINS}, (_, i) => ({duration_s: width, drive: Float64Array.from(driveAt(plan, (i + 0.5) * width))}));
}

// "minutes, value, value": one section per line
const planText = plan => plan.map(s => [+(s.duration_s / 60).toPrecision(10), ...Array.from(s.drive, v => +v.toPrecision(10))].join(", ")).join("\n");

// @throws Error  saying which line is wrong and why
function planOf(text, drive) {
  const plan = [];
  text.split("\n").forEach((line, i) => {
    if (line.trim() === "") return;
    const numbers = line.split(",").map(part => part.trim() === "" ? NaN : Number(part));
    const fail = why => { throw new Error(`line ${i + 1}, "${line.trim()}": ${why}`); };
    if (numbers.length !== 1 + drive.length) fail(`${1 + drive.length} numbers are required, with commas between them`);
    if (!numbers.every(Number.isFinite)) fail("every entry must be a number");
    if (!(numbers[0] > 0 && numbers[0] <= 60000)) fail("a duration above 0 and up to 60000 min is required");
    drive.forEach((d, k) => {
      if (!(numbers[k + 1] >= 0 && numbers[k + 1] <= d.most)) fail(`${d.label} goes from 0 to ${d.most} ${d.unit}, for which the model was made`);
    });
    plan.push({duration_s: 60 * numbers[0], drive: Float64Array.from(numbers.slice(1))});
  });
  if (plan.length === 0) throw new Error("a section is required");
  return merged(plan);
}

// Pointer strokes on the chart of the drive. @param told  called with the new plan and the time from which it differs
function drawable(chart, drive, variable, planNow, told) {
  const canvas = chart.canvas;
  let bins = null, last = null;
  const paint = event => {
    const box = canvas.getBoundingClientRect(), d = drive[variable()];
    const bin = Math.min(BINS - 1, Math.max(0, Math.floor(chart.timeAt(event.clientX - box.left) / chart.end_s * BINS)));
    const share = Math.min(1, Math.max(0, chart.valueAt(event.clientY - box.top) / d.most));
    const value = Math.round(share * DRAWN_STEPS) / DRAWN_STEPS * d.most;
    const [from, to] = last === null ? [bin, bin] : [Math.min(bin, last), Math.max(bin, last)];
    for (let i = from; i <= to; ++i) bins[i].drive[variable()] = value;
    last = bin;
    told(merged(bins), from * chart.end_s / BINS);
  };
  canvas.addEventListener("pointerdown", event => {
    bins = binned(planNow());
    last = null;
    canvas.setPointerCapture(event.pointerId);
    paint(event);
  });
  canvas.addEventListener("pointermove", event => { if (bins) paint(event); });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => bins = null);
}
