"use strict";
// The state of the view in the address of the page, so that it can be sent to somebody: "#walk&learner=naive&start=1..".

const PLACE = "#walk";

/** What the address says; nothing where it is not about the view. Numbers that are none are left out. */
function readAddress(hash) {
  const [place, ...rest] = hash.split("&");
  if (place !== PLACE || rest.length === 0) return null;
  const parameters = new URLSearchParams(rest.join("&"));
  const number = (text) => (text !== null && text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : undefined);
  const camera = (parameters.get("camera") ?? "").split(",").map(number);
  const names = ["azimuth", "elevation", "distance", "x", "y", "z"];
  const whole = camera.length === names.length && camera.every((value) => value !== undefined);
  return {
    learner: parameters.get("learner") ?? undefined,
    constraint: parameters.get("constraint") ?? undefined,
    start: number(parameters.get("start")),
    sample: number(parameters.get("sample")),
    camera: whole ? Object.fromEntries(names.map((name, i) => [name, camera[i]])) : undefined,
  };
}

/** The address that says this. */
function writeAddress({ choice: { learner, constraint, start }, sample }, camera) {
  const place = Object.values(camera.place()).map((value) => Number(value.toFixed(3)));
  const parameters = { learner, constraint, start, sample: Number(sample.toFixed(1)), camera: place.join(",") };
  return [PLACE, ...Object.entries(parameters).map(([name, value]) => `${name}=${value}`)].join("&");
}
