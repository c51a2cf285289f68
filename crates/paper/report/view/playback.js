"use strict";
// The movement shown and its current time, independent of drawing.

/** Rows of positions from their steps, which are stored as integer multiples of 1 / `parts`. */
function rows(steps, parts) {
  const sum = steps[0].map(() => 0);
  return steps.map((step) => step.map((by, k) => (sum[k] += by) / parts));
}

/** A hand slower than this is at rest, metres per second. */
const AT_REST = 0.001;
/** Palms are in the middle of hands 3.5 cm thick. Deeper than this, a palm goes through the ball, metres. */
const DEEP = 0.01;

class Playback {
  constructor(document) {
    this.document = document;
    for (const movement of document.movements) {
      movement.joints = rows(movement.joints, document.parts);
      movement.palms = rows(movement.palms, document.parts);
    }
    this.robot = new Robot(document.robot);
    const ids = (options) => options.map(({ id }) => id);
    this.options = {
      learner: ids(document.learners),
      constraint: ids(document.constraints),
      start: document.starts,
    };
    // The most instructive choice: the obstacle in no demonstration, which stops the naive learner's hands.
    const { learner, constraint } = this.options;
    const unseen = constraint.includes("obstacle") ? "obstacle" : constraint[0];
    this.choice = { learner: learner.at(-1), constraint: unseen, start: document.starts[0] };
    this.all = true;
    this.ghost = false;
    this.loop = false;
    this.courses = new Map();
    this.speed = 5;
    this.playing = false;
    // Starts with the last picture, the most informative one: hands at the ball, with their paths.
    this.sample = this.lastSample;
  }

  /** Changes learner, constraint or start; "all" shows all learners' paths, "ghost" also the expert's robot. */
  select({ all = this.all, ghost = this.ghost, loop = this.loop, ...choice }) {
    if (choice.learner === "all") {
      all = true;
      delete choice.learner;
    }
    for (const [name, value] of Object.entries(choice)) {
      if (!this.options[name]?.includes(value)) throw new RangeError(`no ${name} is called ${value}`);
    }
    Object.assign(this.choice, choice);
    Object.assign(this, { all, ghost, loop });
  }

  /** The movement chosen, or that of another learner from the same start. */
  movement(learner = this.choice.learner) {
    const wanted = { ...this.choice, learner };
    const names = Object.keys(wanted);
    return this.document.movements.find((movement) => names.every((name) => movement[name] === wanted[name]));
  }

  /** The learners whose paths are shown. */
  get learners() {
    return this.all ? this.options.learner : [this.choice.learner];
  }

  get lastSample() {
    return this.movement().joints.length - 1;
  }

  /** Starts playing, from the beginning if at the end. */
  play() {
    if (this.sample >= this.lastSample) this.sample = 0;
    this.playing = true;
  }

  pause() {
    this.playing = false;
  }

  seek(sample) {
    this.sample = Math.min(Math.max(sample, 0), this.lastSample);
  }

  /** Advances by this many seconds of real time. */
  advance(seconds) {
    this.seek(this.sample + seconds * this.speed / this.document.time_step);
    if (this.sample < this.lastSample) return;
    if (this.loop) this.sample = 0;
    else this.pause();
  }

  /** A row of a movement at a time, linearly interpolated between samples. */
  static at(rows, sample) {
    const before = Math.floor(sample);
    return mix(rows[before], rows[Math.min(before + 1, rows.length - 1)], sample - before);
  }

  /** Joint positions of the robot, or those that another learner would give it, at a sample. */
  joints(learner = this.choice.learner, sample = this.sample) {
    return Playback.at(this.movement(learner).joints, sample);
  }

  /** Positions of the palms in a learner's policy, left and right, metres. */
  palms(learner, sample = this.sample) {
    const row = Playback.at(this.movement(learner).palms, sample);
    return [row.slice(0, 3), row.slice(3)];
  }

  /** Distances of the robot's palms from their places at the ball, left and right, metres. */
  distances(learner, sample) {
    return this.toPlaces(this.robot.hands(this.joints(learner, sample)));
  }

  /** Distances of the robot's palms at every sample, one row each; left and right, metres. */
  course(learner) {
    const name = [this.choice.constraint, this.choice.start, learner].join();
    if (!this.courses.has(name)) {
      const course = this.movement(learner).joints.map((joints) => this.toPlaces(this.robot.hands(joints)));
      this.courses.set(name, course);
    }
    return this.courses.get(name);
  }

  /** Whether a plate holds each hand at the end of a movement: at rest before the plate, within its reach. */
  held(learner) {
    const { palms, plates } = this.movement(learner);
    const { wall, target } = this.document.scene;
    return [0, 3].map((hand) => {
      const [before, [x, y, z]] = palms.slice(-2).map((row) => row.slice(hand, hand + 3));
      const behind = plates.some(([from, to]) => y >= (from ?? -Infinity) && y <= (to ?? Infinity));
      const rests = length(minus([x, y, z], before)) < AT_REST * this.document.time_step;
      return x < wall.x && wall.x - x < wall.reach + 0.01 && target[hand] > wall.x && behind && rests;
    });
  }

  /** Number of samples with a palm of the robot within the ball, deeper than `DEEP`. */
  withinBall(learner) {
    const { centre, diameter } = this.document.scene.ball;
    const inside = (palm) => length(minus(palm, centre)) < diameter / 2 - DEEP;
    return this.movement(learner).joints.filter((joints) => this.robot.hands(joints).some(inside)).length;
  }

  /** Distances of the palms if the joints could follow the policy. */
  wantedDistances(learner, sample) {
    return this.toPlaces(this.palms(learner, sample));
  }

  toPlaces(palms) {
    const { target } = this.document.scene;
    return palms.map((palm, i) => length(minus(palm, target.slice(3 * i, 3 * i + 3))));
  }
}
