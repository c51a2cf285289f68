"use strict";
// The state of the view in the address of the page, so that it can be sent to somebody: "#walk&learner=naive&start=1..".

const PLACE = "#walk";

/** What the address says; nothing where it is not about the view. Numbers that are none are left out. */
function readAddress(hash) {
  const [place, ...rest] = hash.split("&");
  if (place !== PLACE || rest.length === 0) return null;
  const told = new URLSearchParams(rest.join("&"));
  const number = (text) => (text !== null && text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : undefined);
  const flag = (text) => ({ yes: true, no: false })[text];
  const camera = (told.get("camera") ?? "").split(",").map(number);
  const names = ["azimuth", "elevation", "distance", "x", "y", "z"];
  const whole = camera.length === names.length && camera.every((value) => value !== undefined);
  return {
    learner: told.get("learner") ?? undefined,
    constraint: told.get("constraint") ?? undefined,
    start: number(told.get("start")),
    sample: number(told.get("sample")),
    speed: number(told.get("speed")),
    all: flag(told.get("all")),
    ghost: flag(told.get("ghost")),
    loop: flag(told.get("loop")),
    camera: whole ? Object.fromEntries(names.map((name, i) => [name, camera[i]])) : undefined,
  };
}

/** The address that says this. */
function writeAddress({ choice: { learner, constraint, start }, sample, speed, all, ghost, loop }, camera) {
  const place = Object.values(camera.place()).map((value) => Number(value.toFixed(3)));
  const flag = (value) => (value ? "yes" : "no");
  const flags = { all: flag(all), ghost: flag(ghost), loop: flag(loop) };
  const told = { learner, constraint, start, sample: Number(sample.toFixed(1)), speed, ...flags, camera: place.join(",") };
  return [PLACE, ...Object.entries(told).map(([name, value]) => `${name}=${value}`)].join("&");
}
