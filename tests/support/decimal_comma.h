// A locale that writes 1.5 as 1,5, for the length of a test: what a program that embeds the library may have set.
#pragma once

#include <cstdlib>
#include <locale>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "support/environment.h"
#include "support/temporary_directory.h"

namespace vantage::testing {

/// One that is installed, or else one that localedef makes, once for all tests, in a folder of its own.
class DecimalComma {
 public:
  static DecimalComma& instance() {
    static DecimalComma comma;
    return comma;
  }

  bool is_available() const { return !name_.empty(); }

  /// For the streams too.
  void enter() const {
    const auto path = search_path();
    std::locale::global(std::locale(name_));
  }
  static void leave() { std::locale::global(std::locale::classic()); }

 private:
  DecimalComma() {
    // The C library remembers what it has not found: no name is tried twice.
    for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
      if (is_found(name)) return;
    }
    folder_.emplace();
    const auto path = search_path();
    const std::string made = (*folder_ / "de_AT.UTF-8").string();
    if (std::system(("localedef -i de_DE -f UTF-8 '" + made + "' >/dev/null 2>&1").c_str()) == 0) {
      is_found("de_AT.UTF-8");
    }
  }

  bool is_found(const char* name) {
    try {
      const std::locale locale(name);
      name_ = name;
      return true;
    } catch (const std::runtime_error&) {
      return false;
    }
  }

  std::unique_ptr<EnvironmentVariable> search_path() const {
    return folder_ ? std::make_unique<EnvironmentVariable>("LOCPATH", folder_->path().string()) : nullptr;
  }

  std::optional<TemporaryDirectory> folder_;
  std::string name_;
};

}  // namespace vantage::testing
