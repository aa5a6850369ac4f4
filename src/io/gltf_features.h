// Features of glTF (EXT_mesh_features, EXT_instance_features and EXT_structural_metadata, 3D Tiles 1.1; _BATCHID of
// b3dm, 3D Tiles 1.0): to whom of a primitive's vertices or a node's instances belong.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "io/feature_identity.h"
#include "io/gltf_document.h"

namespace vantage::internal::io::gltf {

/// An id for each vertex or instance, and the table that describes these.
struct FeatureIds {
  static constexpr std::uint64_t kNoTable = ~std::uint64_t{0}, kBatchTable = kNoTable - 1;
  std::uint64_t table = kNoTable;  ///< index of a property table
  std::optional<Accessor> values;  ///< nothing: the element's own number
  std::optional<std::uint64_t> null_id;

  /// Nothing: it belongs to no feature.
  std::optional<std::uint64_t> of(std::uint64_t element) const;
};

class Features {
 public:
  using Batch = std::function<SceneObject(std::uint64_t id)>;

  /// `batch`: the batch table of a b3dm, for _BATCHID; may be empty. `tile`: for ids of features without one.
  Features(Document& document, Batch batch, std::string tile)
      : document_(document), batch_(std::move(batch)), tile_(std::move(tile)) {}

  /// Nothing where the primitive has none. `attributes`: by name, as far as they are known already.
  std::optional<FeatureIds> of_primitive(const Json& primitive, const std::map<std::string, Accessor>& attributes);
  /// The same for instances of a node.
  std::optional<FeatureIds> of_node(const Json& node);

  /// A property that cannot be read is taken as missing.
  SceneObject identity(std::uint64_t table, std::uint64_t id);
  const UnreadableProperties& unreadable() const { return unreadable_; }
  /// Primitives with a set of features by texture, each time that one was asked for.
  std::uint64_t by_texture() const { return by_texture_; }

 private:
  struct Table {
    const Json* properties = nullptr;
    const Json* classes = nullptr;  ///< properties of its class
    std::uint64_t count = 0;
    IdentityProperties known;
  };

  const Json* member(const Json& object, const char* key) const;
  const Table* table(std::uint64_t index);
  const Table* table_or_nothing(std::uint64_t index);
  std::optional<FeatureIds> best_of(const Json& sets, const std::function<Accessor(const std::string&)>& attribute);
  std::string value_or_nothing(const Table& table, const std::string& property, std::uint64_t row);
  std::string value(const Table& table, const std::string& property, std::uint64_t row);
  std::string text_value(const Json& property, std::uint64_t row, std::uint64_t count);

  Document& document_;
  Batch batch_;
  std::string tile_;
  std::map<std::uint64_t, Table> tables_;
  UnreadableProperties unreadable_;
  std::uint64_t by_texture_ = 0;
};

}  // namespace vantage::internal::io::gltf
