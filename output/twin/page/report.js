// With #report after its address the page writes its results into itself, for comparison (docs/how-to/view.md).

const FRAMES = 100;  // of each kind that are timed
const sorted = list => Float64Array.from(list).sort();

function reportOf(page) {
  const {twin, data} = page, report = {cyclograms: {}, differences: page.off};
  for (const {name, plan} of twin.cyclograms) {
    const began = performance.now(), run = twin.rowsOf(plan), outputs = {}, left = {};
    const milliseconds = performance.now() - began;
    page.outputs.forEach((o, i) => outputs[o.name] = Array.from(run.column(i)));
    for (const i of page.drawn) if (page.outputs[i].unit === "um") left[page.outputs[i].name] = Array.from(corrected(run, i, data.correction).left);
    report.cyclograms[name] = {milliseconds, time_s: Array.from(run.time_s), outputs, left_um: left};
  }
  const acts = {playing: () => {}, ...(data.drive.length > 0 ? {dragging: dragSpeed, drawing: drawSpeed} : {})};
  report.frames = Object.fromEntries(Object.entries(acts).map(([name, act]) => [name, framesWhile(page, act, FRAMES)]));
  if (page.scene) {
    const gl = page.scene.gl, pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let covered = 0;
    for (let i = 3; i < pixels.length; i += 4) covered += pixels[i] > 0 ? 1 : 0;
    report.picture = {covered: covered / (pixels.length / 4), triangles: page.scene.triangles.n / 3, nodes: page.fields.n};
  }
  return report;
}

// Script time of frames [ms] while time runs and `act` does something in each.
function framesWhile(page, act, n) {
  page.choose(page.data.first);
  page.play(true);
  page.goTo(0.3 * page.twin.run.end_s);
  page.script_ms.length = 0;
  for (let i = 0; i < n; ++i) {
    const began = performance.now();
    act(page, i);
    const acted = performance.now() - began;
    page.frame(16.7 * i);
    page.script_ms[page.script_ms.length - 1] += acted;
  }
  page.play(false);
  const list = sorted(page.script_ms);
  return {median: list[n >> 1], p95: list[Math.floor(0.95 * n)], most: list[n - 1]};
}
const dragSpeed = (page, i) => page.setDrive(0, page.data.drive[0].most * (0.5 + 0.5 * Math.sin(0.05 * i)));
const drawSpeed = (page, i) => {
  const bins = binned(page.twin.run.plan), bin = i % BINS;
  bins[bin].drive[0] = page.data.drive[0].most * Math.round(DRAWN_STEPS * (0.5 + 0.5 * Math.cos(0.3 * i))) / DRAWN_STEPS;
  page.setPlan(merged(bins), bin * page.twin.run.end_s / BINS);
};

const page = new Page(JSON.parse(byId("data").textContent));
window.twin = page.twin;
window.page = page;
page.twin.run.finish();
page.showWorst();
for (let i = 0; i < 100 && (i < 2 || page.dirty.fields || page.dirty.picture || (page.fields && page.fields.next < page.fields.n)); ++i) page.frame(0);
if (location.hash === "#report") {
  const pre = document.body.appendChild(document.createElement("pre"));
  pre.id = "report";
  pre.textContent = JSON.stringify(reportOf(page));
} else {
  page.live();
}
