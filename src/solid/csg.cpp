#include "solid/csg.h"

#include <manifold/manifold.h>
#include <manifold/polygon.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "vantage/error.h"

namespace vantage::internal::solid {

struct Solid::Impl {
  manifold::Manifold manifold;  // evaluated, status NoError
};

namespace {

using Status = manifold::Manifold::Error;

/// Manifold names its errors in debug builds only.
const char* name_of(Status status) {
  switch (status) {
    case Status::NoError:
      return "no error";
    case Status::NonFiniteVertex:
      return "a coordinate is not finite";
    case Status::NotManifold:
      return "not closed and oriented";
    case Status::VertexOutOfBounds:
      return "a vertex index is out of range";
    case Status::PropertiesWrongLength:
      return "properties of wrong length";
    case Status::MissingPositionProperties:
      return "positions are missing";
    case Status::MergeVectorsDifferentLengths:
      return "merge vectors of different lengths";
    case Status::MergeIndexOutOfBounds:
      return "a merge index is out of range";
    case Status::TransformWrongLength:
      return "transforms of wrong length";
    case Status::RunIndexWrongLength:
      return "run indices of wrong length";
    case Status::FaceIDWrongLength:
      return "labels of wrong length";
    case Status::InvalidConstruction:
      return "invalid construction";
    case Status::ResultTooLarge:
      return "the result has too many triangles";
    case Status::InvalidTangents:
      return "invalid tangents";
    case Status::Cancelled:
      return "cancelled";
  }
  return "unknown status";
}

Vec3 from_manifold(const manifold::vec3& v) { return {v.x, v.y, v.z}; }

Solid wrap(manifold::Manifold evaluated) {
  return Solid(std::make_shared<const Solid::Impl>(Solid::Impl{std::move(evaluated)}));
}

/// Fewer facets than these take milliseconds, and need no thread of their own to be asked from.
constexpr double kQuickFacets = 5000;

/// Manifold evaluates lazily. While it works on another thread this one asks every few milliseconds whether to go on.
Status evaluate(const manifold::Manifold& lazy, double facets, const core::ProgressReporter& progress) {
  if (progress.is_followed()) progress.check();
  if (!progress.is_followed() || facets < kQuickFacets) return lazy.Status();
  manifold::ExecutionContext context;
  const manifold::Manifold watched = lazy.WithContext(context);
  const auto ask = [&] {
    try {
      progress.report(context.Progress());
    } catch (...) {
      context.Cancel();
      throw;
    }
  };
  parallel::run_while_asking([&] { (void)watched.Status(); }, ask);
  return lazy.Status();  // only takes over the cached result
}

/// `facets`: those that go in.
Solid evaluated(const manifold::Manifold& lazy, double facets, const char* operation,
                const core::ProgressReporter& progress) {
  progress.spend(facets);
  const Status status = evaluate(lazy, facets, progress);
  if (status == Status::Cancelled) throw Error(ErrorCode::cancelled, "cancelled", operation, "");
  if (status != Status::NoError) {
    throw Error(ErrorCode::internal_defect, std::string("a boolean operation on solids failed: ") + name_of(status),
                operation, "");
  }
  return wrap(lazy);
}

double facets_of(const Solid& a, const Solid& b) { return static_cast<double>(a.facets() + b.facets()); }

std::vector<manifold::Manifold> manifolds_of(std::span<const Solid> operands) {
  std::vector<manifold::Manifold> result;
  result.reserve(operands.size());
  for (const Solid& operand : operands) result.push_back(operand.impl().manifold);
  return result;
}

manifold::MeshGL64 to_mesh_gl(const LabelledMesh& labelled, const std::string& name) {
  const auto& [mesh, labels] = labelled;
  if (labels.size() != mesh.triangles.size()) {
    throw Error(ErrorCode::internal_defect, "labels and triangles differ in number", name, "");
  }
  manifold::MeshGL64 gl;
  gl.vertProperties.reserve(3 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) gl.vertProperties.insert(gl.vertProperties.end(), {v.x(), v.y(), v.z()});
  gl.triVerts.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) gl.triVerts.insert(gl.triVerts.end(), {t[0], t[1], t[2]});
  // A face id is carried through every operation, and Manifold never joins facets whose ids differ.
  gl.faceID.reserve(labels.size());
  for (const std::uint32_t label : labels) {
    if (label > kMaxLabel) throw Error(ErrorCode::internal_defect, "a label is too large", name, "");
    gl.faceID.push_back(label);
  }
  return gl;
}

}  // namespace

Solid::Solid() : impl_(std::make_shared<const Impl>()) {}

Solid::Solid(const LabelledMesh& labelled, const std::string& name) {
  const manifold::Manifold manifold(to_mesh_gl(labelled, name));
  const Status status = manifold.Status();
  if (status != Status::NoError) {
    throw Error(ErrorCode::mesh_not_closed, std::string("the mesh does not bound a solid: ") + name_of(status), name,
                "give a closed mesh whose triangles all face outward");
  }
  impl_ = std::make_shared<const Impl>(Impl{manifold});
}

LabelledMesh Solid::to_mesh() const {
  const manifold::MeshGL64 gl = impl_->manifold.GetMeshGL64();
  LabelledMesh result;
  result.mesh.vertices.reserve(gl.NumVert());
  for (std::size_t i = 0; i < gl.NumVert(); ++i) result.mesh.vertices.push_back(from_manifold(gl.GetVertPos(i)));
  std::vector<std::uint32_t> merged(gl.NumVert());
  std::iota(merged.begin(), merged.end(), 0u);
  for (std::size_t i = 0; i < gl.mergeFromVert.size(); ++i) {
    merged[gl.mergeFromVert[i]] = static_cast<std::uint32_t>(gl.mergeToVert[i]);
  }
  result.mesh.triangles.reserve(gl.NumTri());
  for (std::size_t i = 0; i < gl.NumTri(); ++i) {
    result.mesh.triangles.push_back(
        {merged[gl.triVerts[3 * i]], merged[gl.triVerts[3 * i + 1]], merged[gl.triVerts[3 * i + 2]]});
  }
  result.labels.reserve(gl.NumTri());
  for (const auto label : gl.faceID) result.labels.push_back(static_cast<std::uint32_t>(label));
  return result;
}

bool Solid::empty() const { return impl_->manifold.IsEmpty(); }
std::size_t Solid::facets() const { return impl_->manifold.NumTri(); }
double Solid::volume() const { return impl_->manifold.Volume(); }
double Solid::area() const { return impl_->manifold.SurfaceArea(); }
double Solid::epsilon() const { return impl_->manifold.GetEpsilon(); }

Box Solid::bounds() const {
  if (empty()) return {};
  const manifold::Box box = impl_->manifold.BoundingBox();
  return {from_manifold(box.min), from_manifold(box.max)};
}

long Solid::euler() const {
  const manifold::Manifold& m = impl_->manifold;
  return static_cast<long>(m.NumVert()) - static_cast<long>(m.NumEdge()) + static_cast<long>(m.NumTri());
}

Solid unite(const Solid& a, const Solid& b, const core::ProgressReporter& progress) {
  return evaluated(a.impl().manifold + b.impl().manifold, facets_of(a, b), "union", progress);
}

Solid intersect(const Solid& a, const Solid& b, const core::ProgressReporter& progress) {
  return evaluated(a.impl().manifold ^ b.impl().manifold, facets_of(a, b), "intersection", progress);
}

Solid subtract(const Solid& a, const Solid& b, const core::ProgressReporter& progress) {
  return evaluated(a.impl().manifold - b.impl().manifold, facets_of(a, b), "difference", progress);
}

Solid unite(std::span<const Solid> operands, const core::ProgressReporter& progress) {
  double facets = 0;
  for (const Solid& operand : operands) facets += static_cast<double>(operand.facets());
  const int rounds = std::bit_width(std::max<std::size_t>(operands.size(), 1) - 1);
  return evaluated(manifold::Manifold::BatchBoolean(manifolds_of(operands), manifold::OpType::Add), facets * rounds,
                   "union", progress);
}

Solid intersect(std::span<const Solid> operands, const core::ProgressReporter& progress) {
  if (operands.empty()) throw Error(ErrorCode::internal_defect, "an intersection needs an operand", "", "");
  // If several are as large, the first ones come first.
  const auto is_larger = [](const std::pair<std::size_t, Solid>& a, const std::pair<std::size_t, Solid>& b) {
    return std::pair(a.second.facets(), a.first) > std::pair(b.second.facets(), b.first);
  };
  std::vector<std::pair<std::size_t, Solid>> heap;
  for (const Solid& operand : operands) heap.emplace_back(heap.size(), operand);
  std::make_heap(heap.begin(), heap.end(), is_larger);
  const auto take = [&] {
    std::pop_heap(heap.begin(), heap.end(), is_larger);
    Solid taken = std::move(heap.back().second);
    heap.pop_back();
    return taken;
  };
  const auto count = static_cast<double>(operands.size());
  for (std::size_t done = 0; heap.size() > 1; ++done) {
    const Solid a = take(), b = take();
    const auto at = static_cast<double>(done);
    Solid both = intersect(a, b, progress.part(at / count, (at + 1) / count));
    if (both.empty()) return both;
    heap.emplace_back(operands.size() + done, std::move(both));
    std::push_heap(heap.begin(), heap.end(), is_larger);
  }
  return heap.front().second;
}

Solid simplified(const Solid& solid) {
  if (solid.empty()) return solid;
  const Solid one(solid.to_mesh());  // of one operand
  return evaluated(one.impl().manifold.Simplify(), 0, "simplification", {});
}

std::vector<Triangle> triangulate(const std::vector<std::vector<NumberedPoint>>& rings, double epsilon) {
  manifold::PolygonsIdx polygons;
  for (const std::vector<NumberedPoint>& ring : rings) {
    manifold::SimplePolygonIdx& polygon = polygons.emplace_back();
    for (const auto& [place, number] : ring) polygon.push_back({{place.x(), place.y()}, static_cast<int>(number)});
  }
  std::vector<Triangle> triangles;
  for (const manifold::ivec3& t : manifold::TriangulateIdx(polygons, epsilon)) {
    triangles.push_back(
        {static_cast<std::uint32_t>(t.x), static_cast<std::uint32_t>(t.y), static_cast<std::uint32_t>(t.z)});
  }
  return triangles;
}

Solid make_box(const Box& box, const BoxLabels& labels) {
  if (!(box.min.array() < box.max.array()).all()) {
    throw Error(ErrorCode::internal_defect, "a box must have min < max on every axis", "", "");
  }
  LabelledMesh result;
  // Bit i of a corner's index says whether it lies at the far end of axis i.
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3& vertex = result.mesh.vertices.emplace_back();
    for (unsigned axis = 0; axis < 3; ++axis) vertex[axis] = (corner >> axis & 1) ? box.max[axis] : box.min[axis];
  }
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, far = 1u << axis;
    // Counter-clockwise about the axis on the far side, clockwise on the near one.
    result.mesh.triangles.push_back({far, far + u, far + u + v});
    result.mesh.triangles.push_back({far, far + u + v, far + v});
    result.mesh.triangles.push_back({0, u + v, u});
    result.mesh.triangles.push_back({0, v, u + v});
    result.labels.insert(result.labels.end(), {labels.max[axis], labels.max[axis], labels.min[axis], labels.min[axis]});
  }
  return Solid(result, "box");
}

Solid make_prism(const std::vector<std::vector<Eigen::Vector2d>>& rings, double low, double high,
                 const std::array<std::uint32_t, 3>& labels) {
  manifold::PolygonsIdx polygons;
  LabelledMesh result;
  std::vector<Vec3>& vertices = result.mesh.vertices;
  std::uint32_t count = 0;
  for (const std::vector<Eigen::Vector2d>& ring : rings) {
    manifold::SimplePolygonIdx& polygon = polygons.emplace_back();
    for (const Eigen::Vector2d& p : ring) {
      polygon.push_back({{p.x(), p.y()}, static_cast<int>(count++)});
      vertices.emplace_back(p.x(), p.y(), low);
    }
  }
  for (std::uint32_t v = 0; v < count; ++v) vertices.emplace_back(vertices[v].x(), vertices[v].y(), high);
  const auto add = [&](const Triangle& triangle, std::uint32_t label) {
    result.mesh.triangles.push_back(triangle);
    result.labels.push_back(label);
  };
  for (const manifold::ivec3& t : manifold::TriangulateIdx(polygons)) {
    const auto a = static_cast<std::uint32_t>(t.x), b = static_cast<std::uint32_t>(t.y),
               c = static_cast<std::uint32_t>(t.z);
    add({c, b, a}, labels[0]);
    add({count + a, count + b, count + c}, labels[1]);
  }
  std::uint32_t first = 0;
  for (const std::vector<Eigen::Vector2d>& ring : rings) {
    const auto size = static_cast<std::uint32_t>(ring.size());
    for (std::uint32_t i = 0; i < size; ++i) {
      const std::uint32_t from = first + i, to = first + (i + 1) % size;
      add({from, to, count + to}, labels[2]);
      add({from, count + to, count + from}, labels[2]);
    }
    first += size;
  }
  return Solid(result, "zone");
}

}  // namespace vantage::internal::solid
