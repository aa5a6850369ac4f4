// What a call of the page answers: JSON, and what went wrong in words.
#pragma once

#include <exception>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vantage::live {

/// {"error": {code, problem, where, fix}}
nlohmann::ordered_json error_json(const std::exception& error);

/// What `work()` returns, or the text of error_json() when it throws.
std::string answered(const std::function<std::string()>& work);

}  // namespace vantage::live
