// GLSL of the pictures. Depth is reversed: 1 is near, 0 is nothing. Positions are metres relative to the draw list's
// origin. Colours are what is shown (sRGB values): pictures are composed as a printer lays ink, not as light adds up.
#pragma once

namespace vantage::internal::picture::shaders {

inline constexpr const char* kHeader = R"(#version 450 core
#define SKY 9
#define SUN 2
layout(std140, binding = 0) uniform Frame {
  mat4 clip, unclip;
  vec4 eye;    // xyz; w: 1 in a perspective, 0 in a parallel projection
  vec4 back;   // xyz: towards the viewer; w: distance of what is looked at
  vec4 fade;   // xy: middle of the disc of scene; z, w: radii between which it fades
  vec4 size;   // pixels across, pixels down; number of this frame, count of frames
  vec4 bias;   // towards the viewer, over the distance: volume, lines, target
  vec4 offset; // metres along the normal before asking for shadow: sky, sun
  vec4 light[SKY + SUN];  // xyz: towards the light
  mat4 light_clip[SKY + SUN];
};
vec3 to_viewer(vec3 p) { return eye.w > 0.5 ? eye.xyz - p : back.xyz * back.w; }
float faded(vec3 p) { return smoothstep(fade.z, fade.w, distance(p.xy, fade.xy)); }
// Colour and opacity of the volume: what is looked through at a slant is thicker.
vec4 film_of(vec3 p, vec3 normal, vec3 colour) {
  vec3 n = normalize(normal);
  float slant = dot(n, normalize(to_viewer(p)));
  float opacity = slant > 0 ? 0.20 : 0.13;
  opacity = 1 - pow(1 - opacity, 1 / max(abs(slant), 0.22));
  return vec4(colour * (0.84 + 0.16 * abs(dot(n, light[SKY].xyz))), opacity);
}
)";

inline constexpr const char* kSolidVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
out vec3 v_position;
flat out vec3 v_normal;
flat out vec4 v_colour;
void main() {
  v_position = position;
  v_normal = normal;
  v_colour = colour;
  gl_Position = clip * vec4(position, 1);
}
)";

// Ground pales into the paper with the distance. Buildings pale as a whole (opacity: 1 - how far), and are left out of
// as large a share of the frames, so that what fades hides nothing.
inline constexpr const char* kSolidFragment = R"(
in vec3 v_position;
flat in vec3 v_normal;
flat in vec4 v_colour;
layout(location = 0) out vec4 out_normal;
layout(location = 1) out vec4 out_colour;
void main() {
  bool is_ground = v_colour.a == 0;
  float fade = is_ground ? faded(v_position) : 1 - v_colour.a;
  if (fade >= 1 || (!is_ground && fade > (size.z + 0.5) / size.w)) discard;
  vec3 n = normalize(v_normal);
  out_normal = vec4(dot(n, to_viewer(v_position)) < 0 ? -n : n, 1);
  out_colour = vec4(v_colour.rgb, fade);
}
)";

inline constexpr const char* kShadowVertex = R"(
layout(location = 0) in vec3 position;
uniform int which;
void main() { gl_Position = light_clip[which] * vec4(position, 1); }
)";
inline constexpr const char* kShadowFragment = R"(
void main() {}
)";

inline constexpr const char* kScreenVertex = R"(
void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }
)";

inline constexpr const char* kShadeFragment = R"(
layout(binding = 0) uniform sampler2D depths;
layout(binding = 1) uniform sampler2D normals;
layout(binding = 2) uniform sampler2D colours;
layout(binding = 3) uniform sampler2DArrayShadow sky_maps;
layout(binding = 4) uniform sampler2DArrayShadow sun_maps;
layout(location = 0) out vec4 result;
float lit(sampler2DArrayShadow maps, int layer, int i, vec3 p) {
  vec3 q = (light_clip[i] * vec4(p, 1)).xyz;
  return texture(maps, vec4(0.5 * q.xy + 0.5, layer, q.z));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depths, at, 0).x;
  if (depth <= 0) {
    result = vec4(1);
    return;
  }
  vec4 p4 = unclip * vec4(2 * gl_FragCoord.xy / size.xy - 1, depth, 1);
  vec3 p = p4.xyz / p4.w;
  vec3 n = normalize(texelFetch(normals, at, 0).xyz);
  float sky = 0, sun = 0;
  for (int i = 0; i < SKY; ++i) {
    float c = dot(n, light[i].xyz);
    if (c > 0) sky += c * lit(sky_maps, i, i, p + offset.x * n);
  }
  for (int i = 0; i < SUN; ++i) {
    float c = dot(n, light[SKY + i].xyz);
    if (c > 0) sun += c * lit(sun_maps, i, SKY + i, p + offset.y * n);
  }
  float shade = 0.30 + 0.52 * (2.0 / SKY) * sky + 0.24 * sun / SUN + 0.10 * (0.5 - 0.5 * n.z);
  vec4 colour = texelFetch(colours, at, 0);
  result = vec4(mix(colour.rgb * min(shade, 1.0), vec3(1), colour.a), 1);
}
)";

inline constexpr const char* kFilmVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
out vec3 v_position;
flat out vec3 v_normal;
flat out vec4 v_colour;
void main() {
  vec3 p = position + bias.x * to_viewer(position);
  v_position = p;
  v_normal = normal;
  v_colour = colour;
  gl_Position = clip * vec4(p, 1);
}
)";

// `before`: depths of the layer before, 1 everywhere for the first.
inline constexpr const char* kFilmFragment = R"(
layout(binding = 0) uniform sampler2D depths;
layout(binding = 1) uniform sampler2D before;
in vec3 v_position;
flat in vec3 v_normal;
flat in vec4 v_colour;
layout(location = 0) out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (gl_FragCoord.z <= texelFetch(depths, at, 0).x || gl_FragCoord.z >= texelFetch(before, at, 0).x) discard;
  vec4 film = film_of(v_position, v_normal, v_colour.rgb);
  film.a *= v_colour.a;
  result = vec4(film.rgb, 1) * film.a;
}
)";

// What is behind the layers that were peeled, in no order: the sum of the films' colours, each times its film's share
// -ln(1 - opacity), and what light is left of all (by blending).
inline constexpr const char* kRestFragment = R"(
layout(binding = 0) uniform sampler2D depths;
layout(binding = 1) uniform sampler2D before;
in vec3 v_position;
flat in vec3 v_normal;
flat in vec4 v_colour;
layout(location = 0) out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (gl_FragCoord.z <= texelFetch(depths, at, 0).x || gl_FragCoord.z >= texelFetch(before, at, 0).x) discard;
  vec4 film = film_of(v_position, v_normal, v_colour.rgb);
  film.a *= v_colour.a;
  result = vec4(film.rgb * -log(1 - film.a), film.a);
}
)";
inline constexpr const char* kMeanFragment = R"(
layout(binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 result;
void main() {
  vec4 rest = texelFetch(image, ivec2(gl_FragCoord.xy), 0);
  if (rest.a >= 1) discard;
  result = vec4(rest.rgb / -log(max(rest.a, 1e-6)), 1) * (1 - rest.a);
}
)";

inline constexpr const char* kCopyFragment = R"(
layout(binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 result;
void main() { result = texelFetch(image, ivec2(gl_FragCoord.xy), 0); }
)";

// A layer of the volume, where it has any: its colours elsewhere are of layers before.
inline constexpr const char* kLayerFragment = R"(
layout(binding = 0) uniform sampler2D image;
layout(binding = 1) uniform sampler2D depths;
layout(location = 0) out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (texelFetch(depths, at, 0).x <= 0) discard;
  result = texelFetch(image, at, 0);
}
)";

inline constexpr const char* kTargetVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 colour;
flat out vec4 v_colour;
void main() {
  v_colour = colour;
  gl_Position = clip * vec4(position + bias.z * to_viewer(position), 1);
}
)";
inline constexpr const char* kTargetFragment = R"(
layout(binding = 0) uniform sampler2D depths;
flat in vec4 v_colour;
layout(location = 0) out vec4 result;
void main() {
  if (gl_FragCoord.z < texelFetch(depths, ivec2(gl_FragCoord.xy), 0).x) discard;
  result = vec4(v_colour.rgb, 1) * v_colour.a;
}
)";

// A line is a rectangle in the picture's plane, half a pixel longer and wider than it is, with soft sides.
inline constexpr const char* kLineVertex = R"(
layout(location = 0) in vec3 a;
layout(location = 1) in vec3 b;
layout(location = 2) in vec4 colour;
layout(location = 3) in vec3 style;  // width, opacity behind the volume, behind the scene
out vec3 v_position;
noperspective out vec2 v_across;  // pixels from the middle line; half the width
flat out vec4 v_colour;
flat out vec2 v_behind;
void main() {
  const vec2 corners[6] = vec2[](vec2(0, -1), vec2(1, -1), vec2(1, 1), vec2(0, -1), vec2(1, 1), vec2(0, 1));
  vec2 corner = corners[gl_VertexID % 6];
  vec3 p = a + bias.y * to_viewer(a), q = b + bias.y * to_viewer(b);
  vec4 cp = clip * vec4(p, 1), cq = clip * vec4(q, 1);
  float nearest = eye.w * 1e-3 * back.w;  // of a perspective: what is behind the eye has no place in the picture
  if (cp.w < nearest && cq.w < nearest) {
    gl_Position = vec4(2, 2, 2, 1);
    return;
  }
  if (cp.w < nearest) { float t = (nearest - cp.w) / (cq.w - cp.w); cp = mix(cp, cq, t); p = mix(p, q, t); }
  if (cq.w < nearest) { float t = (nearest - cq.w) / (cp.w - cq.w); cq = mix(cq, cp, t); q = mix(q, p, t); }
  vec2 along = (cq.xy / cq.w - cp.xy / cp.w) * size.xy;
  float long_enough = length(along);
  along = long_enough > 1e-4 ? along / long_enough : vec2(1, 0);
  float half_width = 0.5 * style.x, reach = half_width + 0.5;
  vec4 place = corner.x < 0.5 ? cp : cq;
  vec2 move = reach * corner.y * vec2(-along.y, along.x) + 0.5 * half_width * (corner.x < 0.5 ? -along : along);
  place.xy += 2 * move / size.xy * place.w;
  v_position = corner.x < 0.5 ? p : q;
  v_across = vec2(reach * corner.y, half_width);
  v_colour = colour;
  v_behind = style.yz;
  gl_Position = place;
}
)";
inline constexpr const char* kLineFragment = R"(
layout(binding = 0) uniform sampler2D depths;
layout(binding = 1) uniform sampler2D volume;
uniform float fades;  // 1: with the scene
in vec3 v_position;
noperspective in vec2 v_across;
flat in vec4 v_colour;
flat in vec2 v_behind;
layout(location = 0) out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float alpha = v_colour.a * clamp(v_across.y + 0.5 - abs(v_across.x), 0, 1);
  if (gl_FragCoord.z < texelFetch(volume, at, 0).x) alpha *= v_behind.x;
  if (gl_FragCoord.z < texelFetch(depths, at, 0).x) alpha *= v_behind.y;
  alpha *= 1 - fades * faded(v_position);
  if (alpha <= 0) discard;
  result = vec4(v_colour.rgb * alpha, alpha);
}
)";

}  // namespace vantage::internal::picture::shaders
