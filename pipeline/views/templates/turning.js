// Bodies that can be turned by dragging, and modes that move, drawn from the data of a figure in place of its picture.
"use strict";
(() => {
  const SIZE = [840, 640], PERIOD = 1600, FRAME = 30, FILLED = 0.85;
  const STOPS = [[45, 0, 75], [153, 142, 195], [247, 247, 247], [241, 163, 64], [127, 59, 8]];

  async function read(picture) {
    const look = JSON.parse(picture.dataset.shape);
    const [, ...lines] = (await reading.text(picture.closest("figure").querySelector("a.data").href)).trimEnd().split("\n");
    const rows = lines.map(line => line.split(",").map(Number));
    const column = k => Float64Array.from(rows, row => row[k]);
    const part = first => look.moving ? [0, 2, 4].map(k => column(first + k)) : [];
    return {look, points: [0, 1, 2].map(column), real: part(3), imaginary: part(4), faces: await reading.integers(picture.dataset.faces)};
  }

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = a => a.map(v => v / Math.hypot(...a));

  // rows: to the right, upwards, towards the eye
  function view(direction) {
    const eye = unit(direction), right = unit(cross([0, 0, 1], eye));
    return [right, cross(eye, right), eye];
  }

  function turned([right, up, eye], across, along) {
    const mixed = (a, b, angle) => a.map((v, k) => Math.cos(angle) * v + Math.sin(angle) * b[k]);
    const [side, back] = [mixed(right, eye, -across), mixed(eye, right, across)];
    return [side, mixed(up, back, along), mixed(back, up, -along)];
  }

  function colour(value) {
    const place = 2 + 2 * Math.max(-1, Math.min(1, value)), k = Math.min(3, Math.floor(place));
    return STOPS[k].map((v, c) => v + (place - k) * (STOPS[k + 1][c] - v));
  }

  function plain(text) {
    return [1, 3, 5].map(k => parseInt(text.slice(k, k + 2), 16));
  }

  const ends = values => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);

  function canvas(picture, shape) {
    const element = document.createElement("canvas");
    [element.width, element.height] = SIZE;
    element.setAttribute("role", "img");
    element.setAttribute("aria-label", picture.querySelector("img").alt);
    picture.append(element);
    const pen = element.getContext("2d");
    const {look, points, real, imaginary, faces} = shape, count = points[0].length, total = faces.length / 4;
    const middle = points.map(values => ends(values).reduce((low, high) => (low + high) / 2));
    const seen = [0, 1, 2].map(() => new Float64Array(count)), axial = new Float64Array(count);
    const depth = new Float64Array(total), order = Uint32Array.from({length: total}, (_, k) => k);
    const body = look.bodies.flatMap((each, k) => Array(each.faces).fill(k)), paints = look.bodies.map(each => plain(each.colour));
    const state = {view: view(look.direction), zoom: 1, size: 1, phase: 0};
    place();
    const fit = FILLED * Math.min(...SIZE.map((pixels, a) => pixels / ends(seen[a]).reduce((low, high) => high - low)));

    // seen: to the right, upwards and towards the eye, of every point in its place at this phase
    function place() {
      const c = Math.cos(state.phase), s = Math.sin(state.phase), scale = look.scale * state.size, p = [0, 0, 0];
      for (let n = 0; n < count; n++) {
        for (let a = 0; a < 3; a++) {
          const moved = look.moving ? real[a][n] * c - imaginary[a][n] * s : 0;
          p[a] = points[a][n] - middle[a] + scale * moved;
          if (a === 2) axial[n] = moved / look.limit;
        }
        for (let a = 0; a < 3; a++) seen[a][n] = dot(state.view[a], p);
      }
      for (let f = 0; f < total; f++) {
        depth[f] = 0;
        for (let e = 4 * f; e < 4 * f + 4; e++) depth[f] += seen[2][faces[e]];
      }
      order.sort((f, g) => depth[f] - depth[g]);
    }

    // share of the light that a face with these corners sends to the eye
    function light(i, j, k, l) {
      const [x, y, z] = seen, a = x[k] - x[i], b = y[k] - y[i], c = z[k] - z[i];
      const d = x[l] - x[j], e = y[l] - y[j], f = z[l] - z[j];
      const normal = [b * f - c * e, c * d - a * f, a * e - b * d];
      return 0.45 + 0.55 * Math.abs(normal[2]) / (Math.hypot(...normal) || 1);
    }

    function draw() {
      place();
      const [width, height] = SIZE, factor = state.zoom * fit;
      pen.fillStyle = "#fff";
      pen.fillRect(0, 0, width, height);
      for (const f of order) {
        const i = faces[4 * f], j = faces[4 * f + 1], k = faces[4 * f + 2], l = faces[4 * f + 3];
        const base = look.moving ? colour((axial[i] + axial[j] + axial[k] + axial[l]) / 4) : paints[body[f]];
        const bright = light(i, j, k, l), shade = `rgb(${base.map(v => Math.round(v * bright)).join(",")})`;
        const opacity = look.bodies[body[f]].opacity;
        pen.globalAlpha = opacity;
        pen.fillStyle = shade;
        pen.strokeStyle = look.moving ? shade : "#3a4048";
        pen.beginPath();
        pen.moveTo(width / 2 + factor * seen[0][i], height / 2 - factor * seen[1][i]);
        for (let e = 4 * f + 1; e < 4 * f + 4; e++) {
          pen.lineTo(width / 2 + factor * seen[0][faces[e]], height / 2 - factor * seen[1][faces[e]]);
        }
        pen.closePath();
        pen.fill();
        if (opacity === 1) pen.stroke();
      }
      pen.globalAlpha = 1;
    }
    return {element, state, draw};
  }

  function control(bar, kind, label, settings) {
    const element = document.createElement(kind);
    Object.assign(element, settings);
    const named = document.createElement("label");
    named.append(kind === "button" ? "" : `${label} `, element);
    bar.append(named);
    return element;
  }

  async function turn(picture, button) {
    button.remove();
    const shape = await read(picture), {element, state, draw} = canvas(picture, shape);
    picture.classList.add("turning");
    let playing = shape.look.moving, visible = true, last = 0;
    function step(time) {
      if (!playing || !visible || !element.isConnected) { last = 0; return; }
      requestAnimationFrame(step);
      if (last && time - last < FRAME) return;
      state.phase += last ? 2 * Math.PI * (time - last) / PERIOD : 0;
      last = time;
      draw();
    }
    const still = () => { if (!playing) draw(); };
    element.addEventListener("pointerdown", event => element.setPointerCapture(event.pointerId));
    element.addEventListener("pointermove", event => {
      if (!event.buttons) return;
      state.view = turned(state.view, -event.movementX / 120, event.movementY / 120);
      still();
    });
    const bar = document.createElement("div");
    bar.className = "controls";
    picture.after(bar);
    const ranged = {type: "range", step: 0.05};
    const zoom = control(bar, "input", "zoom", {...ranged, min: 0.5, max: 4, value: 1});
    zoom.addEventListener("input", () => { state.zoom = Number(zoom.value); still(); });
    if (shape.look.moving) {
      const size = control(bar, "input", "amplitude", {...ranged, min: 0, max: 3, value: 1});
      size.addEventListener("input", () => { state.size = Number(size.value); still(); });
      const pause = control(bar, "button", "", {textContent: "pause"});
      pause.addEventListener("click", () => {
        playing = !playing;
        pause.textContent = playing ? "pause" : "move";
        if (playing) requestAnimationFrame(step);
      });
      new IntersectionObserver(([entry]) => {
        const shown = visible;
        visible = entry.isIntersecting;
        if (visible && !shown) requestAnimationFrame(step);
      }).observe(element);
    }
    draw();
    if (playing) requestAnimationFrame(step);
  }

  for (const picture of document.querySelectorAll(".picture[data-shape]")) {
    const button = document.createElement("button");
    button.textContent = "turn in 3D";
    button.className = "turn";
    button.addEventListener("click", () => turn(picture, button));
    picture.closest("figure").querySelector("figcaption").append(" ", button);
  }
})();
