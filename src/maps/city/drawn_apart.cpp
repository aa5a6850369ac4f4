#include "maps/city/drawn_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

// Distances to try, in metres: what is least seen first.
constexpr std::array<double, 9> kDistances = {0.001, 0.002, 0.0005, 0.004, 0.00025, 0.008, 0.016, 0.032, 0.064};

/// The boundary as corners that know their neighbours.
class LinkedRings {
 public:
  explicit LinkedRings(const std::vector<GridRing>& rings, const std::vector<Touch>& touches) {
    std::vector<std::vector<GridPoint>> on_side;  // per side: corners of others that lie on it
    std::size_t count = 0;
    for (const GridRing& ring : rings) count += ring.size();
    on_side.resize(count);
    std::vector<GridPoint> corners;
    for (const GridRing& ring : rings) corners.insert(corners.end(), ring.begin(), ring.end());
    for (const Touch& touch : touches) on_side[touch.side].push_back(corners[touch.corner]);
    std::size_t side = 0;
    for (const GridRing& ring : rings) {
      const std::size_t first = corners_.size();
      for (std::size_t i = 0; i < ring.size(); ++i, ++side)
        add_side(ring[i], ring[(i + 1) % ring.size()], on_side[side]);
      link(first);
    }
  }

  /// At each place with several corners the boundary turns from every incoming side to the next outgoing one round the
  /// wedge of space between them.
  void relink() {
    std::map<GridPoint, std::vector<std::size_t>> places;
    for (std::size_t c = 0; c < corners_.size(); ++c) places[corners_[c].at].push_back(c);
    for (const auto& [at, here] : places) {
      if (here.size() < 2) continue;
      std::vector<std::size_t> before;  // of each corner here: the one to come from
      for (const std::size_t c : here) before.push_back(incoming(at, here, corners_[corners_[c].next].at));
      for (std::size_t k = 0; k < here.size(); ++k) {
        corners_[here[k]].previous = before[k];
        corners_[before[k]].next = here[k];
        corners_[here[k]].crowded = true;
      }
    }
  }

  /// The rings, with crowded corners moved this far into their wedges.
  std::vector<GridRing> rings(double distance) const {
    std::vector<GridRing> result;
    std::vector<char> seen(corners_.size(), 0);
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      if (seen[c]) continue;
      GridRing ring;
      for (std::size_t i = c; !seen[i]; i = corners_[i].next) {
        seen[i] = 1;
        ring.push_back(corners_[i].crowded ? moved(corners_[i], distance / kGrid) : corners_[i].at);
      }
      result.push_back(std::move(ring));
    }
    return result;
  }

 private:
  struct Corner {
    GridPoint at;
    std::size_t next = 0, previous = 0;
    bool crowded = false;
  };

  void add_side(const GridPoint& from, const GridPoint& to, std::vector<GridPoint>& between) {
    std::sort(between.begin(), between.end(),
              [&](const GridPoint& a, const GridPoint& b) { return dot(from, a, to) < dot(from, b, to); });
    between.erase(std::unique(between.begin(), between.end()), between.end());
    corners_.push_back({from});
    for (const GridPoint& p : between) {
      if (p != from && p != to) corners_.push_back({p});
    }
  }

  void link(std::size_t first) {
    const std::size_t count = corners_.size() - first;
    for (std::size_t i = 0; i < count; ++i) {
      corners_[first + i].next = first + (i + 1) % count;
      corners_[first + i].previous = first + (i + count - 1) % count;
    }
  }

  /// The beginning of the side that comes in at `at` first, counter-clockwise from the direction to `out`.
  std::size_t incoming(const GridPoint& at, const std::vector<std::size_t>& here, const GridPoint& out) const {
    // Counter-clockwise from `out`: less than half a turn first.
    const auto half = [&](const GridPoint& p) {
      const std::int64_t t = turn(at, out, p);
      return t > 0 || (t == 0 && dot(at, out, p) > 0) ? 0 : 1;
    };
    const auto sooner = [&](const GridPoint& a, const GridPoint& b) {
      return half(a) != half(b) ? half(a) < half(b) : turn(at, a, b) > 0;
    };
    std::size_t best = corners_[here[0]].previous;
    for (const std::size_t c : here) {
      if (sooner(corners_[corners_[c].previous].at, corners_[best].at)) best = corners_[c].previous;
    }
    return best;
  }

  /// Along the bisector of the wedge to the left of the boundary.
  GridPoint moved(const Corner& corner, double distance) const {
    const auto direction = [&](std::size_t c) {
      const GridPoint& p = corners_[c].at;
      return Vec2(static_cast<double>(p.x - corner.at.x), static_cast<double>(p.y - corner.at.y)).normalized();
    };
    const Vec2 out = direction(corner.next), in = direction(corner.previous);
    const double angle = std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in));
    const double half = (angle > 0 ? angle : angle + 2 * std::acos(-1.0)) / 2;
    const Vec2 into(out.x() * std::cos(half) - out.y() * std::sin(half),
                    out.x() * std::sin(half) + out.y() * std::cos(half));
    return {corner.at.x + std::llround(into.x() * distance), corner.at.y + std::llround(into.y() * distance)};
  }

  std::vector<Corner> corners_;
};

}  // namespace

std::vector<GridRing> drawn_apart(const std::vector<GridRing>& rings) {
  const std::vector<Touch> touches = touches_of(rings);
  if (touches.empty()) return rings;
  LinkedRings linked(rings, touches);
  linked.relink();
  for (const double distance : kDistances) {
    std::vector<GridRing> result = linked.rings(distance);
    const Meeting meeting = meeting_of(result);
    if (!meeting.crossing && !meeting.touching) return result;
  }
  throw Error(ErrorCode::internal_defect, "a footprint touches itself where there is no room to draw it apart",
              "footprint", "please report this with the map");
}

}  // namespace vantage::internal::city
