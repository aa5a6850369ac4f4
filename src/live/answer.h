// What a call of the page answers: JSON, and what went wrong in words.
#pragma once

#include <functional>
#include <string>

namespace vantage::live {

/// What `work()` returns; {"error": {code, problem, where, fix}} when it throws.
std::string answered(const std::function<std::string()>& work);

}  // namespace vantage::live
