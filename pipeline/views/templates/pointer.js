// Values under the pointer, read from the CSV data of a figure, and a large view of it. Without it the page is the same.
"use strict";
(() => {
  const NEAR = 60;
  const readings = new WeakMap();
  const tip = made("div", "tip"), dot = made("div", "dot");

  function made(kind, name, inside = document.body) {
    const element = document.createElement(kind);
    element.className = name;
    inside.append(element);
    return element;
  }

  const scaled = (value, log) => log ? Math.log(value) : value;
  const share = (axis, value) => {
    const [low, high] = axis.limits.map(v => scaled(v, axis.log));
    return (scaled(value, axis.log) - low) / (high - low);
  };
  const at = (axis, cell) => cell === "" ? NaN : share(axis, axis.texts?.[cell] ?? Number(cell));

  // panels, and of each series its points as fractions of the picture, with the texts of its columns
  async function read(picture) {
    const {panels, series} = JSON.parse(picture.dataset.places);
    const link = picture.source ?? picture.closest("figure").querySelector("a.data");
    const [names, ...rows] = (await reading.text(link.href)).trimEnd().split("\n").map(reading.cells);
    const points = series.map(({panel, x, y, more = []}) => {
      const {box, x: across, y: up} = panels[panel];
      return {panel, columns: [x, y, ...more],
              x: Float64Array.from(rows, row => box[0] + (box[2] - box[0]) * at(across, row[x])),
              y: Float64Array.from(rows, row => box[3] - (box[3] - box[1]) * at(up, row[y]))};
    });
    return {panels, names, rows, points};
  }

  function written(name, cell) {
    const [quantity, ...unit] = name.split(" / ");
    return `${quantity}: ${cell}${unit.length && unit.join(" / ") !== "1" ? " " + unit.join(" / ") : ""}`;
  }

  // texts about the nearest point, and its place as fractions; of the pointer itself if none is near
  function nearest({panels, names, rows, points}, x, y, width, height) {
    const panel = panels.findIndex(({box}) => x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]);
    if (panel < 0) return null;
    let best = NEAR, found = null;
    const lines = new Set();
    for (const series of points) {
      if (series.panel !== panel) continue;
      let least = best + 0.5, index = -1;
      for (let k = 0; k < series.x.length; k++) {
        const far = Math.hypot((series.x[k] - x) * width, (series.y[k] - y) * height);
        if (far < least) [least, index] = [far, k];
      }
      if (index < 0) continue;
      if (least < best - 0.5) lines.clear();
      if (least < best) [best, found] = [least, [series.x[index], series.y[index]]];
      for (const column of series.columns) if (rows[index][column]) lines.add(written(names[column], rows[index][column]));
    }
    return found && {lines: [...lines], x: found[0], y: found[1]};
  }

  function hide() {
    tip.hidden = dot.hidden = true;
  }

  async function show(event) {
    const picture = event.target.closest?.(".picture[data-places]");
    if (!picture) return hide();
    if (!readings.has(picture)) readings.set(picture, read(picture));
    const reading = await readings.get(picture);
    const frame = picture.querySelector("img").getBoundingClientRect();
    const point = nearest(reading, (event.clientX - frame.left) / frame.width, (event.clientY - frame.top) / frame.height,
                          frame.width, frame.height);
    if (!point) return hide();
    (picture.closest("dialog") ?? document.body).append(tip, dot);
    tip.textContent = point.lines.join("\n");
    tip.hidden = dot.hidden = false;
    dot.style.left = `${frame.left + point.x * frame.width}px`;
    dot.style.top = `${frame.top + point.y * frame.height}px`;
    tip.style.left = `${Math.max(4, Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 4))}px`;
    tip.style.top = `${event.clientY + 18 + tip.offsetHeight > innerHeight ? event.clientY - tip.offsetHeight - 12 : event.clientY + 18}px`;
  }

  // a large view: wheel zooms about the pointer, dragging moves, double click resets, Escape or a click beside it closes
  function enlarge(picture) {
    const dialog = made("dialog", "large");
    const copy = picture.cloneNode(true);
    copy.source = picture.closest("figure").querySelector("a.data");
    const close = made("button", "close", dialog);
    close.textContent = "close";
    close.addEventListener("click", () => dialog.close());
    dialog.append(copy);
    let zoom = 1, left = 0, top = 0, held = null;
    const place = () => { copy.style.transform = `translate(${left}px, ${top}px) scale(${zoom})`; hide(); };
    dialog.addEventListener("wheel", event => {
      event.preventDefault();
      const frame = copy.getBoundingClientRect(), factor = Math.min(Math.max(zoom * 1.0015 ** -event.deltaY, 1), 40) / zoom;
      left += (1 - factor) * (event.clientX - frame.left);
      top += (1 - factor) * (event.clientY - frame.top);
      zoom *= factor;
      if (zoom === 1) left = top = 0;
      place();
    }, {passive: false});
    copy.addEventListener("pointerdown", event => { held = [event.clientX - left, event.clientY - top]; event.preventDefault(); });
    dialog.addEventListener("pointermove", event => {
      if (held && event.buttons) { [left, top] = [event.clientX - held[0], event.clientY - held[1]]; place(); }
    });
    dialog.addEventListener("pointerup", () => { held = null; });
    copy.addEventListener("dblclick", () => { zoom = 1; left = top = 0; place(); });
    dialog.addEventListener("click", event => { if (event.target === dialog) dialog.close(); });
    dialog.addEventListener("close", () => { document.body.append(tip, dot); hide(); dialog.remove(); });
    dialog.showModal();
  }

  hide();
  document.addEventListener("pointermove", show);
  document.addEventListener("pointerdown", show);
  document.addEventListener("scroll", hide, true);
  document.addEventListener("click", event => {
    const picture = event.target.closest?.("figure .picture");
    if (picture && !picture.querySelector("canvas")) enlarge(picture);
  });
})();
