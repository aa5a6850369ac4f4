// HiGHS: Huangfu and Hall, "Parallelizing the dual revised simplex method", 2018. The only file that sees it.
#include <Highs.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flight/tour/linear_program.h"

namespace vantage::internal::flight::tour {
namespace {

double bound_of(double bound) { return std::isinf(bound) ? std::copysign(kHighsInf, bound) : bound; }

class HighsProgram : public LinearProgram {
 public:
  HighsProgram() {
    highs_.setOptionValue("output_flag", false);
    highs_.setOptionValue("threads", 1);
    highs_.setOptionValue("parallel", "off");
    highs_.setOptionValue("solver", "simplex");
    highs_.setOptionValue("random_seed", 0);
  }

  void add_row(double lower, double upper, std::span<const Entry> columns) override {
    split(columns);
    highs_.addRow(bound_of(lower), bound_of(upper), static_cast<HighsInt>(index_.size()), index_.data(),
                  number_.data());
  }

  void add_column(double cost, double lower, double upper, std::span<const Entry> rows) override {
    split(rows);
    highs_.addCol(cost, bound_of(lower), bound_of(upper), static_cast<HighsInt>(index_.size()), index_.data(),
                  number_.data());
  }

  void set_column_bounds(std::size_t column, double lower, double upper) override {
    highs_.changeColBounds(static_cast<HighsInt>(column), bound_of(lower), bound_of(upper));
  }

  void set_cost(std::size_t column, double cost) override { highs_.changeColCost(static_cast<HighsInt>(column), cost); }

  bool solve(double time_limit_s) override {
    highs_.setOptionValue("time_limit", highs_.getRunTime() + std::max(0.0, time_limit_s));
    const HighsStatus status = highs_.run();
    return status != HighsStatus::kError && highs_.getModelStatus() == HighsModelStatus::kOptimal &&
           highs_.getSolution().dual_valid;
  }

  bool is_infeasible() const override { return highs_.getModelStatus() == HighsModelStatus::kInfeasible; }
  double value(std::size_t column) const override { return highs_.getSolution().col_value[column]; }
  double dual(std::size_t row) const override { return highs_.getSolution().row_dual[row]; }

 private:
  void split(std::span<const Entry> entries) {
    index_.clear();
    number_.clear();
    for (const auto& [index, number] : entries) {
      index_.push_back(static_cast<HighsInt>(index));
      number_.push_back(number);
    }
  }

  Highs highs_;
  std::vector<HighsInt> index_;
  std::vector<double> number_;
};

}  // namespace

std::unique_ptr<LinearProgram> make_linear_program() { return std::make_unique<HighsProgram>(); }

bool has_linear_programs() { return true; }

}  // namespace vantage::internal::flight::tour
