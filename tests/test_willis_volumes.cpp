// The volumes that the published program computed, computed anew: how many of their vertices agree with ours, and why
// the others do not.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

#include "depth/depth.h"
#include "support/cli_fixture.h"
#include "support/internals.h"
#include "support/shared_data.h"
#include "vantage/spheres.h"

namespace vantage::testing {
namespace {

constexpr int kSide = 40;            // texels along a face's side
constexpr double kRange = 100;       // metres
constexpr double kFloor = -1;        // metres, in the mesh's y
constexpr double kAgree = 0.1;       // metres
constexpr double kFewest = 0.999;    // of the vertices that must agree
constexpr double kSnap = 1.0 / 256;  // texels: the grid that OpenGL puts corners of triangles on when it draws them

/// A texel of a cube map as a point of the cube of half side kSide: two odd numbers and one of +-kSide.
using Texel = std::array<int, 3>;

/// Their faces in the order of their file: front, its left, back, its right, up, down, with front +x and up +y; rows
/// from below, columns from the left.
std::vector<Texel> their_texels() {
  using V = Eigen::Vector3i;
  const V front(1, 0, 0), up(0, 1, 0), right = front.cross(up);
  const std::array<std::array<V, 3>, 6> faces = {{{front, right, up},
                                                  {-right, front, up},
                                                  {-front, -right, up},
                                                  {right, -front, up},
                                                  {up, right, -front},
                                                  {-up, right, front}}};
  std::vector<Texel> texels;
  for (const auto& [forward, along, above] : faces) {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const V at = kSide * forward + (2 * column + 1 - kSide) * along + (2 * row + 1 - kSide) * above;
        texels.push_back({at.x(), at.y(), at.z()});
      }
    }
  }
  return texels;
}

/// Ours, in the order of depth::cube_faces, in the axes of the mesh: the cube's x, y, z are +x, -z, +y there.
std::vector<Texel> our_texels() {
  std::vector<Texel> texels;
  for (const depth::CubeFace& face : depth::cube_faces()) {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const Vec3 at = kSide * face.forward + (2 * column + 1 - kSide) * face.right + (2 * row + 1 - kSide) * face.up;
        texels.push_back({static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.z())),
                          static_cast<int>(std::lround(-at.y()))});
      }
    }
  }
  return texels;
}

Vec3 direction(const Texel& texel) { return Vec3(texel[0], texel[1], texel[2]).normalized(); }

bool is_cut(const Vec3& vertex) { return vertex.y() < kFloor + 1e-4; }

/// Where the rays of all vertices meet, by least squares: their file does not say.
Vec3 viewpoint_of(const std::vector<Vec3>& vertices, const std::vector<Texel>& texels) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vec3 right_side = Vec3::Zero();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (is_cut(vertices[i])) continue;
    const Vec3 d = direction(texels[i]);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
    sum += across;
    right_side += across * vertices[i];
  }
  return sum.inverse() * right_side;
}

double largest_distance_to_rays(const std::vector<Vec3>& vertices, const std::vector<Texel>& texels, const Vec3& from) {
  double largest = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!is_cut(vertices[i])) largest = std::max(largest, (vertices[i] - from).cross(direction(texels[i])).norm());
  }
  return largest;
}

/// Distance to the first triangle along a ray of length 1, at most kRange. Slow and plain.
double first_hit(const Mesh& mesh, const Vec3& from, const Vec3& along) {
  double nearest = kRange;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - from, b = mesh.vertices[t[1]] - from, c = mesh.vertices[t[2]] - from;
    const double u = along.dot(a.cross(b)), v = along.dot(b.cross(c)), w = along.dot(c.cross(a));
    const bool hits = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    const double at = a.dot(b.cross(c)) / (u + v + w);
    if (hits && at > 0) nearest = std::min(nearest, at);
  }
  return nearest;
}

/// Whether rays through the texel's centre, moved by the snapping of OpenGL, end as near and as far as theirs.
bool is_explained_by_snapping(const Mesh& scene, const Vec3& from, const Texel& texel, double theirs) {
  double low = kRange, high = 0;
  for (int step = 0; step < 9; ++step) {
    Vec3 at(texel[0], texel[1], texel[2]);
    int across = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(texel[axis]) == kSide) continue;
      at[axis] += 2 * kSnap * ((across++ == 0 ? step % 3 : step / 3) - 1);
    }
    const double hit = first_hit(scene, from, at.normalized());
    low = std::min(low, hit);
    high = std::max(high, hit);
  }
  return low - kAgree <= theirs && theirs <= high + kAgree;
}

class WillisVolumes : public Cli {
 protected:
  void run_config(const Vec3& viewpoint, const std::string& sphere) {
    std::ostringstream text;
    text.precision(6);
    text << std::fixed
         << "mesh:\n  id: battcave\n  format : OBJ\n  filename : " << shared_data("battcave/battcave.obj").string()
         << "\nvisibility_vol:\n  id: 0\n  width: 40\n  height: 40\n  fov_degrees: 90\n  origin: [" << viewpoint.x()
         << ", " << viewpoint.y() << ", " << viewpoint.z()
         << "]\n  front: [1.0, 0.0, 0.0]\n  up: [0.0, 1.0, 0.0]\n  up_max: 1000.0\n  up_min: -1.0\n"
         << "  radius_max: 100.0\n  output_file: v.obj\n";
    write("config.yaml", text.str());
    const ProgramRun done = run({"spheres", "-c", "config.yaml", "--device", "cpu", "--sphere", sphere});
    ASSERT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(done.err, "");
  }

  /// Ours says that it is y up, and is turned when it is read; theirs does not.
  Scene ours_as_in_the_file() const {
    Scene ours = read_scene(folder_ / "v.obj");
    EXPECT_EQ(ours.up, UpAxis::y);
    for (Vec3& v : ours.mesh.vertices) v = Vec3(v.x(), v.z(), -v.y());
    return ours;
  }

  void compare(const std::string& name) {
    const Scene theirs = read_scene(shared_data("battcave/" + name));
    const std::vector<Texel> texels = their_texels();
    ASSERT_EQ(theirs.mesh.vertices.size(), texels.size());
    const Vec3 viewpoint = viewpoint_of(theirs.mesh.vertices, texels);
    // Their file has six decimals; a wrong order of texels would be metres off.
    EXPECT_LT(largest_distance_to_rays(theirs.mesh.vertices, texels, viewpoint), 1e-3);
    run_config(viewpoint, "centers");
    const Scene ours = ours_as_in_the_file();
    EXPECT_EQ(ours.mesh.vertices.size(), theirs.mesh.vertices.size());
    EXPECT_EQ(ours.mesh.triangles.size(), theirs.mesh.triangles.size());
    std::map<Texel, Vec3> vertex_of;
    const std::vector<Texel> order = our_texels();
    for (std::size_t i = 0; i < order.size(); ++i) vertex_of[order[i]] = ours.mesh.vertices.at(i);
    ASSERT_EQ(vertex_of.size(), texels.size());

    const Scene scene = read_scene(shared_data("battcave/battcave.obj"));
    std::size_t agree = 0, explained = 0;
    double worst = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const Vec3& their_vertex = theirs.mesh.vertices[i];
      const double distance = (vertex_of.at(texels[i]) - their_vertex).norm();
      worst = std::max(worst, distance);
      if (distance <= kAgree) {
        ++agree;
      } else if (is_explained_by_snapping(scene.mesh, viewpoint, texels[i], (their_vertex - viewpoint).norm())) {
        ++explained;
      }
    }
    const double share = static_cast<double>(agree) / static_cast<double>(texels.size());
    std::printf(
        "%s: %zu of %zu vertices within %.1f m (%.3f %%), worst %.3f m; of the other %zu, %zu lie where a ray "
        "1/256 texel off ends too\n",
        name.c_str(), agree, texels.size(), kAgree, 100 * share, worst, texels.size() - agree, explained);
    EXPECT_GE(share, kFewest);
    EXPECT_EQ(agree + explained, texels.size());
  }
};

TEST_F(WillisVolumes, AgreeWithTheirsOfTarget2) {
  VANTAGE_REQUIRE_SHARED("battcave/v_002.obj");
  compare("v_002.obj");
}

TEST_F(WillisVolumes, AgreeWithTheirsOfTarget3) {
  VANTAGE_REQUIRE_SHARED("battcave/v_003.obj");
  compare("v_003.obj");
}

TEST_F(WillisVolumes, AgreeWithTheirsOfTarget5) {
  VANTAGE_REQUIRE_SHARED("battcave/v_005.obj");
  compare("v_005.obj");
}

// The safe sphere keeps to the floor, the range and what is in sight: from the viewpoint to the middles of its facets
// nothing is in the way. Theirs, which joins texel centres, shows that the check would notice.
TEST_F(WillisVolumes, ConservativeOnesClaimNothingHidden) {
  VANTAGE_REQUIRE_SHARED("battcave/v_002.obj");
  const Vec3 viewpoint(-14.638578, 0.5, -9.623141);
  const Scene scene = read_scene(shared_data("battcave/battcave.obj"));
  const auto hidden_facets = [&](const std::string& sphere) {
    run_config(viewpoint, sphere);
    const Mesh volume = ours_as_in_the_file().mesh;
    for (const Vec3& v : volume.vertices) {
      EXPECT_GE(v.y(), kFloor - 1e-9);
      EXPECT_LE((v - viewpoint).norm(), kRange * (1 + 1e-9));
    }
    std::size_t hidden = 0;
    for (std::size_t t = 0; t < volume.triangles.size(); t += 7) {
      Vec3 middle = Vec3::Zero();
      for (const std::uint32_t k : volume.triangles[t]) middle += volume.vertices[k] / 3;
      const Vec3 ray = middle - viewpoint;
      if (first_hit(scene.mesh, viewpoint, ray.normalized()) < ray.norm() * (1 - 1e-6)) ++hidden;
    }
    return hidden;
  };
  EXPECT_EQ(hidden_facets("conservative"), 0U);
  EXPECT_GT(hidden_facets("centers"), 0U);
}

/// A configuration of the small city with one volume; `more` is added to it.
std::string small_config(const std::string& volume, const std::string& mesh = "filename: city.obj") {
  return "world_coord_sys: {up: [0, 0, 1]}\nmesh: {" + mesh +
         "}\nvisibility_vol: {width: 8, height: 8, up: [0, 0, 1], " + volume + "}\n";
}

class SpheresCommand : public Cli {
 protected:
  void expect_bad_config(const std::string& text,
                         const std::string& where = "config.yaml:3:", const std::vector<std::string>& more = {}) {
    write("config.yaml", text);
    std::vector<std::string> arguments = {"spheres", "-c", "config.yaml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_bad(arguments, where);
  }
};

TEST_F(SpheresCommand, WritesEveryFormatInItsAxes) {
  const std::string block = "visibility_vol: {width: 8, height: 8, up: [0, 0, 1], origin: [0, 0, 3], radius_max: 20, ";
  write("config.yaml", "world_coord_sys: {up: [0, 0, 1]}\nmesh: {filename: city.obj}\n" + block +
                           "output_file: a.obj}\n" + block + "output_file: a.ply}\n");
  const std::string out = output_of({"spheres", "-c", "config.yaml"});
  EXPECT_NE(out.find("wrote "), std::string::npos);
  const Scene obj = read_scene(folder_ / "a.obj"), ply = read_scene(folder_ / "a.ply");
  ASSERT_EQ(obj.mesh.vertices.size(), 384U);
  ASSERT_EQ(ply.mesh.vertices.size(), 384U);
  double lowest = INFINITY;
  for (std::size_t i = 0; i < 384; ++i) {
    EXPECT_EQ(obj.mesh.vertices[i], ply.mesh.vertices[i]);
    EXPECT_LE((obj.mesh.vertices[i] - Vec3(0, 0, 3)).norm(), 20 * (1 + 1e-6));
    lowest = std::min(lowest, obj.mesh.vertices[i].z());
  }
  EXPECT_NEAR(lowest, 0, 1e-5) << "the ground";
}

TEST_F(SpheresCommand, TurnsTheCubeAndTheWorld) {
  // The same city, once z up and once y up: the same volume, turned.
  const Scene scene = read_scene(folder_ / "city.obj");
  std::ostringstream text;
  for (const Vec3& v : scene.mesh.vertices) text << "v " << v.x() << ' ' << v.z() << ' ' << -v.y() << '\n';
  for (const Triangle& t : scene.mesh.triangles) {
    text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  write("turned.obj", text.str());
  write("z.yaml", small_config("origin: [0, 0, 3], radius_max: 40, front: [0.6, 0.8, 0], output_file: z.ply"));
  write("y.yaml",
        "mesh: {filename: turned.obj}\nvisibility_vol: {width: 8, height: 8, origin: [0, 3, 0], radius_max: "
        "40, front: [0.6, 0, -0.8], output_file: y.ply}\n");
  output_of({"spheres", "-c", "z.yaml"});
  output_of({"spheres", "-c", "y.yaml"});
  const Scene z = read_scene(folder_ / "z.ply"), y = read_scene(folder_ / "y.ply");
  ASSERT_EQ(z.mesh.vertices.size(), y.mesh.vertices.size());
  for (std::size_t i = 0; i < z.mesh.vertices.size(); ++i) {
    EXPECT_LT((z.mesh.vertices[i] - y.mesh.vertices[i]).norm(), 1e-9);
  }
  // The first vertex that looks along the cube's front face does so along `front`, not along x.
  const Vec3 sum = std::accumulate(z.mesh.vertices.begin(), z.mesh.vertices.begin() + 64, Vec3(0, 0, 0));
  EXPECT_GT(sum.head<2>().normalized().dot(Eigen::Vector2d(0.6, 0.8)), 0.9);
}

TEST_F(SpheresCommand, PlacesTheMesh) {
  // Half a turn about z and 100 m up: the ground is at 100, the block at x = -30 to -20.
  write("config.yaml",
        small_config(
            "origin: [0, 0, 103], radius_max: 40, output_file: v.obj",
            "filename: city.obj, scale: [1, 1, 0.5], position: [0, 0, 100], 'orientation axis, angle': [0, 0, 1, "
            "180]"));
  output_of({"spheres", "-c", "config.yaml"});
  const Scene volume = read_scene(folder_ / "v.obj");
  double left = 0, right = 0, low = INFINITY;
  for (const Vec3& v : volume.mesh.vertices) {
    if (std::abs(v.y()) < 5 && std::abs(v.z() - 103) < 6) {
      left = std::min(left, v.x());
      right = std::max(right, v.x());
    }
    low = std::min(low, v.z());
  }
  EXPECT_NEAR(left, -20, 1e-3);
  EXPECT_GT(right, 30);
  EXPECT_NEAR(low, 100, 1e-4);
}

TEST_F(SpheresCommand, CutsHeights) {
  for (const std::string sphere : {"centers", "conservative"}) {
    write("config.yaml",
          small_config("origin: [0, 0, 3], radius_max: 40, up_min: 1, up_max: 9, output_file: " + sphere + ".ply"));
    output_of({"spheres", "-c", "config.yaml", "--sphere", sphere});
    const Scene volume = read_scene(folder_ / (sphere + ".ply"));
    double low = INFINITY, high = -INFINITY;
    for (const Vec3& v : volume.mesh.vertices) {
      low = std::min(low, v.z());
      high = std::max(high, v.z());
    }
    EXPECT_NEAR(low, 1, 1e-9);
    EXPECT_NEAR(high, 9, 1e-9);
  }
}

TEST_F(SpheresCommand, WithoutRadiusEndsBehindTheScene) {
  write("config.yaml", small_config("origin: [0, 0, 3], output_file: v.ply"));
  output_of({"spheres", "-c", "config.yaml"});
  double farthest = 0;
  for (const Vec3& v : read_scene(folder_ / "v.ply").mesh.vertices) {
    farthest = std::max(farthest, (v - Vec3(0, 0, 3)).norm());
  }
  EXPECT_NEAR(farthest, Vec3(100, 100, 9).norm(), 1e-3);
}

TEST_F(SpheresCommand, TellsUnknownKeys) {
  write("config.yaml", small_config("origin: [0, 0, 3], radius_max: 9, colour: red, output_file: v.ply"));
  const ProgramRun loud = run({"spheres", "-c", "config.yaml"});
  EXPECT_EQ(loud.exit_code, 0);
  EXPECT_NE(loud.err.find("config.yaml:3:"), std::string::npos) << loud.err;
  EXPECT_NE(loud.err.find("'colour'"), std::string::npos) << loud.err;
  testing::expect_wording(loud.err);
  EXPECT_EQ(output_of({"spheres", "-c", "config.yaml", "-q"}), "");
}

TEST_F(SpheresCommand, RefusesBadViewpoints) {
  expect_bad_config(small_config("origin: [25, 0, 6], output_file: volume.ply"), "block");
  expect_bad_config(small_config("origin: [25, 0, 6], output_file: volume.ply"));
  expect_bad_config(small_config("origin: [0, 0, 0], output_file: volume.ply"), "ground");
  expect_bad_config(small_config("origin: [0, .nan, 0], output_file: volume.ply"));
  expect_bad_config(small_config("origin: [0, 0, 3], fov_degrees: 91, output_file: volume.ply"));
}

TEST_F(SpheresCommand, RefusesBadFiles) {
  const std::string origin = "origin: [0, 0, 3], radius_max: 9, output_file: ";
  expect_bad_config(small_config(origin + "v.ply", "filename: none.obj"), "config.yaml:2:");
  expect_bad_config(small_config(origin + "v.ply", "filename: config.yaml"), "config.yaml");
  expect_bad_config(small_config(origin + "v.txt"));
  expect_bad_config(small_config(origin + "nowhere/v.ply"));
  expect_bad_config(small_config(origin + "city.obj"));
  expect_bad_config(small_config(origin + "."));
  expect_bad({"spheres", "-c", "none.yaml"}, "none.yaml");
  expect_bad({"spheres", "-c", "."}, ".");
  expect_bad({"spheres"}, "command line");
  expect_bad_config(small_config(origin + "v.ply"), "", {"--sphere", "round"});
  expect_bad_config(small_config(origin + "v.ply"), "", {"--device", "abacus"});
  expect_refused({"spheres", "-c", "config.yaml", "--device", "99"}, "0: CPU");  // with this machine's devices
}

TEST_F(SpheresCommand, WritesAllOrNothing) {
  // The second output cannot be written: the first, which could, is left as it was.
  fs::create_directory(folder_ / "open");
  write("open/v.ply", kOldOutput);
  const std::string block = "visibility_vol: {width: 8, height: 8, up: [0, 0, 1], origin: [0, 0, 3], radius_max: 20, ";
  expect_bad_config("world_coord_sys: {up: [0, 0, 1]}\nmesh: {filename: city.obj}\n" + block +
                        "output_file: open/v.ply}\n" + block + "output_file: gone/v.ply}\n",
                    "config.yaml:4:");
  // The disk is full while the second is written.
  options_.largest_file = 60000;
  write("config.yaml", "world_coord_sys: {up: [0, 0, 1]}\nmesh: {filename: city.obj}\n" + block +
                           "output_file: open/v.ply}\nvisibility_vol: {width: 40, height: 40, up: [0, 0, 1], origin: "
                           "[0, 0, 3], radius_max: 20, output_file: open/w.ply}\n");
  expect_bad({"spheres", "-c", "config.yaml"}, "open/w.ply");
  EXPECT_EQ(content(folder_ / "open/v.ply"), kOldOutput);
  EXPECT_FALSE(fs::exists(folder_ / "open/w.ply"));
}

TEST_F(SpheresCommand, KnowsOneFileByTwoNames) {
  fs::create_directory(folder_ / "open");
  fs::create_directory_symlink("open", folder_ / "alias");
  const std::string block = "visibility_vol: {width: 8, height: 8, up: [0, 0, 1], origin: [0, 0, 3], radius_max: 20, ";
  expect_bad_config("world_coord_sys: {up: [0, 0, 1]}\nmesh: {filename: city.obj}\n" + block +
                        "output_file: open/v.ply}\n" + block + "output_file: alias/v.ply}\n",
                    "config.yaml:4:");
}

}  // namespace
}  // namespace vantage::testing
