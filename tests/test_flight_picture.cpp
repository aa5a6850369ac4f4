// Pictures of flights: lines through the scene, and profiles.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "support/opengl.h"
#include "support/scenes.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/picture.h"

namespace vantage {
namespace {

using testing::SceneBuilder;

struct Rgb {
  int red, green, blue;
};

Rgb rgb(const Picture& picture, int column, int row) {
  const auto at =
      4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(column));
  return {picture.rgba.at(at), picture.rgba.at(at + 1), picture.rgba.at(at + 2)};
}

bool is_orange(const Rgb& p) { return p.red > 200 && p.green > 120 && p.green < 200 && p.blue < 60; }
bool is_dark(const Rgb& p) { return p.red < 130 && p.green < 130 && p.blue < 140; }
bool is_grey(const Rgb& p) { return std::abs(p.red - 176) < 6 && std::abs(p.green - 182) < 6; }

/// How many pixels of a column do so.
template <typename Does>
int count_in_column(const Picture& picture, int column, Does does) {
  int found = 0;
  for (int row = 0; row < picture.height; ++row) found += does(rgb(picture, column, row)) ? 1 : 0;
  return found;
}

Scene block_on_ground() { return SceneBuilder().ground("ground", 100).box("block", {20, -5, 0}, {30, 5, 12}).scene(); }

TEST(FlightPicture, LinesAreDrawnWhereTheyAre) {
  VANTAGE_REQUIRE_OPENGL();
  const Scene scene = block_on_ground();
  PictureRequest request;
  request.width = request.height = 320;
  request.annotate = false;
  request.view.kind = PictureView::Kind::top;
  request.frame = {{-40, -40, 0}, {40, 40, 20}};
  request.paths = {{"flight", {{-30, 20, 15}, {30, 20, 15}}, {{{0, 20, 15}, {20, 20, 15}}}, "seen"}};
  const Picture picture = render_picture(scene, request);
  const double scale = (320 - 16) / (80 * 1.03);
  // In so small a picture the line is about a pixel wide: the rows beside count, too.
  const auto shows = [&](double x, double y, bool (*is_so)(const Rgb&)) {
    const int column = static_cast<int>(160 + x * scale), row = static_cast<int>(160 - y * scale);
    return is_so(rgb(picture, column, row - 1)) || is_so(rgb(picture, column, row)) ||
           is_so(rgb(picture, column, row + 1));
  };
  for (const double x : {-25.0, -10.0, 25.0}) EXPECT_TRUE(shows(x, 20, is_dark)) << x;
  for (const double x : {5.0, 10.0, 15.0}) EXPECT_TRUE(shows(x, 20, is_orange)) << x;
  for (const double y : {10.0, 30.0}) EXPECT_FALSE(shows(10, y, is_dark) || shows(10, y, is_orange)) << y;
  request.paths[0].points.push_back({0, std::numeric_limits<double>::quiet_NaN(), 0});
  EXPECT_THROW(render_picture(scene, request), Error);
}

TEST(FlightPicture, FramesTheWholeLine) {
  VANTAGE_REQUIRE_OPENGL();
  const Scene scene = block_on_ground();
  PictureRequest request;
  request.width = request.height = 320;
  request.annotate = false;
  request.view.kind = PictureView::Kind::top;
  request.paths = {{"flight", {{-90, -60, 15}, {0, 0, 15}, {70, 80, 15}}, {}, ""}};
  const Picture picture = render_picture(scene, request);
  int dark = 0, on_border = 0;
  for (int row = 0; row < 320; ++row) {
    for (int column = 0; column < 320; ++column) {
      if (!is_dark(rgb(picture, column, row))) continue;
      ++dark;
      if (row < 4 || column < 4 || row > 315 || column > 315) ++on_border;
    }
  }
  EXPECT_GT(dark, 100);
  EXPECT_EQ(on_border, 0);
}

/// A flight over the block: the chart begins at 16 % of the width, and ends 0.9 letters before the right edge.
ProfileRequest over_the_block() {
  ProfileRequest request;
  request.points = {{-25, 0, 30}, {75, 0, 30}};
  request.width = 800;
  request.strips = {{"square", {{20, 40}, {60, 60}}}, {"roof", {}}};
  return request;
}

int column_of(const ProfileRequest& request, double at_m) {
  const double font = request.width / 75.0, left = 0.16 * request.width, right = request.width - 0.9 * font;
  return static_cast<int>(left + (right - left) * at_m / 100);
}

TEST(FlightPicture, AProfileShowsTheSceneAndWhatIsSeen) {
  const ProfileRequest request = over_the_block();
  const Picture picture = render_profile(block_on_ground(), request);
  EXPECT_EQ(picture.width, 800);
  // The block is from 45 to 55 m along the flight, 12 m high, and the flight at 30 m: grey for 12 of 30 and a bit.
  const int over = count_in_column(picture, column_of(request, 50), is_grey);
  const int beside = count_in_column(picture, column_of(request, 35), is_grey);
  EXPECT_NEAR(over - beside, 12.0 / (30 * 1.16) * 160, 6);
  for (const double at : {22.0, 30.0, 38.0}) EXPECT_GT(count_in_column(picture, column_of(request, at), is_orange), 4);
  for (const double at : {10.0, 45.0, 80.0}) EXPECT_EQ(count_in_column(picture, column_of(request, at), is_orange), 0);
  // Of hovering there is a line.
  int hovering = 0;
  for (int i = -2; i <= 2; ++i) hovering += count_in_column(picture, column_of(request, 60) + i, is_orange);
  EXPECT_GT(hovering, 4);
}

TEST(FlightPicture, AProfileGrowsWithItsStripsAndSaysWhatIsLeftOut) {
  ProfileRequest request = over_the_block();
  const int two = render_profile(block_on_ground(), request).height;
  request.strips.resize(12, {"more", {{0, 100}}});
  EXPECT_GT(render_profile(block_on_ground(), request).height, two);
  request.strips.resize(500, {"more", {{0, 100}}});
  EXPECT_LE(render_profile(block_on_ground(), request).height, kLargestPicture / 2 + 40);
}

TEST(FlightPicture, AProfileWithoutASceneIsDrawnToo) {
  ProfileRequest request = over_the_block();
  request.points = {{0, 0, 5}, {0, 0, 5}};  // hovering: no way at all
  request.strips.clear();
  EXPECT_GT(render_profile(Scene(), request).height, 0);
}

TEST(FlightPicture, RefusesWhatMakesNoSense) {
  const Scene scene = block_on_ground();
  ProfileRequest request = over_the_block();
  request.points.resize(1);
  EXPECT_THROW(render_profile(scene, request), Error);
  request = over_the_block();
  request.points[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(render_profile(scene, request), Error);
  request = over_the_block();
  request.strips[0].spans_m[0][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(render_profile(scene, request), Error);
  request = over_the_block();
  request.width = 63;
  EXPECT_THROW(render_profile(scene, request), Error);
  const Picture high{100, 3000, std::vector<std::uint8_t>(4UL * 100 * 3000, 255)};
  EXPECT_THROW(stack_pictures(high, high), Error);
}

TEST(FlightPicture, StacksInTheMiddle) {
  const Picture wide{4, 2, std::vector<std::uint8_t>(32, 10)}, small{2, 1, std::vector<std::uint8_t>(8, 200)};
  const Picture both = stack_pictures(wide, small);
  EXPECT_EQ(both.width, 4);
  EXPECT_EQ(both.height, 3);
  EXPECT_EQ(rgb(both, 0, 1).red, 10);
  EXPECT_EQ(rgb(both, 1, 2).red, 200);
  EXPECT_EQ(rgb(both, 0, 2).red, 255);  // paper
}

}  // namespace
}  // namespace vantage
