// Whether a position sees the target, and along which parts of a leg it does.
#include "vantage/query.h"

namespace example {

bool sees(const vantage::PreparedTarget& target) { return vantage::query_points(target, {}, {{0, 0, 20}})[0].inside; }

std::size_t parts_of_leg(const vantage::PreparedTarget& target) {
  return vantage::LegViews(target).look({{-50, 0, 20}, {50, 0, 20}}).seen.size();
}

}  // namespace example
