// The written files are read back by the small parsers below, not by vantage's own readers.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/formats.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::read_bytes;
using testing::TemporaryDirectory;

/// Values of the machine's own byte order, which is little-endian wherever this test runs.
template <typename T>
T take(const std::string& bytes, std::size_t& at) {
  T value{};
  if (at + sizeof(T) > bytes.size()) throw std::out_of_range("the file ends early");
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

/// Awkward numbers, names and UTM-sized coordinates.
Volume awkward_volume() {
  Volume volume = testing::make_dome(Vec3(580000.1, 4785000.2, 1000.3), 36, 9, [](double azimuth, double elevation) {
    return 80 + 20 * std::sin(3 * azimuth) * std::cos(elevation);
  });
  volume.causes[0].name = "Straße 7, \"north\" wing";
  volume.causes[1].name = "two\nlines\tand tabs";
  volume.causes[2].name = "";
  volume.causes.push_back({CauseKind::navigation, "zone 0"});
  volume.cause_of[5] = 5;
  return volume;
}

struct Ply {
  std::vector<std::string> header;
  Mesh mesh;
  std::vector<std::uint32_t> cause_of;
};

Ply parse_ply(const std::string& bytes) {
  Ply ply;
  const std::size_t end = bytes.find("end_header\n");
  std::istringstream lines(bytes.substr(0, end));
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(lines, line);) {
    ply.header.push_back(line);
    std::sscanf(line.c_str(), "element vertex %zu", &vertices);
    std::sscanf(line.c_str(), "element face %zu", &faces);
  }
  std::size_t at = end + std::strlen("end_header\n");
  for (std::size_t i = 0; i < vertices; ++i) {
    const double x = take<double>(bytes, at), y = take<double>(bytes, at), z = take<double>(bytes, at);
    ply.mesh.vertices.emplace_back(x, y, z);
  }
  for (std::size_t i = 0; i < faces; ++i) {
    EXPECT_EQ(take<std::uint8_t>(bytes, at), 3);
    const auto a = take<std::uint32_t>(bytes, at), b = take<std::uint32_t>(bytes, at),
               c = take<std::uint32_t>(bytes, at);
    ply.mesh.triangles.push_back({a, b, c});
    ply.cause_of.push_back(take<std::uint32_t>(bytes, at));
  }
  EXPECT_EQ(at, bytes.size());
  return ply;
}

TEST(WritePly, KeepsEveryBitAndNamesTheCauses) {
  const TemporaryDirectory directory;
  const Volume volume = awkward_volume();
  write_volume(volume, directory / "v.ply");
  const Ply ply = parse_ply(read_bytes(directory / "v.ply"));
  EXPECT_EQ(ply.mesh.vertices, volume.mesh.vertices);
  EXPECT_EQ(ply.mesh.triangles, volume.mesh.triangles);
  EXPECT_EQ(ply.cause_of, volume.cause_of);
  const std::vector<std::string> expected = {
      "ply",
      "format binary_little_endian 1.0",
      "comment vantage " VANTAGE_VERSION " visibility volume: computed",
      "comment vantage frame: scene, metres, z up",
      "comment vantage tolerance_m 0.01",
      "comment vantage rounding_m 0",
      "comment vantage cause 0 scene Straße 7, \"north\" wing",
      "comment vantage cause 1 scene two lines and tabs",
      "comment vantage cause 2 scene ",
      "comment vantage cause 3 range max_range",
      "comment vantage cause 4 target_plane target plane",
      "comment vantage cause 5 navigation zone 0",
      "element vertex " + std::to_string(volume.mesh.vertices.size()),
      "property double x",
      "property double y",
      "property double z",
      "element face " + std::to_string(volume.mesh.triangles.size()),
      "property list uchar int vertex_indices",
      "property uint cause",
  };
  EXPECT_EQ(ply.header, expected);
}

struct Obj {
  Mesh mesh;
  std::vector<std::string> group_of;  // per triangle
};

Obj parse_obj(const std::string& text) {
  Obj obj;
  std::istringstream lines(text);
  std::string group;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      std::string x, y, z;
      words >> x >> y >> z;
      obj.mesh.vertices.emplace_back(std::stod(x), std::stod(y), std::stod(z));
    } else if (key == "g") {
      words >> group;
    } else if (key == "f") {
      std::uint32_t a = 0, b = 0, c = 0;
      words >> a >> b >> c;
      obj.mesh.triangles.push_back({a - 1, b - 1, c - 1});
      obj.group_of.push_back(group);
    } else {
      EXPECT_EQ(key, "#") << line;
    }
    std::string rest;
    if (key != "#") {
      EXPECT_FALSE(words >> rest) << line;
    }
  }
  return obj;
}

TEST(WriteObj, HasAGroupPerCauseAndEveryBit) {
  const TemporaryDirectory directory;
  Volume volume = awkward_volume();
  volume.causes[4].name = "zone 0";  // the name of another cause
  write_volume(volume, directory / "v.obj");
  const Obj obj = parse_obj(read_bytes(directory / "v.obj"));
  EXPECT_EQ(obj.mesh.vertices, volume.mesh.vertices);
  EXPECT_EQ(first_open_edge(obj.mesh), "");
  const std::vector<std::string> names = {
      "Straße_7,_\"north\"_wing", "two_lines_and_tabs", "scene", "max_range", "zone_0", "zone_0#5"};
  std::map<Triangle, std::string> expected;
  for (std::size_t t = 0; t < volume.cause_of.size(); ++t) {
    expected[volume.mesh.triangles[t]] = names[volume.cause_of[t]];
  }
  ASSERT_EQ(obj.mesh.triangles.size(), expected.size());
  for (std::size_t t = 0; t < obj.group_of.size(); ++t) {
    EXPECT_EQ(obj.group_of[t], expected.at(obj.mesh.triangles[t]));
  }
}

TEST(WriteObj, YUpIsTheSceneFileFrame) {
  const TemporaryDirectory directory;
  const Volume volume = awkward_volume();
  write_volume(volume, directory / "v.obj", UpAxis::y);
  const Obj obj = parse_obj(read_bytes(directory / "v.obj"));
  ASSERT_EQ(obj.mesh.vertices.size(), volume.mesh.vertices.size());
  for (std::size_t v = 0; v < obj.mesh.vertices.size(); ++v) {
    // A y-up file's (x, y, z) is (x, -z, y) in the scene frame.
    const Vec3& file = obj.mesh.vertices[v];
    EXPECT_EQ(Vec3(file.x(), -file.z(), file.y()), volume.mesh.vertices[v]);
  }
  EXPECT_GT(enclosed_volume(obj.mesh), 0);  // still outward
}

TEST(WriteObj, IsInTheUnitOfTheSceneFile) {
  const TemporaryDirectory directory;
  const Volume volume = awkward_volume();
  for (const double scale : {0.001, 0.3048, 1000.0}) {
    SCOPED_TRACE(scale);
    write_volume(volume, directory / "v.obj", UpAxis::y, scale);
    const Obj obj = parse_obj(read_bytes(directory / "v.obj"));
    ASSERT_EQ(obj.mesh.vertices.size(), volume.mesh.vertices.size());
    EXPECT_EQ(first_open_edge(obj.mesh), "");
    for (std::size_t v = 0; v < obj.mesh.vertices.size(); ++v) {
      const Vec3 file = obj.mesh.vertices[v] * scale, expected = volume.mesh.vertices[v];
      EXPECT_LE((Vec3(file.x(), -file.z(), file.y()) - expected).norm(), 4e-16 * expected.norm());
    }
  }
}

TEST(WriteObj, RefusesUnitsThatAreNone) {
  const TemporaryDirectory directory;
  testing::write_bytes(directory / "v.obj", "old");
  for (const double scale : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-308}) {
    SCOPED_TRACE(scale);
    testing::expect_error([&] { write_volume(awkward_volume(), directory / "v.obj", UpAxis::z, scale); },
                          ErrorCode::value_out_of_range, "scale");
  }
  EXPECT_EQ(read_bytes(directory / "v.obj"), "old");
}

TEST(WriteStl, HoldsTheTrianglesAndTheirNormals) {
  const TemporaryDirectory directory;
  const Volume volume = testing::make_hemisphere(Vec3(1, 2, 3), 50);
  write_volume(volume, directory / "v.stl");
  const std::string bytes = read_bytes(directory / "v.stl");
  EXPECT_NE(bytes.substr(0, 5), "solid");  // that would mark a text file
  std::size_t at = 80;
  ASSERT_EQ(take<std::uint32_t>(bytes, at), volume.mesh.triangles.size());
  ASSERT_EQ(bytes.size(), 84 + 50 * volume.mesh.triangles.size());
  for (const Triangle& triangle : volume.mesh.triangles) {
    Eigen::Vector3f corners[4];
    for (Eigen::Vector3f& v : corners) {
      for (float& coordinate : v) coordinate = take<float>(bytes, at);
    }
    // Rounded to one grid, that of the numbers at the largest coordinate: 53 needs 6 digits before the point.
    for (int i = 0; i < 3; ++i) {
      const Vec3 vertex = volume.mesh.vertices[triangle[i]];
      EXPECT_EQ(corners[i + 1].cast<double>(), ((vertex * 0x1p18).array().round() * 0x1p-18).matrix());
    }
    EXPECT_NEAR(corners[0].norm(), 1, 1e-6);
    EXPECT_NEAR(corners[0].dot(corners[2] - corners[1]), 0, 1e-4);
    const Vec3 outward = volume.mesh.vertices[triangle[0]] - Vec3(1, 2, 4);
    EXPECT_GT(corners[0].cast<double>().dot(outward), 0);
    EXPECT_EQ(take<std::uint16_t>(bytes, at), 0);
  }
}

struct Glb {
  nlohmann::json json;
  std::string buffer;
};

Glb parse_glb(const std::string& bytes) {
  Glb glb;
  std::size_t at = 0;
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  at = 4;
  EXPECT_EQ(take<std::uint32_t>(bytes, at), 2u);
  EXPECT_EQ(take<std::uint32_t>(bytes, at), bytes.size());
  EXPECT_EQ(bytes.size() % 4, 0u);
  for (int chunk = 0; at < bytes.size(); ++chunk) {
    const auto length = take<std::uint32_t>(bytes, at);
    EXPECT_EQ(length % 4, 0u);
    const auto type = take<std::uint32_t>(bytes, at);
    EXPECT_EQ(type, chunk == 0 ? 0x4E4F534Au : 0x004E4942u);
    if (chunk == 0) glb.json = nlohmann::json::parse(bytes.substr(at, length));
    if (chunk == 1) glb.buffer = bytes.substr(at, length);
    at += length;
  }
  EXPECT_EQ(at, bytes.size());
  return glb;
}

/// Where the accessor's data begin; checks what the specification asks of accessors and views.
std::size_t data_of(const Glb& glb, std::size_t accessor, int target, std::size_t element_bytes) {
  const nlohmann::json& a = glb.json.at("accessors").at(accessor);
  const nlohmann::json& view = glb.json.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
  EXPECT_EQ(view.at("target"), target);
  EXPECT_EQ(view.at("buffer"), 0);
  const auto offset = view.at("byteOffset").get<std::size_t>();
  EXPECT_EQ(offset % 4, 0u);
  EXPECT_EQ(view.at("byteLength"), a.at("count").get<std::size_t>() * element_bytes);
  EXPECT_LE(offset + view.at("byteLength").get<std::size_t>(), glb.buffer.size());
  EXPECT_FALSE(view.contains("byteStride"));
  return offset;
}

TEST(WriteGlb, IsValidAndKeepsLargeCoordinates) {
  const TemporaryDirectory directory;
  const Volume volume = awkward_volume();
  write_volume(volume, directory / "v.glb");
  const Glb glb = parse_glb(read_bytes(directory / "v.glb"));
  EXPECT_EQ(glb.json.at("asset").at("version"), "2.0");
  EXPECT_EQ(glb.json.at("buffers").size(), 1u);
  EXPECT_EQ(glb.json.at("buffers")[0].at("byteLength"), glb.buffer.size());
  EXPECT_EQ(glb.json.at("scenes").at(glb.json.at("scene").get<std::size_t>()).at("nodes").dump(), "[0]");
  const nlohmann::json& node = glb.json.at("nodes").at(0);
  const auto translation = node.at("translation").get<std::array<double, 3>>();
  const nlohmann::json& primitives = glb.json.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives");
  ASSERT_EQ(primitives.size(), 4u);

  // Positions: single precision about the node's origin, minimum and maximum exact.
  const auto positions = primitives[0].at("attributes").at("POSITION").get<std::size_t>();
  const nlohmann::json& accessor = glb.json.at("accessors").at(positions);
  EXPECT_EQ(accessor.at("componentType"), 5126);
  EXPECT_EQ(accessor.at("type"), "VEC3");
  std::size_t at = data_of(glb, positions, 34962, 12);
  Mesh mesh;
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t v = 0; v < accessor.at("count").get<std::size_t>(); ++v) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) {
      const double coordinate = take<float>(glb.buffer, at);
      low[i] = std::min(low[i], coordinate);
      high[i] = std::max(high[i], coordinate);
      p[i] = coordinate + translation[i];
    }
    mesh.vertices.emplace_back(p.x(), -p.z(), p.y());  // y up to z up
  }
  EXPECT_EQ((accessor.at("min").get<std::array<double, 3>>()), low);
  EXPECT_EQ((accessor.at("max").get<std::array<double, 3>>()), high);
  ASSERT_EQ(mesh.vertices.size(), volume.mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_LT((mesh.vertices[v] - volume.mesh.vertices[v]).norm(), 1e-5);
  }

  // One primitive and one material per kind of cause.
  std::map<Triangle, std::string> kind_of;
  for (const nlohmann::json& primitive : primitives) {
    EXPECT_EQ(primitive.at("attributes").at("POSITION"), positions);
    EXPECT_EQ(primitive.value("mode", 4), 4);
    const auto indices = primitive.at("indices").get<std::size_t>();
    EXPECT_EQ(glb.json.at("accessors")[indices].at("componentType"), 5125);
    EXPECT_EQ(glb.json.at("accessors")[indices].at("type"), "SCALAR");
    const nlohmann::json& material = glb.json.at("materials").at(primitive.at("material").get<std::size_t>());
    EXPECT_EQ(material.at("alphaMode"), "BLEND");
    EXPECT_EQ(material.at("doubleSided"), true);
    std::size_t from = data_of(glb, indices, 34963, 4);
    for (std::size_t i = 0; i < glb.json.at("accessors")[indices].at("count").get<std::size_t>(); i += 3) {
      const auto a = take<std::uint32_t>(glb.buffer, from), b = take<std::uint32_t>(glb.buffer, from),
                 c = take<std::uint32_t>(glb.buffer, from);
      mesh.triangles.push_back({a, b, c});
      kind_of[{a, b, c}] = material.at("name");
    }
  }
  EXPECT_EQ(first_open_edge(mesh), "");
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(volume.mesh), 0.1);
  const std::vector<std::string> names = {"scene", "scene", "scene", "range", "target_plane", "navigation"};
  for (std::size_t t = 0; t < volume.cause_of.size(); ++t) {
    EXPECT_EQ(kind_of.at(volume.mesh.triangles[t]), names[volume.cause_of[t]]);
  }
}

TEST(WriteGlb, HasTheColoursOfThePictures) {
  const TemporaryDirectory directory;
  write_volume(awkward_volume(), directory / "v.glb");
  const Glb glb = parse_glb(read_bytes(directory / "v.glb"));
  // src/picture/palette.h, from sRGB to linear.
  const std::map<std::string, Vec3> colours = {{"scene", Vec3(0.0000, 0.1683, 0.4452)},
                                               {"range", Vec3(0.7913, 0.3467, 0.0000)},
                                               {"target_plane", Vec3(0.2159, 0.2159, 0.2384)},
                                               {"navigation", Vec3(0.0000, 0.3419, 0.1714)}};
  ASSERT_EQ(glb.json.at("materials").size(), colours.size());
  for (const nlohmann::json& material : glb.json.at("materials")) {
    const nlohmann::json& factor = material.at("pbrMetallicRoughness").at("baseColorFactor");
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(factor.at(i).get<double>(), colours.at(material.at("name"))[i], 1e-4) << material.at("name");
    }
  }
}

TEST(WriteVolume, EmptyVolumesMakeValidFiles) {
  const TemporaryDirectory directory;
  Volume volume;
  volume.outcome = Outcome::outside_limits;
  for (const std::string& name : testing::in_each_format("v")) write_volume(volume, directory / name);
  EXPECT_TRUE(parse_ply(read_bytes(directory / "v.ply")).mesh.empty());
  EXPECT_TRUE(parse_obj(read_bytes(directory / "v.obj")).mesh.empty());
  EXPECT_EQ(read_bytes(directory / "v.stl").size(), 84u);
  const Glb glb = parse_glb(read_bytes(directory / "v.glb"));
  EXPECT_FALSE(glb.json.contains("meshes"));
  EXPECT_FALSE(glb.json.contains("buffers"));
}

TEST(WriteVolume, ExtensionsInCapitals) {
  const TemporaryDirectory directory;
  write_volume(testing::make_hemisphere(Vec3::Zero(), 1), directory / "V.PLY");
  EXPECT_EQ(read_bytes(directory / "V.PLY").substr(0, 4), "ply\n");
}

TEST(WriteVolume, RefusesUnknownExtensionsAndDirectories) {
  const TemporaryDirectory directory;
  const Volume volume = testing::make_hemisphere(Vec3::Zero(), 1);
  const auto expect_refused = [&](const std::filesystem::path& file, ErrorCode code) {
    testing::expect_error([&] { write_volume(volume, file); }, code, file.string());
  };
  expect_refused(directory / "v.step", ErrorCode::output_format_unknown);
  expect_refused(directory / "v", ErrorCode::output_format_unknown);
  expect_refused(directory.path(), ErrorCode::output_not_a_file);
  std::filesystem::create_directory(directory / "d.ply");
  expect_refused(directory / "d.ply", ErrorCode::output_not_a_file);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"d.ply"});
}

TEST(WriteVolume, RefusesABrokenVolume) {
  const TemporaryDirectory directory;
  testing::write_bytes(directory / "v.ply", "old");
  const Volume good = testing::make_hemisphere(Vec3::Zero(), 1);
  std::vector<Volume> broken(4, good);
  broken[0].cause_of.pop_back();
  broken[1].cause_of[3] = 99;
  broken[2].mesh.triangles[3][0] = 9999;
  broken[3].mesh.vertices[3].x() = std::nan("");
  for (const Volume& volume : broken) EXPECT_THROW(write_volume(volume, directory / "v.ply"), Error);
  EXPECT_EQ(read_bytes(directory / "v.ply"), "old");
}

}  // namespace
}  // namespace vantage
