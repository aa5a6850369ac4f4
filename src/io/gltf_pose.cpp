#include "io/gltf_pose.h"

#include <algorithm>
#include <string>

namespace vantage::internal::io::gltf {

std::vector<double> numbers(const Document& document, const Json& object, const char* key,
                            std::vector<double> otherwise) {
  if (!object.contains(key)) return otherwise;
  const Json& values = document.array(object, key);
  if (values.size() != otherwise.size()) document.fail(std::string("\"") + key + "\" of a node has a wrong length");
  std::vector<double> result;
  for (const Json& value : values) {
    if (!value.is_number()) document.fail(std::string("\"") + key + "\" of a node holds something other than numbers");
    result.push_back(value.get<double>());
  }
  return result;
}

Eigen::Affine3d local_transform(const Document& document, const Json& node) {
  if (node.contains("matrix")) {
    const std::vector<double> columns = numbers(document, node, "matrix", std::vector<double>(16));
    Eigen::Affine3d transform;
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(columns.data());
    return transform;
  }
  const auto t = numbers(document, node, "translation", {0, 0, 0});
  const auto r = numbers(document, node, "rotation", {0, 0, 0, 1});  // x, y, z, w
  const auto s = numbers(document, node, "scale", {1, 1, 1});
  return Eigen::Translation3d(t[0], t[1], t[2]) * Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized() *
         Eigen::Scaling(s[0], s[1], s[2]);
}

Vec3 Pose::at(std::uint64_t vertex) const {
  const auto vector = [vertex](const Accessor& values) {
    return Vec3(values.number(vertex, 0), values.number(vertex, 1), values.number(vertex, 2));
  };
  Vec3 position = vector(positions_);
  for (const auto& [weight, offsets] : morphs_) position += weight * vector(offsets);
  if (!joints_) return world_ * position;
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (const auto& [joints, weights_of] : influences_) {
    for (int k = 0; k < 4; ++k) {
      const double weight = weights_of.number(vertex, k);
      if (weight == 0) continue;
      const double joint = joints.number(vertex, k);
      if (!(joint >= 0 && joint < static_cast<double>(joints_->size()))) {
        document_->fail("a vertex is moved by a joint that its skin does not have");
      }
      sum += weight * ((*joints_)[static_cast<std::size_t>(joint)] * position);
      weights += weight;
    }
  }
  if (!(weights > 0)) document_->fail("the weights of a vertex that a skin moves are 0");
  return sum / weights;  // they are 1 together but for their rounding
}

Pose Poses::of(const Json& node, const Json& mesh, const Json& primitive, const Accessor& positions,
               const Eigen::Affine3d& world) {
  Pose pose;
  pose.document_ = &document_;
  pose.positions_ = positions;
  pose.world_ = world;
  add_morphs(pose, node, mesh, primitive);
  if (has_skin(node)) add_skin(pose, node, primitive["attributes"]);
  return pose;
}

void Poses::add_morphs(Pose& pose, const Json& node, const Json& mesh, const Json& primitive) {
  const Json& targets = document_.array(primitive, "targets");
  if (targets.empty()) return;
  const Json& holder = node.contains("weights") ? node : mesh;
  const std::vector<double> weights = numbers(document_, holder, "weights", std::vector<double>(targets.size()));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (!targets[i].is_object()) document_.fail("a morph target is not an object");
    const auto index = document_.whole(targets[i], "POSITION");
    if (weights[i] == 0 || !index) continue;
    const Accessor offsets = document_.accessor(*index);
    if (offsets.components() != 3 || offsets.count() != pose.count()) {
      document_.fail("a morph target does not move all vertices of its primitive");
    }
    pose.morphs_.emplace_back(weights[i], offsets);
  }
}

/// Primitives without joints are moved by the node.
void Poses::add_skin(Pose& pose, const Json& node, const Json& attributes) {
  for (int set = 0;; ++set) {
    const std::string end = "_" + std::to_string(set);
    const auto joints = document_.whole(attributes, ("JOINTS" + end).c_str());
    const auto weights = document_.whole(attributes, ("WEIGHTS" + end).c_str());
    if (!joints || !weights) break;
    const std::pair<Accessor, Accessor> influence(document_.accessor(*joints), document_.accessor(*weights));
    for (const Accessor& values : {influence.first, influence.second}) {
      if (values.components() == 4 && values.count() == pose.count()) continue;
      document_.fail("the joints or weights of a skin are not four for each vertex");
    }
    pose.influences_.push_back(influence);
  }
  if (!pose.influences_.empty()) pose.joints_ = &joints(document_.required_whole(node, "skin"));
}

const std::vector<Eigen::Affine3d>& Poses::joints(std::uint64_t skin) {
  if (const auto known = joints_.find(skin); known != joints_.end()) return known->second;
  const Json& described = document_.item("skins", skin);
  const Json& nodes = document_.array(described, "joints");
  if (nodes.empty()) document_.fail("a skin has no joints");
  std::optional<Accessor> inverse;
  if (const auto index = document_.whole(described, "inverseBindMatrices")) {
    inverse = document_.accessor(*index);
    if (inverse->components() != 16 || inverse->count() < nodes.size()) {
      document_.fail("a skin has no inverse bind matrix for each of its joints");
    }
  }
  std::vector<Eigen::Affine3d> result;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Eigen::Affine3d bind = Eigen::Affine3d::Identity();
    for (int k = 0; inverse && k < 16; ++k) bind.matrix()(k % 4, k / 4) = inverse->number(i, k);
    result.push_back(world_of(document_.as_whole(nodes[i], "joints")) * bind);
  }
  return joints_[skin] = std::move(result);
}

const Eigen::Affine3d& Poses::world_of(std::uint64_t node) {
  if (worlds_.empty()) stand_up();
  document_.item("nodes", node);  // throws where there is none
  if (!worlds_[node]) document_.fail("node " + std::to_string(node) + ", a joint, is its own parent");
  return *worlds_[node];
}

/// The transforms of all nodes, from those without a parent on. Nodes that are their own parents get none.
void Poses::stand_up() {
  const std::size_t count = document_.array(document_.root(), "nodes").size();
  worlds_.resize(count);
  std::vector<std::optional<std::uint64_t>> parent(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (const Json& child : document_.array(document_.item("nodes", i), "children")) {
      const std::uint64_t index = document_.as_whole(child, "children");
      if (index < count) parent[index] = i;
    }
  }
  std::vector<std::uint64_t> waiting;
  for (std::size_t i = 0; i < count; ++i) {
    if (!parent[i]) waiting.push_back(i);
  }
  while (!waiting.empty()) {
    const std::uint64_t node = waiting.back();
    waiting.pop_back();
    const Json& described = document_.item("nodes", node);
    const Eigen::Affine3d above = parent[node] ? *worlds_[*parent[node]] : Eigen::Affine3d::Identity();
    worlds_[node] = above * local_transform(document_, described);
    for (const Json& child : document_.array(described, "children")) {
      const std::uint64_t index = document_.as_whole(child, "children");
      if (index < count && parent[index] == node && !worlds_[index]) waiting.push_back(index);
    }
  }
}

}  // namespace vantage::internal::io::gltf
