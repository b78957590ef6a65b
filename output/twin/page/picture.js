// The picture of the machine in a page: its scene, colour bar, and the names at its points.

const byId = id => document.getElementById(id);

function paintBar(palette) {
  const pen = byId("bar-colours").getContext("2d"), pixels = pen.createImageData(256, 1);
  for (let i = 0; i < 256; ++i) {
    const k = 3 * Math.round(i / 255 * (palette.length / 3 - 1));
    pixels.data.set([...palette.slice(k, k + 3), 255], 4 * i);
  }
  pen.putImageData(pixels, 0, 0);
}

// The range of colours, from the lowest to the highest value seen so far and now; it is written at the ends of the bar.
// @param range_K  [low, high] so far, over the reference
function reached([low, high], values_K, reference_degC) {
  for (const v of values_K) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  high = Math.max(high, low + 0.5);
  byId("bar-low").textContent = `${(low + reference_degC).toFixed(1)} °C`;
  byId("bar-high").textContent = `${(high + reference_degC).toFixed(1)} °C`;
  return [low, high];
}

// @returns null if it cannot be drawn; curves and numbers work without the picture
function sceneOf(surface, palette) {
  try {
    return new Scene(byId("machine"), {
      coords: new Float32Array(decodeBytes(surface.coords)), triangles: new Uint32Array(decodeBytes(surface.triangles)),
      edges: new Uint32Array(decodeBytes(surface.edges))}, palette);
  } catch (error) {
    byId("marks").textContent = `The machine is not drawn: ${error.message}.`;
    return null;
  }
}

function labelsOf(marks) {
  return marks.map(mark => {
    const label = document.createElement("span"), dot = document.createElement("b");
    label.textContent = mark.name;
    if (mark.is_indicator) dot.className = "indicator";
    byId("marks").append(dot, label);
    return {...mark, label, dot};
  });
}

// Places each mark at its point, with its name beside it, moved down where names would overlap.
function placeMarks(marks, scene, fields) {
  const [width, height] = [64, 17];
  const placed = marks.map(mark => {
    const moved = mark.at_m.map((x, k) => x + scene.magnified * fields.displaced_m[3 * mark.node + k]);
    return {mark, at: scene.project(moved)};
  }).sort((a, b) => a.at[1] - b.at[1]);
  const names = [];
  for (const {mark, at: [x, y]} of placed) {
    const name = [x + 7, y - 8];
    for (const [nx, ny] of names) if (Math.abs(nx - name[0]) < width && Math.abs(ny - name[1]) < height) name[1] = ny + height;
    names.push(name);
    mark.dot.style.transform = `translate(${x}px, ${y}px)`;
    mark.label.style.transform = `translate(${name[0]}px, ${name[1]}px)`;
  }
}
