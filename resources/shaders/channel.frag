#version 330 core
// A channel of a picture on the screen, as viewers/splat/channel_picture.cpp does it for values of the host.
// SPDX-License-Identifier: Apache-2.0
uniform sampler2D values;   // R G B as the channel's row says, A alpha
uniform sampler2D behind;   // linear radiance, where `sky` is set
uniform sampler2D palette;  // of false colours
uniform bool sky;
uniform int form;  // 0 linear colour, 1 sRGB colour, 2 direction, 3 grey, 4 false colour
uniform bool times_alpha;
uniform float least_alpha;
uniform float gain;
uniform vec2 limits;
uniform vec3 backdrop;  // linear
in vec2 texture_position;
out vec4 color;

vec3 encoded(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

vec3 decoded(vec3 srgb) {
  vec3 c = max(srgb, 0.0);
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 data(vec4 value) {
  if (form == 2) return 0.5 + 0.5 * value.rgb;
  float x = times_alpha ? value.r / value.a : value.r;
  if (form == 3) return vec3(x);
  return texture(palette, vec2(clamp((x - limits.x) / (limits.y - limits.x), 0.0, 1.0), 0.5)).rgb;
}

void main() {
  const float visible = 1.0 / 255.0;
  vec4 value = texture(values, texture_position);
  if (form < 2) {
    vec3 light = form == 1 ? decoded(value.rgb) : value.rgb;
    vec3 rear = sky ? gain * texture(behind, texture_position).rgb : backdrop;
    color = vec4(encoded(gain * light + (1.0 - value.a) * rear), 1.0);
    return;
  }
  vec3 shown = encoded(backdrop);
  if (value.a >= max(visible, least_alpha))
    shown = mix(shown, clamp(data(value), 0.0, 1.0), least_alpha > visible ? 1.0 : value.a);
  color = vec4(shown, 1.0);
}
