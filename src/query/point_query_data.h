// What PointQuery holds.
#pragma once

#include <vector>

#include "query/limits.h"
#include "query/side.h"
#include "vantage/query.h"

namespace vantage {

struct PointQuery::Data {
  PreparedTarget target;
  internal::query::Limits limits;
  std::vector<internal::query::Sides> parts;
};

namespace internal::query {

/// Throws Error(input) for a target at the end of a radio link: it is reached or not.
void check_has_share(const PreparedTarget& target);

}  // namespace internal::query
}  // namespace vantage
