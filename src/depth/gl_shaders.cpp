#include "depth/gl_shaders.h"

namespace vantage::internal::depth {
namespace {

// Coordinates relative to the eye are taken in double precision, and rounded once: exact to 2^-24 of their size,
// whatever the scene's coordinates are. So is the distance of the triangle's plane.
constexpr const char* kVertex = R"(#version 450 core
layout(location = 0) in dvec3 position;
layout(location = 2) in uint face;  // of the draw command
uniform dvec3 eye;
out Corner {
  dvec3 offset;
  flat uint face;
} corner;
void main() {
  corner.offset = position - eye;
  corner.face = face;
}
)";

// A face's coordinates are (right, up, forward): x and y over z are the image's u and v, 1 / z is the inverse depth,
// which is affine in u and v: dot(normal, (u, v, 1)) / distance.
constexpr const char* kCentersGeometry = R"(#version 450 core
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
in Corner {
  dvec3 offset;
  flat uint face;
} corner[];
uniform mat3 faces[6];
uniform int first_face;
flat out vec4 plane;      // normal, 1 / distance
flat out vec2 depths;     // least and greatest inverse depth of what is in the image
void main() {
  dvec3 a = corner[0].offset, e = corner[1].offset - a, f = corner[2].offset - a;
  dvec3 normal = cross(e, f);
  double area = length(normal);
  if (area == 0.0LF) return;
  normal /= area;
  double distance = dot(normal, a);
  if (distance < 0.0LF) { distance = -distance; normal = -normal; }
  if (distance < 1e-8LF) return;  // seen edge on
  mat3 axes = faces[corner[0].face];
  vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = axes * vec3(corner[k].offset);
  vec3 x = vec3(p[0].x, p[1].x, p[2].x), y = vec3(p[0].y, p[1].y, p[2].y), z = vec3(p[0].z, p[1].z, p[2].z);
  if (all(lessThan(z, vec3(0))) || all(greaterThan(x, z)) || all(greaterThan(-x, z)) || all(greaterThan(y, z)) ||
      all(greaterThan(-y, z))) return;
  // What the image holds of this plane is at z >= distance / sqrt(3). To clip there, rather than at a plane near the
  // eye, keeps the clipped corners exact.
  float nearest = 0.5 * float(distance);
  float least = min(min(z.x, z.y), z.z), greatest = max(max(z.x, z.y), z.z);
  for (int k = 0; k < 3; ++k) {
    gl_Layer = int(corner[0].face) - first_face;
    plane = vec4(axes * vec3(normal), float(1.0LF / distance));
    depths = vec2(1.0 / greatest, 1.0 / max(least, nearest));
    gl_Position = vec4(p[k].x, p[k].y, nearest, p[k].z);
    EmitVertex();
  }
}
)";

constexpr const char* kCentersFragment = R"(#version 450 core
flat in vec4 plane;
flat in vec2 depths;
uniform float face_size;
void main() {
  vec2 c = (2.0 * gl_FragCoord.xy - face_size) / face_size;
  precise float q = (plane.x * c.x + plane.y * c.y + plane.z) * plane.w;
  gl_FragDepth = clamp(q, depths.x, depths.y) * 7.450580596923828125e-9;  // 2^-27
}
)";

// `slack`, in metres, is beyond the rounding of coordinates relative to the eye and of what is computed from them:
// 2^-19 of the triangle's farthest corner, 32 roundings.
constexpr const char* kNearestGeometry = R"(#version 450 core
layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
in Corner {
  dvec3 offset;
  flat uint face;
} corner[];
uniform mat3 faces[6];
uniform int first_face;
uniform float face_size;
flat out vec3 corner_a, corner_b, corner_c;
flat out vec4 plane;   // normal, 1 / distance (bounded from above)
flat out vec4 errors;  // slack, rounding of the test of a direction, greatest inverse depth, of dot(normal, (u, v, 1))

vec2 low = vec2(1e30), high = vec2(-1e30);

void extend(vec3 p, float slack) {
  vec2 c = p.xy / p.z;
  vec2 grow = 4.0 * slack * (1.0 + max(abs(c.x), abs(c.y))) / vec2(p.z);
  low = min(low, c - grow);
  high = max(high, c + grow);
}

double segment_distance(dvec3 from, dvec3 to) {
  dvec3 along = to - from;
  return length(from + clamp(-dot(from, along) / dot(along, along), 0.0LF, 1.0LF) * along);
}

// Whether the eye is on the triangle: then it grazes the triangle wherever it looks along it, which hides nothing.
bool touches(dvec3 a, dvec3 b, dvec3 c, dvec3 normal, double distance) {
  if (abs(distance) >= 1e-8LF) return false;
  double ab = dot(normal, cross(a, b)), bc = dot(normal, cross(b, c)), ca = dot(normal, cross(c, a));
  if (ab >= 0.0LF && bc >= 0.0LF && ca >= 0.0LF) return true;
  return min(min(segment_distance(a, b), segment_distance(b, c)), segment_distance(c, a)) < 1e-8LF;
}

float segment_distance(vec3 from, vec3 to) {
  vec3 along = to - from;
  return length(from + clamp(-dot(from, along) / dot(along, along), 0.0, 1.0) * along);
}

// From the eye to the triangle; `height` over its plane.
float triangle_distance(vec3 p[3], vec3 normal, float height, float tolerance) {
  vec3 sides = vec3(dot(normal, cross(p[0], p[1] - p[0])), dot(normal, cross(p[1], p[2] - p[1])),
                    dot(normal, cross(p[2], p[0] - p[2])));
  if (all(greaterThan(sides, vec3(-tolerance))) || all(lessThan(sides, vec3(tolerance)))) return height;
  return min(min(segment_distance(p[0], p[1]), segment_distance(p[1], p[2])), segment_distance(p[2], p[0]));
}

void main() {
  dvec3 a = corner[0].offset, b = corner[1].offset, c = corner[2].offset;
  dvec3 normal = cross(b - a, c - a);
  double area = length(normal);
  if (area == 0.0LF) return;
  normal /= area;
  double distance = dot(normal, a);
  if (touches(a, b, c, normal, distance)) return;
  mat3 axes = faces[corner[0].face];
  vec3 p[3] = vec3[3](axes * vec3(a), axes * vec3(b), axes * vec3(c));
  if (distance < 0.0LF) {
    distance = -distance;
    normal = -normal;
  } else {  // the axes of a face are a mirror's
    vec3 swapped = p[1];
    p[1] = p[2];
    p[2] = swapped;
  }
  vec3 x = vec3(p[0].x, p[1].x, p[2].x), y = vec3(p[0].y, p[1].y, p[2].y), z = vec3(p[0].z, p[1].z, p[2].z);
  float farthest = max(max(length(p[0]), length(p[1])), length(p[2]));
  float slack = 1.9073486e-6 * farthest;
  vec3 outside = z + 2.0 * slack;
  if (all(lessThan(outside, vec3(0))) || all(greaterThan(x, outside)) || all(greaterThan(-x, outside)) ||
      all(greaterThan(y, outside)) || all(greaterThan(-y, outside))) return;

  // Rounding of the plane in double precision: 2^-50 of its condition.
  double ab = length(b - a), ac = length(c - a), bc = length(c - b);
  double angle_error = 8.9e-16LF * (1.0LF + ab * ac / area);
  double least_distance = distance - angle_error * double(farthest);
  float longest = float(max(max(ab, ac), bc));
  float height = max(float(least_distance), 0.0);
  float reach = triangle_distance(p, axes * vec3(normal), height, slack * longest) - slack;
  float nearest = 0.577 * max(reach, 0.999 * height);  // what the image holds is at z >= distance / sqrt(3)
  float least = min(min(z.x, z.y), z.z);
  float cap = min(1.000001 / max(max(least - slack, nearest), 7.4505806e-9), 134217728.0);

  if (least >= 8.0 * slack) {
    for (int k = 0; k < 3; ++k) extend(p[k], slack);
  } else if (nearest >= 8.0 * slack) {
    for (int k = 0; k < 3; ++k) {
      vec3 from = p[k], to = p[(k + 1) % 3];
      if (from.z >= nearest) extend(from, slack);
      if ((from.z < nearest) != (to.z < nearest)) {
        vec2 across = mix(from.xy, to.xy, (nearest - from.z) / (to.z - from.z));
        extend(vec3(across, nearest), slack);
      }
    }
  } else {
    low = vec2(-1);
    high = vec2(1);
  }
  // Its texels' centres are within half a texel's side (1 / face_size) of the image; half of that more for the rounding
  // of the rasterizer.
  low = max(low - 1.5 / face_size, vec2(-1));
  high = min(high + 1.5 / face_size, vec2(1));
  if (any(greaterThan(low, high))) return;

  for (int k = 0; k < 4; ++k) {
    gl_Layer = int(corner[0].face) - first_face;
    corner_a = p[0];
    corner_b = p[1];
    corner_c = p[2];
    plane = vec4(axes * vec3(normal), 1e30);
    errors = vec4(slack, slack * (longest + 8.0 * slack * farthest * cap), cap, 1e30);
    if (least_distance > 0.0LF) {
      plane.w = min(1.000001 * float(1.0LF / least_distance), 1e30);
      errors.w = 4.8e-7 + 2.0 * float(angle_error);  // 2^-21: eight roundings of sums of three up to 1
    }
    gl_Position = vec4((k & 1) == 0 ? low.x : high.x, (k & 2) == 0 ? low.y : high.y,
                       min(1.000001 * cap * 7.4505806e-9, 1.0), 1);
    EmitVertex();
  }
}
)";

// What the triangle and the texel's pyramid share is a convex polygon, and the inverse depth affine over its image: its
// greatest value is at a corner of that polygon. That is the texel's corner to which the inverse depth grows, when this
// is in the triangle, or else a point of the triangle's sides: an end of what is left of one when cut by the pyramid's
// four planes. When there is neither, triangle and pyramid share nothing.
constexpr const char* kNearestFragment = R"(#version 450 core
layout(depth_less) out float gl_FragDepth;
flat in vec3 corner_a, corner_b, corner_c;
flat in vec4 plane;
flat in vec4 errors;
uniform float face_size;

const float kNone = 1e30;

float size(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

vec4 inside_pyramid(vec3 p, vec2 low, vec2 high) {
  return vec4(high * p.z - p.xy, p.xy - low * p.z) + errors.x;
}

float least_depth(float a, float b, vec4 in_a, vec4 in_b) {
  bvec4 out_a = lessThan(in_a, vec4(0)), out_b = lessThan(in_b, vec4(0));
  vec4 crossing = in_a / (in_a - in_b);
  vec4 enter = mix(vec4(0), crossing, out_a), leave = mix(vec4(1), crossing, out_b);
  float t0 = max(max(enter.x, enter.y), max(enter.z, enter.w));
  float t1 = min(min(leave.x, leave.y), min(leave.z, leave.w));
  bool apart = any(lessThan(max(in_a, in_b), vec4(0))) || t0 > t1 + 4.8e-7;
  return apart ? kNone : min(a + t0 * (b - a), a + t1 * (b - a));
}

void main() {
  vec2 c = (2.0 * gl_FragCoord.xy - face_size) / face_size;
  float reach = 1.000001 / face_size + 2.4e-7;
  vec2 low = c - reach, high = c + reach;
  vec3 worst = vec3(mix(low, high, greaterThan(plane.xy, vec2(0))), 1);
  float q = min(1.000001 * (dot(plane.xyz, worst) + errors.w) * plane.w, errors.z);
  if (q * errors.x < 1.9e-6) discard;  // beyond the farthest corner, which is slack / 2^-19 away

  // A corner that is off by d moves the test of the point worst / q by d times the sine between the other two.
  vec3 across_a = cross(corner_a, corner_b - corner_a), across_b = cross(corner_b, corner_c - corner_b),
       across_c = cross(corner_c, corner_a - corner_c);
  vec3 sides = vec3(dot(across_a, worst), dot(across_b, worst), dot(across_c, worst));
  vec3 sines = vec3(size(cross(corner_a, worst)), size(cross(corner_b, worst)), size(cross(corner_c, worst)));
  vec3 margin = errors.x * (q * vec3(size(across_a), size(across_b), size(across_c)) + sines + sines.yzx) + errors.y;
  if (any(lessThan(sides, -margin))) {
    vec4 in_a = inside_pyramid(corner_a, low, high), in_b = inside_pyramid(corner_b, low, high),
         in_c = inside_pyramid(corner_c, low, high);
    float depth = min(min(least_depth(corner_a.z, corner_b.z, in_a, in_b),
                          least_depth(corner_b.z, corner_c.z, in_b, in_c)),
                      least_depth(corner_c.z, corner_a.z, in_c, in_a));
    if (depth == kNone) discard;
    q = min(q, 1.000001 / max(depth - errors.x, 7.4505806e-9));
  }
  gl_FragDepth = q * 7.450580596923828125e-9;  // 2^-27
}
)";

}  // namespace

ShaderSources centers_shaders() { return {kVertex, kCentersGeometry, kCentersFragment}; }
ShaderSources nearest_shaders() { return {kVertex, kNearestGeometry, kNearestFragment}; }

}  // namespace vantage::internal::depth
