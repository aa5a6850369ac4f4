// The prepared scene's polygons as viewpoints see them: relative to the viewpoint, in double precision, with how far
// they can be off.
#pragma once

#include <cstdint>
#include <vector>

#include "depth/face_view.h"
#include "scene/prepared_data.h"

namespace vantage::internal::depth {

class SeenScene {
 public:
  /// Shares the scene.
  explicit SeenScene(const PreparedScene& scene);

  const PreparedScene::Data& data() const { return scene_.data(); }

  /// `eye` is relative to the scene's origin. The corners are kept in `storage`.
  ViewedPolygon polygon(std::uint32_t number, const Vec3& eye, std::vector<Vec3>& storage) const;

 private:
  PreparedScene scene_;
  std::vector<float> unevenness_;  ///< per polygon: how far its surface may leave the hull of its border, metres
};

}  // namespace vantage::internal::depth
