"use strict";
// Draws a list of things into a canvas: first their depths as seen from the sun, for the shadows, then opaque things,
// then transparent ones.

const SHADOW_PIXELS = 1024;
const SHADOW_CENTRE = [0.4, 0, 0.5];
const SHADOW_REACH = 1.6;
const SUN = unit([0.35, -0.45, 1]);

class Renderer {
  /** Throws without WebGL 2. */
  constructor(canvas) {
    // The buffer is kept so that the picture can be printed, copied and tested.
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("this browser offers no WebGL 2");
    this.gl = gl;
    this.canvas = canvas;
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    this.program = this.linked(VERTEX, FRAGMENT);
    this.depths = this.linked(VERTEX, DEPTH_FRAGMENT);
    this.shadows = this.shadowMap();
    this.sunlight = Renderer.sunlight();
  }

  /** Uploads a mesh to the graphics processor. */
  upload(mesh) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    const buffers = [gl.createBuffer(), gl.createBuffer()];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[0]);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(mesh.vertices), gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(mesh.triangles), gl.STATIC_DRAW);
    [[3, 0], [3, 12], [2, 24]].forEach(([numbers, offset], location) => {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, numbers, gl.FLOAT, false, 32, offset);
    });
    return { array, buffers, count: mesh.triangles.length };
  }

  /** Frees the memory of a mesh. */
  forget({ array, buffers }) {
    this.gl.deleteVertexArray(array);
    buffers.forEach((buffer) => this.gl.deleteBuffer(buffer));
  }

  /**
   * Draws things: `{ mesh, pose, color, opacity, kind, dash, now, shadow, through }`, of which all but mesh and
   * color have defaults. `light` is the palette: background, sky, ground, grid.
   */
  draw(things, camera, light) {
    this.drawDepths(things.filter(({ shadow = true }) => shadow));
    const { gl, canvas, program: { at } } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...light.background.map((value) => value ** (1 / 2.2)), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program.handle);
    gl.bindTexture(gl.TEXTURE_2D, this.shadows.texture);
    gl.uniformMatrix4fv(at.u_camera, false, camera.matrix(canvas.width / canvas.height));
    gl.uniformMatrix4fv(at.u_sunlight, false, this.sunlight);
    gl.uniform3fv(at.u_eye, camera.eye());
    gl.uniform3fv(at.u_sun, SUN);
    for (const name of ["sky", "ground", "grid"]) gl.uniform3fv(at[`u_${name}`], light[name]);
    const clear = ({ opacity = 1, kind }) => opacity < 1 || kind === KIND.floor;
    things.filter((thing) => !clear(thing)).forEach((thing) => this.drawThing(thing));
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    things.filter(clear).forEach((thing) => this.drawThing(thing));
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawThing({ mesh, pose = IDENTITY, color, opacity = 1, kind = KIND.body, dash = [1, 1], now = 0, through = false }) {
    const { gl, program: { at } } = this;
    gl.uniformMatrix4fv(at.u_model, false, matrix(pose));
    gl.uniform3fv(at.u_color, color);
    gl.uniform1f(at.u_opacity, opacity);
    gl.uniform1i(at.u_kind, kind);
    gl.uniform2fv(at.u_dash, dash);
    gl.uniform1f(at.u_now, now);
    // Some things are visible through everything.
    gl.depthFunc(through ? gl.ALWAYS : gl.LEQUAL);
    gl.bindVertexArray(mesh.array);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
  }

  /** Draws the depths of the nearest bodies as seen from the sun. */
  drawDepths(things) {
    const { gl, depths: { handle, at } } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows.frame);
    gl.viewport(0, 0, SHADOW_PIXELS, SHADOW_PIXELS);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(handle);
    gl.depthFunc(gl.LEQUAL);
    gl.uniformMatrix4fv(at.u_camera, false, this.sunlight);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 4);
    for (const { mesh, pose = IDENTITY } of things) {
      gl.uniformMatrix4fv(at.u_model, false, matrix(pose));
      gl.bindVertexArray(mesh.array);
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** The matrix from the world to the picture seen from the sun. */
  static sunlight() {
    const right = unit(cross([0, 1, 0], SUN));
    return product(parallel(SHADOW_REACH), worldToViewer(SHADOW_CENTRE, right, cross(SUN, right), SUN));
  }

  /** The texture for the depths seen from the sun. */
  shadowMap() {
    const gl = this.gl;
    const [texture, frame] = [gl.createTexture(), gl.createFramebuffer()];
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_PIXELS, SHADOW_PIXELS);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
    return { texture, frame };
  }

  /** A program and the locations of its uniforms. */
  linked(...sources) {
    const gl = this.gl;
    const handle = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((type, i) => {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, sources[i]);
      gl.compileShader(shader);
      gl.attachShader(handle, shader);
    });
    gl.linkProgram(handle);
    if (!gl.getProgramParameter(handle, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = gl.getAttachedShaders(handle).map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`the drawing program does not compile: ${logs.join(" ")}`);
    }
    const at = {};
    for (let i = 0; i < gl.getProgramParameter(handle, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(handle, i);
      at[name] = gl.getUniformLocation(handle, name);
    }
    return { handle, at };
  }
}
