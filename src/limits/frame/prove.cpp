// With one orientation what is allowed is convex, an intersection of cones at the target's corners, and vertices
// decide. With several, one of them that serves the three corners of a facet serves all of it. And what is allowed goes
// on away from the target: if c is outside, the way from a forbidden position to c leaves the volume through a
// forbidden point of a facet, which may face either way where the mesh winds round backwards. So one orientation for
// each facet, or for each part of it, is a proof.
#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>

#include "core/parallel.h"
#include "prove/limit_proof.h"
#include "prove/lowest_point.h"
#include "prove/orientation.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

/// Radians, as Mount has them.
struct CameraAim {
  double yaw = 0, pitch = 0;
};

class Picture {
 public:
  Picture(const Pinhole& camera, const Mount& mount, const std::vector<View>& parts, const Vec3& origin)
      : mount_(mount), roll_(mount.roll_deg * kDegrees) {
    across_ = 1 / std::hypot(1, camera.half_width);
    upright_ = 1 / std::hypot(1, camera.half_height);
    half_width_ = camera.half_width;
    half_height_ = camera.half_height;
    for (const View& part : parts) {
      for (const Vec3& corner : part.whole) corners_.push_back(part.origin - origin + corner);
    }
    for (const Vec3& corner : corners_) middle_ += corner / static_cast<double>(corners_.size());
    coarse_ = grid_of(5 * kDegrees);
    fine_ = grid_of(2 * kDegrees);
  }

  const Vec3& middle() const { return middle_; }

  /// Ahead, to the right and down in the picture.
  std::array<Vec3, 3> axes(const CameraAim& aim) const {
    const Vec3 ahead(std::cos(aim.pitch) * std::sin(aim.yaw), std::cos(aim.pitch) * std::cos(aim.yaw),
                     std::sin(aim.pitch));
    const Vec3 level(std::cos(aim.yaw), -std::sin(aim.yaw), 0), below = ahead.cross(level);
    // A positive roll lowers the right edge.
    return {ahead, std::cos(roll_) * level + std::sin(roll_) * below,
            std::cos(roll_) * below - std::sin(roll_) * level};
  }

  /// The edges of the picture, left, right, top and bottom: unit normals of the planes through the camera, inward.
  std::array<Vec3, 4> edges(const CameraAim& aim) const {
    const auto [ahead, right, down] = axes(aim);
    return {across_ * (half_width_ * ahead + right), across_ * (half_width_ * ahead - right),
            upright_ * (half_height_ * ahead + down), upright_ * (half_height_ * ahead - down)};
  }

  /// An orientation, and what it takes to ask whether it serves.
  struct KnownAim {
    CameraAim aim;
    std::array<Vec3, 4> edges;      ///< of the picture
    std::array<double, 4> nearest;  ///< of the target's corners, along each
  };
  KnownAim known(const CameraAim& aim) const {
    KnownAim known{aim, edges(aim), {}};
    for (std::size_t e = 0; e < 4; ++e) {
      known.nearest[e] = std::numeric_limits<double>::infinity();
      for (const Vec3& corner : corners_) known.nearest[e] = std::min(known.nearest[e], known.edges[e].dot(corner));
    }
    return known;
  }

  /// Metres by which some corner of the target is out of the picture, from some of the positions; negative: in it.
  /// NaN where it cannot be computed, which no comparison takes for in it.
  template <typename Positions>
  double out_by(const KnownAim& known, const Positions& positions) const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < 4; ++e) {
      for (const Vec3& position : positions) {
        const double out = known.edges[e].dot(position) - known.nearest[e];
        if (!std::isfinite(out)) return std::numeric_limits<double>::quiet_NaN();  // std::max passes over NaN
        most = std::max(most, out);
      }
    }
    return most;
  }
  template <typename Positions>
  double out_by(const CameraAim& aim, const Positions& positions) const {
    return out_by(known(aim), positions);
  }

  /// Towards the target.
  CameraAim towards(const LimitedVolume::Corners& positions) const {
    const Vec3 way = middle_ - (positions[0] + positions[1] + positions[2]) / 3;
    return {mount_.yaw_deg ? *mount_.yaw_deg * kDegrees : std::atan2(way.x(), way.y()),
            clamped(std::atan2(way.z(), way.head<2>().norm()))};
  }

  /// Of a grid over all that the mount allows, those with no better neighbour: the best ones, best first.
  enum class Grid { coarse, fine };
  std::vector<CameraAim> local_minima(const LimitedVolume::Corners& positions, Grid grid = Grid::coarse) const {
    const AimGrid& all = grid == Grid::coarse ? coarse_ : fine_;
    const int pitches = all.pitches;
    constexpr std::size_t kMost = 8;
    constexpr double kDeepest = 0.15;  // radians: where more is out, none next to it lets all in
    const int yaws = static_cast<int>(all.aims.size()) / pitches;
    std::vector<double> outs;
    outs.reserve(all.aims.size());
    for (const KnownAim& known : all.aims) outs.push_back(out_by(known, positions));
    const auto index_of = [&](int yaw, int pitch) {
      return static_cast<std::size_t>((yaw + yaws) % yaws) * static_cast<std::size_t>(pitches) +
             static_cast<std::size_t>(std::clamp(pitch, 0, pitches - 1));
    };
    const auto out_at = [&](int yaw, int pitch) { return outs[index_of(yaw, pitch)]; };
    const double deepest = kDeepest * distance_from(positions[0]);
    std::vector<std::pair<double, CameraAim>> found;
    for (int yaw = 0; yaw < yaws; ++yaw) {
      for (int pitch = 0; pitch < pitches; ++pitch) {
        const double out = out_at(yaw, pitch);
        if (!(out < deepest)) continue;
        bool is_least = true;
        for (int i = 0; i < 9 && is_least; ++i) is_least = out <= out_at(yaw + i / 3 - 1, pitch + i % 3 - 1);
        if (is_least) found.emplace_back(out, all.aims[index_of(yaw, pitch)].aim);
      }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    if (found.size() > kMost) found.resize(kMost);
    std::vector<CameraAim> aims;
    for (const auto& minimum : found) aims.push_back(minimum.second);
    return aims;
  }

  /// Turns the camera so that what it must see is in the middle of its picture, as far as the mount lets it.
  template <typename Positions>
  CameraAim centred(CameraAim aim, const Positions& positions) const {
    constexpr int kTurns = 4;
    for (int turn = 0; turn < kTurns; ++turn) {
      const auto [ahead, right, down] = axes(aim);
      Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
      for (const Vec3& position : positions) {
        for (const Vec3& corner : corners_) {
          const Vec3 sight = corner - position;
          const double depth = ahead.dot(sight);
          if (!(depth > 0)) return aim;
          const Eigen::Array2d at(right.dot(sight) / depth, down.dot(sight) / depth);
          low = low.min(at);
          high = high.max(at);
        }
      }
      const Eigen::Array2d middle = (low + high) / 2;
      const Vec3 next = ahead + middle.x() * right + middle.y() * down;
      if (!mount_.yaw_deg) {
        // The nearest of the turns, so that aims of neighbours can be compared.
        aim.yaw += std::remainder(std::atan2(next.x(), next.y()) - aim.yaw, 2 * std::numbers::pi);
      }
      aim.pitch = clamped(std::atan2(next.z(), next.head<2>().norm()));
    }
    return aim;
  }

  /// Turns the camera until nothing is out by more than what is allowed, or as far as that gets better: to where the
  /// most is least that any corner is out by, were it linear, again and again (Madsen 1975). Whether it is allowed
  /// then.
  template <typename Positions>
  bool improve(CameraAim& aim, const Positions& positions, double allowed) const {
    constexpr int kMostTurns = 40;
    constexpr double kFirst = 0.1, kFarthest = 0.5, kLast = 1e-9;    // radians
    const double least_gain = std::isfinite(allowed) ? 1e-9 : 1e-6;  // of the distance
    double out = out_by(aim, positions), reach = kFirst;
    for (int i = 0; i < kMostTurns && out > allowed && reach > kLast; ++i) {
      const std::vector<Plane2> planes = outs_about(aim, positions);
      const double yaw = mount_.yaw_deg ? 0 : reach;
      const Eigen::Vector2d turn = lowest_point(planes, {-yaw, clamped(aim.pitch - reach) - aim.pitch},
                                                {yaw, clamped(aim.pitch + reach) - aim.pitch});
      const double hoped = highest(planes, turn);
      if (!(out - hoped > least_gain * distance_from(positions[0]))) break;
      const CameraAim next{aim.yaw + turn.x(), clamped(aim.pitch + turn.y())};
      const double out_of_next = out_by(next, positions), gain = (out - out_of_next) / (out - hoped);
      if (gain > 0) {
        aim = next;
        out = out_of_next;
      }
      const double turned = turn.cwiseAbs().maxCoeff();
      if (gain < 0.25) reach = turned / 4;
      if (gain > 0.75) reach = std::clamp(2 * turned, reach, kFarthest);
    }
    return out <= allowed;
  }

  /// For one place: as far as it gets better.
  CameraAim improve_alone(CameraAim aim, const Vec3& position) const {
    improve(aim, std::array{position}, -std::numeric_limits<double>::infinity());
    return aim;
  }

  /// Whether an orientation that changes linearly, from that of one corner of a facet to that of the next, serves all
  /// of it. An edge's normal is its Taylor polynomial of the second degree about the mean of the three, but for a sixth
  /// of the cube of the turn from there; so what is out is a polynomial of the third degree in the weights of the
  /// corners, but for that times the distance.
  bool serve(const std::array<CameraAim, 3>& aims, const LimitedVolume::Corners& facet, double allowed) const {
    const CameraAim mean{(aims[0].yaw + aims[1].yaw + aims[2].yaw) / 3,
                         (aims[0].pitch + aims[1].pitch + aims[2].pitch) / 3};
    std::array<Eigen::Vector2d, 3> turns;
    double farthest = 0, most_turn = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      turns[i] = {aims[i].yaw - mean.yaw, aims[i].pitch - mean.pitch};
      most_turn = std::max(most_turn, turns[i].lpNorm<1>());
      farthest = std::max(farthest, distance_from(facet[i]));
    }
    const double most = allowed - most_turn * most_turn * most_turn / 6 * farthest;
    const Vec3 level(std::cos(mean.yaw), -std::sin(mean.yaw), 0);
    for (const Vec3& edge : edges(mean)) {
      const std::array<std::array<Vec3, 3>, 3> normals = polar_normals(edge, level, turns);
      for (const Vec3& corner : corners_) {
        Cubic out;
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) {
              out[9 * i + 3 * j + k] = (normals[i][j].dot(facet[k] - corner) + normals[j][k].dot(facet[i] - corner) +
                                        normals[k][i].dot(facet[j] - corner)) /
                                       3;
            }
          }
        }
        if (!is_at_most(out, most, kMostHalvings)) return false;
      }
    }
    return true;
  }

 private:
  /// A polynomial of the third degree over a triangle: symmetric, one number for each three of its corners (its polar
  /// form). These are its coefficients in Bernstein's form: it is no more than the most of them.
  using Cubic = std::array<double, 27>;
  static constexpr int kMostHalvings = 7;

  static bool is_at_most(const Cubic& cubic, double most, int halvings) {
    bool are_all = true;
    for (const double value : cubic) are_all = are_all && value <= most;
    if (are_all) return true;
    for (const std::size_t corner : {0, 13, 26}) {
      if (!(cubic[corner] <= most)) return false;
    }
    if (halvings == 0) return false;
    const auto a = static_cast<std::size_t>(halvings) % 3, b = (a + 1) % 3;
    return is_at_most(halved(cubic, a, b), most, halvings - 1) && is_at_most(halved(cubic, b, a), most, halvings - 1);
  }

  /// Over the half in which the middle between two corners takes the place of the first one.
  static Cubic halved(Cubic cubic, std::size_t moved, std::size_t kept) {
    for (const std::size_t axis : {1, 3, 9}) {
      for (std::size_t at = 0; at < cubic.size(); ++at) {
        if (at / axis % 3 == moved) cubic[at] = (cubic[at] + cubic[at - moved * axis + kept * axis]) / 2;
      }
    }
    return cubic;
  }

  /// The polar form of an edge's normal, to the second degree, of places that turn the camera so from where the edge is
  /// `edge`.
  static std::array<std::array<Vec3, 3>, 3> polar_normals(const Vec3& edge, const Vec3& level,
                                                          const std::array<Eigen::Vector2d, 3>& turns) {
    const auto by_yaw = [](const Vec3& v) { return Vec3(v.y(), -v.x(), 0); };
    const Vec3 yaw = by_yaw(edge), pitch = level.cross(edge);
    const Vec3 yaw_yaw = by_yaw(yaw), yaw_pitch = by_yaw(pitch), pitch_pitch = level.cross(pitch);
    std::array<std::array<Vec3, 3>, 3> normals;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) {
        const Eigen::Vector2d &a = turns[i], &b = turns[j], mean = (a + b) / 2;
        normals[i][j] = normals[j][i] = edge + mean.x() * yaw + mean.y() * pitch + a.x() * b.x() / 2 * yaw_yaw +
                                        (a.x() * b.y() + a.y() * b.x()) / 2 * yaw_pitch +
                                        a.y() * b.y() / 2 * pitch_pitch;
      }
    }
    return normals;
  }

  /// Metres by which each corner is out of each edge of the picture, from each position, as the camera turns by yaw and
  /// pitch.
  template <typename Positions>
  std::vector<Plane2> outs_about(const CameraAim& aim, const Positions& positions) const {
    std::vector<Plane2> planes;
    const Vec3 level(std::cos(aim.yaw), -std::sin(aim.yaw), 0);
    for (const Vec3& edge : edges(aim)) {
      const Vec3 by_yaw(edge.y(), -edge.x(), 0), by_pitch = level.cross(edge);
      for (const Vec3& position : positions) {
        for (const Vec3& corner : corners_) {
          const Vec3 sight = position - corner;
          planes.push_back({edge.dot(sight), {by_yaw.dot(sight), by_pitch.dot(sight)}});
        }
      }
    }
    return planes;
  }

  /// To the farthest corner.
  double distance_from(const Vec3& position) const {
    double farthest = 0;
    for (const Vec3& corner : corners_) farthest = std::max(farthest, (corner - position).norm());
    return farthest;
  }

  /// Over all that the mount allows, yaw by yaw.
  struct AimGrid {
    std::vector<KnownAim> aims;
    int pitches = 0;
  };
  AimGrid grid_of(double step) const {
    const double low = clamped(-std::numbers::pi / 2), high = clamped(std::numbers::pi / 2);
    const int yaws = mount_.yaw_deg ? 1 : static_cast<int>(2 * std::numbers::pi / step);
    AimGrid grid{{}, 2 + static_cast<int>((high - low) / step)};
    for (int yaw = 0; yaw < yaws; ++yaw) {
      for (int pitch = 0; pitch < grid.pitches; ++pitch) {
        const double turned = mount_.yaw_deg ? *mount_.yaw_deg * kDegrees : yaw * 2 * std::numbers::pi / yaws;
        grid.aims.push_back(known({turned, low + (high - low) * pitch / (grid.pitches - 1)}));
      }
    }
    return grid;
  }

  double clamped(double pitch) const {
    return std::clamp(pitch, mount_.min_pitch_deg * kDegrees, mount_.max_pitch_deg * kDegrees);
  }

  Mount mount_;
  double roll_, across_, upright_, half_width_, half_height_;
  std::vector<Vec3> corners_;
  Vec3 middle_ = Vec3::Zero();
  AimGrid coarse_, fine_;
};

/// Looks for orientations that serve facets one after another, in parts where it must. What served one is tried for the
/// next ones.
class FacetServer {
 public:
  explicit FacetServer(const Picture& picture) : picture_(picture) {}

  bool serves(const LimitedVolume::Corners& facet, double allowed) {
    allowed_ = allowed;
    left_ = kMostCuts;
    return serves_in_parts(facet);
  }

 private:
  bool serves_in_parts(const LimitedVolume::Corners& facet) {
    if (serves_whole(facet)) return true;
    for (const Vec3& corner : facet) {
      if (!serves_whole({corner, corner, corner})) return false;
    }
    if (left_ == 0) return false;
    --left_;
    std::size_t longest = 0;
    const auto side = [&](std::size_t k) { return (facet[k] - facet[(k + 1) % 3]).squaredNorm(); };
    for (const std::size_t k : {1, 2}) longest = side(k) > side(longest) ? k : longest;
    const std::size_t next = (longest + 1) % 3;
    LimitedVolume::Corners first = facet, second = facet;
    first[next] = second[longest] = (facet[longest] + facet[next]) / 2;
    return serves_in_parts(first) && serves_in_parts(second);
  }

  bool serves_whole(const LimitedVolume::Corners& facet) {
    for (std::size_t i = 0; i < recent_.size(); ++i) {
      if (!(picture_.out_by(recent_[i], facet) <= allowed_)) continue;
      std::rotate(recent_.begin(), recent_.begin() + static_cast<std::ptrdiff_t>(i),
                  recent_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return true;
    }
    std::vector<CameraAim> aims = {picture_.towards(facet)};
    for (const Picture::KnownAim& known : recent_) aims.push_back(known.aim);
    return serves_next_to(aims, facet) || serves_next_to(picture_.local_minima(facet), facet) || serves_apart(facet) ||
           serves_next_to(picture_.local_minima(facet, Picture::Grid::fine), facet);
  }

  /// Whether those that were found for each corner by itself serve all of a facet, where they are near each other.
  bool serves_apart(const LimitedVolume::Corners& facet) {
    std::array<std::vector<CameraAim>, 3> starts, aims;
    for (std::size_t i = 0; i < 3; ++i) starts[i] = picture_.local_minima({facet[i], facet[i], facet[i]});
    for (std::size_t i = 0; i < 3; ++i) {
      for (const std::vector<CameraAim>& list : starts) {  // what is good for a corner may be for the next one
        for (const CameraAim& start : list) {
          const CameraAim aim = picture_.improve_alone(start, facet[i]);
          if (picture_.out_by(aim, std::array{facet[i]}) <= allowed_) aims[i].push_back(aim);
        }
      }
      if (aims[i].empty()) return false;
      starts[i].insert(starts[i].end(), aims[i].begin(), aims[i].end());
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t known = aims[k].size();
        for (std::size_t a = 0; k != i && a < std::min(known, kMostApart); ++a) {
          const CameraAim aim = picture_.improve_alone(aims[k][a], facet[i]);
          if (picture_.out_by(aim, std::array{facet[i]}) <= allowed_) aims[i].push_back(aim);
        }
      }
    }
    return std::any_of(aims[0].begin(), aims[0].end(), [&](const CameraAim& aim) {
      return picture_.serve({aim, nearest(aims[1], aim), nearest(aims[2], aim)}, facet, allowed_) && found(aim);
    });
  }

  /// With its yaw on the same turn.
  static CameraAim nearest(const std::vector<CameraAim>& aims, const CameraAim& to) {
    const auto turned = [&](const CameraAim& aim) { return std::remainder(aim.yaw - to.yaw, 2 * std::numbers::pi); };
    const CameraAim& best = *std::min_element(aims.begin(), aims.end(), [&](const CameraAim& a, const CameraAim& b) {
      return std::abs(turned(a)) + std::abs(a.pitch - to.pitch) < std::abs(turned(b)) + std::abs(b.pitch - to.pitch);
    });
    return {to.yaw + turned(best), best.pitch};
  }

  /// Whether an orientation next to one of these serves all of a facet, or those for its corners do.
  bool serves_next_to(const std::vector<CameraAim>& aims, const LimitedVolume::Corners& facet) {
    std::vector<std::pair<double, CameraAim>> in_order;
    for (const CameraAim& aim : aims) in_order.emplace_back(picture_.out_by(aim, facet), aim);
    std::stable_sort(in_order.begin(), in_order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto centre = [&](const CameraAim& aim, const Vec3& corner) {
      return picture_.centred(aim, std::array{corner});
    };
    for (std::size_t i = 0; i < std::min(in_order.size(), kMostCentred); ++i) {
      const CameraAim centred = picture_.centred(in_order[i].second, facet);
      if (picture_.out_by(centred, facet) <= allowed_ || serves_between(centred, facet, centre)) return found(centred);
    }
    for (auto& [out, aim] : in_order) {
      const auto own = [&](const CameraAim& start, const Vec3& corner) { return own_aim(start, corner); };
      if (serves_between(aim, facet, own) || picture_.improve(aim, facet, allowed_)) return found(aim);
    }
    return false;
  }

  /// The best one for a corner next to `start`. Facets share corners, so what is found is kept.
  CameraAim own_aim(const CameraAim& start, const Vec3& corner) {
    constexpr double kNear = 0.15;  // radians
    std::vector<CameraAim>& known = own_aims_[{corner.x(), corner.y(), corner.z()}];
    for (const CameraAim& aim : known) {
      const double yaw = std::remainder(aim.yaw - start.yaw, 2 * std::numbers::pi);
      if (std::abs(yaw) + std::abs(aim.pitch - start.pitch) < kNear) return {start.yaw + yaw, aim.pitch};
    }
    const CameraAim aim = picture_.improve_alone(start, corner);
    if (picture_.out_by(aim, std::array{corner}) <= allowed_) known.push_back(aim);
    return aim;
  }

  bool found(const CameraAim& aim) {
    constexpr std::size_t kMostRecent = 6;
    recent_.insert(recent_.begin(), picture_.known(aim));
    if (recent_.size() > kMostRecent) recent_.pop_back();
    return true;
  }

  /// Whether those for the corners, which are found from `aim` and so are alike, serve all of a facet.
  template <typename Find>
  bool serves_between(const CameraAim& aim, const LimitedVolume::Corners& facet, const Find& find) const {
    std::array<CameraAim, 3> aims;
    for (std::size_t i = 0; i < 3; ++i) {
      aims[i] = find(aim, facet[i]);
      if (!(picture_.out_by(aims[i], std::array{facet[i]}) <= allowed_)) return false;
    }
    return picture_.serve(aims, facet, allowed_);
  }

  static constexpr std::size_t kMostCentred = 2;
  static constexpr std::size_t kMostApart = 24;
  static constexpr int kMostCuts = 100;  // of a facet and its parts
  const Picture& picture_;
  std::vector<Picture::KnownAim> recent_;  ///< the last one first
  std::map<std::array<double, 3>, std::vector<CameraAim>> own_aims_;
  double allowed_ = 0;
  int left_ = kMostCuts;
};

/// Facets by the directions from a point, so that the next one in the list is mostly beside the one before.
std::vector<std::uint32_t> in_order_of_directions(const std::vector<LimitedVolume::Corners>& facets, const Vec3& from) {
  constexpr int kBits = 10;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    const Vec3 way = (facets[f][0] + facets[f][1] + facets[f][2]) / 3 - from;
    const double length = way.norm();
    const Vec3 place = length > 0 && std::isfinite(length) ? Vec3(way / length) : Vec3(Vec3::Zero());
    std::uint64_t key = 0;
    for (int bit = kBits - 1; bit >= 0; --bit) {  // Morton's order
      for (const double along : place) {
        const auto cell = static_cast<std::uint64_t>((along + 1) / 2 * ((1 << kBits) - 1));
        key = key << 1 | (cell >> bit & 1);
      }
    }
    keyed.emplace_back(key, f);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order;
  for (const auto& [key, f] : keyed) order.push_back(f);
  return order;
}

struct OpenFacets {
  std::size_t count = 0;
  bool are_all = true;  ///< all were looked at
};

/// In runs of neighbours; what is found does not depend on the number of threads.
template <typename IsOpen>
OpenFacets count_open(const std::vector<LimitedVolume::Corners>& facets, const Picture& picture, const IsOpen& is_open,
                      const core::ProgressReporter& progress) {
  constexpr std::size_t kRun = 256, kRuns = 16;
  constexpr std::size_t kMostOpen = 100;  // these take longest, and one is enough not to prove it
  const std::vector<std::uint32_t> order = in_order_of_directions(facets, picture.middle());
  OpenFacets open;
  std::atomic<std::size_t> count = 0;
  for (std::size_t first = 0; first < order.size() && open.are_all; first += kRun * kRuns) {
    const std::size_t runs = std::min(kRuns, (order.size() - first + kRun - 1) / kRun);
    parallel::for_ranges(runs, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t run = begin; run < end; ++run) {
        FacetServer server(picture);
        const std::size_t from = first + run * kRun, to = std::min(order.size(), from + kRun);
        for (std::size_t i = from; i < to; ++i) {
          if (is_open(facets[order[i]], server)) ++count;
          progress.report(i, order.size());
        }
      }
    });
    open.are_all = count <= kMostOpen || first + kRun * kRuns >= order.size();
  }
  open.count = count;
  return open;
}

}  // namespace

template <>
ClaimProof prove_limit<Limit::frame>(const Pinhole& camera, const Claimant& of,
                                     const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  const Mount& mount = of.sensor.mount;
  const Picture picture(camera, mount, of.parts, volume.origin());
  if (mount.is_fixed()) {
    const CameraAim aim{*mount.yaw_deg * kDegrees, mount.min_pitch_deg * kDegrees};
    return volume.judged_at_vertices("frame",
                                     [&](const Vec3& vertex) { return picture.out_by(aim, std::array{vertex}); });
  }
  const std::optional<bool> is_outside = volume.is_outside(picture.middle());
  if (!is_outside || !*is_outside) return not_proved("frame", "the volume reaches the middle of the target");
  double farthest = 0;
  for (const Vec3& vertex : volume.vertices()) farthest = std::max(farthest, (vertex - picture.middle()).norm());
  const auto is_open = [&](const LimitedVolume::Corners& facet, FacetServer& server) {
    // The way to c does not leave along a facet's plane, but for a few that have neighbours which do not.
    if (orientation(facet[0], facet[1], facet[2], picture.middle()) == 0) return false;
    // What is out at a facet is out by as much more behind it as that lies farther from the target.
    const double distance = nearest_points(facet, {picture.middle(), picture.middle(), picture.middle()}).distance;
    return !server.serves(facet, std::min(volume.tolerance_of(facet), volume.tolerance_m() * distance / farthest));
  };
  const OpenFacets open = count_open(volume.facets(), picture, is_open, progress);
  if (open.count == 0)
    return proved("frame", "for each facet an orientation of the mount was found that serves all of it");
  return not_proved("frame", std::string("no orientation of the mount was found: it is open for ") +
                                 (open.are_all ? "" : "at least ") + std::to_string(open.count) + " facets");
}

}  // namespace vantage::internal::prove
