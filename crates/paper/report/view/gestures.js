"use strict";
// Control of the camera by mouse, fingers, wheel and keys.

const TURN_PER_PIXEL = 0.008;
const TURN_PER_KEY = 0.12;
const KEYS = {
  ArrowLeft: (camera) => camera.orbit(-TURN_PER_KEY, 0),
  ArrowRight: (camera) => camera.orbit(TURN_PER_KEY, 0),
  ArrowUp: (camera) => camera.orbit(0, TURN_PER_KEY),
  ArrowDown: (camera) => camera.orbit(0, -TURN_PER_KEY),
  "+": (camera) => camera.zoom(1 / 1.15),
  "=": (camera) => camera.zoom(1 / 1.15),
  "-": (camera) => camera.zoom(1.15),
  Home: (camera) => camera.look("start"),
};

/** Position of an event in the picture, from its middle to the right and up in half heights; and the aspect ratio. */
function within(canvas, [x, y]) {
  const { left, top, width, height } = canvas.getBoundingClientRect();
  return { at: [(2 * (x - left) - width) / height, 1 - 2 * (y - top) / height], aspect: width / height };
}

/**
 * Moves the camera when the canvas is dragged, pinched, scrolled or receives keys, then calls `changed`. `pick` finds the
 * place that is visible along a line of sight.
 */
function listen(canvas, camera, pick, changed) {
  listenToPointers(canvas, camera, changed);
  // The wheel scrolls the page until a click or the keyboard focuses the picture.
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : 30);
    const { at, aspect } = within(canvas, [event.clientX, event.clientY]);
    camera.zoom(Math.exp(pixels * (event.ctrlKey ? 0.01 : 0.0015)), at, aspect);
    changed();
  }, { passive: false });
  canvas.addEventListener("dblclick", (event) => {
    const { at, aspect } = within(canvas, [event.clientX, event.clientY]);
    const place = pick(camera.eye(), camera.sight(at, aspect));
    if (place) camera.focus(place);
    changed();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(KEYS, event.key)) return;
    event.preventDefault();
    KEYS[event.key](camera);
    changed();
  });
}

/** One pointer turns, or with the right button or Shift moves the picture; two move it and zoom by their distance. */
function listenToPointers(canvas, camera, changed) {
  const pointers = new Map();
  const middle = () => times([...pointers.values()].reduce(plus, [0, 0]), 1 / pointers.size);
  const spread = () => Math.max(...[...pointers.values()].map((at) => length(minus(at, middle()))), 1);
  canvas.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!pointers.has(event.pointerId)) return;
    const before = { middle: middle(), spread: spread() };
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const [dx, dy] = minus(middle(), before.middle);
    if (pointers.size > 1 || event.shiftKey || event.buttons & 2) {
      const { at, aspect } = within(canvas, middle());
      const half = canvas.clientHeight / 2;
      camera.pan([dx / half, -dy / half], aspect);
      if (pointers.size > 1) camera.zoom(before.spread / spread(), at, aspect);
    } else {
      camera.orbit(-dx * TURN_PER_PIXEL, dy * TURN_PER_PIXEL);
    }
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  }
}
