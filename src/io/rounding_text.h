// How far rounding to a file's numbers moved a volume: how that is written into the file, and read again.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace vantage::internal::io {

/// "vantage rounding_m 1.5e-05": a comment; the number reads back exactly.
std::string rounding_text(double rounding_m);

/// Reads the text of a comment, after its sign of a comment, into `known` if it is ours: of several the largest. Throws
/// RoundingProblem for one that is garbled.
void read_rounding_comment(std::string_view comment, std::optional<double>& known);

/// "rounding_m" in the object "vantage" of a JSON object: glTF's "extras", files of their own. Throws RoundingProblem
/// for one that is not a length.
std::optional<double> rounding_in(const nlohmann::json& object);

/// What is wrong with such a number; whoever reads the file adds where it stands.
struct RoundingProblem {
  std::string text;
};

}  // namespace vantage::internal::io
