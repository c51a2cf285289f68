"use strict";
// Which movement is shown, and where in time it is. Knows nothing of drawing.

/** Rows of positions from their steps, which are written in whole parts of a unit. */
function rows(steps, parts) {
  const sum = steps[0].map(() => 0);
  return steps.map((step) => step.map((by, k) => (sum[k] += by) / parts));
}

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
      start: Array.from({ length: document.starts }, (_, i) => i),
    };
    // What shows the point: the obstacle that no demonstration shows, which stops the naive learner's hands.
    const { learner, constraint } = this.options;
    const unseen = constraint.includes("obstacle") ? "obstacle" : constraint[0];
    this.choice = { learner: learner.at(-1), constraint: unseen, start: 0 };
    this.all = true;
    this.speed = 5;
    this.playing = false;
    // The last picture says most: hands at the ball, their paths behind them.
    this.sample = this.lastSample;
  }

  /** Changes some of learner, constraint, start; the learner "all" shows everybody's paths. */
  select({ all = this.all, ...choice }) {
    if (choice.learner === "all") {
      all = true;
      delete choice.learner;
    }
    for (const [name, value] of Object.entries(choice)) {
      if (!this.options[name]?.includes(value)) throw new RangeError(`no ${name} is called ${value}`);
    }
    Object.assign(this.choice, choice);
    this.all = all;
  }

  /** The movement chosen, or that of another learner from the same start. */
  movement(learner = this.choice.learner) {
    const wanted = { ...this.choice, learner };
    const names = Object.keys(wanted);
    return this.document.movements.find((movement) => names.every((name) => movement[name] === wanted[name]));
  }

  /** Whose paths are shown. */
  get learners() {
    return this.all ? this.options.learner : [this.choice.learner];
  }

  get lastSample() {
    return this.movement().joints.length - 1;
  }

  /** Starts; at the end, from the beginning. */
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

  /** So many seconds go by in front of the screen. */
  advance(seconds) {
    this.seek(this.sample + seconds * this.speed / this.document.time_step);
    if (this.sample === this.lastSample) this.pause();
  }

  /** A row of a movement at a time, between samples on a straight line. */
  static at(rows, sample) {
    const before = Math.floor(sample);
    return mix(rows[before], rows[Math.min(before + 1, rows.length - 1)], sample - before);
  }

  /** Joint positions of the robot, or those that another learner would give it, at a sample. */
  joints(learner = this.choice.learner, sample = this.sample) {
    return Playback.at(this.movement(learner).joints, sample);
  }

  /** Where a learner's policy wants the palms, left and right, metres. */
  palms(learner, sample = this.sample) {
    const row = Playback.at(this.movement(learner).palms, sample);
    return [row.slice(0, 3), row.slice(3)];
  }

  /** How far the robot's palms are from their places at the ball, left and right, metres. */
  distances(learner, sample) {
    return this.toPlaces(this.robot.hands(this.joints(learner, sample)));
  }

  /** How far they would be if its joints could follow. */
  wantedDistances(learner, sample) {
    return this.toPlaces(this.palms(learner, sample));
  }

  toPlaces(palms) {
    const { target } = this.document.scene;
    return palms.map((palm, i) => length(minus(palm, target.slice(3 * i, 3 * i + 3))));
  }
}
