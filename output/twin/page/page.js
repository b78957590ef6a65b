// The page: its controls, and the frame loop that keeps it up to date.

const FRAME = {run_ms: 1.5, fields_ms: 1.5};  // time for script in each frame
const isLength = o => o.unit !== "degC";
const UNIT = {degC: "°C", um: "µm", urad: "µrad"};

class Page {
  constructor(data) {
    this.data = data;
    this.twin = new Twin(data);
    this.palette = Uint8Array.from(new Uint8Array(decodeBytes(data.palette)));
    this.outputs = this.twin.machine.outputs_told;
    this.drawn = this.outputs.map((o, i) => i).filter(i => isLength(this.outputs[i]));
    this.thermometers = this.outputs.map((o, i) => i).filter(i => !isLength(this.outputs[i]));
    this.playing = false;
    this.variable = 0;
    this.range_K = [Infinity, -Infinity];
    this.script_ms = [];
    this.dirty = {charts: true, fields: true, picture: true, texts: true};
    this.buildBody();
    this.buildDesk();
    this.buildCharts();
    this.buildFooter();
    this.taken();
  }

  buildBody() {
    const {data} = this;
    paintBar(this.palette);
    for (const element of document.querySelectorAll(".on-mesh")) element.hidden = !data.surface;
    byId("machine").hidden = !data.surface;
    if (data.surface) this.buildScene();
    else this.network = new Network(byId("network"), data.network, this.palette);
  }

  buildScene() {
    const {surface, marks} = this.data;
    this.fields = new SurfaceFields(surface);
    this.scene = sceneOf(surface, this.palette);
    if (!this.scene) return;
    handle(this.scene, () => this.dirty.picture = true);
    this.marks = labelsOf(marks);
    byId("show-marks").addEventListener("change", event => byId("marks").hidden = !event.target.checked);
    byId("home").addEventListener("click", () => {
      this.scene.look();
      this.dirty.picture = true;
    });
    byId("magnify").addEventListener("input", () => this.magnify(10 ** (byId("magnify").value / 20)));
  }

  magnify(factor) {
    this.scene.magnified = factor;
    byId("magnified").textContent = `${Math.round(factor)} times`;
    byId("magnify").value = 20 * Math.log10(Math.max(1, factor));
    this.dirty.picture = true;
  }

  buildDesk() {
    const {data, twin} = this, select = byId("cyclogram");
    for (const name of [...twin.cyclograms.map(c => c.name), ""]) select.add(new Option(name || "by hand", name));
    select.value = data.first;
    select.addEventListener("change", () => { if (select.value) this.choose(select.value); });
    this.sliders = data.drive.map((d, k) => {
      const label = document.createElement("label"), output = document.createElement("output"), input = document.createElement("input");
      Object.assign(input, {type: "range", min: 0, max: d.most, step: d.most / 100});
      label.append(`${d.label} from now on`, output, input);
      byId("sliders").appendChild(label);
      input.addEventListener("input", () => this.setDrive(k, Number(input.value)));
      return {input, output};
    });
    byId("play").addEventListener("click", () => this.play(!this.playing));
    byId("time").addEventListener("input", () => this.goTo(Number(byId("time").value)));
    const body = byId("values").tBodies[0];
    this.rows = this.outputs.map((o, i) => {
      const row = body.insertRow(), name = row.insertCell(), value = row.insertCell(), unit = row.insertCell();
      if (!isLength(o)) name.appendChild(document.createElement("i")).style.background = this.colourOf(i);
      name.append(o.name);
      value.className = "number";
      unit.textContent = UNIT[o.unit];
      return value;
    });
  }

  colourOf(output) { return CURVES[this.thermometers.indexOf(output) % CURVES.length]; }

  buildCharts() {
    const {data} = this, channel = byId("channel");
    this.charts = {plan: new Chart(byId("plan"), ""), drift: new Chart(byId("drift"), "µm"), warm: new Chart(byId("warm"), "°C")};
    for (const i of this.drawn) channel.add(new Option(this.outputs[i].name, i));
    if (data.target >= 0) channel.value = data.target;
    channel.addEventListener("change", () => this.dirty.charts = true);
    byId("left-words").textContent = `as the correction leaves it (${data.correction.name})`;
    for (const element of document.querySelectorAll(".driven")) element.hidden = data.drive.length === 0;  // no drives
    byId("charts").classList.toggle("still", data.drive.length === 0);
    if (data.drive.length > 1) {
      const variable = document.createElement("select");
      variable.setAttribute("aria-label", "variable of the drive that is drawn");
      data.drive.forEach((d, k) => variable.add(new Option(d.label, k)));
      variable.addEventListener("change", () => {
        this.variable = Number(variable.value);
        this.dirty.charts = true;
      });
      byId("plan-caption").append(" ", variable);
    }
    drawable(this.charts.plan, data.drive, () => this.variable, () => this.twin.run.plan, (plan, from_s) => this.setPlan(plan, from_s));
    byId("text-help").textContent = `A section a line: duration in min, ${data.drive.map(d => `${d.label} in ${d.unit} (0 to ${d.most})`).join(", ")}.`;
    byId("text").addEventListener("input", () => {
      try {
        this.setPlan(planOf(byId("text").value, data.drive), 0, true);
        byId("text-fault").textContent = "";
      } catch (error) {
        byId("text-fault").textContent = error.message;
      }
    });
    addEventListener("resize", () => Object.assign(this.dirty, {charts: true, picture: true}));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.dirty.charts = true);
  }

  buildFooter() {
    const {data} = this;
    byId("name").textContent = data.name;
    byId("subtitle").textContent = data.subtitle;
    byId("correction").textContent = data.correction.words;
    for (const note of data.notes) byId("notes").appendChild(document.createElement("li")).textContent = note;
    byId("made").textContent = data.made_by;
    const off = this.twin.check();
    byId("check").textContent = `Run in this page, the cyclogram '${data.check.cyclogram}' is nowhere further than ` +
        `${off.K.toPrecision(2)} K and ${off.um.toPrecision(2)} µm (tilts: µrad) from what ${data.check.by} says of it; this was computed when the page was opened.`;
    this.off = off;
  }

  // Actions of the user.
  choose(name) {
    byId("cyclogram").value = name;
    this.twin.time_s = 0;
    this.twin.take(this.twin.cyclogram(name));
    this.taken();
  }
  setPlan(plan, from_s, isText = false) {
    byId("cyclogram").value = "";
    this.twin.take(plan, from_s);
    this.taken(isText);
  }
  setDrive(variable, value) {
    byId("cyclogram").value = "";
    this.twin.setDrive(variable, value);
    this.taken();
  }
  goTo(time_s) {
    this.twin.time_s = Math.min(this.twin.run.end_s, Math.max(0, time_s));
    Object.assign(this.dirty, {fields: true, texts: true});
  }
  play(playing) {
    this.playing = playing;
    if (playing && this.twin.time_s >= this.twin.run.end_s) this.goTo(0);
    byId("play").textContent = playing ? "Pause" : "Play";
  }
  taken(isText = false) {
    byId("time").max = this.twin.run.end_s;
    this.dirty.plan = this.dirty.plan || !isText;
    Object.assign(this.dirty, {charts: true, fields: true, texts: true});
  }

  // The script of a frame: model, fields, numbers. draw() follows it.
  update(now_ms) {
    const {twin, dirty} = this, passed_s = Math.min(0.1, (now_ms - (this.last_ms ?? now_ms)) / 1000);
    this.last_ms = now_ms;
    if (twin.work(FRAME.run_ms)) Object.assign(dirty, {charts: true, texts: true});
    if (this.playing && twin.isKnown()) {
      this.goTo(twin.time_s + 60 * Number(byId("pace").value) * passed_s);
      if (twin.time_s >= twin.run.end_s) this.play(false);
    }
    if (this.fields && twin.isKnown()) {
      if (dirty.fields && (!this.fields.state || this.fields.next === this.fields.n)) {
        this.fields.begin(twin.stateNow());
        dirty.fields = false;
      }
      if (this.fields.next < this.fields.n && this.fields.work(FRAME.fields_ms)) dirty.picture = this.hasNewFields = true;
    } else if (this.network && dirty.fields && twin.isKnown()) {
      dirty.fields = false;
      dirty.picture = true;
    }
    if (byId("turn").checked && this.scene) {
      this.scene.turnBy(0.4 * passed_s, 0);
      dirty.picture = true;
    }
    if (dirty.texts && twin.isKnown()) this.tell();
  }

  tell() {
    const {twin} = this;
    twin.outputs();
    this.rows.forEach((cell, i) => cell.textContent = twin.told[i].toFixed(2));
    byId("clock").textContent = `${Math.floor(twin.time_s / 3600)} h ${String(Math.floor(twin.time_s / 60) % 60).padStart(2, "0")} min`;
    byId("time").value = twin.time_s;
    const drive = driveAt(twin.run.plan, twin.time_s);
    this.sliders.forEach(({input, output}, k) => {
      output.textContent = `${Math.round(drive[k])} ${this.data.drive[k].unit}`;
      if (document.activeElement !== input || this.playing) input.value = drive[k];
    });
    this.dirty.texts = false;
  }

  draw() {
    const {twin, dirty} = this;
    if (dirty.charts && (twin.run.isDone || !(performance.now() - this.charted_ms < 120))) this.drawCharts();
    for (const chart of Object.values(this.charts)) chart.markAt(twin.time_s);
    if (!dirty.picture) return;
    dirty.picture = false;
    if (this.network) {
      const state = twin.stateNow();
      this.reach(Array.from(this.thermometers, i => twin.told[i] - this.data.reference_degC));
      this.network.show(state, twin.ambientNow_K(), this.data.reference_degC, this.range_K);
    } else if (this.scene) {
      this.drawScene();
    }
  }

  drawScene() {
    const {scene, fields} = this;
    if (this.hasNewFields) {
      scene.takeFields(fields);
      this.reach(fields.temperature_K);
      this.hasNewFields = false;
    }
    scene.range = this.range_K;
    scene.draw();
    if (!byId("marks").hidden) placeMarks(this.marks, scene, fields);
  }

  // Extends the range of colours to what the run has shown so far.
  reach(values_K) { this.range_K = reached(this.range_K, values_K, this.data.reference_degC); }

  drawCharts() {
    const {twin, charts, data} = this, {run} = twin, time_s = run.time_s.subarray(0, run.n_done);
    if (data.drive.length > 0) this.drawPlan();
    if (this.drawn.length > 0) {
      const output = Number(byId("channel").value), {drift, left} = corrected(run, output, data.correction);
      const unit = UNIT[this.outputs[output].unit], isDrift = unit === "µm";
      charts.drift.unit = `${this.outputs[output].name} [${unit}]`;
      const strip = twin.strip(output);
      charts.drift.draw([{time_s, values: drift, colour: styleOf("--drift"), strip}, ...(isDrift ? [{time_s, values: left, colour: styleOf("--left")}] : [])],
                        run.end_s, null, isDrift && data.tolerance_um > 0 ? data.tolerance_um : null);
      const most = list => list.reduce((m, v) => Math.max(m, Math.abs(v)), 0).toFixed(1);
      byId("worst").textContent = `At most ${most(drift)} ${unit}` + (isDrift ? `, ${most(left)} µm with the correction` : "") +
          (isDrift && data.tolerance_um > 0 ? `; tolerance ${data.tolerance_um} µm.` : ".") + (strip ? " " + data.check.band.words : "");
    }
    if (this.dirty.plan && run.isDone) {
      byId("text").value = planText(run.plan);
      this.dirty.plan = false;
    }
    charts.warm.draw(this.thermometers.map(i => ({time_s, values: run.column(i), colour: this.colourOf(i), strip: twin.strip(i)})), run.end_s);
    this.charted_ms = performance.now();
    if (run.isDone) this.dirty.charts = false;
  }

  drawPlan() {
    const {run} = this.twin, d = this.data.drive[this.variable], chart = this.charts.plan, starts = [], values = [];
    let start = 0;
    for (const section of run.plan) {
      starts.push(start);
      values.push(section.drive[this.variable]);
      start += section.duration_s;
    }
    chart.unit = `${d.label} [${d.unit}]`;
    chart.draw([{time_s: [...starts, start], values: [...values, values[values.length - 1]], colour: styleOf("--text"), isStepped: true}],
               run.end_s, [0, 1.04 * d.most]);
  }

  // Goes to the moment of the largest drift, with a magnification that makes the displacement visible.
  showWorst() {
    const {twin, fields, scene} = this;
    const shown = this.drawn.length > 0 ? Number(byId("channel").value) : 0, at = twin.run.column(shown);
    let worst = at.length - 1;
    at.forEach((v, row) => { if (Math.abs(v) > Math.abs(at[worst])) worst = row; });
    this.goTo(twin.run.time_s[worst]);
    if (!scene) return;
    fields.whole(twin.run.stateAt(twin.run.time_s[worst], new Float64Array(twin.machine.n)));
    let most_m = 0;
    for (let i = 0; i < fields.n; ++i) most_m = Math.max(most_m, Math.hypot(...fields.displaced_m.subarray(3 * i, 3 * i + 3)));
    this.reach(fields.temperature_K);
    const exact = most_m > 0 ? Math.min(1e5, 0.1 * scene.radius / most_m) : 1, decade = 10 ** Math.floor(Math.log10(exact));
    this.magnify(decade * [5, 2, 1].find(s => s * decade <= exact));
  }

  frame(now_ms) {
    const begin = performance.now();
    this.update(now_ms);
    this.script_ms.push(performance.now() - begin);
    if (this.script_ms.length > 1000) this.script_ms.shift();
    this.draw();
  }

  live() {
    requestAnimationFrame(now_ms => {
      this.frame(now_ms);
      this.live();
    });
  }
}
