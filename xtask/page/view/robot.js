"use strict";
// Forward kinematics: from joint positions to the poses of all links, in the frame of the first.

class Robot {
  /** `document.robot` of the figure data: links, parents first. */
  constructor({ links, shapes, hands }) {
    Object.assign(this, { links, shapes, handLinks: hands });
  }

  /** The pose of each link at joint positions, radians and metres. */
  poses(joints) {
    const poses = [];
    for (const link of this.links) {
      const parent = link.parent === null ? IDENTITY : poses[link.parent];
      const origin = composed(parent, { rotation: link.rotation, translation: link.translation });
      const position = link.joint === null ? 0 : joints[link.joint];
      poses.push(composed(origin, Robot.moved(link, position)));
    }
    return poses;
  }

  /** Where the left and the right palm are, metres. */
  hands(joints) {
    const poses = this.poses(joints);
    return this.handLinks.map((link) => poses[link].translation);
  }

  /** What a joint adds to its origin. */
  static moved({ motion, axis }, position) {
    if (motion === "turn") return { rotation: rotationAbout(axis, position), translation: [0, 0, 0] };
    if (motion === "slide") return { rotation: IDENTITY.rotation, translation: times(axis, position) };
    return IDENTITY;
  }
}
