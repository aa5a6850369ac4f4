// What the parts of the judge share.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "closed_mesh.h"
#include "judge.h"
#include "oracle.h"
#include "random.h"

namespace attack {

/// One part of the target before the scene. Local coordinates: those of Trial::blockers.
struct PartView {
  PartView(const Blockers& blockers, const SeenTarget& target, double strip, const Vec3& engine_centre)
      : exact(blockers, target),
        inner{View(blockers, moved_in(target, strip, 0)), View(blockers, moved_in(target, strip, strip)),
              View(blockers, moved_in(target, strip, -strip))},
        centre(engine_centre),
        margin(strip) {}

  /// A triangle that hides all of `inner` from there: it does so whatever is excepted.
  std::optional<std::size_t> surely_hiding(const Vec3& point, TriangleFilter filter = TriangleFilter::all) const;
  bool surely_hides(std::size_t triangle, const Vec3& point) const;
  /// A triangle between the facet and the target, whichever of `inner` is taken for it.
  std::optional<std::size_t> surely_hiding(const Corners& facet, TriangleFilter filter = TriangleFilter::all) const;

  View exact;                 ///< as given, and lifted
  std::array<View, 3> inner;  ///< moved in by the margin; and raised by it, and lowered
  Vec3 centre;                ///< that the engine measures distances from
  double margin;              ///< the strip along the outline that vantage/volume.h excepts, metres
};

class Trial {
 public:
  Trial(const Case& the_case, const Answer& the_answer, const JudgeOptions& the_options);

  /// What vantage/volume.h excepts for the coordinates of the mesh: five roundings of the largest, metres.
  double rounding() const { return 5 * 2.23e-16 * blockers.largest; }
  /// Heights over the target's plane below this are rounding of the oracle's own frame.
  double noise() const { return 1e-14 * std::max(blockers.largest, 1e-6); }
  Vec3 to_scene(const Vec3& local) const { return local + blockers.origin; }
  std::string object_of(std::size_t triangle) const;

  const Case& c;
  const Answer& answer;
  JudgeOptions options;
  Blockers blockers;
  std::deque<PartView> parts;
  Random random;
  Judgement result;
};

/// The width of the strip along the target's outline that vantage/volume.h excepts from the guarantee.
double strip_width(const Blockers& blockers, const SeenTarget& target, double range);

/// What becomes smaller with a range of less than 20 m does so by this.
double small_world(double range);

/// The engine looks at a triangle of this circumradius for a point, as docs/theory.md states; metres.
double point_radius(double range);

/// The volume's mesh about the oracle's origin; an empty one where an index is out of range.
vantage::Mesh local_mesh(const Trial& trial, const vantage::Volume& volume);

/// Mesh, causes, and whether anything is claimed wrongly.
void judge_claims(Trial& trial);
/// What of each part's volume is not claimed.
void judge_losses(Trial& trial);
/// query_points against the oracle and against the mesh.
void judge_query(Trial& trial);
/// An empty outcome and a refusal must have a reason.
void judge_outcome(Trial& trial);
void judge_refusal(Trial& trial);

/// Metres along the unit `direction` from `from` until a corner of the target is farther than `range`; 0: never within.
double range_along(const SeenTarget& target, const Vec3& from, const Vec3& direction, double range);

}  // namespace attack
