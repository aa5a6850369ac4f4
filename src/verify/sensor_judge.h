// What the sensor asks of a viewpoint, each limit by its definition in vantage/sensor.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/sensor.h"
#include "verify/frame_search.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {

class SensorJudge {
 public:
  struct Judgement {
    Finding finding = Finding::kept;
    std::string limit;  ///< that is broken: "max_range", "min_range", "incidence", "pixel", "sun", "frame" or "gimbal"
  };

  /// Keeps a reference to the parts. `tolerance_m`: how far inside the range its facets may lie. Throws Error(input)
  /// for a sensor that is wrong in itself, and for a limit that needs a plane where a point has none.
  SensorJudge(const Sensor& sensor, const std::vector<TargetView>& parts, double tolerance_m);

  /// To every vertex of the target, at most; metres, finite.
  double range() const { return range_; }

  /// Judges a viewpoint that is claimed, in the first part's frame: broken is what is broken by more than rounding.
  Judgement of_claimed(const Vec3& position) const { return judge(position, claimed_); }

  /// Judges a viewpoint that is not claimed: broken is also what facets on the safe side may take away.
  Judgement of_unclaimed(const Vec3& position) const { return judge(position, unclaimed_); }

 private:
  /// The limits as numbers to compare with. Angles in radians.
  struct Thresholds {
    double max_range = 0, min_range = 0;  ///< metres
    double incidence = 0, sun = 0;
    double pixel_height = 0;  ///< metres that a viewpoint may be too low for its pixels,
    double pixel_slack = 0;   ///< besides this times its distance
    double frame_loose = 0;   ///< the frame is judged that far from the viewpoint too, of the distance to the target
  };

  Judgement judge(const Vec3& position, const Thresholds& than) const;
  std::optional<std::string> broken_by_part(const TargetView& part, const Vec3& own, const Thresholds& than) const;
  Judgement frame(const Vec3& position, const Thresholds& than) const;
  Judgement frame_at(const Vec3& position) const;
  std::vector<Vec3> directions(const Vec3& position) const;
  Vec3 in_frame_of(const TargetView& part, const Vec3& position) const {
    return position + (parts_.front().origin() - part.origin());
  }

  Sensor sensor_;
  const std::vector<TargetView>& parts_;
  Vec3 middle_;  ///< of all vertices, in the first part's frame
  Vec3 sun_ = Vec3::UnitZ();
  double range_ = 0, pixel_range_ = 0;  ///< metres; infinite where nothing limits it
  Thresholds claimed_, unclaimed_;
  std::optional<FrameSearch> mounted_, free_;  ///< as the camera is, and as if it could look anywhere
};

}  // namespace vantage::internal::verify
