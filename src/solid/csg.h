// Closed solids and their boolean operations, in double precision: the one door to Manifold (csg.cpp alone includes
// it). Every facet carries a label, and a facet of a result keeps the label of the facet that it is a part of.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/labelled_mesh.h"
#include "core/progress_reporter.h"
#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::solid {

using core::LabelledMesh;

/// The largest label of a LabelledMesh that becomes a solid.
constexpr std::uint32_t kMaxLabel = 0x7fffffff;

/// An immutable closed solid, cheap to copy. Any number of threads may read one.
///
/// Accuracy: corners of the operands come out bit for bit where they survive; new corners lie within `epsilon()` of
/// both surfaces that meet there. `epsilon()` grows with the largest absolute coordinate (1e-12 of it), so move what
/// lies far from the origin first. Coplanar facets are joined only where both label and operand agree.
class Solid {
 public:
  /// The empty solid.
  Solid();

  /// Takes in a closed, oriented mesh: each edge's triangles run it as often in one direction as in the other. Vertices
  /// are told apart by index, not by position. Parts turned inside out are cavities; self-intersections are not looked
  /// for (see solid_check.h). `name` is for messages. Throws Error(input) when the mesh is not closed, an index or a
  /// label is out of range, or a coordinate is not finite.
  VANTAGE_INTERNAL_API explicit Solid(const LabelledMesh& labelled, const std::string& name = "mesh");

  /// The boundary: closed, and strictly so (two triangles per edge by index; where pieces touch, vertices are doubled).
  VANTAGE_INTERNAL_API LabelledMesh to_mesh() const;

  VANTAGE_INTERNAL_API bool empty() const;
  std::size_t facets() const;
  double volume() const;                        ///< cubic metres
  double area() const;                          ///< square metres
  VANTAGE_INTERNAL_API double epsilon() const;  ///< metres, see above
  Box bounds() const;
  long euler() const;  ///< V - E + F over all pieces

  struct Impl;
  const Impl& impl() const { return *impl_; }  ///< for csg.cpp
  explicit Solid(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Booleans are regularised: no dangling faces, and what merely touches does not meet. All ask `progress` from the
/// calling thread while the operation runs, and throw Error(cancelled) when told to stop, Error(work_too_large) when
/// the facets that go in, which they count as work, are more than `progress` allows, and Error(internal), with
/// Manifold's status, when an operation fails.
Solid unite(const Solid& a, const Solid& b, const core::ProgressReporter& progress = {});
VANTAGE_INTERNAL_API Solid intersect(const Solid& a, const Solid& b, const core::ProgressReporter& progress = {});
Solid subtract(const Solid& a, const Solid& b, const core::ProgressReporter& progress = {});
/// The union of any number of operands, smallest first. The union of none is empty. Its work is estimated: as if
/// nothing were lost on the way.
Solid unite(std::span<const Solid> operands, const core::ProgressReporter& progress = {});
/// The intersection of at least one operand, the smallest first; ends when nothing is left.
VANTAGE_INTERNAL_API Solid intersect(std::span<const Solid> operands, const core::ProgressReporter& progress = {});

/// Labels of a box's sides.
struct BoxLabels {
  std::array<std::uint32_t, 3> min{}, max{};  ///< of the sides at min x, y, z and at max x, y, z
};
/// The same solid with what lies in one plane and has one label joined, whatever operands it came from, to within
/// epsilon(): what follows costs less.
Solid simplified(const Solid& solid);

struct NumberedPoint {
  Eigen::Vector2d place;
  std::uint32_t number;
};
/// Triangles of an area in the plane, counter-clockwise, by the numbers of the points round it. `rings`:
/// counter-clockwise round the area, clockwise round holes; they may pass through each other by rounding. Each piece of
/// a ring is a side of one triangle, any other side is one of two. Cost: O(n log n) expected.
std::vector<Triangle> triangulate(const std::vector<std::vector<NumberedPoint>>& rings, double epsilon);

/// An axis-aligned box; its corners are those given, bit for bit. Needs min < max on every axis.
Solid make_box(const Box& box, const BoxLabels& labels);

/// The space straight above a polygon, from z `low` to `high`, low < high. `rings`: the outer one counter-clockwise,
/// those of holes clockwise; they may run along one another, not cross. The corners are those given, bit for bit.
/// Labels of the facets at the bottom, at the top and at the sides. Cost: O(n log n) expected.
Solid make_prism(const std::vector<std::vector<Eigen::Vector2d>>& rings, double low, double high,
                 const std::array<std::uint32_t, 3>& labels);

}  // namespace vantage::internal::solid
