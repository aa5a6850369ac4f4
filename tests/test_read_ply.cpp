#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/mesh_reading.h"
#include "support/objects.h"

namespace vantage::internal::io {
namespace {

using testing::bytes_of;
using testing::expect_unreadable;
using testing::read_as;

using Triangles = std::vector<Triangle>;

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

std::string mesh_header(const std::string& format, std::uint64_t vertices, std::uint64_t faces) {
  return header(format, "comment made by hand\nelement vertex " + std::to_string(vertices) +
                            "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                            std::to_string(faces) + "\nproperty list uchar int vertex_indices\n");
}

const std::string kText = mesh_header("ascii", 3, 1) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

template <class T>
std::string ordered(T value, bool big_endian) {
  std::string bytes = bytes_of(value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string replaced(std::string text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return text.replace(at, old_part.size(), new_part);
}

TEST(ReadPly, ReadsText) {
  const RawMesh mesh = read_as("block.ply", mesh_header("ascii", 4, 2) +
                                                "580000.123456789 4785000.987654321 1000.1\n1 0 0\n1 1 0\n0 1 0\n"
                                                "3 0 1 2\n4 0 1 2 3\n");
  EXPECT_EQ(mesh.format, MeshFormat::ply);
  EXPECT_EQ(mesh.vertices[0], Vec3(580000.123456789, 4785000.987654321, 1000.1));
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(names_of(mesh.objects), std::vector<std::string>{"block"});
}

TEST(ReadPly, ReadsBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = mesh_header(big ? "binary_big_endian" : "binary_little_endian", 3, 2);
    for (const double value : {580000.123456789, 4785000.987654321, 1000.1, 1., 0., 0., 0., 1., 0.})
      bytes += ordered(value, big);
    for (int face = 0; face < 2; ++face) {
      bytes += '\3';
      for (const std::int32_t index : {0, 1, 2}) bytes += ordered(index, big);
    }
    const RawMesh mesh = read_as("a.ply", bytes);
    EXPECT_EQ(mesh.vertices[0], Vec3(580000.123456789, 4785000.987654321, 1000.1));
    EXPECT_EQ(mesh.triangles, Triangles(2, {0, 1, 2}));
  }
}

/// Every type as a coordinate and as a corner, other properties and elements between, faces before vertices.
TEST(ReadPly, ReadsEveryTypeAndPassesOverTheRest) {
  const std::string elements =
      "element camera 1\nproperty float a\nproperty list uint short b\n"
      "element face 2\nproperty uchar red\nproperty list ushort uint8 vertex_index\nproperty list int double weights\n"
      "element vertex 4\nproperty list char char notes\nproperty int8 x\nproperty float64 w\nproperty int16 y\n"
      "property uint z\nelement tail 3\nproperty int32 q\n";
  for (const bool big : {false, true}) {
    std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian", elements);
    bytes += ordered(1.f, big) + ordered(std::uint32_t{2}, big) + ordered(std::int16_t{7}, big) +
             ordered(std::int16_t{8}, big);
    for (const int corners : {3, 4}) {
      bytes += '\xff' + ordered(static_cast<std::uint16_t>(corners), big);
      for (int i = 0; i < corners; ++i) bytes += static_cast<char>(i);
      bytes += ordered(std::int32_t{1}, big) + ordered(0.5, big);
    }
    const int x[] = {-128, 127, 127, -128}, y[] = {-300, -300, 300, 300};
    for (int i = 0; i < 4; ++i) {
      bytes += '\0';
      bytes += static_cast<char>(x[i]) + ordered(std::numeric_limits<double>::quiet_NaN(), big) +
               ordered(static_cast<std::int16_t>(y[i]), big) + ordered(std::uint32_t{4000000000u}, big);
    }
    bytes += std::string(12, 'q');
    const RawMesh mesh = read_as("a.ply", bytes);
    ASSERT_EQ(mesh.vertices.size(), 4u);
    EXPECT_EQ(mesh.vertices[2], Vec3(127, 300, 4e9));
    EXPECT_EQ(mesh.triangles.size(), 3u);
  }
  const RawMesh text =
      read_as("a.ply", header("ascii", elements) +
                           "1.5 2 7 8\n255 3 0 1 2 1 0.5\n0 4 0 1 2 3 0\n0 -128 nan -300 4000000000\n"
                           "1 5 127 nan -300 4000000000\n0 127 0 300 4000000000\n0 -128 0 300 4e9\n1 2 3");
  EXPECT_EQ(text.vertices[3], Vec3(-128, 300, 4e9));
  EXPECT_EQ(text.triangles.size(), 3u);
}

TEST(ReadPly, UnderstandsAllLineEndsOfTheHeader) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string bytes;
    for (const char c : mesh_header("binary_little_endian", 3, 1)) bytes += c == '\n' ? end : std::string(1, c);
    // The first byte of the rows is a line feed: it must not be taken for part of the header.
    bytes += "\n" + std::string(71, '\0') + '\3';
    for (const std::int32_t index : {0, 1, 2}) bytes += bytes_of(index);
    EXPECT_EQ(read_as("a.ply", bytes).triangles.size(), 1u) << end.size();
  }
}

TEST(ReadPly, NamesThePlaceOfWhatIsWrongInTheHeader) {
  expect_unreadable("bad.ply", "plywood", ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.ply", "ply", ErrorCode::mesh_syntax, "line 1");
  expect_unreadable("bad.ply", "ply\n", ErrorCode::mesh_syntax, "line 2");
  expect_unreadable("bad.ply", "ply\nformat ascii 1.0\n", ErrorCode::mesh_syntax, "line 3");
  expect_unreadable("bad.ply", replaced(kText, "ascii", "utf8"), ErrorCode::mesh_syntax, "line 2");
  expect_unreadable("bad.ply", replaced(kText, "1.0", "2.0"), ErrorCode::mesh_syntax, "line 2");
  expect_unreadable("bad.ply", replaced(kText, "format ascii 1.0\n", ""), ErrorCode::mesh_syntax, "line 9");
  expect_unreadable("bad.ply", replaced(kText, "vertex 3", "vertex -3"), ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.ply", replaced(kText, "vertex 3", "vertex 99999999999999999999"), ErrorCode::mesh_syntax,
                    "line 4");
  expect_unreadable("bad.ply", replaced(kText, "vertex 3", "vertex"), ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.ply", replaced(kText, "double y", "quad y"), ErrorCode::mesh_syntax, "line 6");
  expect_unreadable("bad.ply", replaced(kText, "double y", "double"), ErrorCode::mesh_syntax, "line 6");
  expect_unreadable("bad.ply", replaced(kText, "uchar int", "float int"), ErrorCode::mesh_syntax, "line 9");
  expect_unreadable("bad.ply", replaced(kText, "int vertex", "float vertex"), ErrorCode::mesh_syntax, "bad.ply");
  expect_unreadable("bad.ply", replaced(kText, "double y", "double v"), ErrorCode::mesh_syntax, "bad.ply");
  expect_unreadable("bad.ply", replaced(kText, "element vertex 3\n", ""), ErrorCode::mesh_syntax, "line 4");
  expect_unreadable("bad.ply", replaced(kText, "vertex 3", "vertices 3"), ErrorCode::mesh_empty, "bad.ply");
  expect_unreadable("bad.ply", replaced(kText, "face 1", "faces 1"), ErrorCode::mesh_empty, "bad.ply");
  expect_unreadable("bad.ply", replaced(kText, "comment", "commend"), ErrorCode::mesh_syntax, "line 3");
}

TEST(ReadPly, NamesThePlaceOfWhatIsWrongInText) {
  expect_unreadable("bad.ply", replaced(kText, "3 0 1 2", "3 0 1 3"), ErrorCode::mesh_syntax, "line 14");
  expect_unreadable("bad.ply", replaced(kText, "3 0 1 2", "3 0 1 -1"), ErrorCode::mesh_syntax, "line 14");
  expect_unreadable("bad.ply", replaced(kText, "3 0 1 2", "3 0 1 1.5"), ErrorCode::mesh_syntax, "line 14");
  expect_unreadable("bad.ply", replaced(kText, "3 0 1 2", "-3 0 1 2"), ErrorCode::mesh_syntax, "line 14");
  expect_unreadable("bad.ply", replaced(kText, "3 0 1 2", "3 0 1"), ErrorCode::mesh_syntax, "line 15");
  expect_unreadable("bad.ply", replaced(kText, "1 0 0", "1 abc 0"), ErrorCode::mesh_syntax, "line 12");
  expect_unreadable("bad.ply", replaced(kText, "1 0 0", "1 1e999 0"), ErrorCode::coordinate_not_finite, "line 12");
  expect_unreadable("bad.ply", replaced(kText, "face 1", "face 1000000000000"), ErrorCode::mesh_syntax, "line 14");
  expect_unreadable("bad.ply", replaced(kText, "vertex 3", "vertex 9223372036854775807"), ErrorCode::mesh_syntax,
                    "line 11");
}

TEST(ReadPly, NamesThePlaceOfWhatIsWrongInBinary) {
  const std::string head = mesh_header("binary_little_endian", 3, 1), rows(72, '\0');
  const std::string start = std::to_string(head.size()), face = std::to_string(head.size() + 73);
  const auto corners = [](std::int32_t last) { return '\3' + bytes_of(0) + bytes_of(1) + bytes_of(last); };
  EXPECT_EQ(read_as("a.ply", head + rows + corners(2)).triangles.size(), 1u);
  expect_unreadable("bad.ply", head + rows + corners(3), ErrorCode::mesh_syntax, "byte " + face);
  expect_unreadable("bad.ply", head + rows + corners(-1), ErrorCode::mesh_syntax, "byte");
  expect_unreadable("bad.ply", head + rows + corners(2).substr(0, 12), ErrorCode::mesh_syntax, "byte");
  expect_unreadable("bad.ply", head + rows.substr(1), ErrorCode::mesh_syntax, "byte " + start);
  expect_unreadable(
      "bad.ply",
      head + std::string(16, '\0') + bytes_of(std::numeric_limits<double>::infinity()) + rows.substr(24) + corners(2),
      ErrorCode::coordinate_not_finite, "byte " + start);
  const std::string huge = replaced(head, "uchar", "uint");
  expect_unreadable("bad.ply", huge + rows + bytes_of(std::uint32_t{4294967295u}) + bytes_of(1), ErrorCode::mesh_syntax,
                    "byte");
  const std::string other = replaced(huge, "vertex_indices", "others\nproperty list uchar int vertex_indices");
  expect_unreadable("bad.ply", other + rows + bytes_of(std::uint32_t{4294967295u}) + bytes_of(1),
                    ErrorCode::mesh_syntax, "byte");
}

/// An element whose rows take no space must not be counted through.
TEST(ReadPly, PassesOverElementsWithoutProperties) {
  const RawMesh mesh =
      read_as("a.ply", replaced(kText, "element vertex", "element nothing 9000000000000000000\nelement vertex"));
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(ReadPly, ReadsStripsOfTriangles) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const RawMesh mesh = read_as("a.ply", text + "11 0 1 2 3 -1 1 2 -1 3 2 1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {3, 2, 1}}));
  // Corners that repeat only lead on.
  EXPECT_EQ(read_as("a.ply", text + "6 0 1 1 2 3 3\n").triangles, (std::vector<Triangle>{{1, 2, 3}}));
}

TEST(ReadPly, PutsElementsThatReferToVerticesIntoTheLedger) {
  const RawMesh mesh = read_as(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nelement edge 2\nproperty int vertex1\nproperty int "
      "vertex2\nelement camera 1\nproperty float far\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 9\n3 0 1 2\n0 3\n1 77\n5\n");
  ASSERT_EQ(mesh.ledger.size(), 1u);
  EXPECT_EQ(mesh.ledger[0].entry.what, "2 of \"edge\"");
  EXPECT_EQ(mesh.ledger[0].entry.box->max, Vec3(1, 1, 9));
}

// Lists, and three numbers, may be polygons, whatever they are called. Colours are bytes.
TEST(ReadPly, PutsElementsWithListsIntoTheLedger) {
  const RawMesh mesh = read_as(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nelement polygon 1\nproperty list uchar int vertices\n"
      "element patch 2\nproperty list uchar int numbers\nelement camera 1\nproperty list uchar float weights\n"
      "element none 0\nproperty list uchar int indices\nelement triangle 1\nproperty int a\nproperty int b\n"
      "property int c\nelement material 1\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 9\n3 0 1 2\n3 0 1 3\n3 0 1 3\n1 2\n1 0.5\n0 1 3\n9 9 9\n");
  ASSERT_EQ(mesh.ledger.size(), 4u);
  EXPECT_EQ(mesh.ledger[2].entry.what, "1 of \"camera\"");
  EXPECT_EQ(mesh.ledger[3].entry.what, "1 of \"triangle\"");
  EXPECT_EQ(mesh.ledger[0].entry.what, "1 of \"polygon\"");
  EXPECT_EQ(mesh.ledger[0].entry.box->max, Vec3(1, 1, 9));
  EXPECT_EQ(mesh.ledger[1].entry.what, "2 of \"patch\"");
  EXPECT_FALSE(mesh.ledger[1].entry.box);
}

TEST(ReadPly, RefusesFacesThatItWouldNotRead) {
  const std::string vertices =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n1 1 9\n3 0 1 2\n";
  const std::string header = "ply\nformat ascii 1.0\n" + vertices;
  EXPECT_EQ(read_as("a.ply", header + "end_header\n" + rows + " \n\n").triangles.size(), 1u);
  testing::expect_error([&] { read_as("a.ply", header + "end_header\n" + rows + "3 0 1 3\n"); }, ErrorCode::mesh_syntax,
                        "a.ply");
  testing::expect_error([&] { read_as("a.ply", header + "property list uchar int vertex_index\nend_header\n" + rows); },
                        ErrorCode::mesh_syntax, "a.ply");
}

}  // namespace
}  // namespace vantage::internal::io
