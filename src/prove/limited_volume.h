// A volume whose limits are proved facet by facet, and what is found of them.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "prove/scene_tree.h"
#include "vantage/prove.h"

namespace vantage::internal::prove {

/// Where a limit is broken, and by how much at least.
struct Broken {
  double by_m = -std::numeric_limits<double>::infinity();
  Vec3 at = Vec3::Zero();

  bool is_unknown = false;  ///< what was seen could not be computed for some place

  void see(double metres, const Vec3& place) {
    if (std::isnan(metres)) is_unknown = true;
    if (!(metres > by_m)) return;
    by_m = metres;
    at = place;
  }
};

/// What an argument says of one facet.
struct FacetFinding {
  bool is_open = false;  ///< the argument does not cover it
  Broken broken;         ///< the worst place on it that was looked at
};

/// Positions are relative to `origin`, near the target.
class LimitedVolume {
 public:
  using Corners = std::array<Vec3, 3>;

  /// `solid`: closed, in the scene frame, vertices in one place taken for one. Must outlive this.
  /// `cuts_m`: how far cutting may have moved a corner (rounding_of_cuts_m of open_volume.h).
  LimitedVolume(const Mesh& solid, const Vec3& origin, double shrink, double rounding_m, double cuts_m);

  /// The same, of which only what lies in front of a plane is looked at, facets and vertices; it winds round what it
  /// did.
  LimitedVolume in_front_of(const Vec3& point, const Vec3& normal) const;

  const Vec3& origin() const { return origin_; }
  const Box& box() const { return box_; }
  const std::vector<Vec3>& vertices() const { return vertices_; }  ///< those that facets use
  const Mesh& solid() const { return solid_; }                     ///< as it was given, scene frame
  const std::vector<Corners>& facets() const { return facets_; }
  double rounding_m() const { return rounding_m_; }  ///< of the volume's file
  double unsure_m() const { return unsure_m_; }      ///< what is rounded in a coordinate, with plenty to spare

  /// A place on the facet breaks a limit if by more than this: what the file and cutting rounded, what is shrunk where
  /// the facet is nearest to the origin, and what is rounded in its own coordinates. So where facets are judged one by
  /// one, no other facet, however far it reaches, changes what this one may do. Where vertices are judged
  /// (tolerance_at), each may do what is due at its own distance, and what is between a far vertex and a near one may
  /// do what is due between.
  double tolerance_of(const Corners& facet) const;
  /// The same of a vertex, and of what is rounded alone.
  double tolerance_at(const Vec3& vertex) const { return rounded_at(vertex) + shrink_ * vertex.norm(); }
  double rounded_at(const Vec3& vertex) const {
    return rounding_m_ + cuts_m_ + unsure_of(vertex.cwiseAbs().maxCoeff());
  }

  double tolerance_m() const { return most_m_; }  ///< the largest of a facet
  double least_m() const { return least_m_; }     ///< no facet has less

  /// Whether the mesh does not wind round a point. Nothing where it is too near to the surface to tell.
  std::optional<bool> is_outside(const Vec3& point) const;

  /// Whether the mesh surely winds round some point that is no farther from this one. Facets that lie on each other, as
  /// two sides of a flap, bound nothing.
  bool is_there(const Vec3& point, double within_m) const;

  /// Looks at every facet, with all threads; or at the first ones, where more than `most_open` of these are open.
  std::vector<FacetFinding> look_at_facets(const std::function<void(const Corners&, FacetFinding&)>& look,
                                           const core::ProgressReporter& progress,
                                           std::size_t most_open = std::numeric_limits<std::size_t>::max()) const;

  /// The verdict on a limit: wrong where a place breaks it by more than the facet's tolerance, else not proved where a
  /// facet is open. `findings`: of look_at_facets. `how`: by what it is proved. `limit`: what a place breaks, for the
  /// text.
  ClaimProof judged(const std::string& name, const std::vector<FacetFinding>& findings, const std::string& how,
                    const std::string& limit) const;

  /// The same of a limit that holds in all of the volume if it holds at the vertices. `excess`: metres by which a
  /// vertex breaks it; `allowed`: by which it may.
  ClaimProof judged_at_vertices(const std::string& name, const std::function<double(const Vec3&)>& excess,
                                const std::function<double(const Vec3&)>& allowed) const;
  ClaimProof judged_at_vertices(const std::string& name, const std::function<double(const Vec3&)>& excess) const;

  /// Not proved, where the volume is not surely there.
  ClaimProof wrong(const std::string& name, const Broken& broken, const std::string& limit) const;

 private:
  double unsure_of(double reach_m) const;

  const Mesh& solid_;
  Vec3 origin_;
  double shrink_, rounding_m_, cuts_m_, unsure_m_ = 0, most_m_ = 0, least_m_ = 0;
  std::vector<Vec3> vertices_;
  std::vector<Corners> facets_;
  std::vector<Corners> closed_;  ///< all facets
  Box box_;
};

ClaimProof not_proved(const std::string& name, const std::string& why);
ClaimProof proved(const std::string& name, const std::string& how);

/// The worse of two verdicts on parts of one limit; of two that are alike the first one.
ClaimProof worse(const ClaimProof& a, const ClaimProof& b);

}  // namespace vantage::internal::prove
