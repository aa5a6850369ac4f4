// glTF 2.0 and GLB (Khronos Group, glTF 2.0 Specification, ISO/IEC 12113:2022): the triangles of the default scene's
// nodes, each moved by its node, its skin and its default morph weights. Materials are passed over, and so are
// animations: nodes stand where they do without. What else is not built is in the ledger.
#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/text.h"
#include "io/georeference_text.h"
#include "io/gltf_document.h"
#include "io/gltf_features.h"
#include "io/gltf_tile.h"
#include "io/mesh_builder.h"
#include "io/mesh_readers.h"
#include "io/object_text.h"
#include "io/rounding_text.h"

namespace vantage::internal::io {
namespace {

using gltf::Accessor;
using gltf::Document;
using gltf::FeatureIds;
using gltf::Json;

// ---- where vertices are

/// By its matrix, or by translation, rotation and scale.
Eigen::Affine3d local_transform(const Document& document, const Json& node);

/// `otherwise.size()` numbers, or `otherwise` if the key is missing.
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
    constexpr double kRounding = 1e-6;
    if ((transform.matrix().row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kRounding) {
      document.fail("the last row of the \"matrix\" of a node is not 0, 0, 0, 1");
    }
    transform.makeAffine();
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

// ---- the reader

enum PrimitiveMode { kTriangleList = 4, kTriangleStrip, kTriangleFan };

class GltfReader {
 public:
  /// `tile`: of 3D Tiles, or nothing for a file of its own.
  GltfReader(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits,
             const TileContext* tile = nullptr)
      : progress_(progress),
        limits_(limits),
        tile_(tile),
        document_(source, progress, limits, tile ? gltf::TileUse{true, tile->read_file} : gltf::TileUse{}),
        builder_(source, MeshFormat::gltf, MeshBuilder::PlaceUnit::byte, limits) {
    if (tile) features_.emplace(document_, tile->batch, tile->name);
  }

  RawMesh read() {
    struct Visit {
      std::uint64_t node;
      Eigen::Affine3d parent;
      bool is_hidden = false;
    };
    std::vector<Visit> waiting;  // a stack: first come, last served
    const std::vector<std::uint64_t> roots = root_nodes();
    for (auto root = roots.rbegin(); root != roots.rend(); ++root)
      waiting.push_back({*root, Eigen::Affine3d::Identity()});
    nodes_ = document_.array(document_.root(), "nodes").size();
    std::vector<bool> seen(nodes_, false);
    while (!waiting.empty()) {
      const Visit visit = waiting.back();
      waiting.pop_back();
      const Json& node = document_.item("nodes", visit.node);
      if (seen[visit.node]) document_.fail("node " + std::to_string(visit.node) + " has two parents, or is its own");
      seen[visit.node] = true;
      progress_.report(visited_++, nodes_);

      const Eigen::Affine3d world = visit.parent * local_transform(document_, node);
      const bool hidden = visit.is_hidden || is_hidden(node);
      hidden_ += hidden && !visit.is_hidden ? 1 : 0;
      const auto mesh = document_.whole(node, "mesh");
      if (mesh && !hidden) add_node(node, document_.item("meshes", *mesh), world);
      const Json& children = document_.array(node, "children");
      for (auto child = children.rbegin(); child != children.rend(); ++child) {
        waiting.push_back({document_.as_whole(*child, "children"), world, hidden});
      }
    }
    pass_coarser(seen);
    tell_other_scenes(seen);
    RawMesh mesh = builder_.finish();
    mesh.georeference = georeference();
    mesh.rounding_m = rounding();
    mesh.ledger = ledger();
    if (hidden_ > 0) {
      mesh.notes.push_back(core::count_text(hidden_, "node is hidden", "nodes are hidden") +
                           " by the file (KHR_node_visibility), with all below: not built");
    }
    return mesh;
  }

  /// What is not built, also where there is nothing else.
  std::vector<Missing> ledger() const {
    std::vector<Missing> ledger;
    for (const Unbuilt& unbuilt : unbuilt_) ledger.push_back(told(unbuilt));
    if (elsewhere_) ledger.push_back({*elsewhere_, {}});
    for (Missing& missing : stated_ledger()) ledger.push_back(std::move(missing));
    return ledger;
  }

  UnreadableProperties unreadable_properties() const {
    return features_ ? features_->unreadable() : UnreadableProperties{};
  }

  std::uint64_t features_by_texture() const { return features_ ? features_->by_texture() : 0; }

  /// CESIUM_RTC (Cesium): what all positions are about.
  Vec3 center() const {
    const Json* const about = document_.extension(document_.root(), "CESIUM_RTC");
    if (!about) return Vec3::Zero();
    const std::vector<double> center = numbers(document_, *about, "center", {0, 0, 0});
    return {center[0], center[1], center[2]};
  }

 private:
  /// KHR_node_visibility.
  bool is_hidden(const Json& node) const {
    const Json* const visibility = document_.extension(node, "KHR_node_visibility");
    return visibility && visibility->value("visible", Json(true)) == Json(false);
  }

  /// The "extras" of the default scene and, as others may move them there, of other scenes and the asset.
  std::vector<const Json*> extras() const {
    const Json& root = document_.root();
    const Json& scenes = document_.array(root, "scenes");
    std::vector<const Json*> holders, extras;
    if (!scenes.empty()) holders.push_back(&document_.item("scenes", document_.whole(root, "scene").value_or(0)));
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      if (const Json* const scene = &document_.item("scenes", i); scene != holders.front()) holders.push_back(scene);
    }
    if (const auto asset = root.find("asset"); asset != root.end()) holders.push_back(&*asset);
    for (const Json* holder : holders) {
      if (const auto found = holder->find("extras"); found != holder->end()) extras.push_back(&*found);
    }
    return extras;
  }

  /// Where nodes stand that vantage wrote at the root, moved alone: other programs put one node about all of them.
  /// Nothing where they were changed in another way.
  std::optional<Eigen::Affine3d> moved_by_others() const {
    Eigen::Affine3d moved = Eigen::Affine3d::Identity();
    std::vector<std::uint64_t> nodes = root_nodes();
    while (nodes.size() == 1) {
      const Json& about = document_.item("nodes", nodes.front());
      const Json& children = document_.array(about, "children");
      if (children.empty()) break;
      moved = moved * local_transform(document_, about);
      nodes.clear();
      for (const Json& child : children) nodes.push_back(document_.as_whole(child, "children"));
    }
    for (const std::uint64_t i : nodes) {
      const Json& node = document_.item("nodes", i);
      const bool is_moved_alone = local_transform(document_, node).linear().isIdentity(0);
      if (!is_moved_alone || !document_.array(node, "children").empty()) return std::nullopt;
    }
    return moved;
  }

  /// The ledgers that vantage wrote: of the scene, z up.
  std::vector<Missing> stated_ledger() const {
    std::vector<Missing> ledger;
    try {
      for (const Json* extras : extras()) {
        for (Missing& missing : ledger_in(*extras)) ledger.push_back(std::move(missing));
      }
    } catch (const LedgerProblem& problem) {
      document_.fail(problem.text);
    }
    if (ledger.empty()) return ledger;
    const auto moved = moved_by_others();
    const bool is_as_written = moved && moved->isApprox(Eigen::Affine3d::Identity(), 0);
    for (auto& [entry, holder, is_stated] : ledger) {
      if (!is_as_written) entry.outlines.clear();
      if (!entry.box) continue;
      const Vec3 low = entry.box->min, high = entry.box->max;
      entry.box = Box{Vec3(low.x(), low.z(), -high.y()), Vec3(high.x(), high.z(), -low.y())};
      if (is_as_written) continue;
      Box box;
      for (const Vec3& corner : box_mesh(*entry.box).vertices) box.extend(moved ? *moved * corner : corner);
      const bool is_place = moved && box.min.allFinite() && box.max.allFinite();
      entry.box = is_place ? std::optional(box) : std::nullopt;
      if (!is_place) entry.stand_in.reset();
    }
    return ledger;
  }

  std::optional<Georeference> georeference() const {
    for (const Json* extras : extras()) {
      const Json* found = georeference_in(*extras);
      if (!found) continue;
      try {
        return parse_georeference(*found);
      } catch (const GeoreferenceProblem& problem) {
        document_.fail(problem.text);
      }
    }
    return std::nullopt;
  }

  /// In the "extras" of the asset.
  std::optional<double> rounding() const {
    const auto asset = document_.root().find("asset");
    if (asset == document_.root().end() || !asset->is_object()) return std::nullopt;
    const auto extras = asset->find("extras");
    if (extras == asset->end()) return std::nullopt;
    try {
      return rounding_in(*extras);
    } catch (const RoundingProblem& problem) {
      document_.fail(problem.text);
    }
  }

  /// The nodes of the default scene; of the first scene where none is the default; without scenes the nodes that are
  /// nobody's children.
  std::vector<std::uint64_t> root_nodes() const {
    std::vector<std::uint64_t> roots;
    const Json& root = document_.root();
    if (!document_.array(root, "scenes").empty()) {
      const Json& scene = document_.item("scenes", document_.whole(root, "scene").value_or(0));
      for (const Json& node : document_.array(scene, "nodes")) roots.push_back(document_.as_whole(node, "nodes"));
      return roots;
    }
    const std::size_t count = document_.array(root, "nodes").size();
    std::vector<bool> is_child(count, false);
    for (std::size_t i = 0; i < count; ++i) {
      for (const Json& child : document_.array(document_.item("nodes", i), "children")) {
        const std::uint64_t index = document_.as_whole(child, "children");
        if (index < count) is_child[index] = true;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_child[i]) roots.push_back(i);
    }
    return roots;
  }

  void add_node(const Json& node, const Json& mesh, const Eigen::Affine3d& world) {
    const Json* const instances = document_.extension(node, "EXT_mesh_gpu_instancing");
    if (!instances) {
      add_object(node, mesh);
      add_mesh(node, mesh, world);
      return;
    }
    if (Poses::has_skin(node)) {
      document_.fail_as(ErrorCode::mesh_unsupported, "a node has both a skin and instances, which cannot be read");
    }
    const auto ids = features_ ? features_->of_node(node) : std::nullopt;
    const auto attributes = instances->find("attributes");
    if (attributes == instances->end() || !attributes->is_object()) document_.fail("instances have no \"attributes\"");
    const auto positions = instance_values(*attributes, "TRANSLATION", 3);
    const auto rotations = instance_values(*attributes, "ROTATION", 4);
    const auto scales = instance_values(*attributes, "SCALE", 3);
    const std::uint64_t count = instance_count(*attributes);
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto value = [i](const std::optional<Accessor>& values, int component, double otherwise) {
        return values ? values->number(i, component) : otherwise;
      };
      const Eigen::Affine3d placed =
          Eigen::Translation3d(value(positions, 0, 0), value(positions, 1, 0), value(positions, 2, 0)) *
          Eigen::Quaterniond(value(rotations, 3, 1), value(rotations, 0, 0), value(rotations, 1, 0),
                             value(rotations, 2, 0))
              .normalized() *
          Eigen::Scaling(value(scales, 0, 1), value(scales, 1, 1), value(scales, 2, 1));
      const auto id = ids ? ids->of(i) : std::nullopt;
      if (id) {
        set_feature(ids->table, *id);
      } else {
        add_object(node, mesh);
      }
      add_mesh(node, mesh, world * placed);
      progress_.tick(visited_, nodes_);
    }
  }

  /// Every attribute has a value for each instance, also one that moves nothing.
  std::uint64_t instance_count(const Json& attributes) {
    if (attributes.empty()) document_.fail("instances have no attributes, which would tell how many there are");
    std::optional<std::uint64_t> count;
    bool is_backed = false;  // by a buffer that is known to be long enough
    for (const auto& [name, index] : attributes.items()) {
      const std::uint64_t accessor = document_.as_whole(index, "attributes");
      const std::uint64_t own = document_.required_whole(document_.item("accessors", accessor), "count");
      if (count && *count != own) document_.fail("the attributes of instances differ in length");
      count = own;
      is_backed = is_backed || name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
    }
    if (!is_backed) document_.accessor(document_.as_whole(*attributes.begin(), "attributes"));
    return *count;
  }

  std::optional<Accessor> instance_values(const Json& attributes, const char* name, int components) {
    const auto index = document_.whole(attributes, name);
    if (!index) return std::nullopt;
    Accessor values = document_.accessor(*index);
    if (values.components() != components) document_.fail(std::string(name) + " of instances has a wrong type");
    return values;
  }

  /// The object of a node, for all that belongs to no feature.
  void add_object(const Json& node, const Json& mesh) {
    std::string name = document_.text(node, "name");
    if (name.empty()) name = document_.text(mesh, "name");
    object_ = builder_.add_object(name);
    if (tile_) builder_.identify_object(object_, {name, tile_->name, object_named(name).kind});
    if (const auto extras = node.find("extras"); extras != node.end()) {
      const auto stated = object_in(*extras);
      if (stated && display_name(*stated) == name) builder_.identify_object(object_, *stated);
    }
  }

  /// Goes on with the object of a feature, which all primitives and nodes share.
  void set_feature(std::uint64_t table, std::uint64_t id) {
    const auto [entry, is_new] = object_of_feature_.try_emplace({table, id}, 0);
    if (is_new) {
      entry->second = builder_.add_object("");
      builder_.identify_object(entry->second, features_->identity(table, id));
    }
    object_ = entry->second;
    builder_.set_object(object_);
  }

  void add_mesh(const Json& node, const Json& mesh, const Eigen::Affine3d& world) {
    const std::uint32_t own = object_;
    for (const Json& primitive : document_.array(mesh, "primitives")) {
      if (!primitive.is_object()) document_.fail("a primitive is not an object");
      const std::uint64_t mode = document_.whole(primitive, "mode").value_or(kTriangleList);
      object_ = own;
      builder_.set_object(own);
      add_primitive({node, mesh, primitive, world}, mode);
    }
  }

  struct Placed {
    const Json &node, &mesh, &primitive;
    const Eigen::Affine3d& world;  // of the node
  };

  void add_primitive(const Placed& placed, std::uint64_t mode) {
    const Json& primitive = placed.primitive;
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) document_.fail("a primitive has no \"attributes\"");
    const auto position_index = document_.whole(*attributes, "POSITION");
    if (!position_index) {  // the specification allows it; there is nothing to draw
      count_unbuilt(placed, Kind::unplaced, 1, std::nullopt);
      return;
    }
    if (mode < kTriangleList || mode > kTriangleFan) {
      tell_thin(placed, mode, document_.accessor(*position_index));
      return;
    }
    const auto packed = document_.draco(primitive);
    if (packed) mode = kTriangleList;  // Draco gives a list, whatever the triangles were before
    if (packed && !packed->attributes.contains("POSITION")) document_.fail("its Draco data has no positions");
    const Accessor positions = packed ? packed->attributes.at("POSITION") : document_.accessor(*position_index);
    if (positions.components() != 3) document_.fail("a primitive's positions are not of type VEC3");
    std::optional<Accessor> indices;
    if (packed) {
      indices = packed->indices;
    } else if (const auto index = document_.whole(primitive, "indices")) {
      indices = document_.accessor(*index);
      if (!indices->is_index()) document_.fail("a primitive's indices are not unsigned whole numbers");
    }
    const auto features =
        features_ ? features_->of_primitive(primitive, packed ? packed->attributes : std::map<std::string, Accessor>{})
                  : std::nullopt;
    const std::uint32_t own = object_;

    const std::uint64_t corners = indices ? indices->count() : positions.count();
    if (mode == kTriangleList && corners % 3 != 0) {
      document_.fail("a primitive has " + std::to_string(corners) + " corners: no whole number of triangles");
    }
    const std::uint64_t triangles = mode == kTriangleList ? corners / 3 : corners < 3 ? 0 : corners - 2;
    check_total(triangles);
    const Pose pose = poses_.of(placed.node, placed.mesh, primitive, positions, placed.world);
    start_vertices(positions.count());
    const bool mirrored = pose.is_mirrored();
    for (std::uint64_t i = 0; i < triangles; ++i) {
      progress_.tick(visited_, nodes_);
      // The turn of a strip's every second triangle is reversed.
      const bool odd = mode == kTriangleStrip && i % 2 == 1;
      const std::uint64_t first = mode == kTriangleList ? 3 * i : mode == kTriangleStrip ? i : 0;
      const std::uint64_t second = mode == kTriangleList ? first + 1 : i + 1;
      Triangle triangle;
      const std::array<std::uint64_t, 3> corner = {first, second, second + 1};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = vertex(indices ? indices->index(corner[k]) : corner[k], pose);
      }
      if (mirrored != odd) std::swap(triangle[1], triangle[2]);
      if (features) set_object(*features, indices ? indices->index(first) : first, own);
      builder_.add_triangle(triangle);
    }
  }

  /// What of a node's mesh is not built, all its instances together.
  enum class Kind { points, lines, unplaced };
  struct Unbuilt {
    const Json *node, *mesh;
    Kind kind;
    std::uint64_t count = 0;  // of points, or of primitives
    Box box = {};
    bool is_placed = true;  // all of it
  };

  void count_unbuilt(const Placed& placed, Kind kind, std::uint64_t count, const std::optional<Box>& box) {
    const auto [entry, is_new] = unbuilt_number_.try_emplace({&placed.node, kind}, unbuilt_.size());
    if (is_new) unbuilt_.push_back({&placed.node, &placed.mesh, kind});
    Unbuilt& unbuilt = unbuilt_[entry->second];
    unbuilt.count += count;
    unbuilt.is_placed = unbuilt.is_placed && box;
    if (box) unbuilt.box.extend(*box);
  }

  /// Points are held by their box; lines are as thin as nothing.
  Missing told(const Unbuilt& unbuilt) const {
    LedgerEntry entry;
    std::string name = document_.text(*unbuilt.node, "name");
    if (name.empty()) name = document_.text(*unbuilt.mesh, "name");
    entry.object = object_named(clean_name(name));
    if (tile_) entry.object.source_id = tile_->name;
    entry.reason = "only triangles are built";
    if (unbuilt.kind == Kind::points) entry.what = core::count_text(unbuilt.count, "point", "points");
    if (unbuilt.kind == Kind::lines) entry.what = core::count_text(unbuilt.count, "point of lines", "points of lines");
    if (unbuilt.kind == Kind::unplaced) {
      entry.what = core::count_text(unbuilt.count, "primitive without positions", "primitives without positions");
      entry.reason = "the file does not say where it is";
    }
    if (!unbuilt.is_placed || unbuilt.box.empty()) return {std::move(entry), {}};
    if (unbuilt.kind == Kind::points) return held_by_box(std::move(entry), unbuilt.box);
    entry.box = unbuilt.box;
    return {std::move(entry), {}};
  }

  void tell_thin(const Placed& placed, std::uint64_t mode, const Accessor& positions) {
    if (mode > kTriangleFan) document_.fail("a primitive has a mode that is not known");
    if (positions.components() != 3) document_.fail("a primitive's positions are not of type VEC3");
    const Pose pose = poses_.of(placed.node, placed.mesh, placed.primitive, positions, placed.world);
    count_unbuilt(placed, mode == 0 ? Kind::points : Kind::lines, positions.count(), box_of(pose));
  }

  /// Nothing where a coordinate is not finite.
  std::optional<Box> box_of(const Pose& pose) {
    checked_points_ += pose.count();
    const std::uint64_t room = limits_.repeated_triangles + document_.buffer_bytes();
    if (checked_points_ > room) {
      document_.fail_as(ErrorCode::mesh_too_large,
                        "its nodes repeat its points and lines to more than " + std::to_string(room));
    }
    Box box;
    for (std::uint64_t i = 0; i < pose.count(); ++i) {
      progress_.tick(visited_, nodes_);
      const Vec3 point = pose.at(i);
      if (!point.allFinite()) return std::nullopt;
      box.extend(point);
    }
    return box;
  }

  /// Of a node and all below. Children are nodes of a tree: check_nodes.
  bool has_mesh(std::uint64_t index) const {
    const Json& node = document_.item("nodes", index);
    const Json& children = document_.array(node, "children");
    return node.contains("mesh") || std::any_of(children.begin(), children.end(), [&](const Json& child) {
             return has_mesh(document_.as_whole(child, "children"));
           });
  }

  /// Marks the nodes, and all below, that are coarser forms of nodes that are seen and have any form (MSFT_lod).
  void pass_coarser(std::vector<bool>& seen) const {
    std::vector<std::uint64_t> waiting;
    const auto wait_for = [&](const Json& holder, const char* key) {
      for (const Json& index : document_.array(holder, key)) waiting.push_back(document_.as_whole(index, key));
    };
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Json* const levels = seen[i] ? document_.extension(document_.item("nodes", i), "MSFT_lod") : nullptr;
      if (levels && has_mesh(i)) wait_for(*levels, "ids");
    }
    while (!waiting.empty()) {
      const std::uint64_t index = waiting.back();
      waiting.pop_back();
      const Json& node = document_.item("nodes", index);
      if (!seen[index]) wait_for(node, "children");
      seen[index] = true;
    }
  }

  /// Meshes that only other scenes than the default one have, or none, and where, if all of them can be placed.
  void tell_other_scenes(const std::vector<bool>& seen) {
    LedgerEntry entry;
    std::size_t count = 0;
    std::optional<Box> box = Box{};
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Json& node = document_.item("nodes", i);
      if (seen[i] || !node.contains("mesh")) continue;
      if (count++ == 0) entry.object.name = clean_name(document_.text(node, "name"));
      if (box) box = with_unseen(*box, i);
    }
    if (count == 0) return;
    entry.what = core::count_text(count, "node with a mesh", "nodes with meshes");
    entry.reason = "not in the default scene of the file, but in another one or in none";
    if (box && !box->empty()) entry.box = box;
    elsewhere_ = std::move(entry);
  }

  /// A box grown by the mesh of a node that the default scene does not have; nothing where that cannot be placed. What
  /// is garbled there is no error.
  std::optional<Box> with_unseen(Box box, std::uint64_t number) {
    const Json& node = document_.item("nodes", number);
    try {
      if (document_.extension(node, "EXT_mesh_gpu_instancing")) return std::nullopt;
      const Json& mesh = document_.item("meshes", document_.required_whole(node, "mesh"));
      for (const Json& primitive : document_.array(mesh, "primitives")) {
        const auto own = box_of_unseen(number, mesh, primitive);
        if (!own) return std::nullopt;
        box.extend(*own);
      }
      return box;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      return std::nullopt;
    }
  }

  std::optional<Box> box_of_unseen(std::uint64_t number, const Json& mesh, const Json& primitive) {
    if (!primitive.is_object()) return std::nullopt;
    const auto attributes = primitive.find("attributes");
    const bool has_any = attributes != primitive.end() && attributes->is_object();
    const auto positions = has_any ? document_.whole(*attributes, "POSITION") : std::nullopt;
    if (!positions || document_.draco(primitive)) return std::nullopt;
    const Accessor accessor = document_.accessor(*positions);
    if (accessor.components() != 3) return std::nullopt;
    return box_of(poses_.of(document_.item("nodes", number), mesh, primitive, accessor, poses_.world_of(number)));
  }

  /// The object of a triangle: that of the feature of its first corner, or else `own`, of the node.
  void set_object(const FeatureIds& features, std::uint64_t corner, std::uint32_t own) {
    const auto id = features.of(corner);
    if (!id) {
      builder_.set_object(own);
    } else {
      set_feature(features.table, *id);
    }
  }

  /// Nodes may repeat a mesh and primitives an accessor: a small file can describe more triangles than there is memory.
  void check_total(std::uint64_t more) const {
    const std::uint64_t room = limits_.repeated_triangles + document_.buffer_bytes() / 3;
    if (builder_.triangle_count() + more > room) {
      document_.fail_as(ErrorCode::mesh_too_large,
                        "its nodes repeat its meshes to more than " + std::to_string(room) + " triangles");
    }
  }

  /// Makes ready for the vertices of one primitive; only those that its triangles use are added.
  void start_vertices(std::uint64_t count) {
    if (vertex_of_.size() < count) vertex_of_.resize(count, {0, 0});
    ++primitive_;
  }

  std::uint32_t vertex(std::uint64_t index, const Pose& pose) {
    if (index >= pose.count()) {
      document_.fail("a primitive refers to vertex " + std::to_string(index) + ", but has only " +
                     std::to_string(pose.count()) + " (counted from 0)");
    }
    Known& known = vertex_of_[index];
    if (known.primitive != primitive_) {
      const Vec3 moved = pose.at(index);
      if (!moved.allFinite()) {
        document_.fail_as(ErrorCode::coordinate_not_finite,
                          "a coordinate of vertex " + std::to_string(index) + " is not finite");
      }
      known = {primitive_, builder_.add_vertex(moved, 0)};
    }
    return known.vertex;
  }

  /// What a vertex of an accessor became, and for which primitive.
  struct Known {
    std::uint64_t primitive;
    std::uint32_t vertex;
  };

  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
  const TileContext* tile_;
  Document document_;
  MeshBuilder builder_;
  Poses poses_{document_};
  std::vector<Unbuilt> unbuilt_;
  std::map<std::pair<const Json*, Kind>, std::size_t> unbuilt_number_;  // by node
  std::optional<LedgerEntry> elsewhere_;                                // in other scenes
  std::uint64_t hidden_ = 0, checked_points_ = 0;
  std::optional<gltf::Features> features_;
  std::uint32_t object_ = 0;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> object_of_feature_;  // table, id
  std::uint64_t visited_ = 0, nodes_ = 0;
  std::vector<Known> vertex_of_;
  std::uint64_t primitive_ = 0;
};

}  // namespace

RawMesh read_gltf(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  progress.begin("parse glTF");
  return GltfReader(source, progress, limits).read();
}

TileMesh read_gltf_tile(const MeshSource& source, const core::ProgressReporter& progress,
                        const core::ReadLimits& limits, const TileContext& tile) {
  progress.begin("parse glTF");
  GltfReader reader(source, progress, limits, &tile);
  TileMesh result;
  try {
    result.mesh = reader.read();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::mesh_empty) throw;
    result.mesh.ledger = reader.ledger();
  }
  result.center = reader.center();
  result.unreadable_properties = reader.unreadable_properties();
  result.features_by_texture = reader.features_by_texture();
  return result;
}

}  // namespace vantage::internal::io
