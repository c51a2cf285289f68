"use strict";
// The state of the view in the address of the page, so that it can be shared: "#walk&learner=naive&start=1..".

const PLACE = "#walk";

/** Parses an address; `null` if it does not concern the view. Invalid numbers are left out. */
function readAddress(hash) {
  const [place, ...rest] = hash.split("&");
  if (place !== PLACE || rest.length === 0) return null;
  const parameters = new URLSearchParams(rest.join("&"));
  const number = (text) => (text !== null && text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : undefined);
  const flag = (text) => ({ yes: true, no: false })[text];
  const camera = (parameters.get("camera") ?? "").split(",").map(number);
  const names = ["azimuth", "elevation", "distance", "x", "y", "z"];
  const whole = camera.length === names.length && camera.every((value) => value !== undefined);
  return {
    learner: parameters.get("learner") ?? undefined,
    constraint: parameters.get("constraint") ?? undefined,
    start: number(parameters.get("start")),
    sample: number(parameters.get("sample")),
    speed: number(parameters.get("speed")),
    all: flag(parameters.get("all")),
    ghost: flag(parameters.get("ghost")),
    loop: flag(parameters.get("loop")),
    camera: whole ? Object.fromEntries(names.map((name, i) => [name, camera[i]])) : undefined,
  };
}

/** The address with this state. */
function writeAddress({ choice: { learner, constraint, start }, sample, speed, all, ghost, loop }, camera) {
  const place = Object.values(camera.place()).map((value) => Number(value.toFixed(3)));
  const flag = (value) => (value ? "yes" : "no");
  const flags = { all: flag(all), ghost: flag(ghost), loop: flag(loop) };
  const parameters = { learner, constraint, start, sample: Number(sample.toFixed(1)), speed, ...flags, camera: place.join(",") };
  return [PLACE, ...Object.entries(parameters).map(([name, value]) => `${name}=${value}`)].join("&");
}
