#include "picture/draw_list.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/parallel.h"
#include "picture/creases.h"
#include "picture/occlusion_rays.h"
#include "picture/palette.h"

namespace vantage::internal::picture {
namespace {

// Over the radius of what is framed:
constexpr double kFullRadius = 1.08, kFadeRadius = 1.55;  // of the disc of ground
constexpr double kPartFull = 0.95, kPartFade = 1.3;       // nearest point of a building
constexpr double kTerrainSize = 3;                        // of what is not a building
constexpr double kGlass = 0.3;                            // opacity of a building that hides the target
constexpr double kPale = 0.45;                            // opacity of one of several volumes
constexpr double kGroundBand = 0.5;                       // metres about the ground's height that count as ground
constexpr double kGroundSink = 0.05;                      // metres: a ground of the scene's own lies over ours
constexpr double kLargestBox = 3;                         // over the rest's size: larger boxes do not count in framing
constexpr double kGroundMark = 0;                         // opacity that tells ground to the shaders
constexpr double kLeastOpacity = 0.01;                    // of a building that is drawn
constexpr double kSameCorner = 1e-3;                      // metres between corners of parts that are one
constexpr double kPlumbSpacing = 0.03;                    // of a path's length, between its plumb lines
constexpr int kGridCells = 9;                             // or so, across the disc

using Outline = std::vector<Vec3>;

Outline outline_of(const Target& target, std::size_t part) {
  if (target.parts[part].size() < 3) return target.parts[part];
  const TargetFrame frame = make_target_frame(target, part);
  Outline points;
  for (const Eigen::Vector2d& p : frame.polygon) points.push_back(frame.to_scene({p.x(), p.y(), 0}));
  return points;
}

/// A polygon or a point for each part of the targets.
std::vector<Outline> target_outlines(const PictureRequest& request) {
  std::vector<const Target*> targets = request.others;
  if (request.target != nullptr) targets.push_back(request.target);
  std::vector<Outline> outlines;
  for (const Target* target : targets) {
    for (std::size_t i = 0; i < target->parts.size(); ++i) outlines.push_back(outline_of(*target, i));
  }
  return outlines;
}

std::vector<Vec3> corners_of(const std::vector<Outline>& outlines) {
  std::vector<Vec3> corners;
  for (const Outline& outline : outlines) corners.insert(corners.end(), outline.begin(), outline.end());
  return corners;
}

/// Whether a side of one part is one of another part's too, run the other way: it is inside the target.
bool is_shared(const std::vector<Outline>& outlines, const Vec3& from, const Vec3& to) {
  return std::any_of(outlines.begin(), outlines.end(), [&](const Outline& outline) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
      if ((a - to).norm() < kSameCorner && (b - from).norm() < kSameCorner) return true;
    }
    return false;
  });
}

const Mesh* solid_of(const PictureRequest& request) {
  return request.volume != nullptr ? &request.volume->mesh : request.solid;
}

std::array<Vec3, 8> corners_of(const Box& box) {
  std::array<Vec3, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const auto at = [&](int axis) { return (i >> axis & 1U) != 0 ? box.max[axis] : box.min[axis]; };
    corners[i] = {at(0), at(1), at(2)};
  }
  return corners;
}

std::vector<Vec3> framed_points(const Scene& scene, const PictureRequest& request,
                                const core::ProgressReporter& progress) {
  if (!request.frame.empty()) return request.frame;
  std::vector<Vec3> points = corners_of(target_outlines(request));
  for (const PicturePath& path : request.paths) points.insert(points.end(), path.points.begin(), path.points.end());
  std::vector<const Mesh*> meshes = request.solids;
  if (const Mesh* solid = solid_of(request)) meshes.push_back(solid);
  for (const Mesh* mesh : meshes) {
    for (const Triangle& t : mesh->triangles) {
      progress.tick();
      for (const std::uint32_t v : t) points.push_back(mesh->vertices[v]);
    }
  }
  Box bounds;
  for (const Vec3& point : points) bounds.extend(point);
  const double size = bounds.empty() ? 0 : (bounds.max - bounds.min).norm();
  for (const Zone& zone : request.navigation.keep_in) {
    Box box;
    for (const Eigen::Vector2d& p : zone.outer) box.extend(Vec3(p.x(), p.y(), 0));
    box.min.z() = std::isfinite(zone.min_z_m) ? zone.min_z_m : bounds.empty() ? 0 : bounds.min.z();
    box.max.z() = std::isfinite(zone.max_z_m) ? zone.max_z_m : bounds.empty() ? 0 : bounds.max.z();
    const bool is_too_large = (box.max - box.min).norm() > kLargestBox * size;
    if (size > 0 ? is_too_large : !zone.is_box) continue;
    for (const Vec3& corner : corners_of(box)) points.push_back(corner);
  }
  if (points.empty()) {
    for (const Vec3& corner : corners_of(bounding_box(scene.mesh))) points.push_back(corner);
  }
  return points;
}

/// Distance in plan from `focus` to the triangle's bounding box.
double plan_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Eigen::Vector2d& focus) {
  const Eigen::Vector2d low = a.head<2>().cwiseMin(b.head<2>()).cwiseMin(c.head<2>());
  const Eigen::Vector2d high = a.head<2>().cwiseMax(b.head<2>()).cwiseMax(c.head<2>());
  return (focus - focus.cwiseMax(low).cwiseMin(high)).norm();
}

double smooth_step(double begin, double end, double value) {
  const double t = std::clamp((value - begin) / (end - begin), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Objects no wider than `building_size`, and of wider ones the triangles that hang together by corners in one place.
struct Parts {
  std::vector<std::uint32_t> of;  ///< per triangle: index into `boxes`
  std::vector<Box> boxes;         ///< those of parts that are another's stay empty
};

Parts parts_of(const Scene& scene, double building_size, const core::ProgressReporter& progress) {
  const Mesh& mesh = scene.mesh;
  Parts parts{std::vector<std::uint32_t>(mesh.triangles.size()), std::vector<Box>(mesh.triangles.size())};
  std::iota(parts.of.begin(), parts.of.end(), 0U);
  const auto root = [&](std::uint32_t t) {
    while (parts.of[t] != t) t = parts.of[t] = parts.of[parts.of[t]];
    return t;
  };
  struct Corner {
    Vec3 place;
    std::uint32_t object, triangle;
  };
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    progress.tick();
    const std::uint32_t object = t < scene.object_of.size() ? scene.object_of[t] : 0;
    for (const std::uint32_t v : mesh.triangles[t]) corners.push_back({mesh.vertices[v], object, t});
  }
  const auto less = [](const Corner& a, const Corner& b) {
    if (a.object != b.object) return a.object < b.object;
    for (int axis = 0; axis < 3; ++axis) {
      if (a.place[axis] != b.place[axis]) return a.place[axis] < b.place[axis];
    }
    return a.triangle < b.triangle;
  };
  parallel::sort(corners, less, progress);
  for (std::size_t i = 1; i < corners.size(); ++i) {
    progress.tick();
    if (corners[i].object != corners[i - 1].object || corners[i].place != corners[i - 1].place) continue;
    parts.of[root(corners[i].triangle)] = root(corners[i - 1].triangle);
  }
  std::vector<Box> objects(scene.objects.size());
  std::vector<std::uint32_t> first(scene.objects.size(), std::numeric_limits<std::uint32_t>::max());
  for (std::uint32_t t = 0; t < scene.object_of.size(); ++t) {
    progress.tick();
    for (const std::uint32_t v : mesh.triangles[t]) objects[scene.object_of[t]].extend(mesh.vertices[v]);
  }
  for (std::uint32_t t = 0; t < scene.object_of.size(); ++t) {
    progress.tick();
    const std::uint32_t object = scene.object_of[t];
    if ((objects[object].max - objects[object].min).head<2>().maxCoeff() > building_size) continue;
    first[object] = std::min(first[object], t);
    parts.of[root(t)] = root(first[object]);
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    progress.tick();
    parts.of[t] = root(t);
    for (const std::uint32_t v : mesh.triangles[t]) parts.boxes[parts.of[t]].extend(mesh.vertices[v]);
  }
  return parts;
}

/// The height at which most of the level surface lies that is not above `ceiling`: streets, not roofs.
double ground_height(const Scene& scene, const Eigen::Vector2d& focus, double radius, double ceiling,
                     const core::ProgressReporter& progress) {
  constexpr double kStep = 0.25;
  std::map<long, double> area_at;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : scene.mesh.triangles) {
    progress.tick();
    const Vec3 &a = scene.mesh.vertices[t[0]], &b = scene.mesh.vertices[t[1]], &c = scene.mesh.vertices[t[2]];
    if (plan_distance(a, b, c, focus) > radius) continue;
    lowest = std::min({lowest, a.z(), b.z(), c.z()});
    const Vec3 cross = (b - a).cross(c - a);
    const double z = (a.z() + b.z() + c.z()) / 3;
    if (z > ceiling || std::abs(cross.z()) < 0.999 * cross.norm()) continue;
    area_at[std::lround(z / kStep)] += std::min(0.5 * cross.norm(), 4 * radius * radius);
  }
  const auto most = std::max_element(area_at.begin(), area_at.end(),
                                     [](const auto& one, const auto& other) { return one.second < other.second; });
  if (most != area_at.end() && most->second > 0.2 * radius * radius) return static_cast<double>(most->first) * kStep;
  return std::isfinite(lowest) ? lowest : ceiling;
}

/// Builds one list; knows the origin.
class Builder {
 public:
  Builder(const Scene& scene, const PictureRequest& request, const PictureExtent& extent, const View& view,
          const OcclusionRays& occlusion_rays, const core::ProgressReporter& progress)
      : scene_(scene),
        request_(request),
        extent_(extent),
        view_(view),
        occlusion_rays_(occlusion_rays),
        progress_(progress),
        unit_(std::sqrt(1.0 * view.width * view.height) / 1386) {
    list_.origin = extent.centre;
  }

  DrawList build() {
    const Vec3 middle = 0.5 * (extent_.framed.min + extent_.framed.max);
    list_.focus = local(middle).head<2>();
    list_.fade_begin = static_cast<float>(kFullRadius * extent_.radius);
    list_.fade_end = static_cast<float>(kFadeRadius * extent_.radius);
    list_.sun = sun().cast<float>();
    if (request_.draw_scene) {
      ground();
      solids(middle);
    }
    light_ball(middle);
    volume();
    for (std::size_t i = 0; i < request_.solids.size(); ++i) solid(*request_.solids[i], kSolids[i % kSolids.size()]);
    target();
    for (const PicturePath& one : request_.paths) path(one);
    for (const Zone& zone : request_.navigation.keep_in) wire(zone, kBox);
    for (const Zone& zone : request_.navigation.keep_out) wire(zone, kKeepOut);
    return std::move(list_);
  }

 private:
  Eigen::Vector3f local(const Vec3& point) const { return (point - list_.origin).cast<float>(); }

  float pixels(double width) const { return static_cast<float>(std::max(1.0, width * unit_)); }

  /// From the viewer's left and behind, so that what faces the viewer is lit; from the north-west in a plan.
  Vec3 sun() const {
    if (std::abs(view_.back.z()) > 0.999) return Vec3(-0.55, 0.55, 0.9).normalized();
    const Vec3 level = Vec3(view_.back.x(), view_.back.y(), 0).normalized();
    return (0.55 * level - 0.75 * view_.right + 1.05 * Vec3::UnitZ()).normalized();
  }

  void triangle(std::vector<DrawVertex>& to, const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t colour) {
    const Vec3 cross = (b - a).cross(c - a);
    const double size = cross.norm();
    if (!(size > 0)) return;
    const Eigen::Vector3f normal = (cross / size).cast<float>();
    for (const Vec3* corner : {&a, &b, &c}) to.push_back({local(*corner), normal, colour});
  }

  void line(std::vector<DrawLine>& to, const Vec3& a, const Vec3& b, Colour colour, double opacity, double width,
            double behind_volume, double behind_scene) {
    to.push_back({local(a), local(b), packed(colour, opacity), pixels(width), static_cast<float>(behind_volume),
                  static_cast<float>(behind_scene)});
  }

  void ground() {
    const double radius = list_.fade_end, z = extent_.ground_z - kGroundSink;
    const Vec3 middle = 0.5 * (extent_.framed.min + extent_.framed.max);
    const Vec3 low(middle.x() - radius, middle.y() - radius, z), high(middle.x() + radius, middle.y() + radius, z);
    const Vec3 one(high.x(), low.y(), z), other(low.x(), high.y(), z);
    triangle(list_.solids, low, one, high, packed(kGround, kGroundMark));
    triangle(list_.solids, low, high, other, packed(kGround, kGroundMark));

    list_.grid_m = round_length(2 * extent_.radius / kGridCells * 1.2);
    for (int axis = 0; axis < 2; ++axis) {
      const double at = middle[axis], from = std::ceil((at - radius) / list_.grid_m) * list_.grid_m;
      for (double value = from; value <= at + radius; value += list_.grid_m) {
        const double half = std::sqrt(std::max(0.0, radius * radius - (value - at) * (value - at)));
        Vec3 a(0, 0, extent_.ground_z), b = a;
        a[axis] = b[axis] = value;
        a[1 - axis] = middle[1 - axis] - half;
        b[1 - axis] = middle[1 - axis] + half;
        line(list_.ground_lines, a, b, kInk, 0.16, 1.4, 1, 0);
      }
    }
  }

  void solids(const Vec3& middle) {
    const Mesh& mesh = scene_.mesh;
    const Parts parts = parts_of(scene_, extent_.radius, progress_);
    const std::vector<double> opacities = opacities_of(parts, middle);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      progress_.tick();
      const Triangle& t = mesh.triangles[i];
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const bool is_low = std::max({a.z(), b.z(), c.z()}) < extent_.ground_z + kGroundBand;
      const bool pales = is_low || is_terrain(parts.boxes[parts.of[i]]);
      const double opacity = pales ? kGroundMark : opacities[parts.of[i]];
      const bool is_shown = pales ? plan_distance(a, b, c, middle.head<2>()) < list_.fade_end : opacity > kLeastOpacity;
      if (is_shown) triangle(list_.solids, a, b, c, packed(is_low ? kGround : kBuilding, opacity));
    }
  }

  /// Too wide to be a building: it pales with the distance, as the ground does.
  bool is_terrain(const Box& box) const {
    return (box.max - box.min).head<2>().maxCoeff() > kTerrainSize * extent_.radius;
  }

  /// The opacities of the parts: less the farther away, and little where one hides the target.
  std::vector<double> opacities_of(const Parts& parts, const Vec3& middle) const {
    std::vector<double> opacities(parts.boxes.size(), 0);
    for (std::size_t i = 0; i < parts.boxes.size(); ++i) {
      if (parts.boxes[i].empty()) continue;
      const double distance =
          plan_distance(parts.boxes[i].min, parts.boxes[i].max, parts.boxes[i].max, middle.head<2>());
      opacities[i] = 1 - smooth_step(kPartFull * extent_.radius, kPartFade * extent_.radius, distance);
    }
    std::vector<Vec3> points = extent_.target;
    points.push_back(extent_.centre);
    for (const Vec3& point : points) {
      const Vec3 towards = view_.perspective ? Vec3(view_.eye - point) : view_.back;
      occlusion_rays_.each_hit(point + 0.05 * Vec3::UnitZ(), towards, !view_.perspective, [&](std::uint32_t triangle) {
        double& opacity = opacities[parts.of[triangle]];
        opacity = std::min(opacity, kGlass);
        return true;
      });
    }
    return opacities;
  }

  void light_ball(const Vec3& middle) {
    double low = extent_.ground_z, high = extent_.ground_z + 1;
    for (const DrawVertex& vertex : list_.solids) {
      const double z = vertex.position.z() + list_.origin.z();
      low = std::min(low, z);
      high = std::max(high, z);
    }
    list_.light_centre = local({middle.x(), middle.y(), 0.5 * (low + high)});
    list_.light_radius = static_cast<float>(std::hypot(list_.fade_end, 0.5 * (high - low)));
  }

  void volume() {
    const Mesh* solid = solid_of(request_);
    if (solid == nullptr || solid->triangles.empty()) return;
    std::vector<std::uint8_t> kinds;
    const Volume* volume = request_.volume;
    if (request_.marks.empty() && volume != nullptr && volume->cause_of.size() == solid->triangles.size() &&
        !volume->causes.empty()) {
      for (const std::uint32_t cause : volume->cause_of) {
        kinds.push_back(static_cast<std::uint8_t>(volume->causes.at(cause).kind));
      }
    }
    const std::vector<Colour> marked = mark(*solid);
    for (std::size_t t = 0; t < solid->triangles.size(); ++t) {
      progress_.tick();
      const Triangle& corners = solid->triangles[t];
      const Colour plain = marked.empty() ? kPlainVolume : marked[t];
      const Colour colour = kinds.empty() ? plain : colour_of(static_cast<CauseKind>(kinds[t]));
      triangle(list_.volume, solid->vertices[corners[0]], solid->vertices[corners[1]], solid->vertices[corners[2]],
               packed(colour));
    }
    creases(*solid, kinds, 1);
  }

  /// One of several.
  void solid(const Mesh& mesh, Colour colour) {
    for (const Triangle& t : mesh.triangles) {
      progress_.tick();
      triangle(list_.volume, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], packed(colour, kPale));
    }
    creases(mesh, {}, kPale);
  }

  void creases(const Mesh& mesh, const std::vector<std::uint8_t>& kinds, double opacity) {
    const std::vector<Crease> creases = find_creases(mesh, kinds, view_.eye, view_.back, view_.perspective, progress_);
    for (const Crease& crease : thin_out(creases, view_, unit_, progress_)) {
      line(list_.creases, crease.a, crease.b, kCrease, opacity * crease_opacity(crease.strength),
           crease_width(crease.strength), 0.35, 0);
    }
  }

  /// The colour of each facet, and lines round those that are marked: most are too small to be seen without.
  std::vector<Colour> mark(const Mesh& solid) {
    if (request_.marks.empty()) return {};
    std::vector<Colour> colours(solid.triangles.size(), kPlainVolume);
    for (std::size_t i = request_.marks.size(); i-- > 0;) {
      const Colour colour = kMarks[i % kMarks.size()];
      for (const std::uint32_t facet : request_.marks[i].facets) {
        progress_.tick();
        colours[facet] = colour;
        const Triangle& corners = solid.triangles[facet];
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 &a = solid.vertices[corners[k]], &b = solid.vertices[corners[(k + 1) % 3]];
          line(list_.lines, a, b, colour, 0.9, 2, 0.8, 0.3);
        }
      }
    }
    return colours;
  }

  void target() {
    const std::vector<Outline> outlines = target_outlines(request_);
    for (const Outline& points : outlines) {
      if (points.size() < 3) {
        for (const Vec3& point : points) dot(point);
        continue;
      }
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        triangle(list_.target, points[0], points[i], points[i + 1], packed(kTarget, 0.9));
      }
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 &from = points[i], &to = points[(i + 1) % points.size()];
        if (!is_shared(outlines, from, to)) line(list_.lines, from, to, kTargetOutline, 1, 3, 1, 0.35);
      }
    }
  }

  /// On paper, so that it stands out; with plumb lines to the ground, so that its height can be read.
  void path(const PicturePath& path) {
    double length = 0;
    for (std::size_t i = 1; i < path.points.size(); ++i) length += (path.points[i] - path.points[i - 1]).norm();
    double since = 0;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const Vec3& point = path.points[i];
      if (i > 0) since += (point - path.points[i - 1]).norm();
      if (i > 0 && i + 1 < path.points.size() && since < kPlumbSpacing * length) continue;
      since = 0;
      line(list_.lines, point, {point.x(), point.y(), extent_.ground_z}, kPath, 0.45, 1.2, 0.6, 0.15);
    }
    polyline(path.points, kPaper, 7, 0.7);
    polyline(path.points, kPath, 3.5, 1);
    for (const std::vector<Vec3>& points : path.marked) polyline(points, kMarkedPath, 5, 1);
  }

  void polyline(const std::vector<Vec3>& points, Colour colour, double width, double opacity) {
    for (std::size_t i = 1; i < points.size(); ++i) {
      line(list_.lines, points[i - 1], points[i], colour, opacity, width, 0.8, 0.3);
    }
  }

  /// An octahedron of a few pixels.
  void dot(const Vec3& point) {
    const double size = 9 * unit_ / view_.pixels_per_metre();
    for (const double x : {-size, size}) {
      for (const double y : {-size, size}) {
        for (const double z : {-size, size}) {
          triangle(list_.target, point + x * Vec3::UnitX(), point + y * Vec3::UnitY(), point + z * Vec3::UnitZ(),
                   packed(kTarget));
        }
      }
    }
  }

  void wire(const Box& box, Colour colour) {
    const std::array<Vec3, 8> corners = corners_of(box);
    for (unsigned i = 0; i < 8; ++i) {
      for (const unsigned bit : {1U, 2U, 4U}) {
        if ((i & bit) == 0) line(list_.lines, corners[i], corners[i | bit], colour, 0.95, 1.8, 0.6, 0.25);
      }
    }
  }

  void limit_line(const Vec3& from, const Vec3& to, Colour colour) {
    line(list_.lines, from, to, colour, 0.95, 1.8, 0.6, 0.25);
  }

  /// Not so far away in plan that the picture does not show it: files of zones hold those of a country.
  bool is_near(const Zone& zone) const {
    Box box;
    for (const Eigen::Vector2d& p : zone.outer) box.extend(Vec3(p.x(), p.y(), 0));
    const Vec3 reach = Vec3::Constant(kLargestBox * (extent_.framed.max - extent_.framed.min).norm());
    return (box.min - extent_.framed.max - reach).head<2>().maxCoeff() <= 0 &&
           (extent_.framed.min - reach - box.max).head<2>().maxCoeff() <= 0;
  }

  /// A zone without a lower or an upper bound is drawn from the lowest or to the highest of what the picture is about.
  /// Corners that hardly turn, as those of circles, have no upright line.
  void wire(const Zone& zone, Colour colour) {
    if (zone.is_box) return wire(zone.box(), colour);
    if (!is_near(zone)) return;
    const double low = std::isfinite(zone.min_z_m) ? zone.min_z_m : std::min(extent_.framed.min.z(), zone.max_z_m);
    const double high = std::isfinite(zone.max_z_m) ? zone.max_z_m : std::max(extent_.framed.max.z(), zone.min_z_m);
    const auto wire_ring = [&](const Zone::Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        for (const double z : {low, high}) limit_line({a.x(), a.y(), z}, {b.x(), b.y(), z}, colour);
        const Eigen::Vector2d in = a - ring[(i + ring.size() - 1) % ring.size()], out = b - a;
        constexpr double kStraight = 0.998;  // the cosine of 3.6 degrees
        if (in.dot(out) < kStraight * in.norm() * out.norm()) {
          limit_line({a.x(), a.y(), low}, {a.x(), a.y(), high}, colour);
        }
      }
    };
    wire_ring(zone.outer);
    for (const Zone::Ring& hole : zone.holes) wire_ring(hole);
  }

  const Scene& scene_;
  const PictureRequest& request_;
  const PictureExtent& extent_;
  const View& view_;
  const OcclusionRays& occlusion_rays_;
  const core::ProgressReporter& progress_;
  double unit_;  // pixels of the picture for one of a picture of 1600 x 1200
  DrawList list_;
};

}  // namespace

double round_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  const double factor = length / power;
  return power * (factor >= 5 ? 5 : (factor >= 2 ? 2 : 1));
}

PictureExtent find_extent(const Scene& scene, const PictureRequest& request, const core::ProgressReporter& progress) {
  PictureExtent extent;
  extent.points = framed_points(scene, request, progress);
  for (const Vec3& point : extent.points) extent.framed.extend(point);
  extent.target = corners_of(target_outlines(request));
  const std::vector<Vec3>& target = extent.target;
  extent.centre = 0.5 * (extent.framed.min + extent.framed.max);
  if (!target.empty()) {
    extent.centre.setZero();
    for (const Vec3& point : target) extent.centre += point / static_cast<double>(target.size());
  }
  const Eigen::Vector2d middle = 0.5 * (extent.framed.min + extent.framed.max).head<2>();
  double radius = 0;
  for (const Vec3& point : extent.points) radius = std::max(radius, (point.head<2>() - middle).norm());
  extent.radius = std::max(radius, 1.0);
  const double ceiling = target.empty() ? extent.framed.max.z() : extent.centre.z() + kGroundBand;
  extent.ground_z = ground_height(scene, middle, extent.radius, ceiling, progress);
  return extent;
}

DrawList make_draw_list(const Scene& scene, const PictureRequest& request, const PictureExtent& extent,
                        const View& view, const OcclusionRays& occlusion_rays, const core::ProgressReporter& progress) {
  return Builder(scene, request, extent, view, occlusion_rays, progress).build();
}

}  // namespace vantage::internal::picture
