#include "core/navigation_check.h"
#include "query/ground_heights.h"
#include "vantage/ground.h"

namespace vantage {

struct GroundLevels::Data {
  internal::query::GroundHeights heights;
};

GroundLevels::GroundLevels(const Ground& ground) {
  internal::core::check_ground(ground, "GroundLevels");
  data_ = std::make_unique<Data>(Data{internal::query::GroundHeights(ground)});
}
GroundLevels::~GroundLevels() = default;
GroundLevels::GroundLevels(GroundLevels&&) noexcept = default;
GroundLevels& GroundLevels::operator=(GroundLevels&&) noexcept = default;

std::optional<GroundLevels::Range> GroundLevels::at(double x, double y) const {
  const auto found = data_->heights.at(x, y);
  if (!found) return std::nullopt;
  return Range{found->lowest_m, found->highest_m};
}

}  // namespace vantage
