#include "tiles/document.h"

#include <array>
#include <cmath>
#include <utility>

#include "geo/ellipsoid.h"
#include "io/json_text.h"
#include "io/tileset.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

// Extensions that a tileset may require: what they add is read, is checked, or says nothing of shapes.
constexpr std::array<std::string_view, 7> kKnownExtensions = {
    "3DTILES_content_gltf",       "3DTILES_implicit_tiling", "3DTILES_multiple_contents",    "3DTILES_metadata",
    "3DTILES_bounding_volume_S2", "3DTILES_ellipsoid",       "3DTILES_batch_table_hierarchy"};

const Json* find_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

const Json* extension_of(const Json& object, const char* name) {
  const Json* const extensions = find_in(object, "extensions");
  return extensions && extensions->is_object() ? find_in(*extensions, name) : nullptr;
}

}  // namespace

bool is_tileset_text(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string_view::npos && bytes[first] == '{' && io::is_tileset(bytes);
}

TilesetDocument::TilesetDocument(std::string address, std::string shown, std::string_view text,
                                 const core::ProgressReporter& progress, const core::ReadLimits& limits)
    : address_(std::move(address)), shown_(std::move(shown)) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  try {
    io::MeasuredJson parsed = io::parse_json_measured(text, progress, limits);
    json_ = std::move(parsed.value);
    memory_bytes_ = parsed.bytes;
  } catch (const io::JsonProblem& problem) {
    std::string where = shown_;
    if (problem.line > 0) {
      where.append(", line ").append(std::to_string(problem.line));
      where.append(", column ").append(std::to_string(problem.column));
    }
    throw Error(ErrorCode::mesh_syntax, "not a valid tileset: " + problem.text, where,
                "export the tileset again; it is cut off or garbled");
  }
  if (!json_.is_object()) fail("its JSON is not an object");
  check_version(json_);
  check_ellipsoid(json_);
  root_ = find_in(json_, "root");
  if (!root_ || !root_->is_object()) fail("it has no \"root\"");
  error_m_ = number(json_, "geometricError").value_or(0);
}

void TilesetDocument::fail(const std::string& problem) const {
  throw Error(ErrorCode::mesh_syntax, "not a valid tileset: " + problem, shown_,
              "export the tileset again; it is cut off or garbled");
}

/// Of the extension 3DTILES_ellipsoid: the earth's, or none is named.
void TilesetDocument::check_ellipsoid(const Json& json) {
  const Json* const ellipsoid = extension_of(json, "3DTILES_ellipsoid");
  const Json* const radii = ellipsoid && ellipsoid->is_object() ? find_in(*ellipsoid, "radii") : nullptr;
  if (!radii) return;
  constexpr double kSame = 1;  // metres
  const std::array<double, 3> earth{geo::kEquatorM, geo::kEquatorM, geo::kEquatorM * (1 - geo::kFlattening)};
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_number = radii->is_array() && radii->size() == 3 && (*radii)[i].is_number();
    if (is_number && std::abs((*radii)[i].get<double>() - earth[i]) <= kSame) continue;
    throw Error(ErrorCode::mesh_unsupported, "the tileset is about another ellipsoid than WGS 84", shown_,
                "give a tileset of the earth");
  }
}

void TilesetDocument::check_version(const Json& json) {
  const Json* const asset = find_in(json, "asset");
  if (!asset || !asset->is_object()) fail("it has no \"asset\"");
  const Json* const version = find_in(*asset, "version");
  if (!version || !version->is_string()) fail("its \"asset\" has no \"version\"");
  const std::string stated = version->get<std::string>();
  if (stated != "0.0" && stated != "1.0" && stated != "1.1") {
    throw Error(ErrorCode::mesh_unsupported, "3D Tiles of version " + stated + " cannot be read", shown_,
                "export the tileset as 3D Tiles 1.0 or 1.1");
  }
  if (const Json* const up = find_in(*asset, "gltfUpAxis"); up && up->is_string()) {
    if (*up == "x" || *up == "X") up_ = GltfUp::x;
    if (*up == "z" || *up == "Z") up_ = GltfUp::z;
  }
  const Json* const required = find_in(json, "extensionsRequired");
  if (!required) return;
  if (!required->is_array()) fail("\"extensionsRequired\" is not an array");
  for (const Json& name : *required) {
    bool is_known = false;
    for (const std::string_view known : kKnownExtensions) is_known = is_known || name == known;
    if (is_known) continue;
    throw Error(ErrorCode::mesh_unsupported,
                "the tileset requires the extension " + (name.is_string() ? name.get<std::string>() : name.dump()) +
                    ", which cannot be read",
                shown_, "export the tileset without it");
  }
}

std::optional<double> TilesetDocument::number(const Json& object, const char* key) const {
  const Json* const found = find_in(object, key);
  if (!found) return std::nullopt;
  const double value = found->is_number() ? found->get<double>() : NAN;
  if (!(value >= 0) || !std::isfinite(value)) fail(std::string("\"") + key + "\" is not a number of 0 or more");
  return value;
}

void TilesetDocument::read_contents(const Json& described, Tile& tile) const {
  std::vector<ContentName>& found = tile.contents;
  const auto add = [&](const Json& content) {
    if (!content.is_object()) fail("a \"content\" is not an object");
    const Json* uri = find_in(content, "uri");
    if (!uri) uri = find_in(content, "url");
    if (!uri || !uri->is_string()) fail("a \"content\" has no \"uri\"");
    const Json* const bounds = find_in(content, "boundingVolume");
    found.push_back({uri->get<std::string>(), bounds ? parse_volume(*bounds) : Everywhere{}});
  };
  const auto add_all = [&](const Json& several) {
    if (!several.is_array()) fail("\"contents\" is not an array");
    for (const Json& content : several) add(content);
  };
  if (const Json* const content = find_in(described, "content")) add(*content);
  if (const Json* const several = find_in(described, "contents")) add_all(*several);
  if (const Json* const multiple = extension_of(described, "3DTILES_multiple_contents")) {
    const Json* const list = multiple->is_object() ? find_in(*multiple, "contents") : nullptr;
    const Json* const older = multiple->is_object() ? find_in(*multiple, "content") : nullptr;
    const std::size_t own = found.size();
    if (list || older) add_all(list ? *list : *older);
    tile.extension_contents = found.size() - own;
    // The extension forbids a "content" beside it. Where there is one for older programs it is one of the others.
    for (std::size_t i = own; i < found.size() && own == 1; ++i) {
      if (found[i].uri != found[0].uri) continue;
      found.erase(found.begin());
      break;
    }
  }
}

Tile TilesetDocument::tile(const Json& described) const {
  if (!described.is_object()) fail("a tile is not an object");
  Tile tile;
  try {
    if (const Json* const bounds = find_in(described, "boundingVolume")) tile.bounds = parse_volume(*bounds);
    read_contents(described, tile);
  } catch (const std::string& problem) {
    fail(problem);
  }
  if (const Json* const transform = find_in(described, "transform")) {
    if (!transform->is_array() || transform->size() != 16) fail("a \"transform\" does not hold 16 numbers");
    for (int i = 0; i < 16; ++i) {
      const Json& value = (*transform)[static_cast<std::size_t>(i)];
      const double entry = value.is_number() ? value.get<double>() : NAN;
      if (!std::isfinite(entry)) fail("a \"transform\" holds something other than numbers");
      tile.transform.matrix()(i % 4, i / 4) = entry;
    }
    if (tile.transform.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) fail("a \"transform\" is not affine");
  }
  tile.error_m = number(described, "geometricError");
  if (const Json* const refine = find_in(described, "refine")) {
    const std::string word = refine->is_string() ? refine->get<std::string>() : "";
    const bool is_add = word == "ADD" || word == "add";
    if (!is_add && word != "REPLACE" && word != "replace") fail("\"refine\" is neither ADD nor REPLACE");
    tile.refinement = is_add ? Refinement::add : Refinement::replace;
  }
  tile.implicit = find_in(described, "implicitTiling");
  if (!tile.implicit) tile.implicit = extension_of(described, "3DTILES_implicit_tiling");
  if (tile.implicit && !tile.implicit->is_object()) fail("\"implicitTiling\" is not an object");
  tile.children = find_in(described, "children");
  if (tile.children && !tile.children->is_array()) fail("\"children\" is not an array");
  if (tile.children && tile.children->empty()) tile.children = nullptr;
  return tile;
}

}  // namespace vantage::internal::tiles
