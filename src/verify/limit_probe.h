// The check of a limit of navigation by points: each room of src/limits/ defines that of its own.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vantage/each_limit.h"

namespace vantage::internal::verify {

struct JudgedPoint {
  Vec3 local, scene;  ///< about the origin of the check, and in the scene frame
};

class LimitProbe {
 public:
  LimitProbe() = default;
  LimitProbe(const LimitProbe&) = delete;
  LimitProbe& operator=(const LimitProbe&) = delete;
  virtual ~LimitProbe() = default;

  /// The name, as answers for points have it, of what the point breaks; nothing where it keeps the limit. Borders are
  /// allowed.
  virtual std::optional<std::string> broken_by(const JudgedPoint& point) const = 0;

  /// Whether a volume may leave the point out for the limit, though it keeps it: what is cut away may reach too far.
  virtual bool may_leave_out(const JudgedPoint& point) const = 0;
};

/// `origin`: of JudgedPoint::local. Throws Error(input) for a limit that is wrong in itself. Declared alone: a limit
/// whose room has no check does not link.
template <Limit kLimit>
std::unique_ptr<const LimitProbe> probe_of(const LimitValueOf<kLimit>& limit, const Vec3& origin);

}  // namespace vantage::internal::verify
