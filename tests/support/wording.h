// The words of messages are in one file, tests/golden/messages.txt. Tests assert codes, places and numbers, and compare
// the words with that file.
//
// After a message was changed on purpose, run `VANTAGE_UPDATE_GOLDEN=1 build/bin/vantage_tests` and look at the
// difference. Only the tests that ran are written anew, so a --gtest_filter may choose them.
#pragma once

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "vantage/error.h"

namespace vantage {

inline void PrintTo(ErrorCode code, std::ostream* out) { *out << name_of(code); }
inline void PrintTo(WarningCode code, std::ostream* out) { *out << name_of(code); }

}  // namespace vantage

namespace vantage::testing {

/// Compares a text with the golden file. The entry is that of the running test with the number of the call in it. The
/// folders of tests are written <folder> there, that of the sources <source>, and what PROJ says <PROJ>.
void expect_wording(const std::string& text);
void expect_wording(const std::vector<std::string>& texts);  ///< as one entry, a line each

/// What `action` throws; fails the test where that is nothing. Each of the three parts must be one line, and only
/// defects and cancelling may come without advice. The whole is compared with the golden file.
Error error_of(const std::function<void()>& action);

/// The code of error_of; nothing where nothing is thrown.
std::optional<ErrorCode> code_of(const std::function<void()>& action);

/// error_of, and checks the code, and that `where` is in the place.
Error expect_error(const std::function<void()>& action, ErrorCode code, const std::string& where = "");

/// The same without the golden file: for words of the system or of a library, for numbers that differ from machine to
/// machine, and in loops over many inputs.
Error expect_code(const std::function<void()>& action, ErrorCode code, const std::string& where = "");

}  // namespace vantage::testing
