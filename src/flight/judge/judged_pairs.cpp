// Bounds by pairs. With vectors u_ij = -u_ji a tour is at least the sum over its regions i of c_i(j, k) = min (u_ij +
// u_ik) . v, j and k its neighbours. For any numbers p, d, and s >= 0 of sets, that is at least the sum over regions of
// the least c_i(j, k) - p_ij - p_ik, of 2 d_i, of 2 s, and over edges of min(0, p_ij + p_ji - d_i - d_j - the s of sets
// that it leaves): a tour has two edges at each region and leaves each set twice. "edge" fixes one in the tour, then
// out of it.
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "flight/judge/judged_proofs.h"

namespace vantage::internal::flight::judge {
namespace {

using Edge = std::pair<std::size_t, std::size_t>;
using Edges = std::set<Edge>;
using Rows = std::vector<std::vector<Direction>>;  // of region i one for each j < i

Edge edge_of(std::size_t i, std::size_t j) { return {std::min(i, j), std::max(i, j)}; }

/// The numbers of a leaf.
struct Duals {
  std::vector<std::vector<BigInteger>> of_edge_at;
  std::vector<BigInteger> of_region;
  std::vector<std::pair<BigInteger, std::set<std::size_t>>> of_set;
};

/// A branch of the tree: edges that are in the tour, and out of it.
struct Branch {
  Edges inside, outside;
};

class PairsJudge {
 public:
  PairsJudge(JudgedTour& tour, const core::ProgressReporter& progress)
      : tour_(tour), progress_(progress), count_(tour.cells.size() + (tour.closed ? 0 : 1)) {}

  std::optional<BigInteger> least(const Json& proof) {
    constexpr const char* kKeys[] = {"kind", "origin", "vectors", "tree"};
    demand_keys(proof, kKeys, "the proof has keys too many or too few");
    read_vectors(proof["vectors"]);
    list_of(proof["origin"], 3);
    for (std::size_t k = 0; k < 3; ++k) origin_[k] = whole_of(proof["origin"][k], tour_.bits);
    Branch& root = waiting_.emplace_back();
    for (const std::size_t end : tour_.ends) root.inside.insert({end, count_ - 1});  // to everywhere
    const Json& tree = list_of(proof["tree"]);
    for (std::size_t i = 0; i < tree.size(); ++i) {
      progress_.report(i, tree.size());
      demand(!waiting_.empty(), "the tree has too many nodes");
      const Branch branch = std::move(waiting_.back());
      waiting_.pop_back();
      take(branch, list_of(tree[i]));
    }
    demand(waiting_.empty(), "the tree ends too early");
    return least_;
  }

 private:
  void read_vectors(const Json& sets) {
    for (const Json& rows : list_of(sets)) {
      Rows& read = sets_.emplace_back();
      for (const Json& row : list_of(rows, count_)) {
        read.push_back(vectors_of(row));
        demand(read.back().size() + 1 == read.size(), "there are vectors for other pairs");
      }
      const bool is_nowhere = tour_.closed || std::all_of(read.back().begin(), read.back().end(),
                                                          [](const Direction& u) { return u == Direction{}; });
      demand(is_nowhere, "vectors to everywhere are not 0");
    }
    demand(count_ > 2, "there are vectors for other pairs");
  }

  void take(const Branch& branch, const Json& node) {
    const auto& kind = node.at(0).get_ref<const std::string&>();
    if (kind == "edge") {
      list_of(node, 3);
      const Edge edge = {index_of(node[1], count_), index_of(node[2], count_)};
      demand(edge.first < edge.second, "there is no edge");
      Branch without = branch, with = branch;
      without.outside.insert(edge);
      with.inside.insert(edge);
      waiting_.push_back(std::move(without));
      waiting_.push_back(std::move(with));
      return;
    }
    demand(kind == "leaf", "a node is of no known kind");
    list_of(node, 5);
    const Rows& rows = sets_[index_of(node[1], sets_.size())];
    std::optional<BigInteger> length = leaf(branch, rows, duals_of(node));
    if (length && (!least_ || *length < *least_)) least_ = std::move(length);
  }

  BigInteger dual(const Json& number) const { return whole_of(number, tour_.bits) * BigInteger(kUnit); }

  std::vector<BigInteger> duals(const Json& numbers) const {
    std::vector<BigInteger> result;
    for (const Json& number : list_of(numbers, count_)) result.push_back(dual(number));
    return result;
  }

  Duals duals_of(const Json& node) const {
    Duals result;
    for (const Json& row : list_of(node[2], count_)) result.of_edge_at.push_back(duals(row));
    result.of_region = duals(node[3]);
    for (const Json& entry : list_of(node[4])) {
      list_of(entry, 2);
      std::set<std::size_t> members;
      for (const Json& member : list_of(entry[1])) members.insert(index_of(member, count_));
      BigInteger value = dual(entry[0]);
      demand(value.sign() >= 0 && !members.empty() && members.size() < count_, "there is no set, or less than 0");
      result.of_set.emplace_back(std::move(value), std::move(members));
    }
    return result;
  }

  static Direction vector_between(const Rows& rows, std::size_t i, std::size_t j) {
    if (j < i) return rows[i][j];
    const Direction& back = rows[j][i];
    return {-back[0], -back[1], -back[2]};
  }

  /// The least that region i adds between its neighbours, about the origin.
  BigInteger cost(const Rows& rows, std::size_t i, std::size_t j, std::size_t k) const {
    if (i == tour_.cells.size()) return {};
    const Direction a = vector_between(rows, i, j), b = vector_between(rows, i, k);
    const Direction both = {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
    Cell& cell = *tour_.cells[i];
    BigInteger least = tour_.dwell[i].sign() > 0 ? cell.least(a) + cell.least(b) + tour_.dwell[i] * BigInteger(kUnit)
                                                 : cell.least(both);
    const bool turns = tour_.turn_radius.sign() > 0 && tour_.dwell[i].sign() == 0 && !tour_.is_place[i];
    if (turns && std::max(j, k) < tour_.cells.size()) {
      least += turning_at(tour_.turn_radius, a, vector_between(rows, k, i), room_between(*tour_.cells[j], cell, a),
                          room_between(*tour_.cells[k], cell, b));
    }
    return least -= dot(both, origin_);
  }

  /// Nothing: no tour has the edges that are fixed.
  std::optional<BigInteger> leaf(const Branch& branch, const Rows& rows, const Duals& duals) const {
    BigInteger total;
    for (const BigInteger& d : duals.of_region) total += d + d;
    for (const auto& [s, members] : duals.of_set) total += s + s;
    bool is_possible = true;
    for (std::size_t i = 0; i < count_; ++i) {
      progress_.check();
      std::vector<std::size_t> beside, must;
      for (std::size_t j = 0; j < count_; ++j) {
        if (j == i || branch.outside.contains(edge_of(i, j))) continue;
        beside.push_back(j);
        if (branch.inside.contains(edge_of(i, j))) must.push_back(j);
      }
      std::optional<BigInteger> least = least_between(rows, duals.of_edge_at[i], i, beside, must);
      is_possible = is_possible && least;
      if (least) total += *least;
      for (const std::size_t j : beside) {
        if (j >= i) continue;
        BigInteger left = duals.of_edge_at[i][j] + duals.of_edge_at[j][i] - duals.of_region[i] - duals.of_region[j];
        for (const auto& [s, members] : duals.of_set) {
          if (members.contains(i) != members.contains(j)) left -= s;
        }
        const bool is_in = std::find(must.begin(), must.end(), j) != must.end();
        if (is_in || left.sign() < 0) total += left;
      }
    }
    return is_possible ? std::optional(std::move(total)) : std::nullopt;
  }

  std::optional<BigInteger> least_between(const Rows& rows, const std::vector<BigInteger>& p, std::size_t i,
                                          const std::vector<std::size_t>& beside,
                                          const std::vector<std::size_t>& must) const {
    std::optional<BigInteger> least;
    for (std::size_t a = 0; a < beside.size(); ++a) {
      for (std::size_t b = a + 1; b < beside.size(); ++b) {
        const std::size_t j = beside[a], k = beside[b];
        const bool has_all =
            std::all_of(must.begin(), must.end(), [&](std::size_t edge) { return edge == j || edge == k; });
        if (!has_all) continue;
        BigInteger value = cost(rows, i, j, k) - p[j] - p[k];
        if (!least || value < *least) least = std::move(value);
      }
    }
    return least;
  }

  JudgedTour& tour_;
  const core::ProgressReporter& progress_;
  std::size_t count_;  // regions, and everywhere behind them, for open tours
  std::vector<Rows> sets_;
  WholePoint origin_;
  std::vector<Branch> waiting_;
  std::optional<BigInteger> least_;
};

}  // namespace

std::optional<BigInteger> proved_by_pairs(JudgedTour& tour, const Json& proof, const core::ProgressReporter& progress) {
  return PairsJudge(tour, progress).least(proof);
}

}  // namespace vantage::internal::flight::judge
