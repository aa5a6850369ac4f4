// A glTF file's JSON and buffers, and typed access to both with messages that name the culprit.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/mesh_codecs.h"
#include "io/mesh_source.h"

namespace vantage::internal::io::gltf {

using Json = nlohmann::json;

/// One accessor: `count` elements of `components` numbers each, in a buffer that is known to be long enough.
class Accessor {
 public:
  std::uint64_t count() const { return base_.count; }
  int components() const { return base_.components; }
  bool is_index() const { return components() == 1 && !normalized_ && is_unsigned(base_.component_type); }

  /// A number of an element as it is meant: sparse values put in, normalised integers divided.
  double number(std::uint64_t element, int component) const;
  /// The same for indices.
  std::uint64_t index(std::uint64_t element) const;

 private:
  friend class Document;

  /// Elements at regular steps in a buffer.
  struct Elements {
    const char* data = nullptr;
    std::uint64_t stride = 0, count = 0;
    std::uint64_t component_type = 0;
    int components = 0;

    std::uint64_t whole(std::uint64_t element) const;
    double number(std::uint64_t element, int component, bool normalized) const;
  };
  static bool is_unsigned(std::uint64_t component_type);

  /// The element among the sparse values, if it is there.
  std::optional<std::uint64_t> find_sparse(std::uint64_t element) const;

  Elements base_, sparse_indices_, sparse_values_;
  bool normalized_ = false;
};

/// What a tile of 3D Tiles may use besides what a file of its own may.
struct TileUse {
  bool in_tile = false;
  /// The content of a file that the tile refers to. A file of its own reads it from its own folder.
  std::function<std::string(const std::string& uri)> read_file;
};

/// The accessors of a primitive that is compressed with Draco.
struct DracoAccessors {
  Accessor indices;
  std::map<std::string, Accessor> attributes;  ///< by name: POSITION, and those that begin with "_"
};

class Document {
 public:
  /// Parses the JSON part and checks the version and the extensions.
  Document(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits,
           TileUse use = {});
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  const Json& root() const { return root_; }
  /// Bytes of all buffers that were used so far.
  std::uint64_t buffer_bytes() const { return buffer_bytes_; }

  [[noreturn]] void fail(std::string problem) const { fail_as(ErrorCode::mesh_syntax, std::move(problem)); }
  [[noreturn]] void fail_as(ErrorCode code, std::string problem) const;

  /// The items of an array that may be missing.
  const Json& array(const Json& object, const char* key) const;
  /// Item `index` of a top-level array; an object.
  const Json& item(const char* key, std::uint64_t index) const;
  /// A whole number that is not negative; nothing if the key is missing.
  std::optional<std::uint64_t> whole(const Json& object, const char* key) const;
  std::uint64_t required_whole(const Json& object, const char* key) const;
  /// A text, empty if the key is missing.
  std::string text(const Json& object, const char* key) const;
  /// Value of a JSON number that must be whole and not negative.
  std::uint64_t as_whole(const Json& value, const char* what) const;

  Accessor accessor(std::uint64_t index);
  /// The bytes of a buffer view, unpacked where they are compressed with meshoptimizer.
  std::string_view view(std::uint64_t index);
  /// Nothing if the primitive is not compressed with Draco, or also there without.
  std::optional<DracoAccessors> draco(const Json& primitive);
  /// An extension of an object, which is an object itself; nothing if it has none.
  const Json* extension(const Json& object, const char* name) const;

 private:
  void split_glb();
  void parse_json();
  void check_version_and_extensions() const;

  Accessor::Elements elements(const Json& view, std::uint64_t component_type, int components, std::uint64_t count,
                              const std::string& name);
  Accessor::Elements zeros(std::uint64_t component_type, int components, std::uint64_t count,
                           const std::string& name) const;
  bool is_required(std::string_view extension) const;
  std::string_view unpacked_view(std::uint64_t index, const Json& packed);
  const DracoMesh& unpacked_mesh(std::uint64_t view, const std::vector<std::uint32_t>& ids,
                                 std::uint64_t most_triangles);
  [[noreturn]] void fail_for_codec(const CodecProblem& problem, const std::string& where) const;
  std::string_view buffer(std::uint64_t index);
  std::string_view external_file(const std::string& uri);
  void count_held(std::uint64_t bytes);
  std::filesystem::path file_below(const std::string& relative, const std::string& uri) const;

  const MeshSource& source_;
  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
  TileUse use_;
  std::string_view json_, glb_buffer_;
  bool is_glb_ = false;
  Json root_;
  std::map<std::uint64_t, std::string_view> buffers_;    // by index
  std::map<std::string, std::string> contents_;          // of external files by path, of data URIs by index
  std::map<std::uint64_t, std::string> unpacked_views_;  // by index
  std::set<std::uint64_t> checked_sparse_;               // accessors
  std::map<std::pair<std::uint64_t, std::vector<std::uint32_t>>, DracoMesh> unpacked_meshes_;  // by view, attributes
  std::uint64_t buffer_bytes_ = 0;
  std::uint64_t held_bytes_ = 0;  // of a tile's files and of unpacked meshes
};

}  // namespace vantage::internal::io::gltf
