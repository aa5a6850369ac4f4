#include "solid/frame_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "core/portable_math.h"
#include "sensor/best_aim.h"
#include "solid/convex_body.h"
#include "solid/halve_sides.h"

namespace vantage::internal::solid {
namespace {

using sensor::Aim;
using sensor::AimedView;
using sensor::AimFinder;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kFirstParts = 6;       // of the icosahedron's sides: 720 facets
constexpr double kFirstSide = 0.2;   // radians: these are no longer
constexpr double kNarrowest = 4e-3;  // radians: shorter edges are not halved
constexpr double kRaise = 1 + 1e-4;  // what is raised once need not be raised again for a neighbour's sake
constexpr int kOwnRaises = 10;       // of a facet, before it gives up its corners' own aims
constexpr double kEnough = 0.9;      // of the most facets
constexpr double kMuch = 2.0;        // times the distance that a corner's own aim allows
constexpr double kSmallTurn = 0.3;   // radians: aims between two that differ by less are tried for their middle
constexpr int kVerticalAims = 12;    // in half a turn, after which the picture is the same
constexpr double kSteep = 1.1;       // radians above or below level

double cube(double x) { return x * x * x; }

/// The smallest turn from one yaw to another.
double turn(double from, double to) {
  const double difference = to - from;
  return std::abs(difference) <= std::numbers::pi ? difference : std::remainder(difference, 2 * std::numbers::pi);
}

/// The most that a l_0 l_1 + b l_1 l_2 + c l_2 l_0 can be for weights l >= 0 that add up to 1, with a, b, c >= 0: as
/// the square of the radius of the smallest circle round a triangle with sides of these squares.
double most_of_products(double a, double b, double c) {
  const double largest = std::max({a, b, c});
  if (largest >= a + b + c - largest) return largest / 4;
  return a * b * c / (2 * (a * b + b * c + c * a) - a * a - b * b - c * c);
}

class FrameSurfaceBuilder {
 public:
  explicit FrameSurfaceBuilder(const FrameView& view)
      : view_(view),
        finder_(view.corners, view.camera, view.mount, view.least),
        normal_length_{portable::hypot(1, view.camera.half_width), portable::hypot(1, view.camera.half_height)},
        roll_(view.mount.roll_deg * std::numbers::pi / 180) {
    for (const Vec3& corner : view.corners) radius_ = std::max(radius_, corner.norm());
    // Beyond this a facet between three corners of the first sphere is out of reach everywhere.
    cap_ = 1.2 * view.reach;
    // Next to the vertical the best yaws of neighbours are far apart: there one that looks straight down, or up, for
    // all of them does better.
    for (const double pitch : {-std::numbers::pi / 2, std::numbers::pi / 2}) {
      for (int i = 0; i < kVerticalAims; ++i) {
        const AimedView vertical = finder_.next_to({std::numbers::pi * i / kVerticalAims, pitch});
        if (std::abs(vertical.aim.pitch) > kSteep) vertical_.push_back(vertical);
      }
    }
  }

  FrameSurface build();

 private:
  struct Node {
    Node(const Vec3& unit, double reach_m) : direction(unit), reach(reach_m) {}

    Vec3 direction;
    double reach = 0;
    std::optional<Aim> start;  ///< between those of its neighbours, if they are near to each other
    bool is_known = false;
    bool is_new = false;  ///< its view has changed since facets were asked
    AimedView view;       ///< of the best aim found,
    double best = 0;      ///< and how near it lets the viewpoint come
    double distance = 0;
  };
  /// Distances that its corners need for a facet to be safe.
  using Needs = std::array<double, 3>;
  struct Estimate {
    bool is_known = false;
    Needs needs;
  };

  Node node_at(const Vec3& direction, double side) const {
    constexpr double kAbout = 0.6;  // of a side: what is so near to a corner may be in a facet
    if (!view_.reach_along) return {direction, view_.reach};
    return {direction, std::min(view_.reach_along(direction, kAbout * side), view_.reach)};
  }
  bool matters(const Triangle& facet) const;
  void estimate();
  /// Those beside corners that are far out take others with them: facets that no aim does for.
  enum class Asked { all, beside_raised };
  void settle(Asked asked);
  double cost(const Triangle& facet, const Needs& needs) const;
  Needs cheaper_needs(const Triangle& facet) const;
  bool holds(const Triangle& facet, const Needs& needs) const;
  Needs own_needs(const Triangle& facet) const;
  Needs shared_needs(const Triangle& facet) const;
  double length(std::uint32_t a, std::uint32_t b) const;
  double space(const Triangle& facet) const;
  double least_space() const;
  std::uint32_t add_middle(std::uint32_t a, std::uint32_t b);
  bool refine();
  void aim_nodes();

  const FrameView& view_;
  AimFinder finder_;
  std::array<double, 2> normal_length_;
  sensor::Angle roll_;
  double radius_ = 0, cap_ = 0;
  std::vector<AimedView> vertical_;
  std::vector<Node> nodes_;
  std::vector<Triangle> facets_;
  std::vector<Estimate> estimates_;  // per facet
};

/// Whether some of a facet's directions are to the front, or rounding may take them to be.
bool FrameSurfaceBuilder::matters(const Triangle& facet) const {
  constexpr double kMostBehind = 1e-6;
  if (!view_.front) return true;
  return std::any_of(facet.begin(), facet.end(),
                     [&](std::uint32_t i) { return view_.front->dot(nodes_[i].direction) > -kMostBehind; });
}

/// What the corners need where each has its own aim. Between them the camera is aimed at the mean of the three, by the
/// weights l of the place p = sum l_i p_i. How far a corner v of the target is inside of an edge's plane with the
/// normal n, f = n . (v - p), is at the least sum l_i f_i - sum over pairs of l_i l_j f''_ij / 2 less a rest, with
/// f''_ij the second derivative from one corner to the other, n'' . (v - p) - 2 n' . (p_i - p_j), at the facet's
/// middle. docs/theory.md has the rest, and why it is the rest.
FrameSurfaceBuilder::Needs FrameSurfaceBuilder::own_needs(const Triangle& facet) const {
  struct Side {
    double yaw, pitch;
    Vec3 way;
  };
  std::array<Side, 3> sides;
  Vec3 middle = Vec3::Zero();
  double turned = 0, longest = 0, farthest = 0, pitch = 0;
  const double first_yaw = nodes_[facet[0]].view.aim.yaw;
  std::array<double, 3> yaws;
  for (std::size_t i = 0; i < 3; ++i) {
    const Node& node = nodes_[facet[i]];
    yaws[i] = turn(first_yaw, node.view.aim.yaw);
    pitch += node.view.aim.pitch / 3;
    middle += node.distance / 3 * node.direction;
    farthest = std::max(farthest, node.distance + radius_);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Node &a = nodes_[facet[i]], &b = nodes_[facet[(i + 1) % 3]];
    sides[i] = {yaws[(i + 1) % 3] - yaws[i], b.view.aim.pitch - a.view.aim.pitch,
                b.distance * b.direction - a.distance * a.direction};
    turned = std::max(turned, std::abs(sides[i].yaw) + std::abs(sides[i].pitch));
    longest = std::max(longest, sides[i].way.norm());
  }
  const sensor::Angle mean_yaw(first_yaw + (yaws[0] + yaws[1] + yaws[2]) / 3);
  const sensor::PictureEdges edges = sensor::picture_edges(view_.camera, mean_yaw, sensor::Angle(pitch), roll_);
  const Vec3 level(mean_yaw.cosine, -mean_yaw.sine, 0);
  const auto by_yaw = [](const Vec3& v) { return Vec3(v.y(), -v.x(), 0); };
  const double rest = 4.0 / 27 * turned * turned * (turned * farthest + 3 * longest);
  std::array<double, 4> slack{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& n = edges[k];
    const Vec3 n_yaw = by_yaw(n), n_pitch = level.cross(n);
    const Vec3 n_yaw_yaw = by_yaw(n_yaw), n_yaw_pitch = 2 * by_yaw(n_pitch), n_pitch_pitch = level.cross(n_pitch);
    std::array<double, 3> most;
    for (std::size_t i = 0; i < 3; ++i) {
      const Side& side = sides[i];
      const Vec3 first = side.yaw * n_yaw + side.pitch * n_pitch;
      const Vec3 second =
          side.yaw * (side.yaw * n_yaw_yaw + side.pitch * n_yaw_pitch) + side.pitch * side.pitch * n_pitch_pitch;
      double farthest_corner = -kNever;
      for (const Vec3& corner : view_.corners) farthest_corner = std::max(farthest_corner, second.dot(corner));
      most[i] = std::max(0.0, farthest_corner - second.dot(middle) - 2 * first.dot(side.way));
    }
    slack[k] = most_of_products(most[0], most[1], most[2]) / 2 + normal_length_[k / 2] * rest;
  }
  Needs needs;
  for (std::size_t i = 0; i < 3; ++i) needs[i] = nodes_[facet[i]].view.distance(nodes_[facet[i]].direction, slack);
  return needs;
}

/// Where one aim, that of a corner or a vertical one, does for all: the places from which it does are convex.
FrameSurfaceBuilder::Needs FrameSurfaceBuilder::shared_needs(const Triangle& facet) const {
  Needs best{kNever, kNever, kNever};
  double least = kNever;
  const auto consider = [&](const AimedView& view) {
    Needs needs;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      needs[i] = view.distance(nodes_[facet[i]].direction);
      sum += std::max(needs[i], nodes_[facet[i]].distance);
    }
    if (!(sum < least)) return;
    least = sum;
    best = needs;
  };
  for (const std::uint32_t of : facet) consider(nodes_[of].view);
  if (std::abs(nodes_[facet[0]].direction.z()) < portable::sin(kSteep)) return best;
  for (const AimedView& view : vertical_) consider(view);
  return best;
}

bool FrameSurfaceBuilder::holds(const Triangle& facet, const Needs& needs) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(nodes_[facet[i]].distance >= needs[i])) return false;
  }
  return true;
}

/// The sum of the corners' distances once they are raised to what is needed.
double FrameSurfaceBuilder::cost(const Triangle& facet, const Needs& needs) const {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += std::max(needs[i], nodes_[facet[i]].distance);
  return sum;
}

/// What is needed where the corners are as near as each of them may be.
FrameSurfaceBuilder::Needs FrameSurfaceBuilder::cheaper_needs(const Triangle& facet) const {
  const Needs own = own_needs(facet);
  if (cost(facet, own) <= (1 + view_.share) * cost(facet, {})) return own;
  const Needs shared = shared_needs(facet);
  Needs needs = cost(facet, own) <= cost(facet, shared) ? own : shared;
  if (!(*std::max_element(needs.begin(), needs.end()) < cap_)) needs.fill(cap_);
  return needs;
}

/// About how far out corners will have to be. A facet is asked again where the aims of its corners have changed.
void FrameSurfaceBuilder::estimate() {
  for (Node& node : nodes_) node.distance = std::min(node.best, cap_);
  estimates_.resize(facets_.size());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Triangle& facet = facets_[f];
    if (!matters(facet)) continue;
    Estimate& of = estimates_[f];
    const bool is_new = std::any_of(facet.begin(), facet.end(), [&](std::uint32_t i) { return nodes_[i].is_new; });
    if (!of.is_known || is_new) of = {true, cheaper_needs(facet)};
  }
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (!estimates_[f].is_known) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      double& distance = nodes_[facets_[f][i]].distance;
      distance = std::min(std::max(distance, estimates_[f].needs[i]), cap_);
    }
  }
  for (Node& node : nodes_) node.is_new = false;
  settle(Asked::beside_raised);
}

/// Raises corners until every facet is safe. A facet that one aim makes safe stays so when corners are raised, others
/// are asked again. A facet that does not settle early gives up its own aims, as what they need grows with the
/// distances; so this ends.
void FrameSurfaceBuilder::settle(Asked asked) {
  constexpr int kBefore = -2;
  std::vector<int> raised(nodes_.size(), asked == Asked::all ? 0 : kBefore);  // in which pass
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    if (node.distance > kMuch * node.best) raised[i] = 0;
    node.distance = std::min(node.distance * kRaise, cap_);
  }
  std::vector<int> own_raises(facets_.size(), 0);
  bool is_raised = true;
  for (int pass = 1; is_raised; ++pass) {
    is_raised = false;
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      const Triangle& facet = facets_[f];
      const bool is_new =
          std::any_of(facet.begin(), facet.end(), [&](std::uint32_t i) { return raised[i] >= pass - 1; });
      if (!is_new || !matters(facet) || holds(facet, {cap_, cap_, cap_})) continue;
      const Needs own = own_needs(facet);
      if (holds(facet, own)) continue;
      const Needs shared = shared_needs(facet);
      if (holds(facet, shared)) continue;
      const bool takes_own = own_raises[f] < kOwnRaises && cost(facet, own) <= cost(facet, shared);
      if (takes_own) ++own_raises[f];
      Needs needs = takes_own ? own : shared;
      // No aim does: nothing is left in its directions.
      if (!(*std::max_element(needs.begin(), needs.end()) < cap_)) needs.fill(cap_);
      for (std::size_t i = 0; i < 3; ++i) {
        double& distance = nodes_[facet[i]].distance;
        if (needs[i] <= distance) continue;
        distance = std::min(needs[i] * kRaise, cap_);
        raised[facet[i]] = pass;
      }
      is_raised = true;
    }
  }
}

double FrameSurfaceBuilder::length(std::uint32_t a, std::uint32_t b) const {
  return (nodes_[a].direction - nodes_[b].direction).norm();
}

/// What a facet takes away too much of what can be seen, times 18.
double FrameSurfaceBuilder::space(const Triangle& facet) const {
  double sum = 0;
  for (const std::uint32_t i : facet) {
    const Node& node = nodes_[i];
    sum += std::max(cube(std::min(node.distance, node.reach)) - cube(node.best), 0.0);
  }
  const Vec3& from = nodes_[facet[0]].direction;
  return sum * (nodes_[facet[1]].direction - from).cross(nodes_[facet[2]].direction - from).norm();
}

/// Facets with more space are halved: more than the mean, and no more of them than there may be.
double FrameSurfaceBuilder::least_space() const {
  std::vector<double> spaces;
  double all = 0;
  for (const Triangle& facet : facets_) {
    if (!matters(facet)) continue;
    spaces.push_back(space(facet));
    all += spaces.back();
  }
  const double mean = all / static_cast<double>(facets_.size());
  // A facet that is halved halves another one beside it.
  const std::size_t most = std::max<std::size_t>((view_.most_facets - facets_.size()) / 2, 1);
  if (spaces.size() <= most) return mean;
  std::nth_element(spaces.begin(), spaces.begin() + static_cast<std::ptrdiff_t>(most), spaces.end(), std::greater());
  return std::max(mean, spaces[most]);
}

std::uint32_t FrameSurfaceBuilder::add_middle(std::uint32_t a, std::uint32_t b) {
  Node node = node_at((nodes_[a].direction + nodes_[b].direction).normalized(), length(a, b) / 2);
  if (nodes_[a].is_known && nodes_[b].is_known) {
    const Aim from = nodes_[a].view.aim, to = nodes_[b].view.aim;
    const double yaw = turn(from.yaw, to.yaw), pitch = to.pitch - from.pitch;
    if (std::abs(yaw) + std::abs(pitch) < kSmallTurn) node.start = Aim{from.yaw + yaw / 2, from.pitch + pitch / 2};
  }
  nodes_.push_back(node);
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

/// Halves facets that lie farther out than they have to, of these the ones with the most space between the two. False
/// where none does, or there are enough.
bool FrameSurfaceBuilder::refine() {
  if (static_cast<double>(facets_.size()) > kEnough * static_cast<double>(view_.most_facets)) return false;
  const auto is_far_out = [&](std::uint32_t i) {
    const Node& node = nodes_[i];
    return node.best < node.reach && node.distance > node.best * (1 + view_.share);
  };
  const double least = least_space();
  const auto wants = [&](const Triangle& t) {
    return matters(t) && std::any_of(t.begin(), t.end(), is_far_out) && space(t) > least &&
           std::max({length(t[0], t[1]), length(t[1], t[2]), length(t[2], t[0])}) > kNarrowest;
  };
  const std::vector<Triangle> before = facets_;
  std::vector<std::uint32_t> of_facet;
  const auto side_length = [&](std::uint32_t a, std::uint32_t b) { return length(a, b); };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) { return add_middle(a, b); };
  if (!halve_sides(facets_, wants, side_length, middle, of_facet)) return false;
  std::vector<Estimate> estimates(facets_.size());
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    if (facets_[i] == before[of_facet[i]]) estimates[i] = estimates_[of_facet[i]];
  }
  estimates_ = std::move(estimates);
  return true;
}

/// The best aim may be one of several that no small turn leads to: what a neighbour has found is tried too.
void FrameSurfaceBuilder::aim_nodes() {
  constexpr double kBetter = 1 - 1e-3;
  std::vector<std::uint32_t> unknown;
  for (const Triangle& facet : facets_) {
    if (!matters(facet)) continue;
    for (const std::uint32_t i : facet) {
      if (!std::exchange(nodes_[i].is_known, true)) unknown.push_back(i);
    }
  }
  parallel::for_ranges(unknown.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Node& node = nodes_[unknown[i]];
      node.view = finder_.best(node.direction, node.start);
      node.best = std::max(node.view.distance(node.direction), view_.least);
      node.is_new = true;
    }
  });
  std::vector<int> changed(nodes_.size(), -1);  // in which pass
  for (const std::uint32_t i : unknown) changed[i] = 0;
  int pass = 0;
  const auto learn = [&](std::uint32_t i, const Node& neighbour) {
    Node& node = nodes_[i];
    const double its_distance = neighbour.view.distance(node.direction);
    if (!(std::max(its_distance, view_.least) < kBetter * node.best)) return false;
    // The search from there may end at a worse one: then the same would be learnt again and again.
    const AimedView found = finder_.best(node.direction, neighbour.view.aim);
    node.view = found.distance(node.direction) <= its_distance ? found : neighbour.view;
    node.best = std::max(node.view.distance(node.direction), view_.least);
    node.is_new = true;
    changed[i] = pass;
    return true;
  };
  for (bool is_better = true; is_better;) {
    is_better = false;
    ++pass;
    for (const Triangle& facet : facets_) {
      const bool is_new =
          changed[facet[0]] >= pass - 1 || changed[facet[1]] >= pass - 1 || changed[facet[2]] >= pass - 1;
      if (!is_new || !matters(facet)) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = facet[i], b = facet[(i + 1) % 3];
        if (a > b) continue;  // the facet on the other side asks them
        if (learn(a, nodes_[b])) is_better = true;
        if (learn(b, nodes_[a])) is_better = true;
      }
    }
  }
}

FrameSurface FrameSurfaceBuilder::build() {
  SphereMesh sphere = make_sphere(kFirstParts);
  for (const Vec3& direction : sphere.mesh.vertices) nodes_.push_back(node_at(direction, kFirstSide));
  facets_ = std::move(sphere.mesh.triangles);
  do {
    aim_nodes();
    estimate();
  } while (refine());
  settle(Asked::all);

  FrameSurface surface;
  surface.least_distance = kNever;
  for (const Node& node : nodes_) {
    const double distance = node.is_known ? node.distance : std::max(radius_, view_.least);
    surface.mesh.vertices.push_back(distance * node.direction);
    if (node.is_known) surface.least_distance = std::min(surface.least_distance, node.best);
  }
  for (const Triangle& facet : facets_) {
    surface.by_mount.push_back(std::all_of(facet.begin(), facet.end(), [&](std::uint32_t i) {
      return nodes_[i].is_known && finder_.is_at_limit(nodes_[i].view.aim);
    }));
  }
  surface.mesh.triangles = facets_;
  return surface;
}

}  // namespace

FrameSurface make_frame_surface(const FrameView& view) { return FrameSurfaceBuilder(view).build(); }

}  // namespace vantage::internal::solid
