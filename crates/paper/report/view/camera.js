"use strict";
// A camera that orbits a point, its centre: angles in radians, lengths in metres.

const VIEWS = {
  start: { label: "Reset", azimuth: -0.95, elevation: 0.42 },
  front: { label: "Front", azimuth: 0, elevation: 0.12 },
  side: { label: "Side", azimuth: -Math.PI / 2, elevation: 0.06 },
  top: { label: "Top", azimuth: Math.PI, elevation: Math.PI / 2 },
};
const ANGLE_OF_VIEW = 0.5;
/** A picture narrower than this ratio of width to height is taken from farther away. */
const NARROW = 1.15;
const CENTRE = [0.45, 0, 0.42];
const DISTANCE = { least: 0.35, most: 7 };
/** Each coordinate of the centre stays within this distance of its first value. */
const ASTRAY = 1.5;
/** Largest distance from a place selected for a nearer look. */
const LOOK_AT = 1.3;
/** Factor for the margin around the framed points. */
const MARGIN = 1.05;

class Camera {
  /** Frames these points, metres, in every named view. */
  constructor(points) {
    this.points = points;
    this.look("start");
    this.arrive();
  }

  /** Starts moving to a named view. */
  look(name) {
    const { azimuth, elevation } = VIEWS[name];
    const now = this.azimuth ?? azimuth;
    // The shorter way around.
    const turns = Math.round((now - azimuth) / (2 * Math.PI));
    const distance = this.framing(azimuth, elevation);
    this.goal = { azimuth: azimuth + 2 * Math.PI * turns, elevation, distance, ...Camera.centred(CENTRE) };
  }

  /** Starts moving to a nearer look at a place. */
  focus(place) {
    this.goal = { ...this.goal, ...Camera.centred(place), distance: Math.min(this.goal.distance, LOOK_AT) };
  }

  /** Moves at once to a place in the form that `place` returns. */
  put(place) {
    this.goal = { ...this.goal, ...place };
    this.arrive();
  }

  /** Place of the camera, after any motion: angles, distance, and the centre's coordinates. */
  place() {
    const { azimuth, elevation, distance, x, y, z } = this.goal;
    return { azimuth, elevation, distance, x, y, z };
  }

  /** The centre for a place, clamped to its limits. */
  static centred(place) {
    const [x, y, z] = place.map((value, i) => Math.min(Math.max(value, CENTRE[i] - ASTRAY), CENTRE[i] + ASTRAY));
    return { x, y, z };
  }

  /** The least distance from which all points are in the picture. */
  framing(azimuth, elevation) {
    const { right, up, back } = Camera.axes(azimuth, elevation);
    const slope = Math.tan(ANGLE_OF_VIEW / 2);
    const distances = this.points.map((point) => {
      const from = minus(point, CENTRE);
      const [aside, above] = [Math.abs(dot(from, right)) / NARROW, Math.abs(dot(from, up))];
      return MARGIN * Math.max(aside, above) / slope + dot(from, back);
    });
    return distances.reduce((a, b) => Math.max(a, b), DISTANCE.least);
  }

  /** Orbits by angles, at once. The eye stays above the floor. */
  orbit(azimuth, elevation) {
    const raised = Math.min(Math.max(this.goal.elevation + elevation, 0.02), Math.PI / 2);
    this.goal = { ...this.goal, azimuth: this.goal.azimuth + azimuth, elevation: raised };
    this.arrive();
  }

  /** Moves nearer (factor below 1) or away, at once; the point `at` of the picture, in units of half its height, stays. */
  zoom(factor, at = [0, 0], aspect = 1) {
    const distance = Math.min(Math.max(this.goal.distance * factor, DISTANCE.least), DISTANCE.most);
    const towards = times(this.across(at, aspect), 1 - distance / this.goal.distance);
    this.put({ distance, ...Camera.centred(plus(this.centre(), towards)) });
  }

  /** Shifts the picture at once, in units of half its height. */
  pan(by, aspect) {
    this.put(Camera.centred(minus(this.centre(), this.across(by, aspect))));
  }

  /** The vector from the centre, across the line of sight, to the point at this offset from the middle of the picture. */
  across([aside, above], aspect) {
    const { right, up } = Camera.axes(this.goal.azimuth, this.goal.elevation);
    const half = Math.tan(Camera.angle(aspect) / 2) * this.goal.distance;
    return plus(times(right, aside * half), times(up, above * half));
  }

  /** The unit vector from the eye through a point of the picture. */
  sight(at, aspect) {
    return unit(minus(plus(this.centre(), this.across(at, aspect)), this.eye()));
  }

  arrive() {
    Object.assign(this, this.goal);
  }

  /** Moves towards its goal for this many seconds; returns whether it has not arrived yet. */
  advance(seconds) {
    const share = 1 - Math.exp(-9 * seconds);
    let left = 0;
    for (const name of Object.keys(this.goal)) {
      left = Math.max(left, Math.abs(this.goal[name] - this[name]));
      this[name] += (this.goal[name] - this[name]) * share;
    }
    if (left < 0.002) this.arrive();
    return left >= 0.002;
  }

  /** Unit vectors of a camera at these angles: to its right, up, and from the centre to it. */
  static axes(azimuth, elevation) {
    const [ca, sa] = [Math.cos(azimuth), Math.sin(azimuth)];
    const [ce, se] = [Math.cos(elevation), Math.sin(elevation)];
    return { right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], back: [ce * ca, ce * sa, se] };
  }

  axes() {
    return Camera.axes(this.azimuth, this.elevation);
  }

  centre() {
    return [this.x, this.y, this.z];
  }

  eye() {
    return plus(this.centre(), times(this.axes().back, this.distance));
  }

  /** The vertical angle of view in a picture of this ratio of width to height. */
  static angle(aspect) {
    return 2 * Math.atan(Math.tan(ANGLE_OF_VIEW / 2) * Math.max(1, NARROW / aspect));
  }

  /** The matrix from the world to a picture of this ratio of width to height. */
  matrix(aspect) {
    const { right, up, back } = this.axes();
    return product(perspective(Camera.angle(aspect), aspect, 0.1, 30), worldToViewer(this.eye(), right, up, back));
  }
}
