#include "flight/tour/outer_region.h"

#include <cmath>
#include <utility>

#include "vantage/error.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kLargest = 1e9;  // metres, as everywhere

[[noreturn]] void refuse_computed(const std::string& name) {
  throw Error(ErrorCode::value_out_of_range, "a computed volume lies inside the true one: no bound can be had of it",
              name, "give the outer volume of the same mission (outer_volume)");
}

}  // namespace

OuterRegion::OuterRegion(Kind kind, Mesh mesh, std::string name)
    : kind_(kind), mesh_(std::move(mesh)), name_(std::move(name)) {
  for (const Vec3& v : mesh_.vertices) {
    if (!v.allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "a vertex of the region is not finite", name_,
                  "give three finite numbers");
    }
    if (v.cwiseAbs().maxCoeff() > kLargest) {
      throw Error(ErrorCode::coordinate_too_large, "a vertex of the region is farther than 1e9 m from the origin",
                  name_, "move the region towards the origin");
    }
  }
  for (const Triangle& triangle : mesh_.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh_.vertices.size()) {
        throw Error(ErrorCode::index_out_of_range, "vertex index " + std::to_string(corner) + " is out of range", name_,
                    "give indices of the mesh's own vertices");
      }
    }
  }
}

OuterRegion OuterRegion::of(const OuterVolume& volume, std::string name) {
  if (volume.volume.provenance) refuse_computed(name);
  if (volume.volume.empty()) {
    throw Error(ErrorCode::mesh_empty, "the outer volume is empty: there is no place to visit", name,
                "leave the target out");
  }
  return {Kind::outer, volume.volume.mesh, std::move(name)};
}

OuterRegion OuterRegion::given(Mesh mesh, std::string name) {
  if (mesh.empty()) {
    throw Error(ErrorCode::mesh_empty, "the region has no triangles", name, "give a closed mesh");
  }
  return {Kind::given, std::move(mesh), std::move(name)};
}

OuterRegion OuterRegion::given(const Volume& volume, std::string name) {
  if (volume.provenance) refuse_computed(name);
  return given(volume.mesh, std::move(name));
}

OuterRegion OuterRegion::point(const Vec3& place, std::string name) {
  return {Kind::point, Mesh{{place}, {}}, std::move(name)};
}

const char* name_of(OuterRegion::Kind kind) {
  switch (kind) {
    case OuterRegion::Kind::outer:
      return "outer";
    case OuterRegion::Kind::given:
      return "given";
    case OuterRegion::Kind::point:
      return "point";
  }
  return "";
}

}  // namespace vantage::internal::flight::tour
