#include "solid/range_of_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/mend_welded.h"
#include "core/portable_math.h"
#include "solid/convex_hull.h"
#include "vantage/version.h"

namespace vantage::internal::solid {
namespace {

constexpr double kInside = 1e-9;             // of the distance: places lie so far inside of the spheres
constexpr int kMostRounds = 20;              // of adding places: five have been enough
constexpr std::size_t kMostPlaces = 600000;  // a tolerance that asks for more is too fine

/// In the frame of the target's first part.
class RangeOfParts {
 public:
  RangeOfParts(const PreparedTarget& target, double tolerance_m)
      : range_(range_limit_m(target.sensor())), tolerance_(tolerance_m) {
    Box box;
    for (std::size_t i = 0; i < target.part_count(); ++i) {
      for (const Eigen::Vector2d& corner : target.frame(i).polygon) {
        const Vec3 at = target.frame(i).to_scene({corner.x(), corner.y(), 0});
        corners_.push_back(target.frame().to_local(at));
        box.extend(corners_.back());
      }
    }
    middle_ = {(box.min.x() + box.max.x()) / 2, (box.min.y() + box.max.y()) / 2, 0};
  }

  /// nullopt where the middle is out of range, or the tolerance is too fine.
  std::optional<Mesh> mesh() const;

 private:
  double reach(const Vec3& direction) const;
  Vec3 place(const Vec3& direction) const { return middle_ + reach(direction) * direction; }
  std::vector<Vec3> first_places() const;
  bool is_fine(const Vec3& a, const Vec3& b, const Vec3& c) const;
  bool add_places(const Mesh& hull, std::vector<Vec3>& places) const;

  double range_, tolerance_;
  std::vector<Vec3> corners_;
  Vec3 middle_;
};

/// From the middle to the first sphere, along a direction of unit length.
double RangeOfParts::reach(const Vec3& direction) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners_) {
    const Vec3 from = middle_ - corner;
    const double along = from.dot(direction), power = range_ * range_ - from.squaredNorm();
    const double root = std::sqrt(along * along + power);
    least = std::min(least, along > 0 ? power / (along + root) : root - along);
  }
  return (1 - kInside) * least;
}

/// In rows of one height above the plane, of which the first one lies in it.
std::vector<Vec3> RangeOfParts::first_places() const {
  constexpr double kWidest = 0.3;  // radians
  const double apart = std::min(kWidest, std::sqrt(4 * tolerance_ / range_)), quarter = std::numbers::pi / 2;
  if (!(2 * std::numbers::pi / (apart * apart) < kMostPlaces)) return {};
  const int rows = static_cast<int>(std::ceil(quarter / apart));
  std::vector<Vec3> places{place(Vec3::UnitZ())};
  for (int row = 0; row < rows; ++row) {
    const portable::SineCosine height = portable::sine_cosine(row * quarter / rows);
    const int count = std::max(6, static_cast<int>(std::ceil(4 * rows * height.cosine)));
    for (int i = 0; i < count; ++i) {
      const portable::SineCosine turn = portable::sine_cosine((i + 0.5 * (row % 2)) * 4 * quarter / count);
      const Vec3 level(turn.cosine, turn.sine, 0);
      places.push_back(place(row == 0 ? level : Vec3(height.cosine * level + height.sine * Vec3::UnitZ())));
    }
  }
  return places;
}

/// Whether no point of a facet is farther inside than the tolerance. Either one sphere says so, whose centre has that
/// distance from the facet's plane. Or the middle does: how far inside a point lies, as a part of its ray, is concave
/// on a facet and never negative, so nowhere more than three times what it is in the middle.
bool RangeOfParts::is_fine(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  double deepest = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : corners_) deepest = std::min(deepest, range_ - normal.dot(a - corner));
  if (deepest <= tolerance_) return true;
  const Vec3 way = (a + b + c) / 3 - middle_;
  const double part = 3 * (1 - way.norm() / reach(way.normalized()));
  const double farthest =
      std::sqrt(std::max({(a - middle_).squaredNorm(), (b - middle_).squaredNorm(), (c - middle_).squaredNorm()}));
  return part < 1 && farthest * part / (1 - part) <= tolerance_;
}

/// For facets that are not fine, where their middles and those of their sides lie deep. False where all are fine.
bool RangeOfParts::add_places(const Mesh& hull, std::vector<Vec3>& places) const {
  constexpr double kDeep = 0.5;  // of the deepest of a facet
  const std::size_t before = places.size();
  const auto& v = hull.vertices;
  for (const auto& [a, b, c] : hull.triangles) {
    const bool is_base = v[a].z() == 0 && v[b].z() == 0 && v[c].z() == 0;
    if (is_base || is_fine(v[a], v[b], v[c])) continue;
    std::array<Vec3, 4> found;
    std::array<double, 4> depths;
    const std::array<Vec3, 4> points{(v[a] + v[b] + v[c]) / 3, (v[a] + v[b]) / 2, (v[b] + v[c]) / 2, (v[c] + v[a]) / 2};
    for (std::size_t i = 0; i < points.size(); ++i) {
      found[i] = place((points[i] - middle_).normalized());
      depths[i] = (found[i] - points[i]).norm();
    }
    const double least = kDeep * *std::max_element(depths.begin(), depths.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (depths[i] >= least) places.push_back(found[i]);
    }
  }
  return places.size() > before;
}

std::optional<Mesh> RangeOfParts::mesh() const {
  for (const Vec3& corner : corners_) {
    if (!((middle_ - corner).norm() < range_ * (1 - kInside))) return std::nullopt;
  }
  std::vector<Vec3> places = first_places();
  if (places.empty()) return std::nullopt;
  for (int round = 0; round < kMostRounds && places.size() < kMostPlaces; ++round) {
    Mesh hull = convex_hull(places);
    if (!add_places(hull, places)) return hull;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Volume> range_of_parts(const PreparedTarget& target, const ExactOptions& options) {
  std::optional<Mesh> mesh = RangeOfParts(target, options.tolerance_m).mesh();
  if (!mesh || mesh->empty()) return std::nullopt;
  Volume volume;
  volume.tolerance_m = options.tolerance_m;
  volume.frame = target.frame();
  volume.notes = target.notes();
  for (std::size_t i = 0; i < target.part_count(); ++i) volume.lift_m.push_back(target.lift_m(i));
  volume.provenance = {VANTAGE_VERSION, "exact", target.target(), target.sensor(), "", ""};
  volume.causes = {{CauseKind::range, "max_range"}, {CauseKind::target_plane, "target plane"}};
  core::LabelledMesh labelled{*std::move(mesh), {}};
  for (const Triangle& t : labelled.mesh.triangles) {
    const bool is_base =
        std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return labelled.mesh.vertices[v].z() == 0; });
    labelled.labels.push_back(is_base ? 1 : 0);
  }
  for (Vec3& vertex : labelled.mesh.vertices) vertex = volume.frame.to_scene(vertex);
  core::mend_for_doubles(labelled);
  volume.polygon_of.assign(labelled.labels.size(), kNoPolygon);
  volume.mesh = std::move(labelled.mesh);
  volume.cause_of = std::move(labelled.labels);
  return volume;
}

}  // namespace vantage::internal::solid
