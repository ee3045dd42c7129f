#version 330 core
// An encoded picture as it is; columns outside `columns` are left out (wipe). SPDX-License-Identifier: Apache-2.0
uniform sampler2D picture;
uniform float opacity;
uniform vec2 columns;  // window pixels, half-open
in vec2 texture_position;
out vec4 color;

void main() {
  if (gl_FragCoord.x < columns.x || gl_FragCoord.x >= columns.y) discard;
  color = vec4(texture(picture, texture_position).rgb, opacity);
}
