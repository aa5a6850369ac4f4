#include "io/stored_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "common/output.h"
#include "core/mend_welded.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

double largest_coordinate(const Box& box) {
  return std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
}

/// The distance between numbers of that many binary digits at the magnitude of `number` > 0.
double spacing(double number, int digits) {
  int exponent = 0;
  std::frexp(number, &exponent);  // number < 2^exponent
  return std::ldexp(1.0, exponent - digits);
}

/// Moves the vertices to `transform(vertex)` and makes the mesh whole for readers: `mend` says how far a point of the
/// surface moved for it, or nothing where nothing had to be changed.
template <typename Transform, typename Mend>
StoredMesh stored(const Volume& volume, const Transform& transform, const Mend& mend) {
  StoredMesh result;
  core::LabelledMesh labelled{volume.mesh, volume.cause_of};
  for (Vec3& vertex : labelled.mesh.vertices) {
    const Vec3 moved = transform(vertex);
    result.rounding_m = std::max(result.rounding_m, (moved - vertex).norm());
    vertex = moved;
  }
  if (result.rounding_m > 0) {
    const auto normal = [](const Mesh& mesh, const Triangle& t) {
      return (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    };
    for (const Triangle& t : volume.mesh.triangles) {
      if (normal(labelled.mesh, t).dot(normal(volume.mesh, t)) < 0) ++result.turned_facets;
    }
  }
  const std::optional<double> moved = mend(labelled);
  result.is_mended = moved.has_value();
  result.rounding_m += moved.value_or(0);
  result.mesh = std::move(labelled.mesh);
  result.cause_of = std::move(labelled.labels);
  return result;
}

/// Rounds to a grid about `origin` whose numbers single precision holds, all of them: so neighbouring vertices are
/// whole steps apart, also where the numbers are small, and what has no area has none in exact arithmetic.
StoredMesh stored_on_grid(const Volume& volume, const Box& box, const Vec3& origin) {
  constexpr int kFloatDigits = std::numeric_limits<float>::digits, kDoubleDigits = std::numeric_limits<double>::digits;
  const Box local{box.min - origin, box.max - origin};
  const double largest = largest_coordinate(local);
  if (largest > static_cast<double>(std::numeric_limits<float>::max())) {
    throw Error(ErrorCode::format_too_small, "the volume's coordinates are too large for single precision", "",
                "write " + double_extensions_text());
  }
  // Origin and number must also add up exactly where they are read.
  const double step = std::max({spacing(largest, kFloatDigits), spacing(largest_coordinate(box), kDoubleDigits),
                                static_cast<double>(std::numeric_limits<float>::min())});
  const auto transform = [&](const Vec3& vertex) {
    return Vec3(origin + ((vertex - origin) / step).array().round().matrix() * step);
  };
  StoredMesh result = stored(volume, transform, [&](core::LabelledMesh& labelled) {
    return core::mend_welded(labelled, 0) ? std::optional(core::split_on_grid(labelled, transform)) : std::nullopt;
  });
  result.origin = origin;
  if (result.mesh.empty()) {
    throw Error(ErrorCode::format_too_small,
                "nothing of the volume is left in single precision: at these coordinates it is coarse", "",
                "write " + double_extensions_text());
  }
  return result;
}

}  // namespace

StoredMesh stored_as_doubles(const Volume& volume) {
  return stored(
      volume, [](const Vec3& vertex) { return vertex; }, core::mend_for_doubles);
}

StoredMesh stored_in_units(const Volume& volume, double scale) {
  // Until the number that is written reads back as the one that it was made from: at once, as a rule.
  constexpr int kRounds = 4;
  const auto transform = [&](Vec3 vertex) {
    for (int round = 0; round < kRounds; ++round) vertex = vertex / scale * scale;
    return vertex;
  };
  return stored(volume, transform, [&](core::LabelledMesh& labelled) {
    const std::optional<double> moved = core::mend_for_doubles(labelled);
    if (!moved) return moved;
    // Where mending moved vertices the numbers are others.
    double again = 0;
    for (Vec3& vertex : labelled.mesh.vertices) {
      const Vec3 rounded = transform(vertex);
      again = std::max(again, (rounded - vertex).norm());
      vertex = rounded;
    }
    return std::optional<double>(*moved + again);
  });
}

StoredMesh stored_as_floats(const Volume& volume) {
  if (volume.mesh.empty()) return {};
  return stored_on_grid(volume, bounding_box(volume.mesh), Vec3::Zero());
}

StoredMesh stored_as_local_floats(const Volume& volume) {
  if (volume.mesh.empty()) return {};
  const Box box = bounding_box(volume.mesh);
  // Whole multiples of a sixteenth of the size, or so: the origin then lies on the grid.
  const double extent = (box.max - box.min).maxCoeff(), part = extent > 0 ? spacing(extent, 4) : 1;
  const double unit = std::max(part, spacing(std::max(largest_coordinate(box), extent), 53));
  return stored_on_grid(volume, box, ((box.min + box.max) / (2 * unit)).array().round() * unit);
}

}  // namespace vantage::internal::io
