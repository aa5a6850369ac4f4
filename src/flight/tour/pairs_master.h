// The linear program of the bound by pairs, over the columns that matter so far.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "flight/tour/linear_program.h"
#include "flight/tour/pair_costs.h"
#include "flight/tour/pairs_bound.h"

namespace vantage::internal::flight::tour {

/// Metres; duals are whole multiples.
constexpr double kDualUnit = 0x1p-30;

/// The linear program over the columns that matter so far.
class PairsMaster {
 public:
  PairsMaster(const PairCosts& costs, double penalty) : costs_(costs), penalty_(penalty), n_(costs.count()) {
    program_ = make_linear_program();
    column_of_edge_.assign(n_ * n_, kNoColumn);
    row_of_edge_at_.assign(n_ * n_, kNoColumn);
    has_pair_.assign(n_ * n_ * n_, false);
    beside_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      add_row(2, 2);
      add_column(penalty_, {{i, 2.0}});
    }
  }

  bool has_edge(std::size_t i, std::size_t j) const { return column_of_edge_[i * n_ + j] != kNoColumn; }
  const std::vector<PairEdge>& edges() const { return edges_; }
  std::size_t columns() const { return columns_; }

  void add_edge(std::size_t i, std::size_t j) {
    if (i == j || has_edge(i, j)) return;
    for (const auto& [at, to] : {std::pair(i, j), std::pair(j, i)}) {
      row_of_edge_at_[at * n_ + to] = rows_;
      add_row(0, 0);
    }
    const std::size_t one = row_of_edge_at_[i * n_ + j], other = row_of_edge_at_[j * n_ + i];
    std::vector<LinearProgram::Entry> entries = {{i, 1.0}, {j, 1.0}, {one, -1.0}, {other, -1.0}};
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      if (sets_[s][i] != sets_[s][j]) entries.emplace_back(row_of_set_[s], 1.0);
    }
    column_of_edge_[i * n_ + j] = column_of_edge_[j * n_ + i] = columns_;
    add_column(0, entries);
    add_column(penalty_, {{one, 1.0}});
    add_column(penalty_, {{other, 1.0}});
    edges_.push_back(edge_of(i, j));
    for (const auto& [at, to] : {std::pair(i, j), std::pair(j, i)}) {
      for (const std::size_t k : beside_[at]) add_pair(at, to, k);
      beside_[at].push_back(to);
    }
  }

  void add_pair(std::size_t i, std::size_t j, std::size_t k) {
    const std::size_t key = (i * n_ + std::min(j, k)) * n_ + std::max(j, k);
    if (has_pair_[key]) return;
    has_pair_[key] = true;
    add_column(costs_(i, j, k), {{row_of_edge_at_[i * n_ + j], 1.0}, {row_of_edge_at_[i * n_ + k], 1.0}});
  }
  bool has_pair(std::size_t i, std::size_t j, std::size_t k) const {
    return has_pair_[(i * n_ + std::min(j, k)) * n_ + std::max(j, k)];
  }

  void add_set(const std::vector<bool>& in) {
    std::vector<LinearProgram::Entry> entries;
    for (const PairEdge& e : edges_) {
      if (in[e[0]] != in[e[1]]) entries.emplace_back(column_of_edge_[e[0] * n_ + e[1]], 1.0);
    }
    sets_.push_back(in);
    row_of_set_.push_back(rows_++);
    program_->add_row(2, std::numeric_limits<double>::infinity(), entries);
    add_column(penalty_, {{row_of_set_.back(), 1.0}});
  }

  void fix(const FixedEdges& fixed) {
    for (const PairEdge& e : edges_) {
      const bool out = fixed.is_out(e[0], e[1]), in = fixed.is_in(e[0], e[1]);
      program_->set_column_bounds(column_of_edge_[e[0] * n_ + e[1]], in ? 1 : 0, out ? 0 : 1);
    }
  }

  bool solve(double time_limit_s) { return program_->solve(time_limit_s); }
  double value(const PairEdge& e) const { return program_->value(column_of_edge_[e[0] * n_ + e[1]]); }

  PairsDuals duals() const {
    PairsDuals duals;
    duals.of_edge_at.assign(n_, std::vector<double>(n_, 0.0));
    for (std::size_t i = 0; i < n_; ++i) {
      duals.of_region.push_back(rounded(program_->dual(i)));
      for (const std::size_t j : beside_[i]) {
        duals.of_edge_at[i][j] = rounded(program_->dual(row_of_edge_at_[i * n_ + j]));
      }
    }
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      const double dual = rounded(program_->dual(row_of_set_[s]));
      if (!(dual > 0)) continue;
      std::vector<std::size_t> members;
      for (std::size_t i = 0; i < n_; ++i) {
        if (sets_[s][i]) members.push_back(i);
      }
      duals.of_set.emplace_back(dual, std::move(members));
    }
    return duals;
  }

 private:
  static constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();
  static double rounded(double value) { return std::round(value / kDualUnit) * kDualUnit; }
  void add_row(double lower, double upper) {
    program_->add_row(lower, upper, {});
    ++rows_;
  }
  void add_column(double cost, const std::vector<LinearProgram::Entry>& rows) {
    program_->add_column(cost, 0, std::numeric_limits<double>::infinity(), rows);
    ++columns_;
  }

  const PairCosts& costs_;
  double penalty_;
  std::size_t n_, rows_ = 0, columns_ = 0;
  std::unique_ptr<LinearProgram> program_;
  std::vector<std::size_t> column_of_edge_, row_of_edge_at_, row_of_set_;
  std::vector<bool> has_pair_;
  std::vector<std::vector<std::size_t>> beside_;
  std::vector<PairEdge> edges_;
  std::vector<std::vector<bool>> sets_;
};

/// Sets that a solution leaves less than twice: the parts of the graph, or else the cuts of the phases of Stoer and
/// Wagner 1997.
std::vector<std::vector<bool>> short_cuts(const std::vector<std::vector<double>>& weights);

}  // namespace vantage::internal::flight::tour
