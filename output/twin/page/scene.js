// The machine in WebGL 2: its surface in the colours of temperature, bent by its displacement, seen in parallel projection.

const VERTEX = `#version 300 es
in vec3 place; in vec3 displaced; in float temperature;
uniform mat4 view; uniform float magnified; uniform vec2 range; uniform float nearer;
out vec3 at; out float share;
void main() {
  vec3 p = place + magnified * displaced;
  at = (view * vec4(p, 0.0)).xyz;
  share = clamp((temperature - range.x) / (range.y - range.x), 0.0, 1.0);
  gl_Position = view * vec4(p, 1.0);
  gl_Position.z -= nearer;
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at; in float share;
uniform sampler2D colours; uniform float isLine; uniform vec2 aspect;
out vec4 colour;
void main() {
  vec3 p = vec3(at.xy * aspect, -at.z);
  vec3 normal = normalize(cross(dFdx(p), dFdy(p)));
  float light = 0.62 + 0.38 * abs(dot(normal, normalize(vec3(0.3, 0.5, 0.8))));
  colour = vec4(mix(texture(colours, vec2(share, 0.5)).rgb * light, vec3(0.08, 0.09, 0.1), isLine), 1.0);
}`;

class Scene {
  // @param palette  of temperature, RGB bytes from cold to warm
  // @throws where the browser has no WebGL 2
  constructor(canvas, surface, palette) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext("webgl2", {antialias: true, alpha: true, preserveDrawingBuffer: true});
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.program = this.compile();
    this.uniforms = Object.fromEntries(["view", "magnified", "range", "nearer", "colours", "isLine", "aspect"].map(
        name => [name, gl.getUniformLocation(this.program, name)]));
    const attribute = (name, width, values) => {
      const buffer = gl.createBuffer(), place = gl.getAttribLocation(this.program, name);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, width, gl.FLOAT, false, 0, 0);
      return buffer;
    };
    const elements = values => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, values, gl.STATIC_DRAW);
      return {buffer, n: values.length};
    };
    attribute("place", 3, surface.coords);
    this.displaced = attribute("displaced", 3, new Float32Array(surface.coords.length));
    this.temperature = attribute("temperature", 1, new Float32Array(surface.coords.length / 3));
    this.triangles = elements(surface.triangles);
    this.edges = elements(surface.edges);
    this.paint(palette);
    this.frame(surface.coords);
    this.look();
    this.magnified = 0;
    this.range = [0, 1];
  }

  compile() {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    return program;
  }

  paint(palette) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, palette.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, palette);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
                                [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, key, value);
  }

  frame(coords) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < coords.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], coords[i]);
      high[i % 3] = Math.max(high[i % 3], coords[i]);
    }
    this.middle = low.map((l, k) => 0.5 * (l + high[k]));
    this.radius = 0.5 * Math.hypot(...low.map((l, k) => high[k] - l));
  }

  look() {
    Object.assign(this, {yaw: 0.7, pitch: 0.45, zoom: 1, pan: [0, 0]});
  }
  turnBy(right, up) {
    this.yaw -= right;
    this.pitch = Math.min(1.57, Math.max(-1.57, this.pitch + up));
  }
  zoomBy(factor) { this.zoom = Math.min(40, Math.max(0.3, this.zoom * factor)); }

  // From a point of the machine [m] to the picture, -1 to 1; Z is up, the eye looks from +x, +y.
  matrix() {
    const {yaw, pitch, zoom, radius, middle, pan, canvas} = this;
    const away = [Math.cos(pitch) * Math.sin(yaw), Math.cos(pitch) * Math.cos(yaw), Math.sin(pitch)];
    const right = [-Math.cos(yaw), Math.sin(yaw), 0];
    const up = [-Math.sin(pitch) * Math.sin(yaw), -Math.sin(pitch) * Math.cos(yaw), Math.cos(pitch)];
    const ratio = canvas.width / canvas.height, scale = 0.98 * zoom / radius;
    const sx = scale / Math.max(1, ratio), sy = scale * Math.min(1, ratio), sz = 0.2 / radius;
    const dot = v => v[0] * middle[0] + v[1] * middle[1] + v[2] * middle[2];
    this.aspect = [1 / sx, 1 / sy];
    this.depth = 1 / sz;
    return [sx * right[0], sy * up[0], -sz * away[0], 0, sx * right[1], sy * up[1], -sz * away[1], 0,
            sx * right[2], sy * up[2], -sz * away[2], 0, pan[0] - sx * dot(right), pan[1] - sy * dot(up), sz * dot(away), 1];
  }

  // The position of a point in the canvas, in CSS pixels.
  project(point) {
    const m = this.matrix(), x = k => m[k] * point[0] + m[4 + k] * point[1] + m[8 + k] * point[2] + m[12 + k];
    return [0.5 * (1 + x(0)) * this.canvas.clientWidth, 0.5 * (1 - x(1)) * this.canvas.clientHeight];
  }

  takeFields(fields) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.temperature);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, fields.temperature_K);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.displaced);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, fields.displaced_m);
  }

  draw() {
    const {gl, canvas, uniforms} = this, dense = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * dense)), height = Math.max(1, Math.round(canvas.clientHeight * dense));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.uniformMatrix4fv(uniforms.view, false, this.matrix());
    gl.uniform1f(uniforms.magnified, this.magnified);
    gl.uniform2f(uniforms.range, ...this.range);
    gl.uniform2f(uniforms.aspect, ...this.aspect.map(a => a / this.depth));
    gl.uniform1f(uniforms.isLine, 0);
    gl.uniform1f(uniforms.nearer, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles.buffer);
    gl.drawElements(gl.TRIANGLES, this.triangles.n, gl.UNSIGNED_INT, 0);
    gl.uniform1f(uniforms.isLine, 0.7);
    gl.uniform1f(uniforms.nearer, 0.0005);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.edges.buffer);
    gl.drawElements(gl.LINES, this.edges.n, gl.UNSIGNED_INT, 0);
  }
}

// Mouse, touch and keys turn the machine.
function handle(scene, changed) {
  const canvas = scene.canvas;
  let from = null;
  canvas.addEventListener("pointerdown", event => {
    from = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    if (!from) return;
    const right = event.clientX - from[0], down = event.clientY - from[1];
    from = [event.clientX, event.clientY];
    if (event.shiftKey) {
      scene.pan[0] += 2 * right / canvas.clientWidth;
      scene.pan[1] -= 2 * down / canvas.clientHeight;
    } else {
      scene.turnBy(0.008 * right, 0.008 * down);
    }
    changed();
  });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => from = null);
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    scene.zoomBy(Math.exp(-0.0015 * event.deltaY));
    changed();
  }, {passive: false});
  canvas.addEventListener("keydown", event => {
    const act = {ArrowLeft: () => scene.turnBy(-0.1, 0), ArrowRight: () => scene.turnBy(0.1, 0), ArrowUp: () => scene.turnBy(0, -0.1),
                 ArrowDown: () => scene.turnBy(0, 0.1), "+": () => scene.zoomBy(1.2), "-": () => scene.zoomBy(1 / 1.2)}[event.key];
    if (!act) return;
    event.preventDefault();
    act();
    changed();
  });
}
