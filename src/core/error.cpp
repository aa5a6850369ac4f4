#include "vantage/error.h"

#include <utility>

#include "common/input.h"
#include "common/shown_address.h"

namespace vantage {
namespace {

/// The lines that are not empty, joined by newlines.
std::string joined(const std::string& problem, const std::string& where, const std::string& fix) {
  std::string text = problem;
  if (!where.empty()) text += "\n" + where;
  if (!fix.empty()) text += "\n" + fix;
  return text;
}

}  // namespace

Error::Error(ErrorCode code, std::string problem, std::string where, std::string fix,
             std::optional<std::uint32_t> object)
    : std::runtime_error(joined(problem = printable(without_secrets(problem)),
                                where = printable(without_secrets(where, true)),
                                fix = printable(without_secrets(fix)))),
      code_(code),
      problem_(std::move(problem)),
      where_(std::move(where)),
      fix_(std::move(fix)),
      object_(object) {}

std::string message_of(const Error& error) {
  std::string text;
  const auto add_line = [&text](const char* start, const std::string& line) {
    if (!line.empty()) text += start + line + "\n";
  };
  add_line("", error.problem());
  add_line("  where: ", error.where());
  add_line("  what to do: ", error.fix());
  return text;
}

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::input:
    case ErrorKind::output:
      return 2;
    case ErrorKind::cancelled:
      return 130;  // as shells report SIGINT
    case ErrorKind::internal:
      break;
  }
  return 3;
}

}  // namespace vantage
