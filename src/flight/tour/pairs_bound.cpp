#include "flight/tour/pairs_bound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "flight/tour/linear_program.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
constexpr double kNoBound = std::numeric_limits<double>::infinity();
constexpr double kPairRounding = 0x1p-53;
constexpr double kDualUnit = 0x1p-30;  // metres; duals are whole multiples
constexpr std::size_t kFirstNeighbours = 8;
constexpr std::size_t kAllEdges = 16;  // of so many regions all edges are columns from the start
constexpr std::size_t kMostEdgesAtOnce = 60;
constexpr std::size_t kMostPairsAtOnce = 3;  // of a region and one of its edges
constexpr int kMostPairRounds = 60;          // of columns and cuts, for one node
constexpr double kPriced = 1e-7;             // of the size: reduced costs as low as that are 0
constexpr double kFractional = 1e-6;
constexpr std::size_t kMostPairOrders = 20;
constexpr std::size_t kMostTurnsKept = 2;  // of the vectors, at one node
constexpr std::size_t kMostFrames = 60;

double to_dual(double value) { return std::round(value / kDualUnit) * kDualUnit; }

using Edge = std::array<std::size_t, 2>;
Edge edge_of(std::size_t i, std::size_t j) { return {std::min(i, j), std::max(i, j)}; }

/// What is fixed at a node.
struct Fixed {
  std::set<Edge> inside, outside;
  bool is_out(std::size_t i, std::size_t j) const { return outside.contains(edge_of(i, j)); }
  bool is_in(std::size_t i, std::size_t j) const { return inside.contains(edge_of(i, j)); }
};

/// The shortest polyline in an order, and the vectors of its legs, which prove its length; without one points to begin
/// with.
struct Along {
  std::vector<Vec3> points;        // of each region
  std::vector<std::size_t> stops;  // in order, ends included
  std::vector<Direction> legs;     // from each stop to the next one
};

/// The vectors of all pairs and the costs that follow.
class PairCosts {
 public:
  PairCosts(const Cells& cells, const TourSpace& space, const Along& along)
      : regions_(cells.region_count()), count_(regions_ + (space.closed ? 0 : 1)) {
    vectors_.resize(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const bool anywhere = i >= regions_;
        vectors_[i].push_back(anywhere ? Direction{} : direction_of(unit_of(along.points[i] - along.points[j])));
      }
    }
    // Where legs of the tour have no length, or nearly so, only these vectors prove that they need none.
    for (std::size_t k = 0; k < along.legs.size(); ++k) {
      const std::size_t from = along.stops[k], to = along.stops[(k + 1) % along.stops.size()];
      Direction& vector = vectors_[std::max(from, to)][std::min(from, to)];
      vector = along.legs[k];
      if (to < from) {
        for (std::int32_t& x : vector) x = -x;
      }
    }
    costs_.assign(count_, std::vector<double>(count_ * count_, 0.0));
    for (std::size_t i = 0; i < regions_; ++i) {
      const double dwell = space.dwell_m.empty() ? 0 : space.dwell_m[i];
      const Hull& hull = *cells[i].hull;
      for (std::size_t j = 0; j < count_; ++j) {
        for (std::size_t k = j + 1; k < count_; ++k) {
          if (i == j || i == k) continue;
          costs_[i][j * count_ + k] = costs_[i][k * count_ + j] = cost(hull, vector(i, j), vector(i, k), dwell);
        }
      }
      error_ += (2 * 44 * kPairRounding * hull.reach_m() + 2.001 * hull.moved_m()) * 2 + 4 * kPairRounding * dwell;
    }
  }

  std::size_t count() const { return count_; }
  /// Of region i between j and k, but for rounding.
  double operator()(std::size_t i, std::size_t j, std::size_t k) const { return costs_[i][j * count_ + k]; }
  /// All rounding of the costs of a tour: as for touring_bound, at every region.
  double error_m() const { return error_; }
  const std::vector<std::vector<Direction>>& vectors() const { return vectors_; }

 private:
  static Vec3 unit_of(const Vec3& vector) {
    const double norm = vector.norm();
    return norm > 0 ? Vec3(vector / norm) : vector;
  }
  Vec3 vector(std::size_t i, std::size_t j) const {
    return j < i ? vector_of(vectors_[i][j]) : Vec3(-vector_of(vectors_[j][i]));
  }
  static double cost(const Hull& hull, const Vec3& one, const Vec3& other, double dwell) {
    if (dwell > 0) return one.dot(hull.lowest(one)) + other.dot(hull.lowest(other)) + dwell;
    const Vec3 both = one + other;  // exact
    return both.dot(hull.lowest(both));
  }

  std::size_t regions_, count_;
  std::vector<std::vector<Direction>> vectors_;
  std::vector<std::vector<double>> costs_;
  double error_ = 0;
};

/// What is proved by some duals, whatever they are: see the head of pairs_bound.h. All that rounding may add is taken
/// off.
double bound_of(const PairCosts& costs, const Fixed& fixed, const PairsDuals& duals) {
  const std::size_t n = costs.count();
  double sum = 0, size = 0;
  const auto add = [&](double term) {
    sum += term;
    size += std::abs(term);
  };
  for (const double d : duals.of_region) add(2 * d);
  std::vector<std::vector<double>> of_sets(n, std::vector<double>(n, 0.0));
  double largest = 0;
  for (const auto& [dual, members] : duals.of_set) {
    add(2 * dual);
    std::vector<bool> in(n, false);
    for (const std::size_t m : members) in[m] = true;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (in[i] != in[j]) of_sets[i][j] += dual;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::size_t> beside, must;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || fixed.is_out(i, j)) continue;
      beside.push_back(j);
      if (fixed.is_in(i, j)) must.push_back(j);
    }
    double least = kNoBound;
    const std::vector<double>& p = duals.of_edge_at[i];
    for (std::size_t a = 0; a < beside.size(); ++a) {
      for (std::size_t b = a + 1; b < beside.size(); ++b) {
        const std::size_t j = beside[a], k = beside[b];
        if (std::any_of(must.begin(), must.end(), [&](std::size_t m) { return m != j && m != k; })) continue;
        const double here = costs(i, j, k) - p[j] - p[k];
        largest = std::max(largest, std::abs(p[j]) + std::abs(p[k]) + std::abs(costs(i, j, k)));
        least = std::min(least, here);
      }
    }
    if (least == kNoBound) return kNoBound;  // no tour has these edges
    add(least);
    for (const std::size_t j : beside) {
      if (j > i) continue;
      const double left = p[j] + duals.of_edge_at[j][i] - duals.of_region[i] - duals.of_region[j] - of_sets[i][j];
      largest = std::max(largest, std::abs(p[j]) + std::abs(duals.of_edge_at[j][i]) + std::abs(duals.of_region[i]) +
                                      std::abs(duals.of_region[j]) + of_sets[i][j]);
      add(fixed.is_in(i, j) ? left : std::min(0.0, left));
    }
  }
  // Each term has few roundings of what it is made of, and as many as there are sets; there are at most n + n (n - 1) /
  // 2 and two of each set and region; the sum has one rounding for each term, of no more than all sizes.
  const double nn = static_cast<double>(n), sets = static_cast<double>(duals.of_set.size());
  const double terms = 2 * nn + nn * nn + sets;
  const double bound = sum - costs.error_m() - kPairRounding * (terms * (8 + sets) * largest + terms * size);
  return std::isfinite(bound) ? bound : -kNoBound;
}

/// The linear program over the columns that matter so far.
class Master {
 public:
  Master(const PairCosts& costs, double penalty) : costs_(costs), penalty_(penalty), n_(costs.count()) {
    program_ = make_linear_program();
    column_of_edge_.assign(n_ * n_, kNobody);
    row_of_edge_at_.assign(n_ * n_, kNobody);
    has_pair_.assign(n_ * n_ * n_, false);
    beside_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      add_row(2, 2);
      add_column(penalty_, {{i, 2.0}});
    }
  }

  bool has_edge(std::size_t i, std::size_t j) const { return column_of_edge_[i * n_ + j] != kNobody; }
  const std::vector<Edge>& edges() const { return edges_; }
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
    for (const Edge& e : edges_) {
      if (in[e[0]] != in[e[1]]) entries.emplace_back(column_of_edge_[e[0] * n_ + e[1]], 1.0);
    }
    sets_.push_back(in);
    row_of_set_.push_back(rows_++);
    program_->add_row(2, kNoBound, entries);
    add_column(penalty_, {{row_of_set_.back(), 1.0}});
  }

  void fix(const Fixed& fixed) {
    for (const Edge& e : edges_) {
      const bool out = fixed.is_out(e[0], e[1]), in = fixed.is_in(e[0], e[1]);
      program_->set_column_bounds(column_of_edge_[e[0] * n_ + e[1]], in ? 1 : 0, out ? 0 : 1);
    }
  }

  bool solve(double time_limit_s) { return program_->solve(time_limit_s); }
  double value(const Edge& e) const { return program_->value(column_of_edge_[e[0] * n_ + e[1]]); }

  PairsDuals duals() const {
    PairsDuals duals;
    duals.of_edge_at.assign(n_, std::vector<double>(n_, 0.0));
    for (std::size_t i = 0; i < n_; ++i) {
      duals.of_region.push_back(to_dual(program_->dual(i)));
      for (const std::size_t j : beside_[i]) {
        duals.of_edge_at[i][j] = to_dual(program_->dual(row_of_edge_at_[i * n_ + j]));
      }
    }
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      const double dual = to_dual(program_->dual(row_of_set_[s]));
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
  void add_row(double lower, double upper) {
    program_->add_row(lower, upper, {});
    ++rows_;
  }
  void add_column(double cost, const std::vector<LinearProgram::Entry>& rows) {
    program_->add_column(cost, 0, kNoBound, rows);
    ++columns_;
  }

  const PairCosts& costs_;
  double penalty_;
  std::size_t n_, rows_ = 0, columns_ = 0;
  std::unique_ptr<LinearProgram> program_;
  std::vector<std::size_t> column_of_edge_, row_of_edge_at_, row_of_set_;
  std::vector<bool> has_pair_;
  std::vector<std::vector<std::size_t>> beside_;
  std::vector<Edge> edges_;
  std::vector<std::vector<bool>> sets_;
};

/// Sets that a solution leaves less than twice: the parts of the graph, or else the cuts of the phases of Stoer and
/// Wagner 1997.
std::vector<std::vector<bool>> short_cuts(const std::vector<std::vector<double>>& weights) {
  const std::size_t n = weights.size();
  std::vector<std::vector<bool>> found;
  std::vector<bool> seen(n, false);
  for (std::size_t start = 0; start < n; ++start) {
    if (seen[start]) continue;
    std::vector<bool> part(n, false);
    std::vector<std::size_t> stack = {start};
    std::size_t size = 0;
    part[start] = seen[start] = true;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      ++size;
      for (std::size_t j = 0; j < n; ++j) {
        if (weights[i][j] > kFractional && !part[j]) {
          part[j] = seen[j] = true;
          stack.push_back(j);
        }
      }
    }
    if (size < n) found.push_back(std::move(part));
  }
  if (!found.empty()) return found;
  std::vector<std::vector<double>> w = weights;
  std::vector<std::vector<bool>> group(n, std::vector<bool>(n, false));
  std::vector<std::size_t> active;
  for (std::size_t i = 0; i < n; ++i) {
    group[i][i] = true;
    active.push_back(i);
  }
  while (active.size() > 1) {
    std::vector<double> tie(n, 0.0);
    std::vector<std::size_t> left = active;
    std::size_t last = kNobody, before = kNobody;
    double cut = 0;
    while (!left.empty()) {
      const auto most =
          std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return tie[a] < tie[b]; });
      before = last;
      last = *most;
      cut = tie[last];
      left.erase(most);
      for (const std::size_t i : left) tie[i] += w[last][i];
    }
    const auto members = static_cast<std::size_t>(std::count(group[last].begin(), group[last].end(), true));
    if (cut < 2 - 1e-4 && members > 1 && members + 1 < n) found.push_back(group[last]);
    for (const std::size_t i : active) {
      if (i == last || i == before) continue;
      w[before][i] += w[last][i];
      w[i][before] = w[before][i];
    }
    for (std::size_t i = 0; i < n; ++i) group[before][i] = group[before][i] || group[last][i];
    active.erase(std::find(active.begin(), active.end(), last));
  }
  return found;
}

/// Vectors along a tour, and the program of their costs.
struct Frame {
  Frame(const Cells& cells, const TourSpace& space, const Along& along, double penalty)
      : costs(cells, space, along), master(costs, penalty) {}
  PairCosts costs;
  Master master;
  std::set<Edge> tour;  // the edges of the one along which they are
};

class PairsSearch {
 public:
  PairsSearch(const Cells& cells, const TourSpace& space, const std::vector<Vec3>& anchors,
              const std::vector<std::size_t>& order, const PairsOptions& options,
              const core::ProgressReporter& progress)
      : cells_(cells), space_(space), options_(options), progress_(progress) {
    n_ = cells.region_count() + (space.closed ? 0 : 1);
    add_frame(order.empty() ? Along{anchors, {}, {}} : along(order), order);
    nodes_.emplace_back();
    if (!space.closed) {
      const std::size_t anywhere = n_ - 1;
      nodes_[0].fixed.inside.insert(edge_of(*space.first, anywhere));
      if (space.last) nodes_[0].fixed.inside.insert(edge_of(*space.last, anywhere));
    }
  }

  PairsBound run() {
    evaluate(0);
    const double first = nodes_[0].bound;
    while (!heap_.empty() && !stopped_ && first >= options_.worth_m) {
      const double low = -std::get<0>(heap_.top());
      if (low >= options_.enough_m) break;
      progress_.report(std::clamp((low - first) / std::max(options_.enough_m - first, 1e-9), 0.0, 1.0));
      if (is_late() || nodes_.size() + 2 > options_.most_nodes) break;
      const std::size_t number = std::get<1>(heap_.top());
      heap_.pop();
      branch(number);
    }
    return finish();
  }

 private:
  struct Node {
    Fixed fixed;
    double bound = -kNoBound;  // what is proved, with which duals and vectors
    PairsDuals duals;
    std::size_t frame = 0;
    std::size_t work = 0;  // the frame in which the program is solved
    Edge split = {};       // that is fixed in the children, or where to go on
    bool branched = false;
    std::array<std::size_t, 2> children = {};
  };

  bool is_late() const { return watch_.seconds() >= options_.time_limit_s; }

  void add_frame(const Along& along, const std::vector<std::size_t>& order) {
    const std::vector<Vec3>& anchors = along.points;
    Box box;
    for (const Vec3& a : anchors) box.extend(a);
    size_ = std::max((box.max - box.min).norm(), 1e-9);
    double around = 0;
    for (std::size_t i = 0; i + 1 < anchors.size(); ++i) around += (anchors[i + 1] - anchors[i]).norm();
    frames_.push_back(std::make_unique<Frame>(cells_, space_, along, around + 4 * size_));
    Frame& frame = *frames_.back();
    const std::size_t regions = cells_.region_count();
    for (std::size_t i = 0; i < regions; ++i) {
      std::vector<std::pair<double, std::size_t>> near;
      for (std::size_t j = 0; j < regions; ++j) {
        if (j != i) near.emplace_back((anchors[i] - anchors[j]).norm(), j);
      }
      std::sort(near.begin(), near.end());
      const std::size_t most = regions <= kAllEdges ? near.size() : kFirstNeighbours;
      for (std::size_t k = 0; k < std::min(most, near.size()); ++k) frame.master.add_edge(i, near[k].second);
    }
    std::vector<std::size_t> cycle = order;
    if (!space_.closed) {
      for (std::size_t i = 0; i < regions; ++i) frame.master.add_edge(i, regions);
      cycle.insert(cycle.begin(), *space_.first);
      if (space_.last) cycle.push_back(*space_.last);
      cycle.push_back(regions);
    }
    if (order.empty()) return;
    for (std::size_t k = 0; k < cycle.size(); ++k) {
      const std::size_t i = cycle[k], j = cycle[(k + 1) % cycle.size()];
      frame.master.add_edge(i, j);
      frame.tour.insert(edge_of(i, j));
    }
  }

  Along along(const std::vector<std::size_t>& order) const {
    Along result;
    std::vector<std::size_t>& stops = result.stops;
    stops = order;
    if (!space_.closed) {
      stops.insert(stops.begin(), *space_.first);
      if (space_.last) stops.push_back(*space_.last);
    }
    TouringProgram program;
    program.closed = space_.closed;
    for (const std::size_t r : stops) program.hulls.push_back(cells_[r].hull.get());
    TouringSolution solution = solve_touring(program);
    result.points.resize(cells_.region_count());
    for (std::size_t k = 0; k < stops.size(); ++k) result.points[stops[k]] = solution.points[k];
    result.legs = std::move(solution.directions);
    return result;
  }

  /// For edges that are no columns: the largest p_ij that keep the pairs at i from costing less than 0, the nearest
  /// first.
  void complete(const Frame& frame, const Fixed& fixed, PairsDuals& duals) const {
    const Master& master = frame.master;
    const PairCosts& costs = frame.costs;
    for (std::size_t i = 0; i < n_; ++i) {
      std::vector<double>& p = duals.of_edge_at[i];
      std::vector<std::size_t> known;
      std::vector<std::pair<double, std::size_t>> rest;
      for (std::size_t j = 0; j < n_; ++j) {
        if (j == i || fixed.is_out(i, j)) continue;
        if (master.has_edge(i, j)) known.push_back(j);
      }
      for (std::size_t j = 0; j < n_; ++j) {
        if (j == i || fixed.is_out(i, j) || master.has_edge(i, j)) continue;
        p[j] = kNoBound;
        for (const std::size_t k : known) p[j] = std::min(p[j], costs(i, j, k) - p[k]);
        rest.emplace_back(p[j], j);
      }
      std::sort(rest.begin(), rest.end());
      std::vector<std::size_t> done;
      for (const auto& [ignored, j] : rest) {
        for (const std::size_t k : done) p[j] = std::min(p[j], costs(i, j, k) - p[k]);
        p[j] = std::isfinite(p[j]) ? std::floor(p[j] / kDualUnit) * kDualUnit : 0;
        done.push_back(j);
      }
    }
  }

  /// Adds columns whose reduced cost is negative; how many.
  std::size_t price(Frame& frame, const Fixed& fixed, const PairsDuals& duals) {
    Master& master = frame.master;
    const PairCosts& costs = frame.costs;
    const double low = -kPriced * size_;
    std::size_t added = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const std::vector<double>& p = duals.of_edge_at[i];
      for (std::size_t j = 0; j < n_; ++j) {
        if (j == i || fixed.is_out(i, j) || !master.has_edge(i, j)) continue;
        std::vector<std::pair<double, std::size_t>> bad;
        for (std::size_t k = j + 1; k < n_; ++k) {
          if (k == i || fixed.is_out(i, k) || !master.has_edge(i, k) || master.has_pair(i, j, k)) continue;
          const double reduced = costs(i, j, k) - p[j] - p[k];
          if (reduced < low) bad.emplace_back(reduced, k);
        }
        std::sort(bad.begin(), bad.end());
        for (std::size_t b = 0; b < std::min(bad.size(), kMostPairsAtOnce); ++b) {
          master.add_pair(i, j, bad[b].second);
          ++added;
        }
      }
    }
    std::vector<std::vector<double>> of_sets(n_, std::vector<double>(n_, 0.0));
    for (const auto& [dual, members] : duals.of_set) {
      std::vector<bool> in(n_, false);
      for (const std::size_t m : members) in[m] = true;
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t j = 0; j < n_; ++j) of_sets[i][j] += in[i] != in[j] ? dual : 0;
      }
    }
    std::vector<std::pair<double, Edge>> bad;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (master.has_edge(i, j) || fixed.is_out(i, j)) continue;
        const double reduced =
            duals.of_edge_at[i][j] + duals.of_edge_at[j][i] - duals.of_region[i] - duals.of_region[j] - of_sets[i][j];
        if (reduced < low) bad.emplace_back(reduced, Edge{j, i});
      }
    }
    std::sort(bad.begin(), bad.end());
    for (std::size_t b = 0; b < std::min(bad.size(), kMostEdgesAtOnce); ++b)
      master.add_edge(bad[b].second[0], bad[b].second[1]);
    return added + std::min(bad.size(), kMostEdgesAtOnce);
  }

  std::vector<std::vector<double>> weights(const Master& master) const {
    std::vector<std::vector<double>> w(n_, std::vector<double>(n_, 0.0));
    for (const Edge& e : master.edges()) {
      w[e[0]][e[1]] = w[e[1]][e[0]] = std::clamp(master.value(e), 0.0, 1.0);
    }
    return w;
  }

  /// Solves the program of a node with columns and cuts as it needs them; keeps the best duals.
  void evaluate(std::size_t number) {
    for (std::size_t turn = 0; turn <= kMostTurnsKept; ++turn) {
      std::vector<std::vector<double>> w;
      if (!solve(number, w) || nodes_[number].bound >= options_.enough_m) break;
      Node& node = nodes_[number];
      const std::vector<std::size_t> order = order_of(w);
      std::set<Edge> tour;
      for (std::size_t i = 0; i < n_ && !order.empty(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          if (w[i][j] > 0.5) tour.insert({j, i});
        }
      }
      if (!order.empty() && tour == frames_[node.work]->tour) return;  // the shortest one, bounded as well as can be
      if (order.empty() || turn == kMostTurnsKept || frames_.size() >= kMostFrames) {
        choose_split(number, w, tour);
        break;
      }
      const auto known = std::find_if(frames_.begin(), frames_.end(), [&](const auto& f) { return f->tour == tour; });
      node.work = static_cast<std::size_t>(known - frames_.begin());
      if (known == frames_.end()) add_frame(along(order), order);
    }
    Node& node = nodes_[number];
    if (!node.duals.of_region.empty()) return;
    // Nothing was solved: no duals prove something, too.
    node.duals.of_edge_at.assign(n_, std::vector<double>(n_, 0.0));
    node.duals.of_region.assign(n_, 0.0);
    node.bound = bound_of(frames_[node.frame]->costs, node.fixed, node.duals);
  }

  /// False where time ended it. `w`: the values of the edges.
  bool solve(std::size_t number, std::vector<std::vector<double>>& w) {
    const Fixed fixed = nodes_[number].fixed;
    Frame& frame = *frames_[nodes_[number].work];
    for (int round = 0; round < kMostPairRounds; ++round) {
      progress_.check();
      frame.master.fix(fixed);
      if (is_late() || !frame.master.solve(options_.time_limit_s - watch_.seconds())) {
        stopped_ = true;
        return false;
      }
      PairsDuals duals = frame.master.duals();
      complete(frame, fixed, duals);
      const double bound = bound_of(frame.costs, fixed, duals);
      if (bound == -kNoBound) {  // the solver returned what are no numbers
        stopped_ = true;
        return false;
      }
      w = weights(frame.master);
      const std::size_t columns = price(frame, fixed, duals);
      Node& node = nodes_[number];
      if (bound > node.bound || node.duals.of_region.empty()) {
        node.bound = bound;
        node.duals = std::move(duals);
        node.frame = node.work;
      }
      if (bound >= options_.enough_m) return true;
      if (columns > 0) continue;
      const std::vector<std::vector<bool>> cuts = short_cuts(w);
      if (cuts.empty()) return true;
      for (const std::vector<bool>& cut : cuts) frame.master.add_set(cut);
    }
    return true;
  }

  /// The edge that is least decided; of a tour one that the frame's tour does not have.
  void choose_split(std::size_t number, const std::vector<std::vector<double>>& w, const std::set<Edge>& tour) {
    Node& node = nodes_[number];
    double best = kFractional;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (node.fixed.is_in(i, j) || node.fixed.is_out(i, j)) continue;
        double off = 0.5 - std::abs(w[i][j] - 0.5);
        if (!tour.empty()) off = tour.contains({j, i}) && !frames_[node.work]->tour.contains({j, i}) ? 1 : 0;
        if (off > best) {
          best = off;
          node.split = {j, i};
        }
      }
    }
    if (node.split != Edge{}) heap_.emplace(-node.bound, number);
  }

  void branch(std::size_t number) {
    const Edge edge = nodes_[number].split;
    const double above = nodes_[number].bound;
    for (std::size_t side = 0; side < 2; ++side) {
      Node child;
      child.fixed = nodes_[number].fixed;
      (side == 0 ? child.fixed.inside : child.fixed.outside).insert(edge);
      // What proves the parent's bound proves it of the child, too.
      child.duals = nodes_[number].duals;
      child.frame = nodes_[number].frame;
      child.work = nodes_[number].work;
      child.bound = std::max(above, bound_of(frames_[child.frame]->costs, child.fixed, child.duals));
      nodes_[number].children[side] = nodes_.size();
      nodes_.push_back(std::move(child));
      if (nodes_.back().bound < options_.enough_m && !stopped_) evaluate(nodes_.size() - 1);
    }
    nodes_[number].branched = true;
  }

  /// Where the values are a tour: all regions but the ends, which is noted. Else nothing.
  std::vector<std::size_t> order_of(const std::vector<std::vector<double>>& w) {
    std::vector<std::size_t> order = {0};
    std::size_t before = kNobody;
    while (order.size() <= n_) {
      const std::size_t at = order.back();
      std::size_t next = kNobody;
      for (std::size_t j = 0; j < n_; ++j) {
        if (w[at][j] > kFractional && w[at][j] < 1 - kFractional) return {};
        if (w[at][j] > 0.5 && j != before && next == kNobody) next = j;
      }
      if (next == kNobody) return {};
      if (next == 0) break;
      before = at;
      order.push_back(next);
    }
    if (order.size() != n_) return {};
    if (!space_.closed) {
      std::rotate(order.begin(), std::find(order.begin(), order.end(), n_ - 1), order.end());
      if (order[1] != *space_.first) std::reverse(order.begin() + 1, order.end());
      std::erase_if(order, [&](std::size_t r) { return r == n_ - 1 || r == space_.first || r == space_.last; });
    }
    if (orders_.size() < kMostPairOrders && std::find(orders_.begin(), orders_.end(), order) == orders_.end()) {
      orders_.push_back(order);
    }
    return order;
  }

  PairsBound finish() {
    PairsBound result;
    result.bound_m = kNoBound;
    for (const Node& node : nodes_) {
      if (!node.branched) result.bound_m = std::min(result.bound_m, node.bound);
    }
    result.proof.origin = cells_.origin();
    for (const std::unique_ptr<Frame>& frame : frames_) result.proof.vectors.push_back(frame->costs.vectors());
    write(0, result.bound_m, result.proof.nodes);
    result.orders = std::move(orders_);
    result.nodes = nodes_.size();
    for (const std::unique_ptr<Frame>& frame : frames_) result.columns += frame->master.columns();
    return result;
  }

  void write(std::size_t number, double bound, std::vector<PairsNode>& out) {
    const Node& node = nodes_[number];
    PairsNode written;
    if (!node.branched || node.bound >= bound) {
      written.duals = node.duals;
      written.vectors = node.frame;
      out.push_back(std::move(written));
      return;
    }
    written.edge = node.split;
    out.push_back(std::move(written));
    for (const std::size_t child : node.children) write(child, bound, out);
  }

  const Cells& cells_;
  const TourSpace& space_;
  const PairsOptions& options_;
  const core::ProgressReporter& progress_;
  core::Stopwatch watch_;
  std::size_t n_ = 0;
  double size_ = 0;
  bool stopped_ = false;
  std::vector<std::unique_ptr<Frame>> frames_;
  std::vector<Node> nodes_;
  std::priority_queue<std::tuple<double, std::size_t>> heap_;
  std::vector<std::vector<std::size_t>> orders_;
};

}  // namespace

bool has_pairs_bound() { return has_linear_programs(); }

PairsBound pairs_bound(const Cells& cells, const TourSpace& space, const std::vector<Vec3>& anchors,
                       const std::vector<std::size_t>& order, const PairsOptions& options,
                       const core::ProgressReporter& progress) {
  return PairsSearch(cells, space, anchors, order, options, progress).run();
}

}  // namespace vantage::internal::flight::tour
