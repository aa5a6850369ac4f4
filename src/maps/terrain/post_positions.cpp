// Interpolation at Chebyshev points, in barycentric form: Berrut and Trefethen, "Barycentric Lagrange interpolation",
// 2004.
#include "maps/terrain/post_positions.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace vantage::internal::terrain {
namespace {

constexpr std::size_t kNodes = 9;  // per direction
constexpr double kTolerance_m = 1e-4;
constexpr std::size_t kFew = 1024;  // posts: not worth a polynomial

using Weights = std::array<double, kNodes>;

/// Chebyshev points of the second kind on [0, length].
class Nodes {
 public:
  explicit Nodes(double length) {
    for (std::size_t i = 0; i < kNodes; ++i) {
      places_[i] = length / 2 * (1 - std::cos(std::numbers::pi * static_cast<double>(i) / (kNodes - 1)));
    }
  }
  double operator[](std::size_t i) const { return places_[i]; }

  /// What the value at each node counts at a place.
  Weights weights(double at) const {
    Weights weights{};
    double sum = 0;
    for (std::size_t i = 0; i < kNodes; ++i) {
      const double distance = at - places_[i];
      if (distance == 0) {
        weights = {};
        weights[i] = 1;
        return weights;
      }
      weights[i] = (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == kNodes - 1 ? 0.5 : 1.0) / distance;
      sum += weights[i];
    }
    for (double& weight : weights) weight /= sum;
    return weights;
  }

 private:
  std::array<double, kNodes> places_{};
};

class Interpolation {
 public:
  Interpolation(const HeightGrid& grid, const geo::LocalFrame& frame)
      : columns_(grid.columns - 1), rows_(grid.rows - 1) {
    const auto exact = [&](double column, double row) { return frame.to_local(grid.position({column, row})); };
    for (std::size_t i = 0; i < kNodes; ++i) {
      for (std::size_t j = 0; j < kNodes; ++j) values_[i][j] = exact(columns_[j], rows_[i]);
    }
    for (std::size_t i = 0; i + 1 < kNodes; ++i) {
      const double row = (rows_[i] + rows_[i + 1]) / 2;
      const RowValues values = row_values(row);
      for (std::size_t j = 0; j + 1 < kNodes; ++j) {
        const double column = (columns_[j] + columns_[j + 1]) / 2;
        const double error_m = (at(values, columns_.weights(column)) - exact(column, row)).norm();
        if (!(error_m <= kTolerance_m)) good_ = false;
      }
    }
  }

  bool good() const { return good_; }

  using RowValues = std::array<Eigen::Vector2d, kNodes>;
  RowValues row_values(double row) const {
    const Weights weights = rows_.weights(row);
    RowValues values;
    for (std::size_t j = 0; j < kNodes; ++j) {
      values[j].setZero();
      for (std::size_t i = 0; i < kNodes; ++i) values[j] += weights[i] * values_[i][j];
    }
    return values;
  }
  Weights column_weights(double column) const { return columns_.weights(column); }

  static Eigen::Vector2d at(const RowValues& values, const Weights& weights) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t j = 0; j < kNodes; ++j) sum += weights[j] * values[j];
    return sum;
  }

 private:
  Nodes columns_, rows_;
  std::array<RowValues, kNodes> values_;
  bool good_ = true;
};

}  // namespace

std::vector<Eigen::Vector2d> post_positions(const HeightGrid& grid, const geo::LocalFrame& frame) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(grid.heights_m.size());
  if (grid.heights_m.size() > kFew && grid.columns > 1 && grid.rows > 1) {
    const Interpolation interpolation(grid, frame);
    if (interpolation.good()) {
      std::vector<Weights> weights;
      for (int column = 0; column < grid.columns; ++column) weights.push_back(interpolation.column_weights(column));
      for (int row = 0; row < grid.rows; ++row) {
        const Interpolation::RowValues values = interpolation.row_values(row);
        for (const Weights& column : weights) positions.push_back(Interpolation::at(values, column));
      }
      return positions;
    }
  }
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      positions.push_back(frame.to_local(grid.position(Eigen::Vector2d(column, row))));
    }
  }
  return positions;
}

}  // namespace vantage::internal::terrain
