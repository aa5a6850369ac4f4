#include "query/leg_link.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "query/leg_halving.h"

namespace vantage::internal::query {
namespace {

constexpr double kShortest = 1e-3;       // metres
constexpr double kShortestShare = 1e-5;  // and of the leg
/// Where one object is in the way all along, a piece so short (of the leg) is not halved for the names of others.
constexpr double kNamedShare = 1.0 / 256;

/// LinkQuery lets touch what enters a zone by 1e-9 of its size: at its sides 2e-9 of the excess, at its ends 1e-9 of
/// its length. A zone that is longer by so much of both in all has all of it inside.
constexpr double kZoneTouch = 4e-9;

using Objects = std::vector<std::uint32_t>;

void make_set(Objects& objects) {
  std::sort(objects.begin(), objects.end());
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
}

/// Positions are about the antenna, A. A point b enters the zone of a vehicle at x where g(x) = |b| + |b - x| - |x| is
/// less than the excess e.
class LinkHalving {
 public:
  LinkHalving(const LinkQuery& link, const Vec3& origin, const Leg& leg, double radius, double slack)
      : link_(link),
        from_(leg.from - origin - link.antenna()),
        along_(leg.to - leg.from),
        length_(along_.norm()),
        radius_(radius),
        slack_(2 * slack + kZoneTouch * std::max(from_.norm(), (from_ + along_).norm())) {}

  std::vector<std::pair<std::uint32_t, LegInterval>> run() {
    halve({{0, 1}}, [&](const LegInterval& piece, bool is_last) { return look(piece, is_last); });
    return std::move(found_);
  }

 private:
  struct Piece {
    Vec3 begin, middle, end;
    double half;
  };

  /// Whether it is to be halved.
  bool look(const LegInterval& at, bool is_last) {
    const double share = 0.5 * (at.begin + at.end);
    const Piece piece = {position(at.begin), position(share), position(at.end), 0.5 * (at.end - at.begin) * length_};
    Objects maybe, sure;
    // From x to x + s the ways over b and straight on change by at most |s| each.
    const double loose = widened(2 * (piece.half + radius_));
    link_.for_each_polygon_entering(piece.middle, loose, [&](std::uint32_t polygon, const Vec3& point) {
      const double tight = widened(2 * radius_ + change(piece, link_.distance_m(polygon, piece.middle), loose));
      if (tight < loose && !link_.enters(polygon, piece.middle, tight)) return;
      maybe.push_back(link_.object_of(polygon));
      if (is_in_the_way(piece, polygon, point)) sure.push_back(maybe.back());
    });
    if (maybe.empty()) return false;
    make_set(maybe);
    make_set(sure);
    const bool is_short = 2 * piece.half <= std::min(kShortest, kShortestShare * length_);
    const bool is_named = !sure.empty() && at.end - at.begin <= kNamedShare;
    if (!is_last && !is_short && !is_named && sure != maybe) return true;
    for (const std::uint32_t object : maybe) found_.emplace_back(object, at);
    return false;
  }

  Vec3 position(double share) const { return from_ + share * along_; }
  double widened(double more) const { return more + slack_ + kZoneTouch * (link_.excess_m() + more); }

  /// How much less g may be on the piece than in its middle, m, for points of the zone there whose ways are longer by
  /// `loose`, at least `away` from m. To both sides |b - x| lies over its tangent, and |x| over it by s^2 / 2 |m| at
  /// most; their slopes differ as the directions from m to b and to A, which make an angle a with 1 - cos a <= E (E + 2
  /// |m|) / (2 |m| away), E = e + loose.
  double change(const Piece& piece, double away, double loose) const {
    const double distance = piece.middle.norm(), excess = link_.excess_m() + loose;
    const double slopes = std::sqrt(excess * (excess + 2 * distance) / (distance * away));
    const double change = piece.half * slopes + piece.half * piece.half / (2 * distance);
    return change < 2 * piece.half ? change : 2 * piece.half;  // also where it is no number
  }

  /// Whether the polygon is in the way all along the piece: the line of sight crosses it at both ends, or this point of
  /// it enters all zones. |b - x| lies below its chord, and |x| over its tangent in the middle, so g is largest at an
  /// end. What enters zones that are 2 `radius` longer counts for the tube.
  bool is_in_the_way(const Piece& piece, std::uint32_t polygon, const Vec3& point) const {
    const Vec3 outward = piece.middle.normalized();
    const auto longer = [&](const Vec3& x) { return point.norm() + (point - x).norm() - x.dot(outward); };
    if (std::max(longer(piece.begin), longer(piece.end)) < link_.excess_m() + 2 * radius_) return true;
    return link_.crosses(polygon, piece.begin) && link_.crosses(polygon, piece.end);
  }

  const LinkQuery& link_;
  Vec3 from_, along_;  // about the antenna
  double length_, radius_, slack_;
  std::vector<std::pair<std::uint32_t, LegInterval>> found_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, LegInterval>> link_parts(const LinkQuery& link, const Vec3& origin, const Leg& leg,
                                                              double radius, double slack) {
  return LinkHalving(link, origin, leg, radius, slack).run();
}

}  // namespace vantage::internal::query
