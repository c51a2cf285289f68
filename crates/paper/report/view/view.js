"use strict";
// The interactive view: a robot reaches for a ball, seen from any side. It needs the figure data "grasp_playback"
// and an element, and consists of matrix.js, robot.js, meshes.js, shaders.js, renderer.js, camera.js,
// gestures.js, playback.js, scene.js, curves.js, controls.js, address.js and this file, in this order in one script;
// view.css is its style sheet.

const COLOR_NAMES = [
  "background", "sky", "ground", "floor", "grid", "robot", "table", "ball", "plate", "target", "eye",
  "expert", "naive", "policy_align", "slope_gp",
];
const HELP = "Drag or arrow keys: turn. Right button or Shift and drag, two fingers: move. Pinch, wheel (after a click) or + "
  + "and −: nearer, farther. Double-click: look at what is there. Space: play, pause. , and .: a step back, on. F: full screen. "
  + "Home: reset. The address keeps what is shown.";
/** Share of the picture that must be visible before it plays automatically. */
const IN_SIGHT = 0.6;
/** Milliseconds without a change after which the address is written. */
const SETTLED = 400;
const LEGEND = "Paths are solid up to the current time, faint after it; dots are the palms and their places at the ball. Blue plates "
  + "are in the way: in the pale space around them a hand moves neither forwards nor back. Only hands feel them: "
  + "the trunk may lean through. A plate goes on upwards beyond what is drawn; where its side has no dark edge, it goes on sideways "
  + "too.";

/** Builds the view in an element. If it cannot be drawn, a note with a link to `data-still` replaces it. */
function startView(element, data) {
  element.classList.add("view");
  const canvas = make("canvas", {
    tabindex: 0, role: "application", "aria-roledescription": "3-D view", "aria-label": "The robot and the ball",
    "aria-describedby": "view-keys",
  });
  let renderer;
  try {
    renderer = new Renderer(canvas);
  } catch (error) {
    element.replaceChildren(noteInstead(error, element.dataset.still));
    return;
  }
  window.policyAlignView = new View(element, canvas, renderer, data).handle();
}

/** A note with the reason why there is no picture. */
function noteInstead(error, still) {
  const note = make("p", { class: "view-note" }, `The moving picture cannot be drawn here: ${error.message}. `);
  if (still) note.append("A ", make("a", { href: still }, "still picture"), " shows the same.");
  return note;
}

class View {
  constructor(element, canvas, renderer, data) {
    Object.assign(this, { element, canvas, playback: new Playback(data) });
    this.restful = matchMedia("(prefers-reduced-motion: reduce)");
    this.last = null;
    // It plays once automatically, unless the reader has already used it.
    this.fresh = true;
    this.build(renderer);
    this.camera = new Camera(this.scene.extent);
    this.controls = new Controls(this.playback, {
      select: (choice) => this.select(choice),
      toggle: () => (this.playback.playing ? this.pause() : this.play()),
      seek: (sample) => { this.playback.pause(); this.seek(sample); },
      step: (samples) => this.step(samples),
      setSpeed: (speed) => this.setSpeed(speed),
    });
    this.follow(location.hash);
    const look = (name) => this.look(name);
    const zoom = (factor) => { this.camera.zoom(factor); this.changed(); };
    const fill = () => this.fillScreen();
    const stage = make("div", { class: "view-stage" }, canvas, viewButtons(look, zoom, fill));
    const help = make("p", { class: "view-help" }, LEGEND, make("br"), make("span", { id: "view-keys" }, HELP));
    element.replaceChildren(stage, this.controls.element, help);
    this.listen();
    this.ask();
  }

  /** Builds everything on the graphics processor, which may lose it. */
  build(renderer) {
    this.renderer = renderer;
    this.scene = new Scene(renderer, this.playback);
    this.scene.choose();
  }

  listen() {
    const { canvas } = this;
    listen(canvas, this.camera, (eye, sight) => this.scene.pick(eye, sight), () => this.changed());
    window.addEventListener("hashchange", () => this.follow(location.hash));
    const keys = {
      " ": () => this.controls.play.click(),
      ",": () => this.step(-1),
      ".": () => this.step(1),
      f: () => this.fillScreen(),
    };
    canvas.addEventListener("keydown", (event) => {
      const key = event.key.toLowerCase();
      if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(keys, key)) return;
      event.preventDefault();
      keys[key]();
    });
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => { this.build(new Renderer(canvas)); this.ask(); });
    new ResizeObserver(() => this.ask()).observe(canvas);
    const seen = ([entry]) => {
      this.visible = entry.isIntersecting;
      if (entry.intersectionRatio >= IN_SIGHT) this.begin();
      this.ask();
    };
    new IntersectionObserver(seen, { threshold: [0, IN_SIGHT] }).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.ask());
    window.addEventListener("beforeprint", () => this.print(true));
    window.addEventListener("afterprint", () => this.print(false));
  }

  /** On paper, a still picture in light colours: browsers do not print the output of the graphics processor. */
  print(starts) {
    this.element.classList.toggle("view-printing", starts);
    this.render();
    this.element.querySelector(".view-paper")?.remove();
    if (starts) this.canvas.after(make("img", { class: "view-paper", alt: "The robot and the ball", src: this.canvas.toDataURL() }));
  }

  /** Plays once from the beginning, when first seen, unless the reader prefers reduced motion. */
  begin() {
    if (!this.fresh || this.restful.matches) return;
    this.fresh = false;
    this.playback.seek(0);
    this.playback.play();
  }

  /** Shows the state in an address that concerns the view; invalid values change nothing. */
  follow(hash) {
    const address = readAddress(hash);
    if (!address) return;
    const known = Object.entries(this.playback.options).filter(([name, values]) => values.includes(address[name]));
    const { all, ghost, loop } = address;
    this.playback.pause();
    this.playback.select({ all, ghost, loop, ...Object.fromEntries(known.map(([name]) => [name, address[name]])) });
    if (SPEEDS.includes(address.speed)) this.playback.speed = address.speed;
    this.scene.choose();
    if (address.sample !== undefined) this.playback.seek(address.sample);
    if (address.camera) this.camera.put(address.camera);
    this.fresh = false;
    this.element.scrollIntoView({ behavior: "instant" });
    this.ask();
  }

  // Actions of the reader and of tests.

  /** Draws, and writes the address once changes have stopped. */
  changed() {
    this.fresh = false;
    this.ask();
    clearTimeout(this.settling);
    const write = () => history.replaceState(null, "", writeAddress(this.playback, this.camera));
    this.settling = setTimeout(write, SETTLED);
  }

  select(choice) {
    this.playback.select(choice);
    this.scene.choose();
    this.changed();
  }

  play() {
    this.playback.play();
    this.changed();
  }

  pause() {
    this.playback.pause();
    this.changed();
  }

  seek(sample) {
    this.playback.seek(sample);
    this.changed();
  }

  /** Moves by this many samples, forward or back, and pauses at a whole one. */
  step(samples) {
    const { sample } = this.playback;
    this.playback.pause();
    this.seek(samples > 0 ? Math.floor(sample) + samples : Math.ceil(sample) + samples);
  }

  setSpeed(speed) {
    this.playback.speed = speed;
    this.changed();
  }

  /** Switches full screen on or off. */
  fillScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.element.requestFullscreen?.().catch(() => {});
  }

  look(name) {
    this.camera.look(name);
    if (this.restful.matches) this.camera.arrive();
    this.changed();
  }

  // Drawing: only on request, and repeatedly only while the picture is visible.

  ask() {
    this.asked ??= requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    this.asked = null;
    // The first step after a pause has the usual length, not that of the pause.
    const seconds = this.last === null ? 1 / 60 : Math.min((now - this.last) / 1000, 0.25);
    if (this.playback.playing) this.playback.advance(seconds);
    const moving = this.camera.advance(seconds);
    this.render();
    const again = (this.playback.playing || moving) && this.visible !== false;
    this.last = again ? now : null;
    if (again) this.ask();
  }

  /** Draws the current state at once. */
  render() {
    const { canvas, playback } = this;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const size = [canvas.clientWidth, canvas.clientHeight].map((pixels) => Math.max(Math.round(pixels * ratio), 1));
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    const palette = this.readPalette();
    this.renderer.draw(this.scene.things(palette), this.camera, palette);
    this.controls.show(playback);
  }

  /** Position of a place in the picture: to the right and up, from −1 to 1. */
  project(place) {
    const m = this.camera.matrix(this.canvas.clientWidth / this.canvas.clientHeight);
    const row = (i) => dot([m[i], m[i + 4], m[i + 8], m[i + 12]], [...place, 1]);
    return [row(0) / row(3), row(1) / row(3)];
  }

  /** The colours of the style sheet in linear light; CSS has them gamma-encoded. */
  readPalette() {
    const style = getComputedStyle(this.element);
    const color = (name) => {
      const hex = style.getPropertyValue(`--view-${name.replace("_", "-")}`).trim();
      return [1, 3, 5].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255) ** 2.2);
    };
    return Object.fromEntries(COLOR_NAMES.map((name) => [name, color(name)]));
  }

  /** For tests and curious readers. Angles in radians, places in metres. */
  handle() {
    const { playback, camera } = this;
    return {
      select: (choice) => this.select(choice),
      play: () => this.play(),
      pause: () => this.pause(),
      seek: (sample) => this.seek(sample),
      step: (samples) => this.step(samples),
      setSpeed: (speed) => this.setSpeed(speed),
      orbit: (dx, dy) => { camera.orbit(dx, dy); this.changed(); },
      look: (name) => this.look(name),
      render: () => this.render(),
      hands: () => playback.robot.hands(playback.joints()),
      limbs: () => playback.robot.limbs(playback.robot.poses(playback.joints())),
      starts: () => playback.options.start,
      project: (place) => this.project(place),
      state: () => {
        const { choice, all, ghost, loop, sample, playing, speed } = playback;
        const { azimuth, elevation, distance, x, y, z } = camera;
        return { ...choice, all, ghost, loop, sample, playing, speed, azimuth, elevation, distance, x, y, z };
      },
    };
  }
}
