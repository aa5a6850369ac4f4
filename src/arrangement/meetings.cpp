// Two triangles meet where edges of one pass through the other (Moeller, A fast triangle-triangle intersection test,
// 1997), by signs of volumes alone, which are exact (Shewchuk 1997).
#include "arrangement/meetings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/orientation.h"
#include "core/parallel.h"
#include "core/walk_bvh.h"

namespace vantage::internal::arrangement {
namespace {

/// An end of a meeting, before crossings have numbers.
struct End {
  std::uint32_t edge, facet;
  std::uint32_t meeting;
  bool is_begin;

  std::uint64_t key() const { return std::uint64_t{edge} << 32 | facet; }
};

struct Found {
  std::uint32_t a, b;
  std::array<End, 2> ends;  // of which the first one is the begin
};

enum class Answer { no, yes, unknown };

class PairTest {
 public:
  explicit PairTest(const Soup& soup) : soup_(soup) {}

  /// Fills found().
  Answer meets(std::uint32_t a, std::uint32_t b);
  const Found& found() const { return found_; }

 private:
  using Signs = std::array<int, 3>;

  const Vec3& corner(const Facet& facet, std::size_t k) const { return soup_.points()[facet.corners[k]]; }
  int side(const Facet& plane, const Vec3& point) const {
    // Most corners are far from the plane: the normal is off, and the products and their sum are rounded.
    constexpr double kRounding = 0x1p-50, kUp = 1 + 0x1p-40;
    const Vec3 way = point - corner(plane, 0);
    const double height = plane.normal.dot(way);
    const double rounding =
        kUp * (plane.off_by * way.cwiseAbs().sum() + kRounding * plane.normal.cwiseAbs().dot(way.cwiseAbs()));
    if (height > rounding) return -1;
    if (height < -rounding) return 1;
    return core::orientation(corner(plane, 0), corner(plane, 1), corner(plane, 2), point);
  }
  Signs sides(const Facet& plane, const Facet& other) const {
    if (plane.is_flat) return {1, 1, 1};
    return {side(plane, corner(other, 0)), side(plane, corner(other, 1)), side(plane, corner(other, 2))};
  }
  Answer passes(const Vec3& from, const Vec3& to, const Facet& facet) const;
  bool add_edges(std::uint32_t of, std::uint32_t through, const Signs& signs, bool is_first);

  const Soup& soup_;
  Found found_{};
  int begins_ = 0, ends_ = 0;
};

/// Whether the line through two points on different sides of a facet's plane passes through the facet.
Answer PairTest::passes(const Vec3& from, const Vec3& to, const Facet& facet) const {
  int first = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int turn = core::orientation(from, to, corner(facet, k), corner(facet, (k + 1) % 3));
    if (turn == 0) return Answer::unknown;
    if (k == 0) first = turn;
    if (turn != first) return Answer::no;
  }
  return Answer::yes;
}

/// `signs`: 1 where a corner of `of` lies in the operand of the facet `through`. False where it is unknown.
bool PairTest::add_edges(std::uint32_t of, std::uint32_t through, const Signs& signs, bool is_first) {
  const Facet &facet = soup_.facets()[of], &other = soup_.facets()[through];
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = signs[k], to = signs[(k + 1) % 3];
    if (from == to) continue;
    // In the direction of the edge itself, so that its other facet gets the same answer.
    const Edge& edge = soup_.edges()[facet.edges[k]];
    const Answer answer = passes(soup_.points()[edge.from], soup_.points()[edge.to], other);
    if (answer == Answer::unknown) return false;
    if (answer == Answer::no) continue;
    // Where the border of a facet leaves the other operand the line between them begins, for one who stands on it.
    const bool leaves = from > 0, is_begin = leaves == is_first;
    int& count = is_begin ? begins_ : ends_;
    if (++count > 1) return false;
    found_.ends[is_begin ? 0 : 1] = {facet.edges[k], through, kNone, is_begin};
  }
  return true;
}

Answer PairTest::meets(std::uint32_t a, std::uint32_t b) {
  const Facet &one = soup_.facets()[a], &other = soup_.facets()[b];
  const auto all_are = [](const Signs& signs, int sign) {
    return signs[0] == sign && signs[1] == sign && signs[2] == sign;
  };
  const auto is_apart = [&](const Facet& plane, const Signs& signs) {
    return !plane.is_flat && (all_are(signs, 1) || all_are(signs, -1));
  };
  const auto touches = [](const Signs& signs) { return signs[0] == 0 || signs[1] == 0 || signs[2] == 0; };
  const Signs of_one = sides(other, one);
  if (is_apart(other, of_one)) return Answer::no;
  const Signs of_other = sides(one, other);
  if (is_apart(one, of_other)) return Answer::no;
  if (touches(of_one) || touches(of_other)) return Answer::unknown;
  begins_ = ends_ = 0;
  found_.a = a;
  found_.b = b;
  if (!add_edges(a, b, of_one, true) || !add_edges(b, a, of_other, false) || begins_ != ends_) return Answer::unknown;
  return begins_ == 1 ? Answer::yes : Answer::no;
}

/// What may meet a facet.
class NearFacet {
 public:
  NearFacet(const Soup& soup, const Facet& facet) : facet_(facet), corner_(soup.points()[facet.corners[0]]) {
    constexpr double kRounding = 0x1p-49;  // of the middle of a box, too
    for (const std::uint32_t corner : facet.corners) box_.extend(soup.points()[corner]);
    rounding_ = kRounding * soup.largest() * facet.normal.cwiseAbs().sum();
  }

  /// Thin facets that lead outwards from one place have boxes that overlap all others.
  bool may_meet(const core::Bounds& bounds) const {
    const Vec3 least(bounds.min[0], bounds.min[1], bounds.min[2]), most(bounds.max[0], bounds.max[1], bounds.max[2]);
    if (!overlaps(least, most)) return false;
    if (facet_.is_flat) return true;
    const Vec3 half = (most - least) / 2, way = (most + least) / 2 - corner_;
    const double reach = facet_.normal.cwiseAbs().dot(half) + facet_.off_by * (way.cwiseAbs() + half).sum();
    return std::abs(facet_.normal.dot(way)) <= (1 + 0x1p-40) * (reach + rounding_);
  }
  bool overlaps(const Vec3& least, const Vec3& most) const {
    return (least.array() <= box_.max.array()).all() && (most.array() >= box_.min.array()).all();
  }

 private:
  const Facet& facet_;
  Vec3 corner_;
  Box box_;
  double rounding_ = 0;
};

/// All pairs, by the first facet. False where one is unknown; the others are found, and counted, all the same: so what
/// is counted does not depend on threads.
bool find_pairs(const Soup& soup, const core::ProgressReporter& progress, std::vector<Found>& all) {
  constexpr std::size_t kGrain = 256;
  const std::size_t count = soup.facets().size();
  std::vector<std::vector<Found>> parts(count / kGrain + 1);
  std::atomic<bool> is_known = true;
  parallel::for_ranges(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    PairTest test(soup);
    for (std::size_t part = begin; part < end; ++part) {
      std::vector<Found>& found = parts[part];
      for (std::size_t f = part * kGrain; f < std::min(count, (part + 1) * kGrain); ++f) {
        progress.check();
        const auto a = static_cast<std::uint32_t>(f);
        const NearFacet near(soup, soup.facets()[a]);
        const auto overlaps_facet = [&](std::uint32_t b) {
          const auto& [p, q, r] = soup.facets()[b].corners;
          const Vec3 &x = soup.points()[p], &y = soup.points()[q], &z = soup.points()[r];
          return near.overlaps(x.cwiseMin(y).cwiseMin(z), x.cwiseMax(y).cwiseMax(z));
        };
        const auto may_meet = [&](const core::BvhNode& node) { return near.may_meet(node.bounds); };
        const auto first = static_cast<std::ptrdiff_t>(found.size());
        core::walk_bvh(soup.bvh(), may_meet, [&](std::uint32_t item) {
          const std::uint32_t b = soup.order()[item];
          if (b <= a || soup.facets()[b].mesh == soup.facets()[a].mesh || !overlaps_facet(b)) return;
          const Answer answer = test.meets(a, b);
          if (answer == Answer::yes) found.push_back(test.found());
          if (answer == Answer::unknown) is_known = false;
        });
        std::sort(found.begin() + first, found.end(), [](const Found& x, const Found& y) { return x.b < y.b; });
        progress.spend(static_cast<double>(found.size() - static_cast<std::size_t>(first)));
      }
    }
  });
  for (const std::vector<Found>& found : parts) all.insert(all.end(), found.begin(), found.end());
  return is_known;
}

/// A place that is farther off than this part of the largest coordinate is none: about what booleans are off by.
constexpr double kFarthestOff = 0x1p-40;

/// False where rounding would decide where it is.
bool place_crossing(const Soup& soup, Crossing& crossing) {
  const Edge& edge = soup.edges()[crossing.edge];
  crossing.from = soup.height(crossing.facet, edge.from);
  crossing.to = soup.height(crossing.facet, edge.to);
  if (crossing.from.sign() * crossing.to.sign() != -1) return false;
  const double height = crossing.from.size() + crossing.to.size();
  crossing.along = crossing.from.size() / height;
  const Vec3 &from = soup.points()[edge.from], &to = soup.points()[edge.to];
  crossing.place = crossing.along <= 0.5 ? Vec3(from + crossing.along * (to - from))
                                         : Vec3(to + crossing.to.size() / height * (from - to));
  // Heights beyond a needle of a facet, which has hardly any normal, have lost digits.
  constexpr double kRounding = 0x1p-50;
  crossing.along_off_by = kRounding + 2 * (crossing.from.error + crossing.to.error) / height;
  crossing.off_by_m = kPlaceRounding * soup.largest() + crossing.along_off_by * (to - from).cwiseAbs().maxCoeff();
  return crossing.off_by_m <= kFarthestOff * soup.largest();
}

}  // namespace

std::optional<Meetings> find_meetings(const Soup& soup, const core::ProgressReporter& progress) {
  std::vector<Found> found;
  if (!find_pairs(soup, progress, found)) return std::nullopt;
  Meetings result;
  std::vector<End> ends;
  for (const Found& pair : found) {
    for (const End& end : pair.ends) {
      ends.push_back(end);
      ends.back().meeting = static_cast<std::uint32_t>(result.meetings.size());
    }
    result.meetings.push_back({pair.a, pair.b, {kNone, kNone}});
  }
  parallel::sort(
      ends, [](const End& x, const End& y) { return std::pair(x.key(), x.meeting) < std::pair(y.key(), y.meeting); },
      progress);
  // Both facets of an edge that passes through a facet meet it there.
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    if (i + 1 == ends.size() || ends[i].key() != ends[i + 1].key()) return std::nullopt;
    const auto number = static_cast<std::uint32_t>(result.crossings.size());
    Crossing& crossing = result.crossings.emplace_back();
    crossing.edge = ends[i].edge;
    crossing.facet = ends[i].facet;
    const Edge& edge = soup.edges()[crossing.edge];
    for (std::size_t k = 0; k < 2; ++k) {
      const End& end = ends[i + k];
      Meeting& meeting = result.meetings[end.meeting];
      meeting.ends[end.is_begin ? 0 : 1] = number;
      const std::uint32_t of_edge = meeting.a == crossing.facet ? meeting.b : meeting.a;
      const std::size_t which = edge.facets[0] == of_edge ? 0 : 1;
      if (edge.facets[which] != of_edge || crossing.meetings[which] != kNone) return std::nullopt;
      crossing.meetings[which] = end.meeting;
      crossing.is_begin[which] = end.is_begin;
    }
  }
  std::atomic<bool> is_known = true;
  constexpr std::size_t kGrain = 1024;
  parallel::for_ranges(result.crossings.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!place_crossing(soup, result.crossings[i])) is_known = false;
    }
  });
  if (!is_known) return std::nullopt;
  return result;
}

}  // namespace vantage::internal::arrangement
