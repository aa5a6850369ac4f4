// What all formats have in common: telling them apart, compression, axes and scale, files that cannot be read,
// progress; and the real inputs.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <random>
#include <set>

#include "io/mesh_file.h"
#include "support/mesh_reading.h"
#include "support/objects.h"
#include "support/shared_data.h"
#include "support/temporary_directory.h"
#include "vantage/scene.h"

namespace vantage {
namespace {

using testing::expect_error;
using testing::gzip;
using testing::shared_data;
using testing::TemporaryDirectory;
using testing::write_bytes;

const std::string kObj = "o tower\nv 1 2 3\nv 4 2 3\nv 1 5 4\nf 1 2 3\n";

TEST(ReadScene, GivesTheSceneFrame) {
  TemporaryDirectory folder;
  write_bytes(folder / "a.obj", kObj);
  const Scene plain = read_scene(folder / "a.obj");
  EXPECT_EQ(plain.mesh.vertices[0], Vec3(1, 2, 3));
  EXPECT_EQ(names_of(plain.objects), std::vector<std::string>{"tower"});
  EXPECT_EQ(plain.object_of, std::vector<std::uint32_t>{0});
  EXPECT_EQ(plain.source, folder / "a.obj");
  EXPECT_EQ(plain.up, UpAxis::z);

  const Scene turned = read_scene(folder / "a.obj", {.up = UpAxis::y, .scale = 0.5});
  EXPECT_EQ(turned.mesh.vertices[0], Vec3(0.5, -1.5, 1));
  EXPECT_EQ(turned.up, UpAxis::y);
  EXPECT_EQ(turned.scale, 0.5);
}

TEST(ReadScene, TellsTheFormatByContentThenByName) {
  using io::MeshFormat;
  const auto format = [](const std::string& name, const std::string& bytes) {
    return io::mesh_format(io::MeshSource(name, bytes));
  };
  EXPECT_EQ(format("a.obj", "ply\nformat"), MeshFormat::ply);
  EXPECT_EQ(format("a.obj", "solid x\n"), MeshFormat::stl);
  EXPECT_EQ(format("a.obj", " {"), MeshFormat::gltf);
  EXPECT_EQ(format("a", "glTF"), MeshFormat::gltf);
  EXPECT_EQ(format("a", kObj), MeshFormat::obj);
  EXPECT_EQ(format("a.stl", "# comment\n\nmtllib x\n"), MeshFormat::obj);
  EXPECT_EQ(format("A.OBJ", "?"), MeshFormat::obj);
  EXPECT_EQ(format("b.ply.gz", "?"), MeshFormat::ply);
  EXPECT_EQ(format("a.STL", "?"), MeshFormat::stl);
  EXPECT_EQ(format("a.glb", "?"), MeshFormat::gltf);
  expect_error([&] { format("a.txt", "# A title\n\nText.\n"); }, ErrorCode::mesh_format_unknown, "a.txt");
}

TEST(ReadScene, ReadsCompressedFiles) {
  TemporaryDirectory folder;
  write_bytes(folder / "a.obj.gz", gzip(kObj));
  write_bytes(folder / "b", gzip(kObj.substr(0, 20)) + gzip("") + gzip(kObj.substr(20)) + std::string(512, '\0'));
  const Scene zipped = read_scene(folder / "a.obj.gz");
  EXPECT_EQ(zipped.mesh.vertices, read_scene(folder / "b").mesh.vertices);
  // More than one buffer of the decompressor, and well compressible.
  std::string large = kObj;
  for (int i = 0; i < 400000; ++i) large += "f 1 2 3\n";
  write_bytes(folder / "large.obj.gz", gzip(large));
  const Scene many = read_scene(folder / "large.obj.gz");
  EXPECT_EQ(many.mesh.triangles.size(), 400001u);
  write_bytes(folder / "t.ply.gz",
              gzip("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                   "float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                   "0 0 0 1 0 0 0 1 0 3 0 1 2"));
  EXPECT_EQ(names_of(read_scene(folder / "t.ply.gz").objects), std::vector<std::string>{"t"});
}

TEST(ReadScene, FindsBrokenCompression) {
  TemporaryDirectory folder;
  const std::string good = gzip(kObj + std::string(100000, '#'));
  const auto expect = [&](const std::string& bytes, ErrorCode code) {
    write_bytes(folder / "bad.obj.gz", bytes);
    expect_error([&] { read_scene(folder / "bad.obj.gz"); }, code, "bad.obj.gz");
  };
  for (std::size_t size = 2; size < good.size(); ++size) {
    write_bytes(folder / "cut.obj.gz", good.substr(0, size));
    testing::expect_code([&] { read_scene(folder / "cut.obj.gz"); }, ErrorCode::compression_broken, "cut.obj.gz");
  }
  expect(good.substr(0, good.size() / 2), ErrorCode::compression_broken);
  std::string bad = good;
  bad[good.size() - 6] = static_cast<char>(bad[good.size() - 6] ^ 1);  // the check sum
  expect(bad, ErrorCode::compression_broken);
  expect(good + "more", ErrorCode::compression_broken);
  expect(gzip(""), ErrorCode::file_empty);
  write_bytes(folder / "bad.stl.gz", gzip(std::string(80, ' ') + std::string("\1\0\0\0", 4)));
  expect_error([&] { read_scene(folder / "bad.stl.gz"); }, ErrorCode::mesh_syntax,
               "byte 80 of the decompressed content");
}

TEST(ReadScene, StopsDecompressionAtItsLimit) {
  TemporaryDirectory folder;
  write_bytes(folder / "bomb.obj.gz", gzip(kObj + std::string(100000 - kObj.size(), '\n')));
  core::ReadLimits limits;
  limits.decompressed_bytes = 100000;
  const io::RawMesh mesh = io::read_mesh_file(folder / "bomb.obj.gz", {}, limits);
  EXPECT_EQ(mesh.triangles.size(), 1u);
  limits.decompressed_bytes = 99999;
  expect_error([&] { io::read_mesh_file(folder / "bomb.obj.gz", {}, limits); }, ErrorCode::file_too_large,
               "bomb.obj.gz");
}

TEST(ReadScene, SaysWhatATilesetIs) {
  TemporaryDirectory folder;
  const auto expect = [&](const std::string& name, const std::string& content) {
    write_bytes(folder / name, content);
    expect_error([&] { read_scene(folder / name); }, ErrorCode::mesh_unsupported, name);
  };
  const std::string begin = R"({"asset": {"version": "1.0"}, "geometricError": 500, "root": {"geometricError": 9,)";
  expect("tileset.json", begin + R"("children": [{"content": {"uri": "tiles/0.b3dm"}}]}})");
  expect("tileset.json", begin + R"("content": {"url": "a.b3dm"}, "children": [{"contents": [{"uri": "b.glb"}]}]}})");
  expect("tileset.json", begin + R"("children": []}})");
  expect("tileset.json", begin + R"("children": [)");  // cut off
  expect("tile.b3dm", std::string("b3dm\1\0\0\0\x1c\0\0\0", 12));
  expect("0.subtree", std::string("subt\1\0\0\0", 8));
  // Of these there is no GLB to take.
  expect("points.pnts", std::string("pnts\1\0\0\0\x1c\0\0\0", 12));
  expect("trees.i3dm", std::string("i3dm\1\0\0\0\x20\0\0\0", 12));
  expect("several.cmpt", std::string("cmpt\1\0\0\0\x10\0\0\0", 12));
  expect("tileset.json", begin + R"("content": {"uri": "a.pnts"}}})");
}

TEST(ReadScene, StopsDecompressionThatGrowsTooMuch) {
  TemporaryDirectory folder;
  const std::string part = gzip(std::string(std::size_t{1} << 24, '#'));
  std::string bomb;
  for (int i = 0; i < 8; ++i) bomb += part;  // 128 MiB of a comment in some kilobytes
  write_bytes(folder / "bomb.obj.gz", bomb);
  EXPECT_LT(bomb.size(), 1u << 18);
  try {
    read_scene(folder / "bomb.obj.gz");
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_too_large) << error.what();
  }
  const core::ReadLimits limits;
  EXPECT_EQ(limits.most_decompressed(1000), (64u << 20) + 32000u);
  EXPECT_EQ(limits.most_decompressed(std::uint64_t{1} << 40), limits.decompressed_bytes);
}

TEST(ReadScene, NamesFilesThatCannotBeRead) {
  TemporaryDirectory folder;
  const auto expect = [&](const std::string& name, ErrorCode code) {
    expect_error([&] { read_scene(folder / name); }, code, name);
  };
  expect("gone.obj", ErrorCode::file_not_found);
  expect("gone/gone.obj", ErrorCode::file_not_found);
  std::filesystem::create_directory(folder / "city.obj");
  expect("city.obj", ErrorCode::not_a_file);
  write_bytes(folder / "empty.obj", "");
  expect("empty.obj", ErrorCode::file_empty);
  ASSERT_EQ(::mkfifo((folder / "pipe.obj").c_str(), 0600), 0);
  expect("pipe.obj", ErrorCode::not_a_file);
  write_bytes(folder / "secret.obj", kObj);
  std::filesystem::permissions(folder / "secret.obj", std::filesystem::perms::none);
  if (::geteuid() != 0) {  // root may read everything
    testing::expect_code([&] { read_scene(folder / "secret.obj"); }, ErrorCode::file_unreadable, "secret.obj");
  }
  write_bytes(folder / "file", kObj);
  expect("file/a.obj", ErrorCode::file_unreadable);
}

TEST(ReadScene, RefusesWrongScalesAndFarCoordinates) {
  TemporaryDirectory folder;
  write_bytes(folder / "a.obj", kObj);
  for (const double scale :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_error([&] { read_scene(folder / "a.obj", {.scale = scale}); }, ErrorCode::value_out_of_range, "a.obj");
  }
  expect_error([&] { read_scene(folder / "a.obj", {.scale = 1e9}); }, ErrorCode::coordinate_too_large, "a.obj");
  expect_error([&] { read_scene(folder / "a.obj", {.scale = 1e308}); }, ErrorCode::coordinate_too_large, "a.obj");
}

/// Bytes changed, cut out, doubled: each file must be read, or refused with an input error.
TEST(ReadScene, SurvivesMutations) {
  const unsigned seed = 42;
  std::mt19937 random(seed);
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
      std::string(36, '\0') + '\3' + testing::bytes_of(0) + testing::bytes_of(1) + testing::bytes_of(2);
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0,"translation":[1,2,3]}],"meshes":[{"primitives":[{"attributes":)"
      R"({"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":)"
      R"([{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:;base64,)" +
      std::string(48, 'A') + "\"}]}";
  const std::string stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "endsolid a\n";
  int read = 0, refused = 0;
  for (const std::string& original : {kObj, ply, gltf, stl}) {
    EXPECT_EQ(testing::read_as("a", original).triangles.size(), 1u);
    for (int trial = 0; trial < 20000; ++trial) {
      std::string bytes = original;
      for (unsigned change = random() % 3 + 1; change > 0 && !bytes.empty(); --change) {
        const std::size_t at = random() % bytes.size(), length = random() % 9;
        switch (random() % 4) {
          case 0:
            bytes[at] = static_cast<char>(random());
            break;
          case 1:
            bytes[at] = "0123456789-. \n"[random() % 14];
            break;
          case 2:
            bytes.erase(at, length);
            break;
          default:
            bytes.insert(at, bytes.substr(random() % bytes.size(), length));
        }
      }
      try {
        testing::read_as("a", bytes);
        ++read;
      } catch (const Error& error) {
        ASSERT_EQ(error.kind(), ErrorKind::input) << "seed " << seed << ": " << error.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 1000);
  EXPECT_GT(refused, 1000);
}

TEST(ReadScene, ReportsProgressAndCanBeCancelled) {
  TemporaryDirectory folder;
  std::string large = kObj;
  for (int i = 0; i < 300000; ++i) large += "v 0.1234567 4785000.123 88.8\nf 1 2 3\n";
  write_bytes(folder / "large.obj.gz", gzip(large));
  std::set<std::string> stages;
  double last = 0;
  read_scene(folder / "large.obj.gz", {}, [&](std::string_view stage, double fraction) {
    if (stages.insert(std::string(stage)).second) last = 0;
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    return true;
  });
  EXPECT_EQ(stages, (std::set<std::string>{"read file", "decompress", "parse OBJ"}));
  for (const std::string& stop : stages) {
    try {
      read_scene(folder / "large.obj.gz", {}, [&](std::string_view stage, double) { return stage != stop; });
      ADD_FAILURE() << "not cancelled at " << stop;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
  }
}

// ---- real inputs ----

struct RealInput {
  const char* file;
  std::size_t triangles, objects;
  const char* object;  // one of them
};

class ReadRealScene : public ::testing::TestWithParam<RealInput> {};

TEST_P(ReadRealScene, HasItsTrianglesAndNames) {
  const RealInput& input = GetParam();
  VANTAGE_REQUIRE_SHARED(input.file);
  const Scene scene = read_scene(shared_data(input.file));
  EXPECT_EQ(scene.mesh.triangles.size(), input.triangles);
  EXPECT_EQ(scene.object_of.size(), input.triangles);
  EXPECT_EQ(scene.dropped_faces, 0u);
  EXPECT_EQ(scene.objects.size(), input.objects);
  const std::vector<std::string> names = names_of(scene.objects);
  EXPECT_EQ(std::count(names.begin(), names.end(), input.object), 1);
  for (const Triangle& triangle : scene.mesh.triangles) {
    for (const std::uint32_t corner : triangle) ASSERT_LT(corner, scene.mesh.vertices.size());
  }
  for (const std::uint32_t object : scene.object_of) ASSERT_LT(object, scene.objects.size());
}

INSTANTIATE_TEST_SUITE_P(
    All, ReadRealScene,
    ::testing::Values(RealInput{"charlotte/uptownCharlotte.obj", 7890, 184, "Building1"},
                      RealInput{"battcave/battcave.obj", 2183, 4, "terrain"},
                      RealInput{"battcave/v_002.obj", 19196, 1, "object 0"},
                      RealInput{"battcave/v_003.obj", 19196, 1, "object 0"},
                      RealInput{"battcave/v_005.obj", 19196, 1, "object 0"},
                      RealInput{"mesh/munich_merged.ply", 38938, 1, "munich_merged"},
                      RealInput{"mesh/florence_merged.ply", 35373, 1, "florence_merged"},
                      RealInput{"mesh/etoile_merged.ply", 13058, 1, "etoile_merged"},
                      RealInput{"mesh/simple_street_canyon_merged.ply", 74, 1, "simple_street_canyon_merged"},
                      RealInput{"mesh/openfoam-buildings.obj.gz", 400020, 1, "buildings11"},
                      RealInput{"mesh/delft-3dfier.obj.gz", 88670, 570, "bedabd859-00c8-11e6-b420-2bdcc4ab5d7f"},
                      RealInput{"mesh/delft-gltf/delft.gltf", 21801, 570, "b0a8da4cc-2d2a-11e6-9a38-393caa90be70"},
                      RealInput{"mesh/tour_part_dieu_0.obj", 1176, 1, "object 0"}),
    [](const ::testing::TestParamInfo<RealInput>& instance) {
      std::string name = std::filesystem::path(instance.param.file).filename().string();
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return name;
    });

TEST(ReadRealSceneValues, CoordinatesAreThoseOfTheFile) {
  const std::string delft = "mesh/delft-3dfier.obj.gz", charlotte = "charlotte/uptownCharlotte.obj";
  VANTAGE_REQUIRE_SHARED(delft);
  VANTAGE_REQUIRE_SHARED(charlotte);
  const Scene scene = read_scene(shared_data(delft));
  EXPECT_EQ(scene.mesh.vertices[0], Vec3(85012.343, 447455.577, 0.00));
  const Box box = bounding_box(read_scene(shared_data(charlotte), {.up = UpAxis::y}).mesh);
  EXPECT_NEAR(box.min.z(), 0, 1e-15);  // the ground
  EXPECT_GT(box.max.z(), 100);
}

}  // namespace
}  // namespace vantage
