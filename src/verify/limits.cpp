#include "verify/limits.h"

#include <algorithm>

namespace vantage::internal::verify {

Limits::Limits(const Navigation& navigation, const Vec3& origin) : origin_(origin) {
  each_limit(navigation, [&](auto limit, const auto& value) {
    probes_.push_back(probe_of<decltype(limit)::value>(value, origin));
  });
}

std::optional<std::string> Limits::broken_by(const Vec3& point) const {
  const JudgedPoint judged{point, point + origin_};
  for (const auto& probe : probes_) {
    if (auto limit = probe->broken_by(judged)) return limit;
  }
  return std::nullopt;
}

bool Limits::may_leave_out(const Vec3& point) const {
  const JudgedPoint judged{point, point + origin_};
  return std::any_of(probes_.begin(), probes_.end(), [&](const auto& probe) { return probe->may_leave_out(judged); });
}

}  // namespace vantage::internal::verify
