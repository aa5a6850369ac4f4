// Volumes of both sides of a target touch in the target's plane. What is made of them must be closed all the same:
// missions, reduced to a few triangles, for which the volume was not closed.
#include <gtest/gtest.h>

#include <string>

#include "support/formats.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "vantage/mission.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

class BothSidesMission : public ::testing::Test {
 protected:
  /// Runs the mission over the triangles of an OBJ file. Its volume must be closed, and stay so in each format.
  Volume run(const std::string& triangles, const std::string& mission) {
    testing::write_bytes(folder_ / "soup.obj", "o soup\n" + triangles);
    testing::write_bytes(folder_ / "mission.yaml", "scene: {mesh: soup.obj}\n" + mission);
    const Mission read = resolve_mission(read_mission(folder_ / "mission.yaml"));
    Volume volume = run_mission(read).volume;
    if (volume.outcome != Outcome::computed) return volume;
    EXPECT_EQ(testing::first_open_edge(volume.mesh), "");
    const MeshMeasures measures = measure(volume.mesh);
    EXPECT_TRUE(measures.closed && measures.oriented);
    EXPECT_GT(measures.volume_m3, 0);
    for (const std::string& name : testing::in_each_format("v")) {
      write_volume(volume, folder_ / name);
      EXPECT_EQ(find_open_edges(read_volume(folder_ / name).volume.mesh).count, 0U) << name;
    }
    return volume;
  }

  testing::TemporaryDirectory folder_;
};

TEST_F(BothSidesMission, OfSeveralTargetsThatAreAllSeen) {
  const Volume volume =
      run("v -1.8 -12.6 14.3\nv 7.5 -9.6 15.8\nv 0 -12.8 18.4\nf -3 -2 -1\n"
          "v -6.1 -12.4 17.8\nv -17 -16.8 16.1\nv -14.8 -8.1 13.9\nf -3 -2 -1\n"
          "v -16.7 -6.7 24\nv -11.9 -11.4 20.7\nv -19.9 -4.9 19.2\nf -3 -2 -1\n",
          "combine: all\n"
          "targets:\n"
          "  - {vertices: [[-3.2, 6.3, 10], [0.1, 6.9, 12.3], [1.1, 3.6, 7.9]], sides: both}\n"
          "  - {vertices: [[2.8, 6.1, 10.8], [1.2, 2.2, 10.2], [3.1, 7.5, 15.7]]}\n"
          "  - {vertices: [[9.9, 8.6, 10.9], [3.8, 2.8, 9.6], [3.6, 6, 15.2]], sides: both}\n"
          "sensor: {max_range: 44}\n"
          "exact: {tolerance: 0.05}\n");
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
}

TEST_F(BothSidesMission, OfTargetsOfWhichOneIsEnough) {
  const Volume volume =
      run("v -3.1 9.6 13\nv 6.2 2.3 13.9\nv 3.1 2.6 17.3\nf -3 -2 -1\n"
          "v -2.6 4.1 11.8\nv 5 7.4 10.1\nv -0.7 6 16.8\nf -3 -2 -1\n"
          "v 6.5 -3.8 7.6\nv 3.3 0 11.2\nv 4.7 -3.8 15.1\nf -3 -2 -1\n"
          "v -14.7 0.8 7.6\nv -11.7 -7.1 6\nv -7.9 -7.4 1\nf -3 -2 -1\n"
          "v 14.8 -11.5 19.4\nv 4.7 -10 21.7\nv 10.7 -5.3 17.5\nf -3 -2 -1\n"
          "v 2.4 15.7 4.4\nv 3.6 9.1 6.4\nv -6.5 16.1 11\nf -3 -2 -1\n",
          "combine: any\n"
          "targets:\n"
          "  - {vertices: [[-8.4, 4, 11.7], [-6.2, 0.9, 16.4], [-4.6, -0.7, 15.1]]}\n"
          "  - {vertices: [[2.2, 2.4, 9.5], [1.7, 7.3, 11.1], [3.8, 8.4, 9.8]], sides: both}\n"
          "  - {vertices: [[5.1, 0.6, 8.3], [5, 1.5, 9.5], [6, -2.5, 11.7]]}\n"
          "  - {point: [4, 1, 18]}\n"
          "sensor: {max_range: 34, min_range: 5, sun: {azimuth: 163, elevation: 32, exclude: 30}}\n"
          "exact: {tolerance: 0.05}\n");
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
}

TEST_F(BothSidesMission, OfOneTargetWithGimbalAndPixels) {
  const Volume volume =
      run("v -5.9 -10.6 5.9\nv -5 -10.7 8.7\nv -8.8 -8.4 14.2\nf -3 -2 -1\n",
          "target: {vertices: [[3.8, 4.7, 15.6], [6.9, 1.5, 15.8], [4.6, 0.5, 11.7]], sides: both}\n"
          "sensor: {max_range: 40, min_range: 7, fov: [31, 27], camera: {width: 4000, height: 3000},\n"
          "  gimbal: {pitch: [-56, 0], roll: 9}, pixel: {size: 0.0067, kind: perpendicular}}\n"
          "exact: {tolerance: 0.05}\n");
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
}

}  // namespace
}  // namespace vantage
