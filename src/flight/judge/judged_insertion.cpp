// Bounds by insertion. Let stops lie in convex hulls, in a given order. For any vectors u_k, none longer than 1, of the
// legs between them the way is at least the sum over stops of the least (u_(k-1) - u_k) . v over the corners v of the
// hull (Cauchy and Schwarz). The tree begins with three regions, or the ends of an open tour: any tour visits them in
// this order. "insert" puts a region behind each stop, "cut" takes the parts of a stop's cell on both sides of a plane:
// the children cover all tours of the parent, and leaving out stops makes no way longer. So the least leaf is a bound.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "flight/judge/judged_proofs.h"

namespace vantage::internal::flight::judge {
namespace {

using Stops = std::vector<Cell*>;

std::int64_t square_of(const Direction& u) { return u[0] * u[0] + u[1] * u[1] + u[2] * u[2]; }

/// The smallest whole number that is no less than the root of `square`, 0 to 2^60.
std::int64_t root_up(std::int64_t square) {
  auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square)));
  while (root * root > square) --root;
  while (root * root < square) ++root;
  return root;
}

Direction difference(const Direction& a, const Direction& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// A point of a leaf.
struct Stop {
  Cell* cell;
  Direction before, behind;  // vectors of its legs
};

/// At a place a flight may begin in another direction than it ends in. If it is no stop, that may happen on any leg.
bool has_all_places(const JudgedTour& tour, const std::vector<Cell*>& stops) {
  for (std::size_t region = 0; region < tour.is_place.size(); ++region) {
    const auto is_it = [&](const Cell* cell) { return cell->region() == region; };
    if (tour.is_place[region] && std::none_of(stops.begin(), stops.end(), is_it)) return false;
  }
  return true;
}

/// Where the vector stays the same, it does not matter where along the track the stop is.
BigInteger turning_of(const JudgedTour& tour, const std::vector<Stop>& stops) {
  std::vector<Stop> turns;
  for (const Stop& stop : stops) {
    if (stop.before != stop.behind || tour.is_place[stop.cell->region()]) turns.push_back(stop);
  }
  std::vector<BigInteger> rooms;  // before each
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const Stop& last = turns[(k + turns.size() - 1) % turns.size()];
    rooms.push_back(room_between(*last.cell, *turns[k].cell, turns[k].before));
  }
  BigInteger total;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const auto& [cell, before, behind] = turns[k];
    if (tour.is_place[cell->region()]) continue;
    total += turning_at(tour.turn_radius, before, behind, rooms[k], rooms[(k + 1) % rooms.size()]);
  }
  return total;
}

/// A stop with a dwell is two points, with a leg between that counts as so long at least.
BigInteger leaf_of_insertion(const JudgedTour& tour, const Stops& stops, const std::vector<Direction>& vectors) {
  std::vector<Cell*> points;
  std::vector<BigInteger> stays;  // on the leg behind each
  for (Cell* cell : stops) {
    demand(!cell->is_empty(), "a part of a region is empty");
    const BigInteger& stay = tour.dwell[cell->region()];
    if (stay.sign() > 0) {
      points.push_back(cell);
      stays.push_back(stay);
    }
    points.push_back(cell);
    stays.emplace_back(0);
  }
  const std::size_t none = !tour.closed || points.size() == 1 ? 1 : 0;
  demand(vectors.size() + none == points.size(), "there are vectors for another number of legs");
  BigInteger total;
  std::vector<Stop> around;
  for (std::size_t k = 0; k < points.size() && !vectors.empty(); ++k) {
    const bool has_before = k > 0 || tour.closed, has_behind = k < vectors.size();
    const Direction before = has_before ? vectors[k > 0 ? k - 1 : vectors.size() - 1] : Direction{};
    around.push_back({points[k], before, has_behind ? vectors[k] : Direction{}});
    total += points[k]->least(difference(before, around.back().behind));
  }
  if (tour.turn_radius.sign() > 0 && has_all_places(tour, stops)) total += turning_of(tour, around);
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    // A stay may be longer than the way between its points: what the vector leaves of it counts.
    if (stays[k].sign() > 0) total += stays[k] * BigInteger(kUnit - root_up(square_of(vectors[k])));
  }
  return total;
}

class InsertionJudge {
 public:
  InsertionJudge(JudgedTour& tour, const core::ProgressReporter& progress) : tour_(tour), progress_(progress) {}

  std::optional<BigInteger> least(const Json& proof) {
    constexpr const char* kKeys[] = {"kind", "root", "tree"};
    demand_keys(proof, kKeys, "the proof has keys too many or too few");
    begin(proof["root"]);
    const Json& tree = list_of(proof["tree"]);
    std::size_t done = 0;
    for (const Json& node : tree) {
      progress_.tick(done++, tree.size());
      demand(!waiting_.empty(), "the tree has too many nodes");
      const Stops stops = std::move(waiting_.back());
      waiting_.pop_back();
      take(stops, list_of(node));
    }
    demand(waiting_.empty(), "the tree ends too early");
    return least_;
  }

 private:
  void begin(const Json& root) {
    std::vector<std::size_t> regions;
    for (const Json& region : list_of(root)) regions.push_back(index_of(region, tour_.cells.size()));
    const std::set<std::size_t> different(regions.begin(), regions.end());
    const bool are_three =
        different.size() == regions.size() && regions.size() == std::min<std::size_t>(3, tour_.cells.size());
    demand(tour_.closed ? are_three : regions == tour_.ends, "the tree does not begin with three regions, or the ends");
    Stops& stops = waiting_.emplace_back();
    for (const std::size_t region : regions) stops.push_back(tour_.cells[region].get());
  }

  void take(const Stops& stops, const Json& node) {
    const auto& kind = node.at(0).get_ref<const std::string&>();
    if (kind == "leaf") {
      list_of(node, 2);
      BigInteger length = leaf_of_insertion(tour_, stops, vectors_of(node[1]));
      if (!least_ || length < *least_) least_ = std::move(length);
    } else if (kind == "insert") {
      list_of(node, 2);
      insert(stops, index_of(node[1], tour_.cells.size()));
    } else if (kind == "cut") {
      list_of(node, 4);
      cut(stops, node);
    } else {
      const bool is_empty = std::any_of(stops.begin(), stops.end(), [](const Cell* cell) { return cell->is_empty(); });
      demand(kind == "empty" && node.size() == 1 && is_empty, "a node is said to be empty, and is not");
    }
  }

  void insert(const Stops& stops, std::size_t region) {
    for (const Cell* cell : stops) demand(cell->region() != region, "a region is inserted that is there");
    const std::size_t places = stops.size() - (tour_.ends.size() == 2 ? 1 : 0);
    for (std::size_t i = places; i > 0; --i) {  // the first one is taken first
      Stops& more = waiting_.emplace_back(stops);
      more.insert(more.begin() + static_cast<std::ptrdiff_t>(i), tour_.cells[region].get());
    }
  }

  void cut(const Stops& stops, const Json& node) {
    const std::size_t stop = index_of(node[1], stops.size());
    std::array<int, 3> normal{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Json& entry = list_of(node[2], 3)[k];
      demand(entry.is_number_integer() && std::abs(entry.get<double>()) <= 1, "a cut is no plane");
      normal[k] = entry.get<int>();
    }
    demand(normal != std::array<int, 3>{}, "a cut is no plane");
    // A stay may begin on one side of the plane and end on the other.
    demand(tour_.dwell[stops[stop]->region()].sign() <= 0, "a region where the flight stays is cut");
    const std::array<Cell*, 2> halves = stops[stop]->cut(normal, whole_of(node[3], tour_.bits));
    for (const std::size_t half : {1, 0}) {
      Stops& part = waiting_.emplace_back(stops);
      part[stop] = halves[half];
    }
  }

  JudgedTour& tour_;
  const core::ProgressReporter& progress_;
  std::vector<Stops> waiting_;
  std::optional<BigInteger> least_;
};

}  // namespace

std::vector<Direction> vectors_of(const Json& numbers) {
  demand(list_of(numbers).size() % 3 == 0, "a vector is not three numbers");
  std::vector<Direction> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    demand(numbers[i].is_number_integer(), "there is no whole number where one should be");
    demand(std::abs(numbers[i].get<double>()) <= static_cast<double>(kUnit), "a vector is longer than 1");
    vectors[i / 3][i % 3] = numbers[i].get<std::int64_t>();
  }
  for (const Direction& u : vectors) demand(square_of(u) <= kUnit * kUnit, "a vector is longer than 1");
  return vectors;
}

std::optional<BigInteger> proved_by_insertion(JudgedTour& tour, const Json& proof,
                                              const core::ProgressReporter& progress) {
  return InsertionJudge(tour, progress).least(proof);
}

}  // namespace vantage::internal::flight::judge
