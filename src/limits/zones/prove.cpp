// No facet meets what is taken away, and one point of that is outside. Or every facet is covered by what is kept, and
// that leaves no hollow. docs/proof.md has the arguments.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "prove/ground_band.h"
#include "prove/limit_proof.h"
#include "prove/prism.h"
#include "prove/within_box.h"

namespace vantage::internal::prove {
namespace {

bool are_apart(const Box& a, const Box& b, double by) {
  return (a.min.array() > b.max.array() + by).any() || (b.min.array() > a.max.array() + by).any();
}

bool has_terrain(const Zone& zone) { return zone.above_ground && zone.above_ground->ground.surface; }

ConvexPolygon polygon_of(const LimitedVolume::Corners& corners) { return {corners.begin(), corners.end()}; }

ClaimProof prove_clear_of(const LimitedVolume& volume, const Prism& prism, const std::string& what,
                          const core::ProgressReporter& progress) {
  const std::string name = "keep_out";
  const std::string how = "no facet meets what is taken away, and it is not inside";
  if (!(prism.low() < prism.high()) || are_apart(prism.box(), volume.box(), 0)) return proved(name, how);
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& corners, FacetFinding& finding) {
        const ConvexPolygon facet = polygon_of(corners);
        if (are_apart(box_of(facet), prism.box(), 0)) return;
        const double plate = volume.tolerance_of(corners) / 2;
        if (!(prism.rounding_m() < plate)) {
          finding.is_open = true;
          return;
        }
        for (const ConvexPolygon& piece : prism.divide(facet, -plate, plate).inside) {
          finding.is_open = true;
          const Vec3 middle = middle_of(piece);
          finding.broken.see(prism.depth(middle), middle);
          for (const Vec3& corner : piece) finding.broken.see(prism.depth(corner), corner);
        }
      },
      progress);
  ClaimProof claim = volume.judged(name, findings, how, what);
  if (claim.verdict != ProofVerdict::proved) return claim;
  if (!std::isfinite(prism.low()) || !std::isfinite(prism.high())) return claim;  // no mesh winds round all of that
  const std::optional<Vec3> deep = prism.deep_point();
  const double depth = deep ? prism.depth(*deep) : 0;
  if (!(depth > volume.tolerance_m()) || !prism.is_one_piece(volume.tolerance_m())) {
    return not_proved(name, what + " is narrower than what numbers can tell");
  }
  const std::optional<bool> is_outside = volume.is_outside(*deep);
  if (!is_outside) return not_proved(name, what + " may be all inside");
  if (!*is_outside) return volume.wrong(name, {depth, *deep}, what);
  return claim;
}

struct Kept {
  std::vector<Prism> prisms;

  double outside_by(const Vec3& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Prism& prism : prisms) least = std::min(least, -prism.depth(point));
    return least;
  }
  double rounding_m() const {
    double most = 0;
    for (const Prism& prism : prisms) most = std::max(most, prism.rounding_m());
    return most;
  }
};

/// Straight up from a point of a hollow there is a piece, and straight down as well. Shallower ones than the least
/// tolerance are covered by what is allowed.
bool may_have_hollow(const std::vector<Prism>& prisms, const LimitedVolume& volume) {
  const Box& within = volume.box();
  const Vec3 beside(2 * volume.tolerance_m(), 2 * volume.tolerance_m(), 0);
  for (const Prism& below : prisms) {
    for (const Prism& above : prisms) {
      const double low = std::max(below.high(), within.min.z()), high = std::min(above.low(), within.max.z());
      if (!(high - low > volume.least_m())) continue;
      const Vec3 min = below.box().min.cwiseMax(above.box().min).cwiseMax(within.min) - beside;
      const Vec3 max = below.box().max.cwiseMin(above.box().max).cwiseMin(within.max) + beside;
      if (min.x() <= max.x() && min.y() <= max.y()) return true;
    }
  }
  return false;
}

ClaimProof prove_covered(const LimitedVolume& volume, const Kept& kept, const core::ProgressReporter& progress) {
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& corners, FacetFinding& finding) {
        const double plate = volume.tolerance_of(corners) / 2;
        if (!(kept.rounding_m() < plate)) {
          finding.is_open = true;
          return;
        }
        std::vector<ConvexPolygon> left = {polygon_of(corners)};
        for (const Prism& prism : kept.prisms) {
          std::vector<ConvexPolygon> still;
          for (const ConvexPolygon& piece : left) {
            Prism::Parts parts = prism.divide(piece, plate, plate);
            std::move(parts.outside.begin(), parts.outside.end(), std::back_inserter(still));
          }
          left = std::move(still);
        }
        for (const ConvexPolygon& piece : left) {
          finding.is_open = true;
          const Vec3 middle = middle_of(piece);
          finding.broken.see(kept.outside_by(middle), middle);
          for (const Vec3& corner : piece) finding.broken.see(kept.outside_by(corner), corner);
        }
      },
      progress);
  ClaimProof claim =
      volume.judged("keep_in", findings, "every facet is covered by what is kept, which has no hollow", "what is kept");
  if (claim.verdict != ProofVerdict::proved) return claim;
  if (may_have_hollow(kept.prisms, volume)) {
    return not_proved("keep_in", "pieces lie over each other with a gap between, which may be a hollow");
  }
  return claim;
}

}  // namespace

/// Of the union of all zones to stay in.
template <>
ClaimProof prove_limit<Limit::keep_in>(const std::vector<Zone>& zones, const Claimant& of,
                                       const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  const bool is_one = zones.size() == 1;
  if (is_one && zones[0].is_box) return prove_within_box("keep_in", volume, zones[0].box());
  Kept kept;
  std::optional<ClaimProof> heights;
  for (const Zone& zone : zones) {
    kept.prisms.emplace_back(zone, volume.origin());
    if (!has_terrain(zone)) continue;
    if (!is_one) return not_proved("keep_in", "one of several pieces is bounded by heights above terrain");
    heights = prove_above_ground("keep_in", volume, *zone.above_ground, progress);
  }
  const ClaimProof in_plan = prove_covered(volume, kept, progress);
  return heights ? worse(in_plan, *heights) : in_plan;
}

/// The worst of the proofs for each zone to stay out of.
template <>
ClaimProof prove_limit<Limit::keep_out>(const std::vector<Zone>& zones, const Claimant& of,
                                        const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  std::optional<ClaimProof> all;
  const auto add = [&](const ClaimProof& one) { all = all ? worse(*all, one) : one; };
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[i];
    const std::string what = zone_name(zones, i);
    ClaimProof claim = prove_clear_of(volume, Prism(zone, volume.origin()), what, progress);
    // It takes away no more than without the heights.
    if (has_terrain(zone) && claim.verdict != ProofVerdict::proved) {
      claim = not_proved("keep_out", what + " is bounded by heights above terrain");
    }
    add(claim);
  }
  return *all;
}

}  // namespace vantage::internal::prove
