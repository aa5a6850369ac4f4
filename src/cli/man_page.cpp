#include "cli/man_page.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

#include "vantage/version.h"

namespace vantage::cli {
namespace {

constexpr std::size_t kSourceWidth = 72;

/// `text` with the characters that roff takes for its own. A minus that is to be typed is \-, a hyphen is not.
std::string escaped(std::string_view text, bool is_typed) {
  std::string result;
  bool in_option = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool begins = i == 0 || std::string_view(" ('\"=").find(text[i - 1]) != std::string_view::npos;
    if (begins) in_option = c == '-';
    switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += is_typed || in_option ? "\\-" : "-";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += c;
    }
  }
  return result.starts_with('.') ? "\\&" + result : result;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text, true) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + escaped(text, true) + "\\fR"; }

/// Prose, broken into short source lines.
std::string filled(const std::string& text) {
  std::string result, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > kSourceWidth) {
      result += escaped(line, false) + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return result + escaped(line, false) + "\n";
}

std::string in_one_line(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + " ";
  return text;
}

std::string page_name(const CommandRow& row) { return row.name.empty() ? "vantage" : "vantage-" + row.name; }

bool has_page(const CommandRow& row) { return row.name != "help" && row.name != "version"; }

std::string option_text(const OptionRow& option) {
  std::string text = ".TP\n";
  for (const std::string& name : option.names) {
    text += (&name == &option.names.front() ? "" : ", ") + bold(name);
  }
  if (!option.value.empty()) text += (option.names.empty() ? "" : " ") + italic(option.value);
  text += "\n";
  std::string words;
  for (const std::string& word : option.words) {
    if (option.description.find(word) == std::string::npos) words += (words.empty() ? "" : ", ") + word;
  }
  text += filled(option.description + (words.empty() ? "" : " (" + words + ")"));
  return text;
}

std::string synopsis(const CommandRow& row) {
  std::string text = ".SH SYNOPSIS\n" + bold("vantage");
  if (row.name.empty()) return text + " " + italic("COMMAND") + " [" + italic("OPTION") + "]...\n";
  text += " " + bold(row.name) + " [" + italic("OPTION") + "]...";
  for (const OptionRow& option : row.options) {
    if (option.is_required) text += " " + bold(option.names.front()) + " " + italic(option.value);
  }
  for (const OptionRow& positional : row.positionals) {
    text += positional.is_required ? " " + italic(positional.value) : " [" + italic(positional.value) + "]";
  }
  return text + "\n";
}

std::string commands(const std::vector<CommandRow>& table) {
  std::string text = ".SH COMMANDS\n";
  for (const CommandRow& row : table) {
    if (row.name.empty()) continue;
    text += ".TP\n" + bold(row.name) + "\n" + filled(row.description + ".");
    if (has_page(row)) text += "See " + bold(page_name(row)) + "(1).\n";
  }
  return text;
}

/// Rows are "  2      bad input", their further lines have no code; what is left is a paragraph.
std::string exit_status(const HelpSection& section) {
  std::string text = ".SH EXIT STATUS\n", paragraph;
  const auto flush = [&] {
    if (!paragraph.empty()) text += filled(paragraph);
    paragraph.clear();
  };
  for (const std::string& line : section.lines) {
    const std::size_t begin = line.find_first_not_of(' ');
    const std::size_t gap = line.find("  ", begin);
    if (begin > 2) {
      paragraph += " " + line;
    } else if (gap != std::string::npos) {
      flush();
      text += ".TP\n" + bold(line.substr(begin, gap - begin)) + "\n";
      paragraph = line.substr(gap);
    } else {
      flush();
      text += ".PP\n";
      paragraph = line;
    }
  }
  flush();
  return text;
}

/// As typed, without the indentation.
std::string examples(const HelpSection& section) {
  std::string text = ".SH EXAMPLES\n.nf\n";
  for (const std::string& line : section.lines) {
    text += escaped(line.substr(std::min(line.size(), line.find_first_not_of(' '))), true) + "\n";
  }
  return text + ".fi\n";
}

std::string see_also(const CommandRow& row, const std::vector<CommandRow>& table) {
  std::string text = ".SH SEE ALSO\n", previous;
  for (const CommandRow& other : table) {
    if (!has_page(other) || other.name == row.name) continue;
    if (!previous.empty()) text += ".BR " + previous + " (1),\n";
    previous = escaped(page_name(other), true);
  }
  return text + ".BR " + previous + " (1)\n";
}

std::string page(const CommandRow& row, const std::vector<CommandRow>& table) {
  const std::string name = page_name(row);
  std::string title = name, brief = row.description;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  brief[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(brief[0])));
  if (brief.ends_with('.')) brief.pop_back();
  std::string text = ".\\\" Written by 'vantage docs man' from the tables of 'vantage --help'.\n.TH " +
                     escaped(title, true) + " 1 \"\" \"vantage " VANTAGE_VERSION "\" \"vantage\"\n.SH NAME\n" +
                     escaped(name, true) + " \\- " + escaped(brief, false) + "\n" + synopsis(row) +
                     ".SH DESCRIPTION\n" + filled(row.description + (row.description.ends_with('.') ? "" : "."));
  for (const HelpSection& section : row.sections) {
    if (section.title.empty()) text += ".PP\n" + filled(in_one_line(section.lines));
  }
  if (row.name.empty()) text += commands(table);
  text += ".SH OPTIONS\n";
  for (const OptionRow& positional : row.positionals) text += option_text(positional);
  for (const OptionRow& option : row.options) text += option_text(option);
  std::string shown, last;
  for (const HelpSection& section : row.sections) {
    if (section.title == "EXIT CODES") {
      last.insert(0, exit_status(section));
    } else if (section.title == "EXAMPLES") {
      last += examples(section);
    } else if (!section.title.empty()) {
      shown += ".SH " + section.title + "\n" + filled(in_one_line(section.lines));
    }
  }
  return text + shown + last + see_also(row, table);
}

}  // namespace

std::vector<ManPage> man_pages(const std::vector<CommandRow>& table) {
  std::vector<ManPage> pages;
  for (const CommandRow& row : table) {
    if (has_page(row)) pages.push_back({page_name(row) + ".1", page(row, table)});
  }
  return pages;
}

}  // namespace vantage::cli
