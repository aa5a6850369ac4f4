#include "cli/row_reader.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "vantage/error.h"

namespace vantage::cli {
namespace {

constexpr std::size_t kPortion = std::size_t{1} << 20;
constexpr std::size_t kLongestRow = std::size_t{1} << 20;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// ' ' stands for any run of blanks. A semicolon wins: where it separates, commas are decimal ones.
char separator_of(std::string_view row) {
  if (row.find(';') != std::string_view::npos) return ';';
  if (row.find(',') != std::string_view::npos) return ',';
  return std::count(row.begin(), row.end(), '\t') > 1 && row.find(' ') == std::string_view::npos ? '\t' : ' ';
}

bool ends_field(char c, char separator) { return separator == ' ' ? is_blank(c) : c == separator; }

/// Blanks that belong to no field.
bool is_between(char c, char separator) { return is_blank(c) && c != separator; }

/// Past the closing quote of the field whose opening quote is at `at`; npos where none closes it.
std::size_t after_quotes(std::string_view row, std::size_t at) {
  for (++at; at < row.size(); ++at) {
    if (row[at] != '"') continue;
    if (at + 1 == row.size() || row[at + 1] != '"') return at + 1;
    ++at;
  }
  return std::string_view::npos;
}

}  // namespace

std::string Field::plain() const {
  if (!is_quoted) return std::string(text);
  std::string result;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    result += text[i];
    if (text[i] == '"') ++i;
  }
  return result;
}

RowReader::RowReader(int descriptor, std::string file, std::function<void()> check)
    : descriptor_(descriptor), file_(std::move(file)), check_(std::move(check)) {}

const std::vector<Row>& RowReader::next() {
  rows_.clear();
  text_.erase(0, taken_);
  taken_ = 0;
  while (rows_.empty() && !(is_at_end_ && text_.empty())) {
    if (!is_at_end_) read_more();
    take_rows();
    if (rows_.empty()) {
      text_.erase(0, taken_);
      taken_ = 0;
      if (text_.size() > kLongestRow) fail_of_length();
    }
  }
  return rows_;
}

void RowReader::split(std::string_view row, std::vector<Field>& fields) const {
  fields.clear();
  std::size_t at = 0;
  while (at <= row.size()) {
    while (at < row.size() && is_between(row[at], separator_)) ++at;
    const std::size_t start = at;
    Field field;
    if (at < row.size() && row[at] == '"') {
      at = std::min(after_quotes(row, at), row.size());
      field = {row.substr(start, at - start), true};
      while (at < row.size() && !ends_field(row[at], separator_)) ++at;
    } else {
      while (at < row.size() && !ends_field(row[at], separator_)) ++at;
      field = {trimmed(row.substr(start, at - start)), false};
    }
    fields.push_back(field);
    ++at;  // past the separator; past the end after the last field
  }
}

bool RowReader::wait_for_input(int milliseconds) const {
  pollfd input{descriptor_, POLLIN, 0};
  return ::poll(&input, 1, milliseconds) > 0;
}

/// Waits for something, and takes what else is there already.
void RowReader::read_more() {
  while (!wait_for_input(100)) check_();
  const std::size_t enough = text_.size() + kPortion;
  do {
    const std::size_t before = text_.size();
    text_.resize(enough);
    const ssize_t count = ::read(descriptor_, text_.data() + before, enough - before);
    const int reason = errno;
    text_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && reason != EINTR) {
      fail(ErrorCode::file_unreadable, std::string("the points cannot be read: ") + std::strerror(reason),
           "check where they come from");
    }
    if (count == 0) is_at_end_ = true;
    check_();
  } while (!is_at_end_ && text_.size() < enough && wait_for_input(0));
}

void RowReader::take_rows() {
  const std::string_view text = text_;
  if (!has_begun_ && text.starts_with("\xEF\xBB\xBF")) taken_ = 3;  // a byte order mark, as spreadsheets write it
  has_begun_ = true;
  while (taken_ < text.size()) {
    bool is_in_quotes = false;
    std::size_t end = end_of_row(text.substr(taken_), is_in_quotes);
    if (end == std::string_view::npos) {
      if (!is_at_end_) return;
      if (is_in_quotes) fail(ErrorCode::table_syntax, "a quote is not closed", "write \" at the end of the field");
      end = text.size() - taken_;
    }
    if (end > kLongestRow) fail_of_length();
    const std::string_view lines = text.substr(taken_, end), row = trimmed(lines);
    if (!row.empty() && row.front() != '#') rows_.push_back({row, line_});
    line_ += 1 + static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n'));
    taken_ = std::min(taken_ + end + 1, text.size());
  }
}

/// Where the line break after the first row is; a field in quotes may hold others. npos where it is not there yet.
std::size_t RowReader::end_of_row(std::string_view text, bool& is_in_quotes) {
  const std::size_t end_of_line = text.find('\n');
  const std::string_view line = trimmed(text.substr(0, end_of_line));
  if (line.empty() || line.front() == '#') return end_of_line;
  if (separator_ == 0) separator_ = separator_of(line);
  if (line.find('"') == std::string_view::npos) return end_of_line;
  std::size_t at = 0;
  while (at < text.size()) {
    while (at < text.size() && is_between(text[at], separator_)) ++at;
    if (at < text.size() && text[at] == '"') {
      at = after_quotes(text, at);
      if (at == std::string_view::npos) {
        is_in_quotes = true;
        return at;
      }
    }
    while (at < text.size() && text[at] != '\n' && !ends_field(text[at], separator_)) ++at;
    if (at < text.size() && text[at] == '\n') return at;
    ++at;
  }
  return std::string_view::npos;
}

void RowReader::fail_of_length() const {
  fail(ErrorCode::table_syntax, "the row is longer than a megabyte",
       "is a quote not closed? Begin each point on a line of its own");
}

void RowReader::fail(ErrorCode code, const std::string& problem, const std::string& fix) const {
  throw Error(code, problem, file_ + ":" + std::to_string(line_), fix);
}

}  // namespace vantage::cli
