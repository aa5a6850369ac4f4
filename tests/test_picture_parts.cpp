// The camera of pictures, the edges that they draw, and the causes that are read for them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "io/read_causes.h"
#include "picture/annotate.h"
#include "picture/creases.h"
#include "picture/draw_list.h"
#include "picture/view.h"
#include "support/internals.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/scene.h"

namespace vantage {
namespace {

using picture::Crease;
using picture::find_creases;
using picture::make_view;
using picture::View;
using testing::make_box_mesh;

const std::vector<Vec3> kPoints = {{-10, -20, 0}, {30, 5, 12}, {0, 0, 40}, {7, -3, 25}};

View view_of(const PictureView& request) {
  Box bounds;
  for (const Vec3& point : kPoints) bounds.extend(point);
  return make_view(request, 400, 300, {10, 40, 20, 60}, kPoints, Vec3(1, 2, 3), bounds);
}

std::vector<PictureView> views() {
  PictureView top, oblique, from;
  top.kind = PictureView::Kind::top;
  oblique.azimuth_deg = 130;
  oblique.elevation_deg = 20;
  from.kind = PictureView::Kind::from;
  from.from = {80, -70, 50};
  return {top, oblique, from};
}

TEST(PictureView, FramesItsPointsTightlyWithinTheInsets) {
  for (const PictureView& request : views()) {
    const View view = view_of(request);
    Eigen::AlignedBox2d box;
    for (const Vec3& point : kPoints) box.extend(view.pixel(point));
    EXPECT_GE(box.min().x(), 10);
    EXPECT_GE(box.min().y(), 40);
    EXPECT_LE(box.max().x(), 380);
    EXPECT_LE(box.max().y(), 240);
    EXPECT_TRUE(box.sizes().x() > 0.95 * 370 || box.sizes().y() > 0.95 * 200) << box.sizes().transpose();
    EXPECT_NEAR(box.center().x(), 195, 1e-6);
    EXPECT_NEAR(box.center().y(), 140, 1e-6);
  }
}

TEST(PictureNotes, AreWrittenUnderTheSubtitle) {
  picture::Annotation annotation;
  annotation.title = "square";
  annotation.subtitle = "range 60 m";
  View view = view_of(views()[0]);
  view.width = 800;
  view.height = 600;
  const Picture paper{800, 600, std::vector<std::uint8_t>(std::size_t{4} * 800 * 600, 255)};
  const auto red_rows = [](const Picture& picture) {
    int first = picture.height, last = -1;
    for (int row = 0; row < picture.height; ++row) {
      for (int column = 0; column < picture.width; ++column) {
        const std::uint8_t* const pixel =
            &picture.rgba[4 * (static_cast<std::size_t>(row) * 800 + static_cast<std::size_t>(column))];
        if (pixel[0] < pixel[2] + 60) continue;
        first = std::min(first, row);
        last = std::max(last, row);
      }
    }
    return std::pair(first, last);
  };
  EXPECT_EQ(red_rows(annotated(paper, annotation, view)).second, -1);
  const double plain = insets_of(annotation, 800, 600).top;
  annotation.notes = {"the range reaches 12 m beyond the map"};
  const double one = insets_of(annotation, 800, 600).top;
  EXPECT_GT(one, plain + 5);
  const auto [first, last] = red_rows(annotated(paper, annotation, view));
  EXPECT_GT(first, plain / 2);
  EXPECT_LE(last, one);
  annotation.notes.assign(9, std::string(40, 'x') + " " + std::string(60, 'y') + " " + std::string(300, 'z'));
  const double many = insets_of(annotation, 800, 600).top;
  EXPECT_GT(many, one + 20);
  EXPECT_LT(many, 200) << "a picture must have room for what it shows";
  EXPECT_LE(red_rows(annotated(paper, annotation, view)).second, many);
}

TEST(PictureCredit, StandsAboveTheLegendOrAlone) {
  picture::Annotation annotation;
  View view = view_of(views()[0]);
  view.width = 800;
  view.height = 600;
  const Picture paper{800, 600, std::vector<std::uint8_t>(std::size_t{4} * 800 * 600, 255)};
  const auto ink_in_left_corner = [](const Picture& picture) {
    int dark = 0;
    for (int row = 500; row < 600; ++row) {
      for (int column = 0; column < 300; ++column) {
        dark += picture.rgba[4 * (static_cast<std::size_t>(row) * 800 + static_cast<std::size_t>(column))] < 128;
      }
    }
    return dark;
  };
  EXPECT_EQ(ink_in_left_corner(annotated(paper, annotation, view)), 0);
  const double plain = insets_of(annotation, 800, 600).bottom;
  annotation.credit = kOpenStreetMapCredit;
  EXPECT_GT(insets_of(annotation, 800, 600).bottom, plain + 5);
  EXPECT_GT(ink_in_left_corner(annotated(paper, annotation, view)), 100);
  EXPECT_GT(ink_in_left_corner(picture::credited(paper, annotation.credit)), 100);
  EXPECT_EQ(picture::credited(paper, "").rgba, paper.rgba);
}

TEST(PictureLegend, NamesMarksInsteadOfCauses) {
  Volume volume;
  volume.mesh = make_box_mesh({0, 0, 0}, {1, 1, 1});
  volume.cause_of.assign(12, 0);
  volume.causes = {{CauseKind::range, "max_range", 6}};
  PictureRequest request;
  request.volume = &volume;
  EXPECT_EQ(picture::legend_of(request).size(), 1u);
  request.marks = {{"open", {3, 4}}, {"too small", {}}, {"other", {5}}};
  const std::vector<picture::LegendEntry> legend = picture::legend_of(request);
  ASSERT_EQ(legend.size(), 3u);
  EXPECT_EQ(legend[1].label, "open");
  EXPECT_EQ(legend[1].remark, "2");
  EXPECT_EQ(legend[2].label, "other");
  EXPECT_EQ(legend[2].colour.red, legend[1].colour.red);
}

TEST(PictureView, ClipCoordinatesAgreeWithPixelsAndDepths) {
  const Vec3 origin(100, 200, 300);
  for (const PictureView& request : views()) {
    const View view = view_of(request);
    float nearest = 0, farthest = 2;
    double nearest_depth = 1e9, farthest_depth = 0;
    for (const Vec3& point : kPoints) {
      Eigen::Vector4f p;
      p << (point - origin).cast<float>(), 1;
      const Eigen::Vector4f clip = view.clip(origin, {0.25, -0.5}) * p;
      const Eigen::Vector3f ndc = clip.head<3>() / clip.w();
      EXPECT_NEAR(ndc.x(), (view.pixel(point).x() + 0.25) / 200 - 1, 1e-3);
      EXPECT_NEAR(ndc.y(), 1 - (view.pixel(point).y() - 0.5) / 150, 1e-3);
      EXPECT_GT(ndc.z(), 0);
      EXPECT_LT(ndc.z(), 1);
      if (view.depth(point) < nearest_depth) {
        nearest_depth = view.depth(point);
        nearest = ndc.z();
      }
      if (view.depth(point) > farthest_depth) {
        farthest_depth = view.depth(point);
        farthest = ndc.z();
      }
    }
    EXPECT_GT(nearest, farthest) << "depth is reversed";
  }
}

TEST(PictureView, LooksFromWhereItIsAskedTo) {
  const std::vector<PictureView> requests = views();
  EXPECT_EQ(view_of(requests[0]).up, Vec3::UnitY());
  EXPECT_NEAR(view_of(requests[1]).back.z(), std::sin(20 * std::numbers::pi / 180), 1e-12);
  const View from = view_of(requests[2]);
  EXPECT_EQ(from.eye, Vec3(80, -70, 50));
  EXPECT_NEAR((from.back - (from.eye - Vec3(1, 2, 3)).normalized()).norm(), 0, 1e-12);
}

TEST(PictureView, SurvivesPointsBehindTheCamera) {
  PictureView inside;
  inside.kind = PictureView::Kind::from;
  inside.from = {5, 0, 20};
  const View view = view_of(inside);
  EXPECT_TRUE(std::isfinite(view.pixels));
  EXPECT_GT(view.pixels, 0);
}

TEST(RoundLength, GoesByOneTwoFive) {
  EXPECT_DOUBLE_EQ(picture::round_length(1), 1);
  EXPECT_DOUBLE_EQ(picture::round_length(4.9), 2);
  EXPECT_DOUBLE_EQ(picture::round_length(73), 50);
  EXPECT_DOUBLE_EQ(picture::round_length(0.3), 0.2);
}

TEST(Creases, OfABoxAreItsEdges) {
  const Mesh box = make_box_mesh({0, 0, 0}, {2, 3, 4});
  const std::vector<Crease> creases = find_creases(box, {}, Vec3(0, 0, 9), Vec3::UnitZ(), false);
  EXPECT_EQ(creases.size(), 12U) << "no diagonals";
  for (const Crease& crease : creases) {
    EXPECT_EQ(((crease.a - crease.b).array() != 0).count(), 1);
    EXPECT_EQ(crease.strength, 1);
  }
}

TEST(Creases, StandWhereKindsMeetHoweverFlat) {
  Mesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto inner = [&](std::vector<std::uint8_t> kinds) {
    int count = 0;
    for (const Crease& crease : find_creases(flat, kinds, Vec3(0, 0, 9), Vec3::UnitZ(), false)) {
      count += (crease.a - crease.b).norm() > 1.1 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(inner({0, 0}), 0);
  EXPECT_EQ(inner({0, 1}), 1);
}

TEST(Creases, AreNotDrawnRoundSlivers) {
  // A flat strip with a thin triangle in its middle whose tip is a little off the plane: its own normal is far off.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {5, 1e-6, 1e-6}, {5, 5, 0}, {5, -5, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {0, 4, 1}};
  for (const Crease& crease : find_creases(mesh, {}, Vec3(0, 0, 9), Vec3::UnitZ(), false)) {
    const bool is_rim = crease.a.y() == 5 || crease.b.y() == 5 || crease.a.y() == -5 || crease.b.y() == -5;
    EXPECT_TRUE(is_rim) << crease.a.transpose() << " to " << crease.b.transpose();
  }
}

Volume two_causes() {
  Volume volume;
  volume.mesh = make_box_mesh({0, 0, 0}, {1, 2, 3});
  volume.causes = {{CauseKind::range, "max_range", 0}, {CauseKind::scene, "Building 17, south", 0}};
  for (std::size_t t = 0; t < volume.mesh.triangles.size(); ++t) {
    volume.cause_of.push_back(static_cast<std::uint32_t>(t % 2));
  }
  return volume;
}

TEST(ReadCauses, BringsBackWhatWasWritten) {
  const testing::TemporaryDirectory folder;
  const Volume written = two_causes();
  write_volume(written, folder / "v.ply");
  Volume read;
  read.mesh = read_scene(folder / "v.ply").mesh;
  io::read_causes(folder / "v.ply", read);
  EXPECT_EQ(read.cause_of, written.cause_of);
  ASSERT_EQ(read.causes.size(), 2U);
  EXPECT_EQ(read.causes[0].kind, CauseKind::range);
  EXPECT_EQ(read.causes[1].name, "Building 17, south");
  EXPECT_NEAR(read.causes[0].area_m2 + read.causes[1].area_m2, surface_area(read.mesh), 1e-9);
}

TEST(ReadCauses, TakesOtherFilesForPlainMeshes) {
  const testing::TemporaryDirectory folder;
  for (const std::string name : {"v.stl", "v.obj", "v.glb"}) {
    write_volume(two_causes(), folder / name);
    Volume read;
    read.mesh = read_scene(folder / name).mesh;
    io::read_causes(folder / name, read);
    EXPECT_TRUE(read.causes.empty()) << name;
    EXPECT_TRUE(read.cause_of.empty()) << name;
  }
}

TEST(ReadCauses, RefusesCausesOutOfRange) {
  const testing::TemporaryDirectory folder;
  write_volume(two_causes(), folder / "v.ply");
  std::string bytes = testing::read_bytes(folder / "v.ply");
  bytes[bytes.size() - 4] = 9;  // of the last facet
  testing::write_bytes(folder / "v.ply", bytes);
  Volume read;
  read.mesh = read_scene(folder / "v.ply").mesh;
  testing::expect_error([&] { io::read_causes(folder / "v.ply", read); }, ErrorCode::record_garbled, "v.ply");
}

}  // namespace
}  // namespace vantage
