// Whether what the engine says of a case is right: docs/verification.md.
#pragma once

#include <string>
#include <vector>

#include "case.h"
#include "engine_calls.h"

namespace attack {

enum class FindingKind {
  // Wrong: the attack fails.
  over_claim,       ///< a point deeper inside than kDepth of its distance does not see all of the target
  thin_over_claim,  ///< likewise, and only triangles thinner than a nanometre hide it
  out_of_range,     ///< such a point is farther than max_range from a corner
  behind_target,    ///< such a point is behind the target's plane
  outside_limits,   ///< such a point breaks a navigation limit
  bad_mesh,         ///< not closed or not oriented, by index
  flat_facets,      ///< facets whose corners lie on one line, exactly
  bad_causes,       ///< an index of a cause out of range, or not one a facet
  query_over,       ///< query_points says inside where the target is hidden by more than kDepth of the distance
  bad_outcome,      ///< empty for a reason that does not hold
  false_refusal,    ///< refused, though all of the target is clear
  defect,           ///< Error(internal), or an exception of another kind
  crash,            ///< the process died
  hang,             ///< it took longer than the limit

  // Told, not failed.
  shallow,       ///< some point of a facet, moved in by kDepth along the line to the centre, does not see all, but it
                 ///< lies less deep than the guarantee speaks of
  touching,      ///< over-claimed by the triangles as stored, not when the target is smaller by the separation
  query_under,   ///< query_points says outside where all is clear by more than kDepth
  query_mesh,    ///< query_points and the mesh end the view at places that differ by more than kDepth
  blocked_by,    ///< query_points names an object that hides nothing, or not one that does
  under_claim,   ///< a place outside sees everything, by more than kDepth and the tolerance
  lift_refusal,  ///< refused, though all is clear; something is over the target by less than the lift that is stated
  reversed,      ///< the target's corners in the other order give another volume, or comparing the two fails
};
inline constexpr int kClasses = static_cast<int>(FindingKind::reversed) + 1;

const char* name_of(FindingKind which);
bool is_wrong(FindingKind which);

/// What the engine guarantees, in parts of the distance to the target's centre.
inline constexpr double kDepth = 1e-6;

struct Finding {
  FindingKind which;
  double share = 0;  ///< how deep, how far apart: in parts of the distance to the target's centre
  vantage::Vec3 place = vantage::Vec3::Zero();  ///< scene frame
  std::string detail;
};

struct Judgement {
  std::string status;              ///< "computed", an outcome's name, "refused: pierced", ...
  std::vector<Finding> findings;   ///< the worst one of each class
  std::size_t viewpoints = 0;      ///< claimed ones that were looked from
  std::size_t proved = 0;          ///< facets whose every point sees all of the target, moved in by kDepth
  std::size_t proved_smaller = 0;  ///< likewise, of the target smaller by the separation
  std::size_t unproved = 0;        ///< not so
  std::size_t untried = 0;         ///< beyond JudgeOptions::proofs
  std::size_t facets = 0;
  double lift = 0;
  double lost = 0;       ///< share of the true volume that is not claimed, less the tolerance: an estimate
  double worst_gap = 0;  ///< the greatest share of a line of sight that is not claimed

  void add(Finding finding);
  const Finding* find(FindingKind which) const;
  bool wrong() const;
};

struct JudgeOptions {
  std::size_t facets = 60;      ///< drawn, to look from points in and right behind them
  std::size_t viewpoints = 40;  ///< anywhere inside
  std::size_t directions = 60;  ///< to look for what is left out
  std::size_t proofs = 3000;    ///< facets at most to prove
  bool reversed = false;        ///< compare with the target's corners the other way round
  bool query = true;            ///< ask query_points too
};

/// `answer`: what the engine made of this case, or of another one, or what became of it: the judge must tell.
Judgement judge(const Case& c, const Answer& answer, const JudgeOptions& options = {});

}  // namespace attack
