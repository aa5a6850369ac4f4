// Places in mission files, for messages.
#pragma once

#include <string>

#include "vantage/error.h"

namespace vantage::internal::core {

/// Calls `action` and returns what it returns. An Error(input) from it is thrown on with `place` (of the mission file)
/// put in front of its own `where`: the engine knows the objects, but not the file that named the target.
template <typename Action>
auto with_place(const std::string& place, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input || place.empty()) throw;
    throw error.with_where(error.where().empty() ? place : place + ", " + error.where());
  }
}

}  // namespace vantage::internal::core
