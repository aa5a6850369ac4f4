#include "prove/limited_volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "core/format.h"
#include "core/parallel.h"
#include "prove/convex_polygon.h"
#include "prove/distance.h"
#include "prove/winding.h"

namespace vantage::internal::prove {
namespace {

/// Roundings of the largest coordinate: a position about the origin has one, and distances to planes have a few more.
constexpr double kUnsureRoundings = 16;

std::string place_text(const Vec3& place) {
  return core::format("{:.9g}, {:.9g}, {:.9g}", place.x(), place.y(), place.z());
}

}  // namespace

LimitedVolume::LimitedVolume(const Mesh& solid, const Vec3& origin, double shrink, double rounding_m, double cuts_m)
    : solid_(solid), origin_(origin), shrink_(shrink), rounding_m_(rounding_m), cuts_m_(cuts_m) {
  std::vector<bool> is_used(solid.vertices.size(), false);
  double reach = 0;
  facets_.reserve(solid.triangles.size());
  for (const Triangle& t : solid.triangles) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = solid.vertices[t[k]] - origin;
      if (is_used[t[k]]) continue;
      is_used[t[k]] = true;
      vertices_.push_back(corners[k]);
      box_.extend(corners[k]);
      reach = std::max(reach, corners[k].cwiseAbs().maxCoeff());
    }
    facets_.push_back(corners);
  }
  closed_ = facets_;
  unsure_m_ = unsure_of(reach);
  least_m_ = rounding_m + cuts_m + unsure_of(0);
  for (const Corners& facet : facets_) most_m_ = std::max(most_m_, tolerance_of(facet));
}

double LimitedVolume::unsure_of(double reach_m) const {
  return kUnsureRoundings * std::numeric_limits<double>::epsilon() * (origin_.cwiseAbs().maxCoeff() + reach_m);
}

double LimitedVolume::tolerance_of(const Corners& facet) const {
  double reach = 0;
  for (const Vec3& corner : facet) reach = std::max(reach, corner.cwiseAbs().maxCoeff());
  return rounding_m_ + cuts_m_ + shrink_ * distance_from(Vec3::Zero(), facet) + unsure_of(reach);
}

LimitedVolume LimitedVolume::in_front_of(const Vec3& point, const Vec3& normal) const {
  LimitedVolume front = *this;
  front.vertices_.clear();
  front.facets_.clear();
  const HalfSpace half{-normal, -normal.dot(point)};
  for (const Corners& facet : facets_) {
    const ConvexPolygon part = cut({facet.begin(), facet.end()}, half).inside;
    for (std::size_t k = 2; k < part.size(); ++k) front.facets_.push_back({part[0], part[k - 1], part[k]});
    front.vertices_.insert(front.vertices_.end(), part.begin(), part.end());
  }
  return front;
}

std::optional<bool> LimitedVolume::is_outside(const Vec3& point) const {
  if ((point.array() < box_.min.array()).any() || (point.array() > box_.max.array()).any()) return true;
  Winding winding(point, box_);
  for (const Corners& facet : closed_) winding.add(facet);
  const std::optional<int> turns = winding.turns(unsure_m_);
  return turns ? std::optional(*turns == 0) : std::nullopt;
}

bool LimitedVolume::is_there(const Vec3& point, double within_m) const {
  constexpr double kNarrower = 8;
  const double first = std::min(within_m, std::numeric_limits<double>::max());  // what is infinite stays so
  for (double step = first; step > 4 * unsure_m_; step /= kNarrower) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const Vec3 way(x, y, z);
          const Vec3 at = point + step / std::max(way.norm(), 1.0) * way;
          if (!is_outside(at).value_or(true)) return true;
        }
      }
    }
  }
  return false;
}

std::vector<FacetFinding> LimitedVolume::look_at_facets(const std::function<void(const Corners&, FacetFinding&)>& look,
                                                        const core::ProgressReporter& progress,
                                                        std::size_t most_open) const {
  constexpr std::size_t kGrain = 16, kBlock = 256;
  const std::size_t block = most_open < facets_.size() ? kBlock : facets_.size();
  std::vector<FacetFinding> findings;
  std::atomic<std::size_t> done = 0;
  std::size_t open = 0;
  while (findings.size() < facets_.size() && open <= most_open) {
    const std::size_t first = findings.size(), count = std::min(block, facets_.size() - first);
    findings.resize(first + count);
    parallel::for_ranges(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = first + begin; f < first + end; ++f) look(facets_[f], findings[f]);
      progress.report(done += end - begin, facets_.size());
    });
    for (std::size_t f = first; f < findings.size(); ++f) open += findings[f].is_open ? 1 : 0;
  }
  return findings;
}

ClaimProof LimitedVolume::judged(const std::string& name, const std::vector<FacetFinding>& findings,
                                 const std::string& how, const std::string& limit) const {
  Broken worst;
  std::size_t open = 0;
  bool is_unknown = false;
  for (std::size_t f = 0; f < findings.size(); ++f) {
    const FacetFinding& finding = findings[f];
    if (finding.is_open) ++open;
    is_unknown = is_unknown || finding.broken.is_unknown;
    if (finding.broken.by_m > tolerance_of(facets_[f])) worst.see(finding.broken.by_m, finding.broken.at);
  }
  if (worst.by_m > -std::numeric_limits<double>::infinity()) return wrong(name, worst, limit);
  const bool are_all = findings.size() == facets_.size();
  if (are_all && open == 0 && !is_unknown) return proved(name, how);
  const char* const more = are_all ? "" : "at least ";
  return not_proved(name, std::string("it is open for ") + more + std::to_string(open) + " facets");
}

ClaimProof LimitedVolume::judged_at_vertices(const std::string& name, const std::function<double(const Vec3&)>& excess,
                                             const std::function<double(const Vec3&)>& allowed) const {
  Broken worst;
  bool is_unknown = false;
  for (const Vec3& vertex : vertices_) {
    const double by = excess(vertex);
    is_unknown = is_unknown || std::isnan(by);
    if (by > allowed(vertex)) worst.see(by, vertex);
  }
  if (worst.by_m > -std::numeric_limits<double>::infinity()) return wrong(name, worst, "the limit");
  if (is_unknown) return not_proved(name, "it cannot be computed for some vertex");
  return proved(name, "it holds at every vertex, and what it allows is convex");
}

ClaimProof LimitedVolume::judged_at_vertices(const std::string& name,
                                             const std::function<double(const Vec3&)>& excess) const {
  return judged_at_vertices(name, excess, [this](const Vec3& vertex) { return tolerance_at(vertex); });
}

ClaimProof LimitedVolume::wrong(const std::string& name, const Broken& broken, const std::string& limit) const {
  // Nearer than half of that it is broken by the other half, at least.
  if (!is_there(broken.at, broken.by_m / 2)) {
    return not_proved(name, "facets break it that may bound nothing, as the two sides of a flap");
  }
  const Vec3 place = origin_ + broken.at;
  return {name, ProofVerdict::wrong,
          core::format("at {} {} is broken by {:.3g} m", place_text(place), limit, broken.by_m), place, broken.by_m};
}

ClaimProof not_proved(const std::string& name, const std::string& why) {
  return {name, ProofVerdict::not_proved, why + ": 'vantage verify' tries points", {}, 0};
}

ClaimProof proved(const std::string& name, const std::string& how) { return {name, ProofVerdict::proved, how, {}, 0}; }

ClaimProof worse(const ClaimProof& a, const ClaimProof& b) { return b.verdict > a.verdict ? b : a; }

}  // namespace vantage::internal::prove
