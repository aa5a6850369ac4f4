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

}  // namespace vantage
