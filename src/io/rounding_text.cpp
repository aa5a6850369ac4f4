#include "io/rounding_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/input.h"
#include "io/text_cursor.h"

namespace vantage::internal::io {
namespace {

constexpr std::string_view kRoundingMark = "vantage rounding_m ";
constexpr const char* kRoundingGarbled = "the rounding_m of vantage in it is not a length";

double checked(double rounding) {
  if (!(rounding >= 0) || !std::isfinite(rounding)) throw RoundingProblem{kRoundingGarbled};
  return rounding;
}

}  // namespace

std::string rounding_text(double rounding_m) { return std::string(kRoundingMark).append(shortest(rounding_m)); }

void read_rounding_comment(std::string_view comment, std::optional<double>& known) {
  while (!comment.empty() && TextCursor::is_blank(comment.front())) comment.remove_prefix(1);
  if (!comment.starts_with(kRoundingMark)) return;
  comment.remove_prefix(kRoundingMark.size());
  while (!comment.empty() && (TextCursor::is_blank(comment.back()) || comment.back() == '\r')) comment.remove_suffix(1);
  double number = -1;
  const auto [end, error] = std::from_chars(comment.data(), comment.data() + comment.size(), number);
  if (error != std::errc() || end != comment.data() + comment.size()) throw RoundingProblem{kRoundingGarbled};
  known = std::max(checked(number), known.value_or(0));
}

std::optional<double> rounding_in(const nlohmann::json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto ours = object.find("vantage");
  if (ours == object.end() || !ours->is_object()) return std::nullopt;
  const auto found = ours->find("rounding_m");
  if (found == ours->end()) return std::nullopt;
  return checked(found->is_number() ? found->get<double>() : -1);
}

}  // namespace vantage::internal::io
