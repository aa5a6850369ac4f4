// Linear programs that grow: minimise cost . x, rows and columns within bounds. Who solves them is chosen when vantage
// is built (VANTAGE_WITH_HIGHS): linear_program_*.cpp. What it returns is not trusted anywhere.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>

namespace vantage::internal::flight::tour {

class LinearProgram {
 public:
  using Entry = std::pair<std::size_t, double>;  ///< the number of a row or of a column, and its coefficient

  LinearProgram() = default;
  LinearProgram(const LinearProgram&) = delete;
  LinearProgram& operator=(const LinearProgram&) = delete;
  virtual ~LinearProgram() = default;

  /// Numbered in the order in which they are added. Infinite bounds are allowed.
  virtual void add_row(double lower, double upper, std::span<const Entry> columns) = 0;
  virtual void add_column(double cost, double lower, double upper, std::span<const Entry> rows) = 0;
  virtual void set_column_bounds(std::size_t column, double lower, double upper) = 0;
  virtual void set_cost(std::size_t column, double cost) = 0;

  /// Goes on from the last solution. False where none was found in time, or there is none: then duals and values mean
  /// nothing.
  virtual bool solve(double time_limit_s) = 0;
  virtual bool is_infeasible() const = 0;  ///< of the last solve(): it is known that there is no solution
  virtual double value(std::size_t column) const = 0;
  /// How much the cost rises with the row's bound.
  virtual double dual(std::size_t row) const = 0;
};

/// None where vantage was built without a solver.
std::unique_ptr<LinearProgram> make_linear_program();
bool has_linear_programs();

}  // namespace vantage::internal::flight::tour
