// Writes scenes of many objects: one writer per file format.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/atomic_file.h"
#include "vantage/scene.h"

namespace vantage::internal::io {

/// The triangles of a scene, object by object; those of one object in the scene's order.
class ObjectTriangles {
 public:
  explicit ObjectTriangles(const Scene& scene);

  /// Calls `visit(object, first, end)` for each object that has triangles: pointers into their indices.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t object = 0; object + 1 < first_.size(); ++object) {
      if (first_[object] < first_[object + 1]) {
        visit(object, triangles_.data() + first_[object], triangles_.data() + first_[object + 1]);
      }
    }
  }

 private:
  std::vector<std::size_t> first_;        // per object, and one more: in triangles_
  std::vector<std::uint32_t> triangles_;  // indices of the scene's
};

/// The name of an object for a file: on one line, never empty.
std::string object_name(const Scene& scene, std::size_t object);

/// Each returns how far the numbers of the format have moved a vertex at most, metres.
double write_scene_obj(const Scene& scene, AtomicFile& file);
double write_scene_ply(const Scene& scene, AtomicFile& file);
double write_scene_stl(const Scene& scene, AtomicFile& file);
double write_scene_glb(const Scene& scene, AtomicFile& file);

}  // namespace vantage::internal::io
