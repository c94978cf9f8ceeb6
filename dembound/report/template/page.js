// Adds a slider to scenes and charts to zoom to the pictures of the page; without it the page is complete.
"use strict";

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 62, right: 12, top: 6, bottom: 22 };
const LABEL_HEIGHT = 20; // of the label below the last panel
const ZOOM = 1.6; // of one press of a button
const PERIOD = 160; // ms between two frames

/** A new element with attributes, those that are false left out. */
function make(name, attributes = {}, parent = null, text = "") {
  const isDrawing = name === "svg" || parent instanceof SVGElement;
  const element = isDrawing ? document.createElementNS(SVG, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) if (value !== false) element.setAttribute(key, value);
  if (text) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

/** A button in a row of tools. */
function button(tools, text, label, press) {
  const made = make("button", { type: "button", "aria-label": label, title: label }, tools, text);
  made.addEventListener("click", press);
  return made;
}

/** The part of a figure that replaces its still picture. */
function livePart(figure) {
  figure.hidden = false;
  figure.classList.add("is-live");
  return make("div", { class: "live" }, figure);
}

/** The scene at several times: a picture, a slider, and a button that plays. */
function showFrames(figure, frames) {
  const part = livePart(figure);
  const tools = make("div", { class: "tools" }, part);
  const play = button(tools, "▶", "Play", toggle);
  const last = frames.uris.length - 1;
  const ends = { type: "range", min: 0, max: last, step: 1, "aria-label": "Snapshot" };
  const slider = make("input", ends, tools);
  const picture = make("img", { width: frames.width, height: frames.height }, part);
  let timer = null;

  function show(index) {
    slider.value = index;
    slider.setAttribute("aria-valuetext", frames.captions[index]);
    picture.src = frames.uris[index];
    picture.alt = `The scene at ${frames.captions[index]}`;
  }
  function next() {
    const index = Number(slider.value);
    if (index < last) show(index + 1);
    else toggle();
  }
  function toggle() {
    if (timer === null) {
      if (Number(slider.value) === last) show(0);
      timer = setInterval(next, PERIOD);
    } else {
      clearInterval(timer);
      timer = null;
    }
    play.textContent = timer === null ? "▶" : "❚❚";
    play.title = timer === null ? "Play" : "Pause";
    play.setAttribute("aria-label", play.title);
  }
  slider.addEventListener("input", () => show(Number(slider.value)));
  show(frames.first);
}

/** Round numbers between two ends, about so many, but at least three. */
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const steps = [0.1, 0.2, 0.5, 1, 2, 5, 10].map((each) => each * power);
  const first = (step) => Math.ceil(low / step - 1e-9), last = (step) => Math.floor(high / step + 1e-9);
  const enough = steps.filter((step) => last(step) - first(step) >= 2);
  const step = enough.find((each) => each >= raw) ?? enough.at(-1) ?? steps[0];
  return Array.from({ length: Math.max(0, last(step) - first(step) + 1) }, (_, index) => (first(step) + index) * step);
}

/** A number as text, in the digits that tell it from one that is a step away. */
function inWords(value, step) {
  if (value === 0) return "0";
  const size = Math.max(Math.abs(value), step);
  const digits = Math.floor(Math.log10(step) + 1e-9);
  if (size < 1e5 && size >= 1e-3) return value.toFixed(Math.min(12, Math.max(0, -digits)));
  return value.toExponential(Math.max(0, Math.floor(Math.log10(size)) - digits)).replace("e+", "e");
}

/** The index of the last number that is not above a value, in numbers that rise; at least 0. */
function lastBelow(numbers, value) {
  let low = 0, high = numbers.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (numbers[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

/** Charts of one figure: panels below each other with a common x axis, which is zoomed; y follows. */
class Charts {
  constructor(figure, id, chart) {
    this.id = id;
    this.chart = chart;
    this.whole = chart.panels[0].range;
    this.range = [...this.whole];
    this.hidden = new Set();
    this.part = livePart(figure);
    make("h4", {}, this.part, chart.title);
    this.makeTools();
    this.panels = chart.panels.map((panel) => this.makePanel(panel));
    this.read = make("p", { class: "read" }, this.part);
    new ResizeObserver(() => this.draw()).observe(this.part);
    this.draw();
  }

  makeTools() {
    const tools = make("div", { class: "tools" }, this.part);
    button(tools, "+", "Zoom in", () => this.zoom(1 / ZOOM));
    button(tools, "−", "Zoom out", () => this.zoom(ZOOM));
    button(tools, "←", "Move left", () => this.move(-0.25));
    button(tools, "→", "Move right", () => this.move(0.25));
    button(tools, "Reset", "Show all", () => this.set(...this.whole));
    const lines = this.chart.panels.flatMap((panel) => panel.lines);
    for (const line of new Map(lines.map((each) => [each.name, each])).values()) this.makeKey(tools, line);
  }

  /** A button that shows or hides all lines of a name. */
  makeKey(tools, { name, colour, dashed }) {
    const key = button(tools, "", `Show ${name}`, () => {
      if (!this.hidden.delete(name)) this.hidden.add(name);
      key.setAttribute("aria-pressed", String(!this.hidden.has(name)));
      this.draw();
    });
    key.setAttribute("aria-pressed", "true");
    make("span", { class: dashed ? "key dashed" : "key" }, key).style.borderColor = colour;
    key.append(name);
  }

  makePanel(panel) {
    const title = [panel.title, panel.y].filter(Boolean).join(" – ");
    make("p", { class: "panel" }, this.part, title);
    const label = `${title}; arrow keys move, + and − zoom, 0 shows all`;
    const svg = make("svg", { role: "group", tabindex: 0, "aria-label": label }, this.part);
    let begun = null;
    const place = ({ clientX }) => {
      const share = (clientX - svg.getBoundingClientRect().left - MARGIN.left) / this.across;
      return this.range[0] + share * (this.range[1] - this.range[0]);
    };
    svg.addEventListener("pointerdown", (event) => {
      if (event.pointerType === "touch") return;
      begun = place(event);
      svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", (event) => this.point(place(event), begun));
    svg.addEventListener("pointerleave", () => this.point(null, null));
    svg.addEventListener("pointerup", (event) => {
      const ended = place(event);
      const isWide = begun !== null && Math.abs(ended - begun) > 0.01 * (this.range[1] - this.range[0]);
      if (isWide) this.set(Math.min(begun, ended), Math.max(begun, ended));
      begun = null;
    });
    svg.addEventListener("dblclick", () => this.set(...this.whole));
    svg.addEventListener("keydown", (event) => {
      const presses = {
        ArrowLeft: () => this.move(-0.1),
        ArrowRight: () => this.move(0.1),
        "+": () => this.zoom(1 / ZOOM),
        "=": () => this.zoom(1 / ZOOM),
        "-": () => this.zoom(ZOOM),
        0: () => this.set(...this.whole),
      };
      if (!(event.key in presses) || event.ctrlKey || event.metaKey) return;
      presses[event.key]();
      event.preventDefault();
    });
    return { ...panel, svg };
  }

  set(low, high) {
    const [first, last] = this.whole;
    this.range = [Math.max(low, first), Math.min(high, last)];
    const least = 1e-4 * (last - first);
    if (this.range[1] - this.range[0] < least) this.range = [this.range[0], this.range[0] + least];
    this.draw();
  }

  zoom(factor) {
    const middle = 0.5 * (this.range[0] + this.range[1]), half = 0.5 * factor * (this.range[1] - this.range[0]);
    this.set(middle - half, middle + half);
  }

  move(share) {
    const width = this.range[1] - this.range[0];
    const low = Math.min(Math.max(this.range[0] + share * width, this.whole[0]), this.whole[1] - width);
    this.set(low, low + width);
  }

  shown(panel) {
    return panel.lines.filter((line) => line.x.length > 0 && !this.hidden.has(line.name));
  }

  /** The ends of y of some panels: of all values between the ends of x, with a margin. */
  values(panels) {
    let low = Infinity, high = -Infinity;
    for (const line of panels.flatMap((panel) => this.shown(panel))) {
      const end = lastBelow(line.x, this.range[1]);
      for (let index = lastBelow(line.x, this.range[0]); index <= end; index++) {
        if (line.y[index] === null) continue;
        low = Math.min(low, line.y[index]);
        high = Math.max(high, line.y[index]);
      }
    }
    if (low > high) return [-1, 1];
    const margin = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
    return [low - margin, high + margin];
  }

  draw() {
    const width = this.part.clientWidth;
    if (width === 0) return;
    this.across = width - MARGIN.left - MARGIN.right;
    const common = this.chart.sharedY ? this.values(this.panels) : null;
    for (const panel of this.panels) this.drawPanel(panel, width, common ?? this.values([panel]));
  }

  drawPanel(panel, width, [low, high]) {
    const { svg } = panel, { left, top, bottom } = MARGIN, isLast = panel === this.panels.at(-1);
    const up = this.panels.length === 1 ? 260 : this.panels.length > 3 ? 90 : 150;
    const height = up + top + bottom + (isLast ? LABEL_HEIGHT : 0);
    const x = (value) => left + ((value - this.range[0]) / (this.range[1] - this.range[0])) * this.across;
    const y = (value) => top + ((high - value) / (high - low)) * up;
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    const marks = ticks(...this.range, Math.max(2, this.across / 90)), levels = ticks(low, high, Math.max(2, up / 40));
    for (const mark of marks) {
      make("line", { x1: x(mark), x2: x(mark), y1: top, y2: top + up, class: "grid" }, svg);
      const place = { x: x(mark), y: top + up + 15, "text-anchor": "middle" };
      make("text", place, svg, inWords(mark, marks[1] - marks[0] || 1));
    }
    for (const level of levels) {
      make("line", { x1: left, x2: left + this.across, y1: y(level), y2: y(level), class: "grid" }, svg);
      const place = { x: left - 6, y: y(level) + 4, "text-anchor": "end" };
      make("text", place, svg, inWords(level, levels[1] - levels[0] || 1));
    }
    const box = { x: left, y: top, width: this.across, height: up };
    const clip = `${this.id}-clip-${this.panels.indexOf(panel)}`;
    make("rect", box, make("clipPath", { id: clip }, svg));
    for (const line of this.shown(panel)) {
      const pen = { stroke: line.colour, "stroke-width": line.width, "stroke-opacity": line.opacity };
      const looks = { ...pen, fill: "none", "stroke-dasharray": line.dashed && "6 4", "clip-path": `url(#${clip})` };
      make("path", { d: this.path(line, x, y), ...looks }, svg);
    }
    make("rect", { ...box, class: "frame" }, svg);
    const below = { x: left + 0.5 * this.across, y: height - 5, "text-anchor": "middle" };
    if (isLast) make("text", below, svg, this.chart.x);
    panel.chosen = make("rect", { y: top, height: up, width: 0, class: "chosen" }, svg);
    panel.cursor = make("line", { y1: top, y2: top + up, x1: -1, x2: -1, class: "cursor" }, svg);
    panel.at = x;
  }

  /** The points of a line between the ends of x, with one more at either side. */
  path(line, x, y) {
    const end = Math.min(line.x.length - 1, lastBelow(line.x, this.range[1]) + 1);
    let text = "", pen = "M";
    for (let index = lastBelow(line.x, this.range[0]); index <= end; index++) {
      const isThere = line.y[index] !== null;
      if (isThere) text += `${pen}${x(line.x[index]).toFixed(1)} ${y(line.y[index]).toFixed(1)}`;
      pen = isThere ? "L" : "M";
    }
    return text;
  }

  /** Mark a place on x in all panels, and the part since another one, and print the values there. */
  point(place, begun) {
    const isInside = place !== null && place >= this.range[0] && place <= this.range[1];
    for (const panel of this.panels) {
      const at = isInside ? panel.at(place) : -1, from = isInside && begun !== null ? panel.at(begun) : at;
      panel.cursor.setAttribute("x1", at);
      panel.cursor.setAttribute("x2", at);
      panel.chosen.setAttribute("x", Math.min(from, at));
      panel.chosen.setAttribute("width", Math.abs(at - from));
    }
    const words = () => [`${this.chart.x} ${place.toPrecision(5)}`, ...this.panels.map((each) => this.at(each, place))];
    this.read.textContent = isInside ? words().join("; ") : "";
  }

  /** The values of a panel's lines at a place, in words. */
  at(panel, place) {
    const value = (line) => line.y[lastBelow(line.x, place)]?.toPrecision(4) ?? "–";
    const values = this.shown(panel).map((line) => `${line.name} ${value(line)}`);
    return [panel.title.split(" at ")[0], values.join(", ")].filter(Boolean).join(": ");
  }
}

/** The values that the page holds, from compressed JSON. */
async function unpacked() {
  const letters = atob(document.getElementById("live").textContent);
  const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text());
}

if ("DecompressionStream" in window) {
  unpacked().then((live) => {
    for (const [id, values] of Object.entries(live)) {
      const figure = document.getElementById(id);
      if (figure === null || values === null) continue;
      if ("uris" in values) showFrames(figure, values);
      else new Charts(figure, id, values);
    }
  });
}
