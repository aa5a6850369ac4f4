#include "io/gltf_document.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/json_text.h"
#include "io/mesh_readers.h"
#include "io/text_cursor.h"

namespace vantage::internal::io::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are read as little-endian");

/// kDouble is not glTF's: unpacked values.
enum ComponentType : std::uint64_t { kInt8 = 5120, kUint8, kInt16, kUint16, kUint32 = 5125, kFloat, kDouble = 5130 };

// It changes where triangles are, even if the file does not require it: about a place on the earth, which is a tile's.
constexpr const char* kTileOnly = "CESIUM_RTC";
// Extensions that a file may require: they change how surfaces look, or are understood, or are read here.
constexpr std::array<std::string_view, 15> kHarmlessPrefixes = {"KHR_materials_",
                                                                "KHR_texture_",
                                                                "EXT_texture_",
                                                                "KHR_lights_",
                                                                "MSFT_texture_",
                                                                "EXT_mesh_features",
                                                                "EXT_instance_features",
                                                                "EXT_structural_metadata",
                                                                "KHR_mesh_quantization",
                                                                "EXT_mesh_gpu_instancing",
                                                                "KHR_draco_mesh_compression",
                                                                "EXT_meshopt_compression",
                                                                "CESIUM_primitive_outline",
                                                                "KHR_node_visibility",
                                                                "KHR_xmp"};
constexpr const char* kMeshopt = "EXT_meshopt_compression";

constexpr const char* kGarbled = "export the mesh again; the file is cut off or garbled";

std::uint64_t size_of(std::uint64_t component_type) {
  switch (component_type) {
    case kInt8:
    case kUint8:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kUint32:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

int components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;
}

template <class T>
T load(const char* data) {
  T value;
  std::memcpy(&value, data, sizeof value);
  return value;
}

template <class T>
double load_number(const char* data, bool normalized) {
  const double value = load<T>(data);
  return normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Nothing if the text is not base64.
std::optional<std::string> decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    have += 6;
    if (have < 8) continue;
    have -= 8;
    out += static_cast<char>(bits >> have & 0xff);
  }
  return out;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const int lower = c | 0x20;
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

std::string decode_percent(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

}  // namespace

bool Accessor::is_unsigned(std::uint64_t component_type) {
  return component_type == kUint8 || component_type == kUint16 || component_type == kUint32;
}

std::uint64_t Accessor::Elements::whole(std::uint64_t element) const {
  const char* at = data + element * stride;
  if (component_type == kUint8) return load<std::uint8_t>(at);
  if (component_type == kUint16) return load<std::uint16_t>(at);
  return load<std::uint32_t>(at);
}

double Accessor::Elements::number(std::uint64_t element, int component, bool normalized) const {
  const std::uint64_t size = component_type == kDouble ? sizeof(double) : size_of(component_type);
  const char* at = data + element * stride + static_cast<std::uint64_t>(component) * size;
  switch (component_type) {
    case kInt8:
      return load_number<std::int8_t>(at, normalized);
    case kUint8:
      return load_number<std::uint8_t>(at, normalized);
    case kInt16:
      return load_number<std::int16_t>(at, normalized);
    case kUint16:
      return load_number<std::uint16_t>(at, normalized);
    case kUint32:
      return load_number<std::uint32_t>(at, normalized);
    case kDouble:
      return load<double>(at);
    default:
      return load<float>(at);
  }
}

std::optional<std::uint64_t> Accessor::find_sparse(std::uint64_t element) const {
  std::uint64_t low = 0, high = sparse_indices_.count;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const std::uint64_t found = sparse_indices_.whole(middle);
    if (found == element) return middle;
    (found < element ? low : high) = found < element ? middle + 1 : middle;
  }
  return std::nullopt;
}

double Accessor::number(std::uint64_t element, int component) const {
  if (const auto sparse = find_sparse(element)) return sparse_values_.number(*sparse, component, normalized_);
  return base_.number(element, component, normalized_);
}

std::uint64_t Accessor::index(std::uint64_t element) const {
  if (const auto sparse = find_sparse(element)) return sparse_values_.whole(*sparse);
  return base_.whole(element);
}

Document::Document(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits,
                   TileUse use)
    : source_(source), progress_(progress), limits_(limits), use_(std::move(use)), json_(source.bytes()) {
  if (source.bytes().starts_with("glTF")) split_glb();
  parse_json();
  check_version_and_extensions();
}

void Document::fail_as(ErrorCode code, std::string problem) const {
  source_.fail(code, "not a valid glTF file: " + std::move(problem), kGarbled);
}

/// GLB: a header of 12 bytes, then chunks, each with its length and type before it: JSON, and perhaps a buffer.
void Document::split_glb() {
  const std::string_view bytes = source_.bytes();
  is_glb_ = true;
  if (bytes.size() < 20)
    source_.fail_at_byte(ErrorCode::mesh_syntax, bytes.size(), "the GLB file ends in its header", kGarbled);
  const auto version = load<std::uint32_t>(bytes.data() + 4), length = load<std::uint32_t>(bytes.data() + 8);
  if (version != 2) {
    source_.fail_at_byte(ErrorCode::mesh_unsupported, 4, "GLB version " + std::to_string(version) + " cannot be read",
                         "export the mesh as glTF 2.0");
  }
  if (length > bytes.size()) {
    source_.fail_at_byte(
        ErrorCode::mesh_syntax, 8,
        "the GLB file announces " + std::to_string(length) + " bytes, but has only " + std::to_string(bytes.size()),
        kGarbled);
  }
  const auto chunk = [&](std::uint64_t at, std::string_view type) {
    const std::uint64_t size = load<std::uint32_t>(bytes.data() + at);
    if (bytes.substr(at + 4, 4) != type)
      source_.fail_at_byte(ErrorCode::mesh_syntax, at + 4, "a GLB chunk of unexpected type", kGarbled);
    if (size > bytes.size() - at - 8) {
      source_.fail_at_byte(ErrorCode::mesh_syntax, at,
                           "a GLB chunk of " + std::to_string(size) + " bytes goes beyond the end of the file",
                           kGarbled);
    }
    return bytes.substr(at + 8, size);
  };
  json_ = chunk(12, "JSON");
  const std::uint64_t next = 20 + json_.size();
  if (next + 8 <= bytes.size()) glb_buffer_ = chunk(next, std::string_view("BIN\0", 4));
}

void Document::parse_json() {
  try {
    root_ = io::parse_json(json_, progress_, limits_);
  } catch (const JsonProblem& problem) {
    fail(problem.text);
  }
  if (!root_.is_object()) fail("its JSON is not an object");
}

void Document::check_version_and_extensions() const {
  const Json asset = root_.value("asset", Json::object());
  if (!asset.is_object()) fail("\"asset\" is not an object");
  if (const std::string version = text(asset, "version"); !version.starts_with("2.")) {
    source_.fail(ErrorCode::mesh_unsupported, "glTF version " + shown_word(version) + " cannot be read",
                 "export the mesh as glTF 2.0");
  }
  const auto refuse = [&](std::string_view name) {
    source_.fail(ErrorCode::mesh_unsupported,
                 "the glTF file uses the extension " + shown_word(name) + ", which cannot be read",
                 "export the mesh without it, or as OBJ or PLY");
  };
  for (const Json& used : array(root_, "extensionsUsed")) {
    if (!use_.in_tile && used == kTileOnly) refuse(kTileOnly);
  }
  for (const Json& required : array(root_, "extensionsRequired")) {
    const std::string name = required.is_string() ? required.get<std::string>() : "";
    const bool harmless =
        name == kTileOnly || std::any_of(kHarmlessPrefixes.begin(), kHarmlessPrefixes.end(),
                                         [&](std::string_view prefix) { return name.starts_with(prefix); });
    if (!harmless) refuse(name);
  }
}

const Json& Document::array(const Json& object, const char* key) const {
  static const Json kEmpty = Json::array();
  const auto found = object.find(key);
  if (found == object.end()) return kEmpty;
  if (!found->is_array()) fail(std::string("\"") + key + "\" is not an array");
  return *found;
}

const Json& Document::item(const char* key, std::uint64_t index) const {
  const Json& items = array(root_, key);
  if (index >= items.size()) {
    fail(std::string("there is no \"") + key + "\" number " + std::to_string(index) + ", only " +
         std::to_string(items.size()) + " (counted from 0)");
  }
  if (!items[index].is_object()) fail(std::string("an item of \"") + key + "\" is not an object");
  return items[index];
}

std::uint64_t Document::as_whole(const Json& value, const char* what) const {
  constexpr double kLargest = 9007199254740992.0;  // 2^53: sums and products below stay in 64 bits
  const double number = value.is_number() ? value.get<double>() : -1;
  if (!(number >= 0 && number <= kLargest) || number != std::floor(number)) {
    fail(std::string("\"") + what + "\" is not a whole number");
  }
  return static_cast<std::uint64_t>(number);
}

std::optional<std::uint64_t> Document::whole(const Json& object, const char* key) const {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  return as_whole(*found, key);
}

std::uint64_t Document::required_whole(const Json& object, const char* key) const {
  const auto number = whole(object, key);
  if (!number) fail(std::string("\"") + key + "\" is missing");
  return *number;
}

std::string Document::text(const Json& object, const char* key) const {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_string()) fail(std::string("\"") + key + "\" is not a text");
  return found->get<std::string>();
}

Accessor Document::accessor(std::uint64_t index) {
  const Json& object = item("accessors", index);
  const std::string name = "accessor " + std::to_string(index);
  const std::uint64_t type = required_whole(object, "componentType");
  const int components = components_of(text(object, "type"));
  if (size_of(type) == 0 || components == 0) fail(name + " has an unknown type");
  const std::uint64_t count = required_whole(object, "count");

  Accessor accessor;
  const bool is_zeros = object.contains("sparse") && !object.contains("bufferView");
  accessor.base_ = is_zeros ? zeros(type, components, count, name) : elements(object, type, components, count, name);
  accessor.normalized_ = object.value("normalized", Json(false)) == Json(true);
  const auto sparse = object.find("sparse");
  if (sparse == object.end()) return accessor;

  if (!sparse->is_object()) fail(name + " has a \"sparse\" that is not an object");
  const auto part = [&](const char* key) -> const Json& {
    const auto found = sparse->find(key);
    if (found == sparse->end() || !found->is_object()) fail(name + " has no sparse \"" + key + "\"");
    return *found;
  };
  const std::uint64_t replaced = required_whole(*sparse, "count");
  const std::uint64_t index_type = required_whole(part("indices"), "componentType");
  if (!Accessor::is_unsigned(index_type)) fail(name + " has sparse indices of a wrong type");
  accessor.sparse_indices_ = elements(part("indices"), index_type, 1, replaced, name);
  accessor.sparse_values_ = elements(part("values"), type, components, replaced, name);
  if (!checked_sparse_.insert(index).second) return accessor;
  for (std::uint64_t i = 0; i < replaced; ++i) {
    if (accessor.sparse_indices_.whole(i) >= (i + 1 < replaced ? accessor.sparse_indices_.whole(i + 1) : count)) {
      fail(name + " has sparse indices that do not ascend, or go beyond its end");
    }
  }
  return accessor;
}

/// What a sparse accessor is without a buffer view (glTF 2.0, section 3.6.2.3).
Accessor::Elements Document::zeros(std::uint64_t component_type, int components, std::uint64_t count,
                                   const std::string& name) const {
  static constexpr std::array<char, 64> kZeros = {};
  constexpr std::uint64_t kMost = 1'000'000;  // they cost the file nothing
  if (count > kMost) fail(name + " has more than " + std::to_string(kMost) + " elements, and no buffer view");
  return {kZeros.data(), 0, count, component_type, components};
}

/// The elements that `view`, an object with "bufferView" and "byteOffset", describes.
Accessor::Elements Document::elements(const Json& view, std::uint64_t component_type, int components,
                                      std::uint64_t count, const std::string& name) {
  const auto view_index = whole(view, "bufferView");
  if (!view_index) fail(name + " has no buffer view");
  const Json& buffer_view = item("bufferViews", *view_index);
  const std::uint64_t size = size_of(component_type) * static_cast<std::uint64_t>(components);
  const std::uint64_t stride = whole(buffer_view, "byteStride").value_or(size);
  if (stride < size || stride > 252) fail(name + " has a wrong byte stride");

  const std::string_view bytes = this->view(*view_index);
  const std::uint64_t start = whole(view, "byteOffset").value_or(0);
  // In this order nothing overflows: every number is at most 2^53.
  if (count > 0 && (count > bytes.size() || start + (count - 1) * stride + size > bytes.size())) {
    fail(name + " goes beyond the end of its buffer view");
  }
  return {count == 0 ? bytes.data() : bytes.data() + start, stride, count, component_type, components};
}

std::string_view Document::view(std::uint64_t index) {
  const Json& object = item("bufferViews", index);
  const Json* const packed = extension(object, kMeshopt);
  if (packed && is_required(kMeshopt)) return unpacked_view(index, *packed);
  const std::string_view bytes = buffer(required_whole(object, "buffer"));
  const std::uint64_t start = whole(object, "byteOffset").value_or(0);
  const std::uint64_t length = required_whole(object, "byteLength");
  if (start + length > bytes.size()) {
    fail("buffer view " + std::to_string(index) + " goes beyond the end of its buffer");
  }
  return bytes.substr(start, length);
}

std::string_view Document::buffer(std::uint64_t index) {
  if (const auto known = buffers_.find(index); known != buffers_.end()) return known->second;
  const Json& object = item("buffers", index);
  const std::string uri = text(object, "uri");
  const std::string name = "buffer " + std::to_string(index);
  std::string_view bytes;
  if (uri.empty()) {
    if (!is_glb_ || index != 0) fail(name + " has no \"uri\"");
    bytes = glb_buffer_;
  } else if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view{uri}.substr(0, comma).ends_with(";base64")) {
      fail(name + " is a data URI without base64");
    }
    auto decoded = decode_base64(std::string_view{uri}.substr(comma + 1));
    if (!decoded) fail(name + " is not valid base64");
    bytes = contents_[std::to_string(index)] = std::move(*decoded);
  } else {
    bytes = external_file(uri);
  }
  const std::uint64_t length = required_whole(object, "byteLength");
  if (length > bytes.size()) {
    fail(name + " announces " + std::to_string(length) + " bytes, but has only " + std::to_string(bytes.size()));
  }
  buffer_bytes_ += length;
  return buffers_[index] = bytes.substr(0, length);
}

std::string_view Document::external_file(const std::string& uri) {
  if (!use_.read_file && uri.find("://") != std::string::npos) {
    source_.fail(ErrorCode::mesh_unsupported, "the glTF file has its data at " + shown_word(uri),
                 "download it and refer to the file");
  }
  const std::string relative = decode_percent(uri);
  if (relative.find('\0') != std::string::npos) fail("a buffer's \"uri\" holds a zero byte");
  if (use_.read_file) {
    const auto known = contents_.find("file " + uri);
    if (known != contents_.end()) return known->second;
    std::string bytes = use_.read_file(uri);
    count_held(bytes.size());
    return contents_.emplace("file " + uri, std::move(bytes)).first->second;
  }
  const std::filesystem::path path = file_below(relative, uri);
  const std::string key = "file " + path.string();
  auto known = contents_.find(key);
  if (known == contents_.end()) {
    known = contents_.emplace(key, read_file_bytes(path, progress_)).first;
    progress_.begin("parse glTF");
  }
  return known->second;
}

/// A small tile may name one large file by many URIs, or unpack the same data many times.
void Document::count_held(std::uint64_t bytes) {
  held_bytes_ += bytes;
  if (held_bytes_ > limits_.decompressed_bytes) {
    fail_as(ErrorCode::mesh_too_large,
            "its buffers take more than " + std::to_string(limits_.decompressed_bytes) + " bytes together");
  }
}

/// The file that a URI means, without links. It must lie below the folder of the glTF file, which others may have made:
/// they shall not choose among all files of the machine.
std::filesystem::path Document::file_below(const std::string& relative, const std::string& uri) const {
  namespace fs = std::filesystem;
  const fs::path folder = source_.file().has_parent_path() ? source_.file().parent_path() : fs::path(".");
  std::error_code error;
  fs::path path = fs::weakly_canonical(folder / relative, error);
  if (error) {
    source_.fail(ErrorCode::mesh_syntax,
                 "the path " + shown_word(uri) + " of a buffer leads nowhere: " + error.message(), kGarbled);
  }
  const auto is_below = [&path](const fs::path& base) {
    return !base.empty() && std::mismatch(base.begin(), base.end(), path.begin(), path.end()).first == base.end();
  };
  // The glTF file may be a link itself, with its buffers beside the one or the other.
  if (is_below(fs::weakly_canonical(folder, error))) return path;
  if (is_below(fs::weakly_canonical(source_.file(), error).parent_path())) return path;
  source_.fail(ErrorCode::mesh_unsupported,
               "the glTF file has its data in " + shown_word(uri) + ", which is not in its own folder",
               "put that file beside the glTF file, or in a folder below, and correct the \"uri\" of the buffer");
}

}  // namespace vantage::internal::io::gltf
