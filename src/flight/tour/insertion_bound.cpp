#include "flight/tour/insertion_bound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "flight/tour/tour_detour.h"
#include "flight/tour/turning.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kAtOnce = 4;  // programs that are solved at once
constexpr std::size_t kMostOrders = 20;
constexpr double kPrecision = 0.01;  // of a program, in parts of the gap that is asked for
constexpr double kTouches = 1e-6;    // of the size: a region so near to the polyline is met

enum class Origin : std::uint8_t { root, inserted, cut };

struct Node {
  std::uint32_t parent = 0;
  Origin origin = Origin::root;
  bool solved = false, expanded = false, ended = false;
  std::uint32_t place = 0;  // in the parent's sequence: the stop behind which, or that is cut
  std::uint32_t cell = 0;
  double own = 0, best = 0;             // bounds: of its own vectors; with those of its ancestors
  std::vector<Direction> local;         // inserted, not solved: of the new legs
  std::vector<std::uint32_t> sequence;  // of cells; solved ones only, like what follows
  std::vector<Direction> directions;
  std::vector<Vec3> points;
  std::vector<std::uint32_t> children;
};

class InsertionSearch {
 public:
  InsertionSearch(Cells& cells, const TourSpace& space, const InsertionOptions& options,
                  const core::ProgressReporter& progress)
      : cells_(cells), space_(space), options_(options), progress_(progress) {
    Box all;
    for (std::size_t r = 0; r < cells_.region_count(); ++r) {
      all.extend(cells_[r].hull->box());
      if (cells_[r].hull->is_point()) points_.push_back(static_cast<std::uint32_t>(r));
    }
    size_ = (all.max - all.min).norm();
    precision_ = std::clamp(kPrecision * options_.gap, 1e-7, 1e-4);
  }

  InsertionBound run() {
    nodes_.emplace_back();
    nodes_[0].sequence = root_sequence();
    result_.tree.root.assign(nodes_[0].sequence.begin(), nodes_[0].sequence.end());
    push(0);
    double first = -1;
    while (!heap_.empty()) {
      const double low = std::get<0>(heap_.top()) * -1;
      if (low >= most()) break;
      if (first < 0 && nodes_.size() > 1) first = low;
      progress_.report(first < 0 ? 0 : std::clamp((low - first) / std::max(options_.enough_m - first, 1e-9), 0.0, 1.0));
      if (watch_.seconds() > options_.time_limit_s || result_.solved >= options_.most_nodes) {
        result_.stopped = true;
        break;
      }
      step();
    }
    finish();
    return std::move(result_);
  }

 private:
  /// What is below a solved node.
  struct Growth {
    std::vector<Node> children;  // of an insertion; none where its polyline meets all regions
    std::size_t stop = kNone;    // then: the one whose point is farthest from its region, if one is off it
    Vec3 at = Vec3::Zero();
  };
  using Entry = std::tuple<double, std::size_t, std::uint32_t>;  // -bound, length, -number: largest first

  /// What is asked for, or can be had: below a node that ended no bound is larger.
  double most() const { return std::min(options_.enough_m, ended_); }
  double dwell_m(std::size_t region) const { return space_.dwell_m.empty() ? 0 : space_.dwell_m[region]; }
  std::size_t points_of(std::uint32_t cell) const { return dwell_m(cells_[cell].region) > 0 ? 2 : 1; }

  std::vector<std::uint32_t> root_sequence() const {
    std::vector<std::uint32_t> sequence;
    if (!space_.closed) {
      sequence.push_back(static_cast<std::uint32_t>(*space_.first));
      if (space_.last) sequence.push_back(static_cast<std::uint32_t>(*space_.last));
      return sequence;
    }
    for (const std::size_t region : cells_.three_far_apart()) sequence.push_back(static_cast<std::uint32_t>(region));
    return sequence;
  }

  TouringProgram program_of(const std::vector<std::uint32_t>& sequence) const {
    TouringProgram program;
    program.closed = space_.closed;
    bool any_dwell = false;
    for (const std::uint32_t cell : sequence) {
      const double dwell = dwell_m(cells_[cell].region);
      program.hulls.push_back(cells_[cell].hull.get());
      if (dwell > 0) {
        any_dwell = true;
        program.hulls.push_back(cells_[cell].hull.get());
        program.at_least_m.push_back(dwell);
      }
      program.at_least_m.push_back(0);
    }
    program.at_least_m.resize(program.leg_count());
    if (!any_dwell) program.at_least_m.clear();
    return program;
  }

  /// At a point a flight may begin in another direction than it ends in. If it is no stop, that may happen on any leg.
  bool has_all_points(const std::vector<std::uint32_t>& sequence) const {
    return std::all_of(points_.begin(), points_.end(), [&](std::uint32_t point) {
      return std::find(sequence.begin(), sequence.end(), point) != sequence.end();  // points are never cut
    });
  }

  /// The last of a stop's points in a sequence.
  std::size_t last_point(const std::vector<std::uint32_t>& sequence, std::size_t stop) const {
    std::size_t point = 0;
    for (std::size_t s = 0; s <= stop; ++s) point += points_of(sequence[s]);
    return point - 1;
  }

  std::size_t leg_count(const std::vector<std::uint32_t>& sequence) const {
    const std::size_t points = last_point(sequence, sequence.size() - 1) + 1;
    return space_.closed && points > 1 ? points : points - 1;
  }

  std::vector<std::uint32_t> sequence_of(const Node& node) const {
    if (node.solved || node.origin == Origin::root) return node.sequence;
    std::vector<std::uint32_t> sequence = nodes_[node.parent].sequence;
    if (node.origin == Origin::cut) {
      sequence[node.place] = node.cell;
    } else {
      sequence.insert(sequence.begin() + node.place + 1, node.cell);
    }
    return sequence;
  }

  std::vector<Direction> directions_of(const Node& node) const {
    if (node.solved || node.origin == Origin::root) return node.directions;
    std::vector<Direction> directions = nodes_[node.parent].directions;
    if (node.origin == Origin::cut) return directions;
    const std::size_t leg = last_point(nodes_[node.parent].sequence, node.place);
    if (leg < directions.size()) directions.erase(directions.begin() + static_cast<std::ptrdiff_t>(leg));
    directions.insert(directions.begin() + static_cast<std::ptrdiff_t>(leg), node.local.begin(), node.local.end());
    return directions;
  }

  void push(std::uint32_t number) {
    const Node& node = nodes_[number];
    const std::size_t depth =
        node.solved || node.origin == Origin::root ? node.sequence.size() : nodes_[node.parent].sequence.size() + 1;
    heap_.emplace(-node.best, depth, ~number);
  }

  /// What comes of a node: its solution, or if it has one what is below it.
  struct Outcome {
    std::vector<std::uint32_t> sequence;
    TouringSolution solution;
    Growth growth;
  };

  /// Some nodes from the top, as many on any machine.
  void step() {
    std::vector<std::uint32_t> batch;
    while (!heap_.empty() && batch.size() < kAtOnce) {
      const std::uint32_t number = ~std::get<2>(heap_.top());
      if (nodes_[number].best >= most()) break;
      heap_.pop();
      batch.push_back(number);
    }
    std::vector<Outcome> outcomes(batch.size());
    parallel::for_ranges(batch.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (nodes_[batch[i]].solved) {
          outcomes[i].growth = grown(batch[i]);
        } else {
          outcomes[i] = solved(nodes_[batch[i]]);
        }
      }
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (nodes_[batch[i]].solved) {
        grow(batch[i], std::move(outcomes[i].growth));
      } else {
        take(batch[i], std::move(outcomes[i].sequence), std::move(outcomes[i].solution));
      }
    }
  }

  Outcome solved(const Node& node) const {
    Outcome outcome;
    outcome.sequence = sequence_of(node);
    TouringOptions options;
    options.gap = options.in_hull = precision_;
    options.most_rounds = 6;
    options.enough_m = options_.enough_m;
    const TouringProgram program = program_of(outcome.sequence);
    TouringSolution& solution = outcome.solution;
    solution = solve_touring(program, options);
    if (space_.turn_radius_m > 0 && has_all_points(outcome.sequence)) {
      solution.directions = straightened(program, std::move(solution.directions), space_.turn_radius_m, options,
                                         [this] { return watch_.seconds() > options_.time_limit_s; });
      solution.bound_m = touring_bound(program, solution.directions) +
                         turning_bound(program, solution.directions, space_.turn_radius_m);
    }
    return outcome;
  }

  void take(std::uint32_t number, std::vector<std::uint32_t> sequence, TouringSolution solution) {
    ++result_.solved;
    std::vector<std::uint32_t> cell_of;
    for (const std::uint32_t cell : sequence) cell_of.insert(cell_of.end(), points_of(cell), cell);
    for (const auto& [hull, half_space] : solution.half_spaces) cells_.learn(cell_of[hull], half_space);
    Node& node = nodes_[number];
    std::vector<Direction> before = directions_of(node);
    if (node.origin == Origin::root || solution.bound_m >= node.own) {
      node.own = solution.bound_m;
      node.directions = std::move(solution.directions);
    } else {
      node.directions = std::move(before);
    }
    node.best = std::max(node.best, node.own);
    node.sequence = std::move(sequence);
    node.points = std::move(solution.points);
    node.local.clear();
    node.solved = true;
    push(number);
  }

  // ---- children -----------------------------------------------------------------------------------------------------

  /// A place for a region: behind which stop, by which point, how long the detour.
  struct Place {
    std::size_t stop = 0, leg = 0;
    Vec3 point = Vec3::Zero();
    double detour = std::numeric_limits<double>::infinity();
  };

  /// Where a stop may be inserted, as legs: those between stops, and behind the last one where an open tour may end
  /// anywhere.
  std::vector<Place> places_of(const Node& node) const {
    std::vector<Place> places;
    std::size_t point = 0;
    for (std::size_t s = 0; s < node.sequence.size(); ++s) {
      point += points_of(node.sequence[s]);
      const bool behind_end = !space_.closed && s + 1 == node.sequence.size();
      if (behind_end && space_.last) continue;
      Place place;
      place.stop = s;
      place.leg = point - 1;
      places.push_back(place);
    }
    return places;
  }

  const Vec3& from_of(const Node& node, const Place& place) const { return node.points[place.leg]; }
  const Vec3& to_of(const Node& node, const Place& place) const {
    if (!space_.closed && place.leg + 1 == node.points.size()) return node.points[place.leg];
    return node.points[(place.leg + 1) % node.points.size()];
  }

  void measure(const Node& node, const Hull& hull, Place& place) const {
    const Vec3 &from = from_of(node, place), &to = to_of(node, place);
    const bool is_end = !space_.closed && place.leg + 1 == node.points.size();
    place.point = hull.nearest_to_segment(from, to, 1e-7 * size_).point;
    place.detour = (place.point - from).norm() + (is_end ? 0.0 : (to - place.point).norm() - (to - from).norm());
  }

  /// The least detour to a region, of all places. `none_below`: it is not measured where it is certainly more.
  Place nearest_place(const Node& node, const std::vector<Place>& places, const Hull& hull) const {
    std::vector<std::pair<double, std::size_t>> order;
    const double radius = 0.5 * hull.extent_m();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec3 &from = from_of(node, places[i]), &to = to_of(node, places[i]);
      const double apart = std::max(0.0, distance_to_leg(hull.middle(), from, to) - radius);
      const bool is_end = !space_.closed && places[i].leg + 1 == node.points.size();
      order.emplace_back(is_end ? apart : least_detour(apart, (to - from).norm()), i);
    }
    std::sort(order.begin(), order.end());
    Place best;
    for (const auto& [low, i] : order) {
      if (low >= best.detour) break;
      Place place = places[i];
      measure(node, hull, place);
      if (place.detour < best.detour) best = place;
    }
    return best;
  }

  /// Vectors for the legs of a child that need no solver: to the point nearest to the leg and on.
  std::vector<Direction> local_directions(const Node& node, const Place& place, std::size_t region) const {
    const Vec3 &from = from_of(node, place), &to = to_of(node, place);
    const bool is_end = !space_.closed && place.leg + 1 == node.points.size();
    const double least = 1e-5 * size_;
    const Direction known = is_end ? Direction{} : node.directions[place.leg];
    const auto towards = [&](const Vec3& vector) {
      return vector.norm() > least ? direction_of(vector.normalized()) : known;
    };
    std::vector<Direction> local = {towards(place.point - from)};
    if (!is_end && place.detour < least * 1e-2) local[0] = known;
    if (dwell_m(region) > 0) local.push_back({});
    if (!is_end) local.push_back(place.detour < least * 1e-2 ? known : towards(to - place.point));
    return local;
  }

  double bound_of(const Node& child) const {
    const TouringProgram program = program_of(sequence_of(child));
    return touring_bound(program, directions_of(child));
  }

  /// What the points of a node give to its bound. Empty where the bound of a child is computed as a whole.
  struct Parts {
    std::vector<double> of_points;
    double reach_m = 0, moved_m = 0;
  };

  Parts parts_of(const Node& node) const {
    Parts parts;
    const std::size_t count = node.points.size();
    if (count < 2 || !space_.dwell_m.empty()) return parts;
    for (std::size_t k = 0; k < count; ++k) {
      const Hull& hull = *cells_[node.sequence[k]].hull;
      parts.of_points.push_back(touring_part(hull, before(node, k), behind(node, k)));
      parts.reach_m += hull.reach_m();
      parts.moved_m += hull.moved_m();
    }
    return parts;
  }

  const Direction* before(const Node& node, std::size_t point) const {
    if (point == 0 && !space_.closed) return nullptr;
    return &node.directions[(point + node.points.size() - 1) % node.points.size()];
  }
  static const Direction* behind(const Node& node, std::size_t point) {
    return point < node.directions.size() ? &node.directions[point] : nullptr;
  }

  double bound_of(const Node& child, const Parts& parts) const {
    if (parts.of_points.empty()) return bound_of(child);
    const Node& node = nodes_[child.parent];
    const std::size_t leg = child.place, next = (leg + 1) % node.points.size();
    const Hull& hull = *cells_[child.cell].hull;
    const Direction* second = child.local.size() > 1 ? &child.local[1] : nullptr;
    std::vector<double> changed = parts.of_points;
    changed[leg] = touring_part(*cells_[node.sequence[leg]].hull, before(node, leg), child.local.data());
    if (second) changed[next] = touring_part(*cells_[node.sequence[next]].hull, second, behind(node, next));
    changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(leg) + 1,
                   touring_part(hull, child.local.data(), second));
    return touring_bound_of(changed, parts.reach_m + hull.reach_m(), parts.moved_m + hull.moved_m());
  }

  Node inserted(std::uint32_t parent, const Parts& parts, const Place& place, std::size_t region) const {
    Node child;
    child.parent = parent;
    child.origin = Origin::inserted;
    child.place = static_cast<std::uint32_t>(place.stop);
    child.cell = static_cast<std::uint32_t>(region);
    child.local = local_directions(nodes_[parent], place, region);
    child.own = bound_of(child, parts);
    child.best = std::max(child.own, nodes_[parent].best);
    return child;
  }

  /// Where a region is far from a leg, vectors to its middle are often good enough, and quickly had.
  std::vector<Node> insert_everywhere(std::uint32_t parent, const Parts& parts, const std::vector<Place>& places,
                                      std::size_t region) const {
    const Node& node = nodes_[parent];
    const Hull& hull = *cells_[region].hull;
    std::vector<Node> children;
    for (Place place : places) {
      const Vec3 &from = from_of(node, place), &to = to_of(node, place);
      if (distance_to_leg(hull.middle(), from, to) > hull.extent_m()) {
        place.point = hull.middle();
        place.detour = size_;
        Node child = inserted(parent, parts, place, region);
        if (child.own >= options_.enough_m) {
          children.push_back(std::move(child));
          continue;
        }
      }
      measure(node, hull, place);
      children.push_back(inserted(parent, parts, place, region));
    }
    return children;
  }

  std::vector<bool> regions_of(const Node& node) const {
    std::vector<bool> has(cells_.region_count(), false);
    for (const std::uint32_t cell : node.sequence) has[cells_[cell].region] = true;
    return has;
  }

  /// The region that is farthest from the polyline is inserted. To look at the bounds of the children of several
  /// regions first, and to choose by these, takes longer and was worse: it prefers regions that gain little,
  /// everywhere.
  Growth grown(std::uint32_t number) const {
    const Node& node = nodes_[number];
    const std::vector<Place> places = places_of(node);
    const std::vector<bool> has = regions_of(node);
    std::size_t farthest = kNone;
    double most = -1;
    for (std::size_t r = 0; r < has.size(); ++r) {
      if (has[r]) continue;
      const double detour = nearest_place(node, places, *cells_[r].hull).detour;
      if (detour <= most || (detour <= kTouches * size_ && dwell_m(r) <= 0)) continue;
      most = detour;
      farthest = r;
    }
    if (farthest == kNone) farthest = missed_by_mesh(node, places, has);
    if (farthest == kNone) return farthest_off(node);
    Growth growth;
    growth.children = insert_everywhere(number, parts_of(node), places, farthest);
    return growth;
  }

  void grow(std::uint32_t number, Growth growth) {
    if (!growth.children.empty()) {
      add_children(number, std::move(growth.children));
      return;
    }
    note_order(nodes_[number]);
    cut_one(number, growth);
  }

  void add_children(std::uint32_t number, std::vector<Node> children) {
    nodes_[number].expanded = true;
    nodes_[number].points.clear();
    for (Node& child : children) {
      const auto added = static_cast<std::uint32_t>(nodes_.size());
      nodes_[number].children.push_back(added);
      nodes_.push_back(std::move(child));
      if (!cells_[nodes_[added].cell].hull) {  // nothing is on this side
        nodes_[added].best = nodes_[added].own = std::numeric_limits<double>::infinity();
      } else if (nodes_[added].best < most()) {
        push(added);
      }
    }
  }

  /// A region that no leg meets, although the hull of one is met; the farthest from the polyline, as far as some points
  /// of it tell.
  std::size_t missed_by_mesh(const Node& node, const std::vector<Place>& places, const std::vector<bool>& has) const {
    std::size_t farthest = kNone;
    double most = -1;
    for (std::size_t r = 0; r < has.size(); ++r) {
      if (has[r]) continue;
      double near = std::numeric_limits<double>::infinity();
      for (const Place& place : places) {
        const Vec3 &from = from_of(node, place), &to = to_of(node, place);
        if (cells_.meets_segment(r, from, to)) {
          near = 0;
          break;
        }
        for (const double t : {0.0, 0.25, 0.5, 0.75})
          near = std::min(near, cells_.distance_m(r, from + t * (to - from)));
      }
      if (near > 2 * kTouches * size_ && near > most) {
        most = near;
        farthest = r;
      }
    }
    return farthest;
  }

  /// The stop whose point is farthest from its region. Not where the flight stays: it may begin to do so on one side of
  /// a plane and end on the other, so two halves would not be all there is.
  Growth farthest_off(const Node& node) const {
    Growth growth;
    double most = kTouches * size_;
    std::size_t point = 0;
    for (std::size_t s = 0; s < node.sequence.size(); ++s) {
      const bool stays = points_of(node.sequence[s]) > 1;
      for (std::size_t k = 0; k < points_of(node.sequence[s]); ++k, ++point) {
        if (stays) continue;
        const double off = cells_.distance_m(cells_[node.sequence[s]].region, node.points[point]);
        if (off <= most) continue;
        most = off;
        growth.stop = s;
        growth.at = node.points[point];
      }
    }
    return growth;
  }

  void cut_one(std::uint32_t number, const Growth& growth) {
    const Node& node = nodes_[number];
    const std::size_t stop = growth.stop;
    const Vec3& at = growth.at;
    const std::uint32_t cell = stop == kNone ? 0 : node.sequence[stop];
    const std::array<std::size_t, 2> halves =
        stop == kNone ? std::array<std::size_t, 2>{0, 0} : cells_.halves(cell, at);
    if (stop == kNone || halves[0] == cell) {  // a shortest polyline: nothing is to be won below this node
      nodes_[number].ended = true;
      ended_ = std::min(ended_, nodes_[number].best);
      return;
    }
    std::vector<Node> children;
    for (const std::size_t half : halves) {
      Node child;
      child.parent = number;
      child.origin = Origin::cut;
      child.place = static_cast<std::uint32_t>(stop);
      child.cell = static_cast<std::uint32_t>(half);
      if (cells_[half].hull) {
        child.own = bound_of(child);
        child.best = std::max(child.own, nodes_[number].best);
      }
      children.push_back(std::move(child));
    }
    add_children(number, std::move(children));
  }

  /// The order in which the polyline of a node meets all regions.
  void note_order(const Node& node) {
    if (result_.orders.size() >= kMostOrders) return;
    const std::vector<Place> places = places_of(node);
    const std::vector<bool> has = regions_of(node);
    std::vector<std::vector<std::size_t>> behind(node.sequence.size());
    for (std::size_t r = 0; r < has.size(); ++r) {
      if (!has[r]) behind[nearest_place(node, places, *cells_[r].hull).stop].push_back(r);
    }
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < node.sequence.size(); ++s) {
      order.push_back(cells_[node.sequence[s]].region);
      order.insert(order.end(), behind[s].begin(), behind[s].end());
    }
    std::erase_if(order, [&](std::size_t r) { return r == space_.first || r == space_.last; });
    if (std::find(result_.orders.begin(), result_.orders.end(), order) == result_.orders.end()) {
      result_.orders.push_back(std::move(order));
    }
  }

  // ---- the proof ----------------------------------------------------------------------------------------------------

  void finish() {
    double bound = ended_;
    for (const Node& node : nodes_) {
      if (!node.expanded && !node.ended) bound = std::min(bound, node.best);
    }
    result_.bound_m = bound;
    result_.cells = cells_.size();
    write_node(0);
  }

  std::size_t write_node(std::uint32_t number) {
    const std::size_t written = result_.tree.nodes.size();
    result_.tree.nodes.emplace_back();
    const Node& node = nodes_[number];
    InsertionNode out;
    if (node.origin != Origin::root && !cells_[node.cell].hull) {
      out.kind = InsertionNode::Kind::empty;
    } else if (node.own >= result_.bound_m || node.children.empty()) {
      out.directions = directions_of(node);
      // A root that was not looked at, as where a tour of no length was found: these prove nothing, as they should.
      if (!node.solved && node.origin == Origin::root) out.directions.assign(leg_count(node.sequence), Direction{});
    } else {
      const Node& child = nodes_[node.children.front()];
      const bool is_cut = child.origin == Origin::cut;
      out.kind = is_cut ? InsertionNode::Kind::cut : InsertionNode::Kind::insert;
      out.what = is_cut ? child.place : child.cell;
      if (is_cut) out.plane = cells_[child.cell].plane;
      for (const std::uint32_t c : node.children) out.children.push_back(write_node(c));
    }
    result_.tree.nodes[written] = std::move(out);
    return written;
  }

  Cells& cells_;
  const TourSpace& space_;
  const InsertionOptions& options_;
  const core::ProgressReporter& progress_;
  core::Stopwatch watch_;
  double size_ = 0, precision_ = 0;
  std::vector<std::uint32_t> points_;  // regions
  double ended_ = std::numeric_limits<double>::infinity();
  std::vector<Node> nodes_;
  std::priority_queue<Entry> heap_;
  InsertionBound result_;
};

}  // namespace

InsertionBound insertion_bound(Cells& cells, const TourSpace& space, const InsertionOptions& options,
                               const core::ProgressReporter& progress) {
  return InsertionSearch(cells, space, options, progress).run();
}

}  // namespace vantage::internal::flight::tour
