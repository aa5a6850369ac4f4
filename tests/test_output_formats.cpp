// The table of formats, and what is made of it.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "common/output.h"
#include "support/formats.h"
#include "support/temporary_directory.h"
#include "support/written_part.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

TEST(OutputFormats, AreDocumented) {
  std::string rows = "\n| extension | precision | what it holds |\n|---|---|---|\n";
  std::vector<FormatFacts> formats = known_formats();
  for (const FormatFacts& format : folder_formats()) formats.push_back(format);
  for (const FormatFacts& format : formats) {
    rows += "| `" + std::string(format.extension) + "` | " + (format.is_single ? "single" : "double") + " | " +
            std::string(format.holds) + " |\n";
  }
  testing::expect_between("docs/command-line.md", "<!-- formats: written by a test -->\n", "\n<!-- end of formats -->",
                          rows);
}

TEST(OutputFormats, AreToldApart) {
  std::set<std::string_view> names, extensions;
  for (const FormatFacts& format : known_formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_TRUE(extensions.insert(format.extension).second) << format.extension;
    EXPECT_EQ(format.extension, format_extension("v" + std::string(format.extension))) << "not in lower case";
    EXPECT_FALSE(format.holds.empty()) << format.name;
  }
}

TEST(OutputFormats, AreListed) {
  const std::vector<std::string> words = format_words();
  ASSERT_EQ(words.size(), known_formats().size());
  std::string list;
  for (const std::string& word : words) {
    if (!list.empty()) list += word == words.back() ? " or " : ", ";
    list += word;
  }
  EXPECT_EQ(format_words_text(), list);
  EXPECT_EQ(extensions_text().find('.'), 0U);
  for (const FormatFacts& format : known_formats()) {
    EXPECT_NE(extensions_text().find(format.extension), std::string::npos);
    EXPECT_NE(volume_extensions_text().find(format.extension), std::string::npos);
    EXPECT_EQ(double_extensions_text().find(format.extension) == std::string::npos,
              format.is_single || format.is_for_maps);
    EXPECT_EQ(scene_extensions_text().find(format.extension) == std::string::npos, format.is_for_maps);
    EXPECT_EQ(scene_frame_names_text().find(format.name) != std::string::npos, format.in_scene_frame);
  }
}

TEST(OutputFormats, FoldersAreToldFromFiles) {
  ASSERT_FALSE(folder_formats().empty());
  for (const FormatFacts& format : folder_formats()) {
    const std::string name = "a/v" + std::string(format.extension);
    for (const std::string& folder : {name, name + "/"}) {
      EXPECT_TRUE(is_folder_format(folder));
      EXPECT_EQ(volume_output(folder), name);
    }
    EXPECT_NE(volume_extensions_text().find(format.extension), std::string::npos);
    EXPECT_EQ(extensions_text().find(format.extension), std::string::npos);
    EXPECT_FALSE(format.holds.empty());
  }
  for (const FormatFacts& format : known_formats()) EXPECT_FALSE(is_folder_format("v" + std::string(format.extension)));
  EXPECT_EQ(volume_output("a/v.ply"), "a/v.ply");
  EXPECT_EQ(volume_output("a/"), "a/");
}

}  // namespace
}  // namespace vantage
