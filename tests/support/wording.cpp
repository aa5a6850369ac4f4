#include "support/wording.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "support/places.h"

namespace vantage::testing {
namespace {

namespace fs = std::filesystem;

/// Of a test "Suite.Name", the number of the call, from 1.
using Key = std::pair<std::string, int>;

fs::path golden_file() { return source_folder() / "tests" / "golden" / "messages.txt"; }

/// A header "[Suite.Name 2]", then the lines of the text, each after two blanks.
std::map<Key, std::string> read_golden() {
  std::map<Key, std::string> entries;
  std::ifstream stream(golden_file());
  Key key;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("[")) {
      const std::size_t blank = line.rfind(' ');
      key = {line.substr(1, blank - 1), std::atoi(line.c_str() + blank)};
      entries[key];
    } else if (line.starts_with("  ")) {
      std::string& text = entries[key];
      text += (text.empty() ? "" : "\n") + line.substr(2);
    }
  }
  return entries;
}

void write_golden(const std::map<Key, std::string>& entries) {
  fs::create_directories(golden_file().parent_path());
  std::ofstream stream(golden_file());
  stream << "The words of messages, by the test that brings them about. See tests/support/wording.h.\n";
  for (const auto& [key, text] : entries) {
    stream << "\n[" << key.first << " " << key.second << "]\n";
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) stream << "  " << line << "\n";
  }
}

/// What every run has elsewhere, and words that are PROJ's.
std::string without_places(std::string text) {
  static const std::regex proj("'proj_create: [^']*'");
  text = std::regex_replace(text, proj, "<PROJ>");
  static const std::regex folder(fs::temp_directory_path().string() + "/*vantage-[a-z]+-[A-Za-z0-9]{6}");
  text = std::regex_replace(text, folder, "<folder>");
  while (text.ends_with('\n')) text.pop_back();
  const std::string source = source_folder().string();
  for (std::size_t at = 0; (at = text.find(source, at)) != std::string::npos;)
    text.replace(at, source.size(), "<source>");
  return text;
}

bool is_updating() { return std::getenv("VANTAGE_UPDATE_GOLDEN") != nullptr; }

std::string name_of_test(const ::testing::TestInfo& test) {
  return std::string(test.test_suite_name()) + "." + test.name();
}

/// The golden file as this process sees it. With VANTAGE_UPDATE_GOLDEN it is written at the end.
class Golden : public ::testing::Environment {
 public:
  static Golden& instance() {
    static auto* const golden = static_cast<Golden*>(::testing::AddGlobalTestEnvironment(new Golden));
    return *golden;
  }

  void compare(const std::string& text) {
    const std::string test = name_of_test(*::testing::UnitTest::GetInstance()->current_test_info());
    const Key key(test, ++calls_[test]);
    const std::string said = without_places(text);
    if (is_updating()) {
      said_[key] = said;
      return;
    }
    const auto entry = entries_.find(key);
    const std::string expected = entry == entries_.end() ? "(no entry)" : entry->second;
    EXPECT_EQ(said, expected) << "[" << test << " " << key.second << "] of " << golden_file().string()
                              << "; where the new words are right, see tests/support/wording.h";
  }

  /// Of a test that ran to its end: no entry may be left of a call that it does not make any more.
  void expect_no_more_than_called(const std::string& test) const {
    if (is_updating()) return;
    const auto calls = calls_.find(test);
    const Key next(test, (calls == calls_.end() ? 0 : calls->second) + 1);
    EXPECT_FALSE(entries_.contains(next)) << "[" << test << " " << next.second << "] of " << golden_file().string()
                                          << " is of a call that the test does not make; see tests/support/wording.h";
  }

  const std::map<Key, std::string>& entries() const { return entries_; }

  /// Entries of tests that ran are replaced, those of tests that are no more are dropped.
  void TearDown() override {
    if (!is_updating()) return;
    std::set<std::string> all;
    const auto& tests = *::testing::UnitTest::GetInstance();
    for (int i = 0; i < tests.total_test_suite_count(); ++i) {
      const ::testing::TestSuite& suite = *tests.GetTestSuite(i);
      for (int j = 0; j < suite.total_test_count(); ++j) all.insert(name_of_test(*suite.GetTestInfo(j)));
    }
    for (const auto& [key, text] : entries_) {
      if (all.contains(key.first) && !calls_.contains(key.first)) said_[key] = text;
    }
    write_golden(said_);
  }

 private:
  std::map<Key, std::string> entries_ = read_golden(), said_;
  std::map<std::string, int> calls_;
};

class AfterEachTest : public ::testing::EmptyTestEventListener {
  void OnTestEnd(const ::testing::TestInfo& test) override {
    if (test.result()->Passed()) Golden::instance().expect_no_more_than_called(name_of_test(test));
  }
};

// Made before the tests run: an environment that is added later is not torn down.
[[maybe_unused]] const Golden& golden_at_start = []() -> const Golden& {
  ::testing::UnitTest::GetInstance()->listeners().Append(new AfterEachTest);
  return Golden::instance();
}();

TEST(Wording, OfNoTestThatIsNoMore) {
  std::set<std::string> all;
  for (const auto& [key, text] : Golden::instance().entries()) all.insert(key.first);
  const auto& tests = *::testing::UnitTest::GetInstance();
  for (int i = 0; i < tests.total_test_suite_count(); ++i) {
    const ::testing::TestSuite& suite = *tests.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) all.erase(name_of_test(*suite.GetTestInfo(j)));
  }
  EXPECT_TRUE(all.empty()) << *all.begin() << " has words in " << golden_file() << ", but there is no such test";
}

/// What is thrown, if it is an Error.
std::optional<Error> thrown_by(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

Error nothing_thrown() {
  ADD_FAILURE() << "nothing was thrown";
  return {ErrorCode::internal_defect, "nothing was thrown", "", ""};
}

void expect_three_lines(const Error& error) {
  EXPECT_FALSE(error.problem().empty());
  EXPECT_TRUE(!error.fix().empty() || error.kind() == ErrorKind::cancelled || error.kind() == ErrorKind::internal)
      << error.what();
  for (const std::string* part : {&error.problem(), &error.where(), &error.fix()}) {
    EXPECT_EQ(part->find('\n'), std::string::npos) << error.what();
  }
}

void expect_place(const Error& error, ErrorCode code, const std::string& where) {
  EXPECT_EQ(error.code(), code) << error.what();
  EXPECT_NE(error.where().find(where), std::string::npos) << error.what() << "\nno place: " << where;
}

}  // namespace

void expect_wording(const std::string& text) { Golden::instance().compare(text); }

void expect_wording(const std::vector<std::string>& texts) {
  std::string lines;
  for (const std::string& text : texts) lines += (lines.empty() ? "" : "\n") + text;
  expect_wording(lines);
}

Error error_of(const std::function<void()>& action) {
  const std::optional<Error> error = thrown_by(action);
  if (!error) return nothing_thrown();
  expect_three_lines(*error);
  expect_wording(error->what());
  return *error;
}

std::optional<ErrorCode> code_of(const std::function<void()>& action) {
  const std::optional<Error> error = thrown_by(action);
  if (!error) return std::nullopt;
  expect_three_lines(*error);
  expect_wording(error->what());
  return error->code();
}

Error expect_error(const std::function<void()>& action, ErrorCode code, const std::string& where) {
  Error error = error_of(action);
  expect_place(error, code, where);
  return error;
}

Error expect_code(const std::function<void()>& action, ErrorCode code, const std::string& where) {
  const std::optional<Error> error = thrown_by(action);
  if (!error) return nothing_thrown();
  expect_three_lines(*error);
  expect_place(*error, code, where);
  return *error;
}

}  // namespace vantage::testing
