// Rows of a table of text, as they come.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/error.h"

namespace vantage::cli {

struct Row {
  std::string_view text;  ///< without blanks round it; not empty. Holds line breaks where a field in quotes does
  std::size_t line = 0;   ///< where it begins, from 1
};

/// A field of a row.
struct Field {
  std::string_view text;   ///< without blanks round it; in quotes where it came so
  bool is_quoted = false;  ///< then "" stands for one quote

  std::string plain() const;  ///< without its quotes
};

/// Reads a file descriptor to its end, in portions of what is there, up to a megabyte: rows can be answered as they
/// come, and the memory does not grow with the table. Empty rows and rows that begin with # are left out. The first row
/// tells how fields are separated: by semicolons if it has one, else by commas, else by tabs if it has two and no
/// blanks, else by blanks.
class RowReader {
 public:
  /// `file` is for messages. `check` is called while nothing comes, ten times a second; it may throw.
  RowReader(int descriptor, std::string file, std::function<void()> check);

  /// The next rows; none at the end. They are valid until the next call. Throws Error(input) when the file cannot be
  /// read, and with the line for a row longer than a megabyte or a quote that is not closed.
  const std::vector<Row>& next();

  const std::string& file() const { return file_; }
  /// Between fields; ' ' stands for any run of blanks.
  char separator() const { return separator_; }

  /// The fields of a row, into `fields`.
  void split(std::string_view row, std::vector<Field>& fields) const;

 private:
  bool wait_for_input(int milliseconds) const;
  void read_more();
  void take_rows();
  std::size_t end_of_row(std::string_view text, bool& is_in_quotes);
  [[noreturn]] void fail_of_length() const;
  [[noreturn]] void fail(ErrorCode code, const std::string& problem, const std::string& fix) const;

  int descriptor_;
  std::string file_;
  std::function<void()> check_;
  std::string text_;       // read and not yet given out
  std::size_t taken_ = 0;  // of that, given out with the last rows
  std::size_t line_ = 1;   // in which the rest begins
  bool is_at_end_ = false, has_begun_ = false;
  char separator_ = 0;
  std::vector<Row> rows_;
};

}  // namespace vantage::cli
