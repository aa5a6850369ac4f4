// Heights beyond a plane of points that have no coordinates, only what makes them: the crossing of an edge u v and a
// facet T is (h_T(u) v - h_T(v) u) / (h_T(u) - h_T(v)), so that its height beyond another facet is a determinant of
// four heights of corners. A rounded value with a bound decides first, 106 digits with a bound where it cannot.
#include "arrangement/lines.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"

namespace vantage::internal::arrangement {
namespace {

/// The heights of both ends of a meeting beyond a facet, and the part of the meeting where the facet's plane is.
struct Passing {
  double begin = 0, end = 0;     // metres times twice the facet's area
  double error = 0;              // of each of the two
  double along = 0, off_by = 0;  // the part, and what that may be off by

  bool is_through() const { return std::abs(begin) > error && std::abs(end) > error && (begin > 0) != (end > 0); }
  bool is_beside() const { return std::abs(begin) > error && std::abs(end) > error && (begin > 0) == (end > 0); }
};

class Geometry {
 public:
  Geometry(const Soup& soup, const Meetings& meetings) : soup_(soup), meetings_(meetings) {}

  const Meeting& meeting(std::uint32_t m) const { return meetings_.meetings[m]; }
  const Crossing& end(std::uint32_t m, std::size_t which) const {
    return meetings_.crossings[meetings_.meetings[m].ends[which]];
  }

  /// What the places of a meeting's ends are off by.
  double off_by(std::uint32_t m) const { return std::max(end(m, 0).off_by_m, end(m, 1).off_by_m); }

  /// The crossing's height beyond a facet, times the sum of its edge's heights beyond the crossing's own facet.
  core::Bounded height(const Crossing& crossing, std::uint32_t facet) const {
    const Edge& edge = soup_.edges()[crossing.edge];
    const core::Bounded from = soup_.height(facet, edge.from), to = soup_.height(facet, edge.to);
    const core::Bounded value = to * crossing.from - from * crossing.to;
    return crossing.from.sign() > 0 ? value : -value;
  }

  /// `is_known`: becomes false where it is not certain whether the meeting passes through the plane.
  Passing passing(std::uint32_t m, std::uint32_t facet, bool& is_known) const;

  /// Whether the meeting passes through the first one of two planes before it does through the other. Both pass.
  bool is_before(std::uint32_t m, std::uint32_t first, std::uint32_t second, bool& is_known) const;

 private:
  Passing rounded(std::uint32_t m, std::uint32_t facet) const;

  const Soup& soup_;
  const Meetings& meetings_;
};

void place(Passing& passing) {
  const double height = std::abs(passing.begin) + std::abs(passing.end);
  constexpr double kRounding = 0x1p-50;
  passing.along = std::abs(passing.begin) / height;
  passing.off_by = 2 * passing.error / height + kRounding;
}

Passing Geometry::rounded(std::uint32_t m, std::uint32_t facet) const {
  const Facet& plane = soup_.facets()[facet];
  const Vec3& corner = soup_.points()[plane.corners[0]];
  Passing passing;
  passing.begin = plane.normal.dot(end(m, 0).place - corner);
  passing.end = plane.normal.dot(end(m, 1).place - corner);
  // No coordinate of a place is farther from one of the corner than twice the largest one.
  passing.error = 4 * off_by(m) * plane.normal.cwiseAbs().sum() + 8 * plane.off_by * soup_.largest();
  return passing;
}

Passing Geometry::passing(std::uint32_t m, std::uint32_t facet, bool& is_known) const {
  Passing quick = rounded(m, facet);
  if (quick.is_beside()) return quick;
  if (quick.is_through()) {
    place(quick);
    const double length = (end(m, 1).place - end(m, 0).place).cwiseAbs().maxCoeff();
    if (quick.off_by * length <= 4 * off_by(m)) return quick;
  }
  const core::Bounded begin = height(end(m, 0), facet), end_height = height(end(m, 1), facet);
  if (begin.sign() == 0 || end_height.sign() == 0) {
    is_known = false;
    return quick;
  }
  Passing exact;
  const auto of_crossing = [](const Crossing& crossing) { return crossing.from.size() + crossing.to.size(); };
  const double of_begin = of_crossing(end(m, 0)), of_end = of_crossing(end(m, 1));
  exact.begin = begin.near() / of_begin;
  exact.end = end_height.near() / of_end;
  constexpr double kRounding = 0x1p-48;
  const double divided = kRounding + 2 * std::max(end(m, 0).along_off_by, end(m, 1).along_off_by);
  const double error = std::max(begin.error / of_begin, end_height.error / of_end) +
                       divided * std::max(std::abs(exact.begin), std::abs(exact.end));
  // The signs are certain, whatever the bound says.
  exact.error = std::min({error, std::abs(exact.begin) / 2, std::abs(exact.end) / 2});
  if ((exact.begin > 0) != (exact.end > 0)) place(exact);
  exact.off_by = std::max(exact.off_by, 2 * error / (std::abs(exact.begin) + std::abs(exact.end)));
  return exact;
}

bool Geometry::is_before(std::uint32_t m, std::uint32_t first, std::uint32_t second, bool& is_known) const {
  const core::Bounded begin_1 = height(end(m, 0), first), end_1 = height(end(m, 1), first),
                      begin_2 = height(end(m, 0), second), end_2 = height(end(m, 1), second);
  // What crossings are multiplied by is the same on both sides.
  const core::Bounded difference = begin_1 * end_2 - begin_2 * end_1;
  const int sign = difference.sign() * begin_1.sign() * begin_2.sign();
  if (sign == 0) is_known = false;
  return sign > 0;
}

/// Of the triple points on a meeting.
struct OnMeeting {
  std::uint32_t triple, third;  // the facet besides the two of the meeting
  double along, off_by;
};

/// A box that holds a meeting, grown by rounding.
struct MeetingBox {
  Vec3 min, max;
  std::uint32_t meeting;
};

class TripleFinder {
 public:
  TripleFinder(const Soup& soup, const Meetings& meetings)
      : soup_(soup), meetings_(meetings), geometry_(soup, meetings), first_of_(soup.facets().size() + 1, 0) {
    for (const Meeting& meeting : meetings.meetings) ++first_of_[meeting.a + 1];
    for (std::size_t f = 0; f + 1 < first_of_.size(); ++f) first_of_[f + 1] += first_of_[f];
  }

  /// Those whose first facet is `a`. False where it is unknown.
  bool find(std::uint32_t a, const core::ProgressReporter& progress, std::vector<TriplePoint>& found) const;

  std::uint32_t meeting_of(std::uint32_t a, std::uint32_t b) const;

 private:
  bool test(std::uint32_t of_b, std::uint32_t of_c, std::vector<TriplePoint>& found) const;

  const Soup& soup_;
  const Meetings& meetings_;
  Geometry geometry_;
  std::vector<std::uint32_t> first_of_;  // per facet: its first meeting with a later one
};

std::uint32_t TripleFinder::meeting_of(std::uint32_t a, std::uint32_t b) const {
  const auto begin = meetings_.meetings.begin() + first_of_[a], end = meetings_.meetings.begin() + first_of_[a + 1];
  const auto found =
      std::lower_bound(begin, end, b, [](const Meeting& meeting, std::uint32_t facet) { return meeting.b < facet; });
  if (found == end || found->b != b) return kNone;
  return static_cast<std::uint32_t>(found - meetings_.meetings.begin());
}

bool TripleFinder::test(std::uint32_t of_b, std::uint32_t of_c, std::vector<TriplePoint>& found) const {
  const std::uint32_t a = meetings_.meetings[of_b].a, b = meetings_.meetings[of_b].b, c = meetings_.meetings[of_c].b;
  const auto is_flat = [&](std::uint32_t facet) { return soup_.facets()[facet].is_flat; };
  if (is_flat(a) || is_flat(b) || is_flat(c)) return true;  // their meetings are points
  bool is_known = true;
  const Passing of_c_through_b = geometry_.passing(of_c, b, is_known);
  if (!is_known) return false;
  if (!of_c_through_b.is_through()) return true;
  const Passing of_b_through_c = geometry_.passing(of_b, c, is_known);
  if (!is_known) return false;
  if (!of_b_through_c.is_through()) return true;
  const std::uint32_t of_b_and_c = meeting_of(b, c);
  if (of_b_and_c == kNone) return false;
  // On a, the meeting with c runs along n_a x n_c: it leaves b's operand where n_b . (n_a x n_c) > 0.
  found.push_back({{a, b, c}, {of_b, of_c, of_b_and_c}, of_c_through_b.begin > 0, of_b_through_c.along});
  return true;
}

bool TripleFinder::find(std::uint32_t a, const core::ProgressReporter& progress,
                        std::vector<TriplePoint>& found) const {
  const std::uint32_t first = first_of_[a], last = first_of_[a + 1];
  if (last - first < 2) return true;
  std::vector<MeetingBox> boxes;
  Box all;
  for (std::uint32_t m = first; m < last; ++m) {
    const Vec3 &begin = geometry_.end(m, 0).place, &end = geometry_.end(m, 1).place;
    const Vec3 rounding = Vec3::Constant(4 * geometry_.off_by(m));
    boxes.push_back({begin.cwiseMin(end) - rounding, begin.cwiseMax(end) + rounding, m});
    all.extend(begin);
    all.extend(end);
  }
  Eigen::Index axis = 0;
  (all.max - all.min).maxCoeff(&axis);
  std::sort(boxes.begin(), boxes.end(), [&](const MeetingBox& x, const MeetingBox& y) {
    return std::pair(x.min[axis], x.meeting) < std::pair(y.min[axis], y.meeting);
  });
  const auto mesh_of = [&](std::uint32_t m) { return soup_.facets()[meetings_.meetings[m].b].mesh; };
  const auto before = found.size();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    progress.tick();
    for (std::size_t k = i + 1; k < boxes.size() && boxes[k].min[axis] <= boxes[i].max[axis]; ++k) {
      progress.tick();
      if ((boxes[k].min.array() > boxes[i].max.array()).any() || (boxes[k].max.array() < boxes[i].min.array()).any()) {
        continue;
      }
      if (mesh_of(boxes[i].meeting) == mesh_of(boxes[k].meeting)) continue;
      if (!test(std::min(boxes[i].meeting, boxes[k].meeting), std::max(boxes[i].meeting, boxes[k].meeting), found)) {
        return false;
      }
    }
  }
  progress.spend(static_cast<double>(found.size() - before));
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(),
            [](const TriplePoint& x, const TriplePoint& y) { return x.facets < y.facets; });
  return true;
}

bool find_triples(const Soup& soup, const TripleFinder& finder, const core::ProgressReporter& progress,
                  std::vector<TriplePoint>& all) {
  constexpr std::size_t kGrain = 256;
  const std::size_t count = soup.facets().size();
  std::vector<std::vector<TriplePoint>> parts(count / kGrain + 1);
  std::atomic<bool> is_known = true;
  parallel::for_ranges(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      for (std::size_t f = part * kGrain; f < std::min(count, (part + 1) * kGrain); ++f) {
        if (!finder.find(static_cast<std::uint32_t>(f), progress, parts[part])) is_known = false;
      }
    }
  });
  for (const std::vector<TriplePoint>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return is_known;
}

/// Sorts what lies on one line: by a rounded number, and where its bound does not tell by `is_before`.
template <typename Item, typename IsBefore>
void sort_along(std::span<Item> items, const IsBefore& is_before) {
  std::sort(items.begin(), items.end(), [](const Item& x, const Item& y) { return x.along < y.along; });
  for (std::size_t i = 1; i < items.size(); ++i) {
    for (std::size_t k = i; k > 0; --k) {
      const Item &x = items[k - 1], &y = items[k];
      if (y.along - x.along > x.off_by + y.off_by || is_before(x, y)) break;
      std::swap(items[k - 1], items[k]);
    }
  }
}

/// The triple points on each meeting. False where their order is unknown.
bool order_on_meetings(const std::vector<TriplePoint>& triples, const Geometry& geometry, Lists& on_meetings,
                       std::size_t meetings) {
  std::atomic<bool> all_known = true;
  constexpr std::size_t kGrain = 256;
  parallel::for_ranges(meetings, kGrain, [&](std::size_t first, std::size_t last) {
    std::vector<OnMeeting> items;
    for (std::size_t m = first; m < last; ++m) {
      const std::span<std::uint32_t> list = on_meetings[m];
      if (list.size() < 2) continue;
      items.clear();
      bool is_known = true;
      const auto meeting = static_cast<std::uint32_t>(m);
      for (const std::uint32_t t : list) {
        const TriplePoint& triple = triples[t];
        const std::uint32_t third = triple.facets[triple.meetings[0] == m ? 2 : triple.meetings[1] == m ? 1 : 0];
        const Passing passing = geometry.passing(meeting, third, is_known);
        if (!passing.is_through()) is_known = false;
        items.push_back({t, third, passing.along, passing.off_by});
      }
      sort_along<OnMeeting>(items, [&](const OnMeeting& x, const OnMeeting& y) {
        return geometry.is_before(meeting, x.third, y.third, is_known);
      });
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = items[i].triple;
      if (!is_known) all_known = false;
    }
  });
  return all_known;
}

/// The crossings on each edge. False where their order is unknown.
bool order_on_edges(const Meetings& meetings, Lists& on_edges, std::size_t edges) {
  struct OnEdge {
    std::uint32_t crossing;
    double along, off_by;
  };
  std::atomic<bool> all_known = true;
  constexpr std::size_t kGrain = 1024;
  parallel::for_ranges(edges, kGrain, [&](std::size_t first, std::size_t last) {
    std::vector<OnEdge> items;
    for (std::size_t e = first; e < last; ++e) {
      const std::span<std::uint32_t> list = on_edges[e];
      if (list.size() < 2) continue;
      items.clear();
      bool is_known = true;
      for (const std::uint32_t c : list) {
        items.push_back({c, meetings.crossings[c].along, meetings.crossings[c].along_off_by});
      }
      sort_along<OnEdge>(items, [&](const OnEdge& x, const OnEdge& y) {
        const Crossing &one = meetings.crossings[x.crossing], &other = meetings.crossings[y.crossing];
        const core::Bounded difference = one.from * other.to - other.from * one.to;
        const int sign = difference.sign() * one.from.sign() * other.from.sign();
        if (sign == 0) is_known = false;
        return sign > 0;
      });
      for (std::size_t i = 0; i < list.size(); ++i) list[i] = items[i].crossing;
      if (!is_known) all_known = false;
    }
  });
  return all_known;
}

}  // namespace

Lists::Lists(std::size_t lists, std::span<const std::pair<std::uint32_t, std::uint32_t>> pairs)
    : first_(lists + 1, 0), items_(pairs.size()) {
  for (const auto& pair : pairs) ++first_[pair.first + 1];
  for (std::size_t i = 0; i < lists; ++i) first_[i + 1] += first_[i];
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [list, item] : pairs) items_[next[list]++] = item;
}

std::optional<Lines> find_lines(const Soup& soup, const Meetings& meetings, const core::ProgressReporter& progress) {
  std::vector<TriplePoint> triples;
  if (!find_triples(soup, TripleFinder(soup, meetings), progress, triples)) return std::nullopt;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_edge, on_meeting;
  for (std::uint32_t c = 0; c < meetings.crossings.size(); ++c) on_edge.emplace_back(meetings.crossings[c].edge, c);
  for (std::uint32_t t = 0; t < triples.size(); ++t) {
    for (const std::uint32_t m : triples[t].meetings) on_meeting.emplace_back(m, t);
  }
  Lines lines{std::move(triples), Lists(soup.edges().size(), on_edge), Lists(meetings.meetings.size(), on_meeting)};
  const Geometry geometry(soup, meetings);
  if (!order_on_edges(meetings, lines.on_edges, soup.edges().size()) ||
      !order_on_meetings(lines.triples, geometry, lines.on_meetings, meetings.meetings.size())) {
    return std::nullopt;
  }
  return lines;
}

}  // namespace vantage::internal::arrangement
