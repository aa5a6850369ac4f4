#include "cli/usage_error.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "common/input.h"

namespace vantage::cli {
namespace {

constexpr const char* kWhere = "command line";

/// "--output" and "-o", as typed.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

bool has_option(const CLI::App& command, const std::string& name) {
  const std::vector<std::string> names = option_names(command);
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The first argument that looks like an option and is none of the command's. "-o=x" and "-ox" are options with their
/// values; of "-output" CLI11 takes the same view, and is seldom right.
std::optional<std::string> unknown_option(const CLI::App& command, const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    const std::string name = argument.substr(0, argument.find('='));
    const bool is_long = name.size() > 2 && name.starts_with("--") && is_letter(name[2]);
    const bool is_short = name.size() > 1 && name[0] == '-' && is_letter(name[1]);
    if (is_long && !has_option(command, name)) return name;
    if (is_short && (!has_option(command, name.substr(0, 2)) || has_option(command, "-" + name))) {
      if (!has_option(command, name)) return name;
    }
  }
  return std::nullopt;
}

/// What may have been meant; empty where nothing is like it.
std::string nearest_option(const CLI::App& command, const std::string& word) {
  const std::vector<std::string> names = option_names(command);
  const std::string long_form = word.starts_with("--") ? word : "-" + word;
  for (const std::string& name : names) {
    if (long_form.size() > 3 && name.starts_with(long_form)) return name;  // "--out", "-output"
  }
  const std::string nearest(nearest_name(word, std::vector<std::string_view>(names.begin(), names.end())));
  const auto slips = static_cast<std::size_t>(edit_distance(word, nearest));
  return slips <= 1 + word.size() / 4 ? nearest : "";
}

std::string other_command_with(const CLI::App& app, const std::string& option) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (has_option(*command, option)) return command->get_name();
  }
  return "";
}

Error unknown_option_error(const CLI::App& app, const CLI::App& command, const std::string& option) {
  const bool is_root = &command == &app;
  const std::string name = is_root ? "vantage" : "vantage " + command.get_name();
  const std::string list = "'" + name + " --help' lists " + (is_root ? "the commands" : "its options");
  std::string fix = list;
  const std::string nearest = nearest_option(command, option);
  const std::string other = nearest.empty() ? other_command_with(app, option) : "";
  if (!nearest.empty()) {
    fix = "did you mean '" + nearest + "'? " + list;
  } else if (!other.empty()) {
    fix = is_root ? "name the command first, as in 'vantage " + other + " " + option + "'"
                  : "it is an option of 'vantage " + other + "'; " + list;
  }
  return {ErrorCode::unknown_option, name + " has no option " + in_quotes(option), kWhere, fix};
}

}  // namespace

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

Error unknown_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string_view nearest = nearest_name(word, std::vector<std::string_view>(names.begin(), names.end()));
  return {ErrorCode::unknown_command, "there is no command " + in_quotes(word), kWhere,
          "did you mean '" + std::string(nearest) + "'? 'vantage --help' lists the commands"};
}

Error usage_error(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
  if (arguments.empty()) return {ErrorCode::command_line_syntax, "no command is given", kWhere, "see 'vantage --help'"};
  const CLI::App* command = find_command(app, arguments.front());
  const std::vector<std::string> rest(arguments.begin() + (command ? 1 : 0), arguments.end());
  // CLI11 may complain of something else first, say of the required option that was misspelt.
  if (const auto option = unknown_option(command ? *command : app, rest)) {
    return unknown_option_error(app, command ? *command : app, *option);
  }
  const auto split =
      std::find_if(rest.begin(), rest.end(), [](const std::string& word) { return word.ends_with(','); });
  if (split != rest.end() && split + 1 != rest.end()) {
    const std::string whole = *split + *(split + 1);
    return {ErrorCode::command_line_syntax,
            in_quotes(*split) + " and " + in_quotes(*(split + 1)) + " are two arguments", kWhere,
            "write them without the blank, " + whole + ", or in quotes"};
  }
  return {ErrorCode::command_line_syntax, error.what(), kWhere,
          command ? "see 'vantage " + command->get_name() + " --help'" : "see 'vantage --help'"};
}

}  // namespace vantage::cli
