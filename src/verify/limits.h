// Navigation limits as a set of points.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/navigation.h"
#include "verify/limit_probe.h"

namespace vantage::internal::verify {

class Limits {
 public:
  /// Throws Error(input) for a reversed band, box or zone, for a zone without corners and for a keep-in mesh that is
  /// not closed.
  Limits(const Navigation& navigation, const Vec3& origin);

  /// Name of the first limit that the local point breaks; nothing where it keeps them all. Borders are allowed.
  std::optional<std::string> broken_by(const Vec3& point) const;

  /// Whether a volume may leave the point out for one of the limits, though it keeps them all.
  bool may_leave_out(const Vec3& point) const;

 private:
  Vec3 origin_;
  std::vector<std::unique_ptr<const LimitProbe>> probes_;
};

}  // namespace vantage::internal::verify
