#include "tiles/content.h"

#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "common/shown_address.h"
#include "io/object_text.h"
#include "tiles/instances.h"
#include "tiles/tables.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

constexpr std::size_t kBatchedHeader = 28, kInstancedHeader = 32, kCompositeHeader = 16;

std::uint32_t load_word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// From glTF's axes to those of tiles, z up (3D Tiles, "Coordinate reference system").
Transform upright(GltfUp up) {
  Transform turn = Transform::Identity();
  if (up == GltfUp::y) turn.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == GltfUp::x) turn.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return turn;
}

std::string without_end(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

}  // namespace

/// Of a b3dm or i3dm.
struct ContentReader::Parts {
  std::string_view feature_json, feature_binary, batch_json, batch_binary, rest;
};

void ContentReader::fail(const std::string& address, const std::string& problem) const {
  throw Error(ErrorCode::mesh_syntax, "not a valid tile: " + problem, source_.shown(address),
              "export the tileset again; the file is cut off or garbled");
}

/// Nothing where there are neither triangles nor anything that is missing.
std::optional<io::TileMesh> ContentReader::surfaces_of(const io::MeshSource& source, const io::TileContext& tile) {
  io::TileMesh mesh = io::read_gltf_tile(source, progress_, limits_, tile);
  count_unreadable(source.file().string(), mesh.unreadable_properties);
  features_by_texture_ += mesh.features_by_texture;
  return mesh.mesh.triangles.empty() && mesh.mesh.ledger.empty() ? std::nullopt : std::optional(std::move(mesh));
}

void ContentReader::count_unreadable(const std::string& shown, io::UnreadableProperties more) {
  if (more.count > 0) more.first.insert(0, without_secrets(shown, true) + ": ");
  unreadable_properties_.add(more);
}

bool ContentReader::read(const std::string& address, const std::string& bytes, const Placement& placement) {
  models_.clear();
  repeated_ = kept_ = other_bytes_ = 0;
  most_repeated_ = limits_.repeated_triangles + bytes.size() / 3;
  try {
    const bool any = read_part(address, bytes, placement, 0);
    models_.clear();
    return any;
  } catch (const std::string& problem) {
    fail(address, problem);
  }
}

bool ContentReader::read_part(const std::string& address, std::string_view bytes, const Placement& placement,
                              int depth) {
  const std::string_view kind = bytes.substr(0, 4);
  if (kind == "b3dm") return read_batched(address, bytes, placement);
  if (kind == "i3dm") return read_instanced(address, bytes, placement);
  if (kind == "cmpt") return read_composite(address, bytes, placement, depth);
  if (kind == "pnts") {
    read_points(address, bytes, placement);
    return false;
  }
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (kind == "glTF" || (first != std::string_view::npos && bytes[first] == '{')) {
    return read_gltf(address, bytes, placement);
  }
  if (kind == "vctr" || kind == "geom") {
    throw Error(ErrorCode::mesh_unsupported, "a tile of the kind " + std::string(kind) + " cannot be read",
                source_.shown(address), "export it as glTF");
  }
  fail(address, "it is neither glTF nor b3dm, i3dm, cmpt or pnts");
}

bool ContentReader::read_composite(const std::string& address, std::string_view bytes, const Placement& placement,
                                   int depth) {
  constexpr int kDeepest = 8;
  if (depth >= kDeepest) fail(address, "composite tiles are nested deeper than 8 levels");
  if (bytes.size() < kCompositeHeader) fail(address, "it ends in its header");
  const std::uint32_t count = load_word(bytes, 12);
  std::size_t at = kCompositeHeader;
  bool any = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (bytes.size() - at < 12) fail(address, "it announces " + std::to_string(count) + " tiles and ends before");
    const std::uint32_t length = load_word(bytes, at + 8);
    if (length < 12 || length > bytes.size() - at) fail(address, "a tile in it goes beyond its end");
    any = read_part(address, bytes.substr(at, length), placement, depth + 1) || any;
    at += length;
  }
  if (bytes.find_first_not_of(std::string_view(" \0", 2), at) != std::string_view::npos) {
    fail(address, "more follows the " + std::to_string(count) + " tiles that it announces");
  }
  return any;
}

ContentReader::Parts ContentReader::split(const std::string& address, std::string_view bytes,
                                          std::size_t header) const {
  if (bytes.size() < header) fail(address, "it ends in its header");
  if (load_word(bytes, 4) != 1) fail(address, "its version is " + std::to_string(load_word(bytes, 4)) + ", not 1");
  const std::uint32_t length = load_word(bytes, 8);
  if (length < header || length > bytes.size()) {
    fail(address, "it announces " + std::to_string(length) + " bytes and has " + std::to_string(bytes.size()));
  }
  std::string_view left = bytes.substr(header, length - header);
  Parts parts;
  std::size_t at = 12;
  for (std::string_view* part : {&parts.feature_json, &parts.feature_binary, &parts.batch_json, &parts.batch_binary}) {
    const std::uint32_t size = load_word(bytes, at);
    if (size > left.size()) fail(address, "one of its tables goes beyond its end");
    *part = left.substr(0, size);
    left.remove_prefix(size);
    at += 4;
  }
  parts.rest = left;
  return parts;
}

/// A cloud of points, which is not built: the box about its points or, where these are compressed, about the tile.
void ContentReader::read_points(const std::string& address, std::string_view bytes, const Placement& placement) {
  constexpr std::size_t kPointsHeader = 28;
  const Parts parts = split(address, bytes, kPointsHeader);
  const Table features(parts.feature_json, parts.feature_binary, progress_, limits_);
  const std::uint64_t count = features.whole("POINTS_LENGTH");
  if (count == 0) return;
  const std::vector<double> about = features.global("RTC_CENTER", 3).value_or(std::vector<double>{0, 0, 0});
  Box box;
  const auto vector = [](const std::vector<double>& numbers, std::size_t i) {
    return Vec3(numbers[i], numbers[i + 1], numbers[i + 2]);
  };
  const auto offset = features.global("QUANTIZED_VOLUME_OFFSET", 3),
             scale = features.global("QUANTIZED_VOLUME_SCALE", 3);
  const bool is_packed = features.json().contains("extensions");
  if (const auto points = is_packed ? std::nullopt : features.per_instance("POSITION", 3, count, "FLOAT")) {
    for (std::size_t i = 0; i + 2 < points->size(); i += 3) box.extend(vector(*points, i));
  } else if (offset && scale) {
    box = {vector(*offset, 0), vector(*offset, 0) + vector(*scale, 0).cwiseMax(0)};
  }
  MissingPart part;
  part.entry.object.source_id = source_.name(address);
  part.entry.what = "cloud of " + std::to_string(count) + " points";
  part.entry.reason = "only surfaces are built";
  if (box.empty() || !box.min.allFinite() || !box.max.allFinite()) {
    part.corners = corners_of(placement.bounds, placement.world);
    part.entry.may_be_larger = true;  // contents stick out of their tiles
  } else {
    const Transform into_world = placement.into_world * Eigen::Translation3d(vector(about, 0));
    for (const Vec3& corner : io::box_mesh(box).vertices) part.corners.push_back(into_world * corner);
  }
  part.is_held = !part.corners.empty();
  part.entry.instead = "its box";
  collector_.missing.push_back(std::move(part));
}

bool ContentReader::read_gltf(const std::string& address, std::string_view bytes, const Placement& placement) {
  const io::MeshSource source(source_.shown(address), std::string(bytes));
  const auto from_here = [&](const std::string& uri) { return other_file(source_.resolve(address, uri)); };
  const auto mesh = surfaces_of(source, {source_.name(address), {}, from_here});
  if (!mesh) return false;
  collector_.add(mesh->mesh, placement.into_world * Eigen::Translation3d(mesh->center) * upright(placement.gltf_up),
                 source_.shown(address));
  return !mesh->mesh.triangles.empty();
}

bool ContentReader::read_batched(const std::string& address, std::string_view bytes, const Placement& placement) {
  const Parts parts = split(address, bytes, kBatchedHeader);
  const Table features(parts.feature_json, parts.feature_binary, progress_, limits_);
  BatchTable batch(parts.batch_json, parts.batch_binary, source_.name(address), progress_, limits_);
  const std::vector<double> about = features.global("RTC_CENTER", 3).value_or(std::vector<double>{0, 0, 0});
  const io::MeshSource source(source_.shown(address), std::string(parts.rest));
  io::TileContext context{source_.name(address), {}, {}};
  if (!features.is_empty() && features.whole("BATCH_LENGTH") > 0) {
    context.batch = [&batch](std::uint64_t id) { return batch.identity(id); };
  }
  context.read_file = [&](const std::string& uri) { return other_file(source_.resolve(address, uri)); };
  const auto mesh = surfaces_of(source, context);
  count_unreadable(source_.shown(address), batch.unreadable());
  if (!mesh) return false;
  const Vec3 center = mesh->center + Vec3(about[0], about[1], about[2]);
  collector_.add(mesh->mesh, placement.into_world * Eigen::Translation3d(center) * upright(placement.gltf_up),
                 source_.shown(address));
  return !mesh->mesh.triangles.empty();
}

/// A file that the content refers to. A small content may name one large file by many URIs, or in many parts.
std::string ContentReader::other_file(const std::string& address) {
  std::string bytes = source_.read(address, progress_);
  other_bytes_ += bytes.size();
  all_other_bytes_ += bytes.size();
  if (other_bytes_ > limits_.decompressed_bytes) {
    throw Error(ErrorCode::mesh_too_large,
                "the files that one tile refers to have more than " +
                    std::to_string(limits_.decompressed_bytes >> 20U) + " MiB together",
                source_.shown(address), "export the tileset in smaller tiles");
  }
  return bytes;
}

/// The model of an i3dm that is another file. The parts of a composite may share one: it is read once.
const std::optional<io::TileMesh>& ContentReader::model(const std::string& address, const std::string& uri) {
  constexpr std::size_t kMostKept = 16, kMostTriangles = 1'000'000;
  const std::string file = source_.resolve(address, uri);
  if (const auto known = models_.find(file); known != models_.end()) return known->second;
  const io::MeshSource source(source_.shown(file), other_file(file));
  const auto from_model = [&](const std::string& name) { return other_file(source_.resolve(file, name)); };
  auto mesh = surfaces_of(source, {source_.name(address), {}, from_model});
  const std::size_t triangles = mesh ? mesh->mesh.triangles.size() : 0;
  if (models_.size() >= kMostKept || kept_ + triangles > kMostTriangles) {
    models_.clear();
    kept_ = 0;
  }
  kept_ += triangles;
  return models_[file] = std::move(mesh);
}

/// Instances repeat their model: a small file can describe more triangles than there is memory.
void ContentReader::count_repeated(const std::string& address, std::uint64_t instances, std::uint64_t triangles) {
  if (triangles > 0 && instances > (most_repeated_ - repeated_) / triangles) {
    throw Error(ErrorCode::mesh_too_large,
                "its instances repeat their models to more than " + std::to_string(most_repeated_) + " triangles",
                source_.shown(address), "export the tileset with fewer instances in a tile, or with simpler models");
  }
  repeated_ += instances * triangles;
}

bool ContentReader::read_instanced(const std::string& address, std::string_view bytes, const Placement& placement) {
  const Parts parts = split(address, bytes, kInstancedHeader);
  const Table features(parts.feature_json, parts.feature_binary, progress_, limits_);
  BatchTable batch(parts.batch_json, parts.batch_binary, source_.name(address), progress_, limits_);
  const std::size_t count = instance_count(features);
  if (count == 0) return false;
  std::optional<io::TileMesh> own;
  const bool is_apart = load_word(bytes, 28) == 0;  // the model is another file
  if (!is_apart) {
    const io::MeshSource source(source_.shown(address), std::string(parts.rest));
    const auto from_here = [&](const std::string& uri) { return other_file(source_.resolve(address, uri)); };
    own = surfaces_of(source, {source_.name(address), {}, from_here});
  }
  const std::optional<io::TileMesh>& mesh = is_apart ? model(address, without_end(std::string(parts.rest))) : own;
  if (!mesh) return false;
  count_repeated(address, count, mesh->mesh.triangles.size());
  const Transform shape = Eigen::Translation3d(mesh->center) * upright(placement.gltf_up);
  for (const Instance& instance : instances_of(features, placement.into_world)) {
    progress_.check();
    collector_.add_as(batch.identity(instance.batch), mesh->mesh, placement.into_world * instance.transform * shape,
                      source_.shown(address));
  }
  count_unreadable(source_.shown(address), batch.unreadable());
  return !mesh->mesh.triangles.empty();
}

}  // namespace vantage::internal::tiles
