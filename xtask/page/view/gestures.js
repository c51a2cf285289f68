"use strict";
// How a hand moves the camera: mouse, fingers, wheel and keys.

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

/** Moves the camera as the canvas is dragged, pinched, scrolled and typed at; then calls `changed`. */
function listen(canvas, camera, changed) {
  listenToPointers(canvas, camera, changed);
  // The page keeps the wheel until the picture is asked for by a click or the keyboard.
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? 1 : 30);
    camera.zoom(Math.exp(pixels * (event.ctrlKey ? 0.01 : 0.0015)));
    changed();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(KEYS, event.key)) return;
    event.preventDefault();
    KEYS[event.key](camera);
    changed();
  });
}

/** One pointer turns; two turn by their middle and zoom by their distance. */
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
    camera.orbit(-dx * TURN_PER_PIXEL, dy * TURN_PER_PIXEL);
    if (pointers.size > 1) camera.zoom(before.spread / spread());
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  }
}
