"use strict";
// Bodies as triangles. A mesh is a list of vertices, eight numbers each: position, normal, and distance along a path
// (metres, samples); and a list of triangles, counter-clockwise as seen from outside.

class Mesh {
  vertices = [];
  triangles = [];

  get count() {
    return this.vertices.length / 8;
  }

  vertex(position, normal, along = [0, 0]) {
    this.vertices.push(...position, ...normal, ...along);
  }

  /** Adds triangles between rows of vertices, each row a ring, which begin at vertex `first`. */
  rings(first, rows, columns) {
    for (let row = 0; row + 1 < rows; row++) {
      for (let column = 0; column < columns; column++) {
        const next = (column + 1) % columns;
        const [a, b, c, d] = [column, next, columns + column, columns + next].map((i) => first + row * columns + i);
        this.triangles.push(a, b, c, b, d, c);
      }
    }
  }

  /** Closes a ring of vertices around the z axis at height `z`, facing up if it is positive, else down. */
  lid(first, columns, z) {
    const middle = this.count;
    this.vertex([0, 0, z], [0, 0, Math.sign(z)]);
    for (let i = 0; i < columns; i++) {
      const edge = [first + i, first + (i + 1) % columns];
      this.triangles.push(middle, ...(z > 0 ? edge : edge.reverse()));
    }
  }

  /** Adds a body at a pose. */
  add(other, { rotation, translation }) {
    const first = this.count;
    for (let i = 0; i < other.vertices.length; i += 8) {
      const [position, normal] = [other.vertices.slice(i, i + 3), other.vertices.slice(i + 3, i + 6)];
      this.vertex(plus(turned(rotation, position), translation), turned(rotation, normal));
    }
    for (const vertex of other.triangles) this.triangles.push(first + vertex);
  }
}

/**
 * A box with rounded edges and this half size. It is a sphere whose eight octants are pulled apart: vertices between
 * octants are duplicated, and the flat faces open between them.
 */
function roundedBox(half, radius, steps) {
  const mesh = new Mesh();
  const inner = half.map((extent) => extent - radius);
  const angles = (quarters, first) => Array.from({ length: quarters * (steps + 1) }, (_, i) => {
    const quarter = Math.floor(i / (steps + 1));
    return (first + quarter + (i - quarter * (steps + 1)) / steps) * Math.PI / 2;
  });
  const [rows, columns] = [angles(2, -1), angles(4, 0)];
  rows.forEach((latitude, row) => columns.forEach((longitude, column) => {
    const quarter = Math.floor(column / (steps + 1));
    const octant = [quarter % 3 === 0 ? 1 : -1, quarter < 2 ? 1 : -1, row > steps ? 1 : -1];
    const around = Math.cos(latitude);
    const normal = [around * Math.cos(longitude), around * Math.sin(longitude), Math.sin(latitude)];
    mesh.vertex(normal.map((n, i) => octant[i] * inner[i] + n * radius), normal);
  }));
  mesh.rings(0, rows.length, columns.length);
  mesh.lid(0, columns.length, -half[2]);
  mesh.lid((rows.length - 1) * columns.length, columns.length, half[2]);
  return mesh;
}

const sphere = (radius) => roundedBox([radius, radius, radius], radius, 14);

/** A box of this size; edges are rounded a little, which catches the light. */
function box(size) {
  const half = times(size, 0.5);
  return roundedBox(half, Math.min(0.012, 0.3 * Math.min(...half)), 3);
}

/** A cylinder along z. */
function cylinder(radius, length) {
  const [mesh, sides, end] = [new Mesh(), 40, length / 2];
  for (const [z, out, up] of [[-end, 0, -1], [-end, 1, 0], [end, 1, 0], [end, 0, 1]]) {
    for (let i = 0; i < sides; i++) {
      const [x, y] = [Math.cos(2 * Math.PI * i / sides), Math.sin(2 * Math.PI * i / sides)];
      mesh.vertex([radius * x, radius * y, z], [out * x, out * y, up]);
    }
  }
  mesh.rings(0, 4, sides);
  mesh.lid(0, sides, -end);
  mesh.lid(3 * sides, sides, end);
  return mesh;
}

/** A cylinder along z with a half ball at either end. */
function capsule(radius, length) {
  const mesh = new Mesh();
  mesh.add(cylinder(radius, length), IDENTITY);
  for (const end of [-length / 2, length / 2]) {
    mesh.add(sphere(radius), { rotation: IDENTITY.rotation, translation: [0, 0, end] });
  }
  return mesh;
}

/** The mesh of a shape of the figure data, as in the robot's URDF. */
function primitive({ kind, size }) {
  if (kind === "sphere") return sphere(size[0]);
  return kind === "cylinder" ? cylinder(size[0], size[1]) : box(size);
}

/** A square in the plane z = 0. */
function square(half) {
  const mesh = new Mesh();
  for (const [x, y] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) mesh.vertex([x * half, y * half, 0], [0, 0, 1]);
  mesh.triangles.push(0, 1, 2, 0, 2, 3);
  return mesh;
}

/** A tube along points, one per sample. */
function tube(points, radius) {
  const [mesh, sides] = [new Mesh(), 10];
  const stops = apart(points, 0.001);
  let far = 0;
  let across = [0, 0, 1];
  stops.forEach(({ point, sample }, i) => {
    const [before, after] = [stops[Math.max(i - 1, 0)].point, stops[Math.min(i + 1, stops.length - 1)].point];
    far += length(minus(point, before));
    const along = stops.length > 1 ? unit(minus(after, before)) : [1, 0, 0];
    // A ring's first direction is the previous ring's, projected across the path, so that the tube is not twisted.
    across = minus(across, times(along, dot(across, along)));
    across = length(across) > 1e-6 ? unit(across) : unit(cross(along, [0.3, 0.9, 0.1]));
    const aside = cross(along, across);
    for (let k = 0; k < sides; k++) {
      const angle = 2 * Math.PI * k / sides;
      const normal = plus(times(across, Math.cos(angle)), times(aside, Math.sin(angle)));
      mesh.vertex(plus(point, times(normal, radius)), normal, [far, sample]);
    }
  });
  mesh.rings(0, stops.length, sides);
  return mesh;
}

/** Points with their indices, without those nearer than `least` to the last point kept. */
function apart(points, least) {
  const stops = [];
  points.forEach((point, sample) => {
    if (sample === 0 || length(minus(point, stops.at(-1).point)) >= least) stops.push({ point, sample });
  });
  return stops;
}
