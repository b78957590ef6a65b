// The page beside a running machine: each message of the server at once, and the last hours as curves.

const UNIT = {degC: "°C", um: "µm", urad: "µrad", mm_min: "mm/min", "1": "", W_m2: "W/m²"};
const MOST_POINTS = 6000, WINDOW_s = 12 * 3600;
const PATIENCE_ms = 6000;   // the server sends something every 2 s
const AGAIN_ms = 1000;
const clock = s => `${Math.floor(s / 3600)} h ${String(Math.floor(s / 60) % 60).padStart(2, "0")} min ${String(Math.floor(s) % 60).padStart(2, "0")} s`;

class LivePage {
  constructor(data) {
    Object.assign(this, {data, last: "", run: "", points: [], range_K: [Infinity, -Infinity], heard_ms: performance.now(), dirty: {}});
    this.palette = new Uint8Array(decodeBytes(data.palette));
    byId("name").textContent = data.name;
    byId("subtitle").textContent = data.subtitle;
    byId("note").textContent = data.note;
    byId("made").textContent = data.made_by;
    this.buildBody();
    addEventListener("resize", () => Object.assign(this.dirty, {charts: true, picture: true}));
    setInterval(() => this.tellAge(), 500);
    this.connect();
    const frame = () => { requestAnimationFrame(frame); this.draw(); };
    requestAnimationFrame(frame);
  }

  buildBody() {
    const {data} = this;
    document.querySelector("main").classList.toggle("flat", !data.surface && !data.network);
    for (const element of document.querySelectorAll(".on-mesh")) element.hidden = !data.surface;
    byId("machine").hidden = !data.surface;
    paintBar(this.palette);
    if (data.network) this.network = new Network(byId("network"), data.network, this.palette);
    if (!data.surface) return;
    this.fields = new SurfaceFields(data.surface);
    this.scene = sceneOf(data.surface, this.palette);
    if (!this.scene) return;
    handle(this.scene, () => this.dirty.picture = true);
    this.marks = labelsOf(data.marks);
    const changed = () => this.dirty.picture = true;
    byId("show-marks").addEventListener("change", event => { byId("marks").hidden = !event.target.checked; changed(); });
    byId("home").addEventListener("click", () => { this.scene.look(); changed(); });
    byId("magnify").addEventListener("input", () => this.magnify(10 ** (byId("magnify").value / 20)));
    byId("magnify").value = 60;
    this.magnify(1000);
  }

  magnify(factor) {
    this.scene.magnified = factor;
    byId("magnified").textContent = `${Math.round(factor)} times`;
    this.dirty.picture = true;
  }

  // The stream of the server; when it ends, it is requested again with what came since.
  connect() {
    const query = new URLSearchParams(location.search);
    query.set("since", this.last);
    this.heard_ms = performance.now();  // the first answer may take as long; a lost connection is reported until then
    const source = this.source = new EventSource(`events?${query}`);
    source.addEventListener("row", event => {
      this.last = event.lastEventId;
      this.hear(JSON.parse(event.data));
    });
    source.addEventListener("beat", () => this.heard());
    source.addEventListener("error", () => this.again());
  }
  again() {
    this.source.close();
    if (this.waiting) return;
    this.lost = true;
    this.waiting = setTimeout(() => { this.waiting = null; this.connect(); }, AGAIN_ms);
  }
  heard() {
    this.heard_ms = performance.now();
    this.lost = false;
  }

  hear(message) {
    this.heard();
    if (message.head && this.head) return location.reload();  // another run, possibly of another machine
    if (message.head) this.begin(message);
    for (const point of message.points) this.points.push(Float64Array.from(point, x => x ?? NaN));
    const end_s = message.run_s, begin = this.points.findIndex(p => p[0] >= end_s - WINDOW_s);
    if (begin > 0) this.points.splice(0, begin);
    if (this.points.length > MOST_POINTS) this.points = this.points.filter((p, i) => i % 2 === 1);
    this.tip = Float64Array.from(message.tip, x => x ?? NaN);
    this.now = message;
    this.row_ms = performance.now();
    this.tell();
    this.tellAge();
    for (const entry of message.journal) this.note(entry);
    Object.assign(this.dirty, {charts: true, state: message.state.length > 0});
  }

  // Takes the head of a message from a server that is new to the page: the columns of its rows; all curves start again.
  begin({head}) {
    this.head = head;
    this.points = [];
    byId("journal").replaceChildren();
    byId("charts").replaceChildren();
    const lines = [];
    head.axes.forEach((axis, a) => {
      const caption = document.createElement("figcaption"), key = document.createElement("span");
      key.className = "key correction";
      const drift = document.createElement("span");
      drift.className = "key told";
      caption.append(axis, " ", drift, " drift predicted ", key, " correction in force");
      lines.push({chart: this.figure(caption, `drift and correction of ${axis} over time`, `${axis} [µm]`),
                  curves: [{column: 1 + 3 * a, colour: "--told", width: 6}, {column: 2 + 3 * a, colour: "--left"}]});
    });
    const coloured = (title, unit, columns, names, range = null) => {
      if (columns.length === 0) return;
      const caption = document.createElement("figcaption");
      caption.append(title);
      const curves = columns.map((column, k) => ({column, colour: CURVES[k % CURVES.length]}));
      curves.forEach(({colour}, k) => {
        const key = document.createElement("span");
        key.className = "key";
        key.style.borderColor = colour;
        caption.append(" ", key, ` ${names[k]}`);
      });
      lines.push({chart: this.figure(caption, `${title} over time`, unit), curves, range});
    };
    const first = 1 + 3 * head.axes.length, of = unit => head.channels.map((c, k) => k).filter(k => head.channels[k].unit === unit);
    coloured("Trust", "trust", head.axes.map((_, a) => 3 + 3 * a), head.axes, [-0.05, 1.05]);
    for (const [title, unit] of [["Thermometers", "degC"], ["Spindle speed", "rpm"]])
      coloured(title, UNIT[unit] ?? unit, of(unit).map(k => first + k), of(unit).map(k => head.channels[k].name));
    this.lines = lines;
  }

  figure(caption, label, unit) {
    const figure = document.createElement("figure"), chart = document.createElement("div"), canvas = document.createElement("canvas");
    chart.className = "chart";
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", label);
    chart.append(canvas);
    figure.append(caption, chart);
    byId("charts").append(figure);
    return new Chart(canvas, unit);
  }

  // Shows the numbers of the line unchanged.
  tell() {
    const {line, values} = this.now, fixed = (x, digits) => x === null || x === undefined ? "–" : x.toFixed(digits);
    const fill = (table, rows) => {
      const body = byId(table).tBodies[0];
      while (body.rows.length > rows.length) body.deleteRow(-1);
      rows.forEach((cells, i) => {
        const row = body.rows[i] ?? body.insertRow();
        while (row.cells.length < cells.length) row.insertCell();
        cells.forEach((text, k) => {
          const cell = row.cells[k];
          if (cell.textContent !== text) cell.textContent = text;
          cell.className = table === "alerts" ? (cells[0] === "Alarm" ? "alarm" : "") : k > 0 && !(table === "values" && k === 2) ? "number" : "";
        });
      });
    };
    fill("axes", Object.entries(line.axes).map(([name, a]) => [name, fixed(a.correction_um, 3), fixed(a.predicted_um, 3), fixed(a.interval_95_um, 2), fixed(a.trust, 3)]));
    const alerts = [];
    for (const [name, a] of Object.entries(line.axes)) {
      if (a.alarm) alerts.push(["Alarm", `${name}: ${a.alarm}`]);
      for (const doubt of a.doubted) alerts.push(["In doubt", `${name}: ${doubt}`]);
    }
    for (const fault of line.faults ?? []) alerts.push(["Row", fault]);
    fill("alerts", alerts.length > 0 ? alerts : [["None", ""]]);
    fill("values", [["time", fixed(line.time_s, 1), "s"], ...this.head.channels.map((c, k) => [c.name, fixed(values[k], 3), UNIT[c.unit] ?? c.unit])]);
    byId("why").textContent = line.why ?? "";
  }

  tellAge() {
    const silent_ms = performance.now() - this.heard_ms, isLost = this.lost || silent_ms > PATIENCE_ms;
    if (silent_ms > PATIENCE_ms) this.again();
    byId("status").className = isLost ? "lost" : this.now ? this.now.line.state : "";
    byId("state").textContent = isLost ? "no connection" : this.now ? this.now.line.state : "waiting for the first row";
    if (this.now)
      byId("age").textContent = `${isLost ? "last known: " : ""}${clock(this.now.run_s)} of the run, ${((performance.now() - this.row_ms) / 1000).toFixed(0)} s ago`;
  }

  note({run_s, words}) {
    const item = document.createElement("li"), at = document.createElement("b");
    at.textContent = clock(run_s);
    item.append(at, " ", words);
    byId("journal").prepend(item);
    while (byId("journal").children.length > 200) byId("journal").lastChild.remove();
  }

  draw() {
    const {dirty, now} = this;
    if (!now) return;
    if (dirty.state) {
      dirty.state = false;
      const state = doubles(now.state);
      if (this.network) this.drawNetwork(state);
      else if (this.scene) {
        this.fields.whole(state);
        this.scene.takeFields(this.fields);
        this.range_K = reached(this.range_K, this.fields.temperature_K, this.data.reference_degC);
        dirty.picture = true;
      }
    }
    if (dirty.picture && this.scene) {
      dirty.picture = false;
      this.scene.range = this.range_K;
      this.scene.draw();
      if (!byId("marks").hidden && this.fields.state) placeMarks(this.marks, this.scene, this.fields);
    }
    if (dirty.charts) {
      dirty.charts = false;
      this.drawCharts();
    }
  }

  drawNetwork(state) {
    const nodes = product(this.network.n, state.length, this.network.temperature, state, new Float64Array(this.network.n));
    this.range_K = reached(this.range_K, [...nodes, this.now.ambient_K], this.data.reference_degC);
    this.network.show(state, this.now.ambient_K, this.data.reference_degC, this.range_K);
  }

  drawCharts() {
    const points = [...this.points, this.tip], time_s = points.map(p => p[0]), begin_s = time_s[0], end_s = Math.max(time_s[time_s.length - 1], begin_s + 1);
    const along = end_s - begin_s > 3 * 3600 ? {unit: "h", unit_s: 3600} : {unit: "min", unit_s: 60};
    for (const {chart, curves, range} of this.lines) {
      chart.along = along;
      chart.draw(curves.map(({column, colour, width}) => ({time_s, width, values: points.map(p => p[column]), colour: colour.startsWith("--") ? styleOf(colour) : colour})),
                 end_s, range ?? null, null, begin_s);
    }
  }
}

window.live = new LivePage(JSON.parse(byId("data").textContent));
