// The error of builds that lack a component.
#pragma once

#include <string>

#include "vantage/error.h"

namespace vantage::internal::app {

/// `component`: "solid"; `what` cannot be done without it: "targets of several parts".
[[noreturn]] inline void throw_missing(const std::string& component, const std::string& what,
                                       const std::string& where) {
  throw Error(ErrorCode::component_missing,
              "this build of vantage has no component '" + component + "', which " + what + " need", where,
              "build vantage with VANTAGE_COMPONENTS=all, or with " + component + " among them");
}

}  // namespace vantage::internal::app
