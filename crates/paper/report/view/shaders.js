"use strict";
// Programs for the graphics processor. One draws everything: bodies, the floor with its grid, and paths.

const KIND = { body: 0, floor: 1, path: 2 };

const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 along;
uniform mat4 u_model, u_camera, u_sunlight;
out vec3 v_position, v_normal, v_in_sunlight;
out vec2 v_along;

void main() {
  vec4 world = u_model * vec4(position, 1.0);
  v_position = world.xyz;
  v_normal = mat3(u_model) * normal;
  v_in_sunlight = (u_sunlight * world).xyz * 0.5 + 0.5;
  v_along = along;
  gl_Position = u_camera * world;
}`;

const FRAGMENT = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
uniform sampler2DShadow u_shadows;
uniform vec3 u_eye, u_sun, u_color, u_sky, u_ground, u_grid;
uniform float u_opacity, u_now;
uniform vec2 u_dash;   // metres from dash to dash, and the share that is drawn
uniform int u_kind;
in vec3 v_position, v_normal, v_in_sunlight;
in vec2 v_along;
out vec4 color;

// The share of the sun that arrives. Four looks at the depths, each a mean of four, give shadows a soft edge.
float sunshine() {
  if (any(greaterThan(abs(v_in_sunlight - 0.5), vec3(0.5)))) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < 4; i++) {
    vec2 aside = (vec2(i % 2, i / 2) - 0.5) * 1.6 / float(textureSize(u_shadows, 0).x);
    sum += texture(u_shadows, vec3(v_in_sunlight.xy + aside, v_in_sunlight.z - 0.0015));
  }
  return sum / 4.0;
}

// Lines of a grid, as wide as a pixel.
float lines(float spacing) {
  vec2 p = v_position.xy / spacing;
  vec2 away = abs(fract(p - 0.5) - 0.5) / fwidth(p);
  return 1.0 - min(min(away.x, away.y), 1.0);
}

vec4 floor_color() {
  float fading = smoothstep(2.3, 0.9, length(v_position.xy - vec2(0.4, 0.0)));
  float line = max(0.35 * lines(0.1), lines(0.5));
  vec3 plain = mix(u_color, u_grid, line);
  return vec4(plain * mix(0.62, 1.0, sunshine()), fading);
}

vec4 body_color() {
  vec3 n = normalize(v_normal);
  vec3 to_eye = normalize(u_eye - v_position);
  vec3 ambient = mix(u_ground, u_sky, 0.5 + 0.5 * n.z);
  float sun = max(dot(n, u_sun), 0.0);
  if (sun > 0.0) sun *= sunshine();
  float gloss = pow(max(dot(n, normalize(u_sun + to_eye)), 0.0), 40.0) * sun;
  float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 4.0);
  return vec4(u_color * (ambient + 0.65 * sun + 0.12 * rim) + 0.1 * gloss, u_opacity);
}

// The solid part of a path ends at the current time. Its colour does not depend on the light.
vec4 path_color() {
  bool ahead = v_along.y > u_now;
  if ((ahead && u_opacity == 1.0) || fract(v_along.x / u_dash.x) > u_dash.y) discard;
  return vec4(u_color * (0.8 + 0.2 * dot(normalize(v_normal), u_sun)), u_opacity);
}

void main() {
  vec4 linear = u_kind == 1 ? floor_color() : u_kind == 2 ? path_color() : body_color();
  color = vec4(pow(linear.rgb, vec3(1.0 / 2.2)), linear.a);
}`;

// From the sun, only depths are needed.
const DEPTH_FRAGMENT = `#version 300 es
precision lowp float;
void main() {}`;
