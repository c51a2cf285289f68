"use strict";
// The things in the picture: fixed ones, those that change with the choice, and moving ones.

/** Dash pattern of each learner's path: metres from dash to dash, and the share that is drawn. As in the figures. */
const DASHES = { expert: [1, 1], naive: [0.016, 0.5], policy_align: [0.045, 0.66], slope_gp: [1, 1] };
const PATH_RADIUS = 0.0055;
const PLATE_THICKNESS = 0.008;
const GHOST = 0.22;

class Scene {
  constructor(renderer, playback) {
    this.renderer = renderer;
    this.playback = playback;
    const upload = (mesh) => renderer.upload(mesh);
    const { robot, document: { scene } } = playback;
    this.scene = scene;
    this.floor = upload(square(3));
    this.table = upload(Scene.tableMesh(scene));
    this.ball = upload(sphere(scene.ball.diameter / 2));
    this.dot = upload(sphere(0.011));
    this.links = robot.links.map((_, link) => {
      const shapes = robot.shapes.filter((shape) => shape.link === link);
      if (shapes.length === 0) return null;
      const mesh = new Mesh();
      for (const shape of shapes) mesh.add(primitive(shape), shape);
      return upload(mesh);
    });
    const { bone, radius } = robot.legs;
    this.bone = upload(capsule(radius, bone));
    this.eye = upload(sphere(robot.eye.radius));
    this.head = robot.links.findIndex(({ name }) => name === "head");
    this.extent = this.corners();
    // A palm is a point; the hand around it is the nearest ancestor link with a body.
    this.handLinks = robot.handLinks.map((link) => {
      while (!this.links[link]) link = robot.links[link].parent;
      return link;
    });
    this.chosen = { meshes: [] };
  }

  /** Points that enclose the scene: table, plates, and the robot at its start, metres. */
  corners() {
    const { playback: { robot, document: { movements } }, scene: { table, wall, stage } } = this;
    const box = ([x, y, z], [far, left, top]) => [x, far].flatMap((a) => [y, left].flatMap((b) => [z, top].map((c) => [a, b, c])));
    const side = table.half_width;
    const poses = robot.poses(movements[0].joints[0]);
    const bodies = robot.shapes.flatMap((shape) => {
      const { vertices } = primitive(shape);
      const { rotation, translation } = composed(poses[shape.link], shape);
      const corners = Array.from({ length: vertices.length / 8 }, (_, i) => vertices.slice(8 * i, 8 * i + 3));
      return corners.map((corner) => plus(turned(rotation, corner), translation));
    });
    return [
      ...box([table.near, -side, 0], [table.far, side, table.top]),
      ...box([wall.x - wall.reach, -side, 0], [wall.x + wall.reach, side, stage.plate_top]),
      ...bodies,
    ];
  }

  /** Builds the plates and paths of a choice. */
  choose() {
    this.chosen.meshes.forEach((mesh) => this.renderer.forget(mesh));
    const meshes = [];
    const upload = (mesh) => {
      meshes.push(this.renderer.upload(mesh));
      return meshes.at(-1);
    };
    const { playback } = this;
    const plates = playback.movement().plates.map((plate) => {
      const [plain, zone, edges] = Scene.plateMeshes(plate, this.scene).map(upload);
      return { plain, zone, edges };
    });
    const paths = playback.learners.flatMap((learner) => [0, 3].map((hand) => {
      const points = playback.movement(learner).palms.map((row) => row.slice(hand, hand + 3));
      return { learner, mesh: upload(tube(points, PATH_RADIUS)) };
    }));
    this.chosen = { meshes, plates, paths };
  }

  /** All things at the current time. */
  things(palette) {
    return [
      { mesh: this.floor, color: palette.floor, kind: KIND.floor, shadow: false },
      { mesh: this.table, color: palette.table },
      { mesh: this.ball, pose: Scene.at(this.scene.ball.centre), color: palette.ball },
      ...this.robotThings(palette),
      ...this.pathThings(palette),
      ...this.plateThings(palette),
    ];
  }

  robotThings(palette) {
    const { playback, playback: { choice: { learner } } } = this;
    const shown = this.bodies(playback.joints(), (hand) => (hand ? palette[learner] : palette.robot), palette.eye);
    if (!playback.ghost || learner === "expert") return shown;
    const ghost = this.bodies(playback.joints("expert"), () => palette.expert, palette.eye);
    return [...shown, ...ghost.map((thing) => ({ ...thing, opacity: GHOST, shadow: false }))];
  }

  /** The robot in one posture. */
  bodies(joints, color, eye) {
    const { robot } = this.playback;
    const poses = robot.poses(joints);
    const links = this.links.map((mesh, link) => ({ mesh, pose: poses[link], color: color(this.handLinks.includes(link)) }));
    const bones = robot.limbs(poses).flatMap(([ankle, knee, hip]) => [between(ankle, knee), between(knee, hip)]);
    const legs = bones.map((pose) => ({ mesh: this.bone, pose, color: color(false) }));
    const eyes = this.eyes().map((at) => ({ mesh: this.eye, pose: composed(poses[this.head], Scene.at(at)), color: eye, shadow: false }));
    return [...links.filter(({ mesh }) => mesh), ...legs, ...eyes];
  }

  /** Positions of the eyes in the frame of the head. */
  eyes() {
    const skull = this.playback.robot.shapes.find(({ link, kind }) => link === this.head && kind === "sphere");
    if (!skull) return [];
    const { radius, aside, up } = this.playback.robot.eye;
    const [out, level] = [skull.size[0] - radius / 3, Math.cos(up)];
    return [-aside, aside].map((turn) => (
      plus(skull.translation, times([level * Math.cos(turn), level * Math.sin(turn), Math.sin(up)], out))
    ));
  }

  /** The first place along a line of sight: the centre of the ball or of a body of the robot, a point of the table top or the floor. */
  pick(eye, sight) {
    const { playback: { robot }, scene: { ball, table } } = this;
    const poses = robot.poses(this.playback.joints());
    const round = robot.shapes.map((shape) => ({
      centre: plus(turned(poses[shape.link].rotation, shape.translation), poses[shape.link].translation),
      radius: Math.max(...shape.size) / (shape.kind === "sphere" ? 1 : 2),
    }));
    const hits = [{ centre: ball.centre, radius: ball.diameter / 2 }, ...round].flatMap(({ centre, radius }) => {
      const along = dot(minus(centre, eye), sight);
      return along > 0 && length(minus(plus(eye, times(sight, along)), centre)) < radius ? [{ along, place: centre }] : [];
    });
    for (const height of [table.top, 0]) {
      const along = (height - eye[2]) / sight[2];
      const place = plus(eye, times(sight, along));
      const there = height === 0 || (place[0] > table.near && place[0] < table.far && Math.abs(place[1]) < table.half_width);
      if (along > 0 && there) hits.push({ along, place });
    }
    return hits.sort((a, b) => a.along - b.along)[0]?.place;
  }

  /**
   * Each path, faint through all bodies, and solid up to the current time; dots at each learner's palms and at their
   * targets.
   */
  pathThings(palette) {
    const { playback } = this;
    const dot = (place, color) => ({ mesh: this.dot, pose: Scene.at(place), color, shadow: false });
    const target = playback.document.scene.target;
    const dots = playback.learners.flatMap((learner) => playback.palms(learner).map((at) => dot(at, palette[learner])));
    const paths = this.chosen.paths.flatMap(({ learner, mesh }) => {
      const look = { color: palette[learner], dash: DASHES[learner], kind: KIND.path, shadow: false };
      const path = { ...look, mesh, now: playback.sample };
      return [path, { ...path, opacity: 0.25, through: true }];
    });
    return [dot(target.slice(0, 3), palette.target), dot(target.slice(3), palette.target), ...dots, ...paths];
  }

  plateThings(palette) {
    const look = { color: palette.plate, shadow: false };
    return this.chosen.plates.flatMap(({ plain, zone, edges }) => [
      { ...look, mesh: edges },
      { ...look, mesh: zone, opacity: 0.07 },
      { ...look, mesh: plain, opacity: 0.3 },
    ]);
  }

  static at(translation) {
    return { rotation: IDENTITY.rotation, translation };
  }

  /** A table top on four legs, flush with its corners. */
  static tableMesh({ table: { top, near, far, half_width: side }, stage: { board: thick, leg } }) {
    const mesh = new Mesh();
    mesh.add(box([far - near, 2 * side, thick]), Scene.at([(near + far) / 2, 0, top - thick / 2]));
    const high = top - thick;
    for (const x of [near + leg / 2, far - leg / 2]) {
      for (const y of [leg / 2 - side, side - leg / 2]) mesh.add(box([leg, leg, high]), Scene.at([x, y, high / 2]));
    }
    return mesh;
  }

  /** A plate, the space in which it acts, and its edges. An open end (null) ends with the table and has no edge. */
  static plateMeshes([from, to], { wall, table, stage: { plate_top: top } }) {
    const side = table.half_width;
    const [left, right] = [from ?? -side, to ?? side];
    const slab = (thickness) => {
      const mesh = new Mesh();
      mesh.add(box([thickness, right - left, top]), Scene.at([wall.x, (left + right) / 2, top / 2]));
      return mesh;
    };
    const [edges, bar] = [new Mesh(), 1.6 * PLATE_THICKNESS];
    edges.add(box([bar, right - left, bar]), Scene.at([wall.x, (left + right) / 2, top]));
    for (const y of [from, to].filter((end) => end !== null)) {
      edges.add(box([bar, bar, top]), Scene.at([wall.x, y, top / 2]));
    }
    return [slab(PLATE_THICKNESS), slab(2 * wall.reach), edges];
  }
}
