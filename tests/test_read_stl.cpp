#include <gtest/gtest.h>

#include <limits>

#include "support/mesh_reading.h"
#include "support/objects.h"

namespace vantage::internal::io {
namespace {

using testing::bytes_of;
using testing::expect_unreadable;
using testing::read_as;

using Names = std::vector<std::string>;

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0.1\n endloop\nendfacet\n";

/// A binary STL of `count` facets; `announced` of them by its header.
std::string binary(std::uint32_t count, std::uint32_t announced, float z = 0.5f,
                   const std::string& header = "made by hand") {
  std::string bytes = header + std::string(80 - header.size(), ' ') + bytes_of(announced);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, z, 1.f, 0.f, z, 0.f, 1.f, z}) bytes += bytes_of(value);
    bytes += bytes_of(std::uint16_t{0});
  }
  return bytes;
}

TEST(ReadStl, ReadsTextWithItsSolids) {
  const RawMesh mesh =
      read_as("part.stl", "solid east wing\n" + kFacet + kFacet + "endsolid east wing\nsolid\r\n" + kFacet +
                              "endsolid\nSOLID upper\nFACET NORMAL nan nan -1.#IND\nOUTER LOOP\n"
                              "VERTEX 0 0 0 VERTEX 1 0 0 VERTEX 1 1 0 VERTEX 0 1 0\nENDLOOP ENDFACET "
                              "ENDSOLID\n");
  EXPECT_EQ(mesh.format, MeshFormat::stl);
  EXPECT_EQ(names_of(mesh.objects), (Names{"east wing", "part", "upper"}));
  EXPECT_EQ(mesh.object_of, (std::vector<std::uint32_t>{0, 0, 1, 2, 2}));
  EXPECT_EQ(mesh.vertices[2], Vec3(0, 1, 0.1));
}

TEST(ReadStl, ReadsBinary) {
  const RawMesh mesh = read_as("tower.stl", binary(2, 2));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(mesh.vertices[4], Vec3(1, 0, 0.5));
  EXPECT_EQ(names_of(mesh.objects), Names{"tower"});
  // Some programs begin binary files with "solid" too; and the name does not matter.
  EXPECT_EQ(read_as("a", binary(2, 2, 0.5f, "solid")).triangles.size(), 2u);
}

TEST(ReadStl, NamesThePlaceOfWhatIsWrong) {
  expect_unreadable("bad.stl", binary(2, 3), ErrorCode::mesh_syntax, "bad.stl, byte 80");
  expect_unreadable("bad.stl", binary(2, 4294967295u), ErrorCode::mesh_syntax, "byte 80");
  expect_unreadable("bad.stl", binary(3, 2), ErrorCode::mesh_syntax, "byte 80");
  expect_unreadable("bad.stl", binary(2, 4, 0, "solid"), ErrorCode::mesh_syntax, "byte 80");
  expect_unreadable("bad.stl", std::string("solid\0", 6), ErrorCode::mesh_syntax, "byte 6");
  expect_unreadable("bad.stl", "?", ErrorCode::mesh_syntax, "byte 1");
  expect_unreadable("bad.stl", binary(0, 0), ErrorCode::mesh_empty, "bad.stl");
  expect_unreadable("bad.stl", binary(2, 2, std::numeric_limits<float>::quiet_NaN()), ErrorCode::coordinate_not_finite,
                    "byte 96");
  expect_unreadable("bad.stl", "solid a\n" + kFacet, ErrorCode::mesh_syntax, "line 9");
  expect_unreadable("bad.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x", ErrorCode::mesh_syntax,
                    "line 4");
  expect_unreadable("bad.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf",
                    ErrorCode::coordinate_not_finite, "line 4");
  expect_unreadable("bad.stl", "solid a\nfacet normal 0 0 1\nvertex 0 0 0", ErrorCode::mesh_syntax, "line 3");
  expect_unreadable("bad.stl", "solid a\nfacette", ErrorCode::mesh_syntax, "line 2");
  expect_unreadable("bad.stl", "solid a\nendsolid a\n", ErrorCode::mesh_empty, "bad.stl");
  expect_unreadable("bad.stl", "solid a\n" + kFacet + "endsolid a\nrubbish\n", ErrorCode::mesh_syntax, "line 10");
}

TEST(ReadStl, PassesOverSomeBytesTooMany) {
  for (const std::size_t more : {1u, 2u, 49u}) {
    const RawMesh mesh = read_as("a.stl", binary(3, 3) + std::string(more, '\n'));
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(mesh.notes.size(), 1u);
  }
  testing::expect_code([] { read_as("a.stl", binary(3, 3) + std::string(50, '\0')); }, ErrorCode::mesh_syntax);
}

}  // namespace
}  // namespace vantage::internal::io
