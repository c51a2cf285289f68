"use strict";
// Distances of the hands from their places over time, above the slider and as wide as its track; a line marks the time.

/** Size and margin of the picture, in its units. It shows the farther of the two hands. */
const CURVES = { width: 1000, height: 130, room: 6 };
/** Seconds between two marks. */
const EVERY = 10;
const LINE_DASHES = { naive: "1 5", policy_align: "9 5" };

const svg = (tag, attributes) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
};

class DistanceCurves {
  constructor(seek) {
    const { width, height } = CURVES;
    this.picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, preserveAspectRatio: "none", "aria-hidden": "true" });
    this.now = svg("line", { class: "view-now", y1: 0, y2: height });
    this.top = make("span", { class: "view-scale top" });
    this.times = make("div", { class: "view-seconds", "aria-hidden": "true" });
    this.element = make("div", { class: "view-curves" },
      make("p", { class: "view-axis" }, "Distance of the farther hand from its place at the ball, over time"),
      make("div", { class: "view-plot" }, this.picture, this.top, make("span", { class: "view-scale" }, "0 cm")), this.times);
    const to = ({ clientX, buttons }) => {
      const { left, width: wide } = this.picture.getBoundingClientRect();
      if (buttons === 1) seek(this.lastSample * Math.min(Math.max((clientX - left) / wide, 0), 1));
    };
    this.picture.addEventListener("pointerdown", (event) => {
      this.picture.setPointerCapture(event.pointerId);
      to(event);
    });
    this.picture.addEventListener("pointermove", to);
  }

  /** Shows the learners' curves for the current choice, and the time. */
  show(playback) {
    const { choice: { constraint, start }, learners, lastSample, sample } = playback;
    const drawn = [constraint, start, ...learners].join();
    if (drawn !== this.drawn) this.draw(playback);
    Object.assign(this, { drawn, lastSample });
    const at = CURVES.width * sample / lastSample;
    this.now.setAttribute("x1", at);
    this.now.setAttribute("x2", at);
  }

  draw(playback) {
    const { width, height, room } = CURVES;
    const curves = playback.learners.map((learner) => [learner, playback.course(learner).map((both) => Math.max(...both))]);
    // Rounded up to a tenth of a metre.
    const top = Math.ceil(10 * Math.max(...curves.flatMap(([, curve]) => curve))) / 10;
    const up = (metres) => height - room - metres / top * (height - 2 * room);
    const lines = curves.map(([learner, curve]) => {
      const points = curve.map((metres, sample) => `${width * sample / (curve.length - 1)},${up(metres).toFixed(1)}`);
      const dash = LINE_DASHES[learner] ? { "stroke-dasharray": LINE_DASHES[learner] } : {};
      return svg("polyline", { class: `view-curve ${learner}`, points: points.join(" "), ...dash });
    });
    const level = svg("line", { class: "view-level", x1: 0, x2: width, y1: up(0), y2: up(0) });
    const end = playback.lastSample * playback.document.time_step;
    const seconds = Array.from({ length: Math.floor(end / EVERY) + 1 }, (_, k) => EVERY * k);
    const across = seconds.slice(1).map((second) => width * second / end);
    const upright = across.map((x) => svg("line", { class: "view-level", x1: x, x2: x, y1: 0, y2: height }));
    this.picture.replaceChildren(level, ...upright, ...lines, this.now);
    this.times.replaceChildren(...seconds.map((second) => (
      make("span", { style: `left: ${100 * second / end}%` }, second === 0 ? "0 s" : `${second}`)
    )));
    write(this.top, `${(100 * top).toFixed(0)} cm`);
  }
}
