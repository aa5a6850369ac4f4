// Man pages and completions: they say what --help says, and the tools that read them take them.
#include <regex>
#include <set>

#include "support/cli_fixture.h"

namespace vantage::testing {
namespace {

using Strings = std::vector<std::string>;

Strings matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern, std::regex::multiline);
  Strings found;
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) {
    found.push_back(match->size() > 1 ? match->str(1) : match->str());
  }
  return found;
}

/// A page as it is read: without fonts, and with the characters that roff needs escaped.
std::string plain(std::string page) {
  const std::pair<const char*, const char*> replacements[] = {{R"(\\f[BIR])", ""}, {R"(\\-)", "-"}, {R"(\\\(aq)", "'"},
                                                              {R"(\\\(ti)", "~"},  {R"(\\&)", ""},  {R"(\\e)", "\\"}};
  for (const auto& [pattern, text] : replacements) page = std::regex_replace(page, std::regex(pattern), text);
  return page;
}

/// Where a program lies; empty where it is not installed.
std::string found_program(const std::string& name) {
  std::string path = run_program("/bin/sh", {"-c", "command -v " + name}).out;
  while (path.ends_with('\n')) path.pop_back();
  return path;
}

class CliDocs : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(output_of({"docs", "man", "man"}), "");
    for (const std::string& line : lines(output_of({"--help"}))) {
      is_listed_ |= line == "Subcommands:";
      if (is_listed_ && line.empty()) break;
      for (const std::string& name : matches(line, "^  ([a-z][a-z-]+) ")) commands_.push_back(name);
    }
    ASSERT_GE(commands_.size(), 11U);
  }

  bool has_page(const std::string& command) const { return command != "help" && command != "version"; }

  std::string page(const std::string& command) const {
    return content(folder_ / "man" / (command.empty() ? "vantage.1" : "vantage-" + command + ".1"));
  }

  /// What bash would offer with the cursor at the end of the last word.
  std::set<std::string> completions(const Strings& words) const {
    std::string script = "source ./completion\nCOMP_WORDS=(";
    for (const std::string& word : words) script += "'" + word + "' ";
    script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) + "\n_vantage\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
    const ProgramRun result = run_program("/bin/bash", {"-c", script}, options_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    std::set<std::string> offered;
    for (const std::string& line : lines(result.out)) {
      if (!line.empty()) offered.insert(line);
    }
    return offered;
  }

  bool is_listed_ = false;
  Strings commands_;
};

TEST_F(CliDocs, EachCommandHasAPageAndIsInTheProgramsPage) {
  std::set<std::string> expected = {"vantage.1"}, found;
  const std::string program = plain(page(""));
  for (const std::string& command : commands_) {
    if (has_page(command)) expected.insert("vantage-" + command + ".1");
    EXPECT_NE(program.find("\n.TP\n" + command + "\n"), std::string::npos) << command;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "man")) {
    found.insert(entry.path().filename().string());
  }
  EXPECT_EQ(found, expected);
}

TEST_F(CliDocs, EachOptionOfTheHelpTextIsInThePage) {
  std::size_t count = 0;
  for (const std::string& command : commands_) {
    if (!has_page(command)) continue;
    const std::string text = plain(page(command));
    const Strings options = matches(output_of({command, "--help"}), "^  (?:-[a-z],)?(--[a-z-]+)");
    for (const std::string& option : options) {
      const std::regex row("\n[.]TP\n(-[a-z], )?" + option + "( [^\n]+)?\n[^.]");
      EXPECT_TRUE(std::regex_search(text, row)) << command << " " << option;
      ++count;
    }
  }
  EXPECT_GT(count, 80U);
}

TEST_F(CliDocs, ExamplesAndExitCodesAreThoseOfTheHelpText) {
  for (const std::string& command : commands_) {
    if (!has_page(command)) continue;
    const std::string help = output_of({command, "--help"}), text = plain(page(command));
    const std::string examples = help.substr(help.find("EXAMPLES\n"));
    for (const std::string& line : matches(examples.substr(0, examples.find("\n\n")), "^  (.+)$")) {
      EXPECT_NE(text.find("\n" + line + "\n"), std::string::npos) << command << ": " << line;
    }
    for (const std::string& code : matches(help.substr(help.find("EXIT CODES\n")), "^  ([0-9n+]+)  ")) {
      EXPECT_NE(text.find("\n.TP\n" + code + "\n"), std::string::npos) << command << ": " << code;
    }
  }
}

TEST_F(CliDocs, PagesAreInOrder) {
  const std::string mandoc = found_program("mandoc"), man = found_program("man");
  if (mandoc.empty() && man.empty()) GTEST_SKIP() << "neither mandoc nor man is installed";
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "man")) {
    const std::string file = entry.path().string();
    if (!mandoc.empty()) {
      for (const std::string& line : lines(run_program(mandoc, {"-T", "lint", "-W", "warning", file}).out)) {
        EXPECT_NE(line.find("missing date"), std::string::npos) << line;  // it would differ with each build
      }
    }
    if (man.empty()) continue;
    const ProgramRun result = run_program("/usr/bin/env", {"LC_ALL=C.UTF-8", man, "--warnings", "-Tutf8", "-l", file});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
  }
}

TEST_F(CliDocs, BashCompletes) {
  if (!fs::exists("/bin/bash")) GTEST_SKIP() << "bash is not installed";
  write("completion", output_of({"docs", "completion", "bash"}));
  write("volumes/a.ply", "");
  using Words = std::set<std::string>;
  EXPECT_EQ(completions({"vantage", "com"}), (Words{"compute", "compare"}));
  for (const std::string& command : commands_) EXPECT_TRUE(completions({"vantage", ""}).contains(command)) << command;
  EXPECT_EQ(completions({"vantage", "compute", "--me"}), (Words{"--method"}));
  EXPECT_EQ(completions({"vantage", "compute", "mission.yaml", "--method", ""}), (Words{"exact", "spheres"}));
  EXPECT_EQ(completions({"vantage", "compute", "--method", "=", "sp"}), (Words{"spheres"}));
  EXPECT_EQ(completions({"vantage", "compute", "--method", "="}), (Words{"exact", "spheres"}));
  EXPECT_EQ(completions({"vantage", "spheres", "--sphere", "c"}), (Words{"centers", "conservative"}));
  EXPECT_EQ(completions({"vantage", "devices", "--device", "g"}), (Words{"gpu"}));
  EXPECT_EQ(completions({"vantage", "help", "ver"}), (Words{"verify", "verify-tour", "version"}));
  EXPECT_EQ(completions({"vantage", "compute", "--stages", "vol"}), (Words{"volumes"}));
  EXPECT_EQ(completions({"vantage", "compute", "--threads", ""}), Words{});
  // Names of files come from bash itself, which knows how to quote them.
  EXPECT_EQ(completions({"vantage", "compute", "mis"}), Words{});
  for (const std::string& command : commands_) {
    const Words offered = completions({"vantage", command, "--"});
    for (const std::string& option : matches(output_of({command, "--help"}), "^  (?:-[a-z],)?(--[a-z-]+)")) {
      EXPECT_TRUE(offered.contains(option)) << command << " " << option;
    }
  }
}

TEST_F(CliDocs, ShellsReadTheirCompletions) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    write("completion", output_of({"docs", "completion", shell}));
    const std::string program = found_program(shell);
    if (program.empty()) continue;
    const ProgramRun result = run_program(program, {"-n", "completion"}, options_);
    EXPECT_EQ(result.exit_code, 0) << shell << result.err;
    EXPECT_EQ(result.err, "") << shell;
  }
}

TEST_F(CliDocs, WhatCompletionOffersIsTaken) {
  for (const char* kind : {"walls", "towers", "bridges", "trees"}) {
    const fs::path map = source_folder() / "examples" / "town" / "town.osm";
    EXPECT_EQ(run({"scene", map.string(), "--without", kind, "-q"}).exit_code, 0) << kind;
  }
  EXPECT_EQ(run({"devices", "--device", "auto"}).exit_code, 0);
  EXPECT_EQ(run({"devices", "--device", "cpu"}).exit_code, 0);
}

TEST_F(CliDocs, RefusesWhatItCannotWrite) {
  expect_bad({"docs", "completion", "tcsh"}, "command line");
  expect_bad({"docs", "man", "city.obj/man"}, "city.obj/man");
  expect_bad({"docs", "completion", "bash", "-o", "none/vantage"}, "none");
  expect_bad({"docs", "html", "folder"}, "command line");
}

}  // namespace
}  // namespace vantage::testing
