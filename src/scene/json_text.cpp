#include "scene/json_text.h"

#include <algorithm>
#include <utility>

namespace vantage::scene {
namespace {

using nlohmann::json;

/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while …" without the code before.
std::string without_code(const std::string& what) {
  const std::size_t start = what.find("] ");
  return what.substr(start == std::string::npos ? 0 : start + 2);
}

JsonProblem problem_at(std::string_view text, std::size_t byte, std::string problem) {
  const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);  // bytes count from 1
  const std::size_t line_start = before.rfind('\n');
  return {std::move(problem), static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n')) + 1,
          before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1) + 1};
}

}  // namespace

json parse_json(std::string_view text, const core::ProgressReporter& progress, const ReadLimits& limits) {
  constexpr int kDeepest = 100;
  std::size_t values = 0;
  const auto count_values = [&](int depth, json::parse_event_t, json&) {
    if (depth > kDeepest) throw JsonProblem{"its JSON is nested deeper than " + std::to_string(kDeepest) + " levels"};
    if (++values > limits.json_values) {
      throw JsonProblem{"its JSON has more than " + std::to_string(limits.json_values) + " values"};
    }
    progress.tick(0, 1);
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), count_values);
  } catch (const json::parse_error& error) {
    throw problem_at(text, error.byte, without_code(error.what()));
  } catch (const json::exception& error) {  // a number that is too large
    throw JsonProblem{without_code(error.what())};
  }
}

}  // namespace vantage::scene
