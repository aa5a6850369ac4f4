// Where the vertices of a glTF primitive are: moved by the default weights of its morph targets, then by the joints of
// its skin as the nodes stand, or else by its node (glTF 2.0, sections 3.7.2.2 and 3.7.3).
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "io/gltf_document.h"
#include "vantage/geometry.h"

namespace vantage::internal::io::gltf {

/// By its matrix, or by translation, rotation and scale.
Eigen::Affine3d local_transform(const Document& document, const Json& node);

/// `count` numbers, or `otherwise` if the key is missing.
std::vector<double> numbers(const Document& document, const Json& object, const char* key,
                            std::vector<double> otherwise);

class Pose {
 public:
  Vec3 at(std::uint64_t vertex) const;
  std::uint64_t count() const { return positions_.count(); }
  /// Whether the turn of triangles is reversed.
  bool is_mirrored() const { return (joints_ ? joints_->front() : world_).linear().determinant() < 0; }

 private:
  friend class Poses;
  Accessor positions_;
  std::vector<std::pair<double, Accessor>> morphs_;        // weight, and how far each vertex moves
  std::vector<std::pair<Accessor, Accessor>> influences_;  // joints and weights, four of each for a vertex
  const std::vector<Eigen::Affine3d>* joints_ = nullptr;   // of the skin; null where there is none
  Eigen::Affine3d world_ = Eigen::Affine3d::Identity();    // of the node
  const Document* document_ = nullptr;
};

class Poses {
 public:
  explicit Poses(Document& document) : document_(document) {}

  /// Of a primitive of `mesh`, which `node` has, with the positions that the caller found. `world`: of the node.
  Pose of(const Json& node, const Json& mesh, const Json& primitive, const Accessor& positions,
          const Eigen::Affine3d& world);
  /// Whether the node's mesh has a skin.
  static bool has_skin(const Json& node) { return node.contains("skin"); }
  /// Of a node, whichever scene it is in.
  const Eigen::Affine3d& world_of(std::uint64_t node);

 private:
  void add_morphs(Pose& pose, const Json& node, const Json& mesh, const Json& primitive);
  void add_skin(Pose& pose, const Json& node, const Json& attributes);
  const std::vector<Eigen::Affine3d>& joints(std::uint64_t skin);
  void stand_up();

  Document& document_;
  std::vector<std::optional<Eigen::Affine3d>> worlds_;            // of all nodes, when one is asked for
  std::map<std::uint64_t, std::vector<Eigen::Affine3d>> joints_;  // by skin: from bind pose into the world
};

}  // namespace vantage::internal::io::gltf
