// A machine of lumped nodes: circles coloured by temperature, joined where heat is exchanged.

const SVG = "http://www.w3.org/2000/svg";
const svgElement = (parent, name, attributes, text = "") => {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  parent.appendChild(element);
  return element;
};

class Network {
  // @param network  {names, links: [[i, j]], temperature}: `temperature` maps a state to the nodes, the last name is the ambient
  constructor(svg, network, palette) {
    Object.assign(this, {network, palette, n: network.names.length - 1});
    this.temperature = doubles(network.temperature);
    svg.removeAttribute("hidden");
    svg.setAttribute("viewBox", "0 0 700 420");
    const place = i => i === this.n ? [300, 385] : [300 + 230 * Math.sin(this.angle(i)), 180 - 140 * Math.cos(this.angle(i))];
    for (const [a, b] of network.links) {
      const [x1, y1] = place(a), [x2, y2] = place(b);
      svgElement(svg, "line", {x1, y1, x2, y2, stroke: "currentColor", "stroke-width": 1.5, opacity: 0.5});
    }
    this.circles = network.names.map((name, i) => {
      const [cx, cy] = place(i), circle = svgElement(svg, "circle", {cx, cy, r: 20, stroke: "currentColor"});
      svgElement(svg, "text", {x: cx + 26, y: cy - 4, fill: "currentColor"}, name);
      this.texts = [...(this.texts ?? []), svgElement(svg, "text", {x: cx + 26, y: cy + 13, fill: "currentColor"})];
      return circle;
    });
  }

  angle(i) { return 2 * Math.PI * (i + 0.5) / this.n; }

  // @param range  of the colours, over the reference [K]
  show(state, ambient_K, reference_degC, range) {
    const values = product(this.n, state.length, this.temperature, state, new Float64Array(this.n + 1));
    values[this.n] = ambient_K;
    values.forEach((theta_K, i) => {
      const share = Math.min(1, Math.max(0, (theta_K - range[0]) / (range[1] - range[0])));
      const k = 3 * Math.round(share * (this.palette.length / 3 - 1));
      this.circles[i].setAttribute("fill", `rgb(${this.palette.slice(k, k + 3).join(",")})`);
      this.texts[i].textContent = (theta_K + reference_degC).toFixed(2) + " °C";
    });
  }
}
