// More digits than a double has, for what is too narrow for doubles.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace vantage::internal::prove {

/// Where long double has no more digits than double, no more is found, and nothing is wrong.
using FineVec3 = Eigen::Matrix<long double, 3, 1>;

constexpr double kFineUnitRounding = static_cast<double>(std::numeric_limits<long double>::epsilon()) / 2;

}  // namespace vantage::internal::prove
