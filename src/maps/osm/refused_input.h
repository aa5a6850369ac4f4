// Thrown by what reads the bytes of a map: map_file.cpp adds the name of the file and makes one Error of it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "vantage/error.h"

namespace vantage::internal::osm {

/// It may cross libosmium's threads, which hand over any exception.
struct RefusedInput : std::runtime_error {
  RefusedInput(ErrorCode refused_as, const std::string& problem, std::string position, std::string advice)
      : std::runtime_error(problem), code(refused_as), place(std::move(position)), fix(std::move(advice)) {}

  ErrorCode code;
  std::string place;  ///< within the file: "byte 17"; may be empty
  std::string fix;
};

}  // namespace vantage::internal::osm
