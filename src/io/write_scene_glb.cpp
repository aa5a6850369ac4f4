// glTF 2.0, binary container: y up, a node with a mesh for each object. Positions are single precision, as glTF
// demands, but relative to the node's translation, which is written in full. The document is put together as text: a
// scene may have tens of thousands of objects, and a tree of JSON values would take longer than all the rest.
#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/georeference_text.h"
#include "io/glb_container.h"
#include "io/object_text.h"
#include "io/scene_writers.h"
#include "io/writers.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

constexpr std::size_t kPositionBytes = 3 * sizeof(float);

std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// "[1,2,3]"
template <class Three>
void append_triple(std::string& text, const Three& three) {
  text += '[';
  for (int axis = 0; axis < 3; ++axis) append_exact(axis == 0 ? text : text += ',', three[axis]);
  text += ']';
}

class SceneGlb {
 public:
  explicit SceneGlb(const Scene& scene) : scene_(scene), local_(scene.mesh.vertices.size()) {}

  /// How far it has moved a vertex.
  double write(AtomicFile& file) {
    ObjectTriangles(scene_).for_each([&](std::size_t object, const std::uint32_t* first, const std::uint32_t* end) {
      add_object(object, first, end);
    });
    const std::size_t positions = buffer_.size();
    buffer_ += indices_;
    write_glb_container(document(positions), buffer_, file);
    return moved_;
  }

 private:
  /// What a vertex of the scene became, and in which object.
  struct Local {
    std::size_t object = 0;  // counted from 1
    std::uint32_t index = 0;
  };

  void add_object(std::size_t object, const std::uint32_t* first, const std::uint32_t* end) {
    const auto& [vertices, triangles] = scene_.mesh;
    Box box;
    for (const std::uint32_t* t = first; t != end; ++t) {
      for (const std::uint32_t vertex : triangles[*t]) box.extend(vertices[vertex]);
    }
    const Vec3 origin = ((box.min + box.max) / 2).array().round();
    ++count_;
    const std::size_t first_position = buffer_.size(), first_index = indices_.size();
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    std::uint32_t used = 0;
    for (const std::uint32_t* t = first; t != end; ++t) {
      for (const std::uint32_t vertex : triangles[*t]) {
        Local& local = local_[vertex];
        if (local.object != count_) {
          local = {count_, used++};
          add_position(to_y_up(vertices[vertex] - origin), low, high);
          note_moved(vertices[vertex], origin);
        }
        append_little_endian(indices_, local.index);
      }
    }
    add_accessors(used, first_position, low, high, static_cast<std::size_t>(end - first) * 3, first_index);
    add_node(object, origin);
  }

  void add_position(const Vec3& position, std::array<float, 3>& low, std::array<float, 3>& high) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<float>(position[static_cast<Eigen::Index>(axis)]);
      low[axis] = std::min(low[axis], coordinate);
      high[axis] = std::max(high[axis], coordinate);
      append_little_endian(buffer_, coordinate);
    }
  }

  /// As readers add the translation to the position.
  void note_moved(const Vec3& vertex, const Vec3& origin) {
    const Vec3 stored = (vertex - origin).cast<float>().cast<double>() + origin;
    moved_ = std::max(moved_, (stored - vertex).norm());
  }

  void add_accessors(std::size_t positions, std::size_t first_position, const std::array<float, 3>& low,
                     const std::array<float, 3>& high, std::size_t indices, std::size_t first_index) {
    std::string& text = accessors_;
    if (count_ > 1) text += ",";
    text.append(R"({"bufferView":0,"byteOffset":)").append(std::to_string(first_position));
    text.append(R"(,"componentType":)").append(std::to_string(kFloat));
    text.append(R"(,"count":)").append(std::to_string(positions)).append(R"(,"type":"VEC3","min":)");
    append_triple(text, low);
    append_triple(text += R"(,"max":)", high);
    text.append(R"(},{"bufferView":1,"byteOffset":)").append(std::to_string(first_index));
    text.append(R"(,"componentType":)").append(std::to_string(kUnsignedInt));
    text.append(R"(,"count":)").append(std::to_string(indices)).append(R"(,"type":"SCALAR"})");
  }

  void add_node(std::size_t object, const Vec3& origin) {
    const std::string name = json_text(object_name(scene_, object));
    const std::string mesh = std::to_string(count_ - 1);
    if (count_ > 1) {
      for (std::string* text : {&nodes_, &meshes_, &roots_}) *text += ",";
    }
    roots_ += mesh;
    nodes_.append(R"({"name":)").append(name).append(R"(,"mesh":)").append(mesh).append(R"(,"translation":)");
    append_triple(nodes_, to_y_up(origin));
    if (says_more_than_name(scene_.objects[object])) {
      nodes_.append(R"(,"extras":{"vantage":{"object":)").append(object_text(scene_.objects[object])).append("}}");
    }
    nodes_ += "}";
    meshes_.append(R"({"name":)").append(name).append(R"(,"primitives":[{"attributes":{"POSITION":)");
    meshes_.append(std::to_string(2 * count_ - 2)).append(R"(},"indices":)").append(std::to_string(2 * count_ - 1));
    meshes_ += R"(,"material":0}]})";
  }

  /// `positions`: bytes of the buffer that hold positions; the rest holds indices.
  std::string document(std::size_t positions) const {
    const auto view = [](std::size_t from, std::size_t size, int target) {
      return std::string(R"({"buffer":0,"byteOffset":)")
          .append(std::to_string(from).append(R"(,"byteLength":)").append(std::to_string(size)))
          .append(R"(,"target":)")
          .append(std::to_string(target));
    };
    std::string text(R"({"asset":{"version":"2.0","generator":"vantage )" VANTAGE_VERSION R"(")");
    const std::string credit = attribution_of(scene_);
    if (const std::string_view shown = credit; !shown.empty()) {
      text.append(R"(,"copyright":)").append(json_text(shown));
    }
    text += R"(},"scene":0,)";
    text.append(R"("scenes":[{"nodes":[)").append(roots_).append("]");
    std::string ours;
    if (scene_.georeference) {
      ours.append(R"("georeference":)").append(io::georeference_text(*scene_.georeference));
    }
    if (const std::vector<std::string> ledger = ledger_texts(scene_, FileObjects::apart); !ledger.empty()) {
      ours.append(ours.empty() ? "" : ",").append(R"("ledger":[)");
      for (const std::string& entry : ledger) ours.append(&entry == &ledger.front() ? "" : ",").append(entry);
      ours += "]";
    }
    if (!ours.empty()) text.append(R"(,"extras":{"vantage":{)").append(ours).append("}}");
    text.append(R"(}],"nodes":[)").append(nodes_).append(R"(],"meshes":[)").append(meshes_);
    // A light grey, seen from both sides: the surfaces need not close.
    text += R"(],"materials":[{"name":"scene","pbrMetallicRoughness":{"baseColorFactor":[0.6,0.6,0.58,1],)";
    text += R"("metallicFactor":0,"roughnessFactor":0.9},"doubleSided":true}],"accessors":[)";
    text.append(accessors_).append(R"(],"bufferViews":[)").append(view(0, positions, kArrayBuffer));
    text.append(R"(,"byteStride":)").append(std::to_string(kPositionBytes)).append("},");
    text.append(view(positions, buffer_.size() - positions, kElementArrayBuffer)).append(R"(}],"buffers":[)");
    text.append(R"({"byteLength":)").append(std::to_string(buffer_.size())).append("}]}");
    return text;
  }

  const Scene& scene_;
  std::vector<Local> local_;  // per vertex of the scene
  std::size_t count_ = 0;     // objects so far
  double moved_ = 0;          // metres, at most
  std::string buffer_, indices_;
  std::string roots_, nodes_, meshes_, accessors_;
};

}  // namespace

double write_scene_glb(const Scene& scene, AtomicFile& file) { return SceneGlb(scene).write(file); }

}  // namespace vantage::internal::io
