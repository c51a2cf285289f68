"use strict";
// Forward kinematics: from joint positions to the poses of all links, in the frame of the first. Legs are only
// drawn: hips move with the trunk, feet stand still.

class Robot {
  /** `document.robot` of the figure data: links, parents first; `legs` and `eye`, which the page adds. */
  constructor({ links, shapes, hands, legs, eye }) {
    Object.assign(this, { links, shapes, handLinks: hands, legs, eye });
    const { rotation, translation } = this.poses([])[legs.trunk];
    // Hips in the trunk's frame, which is not turned while all joints are at 0.
    if (rotation.some((value, i) => value !== IDENTITY.rotation[i])) throw new Error("the trunk is turned at rest");
    this.hips = legs.hips.map((hip) => minus(hip, translation));
  }

  /** The pose of each link at joint positions, radians and metres. */
  poses(joints) {
    const poses = [];
    for (const link of this.links) {
      const parent = link.parent === null ? IDENTITY : poses[link.parent];
      const origin = composed(parent, { rotation: link.rotation, translation: link.translation });
      const position = joints[link.joint] ?? 0;
      poses.push(composed(origin, Robot.moved(link, position)));
    }
    return poses;
  }

  /** Positions of the left and the right palm, metres. */
  hands(joints) {
    const poses = this.poses(joints);
    return this.handLinks.map((link) => poses[link].translation);
  }

  /** Ankle, knee and hip of the left leg and of the right one, metres. */
  limbs(poses) {
    const { rotation, translation } = poses[this.legs.trunk];
    return this.hips.map((at, side) => {
      const [hip, ankle] = [plus(turned(rotation, at), translation), this.legs.ankles[side]];
      return [ankle, Robot.knee(hip, ankle, this.legs.bone), hip];
    });
  }

  /** The knee between equally long bones, in front of the line from hip to ankle; on it if they are too short. */
  static knee(hip, ankle, bone) {
    const down = minus(ankle, hip);
    const along = unit(down);
    const forward = unit(minus([1, 0, 0], times(along, along[0])));
    const bend = Math.sqrt(Math.max(bone ** 2 - dot(down, down) / 4, 0));
    return plus(mix(hip, ankle, 0.5), times(forward, bend));
  }

  /** The pose of a joint's link relative to the joint's origin. */
  static moved({ motion, axis }, position) {
    if (motion === "turn") return { rotation: rotationAbout(axis, position), translation: [0, 0, 0] };
    if (motion === "slide") return { rotation: IDENTITY.rotation, translation: times(axis, position) };
    return IDENTITY;
  }
}
