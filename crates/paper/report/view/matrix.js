"use strict";
// Poses and matrices. A pose is a rotation (9 numbers, row by row) and a translation; a matrix is 4 by 4, column by
// column, as WebGL takes it. Plain arrays: numbers stay 64 bits wide until they are drawn.

const IDENTITY = { rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: [0, 0, 0] };

const plus = (a, b) => a.map((value, i) => value + b[i]);
const minus = (a, b) => a.map((value, i) => value - b[i]);
const times = (a, factor) => a.map((value) => value * factor);
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => times(a, 1 / length(a));
const mix = (a, b, share) => a.map((value, i) => value + (b[i] - value) * share);

/** The rotated vector. */
const turned = (rotation, v) => [0, 3, 6].map((row) => dot(rotation.slice(row, row + 3), v));

/** The composition of two poses: first the inner, then the outer. */
function composed(outer, inner) {
  const [a, b] = [outer.rotation, inner.rotation];
  const entry = (_, i) => {
    const [row, column] = [3 * Math.floor(i / 3), i % 3];
    return a[row] * b[column] + a[row + 1] * b[column + 3] + a[row + 2] * b[column + 6];
  };
  return { rotation: a.map(entry), translation: plus(turned(a, inner.translation), outer.translation) };
}

/** The rotation about a unit axis by an angle (Rodrigues). */
function rotationAbout([x, y, z], angle) {
  const [s, c] = [Math.sin(angle), Math.cos(angle)];
  const k = 1 - c;
  return [
    c + x * x * k, x * y * k - z * s, x * z * k + y * s,
    y * x * k + z * s, c + y * y * k, y * z * k - x * s,
    z * x * k - y * s, z * y * k + x * s, c + z * z * k,
  ];
}

/** The pose at the middle of two points, with the z axis along the line between them. */
function between(from, to) {
  const along = unit(minus(to, from));
  const aside = unit(cross(Math.abs(along[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], along));
  const columns = [aside, cross(along, aside), along];
  const rotation = [0, 1, 2].flatMap((row) => columns.map((column) => column[row]));
  return { rotation, translation: mix(from, to, 0.5) };
}

/** The pose as a matrix. */
function matrix({ rotation: r, translation: t }) {
  return [r[0], r[3], r[6], 0, r[1], r[4], r[7], 0, r[2], r[5], r[8], 0, t[0], t[1], t[2], 1];
}

/** The matrix of `a` after `b`. */
function product(a, b) {
  const entry = (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[i % 4 + 4 * k] * b[k + 4 * Math.floor(i / 4)], 0);
  return Array.from({ length: 16 }, entry);
}

/** The matrix from the world to a viewer at `eye` who looks along −`back`, with `right` and `up` in the picture. */
function worldToViewer(eye, right, up, back) {
  const rotation = [...right, ...up, ...back];
  return matrix({ rotation, translation: times(turned(rotation, eye), -1) });
}

/** Perspective, with the vertical angle of view in radians. */
function perspective(angle, aspect, near, far) {
  const scale = 1 / Math.tan(angle / 2);
  const depth = 1 / (near - far);
  return [scale / aspect, 0, 0, 0, 0, scale, 0, 0, 0, 0, (near + far) * depth, -1, 0, 0, 2 * near * far * depth, 0];
}

/** Parallel projection of the cube |x|, |y|, |z| ≤ half as a viewer sees it. */
const parallel = (half) => [1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -1 / half, 0, 0, 0, 0, 1];
