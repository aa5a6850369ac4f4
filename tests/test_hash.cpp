// SHA-256 against the vectors of FIPS 180-4 and NIST's CAVP, and what the hashes of scenes and volumes depend on.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/sha256.h"
#include "support/internals.h"
#include "support/random.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

std::string sha256(std::string_view text) {
  core::Sha256 hash;
  hash.add(text);
  return hash.hex();
}

TEST(Sha256, GivesThePublishedDigests) {
  const std::pair<std::string, std::string> digests[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
       "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {std::string(1000000, 'a'), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"}};
  for (const auto& [text, digest] : digests) EXPECT_EQ(sha256(text), digest);
}

TEST(Sha256, DoesNotDependOnHowTheBytesArrive) {
  const std::string text(200, 'x');
  for (std::size_t split = 0; split <= text.size(); ++split) {
    core::Sha256 hash;
    hash.add(std::string_view{text}.substr(0, split));
    hash.add(std::string_view{text}.substr(split));
    EXPECT_EQ(hash.hex(), sha256(text)) << split;
  }
}

TEST(Sha256, InstructionsForItAgreeWithPlainCode) {
  testing::Random random(51);
  std::string bytes(64 * 20, ' ');
  for (char& byte : bytes) byte = static_cast<char>(random.integer(-128, 127));
  core::Sha256State by_processor{1, 2, 3, 4, 5, 6, 7, 8}, plain = by_processor;
  if (!core::sha256_blocks_by_processor(by_processor, bytes.data(), 20)) GTEST_SKIP() << "this processor has none";
  for (std::size_t at = 0; at < bytes.size(); at += 64) core::sha256_block(plain, bytes.data() + at);
  EXPECT_EQ(by_processor, plain);
}

TEST(Sha256, PlainCodeGivesThePublishedDigest) {
  // "abc", the bit that ends it, and its length in bits: FIPS 180-4, 5.1.1.
  std::string block = "abc\x80" + std::string(59, '\0') + '\x18';
  core::Sha256State state{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                          0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  core::sha256_block(state, block.data());
  EXPECT_EQ(state, (core::Sha256State{0xba7816bf, 0x8f01cfea, 0x414140de, 0x5dae2223, 0xb00361a3, 0x96177a9c,
                                      0xb410ff61, 0xf20015ad}));
}

Scene two_triangles() {
  Scene scene;
  scene.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.object_of = {0, 1};
  scene.objects.resize(2);
  return scene;
}

TEST(SceneHash, IsThatOfTheBytesInTheDocument) {
  // python3: hashlib.sha256(b"vantage scene 1\n" + struct.pack("<Q9dI9dI", 2, ...)).hexdigest()
  EXPECT_EQ(scene_hash(two_triangles()), "96fedf535c3695639fe597f3ad2b968e7f66efc3da1e2a11ba3d888e9998a3b7");
}

TEST(SceneHash, DependsOnTrianglesAndObjectsOnly) {
  const Scene scene = two_triangles();
  Scene same = scene;
  same.mesh.vertices.push_back({9, 9, 9});
  same.mesh.vertices.push_back(same.mesh.vertices[0]);
  same.mesh.triangles[1][0] = 5;  // a vertex at the same place
  same.mesh.vertices[0].z() = -0.0;
  EXPECT_EQ(scene_hash(same), scene_hash(scene));
  Scene other = scene;
  other.object_of[1] = 0;
  EXPECT_NE(scene_hash(other), scene_hash(scene));
  other = scene;
  other.mesh.vertices[3].z() = std::nextafter(0.5, 1.0);
  EXPECT_NE(scene_hash(other), scene_hash(scene));
  other = scene;
  std::swap(other.mesh.triangles[0], other.mesh.triangles[1]);
  EXPECT_NE(scene_hash(other), scene_hash(scene));
}

TEST(SceneHash, RefusesIndicesOutOfRange) {
  Scene scene = two_triangles();
  scene.mesh.triangles[1][2] = 4;
  EXPECT_THROW(scene_hash(scene), Error);
  scene = two_triangles();
  scene.object_of.pop_back();
  EXPECT_THROW(scene_hash(scene), Error);
}

TEST(VolumeHash, IsThatOfTheBytesInTheDocument) {
  EXPECT_EQ(volume_hash(two_triangles().mesh), "5b3b8d54c522045e7e19e6ed2fbf79b199de1013ef583f201aaad8584862a442");
}

}  // namespace
}  // namespace vantage
