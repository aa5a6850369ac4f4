// A polygon of the scene in pieces over which the zone of a radio link is about equally wide, each grown by that width.
#pragma once

#include <optional>
#include <vector>

#include "exact/zone_radius.h"
#include "vantage/geometry.h"

namespace vantage::internal::exact {

/// Coordinates are about the antenna, metres.
struct GrownPiece {
  std::vector<Vec3> hull;                   ///< corners of a convex polytope that holds the piece grown by its radius
  std::vector<std::vector<Vec3>> surfaces;  ///< convex polygons: no line from the antenna to a vehicle within range
                                            ///< passes all of them by if the piece enters the vehicle's zone
};

/// Cuts polygons up and grows the pieces.
class ZonePieces {
 public:
  /// `clear`: polygons must be this far from the antenna, metres.
  ZonePieces(const ZoneRadius& radius, double clear) : radius_(radius), clear_(clear) {}

  /// Calls act(piece) for each piece of a convex polygon that is within reach. Returns false, at once, where a piece
  /// holds the antenna, or all but holds it: then it enters the zone of any vehicle, or all but does.
  template <typename Act>
  bool for_each(std::vector<Vec3> corners, const Act& act) {
    waiting_.clear();
    waiting_.push_back(std::move(corners));
    while (!waiting_.empty()) {
      const std::vector<Vec3> piece = std::move(waiting_.back());
      waiting_.pop_back();
      const Step step = look_at(piece);
      if (step == Step::covers) return false;
      if (step == Step::far || step == Step::halve) continue;
      const std::optional<GrownPiece> grown = grow(piece);
      if (!grown) return false;
      act(*grown);
    }
    return true;
  }

 private:
  enum class Step { far, covers, halve, grow };

  /// Puts the halves of a piece that is too uneven on the stack.
  Step look_at(const std::vector<Vec3>& piece);
  std::optional<GrownPiece> grow(const std::vector<Vec3>& piece) const;

  ZoneRadius radius_;
  double clear_;
  std::vector<std::vector<Vec3>> waiting_;
};

}  // namespace vantage::internal::exact
