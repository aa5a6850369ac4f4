// tileset.json (3D Tiles 1.0, OGC 18-053r2, and 1.1, OGC 22-025r4): its tiles, as the file describes them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress_reporter.h"
#include "core/read_limits.h"
#include "tiles/bounds.h"

namespace vantage::internal::tiles {

enum class Refinement { add, replace };
enum class GltfUp { x, y, z };  ///< "gltfUpAxis", of files before 1.0

struct ContentName {
  std::string uri;
  Volume bounds = Everywhere{};  ///< in the tile's coordinates
};

/// A tile, in its own coordinates. `implicit` and `children` point into the document.
struct Tile {
  Volume bounds = Everywhere{};
  Transform transform = Transform::Identity();  ///< into its parent's coordinates
  std::optional<double> error_m;
  std::optional<Refinement> refinement;
  std::vector<ContentName> contents;
  std::size_t extension_contents = 0;  ///< how many of them, the last, are of 3DTILES_multiple_contents
  const Json* implicit = nullptr;
  const Json* children = nullptr;  ///< an array, or nothing
};

/// A tileset.json that was read.
class TilesetDocument {
 public:
  /// `shown`: for errors. Throws Error(input) for what is no tileset.
  TilesetDocument(std::string address, std::string shown, std::string_view text, const core::ProgressReporter& progress,
                  const core::ReadLimits& limits);

  const std::string& address() const { return address_; }
  const std::string& shown() const { return shown_; }
  const Json& root() const { return *root_; }
  double error_m() const { return error_m_; }
  /// Memory that the parsed text takes, about.
  std::uint64_t memory_bytes() const { return memory_bytes_; }
  GltfUp gltf_up() const { return up_; }

  /// Throws Error(input) for one that is garbled.
  Tile tile(const Json& described) const;
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  void check_version(const Json& json);
  void check_ellipsoid(const Json& json);
  void read_contents(const Json& described, Tile& tile) const;
  std::optional<double> number(const Json& object, const char* key) const;

  std::string address_, shown_;
  Json json_;
  std::uint64_t memory_bytes_ = 0;
  const Json* root_ = nullptr;
  double error_m_ = 0;
  GltfUp up_ = GltfUp::y;
};

/// Whether these bytes are a tileset.json, and no glTF.
bool is_tileset_text(std::string_view bytes);

}  // namespace vantage::internal::tiles
