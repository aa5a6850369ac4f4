// The commands and options of the program as plain tables. They come from the CLI11 objects that --help prints, so man
// pages and completions cannot differ from it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vantage::cli {

/// What completion offers for a value.
enum class ValueKind { none, file, folder, word, free_text };

struct OptionRow {
  std::vector<std::string> names;  ///< as typed, short ones first: "-o", "--output"; empty for a positional
  std::string value;               ///< as in the help text: "FILE"; empty for a flag
  std::string description;
  std::vector<std::string> words;  ///< values that completion offers
  ValueKind kind = ValueKind::none;
  bool is_required = false;
  bool may_repeat = false;
};

/// A part of a help text: lines under a heading in capitals, or a paragraph without one.
struct HelpSection {
  std::string title;  ///< empty for a paragraph without a heading
  std::vector<std::string> lines;
};

struct CommandRow {
  std::string name;  ///< "compute"; empty for the program
  std::string description;
  std::vector<OptionRow> positionals, options;
  std::vector<HelpSection> sections;
};

/// First the program, then every command that --help lists, in that order.
std::vector<CommandRow> command_table(const CLI::App& app);

/// The sections of a help text's end.
std::vector<HelpSection> help_sections(const std::string& text);

}  // namespace vantage::cli
