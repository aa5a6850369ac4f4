// Parses the JSON part of a file within limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/progress_reporter.h"
#include "core/read_limits.h"

namespace vantage::internal::io {

/// Why a text is no JSON, or too much of it. Line and column count from 1; 0 where there is none.
struct JsonProblem {
  std::string text;
  std::uint64_t line = 0, column = 0;
};

/// What the parser says, without its code ("[json.exception.parse_error.101] ") and with a short quote of the text.
std::string words_of(const nlohmann::json::exception& error);

/// Parses `text`. Throws JsonProblem for what is no JSON, has a member twice in one object (RFC 8259, section 4, leaves
/// open which of the two counts; glTF forbids it), is nested deeper than 100 levels, or is larger than the limits
/// allow; Error(cancelled) when told to stop.
nlohmann::json parse_json(std::string_view text, const core::ProgressReporter& progress,
                          const core::ReadLimits& limits);

/// The same with the memory that the value takes, as far as it can be told: what ReadLimits::json_bytes limits.
struct MeasuredJson {
  nlohmann::json value;
  std::uint64_t bytes = 0;
};
MeasuredJson parse_json_measured(std::string_view text, const core::ProgressReporter& progress,
                                 const core::ReadLimits& limits);

}  // namespace vantage::internal::io
