// The one exception type of vantage.
#pragma once

#include <stdexcept>
#include <string>

#include "vantage/export.h"

namespace vantage {

/// What kind of failure an Error tells of; the program's exit code follows from it.
enum class ErrorKind {
  input,      ///< a file, a mission or an argument is wrong: the caller must mend it (exit code 2)
  output,     ///< a result could not be written; nothing was left half-written (exit code 2)
  cancelled,  ///< the caller's progress callback asked to stop
  internal,   ///< a defect of vantage itself: an invariant did not hold
};

/// Thrown by every public function that fails. Three short lines for the person who must fix it: what is wrong, where
/// (file, line, object), and what to do. `what()` returns the three joined by newlines; `where` and `fix` may be empty.
class VANTAGE_API Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string problem, std::string where, std::string fix);

  ErrorKind kind() const { return kind_; }
  const std::string& problem() const { return problem_; }
  const std::string& where() const { return where_; }
  const std::string& fix() const { return fix_; }

 private:
  ErrorKind kind_;
  std::string problem_, where_, fix_;
};

}  // namespace vantage
