#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "common/input.h"
#include "vantage/error.h"
#include "vantage/mission_keys.h"

namespace vantage::cli {
namespace {

constexpr const char* kKeysExamples =
    "EXAMPLES\n"
    "  vantage keys                     # all keys of a mission file\n"
    "  vantage keys sensor              # those of a section\n"
    "  vantage keys sensor.pixel        # those of a map in it\n"
    "  vantage keys clearance           # every key of that name\n";

struct KeysArguments {
  CommonOptions common;
  std::string word;
};

std::string full_name(const MissionKey& key) { return key.section.empty() ? key.path : key.section + "." + key.path; }

/// Whether the word is the key, a map round it, or the last part of its name.
bool is_meant(const MissionKey& key, const std::string& word) {
  const std::string name = full_name(key);
  return word.empty() || name == word || name.starts_with(word + ".") || name.starts_with(word + "[]") ||
         name.ends_with("." + word);
}

/// Without the marks and links of Markdown.
std::string plain(const std::string& markdown) {
  std::string text;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    if (markdown[i] == '`') continue;
    const std::size_t middle = markdown[i] == '[' ? markdown.find("](", i) : std::string::npos;
    if (middle == std::string::npos || markdown.find(']', i) != middle) {
      text += markdown[i];
      continue;
    }
    text += markdown.substr(i + 1, middle - i - 1);
    i = markdown.find(')', middle);
  }
  return text;
}

/// On lines that are not too long to read.
std::string indented(const std::string& text) {
  constexpr std::size_t kMost = 96;
  const std::string indentation = "      ";
  std::string lines, line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && line.size() + 1 + word.size() > kMost) {
      lines += indentation + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    at = end + 1;
  }
  return lines + indentation + line + "\n";
}

int run_keys(const KeysArguments& options) {
  std::string text;
  for (const MissionKey& key : mission_keys()) {
    if (!is_meant(key, options.word)) continue;
    text += full_name(key) + (key.unit.empty() ? "" : " (" + key.unit + ")") + "\n" + indented(plain(key.text));
  }
  if (text.empty()) {
    std::vector<std::string> names;
    for (const MissionKey& key : mission_keys()) names.push_back(full_name(key));
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw Error(ErrorCode::unknown_choice, "a mission file has no key " + in_quotes(options.word), "command line, KEY",
                "did you mean " + std::string(nearest_name(options.word, known)) + "? `vantage keys` lists all");
  }
  print(text);
  return kSuccess;
}

}  // namespace

void add_keys(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<KeysArguments>();
  CLI::App* command = app.add_subcommand("keys", "List the keys of mission files: units, ranges, defaults");
  command->add_option("key", options->word, "A section, a map or a key: sensor, sensor.pixel, clearance")
      ->option_text("[KEY]");
  finish<KeysArguments>(*command, options, kKeysExamples, chosen, run_keys);
}

}  // namespace vantage::cli
