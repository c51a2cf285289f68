"use strict";
// Buttons, sliders and text around the picture.

/** An element with attributes, listeners ("onclick") and children. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value !== false) element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/** Sets an element's text if it differs, because screen readers read out text that is set again. */
function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Several options, one of which is selected; each is `{ value, label, swatch }`. */
class Options {
  constructor(title, options, choose) {
    // Two views on a page must not share their options.
    const name = `view-${Options.number = (Options.number ?? 0) + 1}`;
    this.inputs = new Map();
    const labels = options.map(({ value, label, swatch }) => {
      const input = make("input", { type: "radio", name, onchange: () => choose(value) });
      this.inputs.set(value, input);
      return make("label", {}, input, ...(swatch ? [make("span", { class: `view-swatch ${swatch}` })] : []), label);
    });
    this.element = make("fieldset", { class: "view-options" }, make("legend", {}, title), ...labels);
  }

  show(value) {
    this.inputs.get(value).checked = true;
  }
}

/** Metres by which the distances of robot and policy have to differ for both to be shown. */
const WORTH_TELLING = 0.001;
const SPEEDS = [1, 2, 5, 10, 20];

/** The controls of the view; `actions` has a function for each request of the reader. */
class Controls {
  constructor(playback, actions) {
    const { document: data } = playback;
    const named = (list) => list.map(({ id, label }) => ({ value: id, label }));
    const learners = data.learners.map(({ id, label }) => ({ value: id, label, swatch: id }));
    const starts = playback.options.start.map((value) => ({ value, label: `${playback.options.start.indexOf(value) + 1}` }));
    this.options = {
      learner: new Options("Who moves the robot", learners, (learner) => actions.select({ learner })),
      constraint: new Options("What is in the way", named(data.constraints), (constraint) => (
        actions.select({ constraint })
      )),
      start: new Options("Start", starts, (start) => actions.select({ start })),
    };
    this.all = make("input", { type: "checkbox", onchange: () => actions.select({ all: this.all.checked }) });
    this.ghost = make("input", { type: "checkbox", onchange: () => actions.select({ ghost: this.ghost.checked }) });
    this.options.learner.element.append(
      make("label", {}, this.all, "paths of all"), make("label", {}, this.ghost, "the expert’s robot as a ghost"));
    this.loop = make("input", { type: "checkbox", onchange: () => actions.select({ loop: this.loop.checked }) });
    this.curves = new DistanceCurves(actions.seek);
    this.play = make("button", { type: "button", class: "view-play", onclick: actions.toggle });
    this.sliding = false;
    this.slider = make("input", {
      type: "range", class: "view-slider", min: 0, step: 1, "aria-label": "Time",
      oninput: () => { this.sliding = true; actions.seek(this.slider.valueAsNumber); },
      onchange: () => { this.sliding = false; actions.seek(this.slider.valueAsNumber); },
    });
    const step = (samples, sign, name) => (
      make("button", { type: "button", "aria-label": name, title: name, onclick: () => actions.step(samples) }, sign)
    );
    const steps = [step(-1, "◂❘", "A step back (,)"), step(1, "❘▸", "A step on (.)")];
    this.time = make("span", { class: "view-time" });
    const speeds = SPEEDS.map((speed) => make("option", { value: speed }, `${speed} ×`));
    this.speed = make("select", { onchange: () => actions.setSpeed(Number(this.speed.value)) }, ...speeds);
    this.words = make("p", { class: "view-words" });
    const { learner, constraint, start } = this.options;
    this.element = make("div", { class: "view-controls" },
      this.curves.element,
      this.slider,
      make("div", { class: "view-times" }, this.play, ...steps, this.time, make("label", {}, "Speed ", this.speed),
        make("label", {}, this.loop, " Loop")),
      make("div", { class: "view-choices" }, learner.element, constraint.element, start.element),
      this.words);
  }

  /** Shows the current state. */
  show(playback) {
    for (const [name, options] of Object.entries(this.options)) options.show(playback.choice[name]);
    for (const name of ["all", "ghost", "loop"]) this[name].checked = playback[name];
    this.ghost.disabled = playback.choice.learner === "expert";
    this.curves.show(playback);
    this.speed.value = playback.speed;
    write(this.play, playback.playing ? "❚❚ Pause" : "▶ Play");
    this.play.setAttribute("aria-label", playback.playing ? "Pause" : "Play");
    const { sample, lastSample, document: { time_step: step } } = playback;
    const seconds = (count) => (count * step).toFixed(1);
    this.slider.max = lastSample;
    // While it plays, the thumb glides; otherwise a key moves it by one sample.
    this.slider.step = playback.playing ? "any" : 1;
    this.slider.value = sample;
    this.slider.setAttribute("aria-valuetext", `${seconds(sample)} of ${seconds(lastSample)} seconds`);
    write(this.time, `${seconds(sample)} s of ${seconds(lastSample)} s`);
    // Screen readers read out changes of the text, but not while it plays or the thumb is dragged.
    this.words.setAttribute("aria-live", playback.playing ? "off" : "polite");
    if (!this.sliding) write(this.words, Controls.inWords(playback));
  }

  /** A sentence with the hands that a plate holds, and the reason. */
  static held([left, right]) {
    const who = left && right ? "hands are" : left ? "left hand is" : right ? "right hand is" : "";
    return who && ` Its ${who} held by the plate before ${left && right ? "their places" : "its place"}: `
      + "the policy keeps pushing straight on.";
  }

  static inWords(playback) {
    const inCentimetres = (distances) => `${distances.map((metres) => (100 * metres).toFixed(1)).join(" and ")} cm`;
    const line = (learner) => {
      const { label } = playback.document.learners.find(({ id }) => id === learner);
      const now = playback.distances(learner, playback.sample);
      const course = playback.course(learner);
      const end = course.at(-1);
      const closest = [0, 1].map((hand) => Math.min(...course.map((both) => both[hand])));
      const wanted = playback.wantedDistances(learner, playback.lastSample);
      const short = wanted.some((distance, hand) => Math.abs(distance - end[hand]) > WORTH_TELLING);
      const remarks = [
        short && ` Its arms do not reach where its policy wants the palms: ${inCentimetres(wanted)} away.`,
        Controls.held(playback.held(learner)),
        playback.withinBall(learner) > 0 && " A palm goes through the ball, which stops nobody here.",
      ];
      return `${label}: now ${inCentimetres(now)}, closest ${inCentimetres(closest)}, at the end ${inCentimetres(end)}.${remarks.filter(Boolean).join("")}`;
    };
    const tracking = playback.movement().error_mm.toFixed(1);
    return [
      "From the robot’s left and right palm to their places at the ball:",
      ...playback.learners.map(line),
      `The robot follows the palms of its policy to within ${tracking} mm.`,
    ].join("\n");
  }
}

/** Buttons over the picture: views, nearer, farther, full screen. */
function viewButtons(look, zoom, fill) {
  const views = Object.entries(VIEWS).map(([name, { label }]) => (
    make("button", { type: "button", onclick: () => look(name) }, label)
  ));
  const nearer = make("button", { type: "button", "aria-label": "Nearer (+)", onclick: () => zoom(1 / 1.2) }, "+");
  const farther = make("button", { type: "button", "aria-label": "Farther (−)", onclick: () => zoom(1.2) }, "−");
  const whole = make("button", { type: "button", onclick: fill }, "Full screen");
  // No button if the browser does not support full screen.
  const last = document.fullscreenEnabled ? [whole] : [];
  return make("div", { class: "view-buttons", role: "group", "aria-label": "Camera" }, ...views, nearer, farther, ...last);
}
