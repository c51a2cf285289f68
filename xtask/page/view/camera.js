"use strict";
// A camera that goes around a point: angles in radians, distance in metres.

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
const DISTANCE = { least: 0.7, most: 7 };
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
    this.goal = { azimuth: azimuth + 2 * Math.PI * turns, elevation, distance: this.framing(azimuth, elevation) };
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

  /** Goes nearer (factor below 1) or away, at once. */
  zoom(factor) {
    const distance = Math.min(Math.max(this.goal.distance * factor, DISTANCE.least), DISTANCE.most);
    this.goal = { ...this.goal, distance };
    this.arrive();
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

  eye() {
    return plus(CENTRE, times(this.axes().back, this.distance));
  }

  /** From the world to a picture of this ratio of width to height. */
  matrix(aspect) {
    const { right, up, back } = this.axes();
    const angle = 2 * Math.atan(Math.tan(ANGLE_OF_VIEW / 2) * Math.max(1, NARROW / aspect));
    return product(perspective(angle, aspect, 0.1, 30), worldToViewer(this.eye(), right, up, back));
  }
}
