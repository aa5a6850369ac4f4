#include "io/json_text.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/input.h"

namespace vantage::internal::io {
namespace {

using nlohmann::json;

/// At most 80 bytes of the file are quoted: it may be one that was named by mistake, or by a stranger.
std::string with_short_quote(const std::string& what) {
  constexpr std::size_t kBefore = 30, kBehind = 50;
  const std::size_t start = what.find('\''), end = what.rfind('\'');
  if (start == std::string::npos || end - start <= kBefore + kBehind) return what;
  std::size_t first = start + kBefore, second = end - kBehind;
  const auto is_continuation = [&](std::size_t i) { return (static_cast<unsigned char>(what[i]) & 0xC0U) == 0x80U; };
  while (first > start && is_continuation(first)) --first;
  while (second < end && is_continuation(second)) ++second;
  return what.substr(0, first) + "..." + what.substr(second);
}

JsonProblem problem_at(std::string_view text, std::size_t byte, std::string problem) {
  const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);  // bytes count from 1
  const std::size_t line_start = before.rfind('\n');
  return {std::move(problem), static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n')) + 1,
          before.size() - (line_start == std::string_view::npos ? 0 : line_start + 1) + 1};
}

/// Builds the value that a text describes. The parser of the library does so too, but looks through all earlier items
/// of an array after each that is an object, where it is given a callback that may stop it: the square of the items.
class ValueBuilder final : public nlohmann::json_sax<json> {
 public:
  ValueBuilder(std::string_view text, const core::ProgressReporter& progress, const core::ReadLimits& limits)
      : text_(text), progress_(progress), limits_(limits) {}

  MeasuredJson result() { return {std::move(root_), bytes_}; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(json::number_integer_t value) override { return add(value); }
  bool number_unsigned(json::number_unsigned_t value) override { return add(value); }
  bool number_float(json::number_float_t value, const json::string_t& /*written*/) override { return add(value); }
  bool string(json::string_t& value) override {
    take(kText + value.size());
    return add(std::move(value));
  }
  bool binary(json::binary_t& value) override { return add(std::move(value)); }
  bool start_object(std::size_t /*size*/) override {
    take(kContainer);
    return open(json::object());
  }
  bool start_array(std::size_t /*size*/) override {
    take(kContainer);
    return open(json::array());
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(json::string_t& name) override {
    take(kMember + name.size());
    const auto [member, is_new] = open_.back()->get_ref<json::object_t&>().try_emplace(name, nullptr);
    if (!is_new) throw JsonProblem{"its JSON has the member " + in_quotes(name) + " twice in one object"};
    member_ = &member->second;
    return true;
  }

  bool parse_error(std::size_t byte, const std::string& /*last*/, const json::exception& error) override {
    if (dynamic_cast<const json::parse_error*>(&error)) throw problem_at(text_, byte, words_of(error));
    throw JsonProblem{words_of(error)};  // a number that is too large
  }

 private:
  // Bytes on the heap: a value in an array that doubles its room; besides, a text, an array or object, a member's node.
  static constexpr std::size_t kValue = 32, kText = 48, kContainer = 64, kMember = 96;

  void take(std::size_t bytes) {
    bytes_ += bytes;
    if (bytes_ > limits_.json_bytes) {
      throw JsonProblem{"its JSON takes more than " + std::to_string(limits_.json_bytes >> 20U) +
                        " MiB when it is parsed"};
    }
  }

  bool add(json value) {
    place(std::move(value));
    return true;
  }

  bool open(json value) {
    constexpr std::size_t kDeepest = 100;
    if (open_.size() > kDeepest) {
      throw JsonProblem{"its JSON is nested deeper than " + std::to_string(kDeepest) + " levels"};
    }
    open_.push_back(place(std::move(value)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  /// Where the value stays until its parent is closed: a parent gets its next item when this one is complete.
  json* place(json value) {
    if (++values_ > limits_.json_values) {
      throw JsonProblem{"its JSON has more than " + std::to_string(limits_.json_values) + " values"};
    }
    take(kValue);
    progress_.tick(0, 1);
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->is_array()) {
      open_.back()->push_back(std::move(value));
      return &open_.back()->back();
    }
    *member_ = std::move(value);
    return member_;
  }

  std::string_view text_;
  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
  json root_;
  std::vector<json*> open_;  ///< arrays and objects whose end has not come, outermost first
  json* member_ = nullptr;   ///< of the innermost one, an object: the value of its last key
  std::size_t values_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::string words_of(const json::exception& error) {
  const std::string what = error.what();
  const std::size_t start = what.find("] ");
  return with_short_quote(what.substr(start == std::string::npos ? 0 : start + 2));
}

json parse_json(std::string_view text, const core::ProgressReporter& progress, const core::ReadLimits& limits) {
  return parse_json_measured(text, progress, limits).value;
}

MeasuredJson parse_json_measured(std::string_view text, const core::ProgressReporter& progress,
                                 const core::ReadLimits& limits) {
  ValueBuilder builder(text, progress, limits);
  json::sax_parse(text.begin(), text.end(), &builder);
  return builder.result();
}

}  // namespace vantage::internal::io
