// A machine on which a click gives the text to paste into a scenario: a surface, a thermometer, a displacement.

// Of each part of the surface; colours that the colour-blind tell apart (Okabe & Ito).
const KINDS = [
  {name: "no name yet", colour: [195, 204, 212]}, {name: "name, neither heat nor film", colour: [230, 159, 0]},
  {name: "name, with heat or film", colour: [0, 158, 115]}, {name: "touches another part", colour: [155, 139, 180]},
  {name: "under the mouse", colour: [150, 205, 240]}, {name: "picked", colour: [0, 114, 178]}];
const FREE = 0, BARE = 1, SERVED = 2, TOUCHING = 3, HOVERED = 4, PICKED = 5;
const CLICK_PX = 4;   // a mouse that moves further drags
const CORNER_PX = 8;  // a click so near to a corner means the corner

// Texts of a scenario.
const inMm = x => (Math.abs(x) < 5e-6 ? 0 : 1000 * x).toFixed(2);
const pointText = at_m => `[${at_m.map(x => `${inMm(x)} mm`).join(", ")}]`;
const placeText = ({region, at_m}) => `region: ${region}, at: ${pointText(at_m)}`;
const surfaceText = (name, pick) => `- {name: ${name}, ${pick}}`;
const sensorText = (name, point) => `- {name: ${name}, ${placeText(point)}}`;
const driftText = (name, axis, tool, table) =>
    `- {name: ${name}, along: ${axis}, tool: {${placeText(tool)}}${table ? `, table: {${placeText(table)}}` : ""}}`;
// A name as the scenario takes it.
const plainName = text => text.trim().replace(/[^A-Za-z0-9_-]/g, "_") || "_";

// The nearest point of the surface under a place of the canvas.
// @param x, y  CSS pixels from its upper left corner
// @returns {triangle, at_m}, or null beside the machine
function hitAt(scene, coords, triangles, x, y) {
  const m = scene.matrix(), {canvas} = scene, n = coords.length / 3, seen = new Float64Array(3 * n);
  const px = 2 * x / canvas.clientWidth - 1, py = 1 - 2 * y / canvas.clientHeight;
  for (let i = 0; i < n; ++i) {
    const a = coords[3 * i], b = coords[3 * i + 1], c = coords[3 * i + 2];
    for (let k = 0; k < 3; ++k) seen[3 * i + k] = m[k] * a + m[4 + k] * b + m[8 + k] * c + m[12 + k];
  }
  let nearest = Infinity, hit = null;
  for (let t = 0; t < triangles.length; t += 3) {
    const [i, j, k] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const ax = seen[i] - px, ay = seen[i + 1] - py, bx = seen[j] - px, by = seen[j + 1] - py, cx = seen[k] - px, cy = seen[k + 1] - py;
    const u = bx * cy - cx * by, v = cx * ay - ax * cy, w = ax * by - bx * ay, sum = u + v + w;
    if (sum === 0 || u * sum < 0 || v * sum < 0 || w * sum < 0) continue;
    const depth = (u * seen[i + 2] + v * seen[j + 2] + w * seen[k + 2]) / sum;
    if (depth >= nearest) continue;
    nearest = depth;
    hit = {triangle: t / 3, at_m: [0, 1, 2].map(d => (u * coords[i + d] + v * coords[j + d] + w * coords[k + d]) / sum)};
  }
  return hit;
}

class PickPage {
  constructor(data) {
    this.data = data;
    this.taken = new Set(data.taken);
    this.coords = new Float32Array(decodeBytes(data.surface.coords));
    this.triangles = new Uint32Array(decodeBytes(data.surface.triangles));
    this.patchOf = new Int32Array(decodeBytes(data.vertex_patch));
    this.fields = {temperature_K: new Float32Array(data.surface.n_nodes), displaced_m: new Float32Array(3 * data.surface.n_nodes)};
    this.picked = null;    // {face, patch, region, at_m, normal}
    this.table = null;     // {region, at_m}
    this.shown = new Set();  // patches in the colour of what is picked
    this.hovered = -1;     // face under the mouse
    this.findCorners();
    this.buildTexts();
    this.buildSurfaces();
    this.scene = sceneOf(data.surface, Uint8Array.from(KINDS.flatMap(k => k.colour)));
    if (this.scene) this.buildScene();
  }

  // Points where three parts of the surface or more meet.
  findCorners() {
    const parts = new Map(), key = i => this.coords.subarray(3 * i, 3 * i + 3).join();
    for (let i = 0; i < this.patchOf.length; ++i) {
      if (!parts.has(key(i))) parts.set(key(i), new Set());
      parts.get(key(i)).add(this.patchOf[i]);
    }
    this.corners = [];
    for (let i = 0; i < this.patchOf.length; ++i) if (parts.get(key(i)).size > 2) this.corners.push(i);
  }

  buildScene() {
    const {scene} = this, {canvas} = scene;
    scene.range = [-0.5, KINDS.length - 0.5];
    handle(scene, () => this.redraw());
    this.marks = labelsOf(this.data.marks);
    byId("show-marks").addEventListener("change", event => byId("marks").hidden = !event.target.checked);
    byId("home").addEventListener("click", () => {
      scene.look();
      this.redraw();
    });
    addEventListener("resize", () => this.redraw());
    const placeOf = event => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    let from = null;
    canvas.addEventListener("pointerdown", event => from = placeOf(event));
    canvas.addEventListener("pointerup", event => {
      const [x, y] = placeOf(event);
      if (from && Math.hypot(x - from[0], y - from[1]) < CLICK_PX) this.pickAt(x, y);
      from = null;
    });
    canvas.addEventListener("pointermove", event => {
      if (event.buttons === 0) this.hoverAt(...placeOf(event));
    });
    canvas.addEventListener("pointerleave", () => this.hover(-1));
    this.paintParts();
  }

  patchOfHit(hit) { return this.data.patches[this.patchOf[this.triangles[3 * hit.triangle]]]; }

  hoverAt(x, y) {
    const hit = hitAt(this.scene, this.coords, this.triangles, x, y);
    this.hover(hit ? this.patchOfHit(hit).face : -1);
  }
  hover(face) {
    if (face === this.hovered) return;
    this.hovered = face;
    if (face >= 0) byId("under").textContent = this.faceWords(face);
    this.paintParts();
  }

  pickAt(x, y) {
    const hit = hitAt(this.scene, this.coords, this.triangles, x, y);
    if (!hit) return;
    const patch = this.patchOfHit(hit), corner = this.cornerNear(this.data.patches.indexOf(patch), x, y);
    const face = this.data.faces[patch.face];
    this.picked = {...patch, region: this.data.regions[face.region].yaml, at_m: corner ?? hit.at_m};
    byId("drift-axis").value = "xyz"[this.mainAxis(hit.triangle)];
    this.show(this.data.patches.map((p, i) => i).filter(i => this.data.patches[i].face === patch.face));
    this.nameAnew();
    this.tell();
  }

  cornerNear(patch, x, y) {
    let best = CORNER_PX, at_m = null;
    for (const i of this.corners) {
      if (this.patchOf[i] !== patch) continue;
      const point = Array.from(this.coords.subarray(3 * i, 3 * i + 3)), [cx, cy] = this.scene.project(point), far = Math.hypot(cx - x, cy - y);
      if (far < best) [best, at_m] = [far, point];
    }
    return at_m;
  }

  // The axis that the normal of a triangle follows most.
  mainAxis(triangle) {
    const [a, b, c] = [0, 1, 2].map(k => Array.from(this.coords.subarray(3 * this.triangles[3 * triangle + k], 3 * this.triangles[3 * triangle + k] + 3)));
    const u = b.map((v, k) => v - a[k]), v = c.map((w, k) => w - a[k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]].map(Math.abs);
    return n.indexOf(Math.max(...n));
  }

  faceWords(face) {
    const f = this.data.faces[face];
    return `Face ${face + 1} of ${this.data.regions[f.region].name}: ${f.words}, ${f.area_m2.toPrecision(4)} m²`;
  }

  // A name that is not taken.
  free(name) {
    for (let i = 2, tried = name; ; ++i) {
      if (!this.taken.has(tried)) return tried;
      tried = `${name}_${i}`;
    }
  }
  nameAnew() {
    let t = 1;
    while (this.taken.has(`t_${t}`)) ++t;
    byId("surface-name").value = this.free(`face_${this.picked.face + 1}`);
    byId("sensor-name").value = `t_${t}`;
    byId("drift-name").value = this.free(`drift_${byId("drift-axis").value}`);
  }

  tell() {
    const {data, picked} = this;
    if (!picked) return;
    const face = data.faces[picked.face], rows = byId("facts").tBodies[0], names = picked.surfaces.map(s => data.surfaces[s]);
    byId("face").textContent = `Face ${picked.face + 1} of ${data.regions[face.region].name}`;
    byId("texts").hidden = false;
    rows.textContent = "";
    const row = (name, value) => {
      const r = rows.insertRow();
      r.insertCell().textContent = name;
      r.insertCell().textContent = value;
    };
    row("shape", face.words);
    row("area", `${face.area_m2.toPrecision(4)} m²`);
    row("point", pointText(picked.at_m));
    for (const s of names) row("name", `${s.name} (${s.carries.length ? s.carries.join(", ") : "neither heat nor film"})`);
    if (picked.touches) row("here", "touches another part");
    byId("surface-text").value = face.pick && data.may_name ? surfaceText(this.nameIn("surface-name"), face.pick) : "";
    for (const element of [byId("surface-text"), byId("surface-name").closest("p")]) element.hidden = !byId("surface-text").value;
    byId("surface-help").textContent = !data.may_name ? data.no_names : face.pick ? "Goes below machine: surfaces." + (names.length ? " The face has a name already; it may have several." : "") :
        `A scenario cannot name this face alone: it is neither a plane nor a cylinder. {name: NAME, region: ${picked.region}, remaining: true} at the end of the list names it with all faces of the region that have no name.`;
    byId("sensor-text").value = sensorText(this.nameIn("sensor-name"), picked);
    byId("drift-text").value = driftText(this.nameIn("drift-name"), byId("drift-axis").value, picked, this.table);
    byId("table-at").textContent = this.table ? `table: {${placeText(this.table)}}` : "Without a table the displacement is against the ground.";
    byId("table-none").hidden = !this.table;
  }

  nameIn(id) {
    const name = plainName(byId(id).value);
    byId(id).classList.toggle("taken", this.taken.has(name));
    byId(id).title = this.taken.has(name) ? "this name is taken" : "";
    return name;
  }

  buildTexts() {
    const {data} = this;
    byId("name").textContent = data.name;
    byId("subtitle").textContent = data.subtitle;
    for (const note of data.notes) byId("notes").appendChild(document.createElement("li")).textContent = note;
    byId("made").textContent = data.made_by;
    byId("beginning").hidden = !data.beginning;
    byId("beginning-text").value = data.beginning;
    for (const kind of KINDS) {
      const label = byId("legend").appendChild(document.createElement("span"));
      label.appendChild(document.createElement("i")).style.background = `rgb(${kind.colour.join()})`;
      label.append(kind.name);
    }
    for (const id of ["surface-name", "sensor-name", "drift-name"]) byId(id).addEventListener("input", () => this.tell());
    byId("drift-axis").addEventListener("change", () => {
      byId("drift-name").value = this.free(`drift_${byId("drift-axis").value}`);
      this.tell();
    });
    byId("table-here").addEventListener("click", () => {
      this.table = {region: this.picked.region, at_m: this.picked.at_m};
      this.tell();
    });
    byId("table-none").addEventListener("click", () => {
      this.table = null;
      this.tell();
    });
    for (const button of document.querySelectorAll("[data-copies]")) button.addEventListener("click", () => this.copy(button));
  }

  // Copies a text; its name is then taken.
  async copy(button) {
    const area = byId(button.dataset.copies), name = byId(area.id.replace("-text", "-name"));
    if (!area.value) return;
    area.select();
    try {
      await navigator.clipboard.writeText(area.value);
    } catch {
      document.execCommand("copy");  // where the browser keeps the clipboard from pages on disk
    }
    if (name) this.taken.add(plainName(name.value));
    button.textContent = "Copied";
    setTimeout(() => button.textContent = "Copy", 1500);
  }

  // Surfaces, then what has no name, each with what heats or cools it.
  buildSurfaces() {
    const {data} = this, body = byId("surfaces").querySelector("tbody"), patches = data.patches.map((p, i) => i);
    const row = (kind, name, area_m2, carries, parts) => {
      const r = body.insertRow(), button = r.insertCell().appendChild(document.createElement("button")), area = r.insertCell();
      button.type = "button";
      button.appendChild(document.createElement("i")).style.background = `rgb(${KINDS[kind].colour.join()})`;
      button.append(name);
      area.className = "number";
      area.textContent = area_m2.toFixed(4);
      r.insertCell().textContent = carries;
      r.addEventListener("click", () => this.show(parts));
    };
    this.bare = [];
    data.surfaces.forEach((s, k) => {
      if (s.carries.length === 0) this.bare.push(s.name);
      row(s.carries.length ? SERVED : BARE, s.name, s.area_m2, s.carries.join(", ") || "none", patches.filter(i => data.patches[i].surfaces.includes(k)));
    });
    data.regions.forEach((region, k) => {
      if (!(region.unnamed_m2 > 0)) return;
      this.bare.push(`${region.name}, no name yet`);
      row(FREE, `${region.name}, no name yet`, region.unnamed_m2, "none", patches.filter(i => this.kindOf(i) === FREE && data.faces[data.patches[i].face].region === k));
    });
    byId("bare").textContent = this.bare.length === 0 ? "Every outer face has heat or a film, or touches another part." : `Without heat and film: ${this.bare.join("; ")}.`;
  }

  kindOf(patch) {
    const {surfaces, touches} = this.data.patches[patch];
    if (surfaces.some(s => this.data.surfaces[s].carries.length > 0)) return SERVED;
    return touches ? TOUCHING : surfaces.length > 0 ? BARE : FREE;
  }

  show(patches) {
    this.shown = new Set(patches);
    this.paintParts();
  }

  paintParts() {
    const {data} = this, kinds = data.patches.map((p, i) => this.shown.has(i) ? PICKED : p.face === this.hovered ? HOVERED : this.kindOf(i));
    for (let i = 0; i < this.patchOf.length; ++i) this.fields.temperature_K[i] = kinds[this.patchOf[i]];
    if (!this.scene) return;
    this.scene.takeFields(this.fields);
    this.redraw();
  }

  redraw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.scene.draw();
      if (!byId("marks").hidden) placeMarks(this.marks, this.scene, this.fields);
    });
  }
}

window.pick = new PickPage(JSON.parse(byId("data").textContent));
