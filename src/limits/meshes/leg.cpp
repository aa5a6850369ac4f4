#include <string>

#include "query/leg_limit.h"

namespace vantage::internal::query {
namespace {

class MeshesOfLeg : public LegLimit {
 public:
  explicit MeshesOfLeg(const std::vector<KeepInMesh>& meshes) {
    for (const KeepInMesh& mesh : meshes) {
      names_.push_back("mesh " + mesh.name);
      meshes_.push_back(std::make_unique<LegMesh>(mesh));
    }
  }

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      add_break(breaks, names_[i], LegBreak::Unit::metres, meshes_[i]->broken(tube),
                [&](double share) { return meshes_[i]->outside(tube.at(share)) + tube.radius; });
    }
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<LegMesh>> meshes_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::meshes>(const std::vector<KeepInMesh>& meshes,
                                                         LegGroundPool& /*grounds*/) {
  return std::make_unique<MeshesOfLeg>(meshes);
}

}  // namespace vantage::internal::query
