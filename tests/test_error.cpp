#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/places.h"
#include "support/temporary_directory.h"
#include "support/wording.h"

namespace vantage {
namespace {

TEST(Error, KeepsItsParts) {
  const Error error(ErrorCode::output_unwritable, "full", "volume.ply", "free some", 7);
  EXPECT_EQ(error.code(), ErrorCode::output_unwritable);
  EXPECT_EQ(error.kind(), ErrorKind::output);
  EXPECT_EQ(error.problem(), "full");
  EXPECT_EQ(error.where(), "volume.ply");
  EXPECT_EQ(error.fix(), "free some");
  EXPECT_EQ(error.object(), 7U);
  EXPECT_EQ(Error(ErrorCode::internal_defect, "", "", "").object(), std::nullopt);
}

TEST(Error, SaysWhatWhereAndWhatToDoInThreeLines) {
  EXPECT_STREQ(Error(ErrorCode::not_a_file, "p", "w", "f").what(), "p\nw\nf");
}

TEST(Error, LeavesOutEmptyLines) {
  EXPECT_STREQ(Error(ErrorCode::not_a_file, "p", "", "f").what(), "p\nf");
  EXPECT_STREQ(Error(ErrorCode::internal_defect, "p", "", "").what(), "p");
}

TEST(Error, IsCaughtAsAStandardException) {
  EXPECT_THROW(throw Error(ErrorCode::cancelled, "stopped", "", ""), std::runtime_error);
}

TEST(Error, KeepsItsCodeWithOtherWords) {
  const Error error(ErrorCode::target_pierced, "p", "w", "f", 3);
  const Error there = error.with_where("there"), better = error.with_fix("better");
  EXPECT_STREQ(there.what(), "p\nthere\nf");
  EXPECT_STREQ(better.what(), "p\nw\nbetter");
  for (const Error& other : {there, better}) {
    EXPECT_EQ(other.code(), ErrorCode::target_pierced);
    EXPECT_EQ(other.object(), 3U);
  }
}

TEST(ErrorCodes, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const ErrorCode code : error_codes()) {
    const std::string name = name_of(code);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos) << name;
    EXPECT_EQ(error_code(name), code);
  }
  EXPECT_EQ(error_code("no-such"), std::nullopt);
  EXPECT_EQ(error_code(""), std::nullopt);
}

TEST(ErrorCodes, SayOfWhichKindTheyAre) {
  std::map<ErrorKind, int> number;
  for (const ErrorCode code : error_codes()) ++number[kind_of(code)];
  EXPECT_EQ(number[ErrorKind::cancelled], 1);
  EXPECT_EQ(number[ErrorKind::internal], 1);
  EXPECT_EQ(number[ErrorKind::output], 2);
}

/// The codes in the tables of the document, before its section of warnings or in it.
std::vector<std::string> documented(bool warnings) {
  std::ifstream stream(testing::source_folder() / "docs" / "errors.md");
  std::vector<std::string> codes;
  bool is_there = !warnings;
  for (std::string line; std::getline(stream, line);) {
    if (line == "## Warnings") is_there = warnings;
    if (is_there && line.starts_with("| `")) codes.push_back(line.substr(3, line.find('`', 3) - 3));
  }
  return codes;
}

// Programs go by the names: none may be renamed or left out. New ones are added to the document.
TEST(ErrorCodes, AreThoseOfTheDocument) {
  std::vector<std::string> declared;
  for (const ErrorCode code : error_codes()) declared.emplace_back(name_of(code));
  EXPECT_EQ(documented(false), declared);
}

TEST(WarningCodes, AreThoseOfTheDocument) {
  std::vector<std::string> declared;
  for (const WarningCode code : warning_codes()) declared.emplace_back(name_of(code));
  EXPECT_EQ(documented(true), declared);
}

// A code that nothing throws would be a promise to nobody.
TEST(ErrorCodes, AreAllThrown) {
  const std::filesystem::path source = testing::source_folder() / "src";
  std::string text;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source)) {
    if (entry.path().filename() == "error_codes.cpp" || !entry.is_regular_file()) continue;
    std::istringstream lines(testing::read_bytes(entry.path()));
    for (std::string line; std::getline(lines, line);) {
      const bool only_compares = line.find("= ErrorCode::") != std::string::npos;  // == and !=
      if (!only_compares) text += line.substr(0, line.find("//")) + "\n";
    }
  }
  for (const ErrorCode code : error_codes()) {
    std::string name = name_of(code);
    std::replace(name.begin(), name.end(), '-', '_');
    EXPECT_TRUE(std::regex_search(text, std::regex("ErrorCode::" + name + "\\b"))) << name;
  }
}

}  // namespace
}  // namespace vantage
