// A target that is ready to be seen: checked against its scene, once, for every method.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/navigation.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage {

/// A target in a scene, with the range it is looked at from. Immutable and cheap to copy (a shared handle); any number
/// of threads may use it at once. Holds on to the scene.
class VANTAGE_API PreparedTarget {
 public:
  /// Checks the target and finds how far each part must be raised to clear the surface that it lies on: rounding of
  /// the input, less than 2.01 mm; where max_range is less than 20 m, in proportion. Throws Error(input) for a bad
  /// target (see make_target_frame), a pierced one (object, place, smallest offset that clears it) and a max_range that
  /// is not positive and finite, or beyond 1e9 m. Cost: in proportion to the scene's polygons near the target.
  PreparedTarget(const PreparedScene& scene, const Target& target, const Sensor& sensor);

  const PreparedScene& scene() const;
  const Target& target() const;  ///< as given
  const Sensor& sensor() const;
  std::size_t part_count() const;

  /// Of a part as it is used, lift included.
  const TargetFrame& frame(std::size_t part = 0) const;
  double lift_m(std::size_t part) const;      ///< how far it was raised
  double lift_m() const;                      ///< the largest
  const std::vector<Warning>& notes() const;  ///< what to know before relying on results: the target seems to be
                                              ///< under the ground

  /// The same of one part alone.
  PreparedTarget part(std::size_t index) const;

  /// One part cut into `count` convex cells of the same area, which together hold all of it: in its plane, raised as it
  /// is, and seen from its side. Their sensor has this range, more than the radius of the part's enclosing circle, and
  /// nothing else. Twice as many cells are halves of these where `count` is a power of two. Cells overlap by rounding,
  /// in parts of the target's extent by 1e-12 and where the cut passes a corner by at most 1e-6. Throws Error(input)
  /// for a point.
  std::vector<PreparedTarget> cells(std::size_t part, std::size_t count, double max_range_m) const;

  /// The same target where it is, in a scene without anything.
  PreparedTarget alone() const;

  struct Data;
  const Data& data() const { return *data_; }  ///< for the methods

 private:
  explicit PreparedTarget(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace vantage
