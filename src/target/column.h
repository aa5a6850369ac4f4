// What of the scene crosses the column that stands on the target.
#pragma once

#include <cstdint>
#include <vector>

#include "core/facet_polygon.h"
#include "scene/prepared_data.h"
#include "target/lengths.h"
#include "target/local_target.h"
#include "vantage/target.h"

namespace vantage::internal::target {

/// The heights at which a scene polygon crosses the column.
struct Crossing {
  double low, high;
  std::uint32_t polygon;
  Vec3 place;  ///< local, at the lowest point
};

class Column {
 public:
  /// Keeps references. Polygons that reach nowhere above `floor` do not count.
  Column(const PreparedScene::Data& scene, const TargetFrame& frame, const Lengths& lengths, double floor);

  /// Crossings that begin below `ceiling` and end above the target's plane, or just below it if the polygon stands
  /// above the plane elsewhere; with a floor below the plane, those that end above the floor. Walls that only touch the
  /// target's outline do not cross its column.
  std::vector<Crossing> crossings(double ceiling);

 private:
  bool meets(const core::Bounds& bounds, double ceiling) const;
  void add_crossing(std::uint32_t polygon, double ceiling, std::vector<Crossing>& found);

  const PreparedScene::Data& scene_;
  const TargetFrame& frame_;
  Lengths lengths_;
  LocalTarget target_;
  double floor_;
  core::FacetPolygon clipped_, scratch_;
};

/// Whether something passes through the target at that height.
inline bool crosses(const Crossing& crossing, double height, const Lengths& lengths) {
  return crossing.low <= height + lengths.slack && crossing.high > height + lengths.slack;
}

/// How far a target at some height is raised to clear the surface that it lies on, and what crosses it there.
struct Lift {
  double lift = 0;
  const Crossing* pierced_by = nullptr;
};
Lift lift_at(const std::vector<Crossing>& crossings, double height, const Lengths& lengths);

/// Heights that people are told are whole steps: millimetres, in small worlds less.
struct HeightStep {
  explicit HeightStep(const Lengths& lengths);
  double past(double height) const;  ///< the next whole step
  int decimals = 3;
};

/// The smallest height from `from` on, in whole steps, at which nothing crosses.
double clear_height(const std::vector<Crossing>& crossings, const Lengths& lengths, double from = 0);

}  // namespace vantage::internal::target
