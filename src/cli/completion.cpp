#include "cli/completion.h"

#include <algorithm>
#include <string_view>

namespace vantage::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* separator = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// `text` with `escape` before each of `characters`.
std::string escaped(std::string_view text, std::string_view characters, std::string_view escape = "\\") {
  std::string result;
  for (const char c : text) {
    if (characters.find(c) != std::string_view::npos) result += escape;
    result += c;
  }
  return result;
}

std::string all_names(const std::vector<OptionRow>& options) {
  std::string text;
  for (const OptionRow& option : options) text += (text.empty() ? "" : " ") + joined(option.names);
  return text;
}

std::string command_names(const std::vector<CommandRow>& table) {
  std::vector<std::string> names;
  for (const CommandRow& row : table) {
    if (!row.name.empty()) names.push_back(row.name);
  }
  return joined(names);
}

// ---- bash ----

/// What to offer for a value: sets `words` or `offer`.
std::string bash_offer(const OptionRow& row) {
  switch (row.kind) {
    case ValueKind::word:
      return "offer=words; words='" + joined(row.words) + "'";
    case ValueKind::folder:
      return "offer=folders";
    case ValueKind::file:
      return "offer=files";
    case ValueKind::none:
    case ValueKind::free_text:
      break;
  }
  return "offer=nothing";
}

/// Cases "COMMAND OPTION" for options that take a value.
std::string bash_values(const CommandRow& row) {
  std::string text;
  for (const OptionRow& option : row.options) {
    if (option.kind == ValueKind::none) continue;
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "'" : " | '") + row.name + " " + name + "'";
    text += "    " + names + ") " + bash_offer(option) + " ;;\n";
  }
  return text;
}

/// What to offer where no option waits for its value.
std::string bash_otherwise(const CommandRow& row) {
  std::string text = "        " + row.name + ") if [[ $cur == -* ]]; then offer=words; words='" +
                     all_names(row.options) + "'; else " +
                     (row.positionals.empty() ? "offer=nothing" : bash_offer(row.positionals.front())) + "; fi ;;\n";
  return text;
}

// ---- zsh ----

/// For '...': a quote ends the string, is escaped, and begins it again.
std::string zsh_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// ":message:action" of _arguments.
std::string zsh_value(const OptionRow& row) {
  std::string action = " ";
  if (row.kind == ValueKind::word) action = "(" + joined(row.words) + ")";
  if (row.kind == ValueKind::file) action = "_files";
  if (row.kind == ValueKind::folder) action = "_files -/";
  return ":" + escaped(row.value, ":\\") + ":" + action;
}

std::string zsh_option(const OptionRow& option) {
  std::string text;
  for (const std::string& name : option.names) {
    std::string spec = option.may_repeat ? "*" : "(" + joined(option.names) + ")";
    spec += name;
    if (option.kind != ValueKind::none) spec += name.starts_with("--") ? "=" : "+";
    spec += "[" + escaped(option.description, "[]:\\") + "]";
    if (option.kind != ValueKind::none) spec += zsh_value(option);
    text += " \\\n        " + zsh_quoted(spec);
  }
  return text;
}

std::string zsh_command(const CommandRow& row) {
  std::string text = "    " + row.name + ")\n      _arguments -s";
  for (const OptionRow& option : row.options) text += zsh_option(option);
  for (std::size_t i = 0; i < row.positionals.size(); ++i) {
    text += " \\\n        " + zsh_quoted(std::to_string(i + 1) + zsh_value(row.positionals[i]));
  }
  return text + "\n      ;;\n";
}

// ---- fish ----

std::string fish_quoted(const std::string& text) { return "'" + escaped(text, "'\\") + "'"; }

std::string fish_offer(const OptionRow& row) {
  switch (row.kind) {
    case ValueKind::word:
      return " -x -a " + fish_quoted(joined(row.words));
    case ValueKind::folder:
      return " -x -a '(__fish_complete_directories)'";
    case ValueKind::file:
      return " -r -F";
    case ValueKind::free_text:
      return " -x";
    case ValueKind::none:
      break;
  }
  return "";
}

std::string fish_option(const std::string& condition, const OptionRow& option) {
  std::string text = "complete -c vantage -n " + fish_quoted(condition);
  for (const std::string& name : option.names) {
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return text + fish_offer(option) + " -d " + fish_quoted(option.description) + "\n";
}

}  // namespace

std::string bash_completion(const std::vector<CommandRow>& table) {
  std::string values, otherwise;
  for (const CommandRow& row : table) {
    values += bash_values(row);
    if (!row.name.empty()) otherwise += bash_otherwise(row);
  }
  return "# Completion of vantage for bash, written by 'vantage docs completion bash'.\n"
         "_vantage() {\n"
         "  local cur=\"${COMP_WORDS[COMP_CWORD]}\" prev=\"${COMP_WORDS[COMP_CWORD - 1]}\"\n"
         "  local command= offer=files words=\n"
         "  COMPREPLY=()\n"
         "  ((COMP_CWORD > 1)) && command=\"${COMP_WORDS[1]}\"\n"
         "  # bash takes --method=exact for three words.\n"
         "  if [[ $cur == = ]]; then\n"
         "    cur=\n"
         "  elif [[ $prev == = ]]; then\n"
         "    prev=\"${COMP_WORDS[COMP_CWORD - 2]}\"\n"
         "  fi\n"
         "  case \"$command $prev\" in\n" +
         values +
         "    *)\n"
         "      case \"$command\" in\n"
         "        '') offer=words; words='" +
         command_names(table) + " " + all_names(table.front().options) + "' ;;\n" + otherwise +
         "      esac ;;\n"
         "  esac\n"
         "  # Files are what bash offers where nothing else is.\n"
         "  [[ $offer == files ]] && return\n"
         "  compopt +o default 2>/dev/null\n"
         "  if [[ $offer == folders ]]; then\n"
         "    compopt -o filenames 2>/dev/null\n"
         "    mapfile -t COMPREPLY < <(compgen -d -- \"$cur\")\n"
         "  elif [[ $offer == words ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
         "  fi\n"
         "}\n"
         "complete -o default -F _vantage vantage\n";
}

std::string zsh_completion(const std::vector<CommandRow>& table) {
  std::string names, commands;
  for (const CommandRow& row : table) {
    if (row.name.empty()) continue;
    names += "      " + zsh_quoted(escaped(row.name, ":\\") + ":" + row.description) + "\n";
    commands += zsh_command(row);
  }
  std::string options;
  for (const OptionRow& option : table.front().options) options += zsh_option(option);
  return "#compdef vantage\n"
         "# Completion of vantage for zsh, written by 'vantage docs completion zsh'.\n"
         "_vantage() {\n"
         "  if (( CURRENT == 2 )); then\n"
         "    local -a commands=(\n" +
         names +
         "    )\n"
         "    [[ $PREFIX != -* ]] && _describe -t commands command commands\n"
         "    _arguments" +
         options +
         "\n"
         "    return\n"
         "  fi\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $words[1] in\n" +
         commands +
         "  esac\n"
         "}\n"
         "# Read by compinit it is called at once; by 'source' it is registered.\n"
         "if [[ $funcstack[1] == _vantage ]]; then _vantage \"$@\"; else compdef _vantage vantage; fi\n";
}

std::string fish_completion(const std::vector<CommandRow>& table) {
  std::string text = "# Completion of vantage for fish, written by 'vantage docs completion fish'.\n";
  for (const CommandRow& row : table) {
    const bool is_program = row.name.empty();
    const std::string condition = is_program ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + row.name;
    if (!is_program) {
      text += "complete -c vantage -n __fish_use_subcommand -f -a " + row.name + " -d " + fish_quoted(row.description) +
              "\n";
    }
    for (const OptionRow& option : row.options) text += fish_option(condition, option);
    const bool takes_files = !row.positionals.empty() && row.positionals.front().kind == ValueKind::file;
    if (takes_files) continue;
    text += "complete -c vantage -n " + fish_quoted(condition) + " -f";
    if (!row.positionals.empty()) text += " -a " + fish_quoted(joined(row.positionals.front().words));
    text += "\n";
  }
  return text;
}

}  // namespace vantage::cli
