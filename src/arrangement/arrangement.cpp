#include "arrangement/arrangement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "arrangement/levels.h"
#include "arrangement/lines.h"
#include "arrangement/meetings.h"
#include "arrangement/subdivision.h"

namespace vantage::internal::arrangement {
namespace {

constexpr int kAttempts = 3;
/// Operands move by some hundred times what their coordinates are rounded by.
constexpr double kStep = 0x1p-44;
/// Where a corner is, between operands as they were given, is at most so many of these away from where it was found.
constexpr double kFarthestBack = 8;

/// Where nodes are, of the operands as they were given: so nothing leaves their bounds. Only where a plane is passed at
/// so small an angle that the moves count is the place the one between operands that were moved. In the plane of a
/// facet across an axis it lies exactly.
class Places {
 public:
  Places(const Soup& soup, const Meetings& meetings, const Lines& lines, double step)
      : soup_(soup), meetings_(meetings), lines_(lines), step_(step) {}

  Vec3 of(std::uint32_t node) const {
    const std::size_t points = soup_.points().size(), crossings = meetings_.crossings.size();
    if (node < points) return soup_.given()[node];
    if (node < points + crossings) return of_crossing(static_cast<std::uint32_t>(node - points));
    const TriplePoint& triple = lines_.triples[node - points - crossings];
    const Meeting& meeting = meetings_.meetings[triple.meetings[0]];
    return passing(of_crossing(meeting.ends[0]), of_crossing(meeting.ends[1]), triple.facets[2], triple.along);
  }

 private:
  static Vec3 between(const Vec3& from, const Vec3& to, double along) {
    const Vec3 place = along <= 0.5 ? Vec3(from + along * (to - from)) : Vec3(to + (1 - along) * (from - to));
    return place.cwiseMax(from.cwiseMin(to)).cwiseMin(from.cwiseMax(to));
  }
  Vec3 of_crossing(std::uint32_t crossing) const {
    const Edge& edge = soup_.edges()[meetings_.crossings[crossing].edge];
    return passing(soup_.given()[edge.from], soup_.given()[edge.to], meetings_.crossings[crossing].facet,
                   meetings_.crossings[crossing].along);
  }
  /// Where the way between two places passes through a facet's plane. `along`: where it does between operands that were
  /// moved. Along a plane these two are far apart, and the second one is as near to the plane.
  Vec3 passing(const Vec3& from, const Vec3& to, std::uint32_t facet, double along) const {
    const auto& [a, b, c] = soup_.facets()[facet].corners;
    const Vec3& corner = soup_.given()[a];
    const core::BoundedVec3 normal = core::cross(core::bounded_difference(soup_.given()[b], corner),
                                                 core::bounded_difference(soup_.given()[c], corner));
    const core::Bounded of_from = core::dot(normal, core::bounded_difference(from, corner)),
                        of_to = core::dot(normal, core::bounded_difference(to, corner)), height = of_from - of_to;
    const double length = (to - from).cwiseAbs().maxCoeff(), farthest = kFarthestBack * step_;
    if (height.size() > 0 && (of_from.error + height.error) * length <= step_ * height.size()) {
      const double given = std::clamp(of_from.near() / height.near(), 0.0, 1.0);
      if (std::abs(given - along) * length <= farthest) along = given;
    }
    Vec3 place = between(from, to, along);
    for (int axis = 0; axis < 3; ++axis) {
      const double level = corner[axis];
      if (soup_.given()[b][axis] == level && soup_.given()[c][axis] == level) place[axis] = level;
    }
    return place;
  }

  const Soup& soup_;
  const Meetings& meetings_;
  const Lines& lines_;
  double step_;
};

/// What bounds the points that weigh enough, and its corners.
class Border {
 public:
  Border(const Soup& soup, const Subdivision& subdivision, const std::vector<std::uint64_t>& levels,
         std::span<const Operand> operands, std::uint64_t least);

  /// nullopt where a ring has fewer than three corners.
  std::optional<Surface> surface(const Meetings& meetings, const Lines& lines, double step) const;

 private:
  bool is_border(std::uint32_t half) const {
    return is_kept_[half] && !(subdivision_.is_of_meeting(half) && is_kept_[subdivision_.twin(half)]);
  }
  std::uint32_t next(std::uint32_t half) const;
  void find_corners();

  const Soup& soup_;
  const Subdivision& subdivision_;
  std::vector<char> is_kept_;             // per half-edge: what lies to its left
  std::vector<std::uint32_t> corner_of_;  // per node: a line of the border through it, or one of the two below
  static constexpr std::uint32_t kNoBorder = kNone, kCorner = kNone - 1;
};

Border::Border(const Soup& soup, const Subdivision& subdivision, const std::vector<std::uint64_t>& levels,
               std::span<const Operand> operands, std::uint64_t least)
    : soup_(soup), subdivision_(subdivision), is_kept_(subdivision.size()) {
  for (std::uint32_t half = 0; half < is_kept_.size(); ++half) {
    const std::uint64_t own = operands[soup.facets()[subdivision.facet(half)].mesh].weight;
    is_kept_[half] = levels[half] < least && levels[half] + own >= least;
  }
  find_corners();
}

/// Where the border comes to a node and goes on straight there is no corner, on any facet.
void Border::find_corners() {
  corner_of_.assign(subdivision_.nodes(), kNoBorder);
  for (std::uint32_t half = 0; half < is_kept_.size(); ++half) {
    if (!is_border(half)) continue;
    // Each piece of the border has two half-edges in it, one in each direction: heads are all of its ends.
    std::uint32_t& corner = corner_of_[subdivision_.head(half)];
    const std::uint32_t line = subdivision_.line(half);
    corner = corner == kNoBorder || corner == line ? line : kCorner;
  }
  for (std::uint32_t node = 0; node < soup_.points().size(); ++node) {
    if (corner_of_[node] != kNoBorder) corner_of_[node] = kCorner;
  }
}

/// The next half-edge of the border round the same part.
std::uint32_t Border::next(std::uint32_t half) const {
  std::uint32_t next = subdivision_.next(half);
  while (!is_border(next)) next = subdivision_.next(subdivision_.twin(next));
  return next;
}

std::optional<Surface> Border::surface(const Meetings& meetings, const Lines& lines, double step) const {
  Surface surface;
  const Places places(soup_, meetings, lines, step);
  std::vector<std::uint32_t> number(subdivision_.nodes(), kNone);  // of a node's point
  struct Ring {
    std::uint32_t facet, begin;
  };
  std::vector<Ring> rings;
  std::vector<char> is_done(subdivision_.size(), 0);
  for (std::uint32_t begin = 0; begin < is_done.size(); ++begin) {
    if (is_done[begin] || !is_border(begin)) continue;
    rings.push_back({subdivision_.facet(begin), begin});
    for (std::uint32_t half = begin; !is_done[half]; half = next(half)) is_done[half] = 1;
  }
  std::stable_sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) { return a.facet < b.facet; });
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (i == 0 || rings[i].facet != rings[i - 1].facet) {
      const Facet& facet = soup_.facets()[rings[i].facet];
      surface.parts.push_back({facet.mesh, facet.given, facet.normal, static_cast<std::uint32_t>(i), 0});
    }
    ++surface.parts.back().rings;
    std::vector<std::uint32_t>& ring = surface.rings.emplace_back();
    std::uint32_t half = rings[i].begin;
    do {
      const std::uint32_t node = subdivision_.head(half);
      if (corner_of_[node] == kCorner) {
        if (number[node] == kNone) {
          number[node] = static_cast<std::uint32_t>(surface.points.size());
          surface.points.push_back(places.of(node));
        }
        ring.push_back(number[node]);
      }
      half = next(half);
    } while (half != rings[i].begin);
    if (ring.size() < 3) return std::nullopt;
  }
  return surface;
}

std::optional<Surface> attempt(const Soup& soup, std::span<const Operand> operands, std::uint64_t least, double step,
                               const core::ProgressReporter& progress) {
  progress.report(0.1);
  const auto meetings = find_meetings(soup, progress);
  if (!meetings) return std::nullopt;
  progress.report(0.4);
  const auto lines = find_lines(soup, *meetings, progress);
  if (!lines) return std::nullopt;
  progress.report(0.7);
  const auto subdivision = Subdivision::of(soup, *meetings, *lines);
  if (!subdivision) return std::nullopt;
  progress.report(0.8);
  const auto levels = find_levels(soup, *subdivision, operands);
  if (!levels) return std::nullopt;
  progress.report(0.9);
  auto surface = Border(soup, *subdivision, *levels, operands, least).surface(*meetings, *lines, step);
  if (!surface) return std::nullopt;
  double off_by = kPlaceRounding * soup.largest();
  for (const Crossing& crossing : meetings->crossings) off_by = std::max(off_by, crossing.off_by_m);
  surface->epsilon_m = (2 * kFarthestBack + 4) * step + 4 * off_by;
  return surface;
}

}  // namespace

std::optional<Surface> weighing_at_least(std::span<const Operand> operands, std::uint64_t least,
                                         const core::ProgressReporter& progress) {
  double largest = 0, facets = 0;
  for (const Operand& operand : operands) {
    facets += static_cast<double>(operand.mesh->triangles.size());
    for (const Vec3& vertex : operand.mesh->vertices) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  }
  progress.spend(facets);
  double step = kStep * largest;
  for (std::uint32_t seed = 1; seed <= kAttempts; ++seed, step *= 4) {
    const auto soup = Soup::of(operands, step, seed);
    if (!soup) return std::nullopt;
    if (auto surface = attempt(*soup, operands, least, step, progress)) return surface;
  }
  return std::nullopt;
}

}  // namespace vantage::internal::arrangement
