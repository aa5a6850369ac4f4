#include <gtest/gtest.h>

#include "support/mesh_reading.h"
#include "support/objects.h"

namespace vantage::internal::io {
namespace {

using testing::expect_error;
using testing::expect_unreadable;
using testing::read_as;

using Names = std::vector<std::string>;
using Triangles = std::vector<Triangle>;

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ReadObj, KeepsCoordinatesToTheLastBit) {
  const RawMesh mesh =
      read_as("a.obj", "v 580000.123456789 4785000.987654321 1000.1\nv -1e-3 +.5 5.\nv 1E+2 1e-400 -0\nf 1 2 3\n");
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], Vec3(580000.123456789, 4785000.987654321, 1000.1));
  EXPECT_EQ(mesh.vertices[1], Vec3(-1e-3, 0.5, 5));
  EXPECT_EQ(mesh.vertices[2], Vec3(100, 0, 0));
  EXPECT_EQ(mesh.format, MeshFormat::obj);
}

TEST(ReadObj, UnderstandsAllWaysToNameACorner) {
  const RawMesh mesh = read_as("a.obj", kThree +
                                            "vt 0 0\nvn 0 0 1\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 "
                                            "2/1/1 3/1/1\nf -3 -2 -1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1 # done\n");
  EXPECT_EQ(mesh.triangles, Triangles(6, {0, 1, 2}));
}

TEST(ReadObj, UnderstandsAllLineEnds) {
  const RawMesh expected = read_as("a.obj", kThree + "o one\nf 1 2 3\n");
  for (const std::string& bytes :
       {std::string("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\no one\r\nf 1 2 3\r\n"),
        std::string("v 0 0 0\rv 1 0 0\rv 0 1 0\ro one\rf 1 2 3\r"),
        std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\no one\nf 1 2 3"),
        std::string("\xef\xbb\xbfv 0 0 \\\n0\nv 1 0 0\n\n\tv  0\t1 0 \no  one \nf 1 2\\\r\n 3\n"),
        std::string("vt 0 \\\n 0\n#no continuation \\\nv 0 0 0 1 0.5 0.5\nv 1 0 0\nv 0 1 0\no one\nf 1 2 3\\\n\n")}) {
    const RawMesh mesh = read_as("a.obj", bytes);
    EXPECT_EQ(mesh.vertices, expected.vertices) << bytes;
    EXPECT_EQ(mesh.triangles, expected.triangles) << bytes;
    EXPECT_EQ(mesh.objects, expected.objects) << bytes;
  }
}

TEST(ReadObj, NamesObjects) {
  const RawMesh mesh = read_as("a.obj", kThree +
                                            "f 1 2 3\n"
                                            "g wall\nf 1 2 3\ng roof tiles\nf 1 2 3\ng wall\nf 1 2 3\n"
                                            "o empty\no way/265517\ng part\nf 1 2 3\no Building 17 \nf 1 2 3\n"
                                            "o Building 17\nf 1 2 3\no\nf 1 2 3\ng roof tiles\nf 1 2 3\n");
  EXPECT_EQ(names_of(mesh.objects),
            (Names{"object 0", "wall", "roof tiles", "way/265517", "Building 17", "Building 17", "part"}));
  EXPECT_EQ(mesh.object_of, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 4, 5, 6, 2}));
}

TEST(ReadObj, TakesTheNamesOfGroupsWhereOneObjectHoldsAll) {
  // As OpenFOAM writes: an object for the file, a group for each zone. Groups may be scattered.
  const RawMesh city = read_as("a.obj", "o city\n" + kThree +
                                            "f 1 2 3\ng house 1\nf 1 2 3\ng house 2\nf 1 2 3\nf 2\n"
                                            "g house 1\nf 1 2 3\ng\nf 1 2 3\ng empty\no\n");
  EXPECT_EQ(names_of(city.objects), (Names{"city", "house 1", "house 2"}));
  EXPECT_EQ(city.object_of, (std::vector<std::uint32_t>{0, 1, 2, 1, 0}));

  const RawMesh late = read_as("a.obj", "o city\ng one\nf 1 2 3\ng two\nf 3 2 1\n" + kThree);
  EXPECT_EQ(names_of(late.objects), (Names{"one", "two"}));
  EXPECT_EQ(late.object_of, (std::vector<std::uint32_t>{0, 1}));
  // Other objects count only if they hold triangles; faces before the object have the names of their own groups.
  RawMesh mesh = read_as("a.obj", kThree + "o empty\nf 1 2\no city\ng one\nf 1 2 3\ng two\nf 1 2 3\n");
  EXPECT_EQ(names_of(mesh.objects), (Names{"one", "two"}));
  mesh = read_as("a.obj", kThree + "g hill\nf 1 2 3\no city\ng one\nf 1 2 3\ng two\nf 1 2 3\n");
  EXPECT_EQ(names_of(mesh.objects), (Names{"hill", "one", "two"}));
}

TEST(ReadObj, KeepsTheNamesOfObjectsWhoseGroupsAreParts) {
  // As OpenFOAM with one zone: the group tells nothing apart.
  const RawMesh mesh = read_as("a.obj", kThree + "o tower\ng zone0\nf 1 2 3\nf 1 2 3\n");
  EXPECT_EQ(names_of(mesh.objects), Names{"tower"});
  // As Blender with material groups.
  const RawMesh houses = read_as("a.obj", kThree +
                                              "o House\ng House_wall\nf 1 2 3\ng House_roof\nf 1 2 3\n"
                                              "o Shed\ng Shed_wall\nf 1 2 3\ng Shed_roof\nf 1 2 3\n");
  EXPECT_EQ(names_of(houses.objects), (Names{"House", "Shed"}));
  EXPECT_EQ(houses.object_of, (std::vector<std::uint32_t>{0, 0, 1, 1}));
  // As OSM2World: a group is the kind of the objects that follow.
  const RawMesh kinds = read_as("a.obj", kThree +
                                             "g Building\no Building0\nf 1 2 3\no Building1\nf 1 2 3\n"
                                             "g Parking\no Parking2\nf 1 2 3\ng Building\no Building3\nf 1 2 3\n");
  EXPECT_EQ(names_of(kinds.objects), (Names{"Building0", "Building1", "Parking2", "Building3"}));
}

TEST(ReadObj, CleansNames) {
  const RawMesh mesh = read_as("a.obj", kThree +
                                            "o Stra\xdf"
                                            "e\x01 \x7f\nf 1 2 3\no Stra\xc3\x9f"
                                            "e \xe2\x82\xac\nf 1 2 3\n"
                                            "o \xed\xa0\x80\nf 1 2 3\n");
  EXPECT_EQ(names_of(mesh.objects), (Names{"Stra\xc3\x9f"
                                           "e",
                                           "Stra\xc3\x9f"
                                           "e \xe2\x82\xac",
                                           "\xc3\xad\xc2\xa0"}))
      << "U+0080 is a control character";
}

TEST(ReadObj, CutsPolygonsAndCountsFacesWithoutArea) {
  const RawMesh mesh = read_as("a.obj", "v 0 0 0\nv 4 -2 0\nv 1 0 0\nv 4 2 0\nf 1 2 3 4\nf 1 2\nf 3\nf\nl 1 2\np 1\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.dropped_faces, 3u);
  Mesh cut{mesh.vertices, mesh.triangles};
  EXPECT_DOUBLE_EQ(surface_area(cut), 2);  // across the other diagonal it would be 14
}

TEST(ReadObj, AllowsVerticesAfterTheirFaces) {
  const RawMesh mesh =
      read_as("a.obj", "o late\nf 1 2 3\nf 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no b\nf 1 2 3\n");
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(names_of(mesh.objects), (Names{"late", "b"}));
  EXPECT_EQ(mesh.object_of, (std::vector<std::uint32_t>{1, 0, 0, 0}));
}

TEST(ReadObj, NamesThePlaceOfWhatIsWrong) {
  expect_unreadable("bad.obj", kThree + "f 1 2 4\n", ErrorCode::mesh_syntax, "bad.obj, line 4");
  expect_unreadable("bad.obj", kThree + "f 1 2 4294967297\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree + "f 1 2 99999999999999999999\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree + "f 1 2 -9223372036854775808\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree + "\n\nf 0 1 2\n", ErrorCode::mesh_syntax, "line 6");
  expect_unreadable("bad.obj", kThree + "f 1 2 -4\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree + "f 1 2 x\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree + "f 1 2 3.5\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree + "f 1 2 3/1/1/1\n", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", "v 0 0\n" + kThree, ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.obj", "v 0 0 1,5\n" + kThree, ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.obj", "v 0 0 0x10\n" + kThree, ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.obj", "v 0 nan 0\n" + kThree, ErrorCode::coordinate_not_finite, "line 1");
  expect_unreadable("bad.obj", kThree + "v 0 0 -inf\n", ErrorCode::coordinate_not_finite, "line 4");
  expect_unreadable("bad.obj", "v 1e999 0 0\n" + kThree, ErrorCode::coordinate_not_finite, "line 1");
  expect_unreadable("bad.obj", kThree + "f 1 2 3\nfacet 1 2 3\n", ErrorCode::mesh_syntax, "line 5");
  expect_unreadable("bad.obj", kThree + "f 1 2", ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.obj", kThree, ErrorCode::mesh_empty, "bad.obj");
  expect_unreadable("bad.obj", kThree + "f 1 2\n", ErrorCode::mesh_empty, "bad.obj");
  expect_unreadable("bad.obj", std::string("v 0 0\0 0\n", 9), ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.obj", std::string(64, '\0'), ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.obj", "\\", ErrorCode::mesh_syntax, "line 1");
}

TEST(ReadObj, RefusesPolygonsWithTooManyCorners) {
  core::ReadLimits limits;
  limits.corners = 4;
  EXPECT_EQ(read_as("a.obj", kThree + "f 1 2 3 3\n", limits).triangles.size(), 2u);
  expect_error([&] { read_as("a.obj", kThree + "f 1 2 3 3 3\n", limits); }, ErrorCode::mesh_too_large, "line 4");
}

TEST(ReadObj, RefusesFreeFormSurfacesAndOtherFiles) {
  for (const std::string line : {"curv 0 1 1 2 3", "surf 0 1 0 1 1 2 3 4", "bzp 1 2 3", "call other.obj"}) {
    expect_unreadable("bad.obj", kThree + "f 1 2 3\ncstype bspline\n" + line + "\n", ErrorCode::mesh_unsupported,
                      "line 6");
  }
}

TEST(ReadObj, PutsLinesAndPointsIntoTheLedger) {
  const RawMesh mesh = read_as("a.obj", kThree + "f 1 2 3\nv 0 0 9\no mast\nl 1/1 4\nl -1 2\np 4\n");
  ASSERT_EQ(mesh.ledger.size(), 2u);
  EXPECT_EQ(mesh.ledger[0].entry.object.name, "mast");
  EXPECT_EQ(mesh.ledger[0].entry.what, "2 lines");
  EXPECT_EQ(mesh.ledger[0].entry.box->max, Vec3(1, 0, 9));
  EXPECT_EQ(mesh.ledger[1].entry.box->min, Vec3(0, 0, 9));
}

// Whatever a quadrilateral means that is not flat lies between its two diagonals.
TEST(ReadObj, TakesBothDiagonalsWhereAFaceIsNotFlat) {
  const auto read_quad = [](const std::string& z) {
    return read_as("a.obj", "v 30 30 0\nv 40 30 " + z + "\nv 40 40 0\nv 30 40 " + z + "\no roof\nf 1 2 3 4\n");
  };
  EXPECT_EQ(read_quad("0").triangles.size(), 2u);
  EXPECT_EQ(read_quad("0.019").triangles.size(), 2u);  // within a centimetre of a plane
  const RawMesh mesh = read_quad("8");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}));
  EXPECT_TRUE(mesh.ledger.empty());
  EXPECT_TRUE(read_quad("0").notes.empty());
  ASSERT_EQ(mesh.notes.size(), 1u);
  testing::expect_wording(mesh.notes[0]);
  core::ReadLimits limits;
  limits.both_diagonals = false;
  const RawMesh once = read_as("a.obj", "v 30 30 0\nv 40 30 8\nv 40 40 0\nv 30 40 8\no roof\nf 1 2 3 4\n", limits);
  EXPECT_EQ(once.triangles.size(), 2u);
  EXPECT_EQ(once.ledger.size(), 1u);
  // Of more corners only one way is taken, and the ledger says how far it may be off.
  const RawMesh five = read_as("a.obj", "o roof\nv 0 0 0\nv 9 0 0\nv 9 9 2\nv 5 12 0\nv 0 9 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(five.triangles.size(), 3u);
  ASSERT_EQ(five.ledger.size(), 1u);
  EXPECT_EQ(five.ledger[0].entry.object.name, "roof");
  EXPECT_EQ(five.ledger[0].entry.box->max, Vec3(9, 12, 2));
  testing::expect_wording(five.ledger[0].entry.what + ": " + five.ledger[0].entry.reason);
  // One whose halves cancel out has no normal, and is not flat all the same.
  const RawMesh twisted = read_as("a.obj", "v 0 0 0\nv 1 2 0\nv 3 0 2\nv 0 2 0\nv 1 0 3\nv 1 2 1\nf 1 2 3 4 5 6\n");
  EXPECT_EQ(twisted.ledger.size(), 1u);
}

}  // namespace
}  // namespace vantage::internal::io
