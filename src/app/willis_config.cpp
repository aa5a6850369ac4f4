// docs/willis-config.md describes every key.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "app/input_file.h"
#include "app/value_reader.h"
#include "common/input.h"
#include "vantage/error.h"
#include "vantage/spheres.h"

namespace vantage {

using namespace internal::app;

namespace {

namespace fs = std::filesystem;

constexpr int kMostTexels = 8192;  // along a face's side, as SpheresOptions::cubemap

/// Sine of the angle between `front` and `up` under which they count as parallel.
constexpr double kParallel = 1e-6;

constexpr const char* kVectorForm = "write three numbers in brackets: [x, y, z]";

const YamlDialect& dialect() {
  static const YamlDialect kDialect = {"configuration file", "docs/willis-config.md", {"mesh", "visibility_vol"}};
  return kDialect;
}

/// A block of the file: its name, the keys that are read, and those that other programs of its authors read.
struct Block {
  std::string_view name;
  std::vector<std::string_view> keys, ignored;
};

const Block kFile = {"the configuration", {"world_coord_sys", "mesh", "visibility_vol"}, {}};
const Block kWorld = {"world_coord_sys", {"id", "origin", "up", "front"}, {}};
const Block kMesh = {
    "mesh", {"id", "position", "scale", "orientation axis, angle", "format", "filename"}, {"material"}};
const Block kVolume = {
    "visibility_vol",
    {"id", "width", "height", "fov_degrees", "origin", "front", "up", "up_max", "up_min", "radius_max", "output_file"},
    {}};

class WillisConfigParser : private ValueReader {
 public:
  explicit WillisConfigParser(const fs::path& file) : ValueReader(file.string()) { config_.file = fs::absolute(file); }

  WillisConfig parse(std::string_view text);

 private:
  void parse_world(const YamlNode& node);
  void parse_mesh(const YamlNode& node);
  void parse_volume(const YamlNode& node);
  void parse_cube(const YamlNode& node, WillisVolume& volume);
  void parse_limits(const YamlNode& node, WillisVolume& volume);
  void parse_output(const YamlNode& node, WillisVolume& volume);

  void check_block(const YamlNode& node, const Block& block);
  const YamlNode& require(const YamlNode& map, const Block& block, std::string_view key, const std::string& fix) const;
  Vec3 scale_of(const YamlNode& node) const;
  Eigen::Matrix3d rotation_of(const YamlNode& node) const;
  Vec3 direction(const YamlNode& node, const std::string& what) const;
  int texels(const YamlNode& node, const std::string& what) const;

  WillisConfig config_;
  std::map<fs::path, std::string> outputs_;  // and where each is named
};

WillisConfig WillisConfigParser::parse(std::string_view text) {
  const YamlNode root = parse_yaml(text, file(), dialect());
  check_block(root, kFile);
  if (const YamlNode* world = find(root, "world_coord_sys")) parse_world(*world);
  for (const YamlEntry& entry : root.entries) {
    if (entry.key == "mesh") parse_mesh(entry.value);
    if (entry.key == "visibility_vol") parse_volume(entry.value);
  }
  if (config_.meshes.empty()) {
    fail(ErrorCode::missing_key, root, "the configuration lacks a block 'mesh'",
         "write 'mesh:' and below it, indented, 'filename: city.obj'");
  }
  if (config_.volumes.empty()) {
    fail(ErrorCode::missing_key, root, "the configuration lacks a block 'visibility_vol': there is nothing to compute",
         "write 'visibility_vol:' and below it, indented, width, height, origin and output_file");
  }
  return std::move(config_);
}

/// Keys that nobody knows are told and passed over, as the published program does; one slip from a key that is read, a
/// cut or a limit would silently be lost.
void WillisConfigParser::check_block(const YamlNode& node, const Block& block) {
  std::string known;
  for (const std::string_view key : block.keys) known.append(known.empty() ? "" : ", ").append(key);
  if (node.kind != YamlNode::Kind::map) {
    fail(ErrorCode::wrong_type, node, std::string(block.name) + " must be a mapping of keys, not " + describe(node),
         "write its keys, indented, as 'key: value': " + known);
  }
  for (const YamlEntry& entry : node.entries) {
    const auto is_key = [&](std::string_view key) { return key == entry.key; };
    if (std::any_of(block.keys.begin(), block.keys.end(), is_key)) continue;
    if (std::any_of(block.ignored.begin(), block.ignored.end(), is_key)) continue;
    const std::string problem = "unknown key " + in_quotes(entry.key) + " in " + std::string(block.name);
    const std::string_view nearest = nearest_name(entry.key, block.keys);
    const int slips = nearest.size() < 5 ? 1 : 2;
    if (edit_distance(entry.key, nearest) <= slips) {
      throw Error(
          ErrorCode::unknown_key, problem, place_in(file(), entry.place),
          "did you mean '" + std::string(nearest) + "'? (keys of " + std::string(block.name) + ": " + known + ")");
    }
    config_.warnings.push_back(place_in(file(), entry.place) + ": " + problem + " means nothing here");
  }
}

const YamlNode& WillisConfigParser::require(const YamlNode& map, const Block& block, std::string_view key,
                                            const std::string& fix) const {
  if (const YamlNode* node = find(map, key)) return *node;
  fail(ErrorCode::missing_key, map, std::string(block.name) + " lacks the key '" + std::string(key) + "'", fix);
}

void WillisConfigParser::parse_world(const YamlNode& node) {
  check_block(node, kWorld);
  if (const YamlNode* origin = find(node, "origin")) {
    if (vector(*origin, "world_coord_sys.origin", kVectorForm) != Vec3::Zero()) {
      fail(ErrorCode::value_unsupported, *origin, "world_coord_sys.origin must be [0, 0, 0]",
           "give the other coordinates from that origin");
    }
  }
  Vec3 up = Vec3::UnitY(), front = Vec3::UnitX();
  if (const YamlNode* given = find(node, "up")) {
    up = direction(*given, "world_coord_sys.up");
    if (up != Vec3::UnitY() && up != Vec3::UnitZ()) {
      fail(ErrorCode::value_unsupported, *given, "world_coord_sys.up must be the y axis or the z axis",
           "write [0, 1, 0] or [0, 0, 1]");
    }
    config_.up = up == Vec3::UnitY() ? UpAxis::y : UpAxis::z;
  }
  if (const YamlNode* given = find(node, "front")) {  // it names no direction of anything; only nonsense is refused
    front = direction(*given, "world_coord_sys.front");
    if (front.cross(up).norm() < kParallel) {
      fail(ErrorCode::direction_invalid, *given, "world_coord_sys.front is parallel to up",
           "write a direction at right angles to up");
    }
  }
}

void WillisConfigParser::parse_mesh(const YamlNode& node) {
  check_block(node, kMesh);
  WillisMesh mesh;
  const YamlNode& name = require(node, kMesh, "filename", "write 'filename: city.obj'");
  mesh.name = text(name, "mesh.filename");
  mesh.where = place_in(file(), name.place);
  mesh.file = config_.file.parent_path() / mesh.name;
  if (const YamlNode* format = find(node, "format")) {
    std::string word = text(*format, "mesh.format");
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    static constexpr std::array<std::string_view, 3> kFormats = {"OBJ", "PLY", "STL"};
    if (std::find(kFormats.begin(), kFormats.end(), word) == kFormats.end()) {
      fail(ErrorCode::value_unsupported, *format, "mesh.format must be OBJ, PLY or STL, not " + in_quotes(format->text),
           "convert the mesh to one of these");
    }
  }
  if (const YamlNode* position = find(node, "position")) {
    mesh.position = vector(*position, "mesh.position", kVectorForm);
  }
  if (const YamlNode* scale = find(node, "scale")) mesh.scale = scale_of(*scale);
  if (const YamlNode* turn = find(node, "orientation axis, angle")) mesh.rotation = rotation_of(*turn);
  config_.meshes.push_back(std::move(mesh));
}

Vec3 WillisConfigParser::scale_of(const YamlNode& node) const {
  if (node.kind != YamlNode::Kind::sequence) return Vec3::Constant(positive(node, "mesh.scale"));
  Vec3 scale = vector(node, "mesh.scale", "write one number, or three in brackets: [x, y, z]");
  if (scale.minCoeff() <= 0) {
    fail(ErrorCode::value_out_of_range, node, "mesh.scale must be greater than 0 in each axis",
         "write positive numbers");
  }
  return scale;
}

Eigen::Matrix3d WillisConfigParser::rotation_of(const YamlNode& node) const {
  const char* const form = "write the axis and the angle in degrees: [x, y, z, angle]";
  const std::string what = "mesh.orientation axis, angle";
  if (list(node, what, form).size() != 4)
    fail(ErrorCode::wrong_type, node, what + " must be four numbers, not " + describe(node), form);
  Vec3 axis;
  for (int i = 0; i < 3; ++i) axis[i] = bounded(node.items[static_cast<std::size_t>(i)], what);
  const double degrees = bounded(node.items[3], what);
  if (degrees == 0) return Eigen::Matrix3d::Identity();
  if (axis.stableNorm() < std::numeric_limits<double>::min()) {
    fail(ErrorCode::direction_invalid, node, what + " has an axis of length 0", "write an axis that is not [0, 0, 0]");
  }
  // The remainder first: an angle of many turns would lose its digits.
  return Eigen::AngleAxisd(std::remainder(degrees, 360.0) * std::numbers::pi / 180, axis.stableNormalized())
      .toRotationMatrix();
}

/// A vector of length 1.
Vec3 WillisConfigParser::direction(const YamlNode& node, const std::string& what) const {
  const Vec3 given = vector(node, what, kVectorForm);
  if (given.stableNorm() < std::numeric_limits<double>::min()) {
    fail(ErrorCode::direction_invalid, node, what + " has length 0", "write a direction, such as [1, 0, 0]");
  }
  return given.stableNormalized();
}

void WillisConfigParser::parse_volume(const YamlNode& node) {
  check_block(node, kVolume);
  WillisVolume volume;
  const YamlNode* id = find(node, "id");
  volume.name = "volume " + (id ? text(*id, "visibility_vol.id") : "at line " + std::to_string(node.place.line));
  const YamlNode& origin =
      require(node, kVolume, "origin", "write 'origin: [x, y, z]', the viewpoint in the mesh's axes");
  volume.origin = vector(origin, "visibility_vol.origin", kVectorForm);
  volume.where = place_in(file(), origin.place);
  parse_cube(node, volume);
  parse_limits(node, volume);
  parse_output(node, volume);
  config_.volumes.push_back(std::move(volume));
}

void WillisConfigParser::parse_cube(const YamlNode& node, WillisVolume& volume) {
  const YamlNode& width = require(node, kVolume, "width", "write 'width: 40', the texels along a face's side");
  const YamlNode& height = require(node, kVolume, "height", "write 'height: 40', the same as width");
  volume.texels = texels(width, "visibility_vol.width");
  if (texels(height, "visibility_vol.height") != volume.texels) {
    fail(
        ErrorCode::value_unsupported, height,
        "visibility_vol.height is " + height.text + ", but width is " + width.text + ": the faces of a cube are square",
        "write the same number for both");
  }
  if (const YamlNode* fov = find(node, "fov_degrees")) {
    const double degrees = number(*fov, "visibility_vol.fov_degrees");
    if (degrees != 90) {
      fail(ErrorCode::value_unsupported, *fov, "visibility_vol.fov_degrees must be 90, not " + shortest(degrees),
           "write 90, or leave the key out: six faces of 90 degrees make a cube, all else leaves gaps or overlaps");
    }
  }
  const YamlNode* up = find(node, "up");
  const YamlNode* front = find(node, "front");
  if (up) volume.up = direction(*up, "visibility_vol.up");
  if (front) volume.front = direction(*front, "visibility_vol.front");
  const Vec3 level = volume.front - volume.front.dot(volume.up) * volume.up;
  if (level.norm() < kParallel) {
    fail(ErrorCode::direction_invalid, front ? *front : *up, "visibility_vol.front is parallel to up",
         "write a front at right angles to up");
  }
  if (level != volume.front) volume.front = level.normalized();
}

int WillisConfigParser::texels(const YamlNode& node, const std::string& what) const {
  const double value = number(node, what);
  if (value != std::floor(value) || value < 1 || value > kMostTexels) {
    fail(ErrorCode::value_out_of_range, node,
         what + " must be a whole number from 1 to " + std::to_string(kMostTexels) + ", not " + in_quotes(node.text),
         "write the texels along a face's side, such as 40");
  }
  return static_cast<int>(value);
}

void WillisConfigParser::parse_limits(const YamlNode& node, WillisVolume& volume) {
  const YamlNode* low = find(node, "up_min");
  const YamlNode* high = find(node, "up_max");
  if (low) volume.up_min = bounded(*low, "visibility_vol.up_min");
  if (high) volume.up_max = bounded(*high, "visibility_vol.up_max");
  if (volume.up_min >= volume.up_max) {
    fail(ErrorCode::limits_reversed, *low,
         "visibility_vol.up_min is " + shortest(volume.up_min) + ", not below up_max, " + shortest(volume.up_max),
         "write the lower height as up_min");
  }
  if (const YamlNode* radius = find(node, "radius_max")) {
    volume.radius_max = positive(*radius, "visibility_vol.radius_max");
  }
  const double height = volume.origin.dot(volume.up);
  if (height <= volume.up_min || height >= volume.up_max) {
    throw Error(ErrorCode::limits_empty,
                "the viewpoint of " + volume.name + " lies at height " + shortest(height) +
                    ", not between up_min and up_max: nothing would be left",
                volume.where, "mend origin, up_min or up_max; heights are along up, from the world's origin");
  }
}

void WillisConfigParser::parse_output(const YamlNode& node, WillisVolume& volume) {
  const YamlNode& output = require(node, kVolume, "output_file", "write 'output_file: volume.obj'");
  volume.output_name = text(output, "visibility_vol.output_file");
  volume.output_where = place_in(file(), output.place);
  volume.output = config_.file.parent_path() / volume.output_name;
  const auto [first, is_new] = outputs_.emplace(volume.output.lexically_normal(), volume.output_where);
  if (!is_new) {
    fail(ErrorCode::output_named_twice, output,
         "two volumes have the same output_file " + in_quotes(volume.output_name),
         "give each a name of its own; the first is at " + first->second);
  }
}

}  // namespace

WillisConfig parse_willis_config(std::string_view text, const fs::path& file) {
  return WillisConfigParser(file).parse(text);
}

WillisConfig read_willis_config(const fs::path& file) {
  check_readable(file, "the configuration file", "");
  WillisConfig config = parse_willis_config(read_text(file, "configuration file"), file);
  for (const WillisMesh& mesh : config.meshes) check_readable(mesh.file, "the mesh", mesh.where);
  return config;
}

}  // namespace vantage
