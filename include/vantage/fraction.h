// How much of a target a point sees, and which part of it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"

namespace vantage {

/// What the seen part and the whole target are measured by. Of a target in parts the parts add up.
enum class FractionMeasure : std::uint8_t {
  area,         ///< on the target
  solid_angle,  ///< from the point
  /// In the image of a pinhole camera (rectilinear, no distortion) at the point, that looks along the axis of the
  /// narrowest cone about the lines of sight to the target's corners. All of the target is then less than 90 degrees
  /// off that axis, so its image is finite. Of a target in parts the camera turns to each part in turn.
  pixels,
};

/// "area", "solid_angle", "pixels".
VANTAGE_API const char* name_of(FractionMeasure measure);

/// The measure of that name; nothing for other words.
VANTAGE_API std::optional<FractionMeasure> fraction_measure(std::string_view name);

/// A plane polygon with holes in the scene frame, metres. Rings run round once, without repeating their first corner:
/// the outer one counter-clockwise, holes clockwise, seen from the target's front. Rings may touch in points.
struct SeenPolygon {
  std::vector<Vec3> outer;
  std::vector<std::vector<Vec3>> holes;
};

struct FractionOptions {
  FractionMeasure measure = FractionMeasure::area;
  bool with_polygons = false;  ///< fill PointFraction::seen too; takes about as long again
};

/// What a point sees of a target.
struct PointFraction {
  /// 0 to 1. Exactly 1 where PointAnswer names nothing that hides some of the target (`blocked_by`), and the point is
  /// in front of all parts (`behind_target`); below 1 everywhere else. Range and navigation limits play no role.
  double fraction = 0;
  std::vector<SeenPolygon> seen;  ///< as asked for; the parts of the target in their order. Nothing for a single point
};

/// The seen parts of a target as GeoJSON (RFC 7946): a collection of one feature for each point, written as they come.
/// Positions are longitude, latitude (WGS 84, degrees) and the z of the scene. Without a place on the earth they are x,
/// y and z of the scene frame, metres, which the RFC leaves to agreement; "coordinate_frame" says which of the two.
class VANTAGE_API SeenGeoJson {
 public:
  explicit SeenGeoJson(std::optional<Georeference> place, FractionMeasure measure)
      : place_(std::move(place)), measure_(measure) {}

  /// Before the first feature, and after the last.
  std::string beginning() const;
  std::string end() const;

  /// A Polygon, a MultiPolygon, or no geometry where nothing is seen. Properties: "index", the number of the point from
  /// 0, "measure" and "fraction". `id`: the feature's, where it is given. Throws Error(input) for a polygon that is not
  /// on the earth.
  std::string feature(const PointFraction& answer, const std::optional<std::string>& id = std::nullopt);

 private:
  std::optional<Georeference> place_;
  FractionMeasure measure_;
  std::size_t count_ = 0;
};

}  // namespace vantage
