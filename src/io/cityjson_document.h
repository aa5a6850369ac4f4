// What stands beside the city objects in a CityJSON file: version, transform, coordinate system, vertices, templates.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/cityjson_trail.h"
#include "io/mesh_builder.h"

namespace vantage::internal::io::cityjson {

using Json = nlohmann::json;

/// Vertices that geometries refer to by number, and what they became in the mesh. Vertices at one place become one.
class Vertices {
 public:
  Vertices() = default;
  explicit Vertices(std::vector<Vec3> positions);

  std::size_t size() const { return positions_.size(); }
  const Vec3& position(std::size_t index) const { return positions_[index]; }

  /// The number of a vertex in the mesh; it is added, moved by `placement`, when it is new there.
  std::uint32_t use(std::size_t index, const Eigen::Affine3d& placement, MeshBuilder& builder);
  /// What is used from now on are other copies of the vertices: of the next instance of a template.
  void begin_instance() { ++instance_; }

 private:
  struct Known {
    std::uint64_t instance = 0;
    std::uint32_t vertex = 0;
  };
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> same_as_;  // the first vertex at the same place
  std::vector<Known> known_;
  std::uint64_t instance_ = 1;
};

/// The parts of the document that its features share.
struct Header {
  bool has_transform = false;
  Vec3 scale = Vec3::Ones(), translate = Vec3::Zero();
  std::string crs;  ///< metadata.referenceSystem, or empty
  Json templates;   ///< array of geometries
  Vertices template_vertices;
};

/// Checks type and version and reads the rest. Throws Error(input).
Header read_header(const Json& root, const Trail& trail);

/// The vertices of a document or a feature, their transform undone.
Vertices read_vertices(const Json& root, const Header& header, const Trail& trail);

/// The member `key` of an object; must be there, and be an object or an array as `type` says. A key that is nearly the
/// same is named in the message.
const Json& required(const Json& object, const char* key, Json::value_t type, const Trail& trail);

/// A whole number from 0 to below `count`; `what` is what it numbers ("vertex").
std::size_t index_below(const Json& value, std::size_t count, const char* what, const Trail& trail);

/// `count` finite numbers.
std::vector<double> numbers(const Json& array, std::size_t count, const char* what, const Trail& trail);

/// The text of a member of an object; empty where there is none.
std::string_view text_in(const Json& object, const char* key);

/// What an object's type says of it (CityJSON 2.0, chapter 2).
ObjectKind kind_of(std::string_view type);

/// Its id, name and kind.
SceneObject identity_of(const std::string& id, const Json& object);

/// Whether a type lies on the ground, so that its footprint is all of it (chapter 2, too).
bool is_flat(std::string_view type);

/// "measuredHeight", in metres: also where it is a text.
std::optional<double> height_of(const Json& object);

/// "geographicalExtent"; an empty box where it is missing or makes no sense: the object is in the ledger all the same.
Box extent_of(const Json& object);

/// Of all vertices that geometries refer to, as far as these can be read.
Box box_of_points(const Json& geometries, const Vertices& vertices);

}  // namespace vantage::internal::io::cityjson
