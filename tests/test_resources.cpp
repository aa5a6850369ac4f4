#include <gtest/gtest.h>
#include <proj.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "common/resources.h"
#include "geo/local_frame.h"
#include "picture/canvas.h"
#include "support/environment.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"

namespace vantage::internal {
namespace {

namespace fs = std::filesystem;

/// A resource folder for one test.
class Resources : public ::testing::Test {
 protected:
  void SetUp() override { set_resource_folder(folder()); }
  void TearDown() override { set_resource_folder(""); }

  fs::path folder() const { return scratch_.path() / "share"; }
  void put(const fs::path& file, const std::string& name) const {
    fs::create_directories((folder() / name).parent_path());
    fs::create_symlink(file, folder() / name);
  }
  const testing::TemporaryDirectory& scratch() const { return scratch_; }

 private:
  testing::TemporaryDirectory scratch_;
};

fs::path proj_database() {
  PJ_CONTEXT* const context = proj_context_create();
  const char* const path = proj_context_get_database_path(context);
  fs::path result = path ? path : "";
  proj_context_destroy(context);
  return result;
}

double width_of(const std::string& text, bool bold) {
  picture::Canvas canvas(100, 100);
  canvas.set_font(20, bold);
  return canvas.width_of(text);
}

TEST_F(Resources, AreOfTheFolderThatWasSet) {
  EXPECT_EQ(resource_folder(), folder());
  set_resource_folder("");
  EXPECT_EQ(resource_folder(), "");
}

TEST_F(Resources, HoldTheDatabaseOfProj) {
  const fs::path database = proj_database();
  ASSERT_TRUE(fs::exists(database));
  const testing::EnvironmentVariable nowhere("PROJ_DATA", scratch().path().c_str());
  testing::expect_code([] { geo::CoordinateSystem("EPSG:28992", "test"); }, ErrorCode::library_missing, "test");
  put(database, "proj/proj.db");
  EXPECT_EQ(geo::CoordinateSystem("EPSG:28992", "test").code(), "EPSG:28992");
}

TEST_F(Resources, WithoutADatabaseLeaveProjToItself) {
  fs::create_directories(folder() / "proj");
  EXPECT_EQ(geo::CoordinateSystem("EPSG:28992", "test").code(), "EPSG:28992");
}

TEST_F(Resources, HoldTheFontsOfPictures) {
  const fs::path mono = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";
  if (!fs::exists(mono)) GTEST_SKIP() << "no DejaVu Sans Mono";
  EXPECT_LT(width_of("iiii", false), 0.5 * width_of("mmmm", false));
  put(mono, "fonts/DejaVuSans.ttf");
  const double width = width_of("iiii", false);
  EXPECT_EQ(width, width_of("mmmm", false)) << "all its letters have one width";
  EXPECT_LT(width_of("iiii", true), width) << "the folder has no bold font";
}

TEST_F(Resources, WithoutAReadableFontLeaveCairoToItself) {
  fs::create_directories(folder() / "fonts");
  std::ofstream(folder() / "fonts" / "DejaVuSans.ttf") << "no font";
  const double width = width_of("text", false);
  set_resource_folder("");
  EXPECT_EQ(width, width_of("text", false));
}

}  // namespace
}  // namespace vantage::internal
