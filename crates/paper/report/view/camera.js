"use strict";
// A camera that goes around a point, its centre: angles in radians, lengths in metres.

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
/** The centre stays within this of where it is at first. */
const ASTRAY = 1.5;
/** So near one looks at a thing that was asked for. */
const LOOK_AT = 1.3;
/** Room around what is framed. */
const MARGIN = 1.05;

class Camera {
  /** Frames these points, metres, in every named view. */
  constructor(points) {
    this.points = points;
    this.look("start");
    this.arrive();
  }

  /** Sets out for a named view. */
  look(name) {
    const { azimuth, elevation } = VIEWS[name];
    const now = this.azimuth ?? azimuth;
    // The shorter way around.
    const turns = Math.round((now - azimuth) / (2 * Math.PI));
    const distance = this.framing(azimuth, elevation);
    this.goal = { azimuth: azimuth + 2 * Math.PI * turns, elevation, distance, ...Camera.centred(CENTRE) };
  }

  /** Sets out for a nearer look at a place. */
  focus(place) {
    this.goal = { ...this.goal, ...Camera.centred(place), distance: Math.min(this.goal.distance, LOOK_AT) };
  }

  /** Where it should be, as `place` tells it, at once. */
  put(place) {
    this.goal = { ...this.goal, ...place };
    this.arrive();
  }

  /** All that says where it is: angles, distance, and the centre's coordinates. */
  place() {
    const { azimuth, elevation, distance, x, y, z } = this.goal;
    return { azimuth, elevation, distance, x, y, z };
  }

  /** A centre, which does not go astray. */
  static centred(place) {
    const [x, y, z] = place.map((value, i) => Math.min(Math.max(value, CENTRE[i] - ASTRAY), CENTRE[i] + ASTRAY));
    return { x, y, z };
  }

  /** The least distance from which all is in the picture. */
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

  /** Goes around by angles, at once. The eye stays above the floor. */
  orbit(azimuth, elevation) {
    const raised = Math.min(Math.max(this.goal.elevation + elevation, 0.02), Math.PI / 2);
    this.goal = { ...this.goal, azimuth: this.goal.azimuth + azimuth, elevation: raised };
    this.arrive();
  }

  /** Goes nearer (factor below 1) or away, at once; what is at `at` in the picture, −1 to 1 of half its height, stays there. */
  zoom(factor, at = [0, 0], aspect = 1) {
    const distance = Math.min(Math.max(this.goal.distance * factor, DISTANCE.least), DISTANCE.most);
    const towards = times(this.across(at, aspect), 1 - distance / this.goal.distance);
    this.put({ distance, ...Camera.centred(plus(this.centre(), towards)) });
  }

  /** Moves what is seen by a part of half the picture's height, at once. */
  pan(by, aspect) {
    this.put(Camera.centred(minus(this.centre(), this.across(by, aspect))));
  }

  /** From the centre, across the line of sight, to what is this far from the middle of the picture. */
  across([aside, above], aspect) {
    const { right, up } = Camera.axes(this.goal.azimuth, this.goal.elevation);
    const half = Math.tan(Camera.angle(aspect) / 2) * this.goal.distance;
    return plus(times(right, aside * half), times(up, above * half));
  }

  /** From the eye through a place of the picture, of length 1. */
  sight(at, aspect) {
    return unit(minus(plus(this.centre(), this.across(at, aspect)), this.eye()));
  }

  arrive() {
    Object.assign(this, this.goal);
  }

  /** Moves towards its goal for so many seconds; whether it has still some way to go. */
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

  /** Of a camera there, unit vectors to its right, up, and from the centre to it. */
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

  /** From the world to a picture of this ratio of width to height. */
  matrix(aspect) {
    const { right, up, back } = this.axes();
    return product(perspective(Camera.angle(aspect), aspect, 0.1, 30), worldToViewer(this.eye(), right, up, back));
  }
}
