#include <vector>

#include "verify/closed_mesh.h"
#include "verify/limit_probe.h"

namespace vantage::internal::verify {
namespace {

class MeshesProbe : public LimitProbe {
 public:
  MeshesProbe(const std::vector<KeepInMesh>& meshes, const Vec3& origin) {
    for (const KeepInMesh& keep_in : meshes) {
      names_.push_back(keep_in.name);
      meshes_.emplace_back(keep_in.mesh, origin, "keep-in mesh '" + keep_in.name + "'");
    }
  }

  std::optional<std::string> broken_by(const JudgedPoint& point) const override {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      if (meshes_[i].contains(point.local) == false) return "mesh " + names_[i];
    }
    return std::nullopt;
  }
  bool may_leave_out(const JudgedPoint& /*point*/) const override { return false; }

 private:
  std::vector<std::string> names_;
  std::vector<ClosedMesh> meshes_;
};

}  // namespace

template <>
std::unique_ptr<const LimitProbe> probe_of<Limit::meshes>(const std::vector<KeepInMesh>& meshes, const Vec3& origin) {
  return std::make_unique<MeshesProbe>(meshes, origin);
}

}  // namespace vantage::internal::verify
