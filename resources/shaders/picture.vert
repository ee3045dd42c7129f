#version 330 core
// A rectangle of the window as two triangles, no buffers. SPDX-License-Identifier: Apache-2.0
uniform vec4 rectangle;  // left, top, right, bottom in normalised device coordinates
out vec2 texture_position;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  texture_position = corner;  // row 0 of a picture is its top
  gl_Position = vec4(mix(rectangle.xy, rectangle.zw, corner), 0.0, 1.0);
}
