// What pictures show, pixel by pixel. Skipped where there is no OpenGL.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "common/output.h"
#include "support/opengl.h"
#include "support/scenes.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/error.h"
#include "vantage/picture.h"

namespace vantage {
namespace {

using testing::make_box_mesh;
using testing::SceneBuilder;

struct Pixel {
  int red, green, blue;
  bool operator==(const Pixel&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Pixel& p) { return out << p.red << "," << p.green << "," << p.blue; }

Pixel pixel(const Picture& picture, int column, int row) {
  const std::size_t at =
      4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(column));
  return {picture.rgba.at(at), picture.rgba.at(at + 1), picture.rgba.at(at + 2)};
}

bool is_red(const Pixel& p) { return p.red > 140 && p.green < 90 && p.blue < 110; }

Volume volume_of(const Mesh& mesh, CauseKind kind) {
  Volume volume;
  volume.mesh = mesh;
  volume.cause_of.assign(mesh.triangles.size(), 0);
  volume.causes = {{kind, "cause", surface_area(mesh)}};
  return volume;
}

/// A block on a ground, a target beside it; from the top, a metre takes four pixels and the origin is in the middle.
class RenderPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    VANTAGE_REQUIRE_OPENGL();
    scene_ = SceneBuilder().ground("ground", 100).box("block", {20, -5, 0}, {30, 5, 12}).scene();
    target_ = testing::target_of({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}});
    request_.target = &target_;
    request_.width = request_.height = 320;
    request_.annotate = false;
    request_.view.kind = PictureView::Kind::top;
    request_.frame = {{-40, -40, 0}, {40, 40, 20}};
  }

  Picture render() const { return render_picture(scene_, request_); }

  /// The pixel where a point of the ground is, from the top; the frame has a margin.
  static Pixel at(const Picture& picture, double x, double y) {
    const double pixels_per_metre = (320 - 16) / (80 * 1.03);
    return pixel(picture, static_cast<int>(160 + x * pixels_per_metre), static_cast<int>(160 - y * pixels_per_metre));
  }

  Scene scene_;
  Target target_;
  PictureRequest request_;
};

TEST_F(RenderPicture, HasTheSizeAskedForAndIsOpaque) {
  request_.width = 200;
  request_.height = 100;
  const Picture picture = render();
  EXPECT_EQ(picture.width, 200);
  EXPECT_EQ(picture.height, 100);
  ASSERT_EQ(picture.rgba.size(), 4U * 200 * 100);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) ASSERT_EQ(picture.rgba[i], 255);
}

TEST_F(RenderPicture, ShowsTheTargetWhereItIs) {
  const Picture picture = render();
  for (const double x : {-4.0, 0.0, 4.0}) {
    for (const double y : {-4.0, 0.0, 4.0}) EXPECT_TRUE(is_red(at(picture, x, y))) << at(picture, x, y);
  }
  for (const double x : {-7.0, 7.0, 25.0}) EXPECT_FALSE(is_red(at(picture, x, 0))) << at(picture, x, 0);
}

TEST_F(RenderPicture, ShowsEveryPartOfTheTarget) {
  EXPECT_FALSE(is_red(at(render(), -20, 25)));
  Target target = *request_.target;
  target.parts.push_back({{-25, 20, 0}, {-15, 20, 0}, {-15, 30, 0}, {-25, 30, 0}});
  request_.target = &target;
  const Picture picture = render();
  EXPECT_TRUE(is_red(at(picture, -20, 25)));
  EXPECT_TRUE(is_red(at(picture, 0, 0)));
}

TEST_F(RenderPicture, HasNorthUpAndEastRight) {
  target_ = testing::target_of({{-25, 20, 0}, {-15, 20, 0}, {-15, 30, 0}, {-25, 30, 0}});
  const Picture picture = render();
  EXPECT_TRUE(is_red(at(picture, -20, 25)));
  EXPECT_FALSE(is_red(at(picture, 20, 25)));
  EXPECT_FALSE(is_red(at(picture, -20, -25)));
}

TEST_F(RenderPicture, MovesTheTargetByItsOffset) {
  request_.view.kind = PictureView::Kind::oblique;
  request_.view.azimuth_deg = 270;
  request_.view.elevation_deg = 0;
  request_.frame = {{-40, 0, -40}, {40, 0, 40}};
  target_ = testing::target_of({{-5, 0, 5}, {5, 0, 5}, {5, 0, 15}, {-5, 0, 15}});
  target_.front = Vec3(0, -1, 0);
  EXPECT_TRUE(is_red(at(render(), 0, 10)));
  target_.parts[0] = {{-5, -5, 10}, {5, -5, 10}, {5, 5, 10}, {-5, 5, 10}};
  target_.front.reset();
  target_.offset_m = 20;
  request_.view.kind = PictureView::Kind::top;
  EXPECT_NO_THROW(render());
}

TEST_F(RenderPicture, TintsWhatIsUnderTheVolumeAndNothingElse) {
  const Volume volume = volume_of(make_box_mesh({-30, -30, 1}, {-10, 30, 15}), CauseKind::scene);
  const Picture without = render();
  request_.volume = &volume;
  const Picture with = render();
  for (const double y : {-22.0, 2.0, 22.0}) {
    const Pixel inside = at(with, -20, y);
    EXPECT_NE(inside, at(without, -20, y));
    EXPECT_GT(inside.blue, inside.red + 20) << inside;
  }
  for (const double x : {-36.0, 3.0, 15.0, 25.0}) EXPECT_EQ(at(with, x, 3), at(without, x, 3)) << x;
}

TEST_F(RenderPicture, ColoursByCause) {
  Volume volume = volume_of(make_box_mesh({-30, -30, 1}, {-10, 30, 15}), CauseKind::range);
  request_.volume = &volume;
  const Pixel orange = at(render(), -20, 22);
  EXPECT_GT(orange.red, orange.blue + 40) << orange;
  volume.causes[0].kind = CauseKind::navigation;
  const Pixel green = at(render(), -20, 22);
  EXPECT_GT(green.green, green.red + 20) << green;
  volume.causes.clear();
  volume.cause_of.clear();
  const Pixel plain = at(render(), -20, 22);
  EXPECT_GT(plain.blue, plain.red + 20) << plain;
}

TEST_F(RenderPicture, TintsMoreWhereMoreFacesLieBehindEachOther) {
  Mesh mesh = make_box_mesh({-30, -30, 1}, {-10, 30, 15});
  testing::append(mesh, make_box_mesh({-25, 10, 3}, {-15, 28, 12}));
  const Volume volume = volume_of(mesh, CauseKind::scene);
  request_.volume = &volume;
  const Picture picture = render();
  EXPECT_GT(at(picture, -20, -22).red, at(picture, -20, 22).red + 15);
}

TEST_F(RenderPicture, DoesNotDependOnTheOrderOfFacets) {
  Mesh mesh = make_box_mesh({-30, -30, 1}, {-10, 30, 15});
  testing::append(mesh, make_box_mesh({-25, 10, 3}, {-15, 28, 12}));
  testing::append(mesh, make_box_mesh({-20, -35, 2}, {-5, 20, 9}));  // through the first
  Volume volume = volume_of(mesh, CauseKind::scene);
  request_.volume = &volume;
  request_.view.kind = PictureView::Kind::oblique;
  request_.view.azimuth_deg = 235;
  const Picture one = render();
  std::reverse(volume.mesh.triangles.begin(), volume.mesh.triangles.end());
  EXPECT_TRUE(render().rgba == one.rgba);
}

TEST_F(RenderPicture, IsTheSameEachTime) {
  const Volume volume = volume_of(make_box_mesh({-30, -30, 1}, {10, 30, 15}), CauseKind::range);
  request_.volume = &volume;
  request_.view = PictureView{};
  request_.annotate = true;
  request_.title = "Straße \xFF nach\nOben";
  EXPECT_TRUE(render().rgba == render().rgba);
}

TEST_F(RenderPicture, ShowsTheTargetThroughABuildingAsThroughGlass) {
  request_.view.kind = PictureView::Kind::from;
  request_.frame = {{0, -20, 0}, {0, 20, 20}};
  // Of the target's pixels: how many, and the least green in them.
  const auto target_from = [&](const Vec3& camera) {
    request_.view.from = camera;
    const Picture picture = render();
    std::pair<int, int> found(0, 255);
    for (int row = 0; row < picture.height; ++row) {
      for (int column = 0; column < picture.width; ++column) {
        const Pixel p = pixel(picture, column, row);
        if (is_red(p)) found = {found.first + 1, std::min(found.second, p.green)};
      }
    }
    return found;
  };
  const auto [open_count, open_green] = target_from({-60, 0, 4});
  const auto [hidden_count, hidden_green] = target_from({60, 0, 4});
  EXPECT_GT(open_count, 40);
  EXPECT_GT(hidden_count, 40);
  EXPECT_GT(hidden_green, open_green + 15) << "paler";
}

TEST_F(RenderPicture, StandsWhereTheTargetIsSeenUnlessToldWhere) {
  scene_ = SceneBuilder().ground("ground", 100).box("wall", {-30, -30, 0}, {30, -10, 60}).scene();
  request_.view = PictureView{};
  request_.frame = {{-40, -40, 0}, {40, 40, 60}};
  const Picture picture = render();
  int reds = 0;
  for (int row = 0; row < 320; ++row) {
    for (int column = 0; column < 320; ++column) reds += is_red(pixel(picture, column, row)) ? 1 : 0;
  }
  EXPECT_GT(reds, 300) << "from the south the wall hides all of it";
}

TEST_F(RenderPicture, DrawsNavigationBoxes) {
  const Picture without = render();
  request_.navigation.keep_in = {Box{{-30, 10, 5}, {-10, 30, 15}}};
  const Picture with = render();
  const Pixel edge = at(with, -10, 20);
  EXPECT_NE(edge, at(without, -10, 20));
  EXPECT_GT(edge.green, edge.red) << edge;
  EXPECT_EQ(at(with, -20, 20), at(without, -20, 20));
}

TEST_F(RenderPicture, DrawsNavigationZones) {
  const Picture without = render();
  request_.navigation.keep_in = {testing::zone_of({{-30, 10}, {-10, 10}, {-10, 30}, {-30, 30}}, 5, INFINITY)};
  const Picture with = render();
  const Pixel edge = at(with, -10, 20);
  EXPECT_NE(edge, at(without, -10, 20));
  EXPECT_GT(edge.green, edge.red) << edge;
  EXPECT_EQ(at(with, -20, 20), at(without, -20, 20));
  request_.navigation.keep_out = std::move(request_.navigation.keep_in);
  request_.navigation.keep_in.clear();
  const Pixel out = at(render(), -10, 20);
  EXPECT_NE(out, at(without, -10, 20));
  EXPECT_NE(out, edge);
}

TEST_F(RenderPicture, MarksFacets) {
  const Volume volume = volume_of(make_box_mesh({-30, -30, 1}, {-10, 30, 10}), CauseKind::range);
  request_.volume = &volume;
  MarkedFacets top{"open", {}};
  for (std::uint32_t t = 0; t < volume.mesh.triangles.size(); ++t) {
    const Triangle& corners = volume.mesh.triangles[t];
    const bool is_top =
        std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return volume.mesh.vertices[v].z() == 10; });
    if (is_top) top.facets.push_back(t);
  }
  ASSERT_EQ(top.facets.size(), 2u);
  request_.marks = {{"open", {}}};
  const Pixel plain = at(render(), -15, 20);
  EXPECT_GT(plain.blue, plain.red) << plain;
  request_.marks = {top};
  const Pixel marked = at(render(), -15, 20);
  EXPECT_GT(marked.red, marked.green + 20) << marked;
  EXPECT_GT(plain.green, marked.green + 5) << plain;
  request_.marks = {{"open", {12}}};
  testing::expect_error([&] { render(); }, ErrorCode::index_out_of_range, "marks");
}

TEST_F(RenderPicture, KeepsItsDetailFarFromTheOrigin) {
  const Picture here = render();
  const Vec3 far(580000, 4785000, 200);
  for (Vec3& vertex : scene_.mesh.vertices) vertex += far;
  for (Vec3& vertex : target_.parts[0]) vertex += far;
  for (Vec3& point : request_.frame) point += far;
  const Picture there = render();
  EXPECT_TRUE(is_red(at(there, 4.5, 4.5)));
  EXPECT_FALSE(is_red(at(there, 6, 6)));
  EXPECT_FALSE(is_red(at(here, 6, 6)));
}

TEST_F(RenderPicture, RefusesWhatMakesNoSense) {
  const auto expect_refused = [&](ErrorCode code) { testing::expect_error([&] { render(); }, code); };
  for (const int size : {0, -5, 63, 4097}) {
    request_.width = size;
    expect_refused(ErrorCode::value_out_of_range);
  }
  request_.width = 320;
  request_.view.kind = PictureView::Kind::from;
  request_.view.from = Vec3::Zero();
  expect_refused(ErrorCode::direction_invalid);
  request_.view.kind = PictureView::Kind::top;
  Volume volume = volume_of(make_box_mesh({-30, -30, 1}, {-10, 30, 15}), CauseKind::scene);
  request_.volume = &volume;
  volume.cause_of[3] = 7;
  expect_refused(ErrorCode::index_out_of_range);
  volume.cause_of[3] = 0;
  volume.mesh.triangles[2][1] = 100;
  expect_refused(ErrorCode::index_out_of_range);
}

// Annotated or not: panels of sheets are not.
TEST_F(RenderPicture, NamesOpenStreetMapWhereTheSceneIsFromThere) {
  const Picture plain = render();
  const auto differing = [&](const Picture& picture) {
    int left_corner = 0, others = 0;
    for (int row = 0; row < 320; ++row) {
      for (int column = 0; column < 320; ++column) {
        if (pixel(picture, column, row) != pixel(plain, column, row)) ++(row > 280 ? left_corner : others);
      }
    }
    return std::pair(left_corner, others);
  };
  scene_.objects[1].source_id = "way/17";
  const auto [corner, others] = differing(render());
  EXPECT_GT(corner, 50);
  EXPECT_EQ(others, 0);
  const testing::TemporaryDirectory directory;
  write_png(plain, directory / "own.png");
  check_derived_output(directory / "own.png");
  testing::write_bytes(directory / "other.png", "\x89PNG\r\n\x1a\n and more");
  testing::expect_code([&] { check_derived_output(directory / "other.png"); }, ErrorCode::output_of_others);
}

TEST_F(RenderPicture, StopsWhenAsked) {
  const auto stop = [](std::string_view, double) { return false; };
  try {
    render_picture(scene_, request_, stop);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

Picture plain_picture(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(4 * static_cast<std::size_t>(width * height), 200)};
}

TEST(PictureSheet, ArrangesPanelsInRows) {
  const std::vector<PicturePanel> panels(5, {plain_picture(100, 60), "caption, not UTF-8: \xC3("});
  const Picture sheet = arrange_sheet(panels, 2, "title", "subtitle");
  EXPECT_GT(sheet.width, 200);
  EXPECT_LT(sheet.width, 300);
  EXPECT_GT(sheet.height, 180);
  EXPECT_EQ(sheet.rgba.size(), 4 * static_cast<std::size_t>(sheet.width * sheet.height));
  const int grey = static_cast<int>(std::count(sheet.rgba.begin(), sheet.rgba.end(), 200));
  EXPECT_GT(grey, 5 * 3 * 90 * 50) << "all five are there";
}

TEST(PictureSheet, RefusesPanelsThatDiffer) {
  EXPECT_THROW(arrange_sheet({}, 2, "", ""), Error);
  EXPECT_THROW(arrange_sheet({{plain_picture(10, 10), ""}, {plain_picture(10, 11), ""}}, 2, "", ""), Error);
  EXPECT_THROW(arrange_sheet({{plain_picture(10, 10), ""}}, 0, "", ""), Error);
}

TEST(WritePng, WritesPngWholeOrNotAtAll) {
  const testing::TemporaryDirectory folder;
  write_png(plain_picture(7, 5), folder / "a.png");
  const std::string bytes = testing::read_bytes(folder / "a.png");
  ASSERT_GT(bytes.size(), 24U);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1A\n");
  EXPECT_EQ(bytes[19], 7);
  EXPECT_EQ(bytes[23], 5);
  EXPECT_THROW(write_png(plain_picture(7, 5), folder / "missing/b.png"), Error);
  EXPECT_EQ(folder.names().size(), 1U);
}

}  // namespace
}  // namespace vantage
