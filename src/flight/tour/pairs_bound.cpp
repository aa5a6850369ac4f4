#include "flight/tour/pairs_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "flight/tour/linear_program.h"
#include "flight/tour/pair_costs.h"
#include "flight/tour/pairs_master.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
constexpr double kNoBound = std::numeric_limits<double>::infinity();
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

/// Vectors along a tour, and the program of their costs.
struct PairsFrame {
  PairsFrame(const Cells& cells, const TourSpace& space, const AlongTour& along, double penalty)
      : costs(cells, space, along), master(costs, penalty) {}
  PairCosts costs;
  PairsMaster master;
  std::set<PairEdge> tour;  // the edges of the one along which they are
};

class PairsSearch {
 public:
  PairsSearch(const Cells& cells, const TourSpace& space, const std::vector<Vec3>& anchors,
              const std::vector<std::size_t>& order, const PairsOptions& options,
              const core::ProgressReporter& progress)
      : cells_(cells), space_(space), options_(options), progress_(progress) {
    n_ = cells.region_count() + (space.closed ? 0 : 1);
    add_frame(order.empty() ? AlongTour{anchors, {}, {}} : along(order), order);
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
    FixedEdges fixed;
    double bound = -kNoBound;  // what is proved, with which duals and vectors
    PairsDuals duals;
    std::size_t frame = 0;
    std::size_t work = 0;  // the frame in which the program is solved
    PairEdge split = {};   // that is fixed in the children, or where to go on
    bool branched = false;
    std::array<std::size_t, 2> children = {};
  };

  bool is_late() const { return watch_.seconds() >= options_.time_limit_s; }

  void add_frame(const AlongTour& along, const std::vector<std::size_t>& order) {
    const std::vector<Vec3>& anchors = along.points;
    Box box;
    for (const Vec3& a : anchors) box.extend(a);
    size_ = std::max((box.max - box.min).norm(), 1e-9);
    double around = 0;
    for (std::size_t i = 0; i + 1 < anchors.size(); ++i) around += (anchors[i + 1] - anchors[i]).norm();
    frames_.push_back(std::make_unique<PairsFrame>(cells_, space_, along, around + 4 * size_));
    PairsFrame& frame = *frames_.back();
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

  AlongTour along(const std::vector<std::size_t>& order) const {
    AlongTour result;
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
  void complete(const PairsFrame& frame, const FixedEdges& fixed, PairsDuals& duals) const {
    const PairsMaster& master = frame.master;
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
  std::size_t price(PairsFrame& frame, const FixedEdges& fixed, const PairsDuals& duals) {
    PairsMaster& master = frame.master;
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
    std::vector<std::pair<double, PairEdge>> bad;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (master.has_edge(i, j) || fixed.is_out(i, j)) continue;
        const double reduced =
            duals.of_edge_at[i][j] + duals.of_edge_at[j][i] - duals.of_region[i] - duals.of_region[j] - of_sets[i][j];
        if (reduced < low) bad.emplace_back(reduced, PairEdge{j, i});
      }
    }
    std::sort(bad.begin(), bad.end());
    for (std::size_t b = 0; b < std::min(bad.size(), kMostEdgesAtOnce); ++b)
      master.add_edge(bad[b].second[0], bad[b].second[1]);
    return added + std::min(bad.size(), kMostEdgesAtOnce);
  }

  std::vector<std::vector<double>> weights(const PairsMaster& master) const {
    std::vector<std::vector<double>> w(n_, std::vector<double>(n_, 0.0));
    for (const PairEdge& e : master.edges()) {
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
      std::set<PairEdge> tour;
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
    node.bound = pairs_value(frames_[node.frame]->costs, node.fixed, node.duals);
  }

  /// False where time ended it. `w`: the values of the edges.
  bool solve(std::size_t number, std::vector<std::vector<double>>& w) {
    const FixedEdges fixed = nodes_[number].fixed;
    PairsFrame& frame = *frames_[nodes_[number].work];
    for (int round = 0; round < kMostPairRounds; ++round) {
      progress_.check();
      frame.master.fix(fixed);
      if (is_late() || !frame.master.solve(options_.time_limit_s - watch_.seconds())) {
        stopped_ = true;
        return false;
      }
      PairsDuals duals = frame.master.duals();
      complete(frame, fixed, duals);
      const double bound = pairs_value(frame.costs, fixed, duals);
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
  void choose_split(std::size_t number, const std::vector<std::vector<double>>& w, const std::set<PairEdge>& tour) {
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
    if (node.split != PairEdge{}) heap_.emplace(-node.bound, number);
  }

  void branch(std::size_t number) {
    const PairEdge edge = nodes_[number].split;
    const double above = nodes_[number].bound;
    for (std::size_t side = 0; side < 2; ++side) {
      Node child;
      child.fixed = nodes_[number].fixed;
      (side == 0 ? child.fixed.inside : child.fixed.outside).insert(edge);
      // What proves the parent's bound proves it of the child, too.
      child.duals = nodes_[number].duals;
      child.frame = nodes_[number].frame;
      child.work = nodes_[number].work;
      child.bound = std::max(above, pairs_value(frames_[child.frame]->costs, child.fixed, child.duals));
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
    for (const std::unique_ptr<PairsFrame>& frame : frames_) result.proof.vectors.push_back(frame->costs.vectors());
    write(0, result.bound_m, result.proof.nodes);
    result.orders = std::move(orders_);
    result.nodes = nodes_.size();
    for (const std::unique_ptr<PairsFrame>& frame : frames_) result.columns += frame->master.columns();
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
  std::vector<std::unique_ptr<PairsFrame>> frames_;
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
