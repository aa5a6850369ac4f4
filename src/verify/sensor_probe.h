// The check of a limit of the sensor by viewpoints: each room of src/limits/ defines that of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vantage/each_limit.h"
#include "verify/frame_search.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {

/// Whether a volume claims the viewpoint that is judged.
enum class Judged {
  claimed,    ///< broken is what is broken by more than rounding
  unclaimed,  ///< broken is also what facets on the safe side may take away
};

struct SensorJudgement {
  Finding finding = Finding::kept;
  std::string limit;  ///< that is broken: "max_range", "min_range", "incidence", "pixel", "sun", "frame" or "gimbal"
};

class SensorProbe {
 public:
  SensorProbe() = default;
  SensorProbe(const SensorProbe&) = delete;
  SensorProbe& operator=(const SensorProbe&) = delete;
  virtual ~SensorProbe() = default;

  /// Of a viewpoint in the frame of the target's first part.
  virtual SensorJudgement judge(const Vec3& position, Judged as) const = 0;
};

/// A position in the frame of the first part, in that of another.
inline Vec3 in_frame_of(const TargetView& part, const Vec3& position, const std::vector<TargetView>& parts) {
  return position + (parts.front().origin() - part.origin());
}

/// A limit that a viewpoint breaks where it breaks it for one of the parts. `breaks`: whether it does, for a position
/// in the part's own frame.
std::unique_ptr<const SensorProbe> probe_of_parts(
    const std::string& limit, const std::vector<TargetView>& parts,
    std::function<bool(const TargetView& part, const Vec3& own, Judged as)> breaks);

/// Keeps a reference to the parts. Throws Error(input) for a limit that is wrong in itself or needs a plane where a
/// point has none. Declared alone: a limit whose room has no check does not link.
template <Limit kLimit>
std::unique_ptr<const SensorProbe> probe_of(const LimitValueOf<kLimit>& limit, const Sensor& sensor,
                                            const std::vector<TargetView>& parts);

/// Throws Error(input) for a point without a front. `limit`: "sensor pixel".
void check_has_plane(const std::vector<TargetView>& parts, const std::string& limit);

/// Between two vectors of any length but 0; exact near 0 and near a right angle.
double angle_between(const Vec3& a, const Vec3& b);

/// The angle of a cone whose tangent is so many times that of the given one, radians: that of a cone with flat sides. A
/// right angle is flat as it is.
double with_tangent_times(double angle, double factor);

}  // namespace vantage::internal::verify
