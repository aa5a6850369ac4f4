#include "cli/command_table.h"

#include <algorithm>
#include <sstream>

namespace vantage::cli {
namespace {

/// Options whose list of words is open: they take numbers or coordinates too, so CLI11 has no list of theirs.
struct OpenList {
  const char* option;
  std::vector<std::string> words;
};
const std::vector<OpenList>& open_lists() {
  static const std::vector<OpenList> lists = {{"--device", {"auto", "cpu", "opengl", "gpu"}},
                                              {"--without", {"walls", "towers", "bridges", "trees"}},
                                              {"--view", {"top", "oblique", "from"}}};
  return lists;
}

/// The words of CLI::IsMember, which describes itself as "{exact,spheres}".
std::vector<std::string> listed_words(const std::string& type_name) {
  const std::size_t begin = type_name.find('{'), end = type_name.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> words;
  std::istringstream list(type_name.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

ValueKind kind_of(const OptionRow& row, bool is_positional) {
  if (!row.words.empty()) return ValueKind::word;
  if (row.value == "FOLDER") return ValueKind::folder;
  if (row.value == "FILE" || is_positional) return ValueKind::file;
  return row.value.empty() ? ValueKind::none : ValueKind::free_text;
}

OptionRow option_row(const CLI::Option& option) {
  OptionRow row;
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  const std::string& text = option.get_option_text();
  row.value = text.substr(0, text.find(" ("));
  row.is_required = option.get_required() || text.find("(required)") != std::string::npos;
  row.description = option.get_description();
  row.words = listed_words(option.get_type_name());
  for (const OpenList& list : open_lists()) {
    if (std::find(row.names.begin(), row.names.end(), list.option) != row.names.end()) row.words = list.words;
  }
  row.may_repeat = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  row.kind = kind_of(row, row.names.empty());
  return row;
}

CommandRow command_row(const CLI::App& command) {
  CommandRow row;
  row.description = command.get_description();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    (option->get_positional() ? row.positionals : row.options).push_back(option_row(*option));
  }
  row.sections = help_sections(command.get_footer());
  return row;
}

/// "EXIT CODES": nothing but capitals and blanks, from the first column on.
bool is_heading(const std::string& line) {
  return line.size() > 1 &&
         std::all_of(line.begin(), line.end(), [](char c) { return c == ' ' || (c >= 'A' && c <= 'Z'); }) &&
         line[0] != ' ';
}

}  // namespace

std::vector<HelpSection> help_sections(const std::string& text) {
  std::vector<HelpSection> sections;
  bool continues = false;  // the line belongs to the section before it
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) {
      continues = false;
      continue;
    }
    if (is_heading(line)) {
      sections.push_back({line, {}});
      continues = true;
      continue;
    }
    if (!continues) sections.emplace_back();
    sections.back().lines.push_back(line);
    continues = true;
  }
  return sections;
}

std::vector<CommandRow> command_table(const CLI::App& app) {
  std::vector<CommandRow> table = {command_row(app)};
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_group().empty()) continue;  // hidden
    table.push_back(command_row(*command));
    table.back().name = command->get_name();
  }
  std::vector<std::string> names;
  for (std::size_t i = 1; i < table.size(); ++i) names.push_back(table[i].name);
  for (CommandRow& row : table) {
    for (OptionRow& positional : row.positionals) {
      if (positional.value != "COMMAND") continue;
      positional.words = names;
      positional.kind = ValueKind::word;
    }
  }
  return table;
}

}  // namespace vantage::cli
