#include "vantage/error.h"

#include <utility>

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
    : std::runtime_error(joined(problem, where, fix)),
      code_(code),
      problem_(std::move(problem)),
      where_(std::move(where)),
      fix_(std::move(fix)),
      object_(object) {}

}  // namespace vantage
